//! The judge of a simulated cell: it reads the world's own vertices and contacts, and knows
//! no plan.

use crate::shared_cell::SharedCell;
use seeone_core::Pose;
use seeone_plugin::{Judge, Measure, PluginError, Verdict};
use seeone_runtime::files::Scene;
use seeone_sim::surroundings::Head;
use seeone_sim::worn::Worn;
use seeone_sim::{Hanging, WearError};
use std::sync::Arc;

/// How long a released object may rock before the verdict, seconds.
const VERDICT_LIMIT_S: f64 = 6.0;
/// A tilt or yaw beyond this is told in the reason, degrees.
const ASKEW_DEG: f64 = 30.0;
/// Why an object that was never taken is nowhere well.
const NEVER_HELD: &str = "never held after the lift";

/// A head, and what the cell's object looks like when it is worn there.
pub struct Wearing {
    /// The head.
    pub head: Head,
    /// The object on it, in the head frame.
    pub worn: Worn,
}

/// Judges by the world (method: Eq. 11 and 12).
pub struct CellJudge {
    cell: SharedCell,
    scene: Scene,
    wearing: Option<Arc<Wearing>>,
}

impl CellJudge {
    /// The judge of `cell`, which was made from `scene`; `wearing` where that has a head.
    pub fn new(cell: SharedCell, scene: Scene, wearing: Option<Arc<Wearing>>) -> Self {
        Self { cell, scene, wearing }
    }

    fn worn(&self, tolerance_d: f64, grasped: bool) -> Result<Verdict, PluginError> {
        let Wearing { head, worn } = self.wearing.as_deref().ok_or_else(|| missing("head"))?;
        let (at_rest, reached) = {
            let mut cell = self.cell.lock()?;
            let at_rest = cell.settle(VERDICT_LIMIT_S).map_err(PluginError::Internal)?;
            let to_head = head.pose.inverse();
            (at_rest, cell.vertices().iter().map(|v| to_head * v).collect::<Vec<_>>())
        };
        let WearError { mean_m: error_m, mean_d: error_d, tilt_deg, nose_up_deg, yaw_deg } =
            WearError::of(worn, &reached);
        let success = grasped && at_rest && error_d < tolerance_d;
        let placed =
            format!("{error_d:.3} d from worn, tilted {tilt_deg:.0}, turned {yaw_deg:.0} degrees");
        let reason = match (grasped, at_rest, success) {
            (false, ..) => NEVER_HELD.into(),
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

    fn hung(&self, grasped: bool) -> Result<Verdict, PluginError> {
        let mut cell = self.cell.lock()?;
        let hanging = cell.hanging().map_err(PluginError::Internal)?;
        let (fallen, mut told) = (cell.fallen(), hanging.to_string());
        let sound = fallen.is_empty() && !cell.met();
        if !fallen.is_empty() {
            told += &format!("; fallen off since: {}", fallen.join(", "));
        }
        if cell.met() {
            told += "; two objects met, and contact between objects is not simulated";
        }
        let success = grasped && sound && matches!(hanging, Hanging::Hung { .. });
        Ok(verdict(grasped, success, told))
    }

    fn held(&self, frame: &str, within_m: f64, grasped: bool) -> Result<Verdict, PluginError> {
        let place: Pose = self.scene.frame(frame).ok_or_else(|| missing(frame))?;
        let mut cell = self.cell.lock()?;
        let held = cell.holds_object().map_err(PluginError::Internal)?;
        let off_m = (cell.world().centre_of_mass().coords - place.translation.vector).norm();
        let reason = match held {
            true => format!("held {:.0} mm from {frame}", off_m * 1e3),
            false => "not in the hand".into(),
        };
        Ok(verdict(grasped, grasped && held && off_m < within_m, reason))
    }
}

/// A verdict on anything but wearing.
fn verdict(grasped: bool, success: bool, placed: String) -> Verdict {
    let reason = if grasped { placed } else { NEVER_HELD.into() };
    Verdict { grasped, success, reason, ..Verdict::default() }
}

fn missing(frame: &str) -> PluginError {
    PluginError::Input(format!("the scene has no {frame}"))
}

impl Judge for CellJudge {
    fn grasped(&mut self) -> Result<bool, PluginError> {
        self.cell.lock()?.holds_object().map_err(PluginError::Internal)
    }

    fn judge(&mut self, measure: &Measure, grasped: bool) -> Result<Verdict, PluginError> {
        match measure {
            Measure::Worn { tolerance_d } => self.worn(*tolerance_d, grasped),
            Measure::Hung => self.hung(grasped),
            Measure::Held { frame, within_m } => self.held(frame, *within_m, grasped),
        }
    }

    fn object(&self) -> Vec<[f64; 3]> {
        self.cell
            .lock()
            .map(|cell| cell.all_vertices().map(|v| (*v).into()).collect())
            .unwrap_or_default()
    }
}
