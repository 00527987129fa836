//! Stability and conservation of a shell in free flight (no gravity, no contact).

#![allow(clippy::unwrap_used, reason = "tests")]

use super::Shell;
use crate::category::cap;
use crate::object::Object;
use nalgebra::Vector3;
use seeone_core::Pose;
use seeone_core::random::{Generator, generator, normal};

const FRAME_S: f64 = 1.0 / 60.0;

fn a_cap() -> Object {
    cap::named("cap-unseen-07").unwrap()
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

#[test]
fn small_noise_dies_out_without_any_damping() {
    for substeps in [20, 40] {
        let (last, most) = energy_shares(Shell::new(&a_cap(), &Pose::identity()), 2.0, substeps);
        assert!(
            last < 0.05 && most < 1.01,
            "{substeps} substeps: {last} at the end, {most} at most"
        );
    }
}

#[test]
fn the_margin_is_wide_softer_hinges_or_none_change_nothing() {
    for factor in [0.01, 0.0] {
        let mut shell = Shell::new(&a_cap(), &Pose::identity());
        shell.bend = shell.bend.scaled(factor);
        let (last, _) = energy_shares(shell, 1.0, 20);
        assert!(last < 0.1, "bending x {factor}: {last}");
    }
}

#[test]
fn noise_calms_down_with_the_usual_damping() {
    let mut shell = Shell::new(&a_cap(), &Pose::identity());
    shake(&mut shell, 0.08);
    fly(&mut shell, 2.0, 20, 2.0, |_| ());
    assert!(shell.rms_speed() < 0.01, "{}", shell.rms_speed());
}

#[test]
fn a_free_spin_keeps_its_momentum() {
    let lost = |substeps| {
        let mut shell = Shell::new(&a_cap(), &Pose::identity());
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
    let (coarse, fine) = (lost(20), lost(40));
    assert!(coarse.abs() < 0.015, "{coarse}");
    assert!(fine.abs() < 0.6 * coarse.abs(), "{fine} at half the step, {coarse} before");
}
