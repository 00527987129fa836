//! Contact of a shell with the two pads of a gripper.

use super::{Sample, Touch};
use crate::hand::{Command, FINGER_THICKNESS_M, Fingers, PAD_HEEL_M, PAD_TIP_M, PAD_WIDTH_M};
use crate::shell::Shell;
use nalgebra::{Point3, Vector3};

/// Farther than this from a pad's rim the shell meets a closing face, whatever face is
/// nearest: otherwise it is squeezed out sideways.
const RIM_M: f64 = 3.0e-3;
/// Radius about the tool frame's origin that holds both fingers, metres, without opening.
const FINGER_RADIUS_M: f64 = 0.03;
/// How far a point may come within a frame, metres.
const MARGIN_M: f64 = 0.02;

/// The samples near a gripper and what its pads felt.
#[derive(Clone, Debug)]
pub struct Pads {
    samples: Vec<Sample>,
    near: Vec<Sample>,
    /// Normal impulse on the closing face of either pad in this frame, N s.
    impulse: [f64; 2],
}

impl Pads {
    /// Pads that may touch any of `samples`.
    pub fn new(samples: Vec<Sample>) -> Self {
        Self { samples, near: Vec::new(), impulse: [0.0; 2] }
    }

    /// All samples of the shell.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// Collects the samples that the fingers may touch in the next frame.
    pub fn begin_frame(&mut self, shell: &Shell, fingers: &Fingers) {
        self.impulse = [0.0; 2];
        let centre = Point3::from(fingers.now.pose.translation.vector);
        let radius = FINGER_RADIUS_M + fingers.now.opening_m / 2.0 + MARGIN_M;
        let close = |s: &&Sample| (s.at(&shell.position) - centre).norm_squared() < radius * radius;
        self.near.clear();
        self.near.extend(self.samples.iter().filter(close));
    }

    /// Pushes the shell off the pads. A pad whose fingers have stopped presses with the
    /// grip's force at most: otherwise a grip that is too weak would still wedge the shell.
    pub fn solve(&mut self, shell: &mut Shell, fingers: &Fingers, friction: f64, h: f64) {
        let mut budget = match fingers.command {
            Command::Grip(force_n) => [force_n * h; 2],
            Command::Close(_) | Command::Width(_) => [f64::INFINITY; 2],
        };
        for sample in &self.near {
            let p = sample.at(&shell.position);
            let Some((touch, closing)) = touch(&p, fingers) else { continue };
            let moved = p - sample.at(&shell.previous);
            let (mut correction, lift) = touch.correction(&moved, friction, h);
            let inverse = sample.inverse_mass(shell);
            if inverse <= 0.0 {
                continue;
            }
            if let Some(finger) = closing {
                let wanted = lift / (inverse * h);
                let impulse = wanted.min(budget[finger]);
                budget[finger] -= impulse;
                self.impulse[finger] += impulse;
                correction *= impulse / wanted.max(f64::MIN_POSITIVE);
            }
            sample.shift(shell, &correction);
        }
    }

    /// Force that both pads pressed with over a frame of `frame_s` seconds, N.
    pub fn squeeze(&self, frame_s: f64) -> f64 {
        self.impulse[0].min(self.impulse[1]) / frame_s
    }
}

/// Where a point touches a finger, and which finger when it is on the closing face.
fn touch(p: &Point3<f64>, fingers: &Fingers) -> Option<(Touch, Option<usize>)> {
    let hand = &fingers.now;
    let q = hand.pose.inverse_transform_point(p);
    let side = if q.y < 0.0 { -1.0 } else { 1.0 };
    let closing = q.y.abs() - hand.opening_m / 2.0;
    let away = FINGER_THICKNESS_M - closing;
    let across = PAD_WIDTH_M / 2.0 - q.x.abs();
    let tip = PAD_TIP_M - q.z;
    if closing <= 0.0 || away <= 0.0 || across <= 0.0 || tip <= 0.0 || q.z <= PAD_HEEL_M {
        return None;
    }
    let flat = closing.min(away);
    let (depth, normal, on_face) = if across.min(tip) > RIM_M || flat <= across.min(tip) {
        if closing <= away {
            (closing, Vector3::y() * -side, true)
        } else {
            (away, Vector3::y() * side, false)
        }
    } else if across < tip {
        (across, Vector3::x() * q.x.signum(), false)
    } else {
        (tip, Vector3::z(), false)
    };
    let slid = side * (hand.opening_m - fingers.before.opening_m) / 2.0;
    let origin = fingers.before.pose * Point3::new(q.x, q.y - slid, q.z);
    let touch = Touch { normal: hand.pose.rotation * normal, depth, carried: p - origin };
    Some((touch, on_face.then_some(usize::from(side > 0.0))))
}
