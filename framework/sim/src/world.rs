//! One deformable object, its surroundings and a gripper, advanced frame by frame.

mod fault;
mod grip;
mod placement;
mod report;
mod settings;
mod settle;

pub use fault::{PlacementFault, WorldFault};
pub use settings::Settings;
pub use settle::{Rest, Settled};

use crate::contact::pads::Pads;
use crate::contact::{Bodies, Sample};
use crate::grasp::Grasp;
use crate::hand::Fingers;
use crate::object::Object;
use crate::self_contact::SelfContact;
use crate::shell::{Momentum, Shell};
use crate::surroundings::Surroundings;
use nalgebra::Vector3;
use seeone_core::{Pose, TriangleMesh};

/// Length of a frame, s.
pub const FRAME_S: f64 = 1.0 / 60.0;

/// A simulated world. Same start, same calls, same bytes.
#[derive(Clone, Debug)]
pub struct World {
    shell: Shell,
    rest: TriangleMesh,
    thickness_m: f64,
    surroundings: Surroundings,
    bodies: Bodies,
    settings: Settings,
    self_contact: SelfContact,
    pads: Pads,
    fingers: Option<Fingers>,
    grasp: Option<Grasp>,
    /// Forces from outside: on which vertex, N in world.
    pushes: Vec<(usize, Vector3<f64>)>,
    frames: u64,
    fault: Option<WorldFault>,
}

impl World {
    /// A world with `object` at rest at `placed` (object frame -> world) and no hand.
    pub fn new(
        object: &Object,
        placed: &Pose,
        surroundings: Surroundings,
        settings: Settings,
    ) -> Self {
        let mesh = object.mesh();
        let samples = Sample::all(mesh.triangles(), mesh.vertices().len());
        let used = object.regions().iter().map(|r| object.materials()[r.index()].thickness_m);
        Self {
            shell: Shell::new(object, placed),
            rest: mesh.clone(),
            thickness_m: used.fold(0.0, f64::max),
            bodies: Bodies::new(surroundings.bodies(), &samples),
            surroundings,
            settings,
            self_contact: SelfContact::new(mesh),
            pads: Pads::new(samples),
            fingers: None,
            grasp: None,
            pushes: Vec::new(),
            frames: 0,
            fault: None,
        }
    }

    /// Advances by one frame of 1/60 s. After a fault it does nothing.
    pub fn advance(&mut self) {
        if self.fault.is_some() {
            return;
        }
        let substeps = self.settings.substeps.max(1);
        let h = FRAME_S / substeps as f64;
        let last_whole = self.shell.position.clone();
        let before = self.shell.momentum();
        if let Some(fingers) = &mut self.fingers {
            fingers.begin_frame();
            self.pads.begin_frame(&self.shell, fingers);
        }
        self.bodies.begin_frame(&self.shell);
        let (mut given, mut rolling) = (Momentum::zero(), 0.0);
        for substep in 1..=substeps {
            rolling += self.substep(substep as f64 / substeps as f64, h, &mut given);
        }
        self.frames += 1;
        if !self.shell.is_finite() {
            self.fault = Some(WorldFault::Diverged { seconds: self.time() });
            self.release();
            self.shell.rest_at(&last_whole);
            return;
        }
        if self.grasp.is_none() {
            self.shell.brake_spin(rolling);
        }
        self.tend_grip(&before, &given);
    }

    /// One substep of `h` seconds, after which the share `done` of the frame is over. Adds what
    /// the surroundings gave the shell to `given`, and tells what rolling may take from its
    /// spin, N m s.
    fn substep(&mut self, done: f64, h: f64, given: &mut Momentum) -> f64 {
        let Self { shell, settings, surroundings, fingers, grasp, pushes, .. } = self;
        shell.predict(h, &settings.gravity, settings.velocity_damping);
        placement::push(shell, pushes, h, given);
        if let Some(fingers) = fingers {
            fingers.step(done, h);
            if let Some(grasp) = grasp {
                grasp.carry(shell, fingers, h);
            }
        }
        shell.solve(h);
        if settings.self_contact {
            let frame = shell.frame();
            let Shell { position, previous, inverse_mass, .. } = shell;
            self.self_contact.solve(&frame, position, previous, inverse_mass, h);
        }
        if let Some(fingers) = fingers {
            self.pads.solve(shell, fingers, surroundings.frictions.pad, h);
        }
        let rolling = self.bodies.solve(shell, h, given);
        if let (Some(fingers), Some(grasp)) = (fingers, grasp) {
            grasp.draw(shell, &fingers.now, h);
        }
        shell.finish(h);
        rolling
    }
}
