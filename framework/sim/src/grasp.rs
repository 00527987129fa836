//! What a closed gripper holds.
//!
//! A pinch of a few coarse vertices cannot carry a cap by contact friction alone: the
//! force that a substep can pass is bounded by vertex mass / h^2. So the points between
//! the pads are carried by the hand, as long as the friction and the pressure that the
//! grip really has would carry the load; then all are let go at once.

use crate::contact::Sample;
use crate::hand::{Fingers, Hand, PAD_HEEL_M, PAD_TIP_M, PAD_WIDTH_M};
use crate::shell::{Momentum, Shell};
use nalgebra::{Point3, Vector3};

/// Fewer points between the pads than this are no grip.
const POINTS_NEEDED: usize = 4;
/// How far from a pad a layer may be and still count as pressed, beyond its thickness.
const PAD_SLACK_M: f64 = 1.0e-3;
/// Compliance of a held point between vertices, m/N.
const COMPLIANCE_M_N: f64 = 1.0e-5;
/// Rate at which a held shell's motion relative to the hand decays beyond the air's, 1/s:
/// the friction inside hanging fabric.
const SWING_DAMPING_1_S: f64 = 3.0;

/// Time over which rubber pads even out a jolt, seconds.
const PADS_GIVE_S: f64 = 0.1;

/// A vertex moved by the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pin {
    vertex: usize,
    /// In the tool frame.
    at: Point3<f64>,
}

/// A point between vertices drawn along by the hand.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Anchor {
    sample: Sample,
    /// In the tool frame.
    at: Point3<f64>,
}

/// A grip on some points of a shell.
#[derive(Clone, Debug, PartialEq)]
pub struct Grasp {
    force_n: f64,
    pins: Vec<Pin>,
    anchors: Vec<Anchor>,
    points: usize,
    /// Mean of what the hand gave the shell, over the time that the pads give way.
    load: Momentum,
}

impl Grasp {
    /// Grips whatever of `samples` lies between the pads of `hand`, which press with
    /// `force_n`; `thickness_m` is the shell's thickest layer. `None` when that is fewer
    /// than four points, or when a pad presses on none.
    pub fn form(
        shell: &mut Shell,
        samples: &[Sample],
        hand: &Hand,
        thickness_m: f64,
        force_n: f64,
    ) -> Option<Self> {
        let local = |p: &Point3<f64>| hand.pose.inverse_transform_point(p);
        let between = |s: &&Sample| {
            let q = local(&s.at(&shell.position));
            let inside = q.x.abs() <= PAD_WIDTH_M / 2.0 && q.z >= PAD_HEEL_M && q.z <= PAD_TIP_M;
            inside && q.y.abs() <= hand.opening_m / 2.0 + PAD_SLACK_M
        };
        let reach = thickness_m + PAD_SLACK_M;
        let held: Vec<Sample> = samples.iter().filter(between).copied().collect();
        let pressed = |side: f64| {
            let gap = |s: &Sample| hand.opening_m / 2.0 - side * local(&s.at(&shell.position)).y;
            held.iter().any(|s| gap(s) <= reach)
        };
        if held.len() < POINTS_NEEDED || !pressed(1.0) || !pressed(-1.0) {
            return None;
        }
        let mut vertices: Vec<usize> = held
            .iter()
            // A grip anywhere on a rigid part moves it as a whole, corners included.
            .filter(|s| s.is_vertex() || s.carriers().all(|(v, _)| shell.is_rigid(v)))
            .flat_map(|s| s.carriers().map(|(v, _)| v))
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        let free = |s: &&Sample| s.carriers().any(|(v, _)| vertices.binary_search(&v).is_err());
        let anchors = held
            .iter()
            .filter(free)
            .map(|s| Anchor { sample: *s, at: local(&s.at(&shell.position)) })
            .collect();
        let pin = |v: &usize| Pin { vertex: *v, at: local(&shell.position[*v]) };
        let pins = vertices.iter().map(pin).collect();
        shell.pin(&vertices);
        Some(Self { force_n, pins, anchors, points: held.len(), load: Momentum::zero() })
    }

    /// What the hand gives the shell, N in `world`, evened out over the time in which the
    /// pads give way.
    pub fn load_n(&self) -> Vector3<f64> {
        self.load.linear
    }

    /// How many points are held.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Moves the pinned vertices with the hand and calms the rest; before the shell's
    /// constraints are solved in a substep of `h` seconds.
    pub fn carry(&self, shell: &mut Shell, fingers: &Fingers, h: f64) {
        let motion = fingers.now.pose * fingers.before.pose.inverse();
        let calm = SWING_DAMPING_1_S * h;
        for vertex in 0..shell.position.len() {
            let before = shell.previous[vertex];
            let swing = (shell.position[vertex] - before) - (motion * before - before);
            if shell.inverse_mass[vertex] > 0.0 {
                shell.position[vertex] -= swing * calm;
            }
        }
        for pin in &self.pins {
            shell.position[pin.vertex] = fingers.now.pose * pin.at;
        }
    }

    /// Draws the anchored points along; after contacts.
    pub fn draw(&self, shell: &mut Shell, hand: &Hand, h: f64) {
        let compliance = COMPLIANCE_M_N / (h * h);
        for anchor in &self.anchors {
            let sample = &anchor.sample;
            let inverse = sample.inverse_mass(shell);
            let off = hand.pose * anchor.at - sample.at(&shell.position);
            sample.shift(shell, &(off * (inverse / (inverse + compliance))));
        }
    }

    /// How far the farthest held point is from where it was gripped, metres.
    pub fn slip_m(&self, shell: &Shell, hand: &Hand) -> f64 {
        let off = |a: &Anchor| (hand.pose * a.at - a.sample.at(&shell.position)).norm();
        self.anchors.iter().map(off).fold(0.0, f64::max)
    }

    /// Whether the grip still carries its load after a frame of `frame_s` seconds in which
    /// the hand gave the shell `load` per second (N, and N m about the world's origin),
    /// with `friction` between pad and shell.
    ///
    /// What counts is the mean over the time in which rubber pads give way: a sheet that
    /// the closing pads were still turning is stopped in one frame here, which real pads
    /// stretch over several.
    pub fn carries(&mut self, load: &Momentum, hand: &Hand, friction: f64, frame_s: f64) -> bool {
        let share = (frame_s / PADS_GIVE_S).min(1.0);
        self.load.linear += (load.linear - self.load.linear) * share;
        self.load.angular += (load.angular - self.load.angular) * share;
        let load = &self.load;
        let centre = hand.pose.translation.vector;
        let force = hand.pose.rotation.inverse() * load.linear;
        let torque = hand.pose.rotation.inverse() * (load.angular - centre.cross(&load.linear));
        // Two pads rub; what they rub with is shared between sliding and turning on the
        // spot (the elliptic limit surface of a soft finger, Howe and Cutkosky 1996).
        let rub = 2.0 * friction * self.force_n;
        let length = PAD_TIP_M - PAD_HEEL_M;
        let radius = 2.0 / 3.0 * (PAD_WIDTH_M * length / std::f64::consts::PI).sqrt();
        let slide = Vector3::new(force.x, 0.0, force.z).norm_squared();
        let turn = (torque.y / radius).powi(2);
        // Tilting is taken up by pressing harder at one rim of the pads than at the other.
        let tilt = (torque.x.abs() / (length / 2.0)).max(torque.z.abs() / (PAD_WIDTH_M / 2.0));
        slide + turn <= rub * rub && tilt <= self.force_n
    }
}
