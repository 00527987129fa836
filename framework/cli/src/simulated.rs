//! The simulated cell as the composition root sees it: made from scene and object, shared
//! with the plugins, and read by the judge.

use anyhow::{Result, anyhow};
use nalgebra::Point3;
use seeone_core::Diagnostic;
use seeone_core::random::generator;
use seeone_core::{Pose, TriangleMesh};
use seeone_plugin::{Judge, Measure, PluginError, Verdict, World, WorldState};
use seeone_runtime::files::Scene;
use seeone_sim::WearError;
use seeone_sim::cell::{Cell, FRAME_S};
use seeone_sim::drop::Drop;
use seeone_sim::object::Object;
use seeone_sim::surroundings::{Frictions, Head, Surroundings};
use seeone_sim::world::Settings;
use seeone_sim::worn::{Worn, worn_on};
use std::sync::{Arc, Mutex, MutexGuard};

/// How long a released object may rock before the verdict, seconds.
const VERDICT_LIMIT_S: f64 = 6.0;
/// A tilt or yaw beyond this is told in the reason, degrees.
const ASKEW_DEG: f64 = 30.0;

/// A simulated cell and what its object looks like when it is worn.
pub struct SimulatedCell {
    /// Shared with the camera and robot plugins.
    pub cell: Arc<Mutex<Cell>>,
    head: Head,
    worn: Arc<Worn>,
}

impl SimulatedCell {
    /// Drops `object` into the scene and lets it come to rest.
    ///
    /// # Errors
    /// When the object cannot be worn at all, or the simulation diverged.
    pub fn drop(scene: &Scene, object: Object, seed: u64) -> Result<Self> {
        check(scene)?;
        let settings = Settings::default();
        let head = Head { pose: scene.head.pose, size: scene.head.size };
        let worn = worn_on(&object, head.size, &settings).map_err(|fault| {
            Diagnostic::new("O006", format!("object \"{}\": {fault}", object.name()))
                .hint("import it for another --head-circumference, or choose another object")
        })?;
        let surroundings = Surroundings {
            table: true,
            head: Some(head),
            hook: None,
            frictions: Frictions {
                table: scene.table.friction,
                head: scene.head.friction,
                ..Frictions::default()
            },
        };
        let centre = [scene.drop.centre.x, scene.drop.centre.y];
        let drop = Drop::draw(centre, &mut generator(seed, "drop"));
        let cell = Cell::after_drop(object, &drop, surroundings, settings)
            .map_err(|fault| anyhow!(fault))?;
        Ok(Self { cell: Arc::new(Mutex::new(cell)), head, worn: Arc::new(worn) })
    }

    /// Puts what was dropped into `other` in the place of this cell's object: plugins that hold a
    /// handle of this cell see it from then on, and the hand stays where it is.
    ///
    /// # Errors
    /// When either simulated cell broke down.
    pub fn exchange(&mut self, other: Self) -> Result<()> {
        let broken = || anyhow!("the simulated cell broke down");
        let mut here = self.cell.lock().map_err(|_| broken())?;
        let mut there = other.cell.lock().map_err(|_| broken())?;
        std::mem::swap(&mut *here, &mut *there);
        if let Some(hand) = there.world().hand() {
            here.place_hand(&hand.pose);
        }
        (self.head, self.worn) = (other.head, Arc::clone(&other.worn));
        Ok(())
    }

    /// The cell as plugins are given it.
    pub fn world(&self) -> Arc<dyn World> {
        Arc::new(SharedCell(Arc::clone(&self.cell)))
    }

    /// The judge of this cell.
    pub fn judge(&self) -> CellJudge {
        CellJudge {
            cell: SharedCell(Arc::clone(&self.cell)),
            head: self.head,
            worn: Arc::clone(&self.worn),
        }
    }

    /// The worn state on this cell's head, in `world`, metres.
    pub fn worn_vertices(&self) -> Vec<Point3<f64>> {
        self.worn.vertices.iter().map(|v| self.head.pose * v).collect()
    }
}

/// What the simulated world has one form of.
fn check(scene: &Scene) -> Result<(), Diagnostic> {
    if scene.table.height_m != 0.0 {
        let cause = format!("the simulated table's top is z = 0, not {} m", scene.table.height_m);
        return Err(Diagnostic::new("C030", cause).hint("move the robot's base instead"));
    }
    Ok(())
}

/// The cell, locked for as long as one call of it.
struct SharedCell(Arc<Mutex<Cell>>);

impl SharedCell {
    fn lock(&self) -> Result<MutexGuard<'_, Cell>, PluginError> {
        self.0.lock().map_err(|_| PluginError::Internal("the simulated cell broke down".into()))
    }
}

impl World for SharedCell {
    fn state(&self) -> Result<WorldState, PluginError> {
        let cell = self.lock()?;
        Ok(WorldState {
            time_s: cell.time_s(),
            frame_s: FRAME_S,
            opening_m: cell.opening_m(),
            fingers_move: cell.fingers_move(),
            pads_feel_load: cell.pads_feel_load(),
            load_n: cell.load_n(),
        })
    }

    fn place_hand(&self, pose: &Pose) -> Result<(), PluginError> {
        self.lock()?.place_hand(pose);
        Ok(())
    }

    fn advance(&self, pose: &Pose) -> Result<(), PluginError> {
        self.lock()?.advance(pose).map_err(PluginError::Internal)
    }

    fn close_fingers(&self, force_n: f64) -> Result<(), PluginError> {
        self.lock()?.close(force_n);
        Ok(())
    }

    fn open_fingers(&self, opening_m: f64) -> Result<(), PluginError> {
        self.lock()?.open(opening_m);
        Ok(())
    }

    fn surfaces(&self) -> Result<Vec<TriangleMesh>, PluginError> {
        Ok(self.lock()?.surfaces())
    }
}

/// Judges by the world's own vertices (method: Eq. 11 and 12).
pub struct CellJudge {
    cell: SharedCell,
    head: Head,
    worn: Arc<Worn>,
}

impl Judge for CellJudge {
    fn grasped(&mut self) -> Result<bool, PluginError> {
        self.cell.lock()?.holds_object().map_err(PluginError::Internal)
    }

    fn judge(&mut self, measure: Measure, grasped: bool) -> Result<Verdict, PluginError> {
        let Measure::Worn { tolerance_d } = measure;
        let (at_rest, reached) = {
            let mut cell = self.cell.lock()?;
            let at_rest = cell.settle(VERDICT_LIMIT_S).map_err(PluginError::Internal)?;
            let to_head = self.head.pose.inverse();
            (at_rest, cell.vertices().iter().map(|v| to_head * v).collect::<Vec<_>>())
        };
        let WearError { mean_m: error_m, mean_d: error_d, tilt_deg, nose_up_deg, yaw_deg } =
            WearError::of(&self.worn, &reached);
        let success = grasped && at_rest && error_d < tolerance_d;
        let placed =
            format!("{error_d:.3} d from worn, tilted {tilt_deg:.0}, turned {yaw_deg:.0} degrees");
        let reason = match (grasped, at_rest, success) {
            (false, ..) => "never held after the lift".into(),
            (true, false, _) => format!("did not come to rest: {placed}"),
            (true, true, true) => placed,
            (true, true, false) if error_d > 1.0 => format!("not on the head: {placed}"),
            (true, true, false) if tilt_deg > ASKEW_DEG || yaw_deg.abs() > ASKEW_DEG => {
                format!("on the head askew: {placed}")
            }
            (true, true, false) => format!("outside the tolerance: {placed}"),
        };
        Ok(Verdict {
            grasped,
            success,
            error_m: Some(error_m),
            error_d: Some(error_d),
            tilt_deg: Some(tilt_deg),
            nose_up_deg: Some(nose_up_deg),
            yaw_deg: Some(yaw_deg),
            reason,
        })
    }

    fn object(&self) -> Vec<[f64; 3]> {
        self.cell
            .lock()
            .map(|cell| cell.vertices().iter().map(|v| (*v).into()).collect())
            .unwrap_or_default()
    }
}
