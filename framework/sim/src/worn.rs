//! The worn state: where a cap's vertices lie when it sits correctly on the head. It is the
//! canonical state of the category, and what a wearing is judged against.

use crate::object::{Object, Region, Symmetry};
use crate::surroundings::{Head, HeadSize, Surroundings};
use crate::world::{Settings, World};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::frames::CanonicalObject;
use seeone_core::{Pose, Similarity};

/// Clearance above the head at which the cap is let go, metres.
const LET_GO_M: f64 = 0.002;
/// It must have come to rest within this time, seconds.
const SETTLE_S: f64 = 8.0;
/// Largest angle between the hem's axis and the head's for a cap to sit, radians.
const LARGEST_TILT_RAD: f64 = 0.4;
/// A hem that rests so high that it would have to stretch by more than this share to come
/// down to the head's widest level is too tight: a closure gives 3 to 4 cm of 57.
const LARGEST_STRETCH: f64 = 0.10;

/// An object as worn on the head.
#[derive(Clone, Debug)]
pub struct Worn {
    /// Its vertices in the head frame, metres: v_t of the wearing metric.
    pub vertices: Vec<Point3<f64>>,
    /// Its largest vertex distance in this state, metres: d of every metric.
    pub diameter_m: f64,
    /// The same state in the unit cube.
    pub canonical: CanonicalObject,
    /// Canonical cube -> head frame, metres.
    pub canonical_to_head: Similarity,
}

/// Why an object has no worn state.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WornFault {
    /// It did not come to rest.
    #[error("the object did not come to rest on the head within {SETTLE_S} s")]
    Restless,
    /// It lies on the head askew, or fell off.
    #[error("the object does not sit on the head: it came to rest tilted by {0:.0} degrees")]
    Askew(f64),
    /// It sits on top of the head like a lid.
    #[error(
        "the object is too tight for the head: its hem would have to stretch by {:.0} % to \
         come down to where hats sit",
        100.0 * .0
    )]
    TooTight(f64),
}

/// Lowers `object` onto a head of medium size, level and with its brim to the front, lets
/// it go just above and waits until it rests.
///
/// # Errors
/// When it does not stay on the head, or does not fit it.
pub fn worn(object: &Object, settings: &Settings) -> Result<Worn, WornFault> {
    worn_on(object, HeadSize::MEDIUM, settings)
}

/// As [`worn`], on a head of another size.
///
/// # Errors
/// As [`worn`].
pub fn worn_on(object: &Object, size: HeadSize, settings: &Settings) -> Result<Worn, WornFault> {
    let head = Head { pose: Pose::identity(), size };
    let surroundings = Surroundings { head: Some(head), ..Surroundings::default() };
    let mut world = World::new(object, &template(object, size), surroundings, *settings);
    if !world.settle(SETTLE_S).at_rest {
        return Err(WornFault::Restless);
    }
    let vertices = world.vertices().to_vec();
    let tilt = tilt(object, &vertices);
    if tilt > LARGEST_TILT_RAD {
        return Err(WornFault::Askew(tilt.to_degrees()));
    }
    let stretch = stretch_to_sit(object, &vertices, size);
    if stretch > LARGEST_STRETCH {
        return Err(WornFault::TooTight(stretch));
    }
    let diameter_m = world.mesh().diameter();
    let (canonical, canonical_to_head) = canonical(object, &vertices);
    Ok(Worn { vertices, diameter_m, canonical, canonical_to_head })
}

/// The pose (object frame -> head frame) just above the head: hem level and centred, brim
/// along +y.
pub fn template(object: &Object, size: HeadSize) -> Pose {
    let hem = object.vertices_of(Region::Hem);
    let vertices = object.mesh().vertices();
    let infinite = Vector3::repeat(f64::INFINITY);
    let (low, high) = hem
        .iter()
        .map(|v| vertices[*v].coords)
        .fold((infinite, -infinite), |(low, high), v| (low.inf(&v), high.sup(&v)));
    let middle = if hem.is_empty() { Vector3::zeros() } else { (low + high) / 2.0 };
    let cranium = Head { pose: Pose::identity(), size }.cranium();
    let clearance = |z: f64| {
        let shift = Vector3::new(-middle.x, -middle.y, z);
        vertices
            .iter()
            .map(|v| cranium.signed_distance(&(v + shift)).0)
            .fold(f64::INFINITY, f64::min)
    };
    // From so high that nothing touches, down to the first contact.
    let (mut above, mut below) = (0.3, -0.2);
    while above - below > 1e-5 {
        let z = 0.5 * (above + below);
        if clearance(z) > LET_GO_M { above = z } else { below = z }
    }
    Pose::from_parts(Translation3::new(-middle.x, -middle.y, above), UnitQuaternion::identity())
}

/// Angle between the object's rest orientation and how its hem lies now, radians.
fn tilt(object: &Object, vertices: &[Point3<f64>]) -> f64 {
    let hem = object.vertices_of(Region::Hem);
    let normal = |points: &[Point3<f64>]| {
        let mean = hem.iter().map(|v| points[*v].coords).sum::<Vector3<f64>>() / hem.len() as f64;
        hem.windows(2)
            .map(|w| (points[w[0]].coords - mean).cross(&(points[w[1]].coords - mean)))
            .sum::<Vector3<f64>>()
    };
    if hem.is_empty() { 0.0 } else { normal(object.mesh().vertices()).angle(&normal(vertices)) }
}

/// By what share the hem, which lies at `vertices` in the head frame, would have to stretch
/// to come down to the head's widest level; none when it is there.
fn stretch_to_sit(object: &Object, vertices: &[Point3<f64>], size: HeadSize) -> f64 {
    let hem = object.vertices_of(Region::Hem);
    let height = hem.iter().map(|v| vertices[*v].z).sum::<f64>() / hem.len().max(1) as f64;
    // The cranium's girth at a share s of its height is sqrt(1 - s^2) of the widest.
    let share = (height / size.semi_axes_m().z).clamp(0.0, 0.999);
    1.0 / (1.0 - share * share).sqrt() - 1.0
}

/// Moves the worn state into the unit cube: centred, longest box edge 1.
fn canonical(object: &Object, vertices: &[Point3<f64>]) -> (CanonicalObject, Similarity) {
    let infinite = Vector3::repeat(f64::INFINITY);
    let (low, high) = vertices
        .iter()
        .fold((infinite, -infinite), |(low, high), v| (low.inf(&v.coords), high.sup(&v.coords)));
    let (centre, edge_m) = ((low + high) / 2.0, (high - low).max());
    let half = Vector3::repeat(0.5);
    let canonical = CanonicalObject {
        name: object.name().to_owned(),
        vertices: vertices.iter().map(|v| ((v.coords - centre) / edge_m + half).into()).collect(),
        triangles: object.mesh().triangles().to_vec(),
        edge_m,
        round: object.symmetry() == Symmetry::Round,
    };
    let to_head = Similarity::from_parts(
        Translation3::from(centre - half * edge_m),
        UnitQuaternion::identity(),
        edge_m,
    );
    (canonical, to_head)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::cap;

    #[test]
    fn a_cap_sits_on_the_head_and_fills_the_unit_cube() {
        let object = cap::named("cap-unseen-00").expect("a cap");
        let worn = worn(&object, &Settings::default()).expect("it sits");
        let mesh = worn.canonical.mesh().expect("a mesh");
        let (low, high) = mesh.bounds();
        assert!(((high - low).max() - 1.0).abs() < 1e-9);
        assert!(((low.coords + high.coords) / 2.0 - Vector3::repeat(0.5)).norm() < 1e-9);
        assert!((0.22..0.36).contains(&worn.diameter_m), "{}", worn.diameter_m);
        let brim = object.vertices_of(Region::Brim);
        let tip = brim.iter().map(|v| mesh.vertices()[*v].y).fold(0.0, f64::max);
        assert!(tip > 0.99, "the brim points along +y");
        for (v, c) in worn.vertices.iter().zip(mesh.vertices()) {
            assert!((worn.canonical_to_head * c - v).norm() < 1e-9);
        }
    }

    #[test]
    fn a_tight_cap_is_told_from_one_that_fits() {
        let settings = Settings::default();
        let narrow = cap::named("cap-unseen-08").expect("a cap");
        assert!(worn_on(&narrow, HeadSize::MEDIUM, &settings).is_ok());
        let fault = worn_on(&narrow, HeadSize::LARGE, &settings).expect_err("a tight cap");
        assert!(matches!(fault, WornFault::TooTight(share) if share > LARGEST_STRETCH));
        assert!(fault.to_string().contains("too tight"), "{fault}");
        let wide = cap::named("cap-unseen-02").expect("a cap");
        for (name, size) in HeadSize::NAMED {
            assert!(worn_on(&wide, size, &settings).is_ok(), "{name}");
        }
    }
}
