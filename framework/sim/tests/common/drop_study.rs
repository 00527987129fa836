//! Seeded drops of a cap, each followed to rest and then put back on the head.

use nalgebra::Point3;
use seeone_core::random::generator;
use seeone_sim::drop::Drop;
use seeone_sim::rigid_fit::rigid_fit;
use seeone_sim::world::{FRAME_S, Rest};
use seeone_sim::worn::{template, worn};
use seeone_sim::{Head, HeadSize, Object, Region, Settings, Surroundings, World};

/// A drop that lasts longer than this counts as never at rest, s.
pub const LIMIT_S: f64 = 6.0;

/// What became of one drop.
#[derive(Clone, Debug)]
pub struct Outcome {
    pub cap: String,
    pub drop: u64,
    pub finite: bool,
    /// Lowest vertex of all frames over the table, metres.
    pub lowest_m: f64,
    /// When its deformation had come to rest for 0.25 s, s; `None` when it had not in time.
    pub shape_rest_s: Option<f64>,
    /// When all of its motion had.
    pub rest_s: Option<f64>,
    /// Root mean square speed at the end, m/s.
    pub speed_m_s: f64,
    pub strain_p99: f64,
    /// Root mean square hinge error of a rigid visor, degrees; 0 for a soft brim, which
    /// droops as it should.
    pub brim_deg: f64,
    pub crossings: usize,
    /// Mean distance of the vertices from the worn state after this drop and a new
    /// settling on the head, metres; `None` when the cap does not come to rest on it.
    pub worn_again_m: Option<f64>,
    /// The same with the best rigid motion taken out: of the shape alone.
    pub shape_again_m: Option<f64>,
}

impl Outcome {
    /// Whether it came to rest in time, whole, on top of the table and in its own shape.
    pub fn keeps_every_bar(&self) -> bool {
        self.finite
            && self.lowest_m > -1e-4
            && self.rest_s.is_some()
            && self.strain_p99 < 0.05
            && self.brim_deg < 2.0
            && self.crossings == 0
            && self.shape_again_m.is_some_and(|m| m < 0.005)
    }
}

/// Drops `cap` from the seeds 1 to `drops` and looks at each.
pub fn study(cap: &Object, drops: u64, settings: &Settings) -> Vec<Outcome> {
    let before = worn(cap, settings).ok().map(|w| w.vertices);
    (1..=drops).map(|seed| one(cap, seed, settings, before.as_deref())).collect()
}

/// Drops `cap` from one seed; `worn` are its vertices on the head.
pub fn one(cap: &Object, seed: u64, settings: &Settings, worn: Option<&[Point3<f64>]>) -> Outcome {
    let table = Surroundings { table: true, ..Surroundings::default() };
    let drop = Drop::draw([0.0; 2], &mut generator(seed, cap.name()));
    let mut world = drop.begin(cap, table, *settings);
    let (mut lowest_m, mut shape_rest_s, mut rest_s) = (f64::INFINITY, None, None);
    let mut rest = Rest::default();
    for frame in 1..=(LIMIT_S / FRAME_S).round() as usize {
        world.advance();
        lowest_m = world.vertices().iter().map(|p| p.z).fold(lowest_m, f64::min);
        rest.look(&world);
        let now = Some(frame as f64 * FRAME_S);
        if rest.of_shape() {
            shape_rest_s = shape_rest_s.or(now);
        }
        if rest.of_all() {
            rest_s = now;
            break;
        }
    }
    let visor = cap.materials()[Region::Brim.index()].is_rigid();
    let again = worn.and_then(|w| worn_again(cap, world.vertices(), settings, w));
    Outcome {
        cap: cap.name().to_owned(),
        drop: seed,
        finite: world.fault().is_none(),
        lowest_m,
        shape_rest_s,
        rest_s,
        speed_m_s: world.rms_speed(),
        strain_p99: world.strain_quantile(0.99),
        brim_deg: if visor { world.hinge_error(Region::Brim).to_degrees() } else { 0.0 },
        crossings: world.crossings(),
        worn_again_m: again.map(|a| a.0),
        shape_again_m: again.map(|a| a.1),
    }
}

/// Puts the cap as it lies, turned back to its template pose, onto the head; lets it settle
/// and compares.
fn worn_again(
    cap: &Object,
    rested: &[Point3<f64>],
    settings: &Settings,
    worn: &[Point3<f64>],
) -> Option<(f64, f64)> {
    let head = Some(Head::medium(seeone_core::Pose::identity()));
    let surroundings = Surroundings { head, ..Surroundings::default() };
    let mut world = World::new(cap, &template(cap, HeadSize::MEDIUM), surroundings, *settings);
    let back = rigid_fit(rested, world.vertices());
    let placed: Vec<_> = rested.iter().map(|p| back * p).collect();
    world.set_vertices(&placed).ok()?;
    let settled = world.settle(LIMIT_S);
    let align = rigid_fit(world.vertices(), worn);
    let mean = |moved: &dyn Fn(&Point3<f64>) -> Point3<f64>| {
        let pairs = world.vertices().iter().zip(worn);
        pairs.map(|(a, b)| (moved(a) - b).norm()).sum::<f64>() / worn.len() as f64
    };
    settled.at_rest.then(|| (mean(&|p| *p), mean(&|p| align * p)))
}
