//! Stability and conservation of a shell in free flight (no gravity, no contact).

#![allow(clippy::unwrap_used, reason = "tests")]

use super::Shell;
use crate::category::cap::{self, Resolution, Set};
use crate::object::Object;
use nalgebra::Vector3;
use rayon::prelude::*;
use seeone_core::Pose;
use seeone_core::random::{Generator, generator, normal};

const FRAME_S: f64 = 1.0 / 60.0;

const RESOLUTIONS: [Resolution; 4] =
    [Resolution::COARSE, Resolution::STANDARD, Resolution::FINE, Resolution::FINEST];

fn a_cap(resolution: Resolution) -> Object {
    cap::named_at("cap-unseen-07", resolution).unwrap()
}

/// Random velocities of `rms` m/s, apart from the shell's own.
fn shake(shell: &mut Shell, rms: f64) {
    let mut rng: Generator = generator(11, "shake");
    for v in &mut shell.velocity {
        *v += Vector3::from_fn(|_, _| normal(&mut rng)) * (rms / 3.0f64.sqrt());
    }
}

/// Flies `seconds` and calls `each` after every frame.
fn fly(
    shell: &mut Shell,
    seconds: f64,
    substeps: usize,
    damping: f64,
    mut each: impl FnMut(&Shell),
) {
    let h = FRAME_S / substeps as f64;
    for _ in 0..(seconds / FRAME_S).round() as usize {
        for _ in 0..substeps {
            shell.predict(h, &Vector3::zeros(), damping);
            shell.solve(h);
            shell.finish(h);
        }
        each(shell);
    }
}

/// Energy at the end and at most, as shares of the start's, from noise of 0.1 mm/s.
fn energy_shares(mut shell: Shell, seconds: f64, substeps: usize) -> (f64, f64) {
    shell.bending_damping_s = 0.0;
    shake(&mut shell, 1e-4);
    let start = shell.kinetic_energy();
    let (mut last, mut most) = (0.0, 0.0f64);
    fly(&mut shell, seconds, substeps, 0.0, |s| {
        last = (s.kinetic_energy() + s.elastic_energy()) / start;
        most = most.max(last);
    });
    (last, most)
}

/// From small noise the energy never grows, and after 2 s hardly any is left.
fn assert_calm(cap: &Object, substeps: usize) {
    let (last, most) = energy_shares(Shell::new(cap, &Pose::identity()), 2.0, substeps);
    let what =
        format!("{} of {} vertices, {substeps} substeps", cap.name(), cap.mesh().vertices().len());
    assert!(last < 0.05 && most < 1.01, "{what}: {last} at the end, {most} at most");
}

#[test]
fn small_noise_dies_out_without_any_damping_at_every_resolution() {
    RESOLUTIONS.par_iter().for_each(|resolution| {
        [20, 25, 40].into_iter().for_each(|n| assert_calm(&a_cap(*resolution), n));
    });
}

/// Every cap for half a second, and every tenth until the noise has died out.
#[test]
fn no_cap_gains_energy_in_free_flight() {
    let names: Vec<String> = Set::DISJOINT.into_iter().flat_map(cap::names).collect();
    names.par_iter().enumerate().for_each(|(index, name)| {
        let cap = cap::named(name).unwrap();
        for substeps in [20, 25, 40] {
            if index % 10 == 0 {
                assert_calm(&cap, substeps);
            } else {
                let shell = Shell::new(&cap, &Pose::identity());
                let (_, most) = energy_shares(shell, 0.5, substeps);
                assert!(most < 1.01, "{name}, {substeps} substeps: {most} of the energy");
            }
        }
    });
}

#[test]
fn the_margin_is_wide_softer_hinges_or_none_change_nothing() {
    for resolution in [Resolution::STANDARD, Resolution::FINE] {
        for factor in [0.01, 0.0] {
            let mut shell = Shell::new(&a_cap(resolution), &Pose::identity());
            shell.bend = shell.bend.scaled(factor);
            let (last, _) = energy_shares(shell, 1.0, 20);
            assert!(last < 0.1, "{resolution:?}, bending x {factor}: {last}");
        }
    }
}

#[test]
fn noise_calms_down_with_the_usual_damping() {
    for resolution in RESOLUTIONS {
        let mut shell = Shell::new(&a_cap(resolution), &Pose::identity());
        shake(&mut shell, 0.08);
        fly(&mut shell, 2.0, 20, 2.0, |_| ());
        assert!(shell.rms_speed() < 0.01, "{resolution:?}: {}", shell.rms_speed());
    }
}

#[test]
fn a_free_spin_keeps_its_momentum() {
    let lost = |resolution, substeps| {
        let mut shell = Shell::new(&a_cap(resolution), &Pose::identity());
        let centre = shell.centre_of_mass();
        let spin = Vector3::new(1.0, 2.0, 3.0).normalize() * 3.7;
        for (v, p) in shell.velocity.iter_mut().zip(&shell.position) {
            *v = spin.cross(&(p - centre));
        }
        shake(&mut shell, 0.01);
        let start = shell.momentum();
        // About the centre, so that the noise's drift does not count.
        let about = |s: &Shell| {
            let m = s.momentum();
            m.angular - s.centre_of_mass().coords.cross(&m.linear)
        };
        let before = about(&shell);
        fly(&mut shell, 1.0, substeps, 0.0, |_| ());
        let (after, drift) = (about(&shell), shell.momentum().linear - start.linear);
        assert!(drift.norm() < 1e-9 * shell.total_mass(), "linear momentum drifts by {drift:?}");
        assert!(before.angle(&after) < 1.0f64.to_radians(), "{}", before.angle(&after));
        1.0 - after.norm() / before.norm()
    };
    for resolution in RESOLUTIONS {
        let (coarse, fine) = (lost(resolution, 20), lost(resolution, 40));
        assert!(coarse.abs() < 0.015, "{resolution:?}: {coarse}");
        assert!(fine.abs() < 0.6 * coarse.abs(), "{fine} at half the step, {coarse} before");
    }
}
