//! Convex bodies and the distances between them.

use crate::segment::Segment;
use nalgebra::{Point3, Unit, Vector3};
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query::ClosestPoints;
use parry3d_f64::query::details::{
    closest_points_support_map_support_map, distance_support_map_support_map,
};
use parry3d_f64::shape::SupportMap;
use seeone_core::Pose;
use seeone_core::robot::Shape;

/// A convex body about its own centre.
#[derive(Clone, Debug, PartialEq)]
enum Core {
    /// A line along z of half this length; zero for a point.
    Segment(f64),
    /// A box with these half edges.
    Box(Vector3<f64>),
    /// A cylinder along z.
    Cylinder { radius: f64, half: f64 },
    /// An ellipsoid with these semi-axes.
    Ellipsoid(Vector3<f64>),
    /// The convex hull of some points, at least one.
    Hull(Vec<Vector3<f64>>),
}

/// A convex body grown by a radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Convex {
    core: Core,
    radius: f64,
    /// Where in the body's frame the capsule's middle is that covers it ...
    cover_middle: Point3<f64>,
    /// ... which lies along z with this half length ...
    cover_half: f64,
    /// ... and this radius. Two of those are compared in a twentieth of the time.
    cover_radius: f64,
}

/// Where two bodies are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Gap {
    /// Metres; negative when they overlap by so much.
    pub(crate) distance_m: f64,
    /// From the first to the second.
    pub(crate) normal: Unit<Vector3<f64>>,
    /// On the first and on the second.
    pub(crate) points: [Point3<f64>; 2],
}

impl Convex {
    fn new(core: Core, radius: f64) -> Self {
        let (middle, half, girth) = match &core {
            Core::Segment(half) => (Point3::origin(), *half, 0.0),
            Core::Box(half) => (Point3::origin(), half.z, half.x.hypot(half.y)),
            Core::Cylinder { radius, half } => (Point3::origin(), *half, *radius),
            Core::Ellipsoid(semi_axes) => (Point3::origin(), 0.0, semi_axes.amax()),
            Core::Hull(points) => {
                let middle =
                    Point3::from(points.iter().sum::<Vector3<f64>>() / points.len() as f64);
                let far = |p: &Vector3<f64>| (p - middle.coords).norm();
                (middle, 0.0, points.iter().map(far).fold(0.0, f64::max))
            }
        };
        Self { core, radius, cover_middle: middle, cover_half: half, cover_radius: girth + radius }
    }

    /// A ball.
    pub fn ball(radius_m: f64) -> Self {
        Self::new(Core::Segment(0.0), radius_m)
    }

    /// An ellipsoid with these semi-axes, metres.
    pub fn ellipsoid(semi_axes_m: Vector3<f64>) -> Self {
        Self::new(Core::Ellipsoid(semi_axes_m), 0.0)
    }

    /// The convex hull of points, metres; `None` of none.
    pub fn hull(points: &[Point3<f64>]) -> Option<Self> {
        let points: Vec<Vector3<f64>> = points.iter().map(|p| p.coords).collect();
        (!points.is_empty()).then(|| Self::new(Core::Hull(points), 0.0))
    }

    /// The body at a pose, in the frame in which all others are.
    pub fn at(&self, pose: Pose) -> Placed<'_> {
        let half = pose.rotation * Vector3::new(0.0, 0.0, self.cover_half);
        Placed { shape: self, cover: Segment { middle: pose * self.cover_middle, half }, pose }
    }

    /// Whether its cover is itself.
    fn is_cover(&self) -> bool {
        matches!(self.core, Core::Segment(_))
    }
}

/// A body at its place.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    shape: &'a Convex,
    pose: Pose,
    /// The line of the capsule that covers it.
    cover: Segment,
}

impl Placed<'_> {
    /// Its lowest point along the frame's z.
    pub fn lowest(&self) -> Point3<f64> {
        let down = self.pose.rotation.inverse_transform_vector(&-Vector3::z());
        let on_core = self.pose * Point3::from(self.shape.core.support(&down));
        on_core - Vector3::z() * self.shape.radius
    }

    /// Height below which none of it is.
    pub(crate) fn floor(&self) -> f64 {
        self.cover.middle.z - self.cover.half.z.abs() - self.shape.cover_radius
    }

    /// Distance from another body, metres; negative by the grown radii at most when they
    /// overlap.
    pub fn distance(&self, other: &Placed) -> f64 {
        if self.shape.is_cover() && other.shape.is_cover() {
            return self.cover_distance(other);
        }
        let relative = parry_pose(&self.pose.inv_mul(&other.pose));
        let apart =
            distance_support_map_support_map(&relative, &self.shape.core, &other.shape.core);
        apart - self.shape.radius - other.shape.radius
    }

    /// By how much two bodies are nearer than `wanted_m`; `None` when they are not.
    pub(crate) fn lack(&self, other: &Placed, wanted_m: f64) -> Option<f64> {
        if self.is_beyond(other, wanted_m) {
            return None;
        }
        let lack = wanted_m - self.distance(other);
        (lack > 0.0).then_some(lack)
    }

    /// Where they are nearest, if they are not further apart than `most_m`. Of bodies that
    /// overlap by more than their grown radii nobody knows where.
    pub(crate) fn gap(&self, other: &Placed, most_m: f64) -> Option<Gap> {
        if self.is_beyond(other, most_m) {
            return None;
        }
        let (radius, other_radius) = (self.shape.radius, other.shape.radius);
        let (on_core, on_other) = if self.shape.is_cover() && other.shape.is_cover() {
            self.cover.nearest(&other.cover)
        } else {
            let relative = parry_pose(&self.pose.inv_mul(&other.pose));
            let reach = most_m + radius + other_radius;
            let (core, other_core) = (&self.shape.core, &other.shape.core);
            match closest_points_support_map_support_map(&relative, core, other_core, reach) {
                ClosestPoints::WithinMargin(a, b) => {
                    let point = |v: Vector| Point3::new(v.x, v.y, v.z);
                    (self.pose * point(a), other.pose * point(b))
                }
                ClosestPoints::Intersecting | ClosestPoints::Disjoint => return None,
            }
        };
        let (normal, apart) = Unit::try_new_and_get(on_other - on_core, 1e-9)?;
        Some(Gap {
            distance_m: apart - radius - other_radius,
            normal,
            points: [
                on_core + normal.into_inner() * radius,
                on_other - normal.into_inner() * other_radius,
            ],
        })
    }

    /// Whether simpler bodies about them say already that they are not nearer than `most_m`.
    fn is_beyond(&self, other: &Placed, most_m: f64) -> bool {
        self.box_distance(other) >= most_m
            || other.box_distance(self) >= most_m
            || self.cover_distance(other) >= most_m
    }

    /// The distance of the capsules that cover them, which is never larger than their own.
    fn cover_distance(&self, other: &Placed) -> f64 {
        let (a, b) = self.cover.nearest(&other.cover);
        (a - b).norm() - self.shape.cover_radius - other.shape.cover_radius
    }

    /// Of a box: the distance from the cover of the other, its line taken for its bounding box
    /// in this box's frame. Never larger than their own.
    fn box_distance(&self, other: &Placed) -> f64 {
        let Core::Box(half) = &self.shape.core else { return f64::NEG_INFINITY };
        let middle = self.pose.inverse_transform_point(&other.cover.middle);
        let extent = self.pose.inverse_transform_vector(&other.cover.half);
        let gaps = middle.coords.abs() - half - extent.abs();
        gaps.map(|gap| gap.max(0.0)).norm() - other.shape.cover_radius
    }
}

impl From<&Shape> for Convex {
    fn from(shape: &Shape) -> Self {
        match *shape {
            Shape::Box { half_m } => Self::new(Core::Box(half_m), 0.0),
            Shape::Cylinder { radius_m, length_m } => {
                Self::new(Core::Cylinder { radius: radius_m, half: 0.5 * length_m }, 0.0)
            }
            Shape::Capsule { radius_m, length_m } => {
                Self::new(Core::Segment(0.5 * length_m), radius_m)
            }
            Shape::Sphere { radius_m } => Self::ball(radius_m),
        }
    }
}

impl Core {
    /// Its furthest point along `direction`, which need not be of unit length.
    fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Segment(half) => Vector3::new(0.0, 0.0, half.copysign(direction.z)),
            Self::Box(half) => half.zip_map(direction, f64::copysign),
            Self::Cylinder { radius, half } => {
                let across = direction.x.hypot(direction.y);
                let scale = if across > 0.0 { radius / across } else { 0.0 };
                Vector3::new(direction.x * scale, direction.y * scale, half.copysign(direction.z))
            }
            Self::Ellipsoid(semi_axes) => {
                let scaled = semi_axes.component_mul(direction);
                let length = scaled.norm();
                if length > 0.0 { semi_axes.component_mul(&scaled) / length } else { scaled }
            }
            Self::Hull(points) => {
                let furthest = |a: Vector3<f64>, b: &Vector3<f64>| {
                    if b.dot(direction) > a.dot(direction) { *b } else { a }
                };
                points.iter().fold(points[0], furthest)
            }
        }
    }
}

impl SupportMap for Core {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let support = self.support(&Vector3::new(direction.x, direction.y, direction.z));
        Vector::new(support.x, support.y, support.z)
    }
}

fn parry_pose(pose: &Pose) -> ParryPose {
    let (t, q) = (&pose.translation.vector, &pose.rotation.coords);
    ParryPose::from_parts(Vector::new(t.x, t.y, t.z), Rotation::from_xyzw(q.x, q.y, q.z, q.w))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Translation3, UnitQuaternion};
    use seeone_core::random::{direction, generator, rotation, uniform};

    #[test]
    fn distances_are_those_of_simple_cases() {
        let at = |x: f64, y: f64, z: f64| Pose::translation(x, y, z);
        let cube = Convex::from(&Shape::Box { half_m: Vector3::repeat(0.1) });
        let capsule = Convex::from(&Shape::Capsule { radius_m: 0.05, length_m: 0.2 });
        let head = Convex::ellipsoid(Vector3::new(0.077, 0.099, 0.110));
        let origin = Pose::identity();
        assert!((cube.at(origin).distance(&capsule.at(at(0.3, 0.0, 0.1))) - 0.15).abs() < 1e-6);
        assert!(
            (head.at(origin).distance(&Convex::ball(0.02).at(at(0.0, 0.0, 0.2))) - 0.07).abs()
                < 1e-6
        );
        assert!((head.at(origin).distance(&capsule.at(at(0.0, -0.2, 0.0))) - 0.051).abs() < 1e-6);
        assert!(cube.at(origin).distance(&capsule.at(at(0.1, 0.0, 0.0))) < 0.0);
        let lying = Pose::from_parts(
            Translation3::new(0.0, 0.0, 1.0),
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2),
        );
        assert!((capsule.at(lying).lowest().z - 0.95).abs() < 1e-12);
        assert!((capsule.at(origin).lowest().z + 0.15).abs() < 1e-12);
    }

    #[test]
    fn the_search_for_the_distance_from_an_ellipsoid_converges() {
        let head = Convex::ellipsoid(Vector3::new(0.077, 0.099, 0.110));
        let mut rng = generator(4, "ellipsoid");
        for _ in 0..2000 {
            let away = direction(&mut rng) * uniform(&mut rng, 0.3, 0.9);
            let pose = Pose::from_parts(away.into(), rotation(&mut rng));
            let half_m = Vector3::new(0.033, 0.044, 0.055);
            let (palm, bound) = (Convex::from(&Shape::Box { half_m }), half_m.norm());
            let distance = palm.at(pose).distance(&head.at(Pose::identity()));
            let (low, high) = (away.norm() - bound - 0.11, away.norm() - 0.11);
            assert!((low..high).contains(&distance), "{distance} not in {low}..{high}");
        }
    }

    #[test]
    fn a_cover_is_never_further_away_than_what_it_covers() {
        let shapes = [
            Convex::from(&Shape::Box { half_m: Vector3::new(0.033, 0.044, 0.055) }),
            Convex::from(&Shape::Cylinder { radius_m: 0.05, length_m: 0.2 }),
            Convex::ellipsoid(Vector3::new(0.077, 0.099, 0.110)),
            Convex::from(&Shape::Capsule { radius_m: 0.05, length_m: 0.4 }),
            Convex::hull(&[Point3::origin(), [0.1, 0.0, 0.2].into(), [0.0, 0.3, 0.1].into()])
                .expect("points"),
        ];
        let mut rng = generator(6, "covers");
        for case in 0..2000 {
            let (a, b) = (&shapes[case % 5], &shapes[case / 5 % 5]);
            let mut draw = || {
                let away = direction(&mut rng) * uniform(&mut rng, 0.1, 0.6);
                Pose::from_parts(away.into(), rotation(&mut rng))
            };
            let (a, b) = (a.at(draw()), b.at(draw()));
            let distance = a.distance(&b);
            for least in [a.cover_distance(&b), a.box_distance(&b), b.box_distance(&a)] {
                assert!(least <= distance.max(0.0) + 1e-6, "{case}: {least} {distance}");
            }
            assert!(a.floor() <= a.lowest().z + 1e-12, "{case}");
            let Some(gap) = a.gap(&b, 0.3) else { continue };
            assert!((gap.distance_m - distance).abs() < 1e-5, "{} {distance}", gap.distance_m);
            let between = gap.points[1] - gap.points[0];
            assert!((between - gap.normal.into_inner() * distance).norm() < 1e-4);
        }
    }
}
