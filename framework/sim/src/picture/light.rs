//! The lamp with its shadows, the sky, and the darkening of creases.

use crate::depth_camera::looking_at;
use crate::raster::{Raster, rasterize};
use nalgebra::{Point3, Vector3};
use seeone_core::{Intrinsics, Pose, TriangleMesh};

/// Direction towards the lamp, `world`.
const TOWARDS_LAMP: Vector3<f64> = Vector3::new(-0.45, -0.55, 0.95);
/// Distance of the lamp from the scene's middle in radii of the scene.
const LAMP_RADII: f64 = 6.0;
/// Edge of the shadow map, pixels.
const SHADOW_MAP: usize = 1536;
/// A surface this much nearer to the lamp throws a shadow, metres.
const SHADOW_BIAS_M: f64 = 0.006;
/// The scene's part that receives shadows: a ball of at most this radius, metres.
const LARGEST_RADIUS_M: f64 = 1.0;

/// A lamp far away with its shadow map.
pub struct Lamp {
    map: Raster,
    from_world: Pose,
    direction: Vector3<f64>,
}

impl Lamp {
    /// A lamp over everything but the widest mesh, which is taken for the ground.
    pub fn over(meshes: &[&TriangleMesh]) -> Self {
        let (centre, radius) = lit_ball(meshes);
        let direction = TOWARDS_LAMP.normalize();
        let pose = looking_at(&(centre + direction * (LAMP_RADII * radius)), &centre);
        let focal = SHADOW_MAP as f64 / 2.0 * (LAMP_RADII - 1.0);
        let middle = (SHADOW_MAP - 1) as f64 / 2.0;
        let view = Intrinsics {
            width: SHADOW_MAP,
            height: SHADOW_MAP,
            fx: focal,
            fy: focal,
            cx: middle,
            cy: middle,
        };
        Self { map: rasterize(meshes, &pose, &view), from_world: pose.inverse(), direction }
    }

    /// Light that leaves a white surface at `point` with the unit `normal` towards `eye`.
    pub fn light_at(
        &self,
        point: &Point3<f64>,
        normal: &Vector3<f64>,
        eye: &Vector3<f64>,
    ) -> Vector3<f64> {
        let lit = self.visible_share(point, normal);
        let lambert = normal.dot(&self.direction).max(0.0);
        let half = (self.direction + (eye - point.coords).normalize()).normalize();
        let gloss = 0.12 * normal.dot(&half).max(0.0).powi(24);
        let sky = 0.5 + 0.5 * normal.z;
        let ambient =
            Vector3::new(0.30, 0.32, 0.36) * sky + Vector3::new(0.16, 0.14, 0.13) * (1.0 - sky);
        ambient + Vector3::new(0.98, 0.94, 0.88) * (lit * (0.78 * lambert + gloss))
    }

    /// Share of the lamp that `point` sees: mean over neighbouring pixels of the map.
    fn visible_share(&self, point: &Point3<f64>, normal: &Vector3<f64>) -> f64 {
        const REACH: isize = 3;
        let seen = self.from_world * (point + normal * (0.5 * SHADOW_BIAS_M));
        let Some((column, row, depth_m)) = self.map.intrinsics.project(&seen) else { return 1.0 };
        let (column, row) = (column.round() as isize, row.round() as isize);
        let mut lit = 0;
        for (dy, dx) in (-REACH..=REACH).flat_map(|y| (-REACH..=REACH).map(move |x| (y, x))) {
            let hidden = self
                .map
                .at(column + dx, row + dy)
                .is_some_and(|h| h.depth_m < depth_m - SHADOW_BIAS_M);
            lit += usize::from(!hidden);
        }
        lit as f64 / (2 * REACH + 1).pow(2) as f64
    }
}

/// A ball around all meshes but the one of the largest extent.
fn lit_ball(meshes: &[&TriangleMesh]) -> (Vector3<f64>, f64) {
    let mut boxes: Vec<_> = meshes.iter().map(|m| m.bounds()).collect();
    boxes.sort_by(|a, b| (a.1 - a.0).norm().total_cmp(&(b.1 - b.0).norm()));
    if boxes.len() > 1 {
        boxes.pop();
    }
    let Some(first) = boxes.first().copied() else { return (Vector3::zeros(), LARGEST_RADIUS_M) };
    let (low, high) = boxes.iter().fold(first, |(l, h), b| (l.inf(&b.0), h.sup(&b.1)));
    let radius = ((high - low).norm() / 2.0).clamp(0.05, LARGEST_RADIUS_M);
    ((low.coords + high.coords) / 2.0, radius * 1.15)
}

/// Darkening where the surroundings of a pixel stand nearer to the camera: creases and the
/// line where one thing rests on another.
pub fn crease_shade(raster: &Raster, column: usize, row: usize, depth_m: f64) -> f64 {
    const DIRECTIONS: [(f64, f64); 8] = [
        (1.0, 0.0),
        (0.7, 0.7),
        (0.0, 1.0),
        (-0.7, 0.7),
        (-1.0, 0.0),
        (-0.7, -0.7),
        (0.0, -1.0),
        (0.7, -0.7),
    ];
    const RADIUS_M: f64 = 0.018;
    const STRENGTH: f64 = 0.45;
    let reach = (RADIUS_M * raster.intrinsics.fx / depth_m).max(1.5);
    let mut hidden = 0.0;
    for scale in [0.35, 0.7, 1.0] {
        for (dx, dy) in DIRECTIONS {
            let at = |sign: f64| {
                raster.at(
                    (column as f64 + sign * dx * reach * scale).round() as isize,
                    (row as f64 + sign * dy * reach * scale).round() as isize,
                )
            };
            // Against the opposite sample, so that a slanted plane does not darken itself.
            let (Some(a), Some(b)) = (at(1.0), at(-1.0)) else { continue };
            let rise = depth_m - 0.5 * (a.depth_m + b.depth_m);
            let near = (rise / (0.3 * RADIUS_M)).clamp(0.0, 1.0);
            let fading = (1.0 - (rise / (5.0 * RADIUS_M)).max(0.0)).clamp(0.0, 1.0);
            hidden += near * fading;
        }
    }
    1.0 - STRENGTH * hidden / (3.0 * DIRECTIONS.len() as f64)
}
