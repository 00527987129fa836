//! A virtual stereo depth camera with the faults of a real one (Intel RealSense D435i).

use crate::raster::{Hit, Raster, rasterize};
use nalgebra::Vector3;
use rand::{Rng, RngExt};
use seeone_core::random::normal;
use seeone_core::{DepthImage, Intrinsics, Pose, TriangleMesh};

/// Depth stream of a D435i at 640 x 480.
pub const D435I: Intrinsics =
    Intrinsics { width: 640, height: 480, fx: 384.0, fy: 384.0, cx: 319.5, cy: 239.5 };

/// How a measured depth differs from the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation of the disparity, pixels; the axial error is
    /// `Z^2 s / (f B)` (Intel's figures: 0.03 at best, 0.08 as a rule).
    pub disparity_px: f64,
    /// Distance of the two imagers, metres.
    pub baseline_m: f64,
    /// Pixels over which errors are alike: the size of the matching window.
    pub correlation_px: usize,
    /// Depths are multiples of this, metres.
    pub step_m: f64,
    /// Surfaces seen at a larger angle from their normal are not measured, radians.
    pub grazing_rad: f64,
    /// A neighbouring pixel that differs by more than this makes a depth edge, metres.
    pub edge_m: f64,
    /// Share of the pixels at a depth edge that are not measured.
    pub edge_dropout: f64,
}

impl Default for Noise {
    /// 2 mm at 0.7 m, alike over 5 pixels.
    fn default() -> Self {
        Self {
            disparity_px: 0.08,
            baseline_m: 0.05,
            correlation_px: 5,
            step_m: 0.001,
            grazing_rad: 75f64.to_radians(),
            edge_m: 0.015,
            edge_dropout: 0.7,
        }
    }
}

/// A depth image and, for ground truth, what each of its pixels truly saw.
#[derive(Clone, Debug)]
pub struct Capture {
    /// What the camera reports.
    pub image: DepthImage,
    /// What a simulator alone knows.
    pub truth: Raster,
}

/// Takes a picture of `meshes` (in `world`) from the pose `camera`.
pub fn capture(
    meshes: &[&TriangleMesh],
    camera: &Pose,
    intrinsics: &Intrinsics,
    noise: &Noise,
    rng: &mut impl Rng,
) -> Capture {
    let truth = rasterize(meshes, camera, intrinsics);
    let errors = Errors::draw(intrinsics, noise.correlation_px, rng);
    let mut depth_m = vec![0.0; truth.hits.len()];
    for (pixel, hit) in truth.hits.iter().enumerate() {
        let lost = rng.random::<f64>() < noise.edge_dropout;
        let Some(hit) = hit else { continue };
        let (column, row) = (pixel % intrinsics.width, pixel / intrinsics.width);
        if lost && at_depth_edge(&truth, column, row, hit, noise.edge_m)
            || is_grazing(meshes, camera, intrinsics, (column, row), hit, noise.grazing_rad)
        {
            continue;
        }
        let sigma = hit.depth_m.powi(2) * noise.disparity_px / (intrinsics.fx * noise.baseline_m);
        let measured = hit.depth_m + sigma * errors.at(column, row);
        depth_m[pixel] = ((measured / noise.step_m).round() * noise.step_m).max(0.0) as f32;
    }
    Capture { image: DepthImage { intrinsics: *intrinsics, depth_m }, truth }
}

fn at_depth_edge(truth: &Raster, column: usize, row: usize, hit: &Hit, edge_m: f64) -> bool {
    [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().any(|(dx, dy)| {
        truth
            .at(column as isize + dx, row as isize + dy)
            .is_some_and(|other| (other.depth_m - hit.depth_m).abs() > edge_m)
    })
}

fn is_grazing(
    meshes: &[&TriangleMesh],
    camera: &Pose,
    intrinsics: &Intrinsics,
    (column, row): (usize, usize),
    hit: &Hit,
    limit_rad: f64,
) -> bool {
    let [a, b, c] = meshes[hit.mesh as usize].corners(hit.triangle as usize);
    let normal = (b - a).cross(&(c - a));
    let ray = camera * intrinsics.deproject(column, row, 1.0).coords;
    normal.dot(&ray).abs() < limit_rad.cos() * normal.norm() * ray.norm()
}

/// A field of standard normal errors, alike over neighbouring pixels: a coarse grid of
/// draws, interpolated and brought back to unit variance everywhere.
struct Errors {
    grid: Vec<f64>,
    columns: usize,
    spacing: usize,
}

impl Errors {
    fn draw(intrinsics: &Intrinsics, spacing: usize, rng: &mut impl Rng) -> Self {
        let spacing = spacing.max(1);
        let columns = intrinsics.width / spacing + 2;
        let rows = intrinsics.height / spacing + 2;
        let grid = (0..columns * rows).map(|_| normal(rng)).collect();
        Self { grid, columns, spacing }
    }

    fn at(&self, column: usize, row: usize) -> f64 {
        let s = self.spacing;
        let first = row / s * self.columns + column / s;
        let (u, v) = ((column % s) as f64 / s as f64, (row % s) as f64 / s as f64);
        let weights = [(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v];
        let corners = [first, first + 1, first + self.columns, first + self.columns + 1];
        let sum: f64 = weights.iter().zip(corners).map(|(w, i)| w * self.grid[i]).sum();
        sum / weights.iter().map(|w| w * w).sum::<f64>().sqrt()
    }
}

/// The pose in `world` of a camera at `eye` that looks at `target`, its image upright.
pub fn looking_at(eye: &Vector3<f64>, target: &Vector3<f64>) -> Pose {
    let forward = (target - eye).normalize();
    let down = if forward.z.abs() > 0.999 { Vector3::y() } else { -Vector3::z() };
    Pose::from_parts((*eye).into(), seeone_core::pose::rotation_from_approach(&forward, &down))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use seeone_core::random::generator;

    fn table() -> TriangleMesh {
        crate::scenery::table()
    }

    fn above(angle_deg: f64) -> Pose {
        let a = angle_deg.to_radians();
        looking_at(&(Vector3::new(0.0, -a.cos(), a.sin()) * 0.7), &Vector3::zeros())
    }

    #[test]
    fn the_error_at_seventy_centimetres_is_two_millimetres() {
        let camera = above(90.0);
        let shot = capture(&[&table()], &camera, &D435I, &Noise::default(), &mut generator(1, "t"));
        let errors: Vec<f64> = shot
            .image
            .depth_m
            .iter()
            .zip(&shot.truth.hits)
            .filter_map(|(z, hit)| Some(f64::from(*z) - hit.as_ref()?.depth_m))
            .collect();
        let sigma = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        assert!((0.0018..0.0023).contains(&sigma), "{sigma}");
        let alike = errors.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / errors.len() as f64;
        assert!(alike > 0.5 * sigma * sigma, "neighbours err alike");
    }

    #[test]
    fn a_grazing_table_is_not_measured() {
        let shot =
            capture(&[&table()], &above(8.0), &D435I, &Noise::default(), &mut generator(1, "t"));
        let middle = shot.image.depth_m[240 * 640 + 320];
        assert_eq!(middle, 0.0);
    }

    #[test]
    fn looks_at_its_target_with_the_image_upright() {
        let camera = above(40.0);
        let target = camera.inverse() * Point3::origin();
        assert!(target.x.abs() < 1e-12 && target.y.abs() < 1e-12 && target.z > 0.0);
        let up = camera.inverse() * Point3::new(0.0, 0.0, 0.1);
        assert!(up.y < 0.0, "what is higher in the world is higher in the image");
    }
}
