//! The hand: moving, closing, holding, letting go.

use super::{FRAME_S, World};
use crate::grasp::Grasp;
use crate::hand::{Command, Fingers, Hand, HandState, MINIMUM_GAP_M};
use crate::shell::Momentum;
use nalgebra::Vector3;

/// Opening within this of the smallest gap counts as closed, metres.
const GAP_TOLERANCE_M: f64 = 1.0e-6;

impl World {
    /// Sets where the hand shall be at the end of the next frame, and how wide open unless
    /// it is closing or gripping. The first call puts it there at once.
    pub fn move_hand(&mut self, hand: &Hand) {
        match &mut self.fingers {
            Some(fingers) => {
                fingers.aim(&hand.pose);
                if let Command::Width(width) = &mut fingers.command {
                    *width = hand.opening_m;
                }
            }
            None => self.fingers = Some(Fingers::new(*hand)),
        }
    }

    /// Closes the fingers until each pad presses with `force_n`, or the smallest gap is
    /// reached; what is between the pads then is held. Without a hand it does nothing.
    pub fn close(&mut self, force_n: f64) {
        if let Some(fingers) = &mut self.fingers {
            fingers.command = Command::Close(force_n.max(0.0));
        }
    }

    /// Opens the fingers to `width_m`, letting go of everything at once.
    pub fn open(&mut self, width_m: f64) {
        self.release();
        if let Some(fingers) = &mut self.fingers {
            fingers.command = Command::Width(width_m);
        }
    }

    /// Takes the hand out of the world, letting go of everything.
    pub fn remove_hand(&mut self) {
        self.release();
        self.fingers = None;
    }

    /// What the gripper reports; all zero without a hand.
    pub fn hand_state(&self) -> HandState {
        let Some(fingers) = &self.fingers else { return HandState::default() };
        let normal_force_n = match fingers.command {
            Command::Grip(force) if self.grasp.is_some() => force,
            _ => self.pads.squeeze(FRAME_S),
        };
        HandState {
            opening_m: fingers.now.opening_m,
            normal_force_n,
            held_points: self.grasp.as_ref().map_or(0, Grasp::points),
            slip_m: self.grasp.as_ref().map_or(0.0, |g| g.slip_m(&self.shell, &fingers.now)),
            closed: matches!(fingers.command, Command::Grip(_)),
            load_n: self.grasp.as_ref().map_or_else(Vector3::zeros, Grasp::load_n),
        }
    }

    /// Stops closing fingers, and lets a grip go that cannot carry its load. `before` is
    /// the momentum at the frame's start, `given` what the surroundings added to it.
    pub(super) fn tend_grip(&mut self, before: &Momentum, given: &Momentum) {
        let Some(mut fingers) = self.fingers else { return };
        if let Command::Close(force_n) = fingers.command {
            let closed = fingers.now.opening_m <= MINIMUM_GAP_M + GAP_TOLERANCE_M;
            if closed || self.pads.squeeze(FRAME_S) >= force_n {
                fingers.command = Command::Grip(force_n);
                self.fingers = Some(fingers);
                let samples = self.pads.samples();
                let (hand, thickness_m) = (&fingers.now, self.thickness_m);
                self.grasp = Grasp::form(&mut self.shell, samples, hand, thickness_m, force_n);
            }
        } else if self.grasp.is_some() {
            let load = self.load_on_hand(before, given);
            let friction = self.surroundings.frictions.pad;
            let carried = |grasp: &mut Grasp| grasp.carries(&load, &fingers.now, friction, FRAME_S);
            if !self.grasp.as_mut().is_some_and(carried) {
                self.release();
            }
        }
    }

    /// What the hand gave the shell, per second of the last frame: the change of momentum
    /// that neither gravity nor drag nor the surroundings explain.
    fn load_on_hand(&self, before: &Momentum, given: &Momentum) -> Momentum {
        let after = self.shell.momentum();
        let weight = self.settings.gravity * self.shell.total_mass();
        let pull = self.shell.centre_of_mass().coords.cross(&weight);
        let drag = self.settings.velocity_damping;
        let load = |after: Vector3<f64>, before: Vector3<f64>, given: Vector3<f64>, weight| {
            (after - before - given) / FRAME_S - weight + (after + before) * (drag / 2.0)
        };
        Momentum {
            linear: load(after.linear, before.linear, given.linear, weight),
            angular: load(after.angular, before.angular, given.angular, pull),
        }
    }

    pub(super) fn release(&mut self) {
        if self.grasp.take().is_some() {
            self.shell.pin(&[]);
        }
    }
}
