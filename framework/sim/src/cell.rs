//! The simulated work cell: an object or several, a mat, a head, hooks, and the hand of whatever
//! arm is plugged in. Robot and camera plugins share it; the verdict reads it.
//!
//! Each object lives in a [`World`] of its own, with the same surroundings and the same hand:
//! objects do not touch each other. That is sound as long as they stay apart, so they are laid
//! apart, and the cell remembers whether two of them [ever met](Cell::met).

mod member;

use crate::depth_camera::look;
use crate::drop::Drop;
use crate::hand::{Hand, HandState};
use crate::object::Object;
use crate::scenery;
use crate::surroundings::Surroundings;
use crate::world::{PlacementFault, Settings, World};
use member::Member;
use nalgebra::{Point3, Vector3};
use rand::Rng;
use seeone_core::{DepthImage, Intrinsics, Pose, TriangleMesh};

pub use crate::world::FRAME_S;

/// How long an object may roll and rock after it was dropped, seconds.
const SETTLE_LIMIT_S: f64 = 6.0;
/// How long a lifted object is watched before it counts as grasped, seconds.
const HOLD_S: f64 = 1.0;
/// A grasped object hangs clear of the table by at least this, metres.
const CLEAR_M: f64 = 0.10;
/// Where the fingers stand before the first command, metres.
const OPENING_M: f64 = 0.03;
/// Fingers that move less than this in a frame have stopped, metres.
const STILL_M: f64 = 1.0e-6;
/// Objects that are dropped come to rest farther from each other than this, metres: room for
/// the hand between them.
const APART_M: f64 = 0.08;
/// How often an object that comes to rest nearer than that is dropped again.
const MOST_DROPS: usize = 20;
/// Objects whose vertices are nearer than this have met, metres: about an edge of their meshes.
const MET_M: f64 = 0.01;

/// A simulated work cell.
#[derive(Clone, Debug)]
pub struct Cell {
    /// At least one.
    members: Vec<Member>,
    /// Which of them the hand took last; the first until it took one.
    taken: usize,
    opening_m: f64,
    fingers_move: bool,
    met: bool,
}

impl Cell {
    /// A cell in which `object` was let go as `drop` says and has come to rest, or has had
    /// six seconds to.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn after_drop(
        object: Object,
        drop: &Drop,
        surroundings: Surroundings,
        settings: Settings,
    ) -> Result<Self, String> {
        let members = vec![dropped(object, drop, surroundings, settings)];
        let cell =
            Self { members, taken: 0, opening_m: OPENING_M, fingers_move: false, met: false };
        cell.whole().map(|()| cell)
    }

    /// Drops a further object over `centre_m` (`world`, metres), and again until it comes to
    /// rest apart from what lies there, before any hand has come.
    ///
    /// # Errors
    /// A sentence when the simulation diverged, or there is no room.
    pub fn drop_beside(
        &mut self,
        object: &Object,
        centre_m: [f64; 2],
        settings: Settings,
        rng: &mut impl Rng,
    ) -> Result<(), String> {
        for _ in 0..MOST_DROPS {
            let surroundings = self.world().surroundings().clone();
            let drop = Drop::draw(centre_m, rng);
            let member = dropped(object.clone(), &drop, surroundings, settings);
            member.world.fault().map_or(Ok(()), |fault| Err(fault.to_string()))?;
            if !self.members.iter().any(|other| member.is_near(other, APART_M)) {
                self.members.push(member);
                return Ok(());
            }
        }
        let [x, y] = centre_m;
        Err(format!("there is no room for {} about ({x}, {y}) m", object.name()))
    }

    pub(crate) fn whole(&self) -> Result<(), String> {
        let fault = self.members.iter().find_map(|member| member.world.fault());
        fault.map_or(Ok(()), |fault| Err(fault.to_string()))
    }

    /// The objects, in the order in which they were dropped.
    pub fn objects(&self) -> impl Iterator<Item = &Object> {
        self.members.iter().map(|member| &member.object)
    }

    /// The object that the hand took last; the first until it took one.
    pub fn object(&self) -> &Object {
        &self.members[self.taken].object
    }

    /// The world of the object that the hand took last, for whoever judges or draws it.
    pub fn world(&self) -> &World {
        &self.members[self.taken].world
    }

    pub(crate) fn world_mut(&mut self) -> &mut World {
        &mut self.members[self.taken].world
    }

    /// Seconds of simulated time.
    pub fn time_s(&self) -> f64 {
        // Worlds that were left alone while one was judged are behind.
        self.members.iter().map(|member| member.world.time()).fold(0.0, f64::max)
    }

    /// Whether two objects ever came so near to each other that they would have touched, which
    /// is not simulated.
    pub fn met(&self) -> bool {
        self.met
    }

    /// The names of the objects that hung when they were judged and hang no more, though nobody
    /// took them.
    pub fn fallen(&self) -> Vec<&str> {
        let hung = self.members.iter().filter(|member| member.hung);
        let fallen = hung.filter(|member| !member.world.hangs());
        fallen.map(|member| member.object.name()).collect()
    }

    /// Notes whether the object that the hand took last hangs now.
    pub(crate) fn note_hung(&mut self, hung: bool) {
        self.members[self.taken].hung = hung;
        self.note_met();
    }

    /// A noisy depth image from the pose `camera` of what stands in the cell: the table,
    /// the head, the hooks, the objects. The arm is expected to keep out of the picture.
    pub fn depth_image(
        &self,
        camera: &Pose,
        intrinsics: &Intrinsics,
        noise: &mut impl Rng,
    ) -> DepthImage {
        look(&self.surfaces(), camera, intrinsics, noise)
    }

    /// The surfaces, in `world`, of what stands in the cell: the table, the objects, the head,
    /// the hooks.
    pub fn surfaces(&self) -> Vec<TriangleMesh> {
        let mut meshes = self.object_meshes();
        meshes.extend(self.scenery_meshes());
        meshes
    }

    /// The objects' surfaces in `world`.
    pub fn object_meshes(&self) -> Vec<TriangleMesh> {
        self.members.iter().map(|member| member.world.mesh()).collect()
    }

    /// The surfaces, in `world`, of all but the objects: the table, the head, the hooks.
    pub fn scenery_meshes(&self) -> Vec<TriangleMesh> {
        let mut meshes = vec![scenery::table()];
        meshes.extend(self.head_mesh());
        meshes.extend(self.hook_meshes());
        meshes
    }

    /// The head's surface in `world`, when there is one.
    pub fn head_mesh(&self) -> Option<TriangleMesh> {
        self.world().surroundings().head.as_ref().map(scenery::head)
    }

    /// The hooks' surfaces in `world`, each with a piece of its wall.
    pub fn hook_meshes(&self) -> Vec<TriangleMesh> {
        self.world().surroundings().hooks.iter().map(scenery::hook).collect()
    }

    /// Puts the hand at a pose at once: where the arm is when the cell is set up.
    pub fn place_hand(&mut self, pose: &Pose) {
        let hand = Hand { pose: *pose, opening_m: self.opening_m };
        self.members.iter_mut().for_each(|member| member.world.move_hand(&hand));
    }

    /// Lays the object that the hand took last so that its vertices are at `vertices` (world,
    /// metres), at rest, as somebody does who sets it right; a grip is let go.
    ///
    /// # Errors
    /// When they are not as many as it has, or not finite.
    pub fn lay(&mut self, vertices: &[Point3<f64>]) -> Result<(), PlacementFault> {
        self.world_mut().set_vertices(vertices)
    }

    /// One frame of [`FRAME_S`], at whose end the hand is at `pose`.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn advance(&mut self, pose: &Pose) -> Result<(), String> {
        let before = self.opening_m();
        let hand = Hand { pose: *pose, opening_m: self.opening_m };
        self.members.iter_mut().for_each(|member| member.advance(&hand));
        self.fingers_move = (self.opening_m() - before).abs() > STILL_M;
        if let Some(held) = self.members.iter().position(Member::is_held) {
            self.taken = held;
            self.members[held].hung = false;
        }
        self.note_met();
        self.whole()
    }

    fn note_met(&mut self) {
        let mut pairs = (1..self.members.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        let near = |(i, j): (usize, usize)| self.members[i].is_near(&self.members[j], MET_M);
        self.met = self.met || pairs.any(near);
    }

    /// Closes the fingers until they press with `force_n`, over the coming frames.
    pub fn close(&mut self, force_n: f64) {
        self.members.iter_mut().for_each(|member| member.world.close(force_n));
    }

    /// Lets go at once and opens the fingers to `opening_m` over the coming frames.
    pub fn open(&mut self, opening_m: f64) {
        self.opening_m = opening_m;
        self.members.iter_mut().for_each(|member| member.world.open(opening_m));
    }

    /// Whether the fingers moved in the last frame.
    pub fn fingers_move(&self) -> bool {
        self.fingers_move
    }

    fn hand_states(&self) -> impl Iterator<Item = HandState> {
        self.members.iter().map(|member| member.world.hand_state())
    }

    /// Distance between the pads, metres: what keeps them apart most counts.
    pub fn opening_m(&self) -> f64 {
        self.hand_states().map(|state| state.opening_m).fold(0.0, f64::max)
    }

    /// What a gripper's own force sensing tells: the fingers stopped against something.
    pub fn pads_feel_load(&self) -> bool {
        self.hand_states().any(|state| state.closed && state.held_points > 0)
    }

    /// What the hand gives to what it holds, newtons in `world`: what a wrist that feels
    /// loads would tell. Zero when it holds nothing.
    pub fn load_n(&self) -> Vector3<f64> {
        self.hand_states().map(|state| state.load_n).sum()
    }

    /// Whether the lifted object is truly held: the hand stands still for a second, and
    /// then the object still hangs from it clear of the table (method: Eq. 11).
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn holds_object(&mut self) -> Result<bool, String> {
        let Some(pose) = self.world().hand().map(|hand| hand.pose) else { return Ok(false) };
        for _ in 0..(HOLD_S / FRAME_S).round() as usize {
            self.advance(&pose)?;
        }
        let lowest = self.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        Ok(self.world().hand_state().held_points > 0 && lowest > CLEAR_M)
    }

    /// The vertices in `world`, metres, of the object that the hand took last.
    pub fn vertices(&self) -> &[Point3<f64>] {
        self.world().vertices()
    }

    /// The vertices of all objects, one after another, in `world`, metres.
    pub fn all_vertices(&self) -> impl Iterator<Item = &Point3<f64>> {
        self.members.iter().flat_map(|member| member.world.vertices())
    }

    /// Lets the object that the hand took last settle without a hand's help for at most
    /// `limit_s` seconds; says whether it came to rest.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn settle(&mut self, limit_s: f64) -> Result<bool, String> {
        let settled = self.world_mut().settle(limit_s);
        self.whole().map(|()| settled.at_rest)
    }
}

/// An object that was let go as `drop` says and has come to rest, or has had six seconds to.
fn dropped(object: Object, drop: &Drop, surroundings: Surroundings, settings: Settings) -> Member {
    let mut world = drop.begin(&object, surroundings, settings);
    world.settle(SETTLE_LIMIT_S);
    Member::new(object, world)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::cap;
    use seeone_core::random::generator;

    fn a_cap() -> Object {
        cap::named("cap-train-003").expect("a cap")
    }

    fn lying() -> Cell {
        let table = Surroundings { table: true, ..Surroundings::default() };
        let drop = Drop::draw([0.4, 0.0], &mut generator(1, "drop"));
        Cell::after_drop(a_cap(), &drop, table, Settings::default()).expect("a cell")
    }

    #[test]
    fn objects_lie_apart_and_that_two_met_is_remembered() {
        let (mut cell, settings) = (lying(), Settings::default());
        let mut rng = generator(1, "beside");
        cell.drop_beside(&a_cap(), [0.4, 0.5], settings, &mut rng).expect("room");
        assert_eq!(cell.objects().count(), 2);
        assert_eq!(cell.surfaces().len(), 3);
        assert!(!cell.members[0].is_near(&cell.members[1], APART_M) && !cell.met());
        let full = cell.drop_beside(&a_cap(), [0.4, 0.5], settings, &mut rng);
        assert!(full.is_err_and(|why| why.contains("no room")));
        let there = cell.members[0].world.vertices().to_vec();
        cell.members[1].world.set_vertices(&there).expect("as many vertices");
        cell.note_hung(false);
        assert!(cell.met());
    }

    #[test]
    fn one_that_hung_and_hangs_no_more_has_fallen() {
        let mut cell = lying();
        assert!(cell.fallen().is_empty());
        cell.note_hung(true);
        assert_eq!(cell.fallen(), ["cap-train-003"]);
    }
}
