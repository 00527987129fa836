//! A parallel-jaw gripper as the shell meets it: two pads that move as told.

use nalgebra::Vector3;
use seeone_core::Pose;

/// Width of a pad along x of the tool frame, metres (AG-95).
pub const PAD_WIDTH_M: f64 = 0.022;
/// Where the finger tips are along z of the tool frame, metres.
pub const PAD_TIP_M: f64 = 0.010;
/// Where the pads begin along z of the tool frame, metres.
pub const PAD_HEEL_M: f64 = -0.024;
/// Thickness of a finger along y, metres.
pub const FINGER_THICKNESS_M: f64 = 0.010;
/// Widest opening, metres.
pub const STROKE_M: f64 = 0.095;
/// Narrowest opening in a grip, metres: two layers of cap fabric.
pub const MINIMUM_GAP_M: f64 = 0.0015;
/// Speed of each finger, m/s.
pub const FINGER_SPEED_M_S: f64 = 0.05;

/// A gripper: the tool frame's pose in world (z approaches, y closes, origin between the
/// pads, 10 mm behind the finger tips) and the distance between the pads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Tool frame -> world.
    pub pose: Pose,
    /// Distance between the pads, metres.
    pub opening_m: f64,
}

/// What a gripper can report.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HandState {
    /// Distance between the pads, metres.
    pub opening_m: f64,
    /// Force with which each pad presses, N: measured while closing, the grip's once the
    /// fingers have stopped.
    pub normal_force_n: f64,
    /// Points held between the pads; none when nothing is held.
    pub held_points: usize,
    /// How far the farthest held point has moved from where it was gripped, metres.
    pub slip_m: f64,
    /// Whether the fingers have stopped closing.
    pub closed: bool,
    /// What the hand gives a held shell, N in `world`, evened out over the time in which
    /// rubber pads give way.
    pub load_n: Vector3<f64>,
}

/// What the fingers are doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Moving to an opening, metres.
    Width(f64),
    /// Closing until each pad presses with this force, N.
    Close(f64),
    /// Stopped with this force, N.
    Grip(f64),
}

/// The gripper's kinematics over a frame and its substeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fingers {
    from: Pose,
    to: Pose,
    /// What the fingers are doing.
    pub command: Command,
    /// The gripper now.
    pub now: Hand,
    /// The gripper one substep ago.
    pub before: Hand,
}

impl Fingers {
    /// A gripper at rest.
    pub fn new(hand: Hand) -> Self {
        let now = Hand { opening_m: hand.opening_m.clamp(0.0, STROKE_M), ..hand };
        let command = Command::Width(now.opening_m);
        Self { from: now.pose, to: now.pose, command, now, before: now }
    }

    /// Sets where the tool frame shall be at the end of the next frame.
    pub fn aim(&mut self, pose: &Pose) {
        self.to = *pose;
    }

    /// Starts a frame where the last one ended.
    pub fn begin_frame(&mut self) {
        self.from = self.now.pose;
    }

    /// Moves on to the share `done` (0 to 1) of the frame, in a substep of `h` seconds.
    pub fn step(&mut self, done: f64, h: f64) {
        self.before = self.now;
        self.now.pose = interpolated(&self.from, &self.to, done);
        let target = match self.command {
            Command::Width(width) => width.clamp(0.0, STROKE_M),
            Command::Close(_) => MINIMUM_GAP_M,
            Command::Grip(_) => self.now.opening_m,
        };
        let reach = 2.0 * FINGER_SPEED_M_S * h;
        self.now.opening_m += (target - self.now.opening_m).clamp(-reach, reach);
    }
}

/// The pose at the share `done` of the way.
fn interpolated(from: &Pose, to: &Pose, done: f64) -> Pose {
    // A slerp of opposite quaternions has no unique answer; none is needed within a frame.
    from.try_lerp_slerp(to, done, 1e-12).unwrap_or(*to)
}
