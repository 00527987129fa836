//! Whether an object hangs on a hook by itself.

use crate::cell::Cell;
use crate::surroundings::Hook;
use crate::world::{FRAME_S, World};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::fmt;

/// How long a released object may swing, seconds.
const SETTLE_S: f64 = 6.0;
/// How long it then has to stay, seconds, ...
const STAY_S: f64 = 3.0;
/// ... shaken to the sides in the last one, m/s2: what is only balanced falls.
const SHAKE_S: f64 = 1.0;
const SHAKE_M_S2: f64 = 0.5;
/// Shakes a second.
const SHAKE_HZ: f64 = 2.0;
/// Nearer to the peg than this it touches it, metres: half a layer of fabric.
const TOUCH_M: f64 = 2.0e-3;
/// What hangs is farther from the table than this, metres.
const CLEAR_M: f64 = 5.0e-3;
/// What hangs still keeps its centre of mass within this for a second, metres. Its speed is
/// not asked for: fabric that is wedged on the peg may shiver in place.
const STILL_M: f64 = 5.0e-3;
const STILL_S: f64 = 1.0;

/// What became of an object that was to hang on the hook.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hanging {
    /// There is no hook.
    NoHook,
    /// The hand has not let go of it.
    InHand,
    /// It lies on the table, or almost.
    OnTable,
    /// It swings still.
    Swinging,
    /// It touches something, but not the peg.
    OffPeg,
    /// It hangs.
    Hung {
        /// Height of its lowest point over the table, metres.
        clear_m: f64,
    },
}

impl fmt::Display for Hanging {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoHook => to.write_str("there is no hook"),
            Self::InHand => to.write_str("still in the hand"),
            Self::OnTable => to.write_str("not on the hook: it lies on the table"),
            Self::Swinging => to.write_str("did not come to rest"),
            Self::OffPeg => to.write_str("not on the hook: it does not touch the peg"),
            Self::Hung { clear_m } => write!(to, "hangs {:.0} mm over the table", clear_m * 1e3),
        }
    }
}

impl Cell {
    /// Takes an empty hand away, lets the object come to rest, waits for three seconds, the
    /// last of them shaken, and says where it then stays. From a hand that holds it
    /// nothing is taken.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn hanging(&mut self) -> Result<Hanging, String> {
        let world = self.world_mut();
        let Some(along) = nearest_wall(world) else { return Ok(Hanging::NoHook) };
        if world.hand_state().held_points > 0 {
            return Ok(Hanging::InHand);
        }
        world.remove_hand();
        world.settle(SETTLE_S);
        wait(world, &along);
        world.settle(SETTLE_S);
        let still = keeps_still(world);
        let (clear_m, on_peg) = (world.clear_m(), world.touches_peg());
        self.note_hung(clear_m > CLEAR_M && still && on_peg);
        self.whole()?;
        Ok(match (clear_m > CLEAR_M, still, on_peg) {
            (false, ..) => Hanging::OnTable,
            (true, false, _) => Hanging::Swinging,
            (true, true, false) => Hanging::OffPeg,
            (true, true, true) => Hanging::Hung { clear_m },
        })
    }
}

impl World {
    /// Height of the object's lowest point over the table, metres.
    fn clear_m(&self) -> f64 {
        self.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min)
    }

    fn touches_peg(&self) -> bool {
        self.min_signed_distance_to_peg().is_some_and(|gap| gap < TOUCH_M)
    }

    /// Whether the object is on a peg and clear of the table now.
    pub(crate) fn hangs(&self) -> bool {
        self.clear_m() > CLEAR_M && self.touches_peg()
    }
}

/// The direction along the wall of the hook that is nearest to the object; none without a hook.
fn nearest_wall(world: &World) -> Option<Vector3<f64>> {
    let place = world.centre_of_mass();
    let away = |hook: &&Hook| (hook.tip() - place).norm();
    let nearest = world.surroundings().hooks.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.map(|hook| hook.pose.rotation * Vector3::x())
}

/// Whether the object is where it was for the second to come.
fn keeps_still(world: &mut World) -> bool {
    let place = world.centre_of_mass();
    (0..frames(STILL_S)).all(|_| {
        world.advance();
        (world.centre_of_mass() - place).norm() < STILL_M
    })
}

fn frames(seconds: f64) -> usize {
    (seconds / FRAME_S).round() as usize
}

/// Waits, and shakes along `side`, a unit vector along the wall.
fn wait(world: &mut World, side: &Vector3<f64>) {
    let gravity = world.gravity();
    for _ in 0..frames(STAY_S - SHAKE_S) {
        world.advance();
    }
    for frame in 0..frames(SHAKE_S) {
        let way = (frame as f64 * FRAME_S * SHAKE_HZ * TAU).sin().signum();
        world.set_gravity(gravity + side * (SHAKE_M_S2 * way));
        world.advance();
    }
    world.set_gravity(gravity);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::cap;
    use crate::drop::Drop;
    use crate::expert::VisorGrasp;
    use crate::object::Region;
    use crate::surroundings::Surroundings;
    use crate::world::Settings;
    use nalgebra::{Rotation3, Translation3, UnitQuaternion};
    use seeone_core::Pose;
    use seeone_core::random::generator;

    /// A cap that lies on the table before a hook.
    fn lying() -> Cell {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
        let hook = Hook::coat(Pose::from_parts(Translation3::new(0.3, 0.6, 0.4), turn));
        let around = Surroundings { table: true, hooks: vec![hook], ..Surroundings::default() };
        let object = cap::named("cap-train-003").expect("a cap");
        let drop = Drop::draw([0.3, 0.0], &mut generator(1, "drop"));
        Cell::after_drop(object, &drop, around, Settings::default()).expect("a cell")
    }

    /// Lets the cap go with its opening to the wall, the hem below its visor so far from the
    /// peg: to the side and above, metres.
    fn let_go(cell: &mut Cell, beside: f64, above: f64) {
        let hook = cell.world().surroundings().hooks[0];
        let mesh = cell.object().mesh().clone();
        let hem = cell.object().vertices_of(Region::Hem).into_iter().map(|v| mesh.vertices()[v]);
        let front = hem.max_by(|a, b| a.y.total_cmp(&b.y)).expect("a hem");
        let axes = [-Vector3::x(), Vector3::z(), Vector3::y()];
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_basis_unchecked(&axes));
        let over = hook.peg.tip() * 0.4 + Vector3::new(beside, 0.0, above);
        let placed = hook.pose * Pose::from_parts((over - turn * front).into(), turn);
        let vertices: Vec<_> = mesh.vertices().iter().map(|v| placed * v).collect();
        cell.world_mut().set_vertices(&vertices).expect("as many vertices");
    }

    #[test]
    fn a_cap_over_the_peg_hangs() {
        let mut cell = lying();
        let_go(&mut cell, 0.0, 0.02);
        let hanging = cell.hanging().expect("sound physics");
        assert!(matches!(hanging, Hanging::Hung { clear_m } if clear_m > 0.1), "{hanging}");
        assert_eq!(cell.world().gravity(), Settings::default().gravity);
    }

    #[test]
    fn a_cap_beside_the_peg_or_on_the_table_does_not_hang() {
        let mut cell = lying();
        assert_eq!(cell.clone().hanging(), Ok(Hanging::OnTable));
        let_go(&mut cell, 0.2, 0.02);
        assert_eq!(cell.hanging(), Ok(Hanging::OnTable));
    }

    #[test]
    fn a_cap_in_the_hand_does_not_hang() {
        let mut cell = lying();
        let_go(&mut cell, 0.0, 0.02);
        let grasp = VisorGrasp::of(cell.object(), 0.0).expect("a visor");
        let tool = grasp.tool_on(cell.vertices());
        cell.place_hand(&tool);
        cell.world_mut().set_gravity(Vector3::zeros());
        cell.close(140.0);
        for _ in 0..40 {
            cell.advance(&tool).expect("sound physics");
        }
        assert!(cell.pads_feel_load());
        assert_eq!(cell.hanging(), Ok(Hanging::InHand));
        assert!(cell.world().hand().is_some(), "from a hand that holds nothing is taken");
    }
}
