//! The planners' table in a configuration.

use seeone_collision::Margins;
use seeone_plugin::PluginError;
use serde::Deserialize;

/// Options of both planners.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotionConfig {
    /// Share of the joints' largest speed that is used, above 0 and at most 1.
    pub speed: f64,
    /// Seconds between samples.
    pub period_s: f64,
    /// Largest speed of the tool on straight lines, metres a second.
    pub line_speed_m_s: f64,
    /// Largest speed of the tool within [`Self::near_m`] of a key pose on a line.
    pub near_speed_m_s: f64,
    /// Speed of the tool on lines that end with contact, metres a second: the slower, the less
    /// it presses on before the load is felt.
    pub guarded_speed_m_s: f64,
    /// How near "near" is, metres.
    pub near_m: f64,
    /// Largest speed of the tool in free space, metres a second.
    pub transit_speed_m_s: f64,
    /// The same with something in the hand.
    pub held_speed_m_s: f64,
    /// Largest acceleration of the tool anywhere, metres a second squared: what hangs in the
    /// hand feels it.
    pub tool_acceleration_m_s2: f64,
    /// Distance of the poses along a line, metres.
    pub line_step_m: f64,
    /// Largest joint step between collision checks in free space, radians.
    pub joint_step_rad: f64,
    /// Distance that the arm keeps from obstacles, metres.
    pub clearance_m: f64,
    /// Within this distance of a key pose the fingers may touch obstacles, metres.
    pub finger_zone_m: f64,
    /// Distance that what is carried keeps from what it is not brought to, metres: it sways and
    /// sags, and no more of it is known than was seen.
    pub carried_clearance_m: f64,
    /// Branches of the arm that are tried for each key pose.
    pub branches: usize,
    /// Most extensions of the random trees for one transit: what is not found by then is not found
    /// with forty times as many.
    pub extensions: usize,
    /// Attempts to cut corners off a planned path.
    pub shortcuts: usize,
}

impl Default for MotionConfig {
    fn default() -> Self {
        Self {
            speed: 0.5,
            period_s: 0.008,
            line_speed_m_s: 0.25,
            near_speed_m_s: 0.1,
            guarded_speed_m_s: 0.05,
            near_m: 0.05,
            transit_speed_m_s: 1.0,
            held_speed_m_s: 0.5,
            tool_acceleration_m_s2: 1.5,
            line_step_m: 0.005,
            joint_step_rad: 0.05,
            clearance_m: 0.005,
            finger_zone_m: 0.15,
            carried_clearance_m: 0.03,
            branches: 8,
            extensions: 1000,
            shortcuts: 60,
        }
    }
}

impl MotionConfig {
    /// The distances that are kept.
    pub(crate) fn margins(&self) -> Margins {
        Margins { clearance_m: self.clearance_m, carried_m: self.carried_clearance_m }
    }

    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub(crate) fn checked(self) -> Result<Self, PluginError> {
        let positive = [
            ("speed", self.speed),
            ("period_s", self.period_s),
            ("line_speed_m_s", self.line_speed_m_s),
            ("near_speed_m_s", self.near_speed_m_s),
            ("guarded_speed_m_s", self.guarded_speed_m_s),
            ("transit_speed_m_s", self.transit_speed_m_s),
            ("held_speed_m_s", self.held_speed_m_s),
            ("tool_acceleration_m_s2", self.tool_acceleration_m_s2),
            ("line_step_m", self.line_step_m),
            ("joint_step_rad", self.joint_step_rad),
        ];
        let any = [
            ("near_m", self.near_m),
            ("clearance_m", self.clearance_m),
            ("finger_zone_m", self.finger_zone_m),
            ("carried_clearance_m", self.carried_clearance_m),
        ];
        let told = |cause: String| Err(PluginError::Configuration(cause));
        if let Some((name, value)) = positive.iter().find(|(_, v)| !(v.is_finite() && *v > 0.0)) {
            return told(format!("{name} must be positive, not {value}"));
        }
        if let Some((name, value)) = any.iter().find(|(_, v)| !(v.is_finite() && *v >= 0.0)) {
            return told(format!("{name} must not be negative, but is {value}"));
        }
        if self.speed > 1.0 {
            return told(format!(
                "speed is a share of the limit and at most 1, not {}",
                self.speed
            ));
        }
        if self.branches == 0 {
            return told("branches must be at least 1".into());
        }
        Ok(self)
    }
}
