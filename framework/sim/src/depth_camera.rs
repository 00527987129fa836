//! A virtual stereo depth camera with the faults of a real one (Intel RealSense D435i).

mod stereo;

use crate::raster::{Hit, Raster, rasterize};
use nalgebra::Vector3;
use rand::{Rng, RngExt};
use seeone_core::random::{normal, uniform};
use seeone_core::{DepthImage, Intrinsics, Pose, TriangleMesh};
use stereo::SecondImager;

/// Depth stream of a D435i at 640 x 480, as the cameras report it (librealsense issue 8689:
/// `fx = fy = 384.2`).
pub const D435I: Intrinsics =
    Intrinsics { width: 640, height: 480, fx: 384.0, fy: 384.0, cx: 319.5, cy: 239.5 };

/// How a measured depth differs from the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation of the disparity, pixels; the axial error is
    /// `Z^2 s / (f B)` (Intel, "Tuning depth cameras for best performance", and
    /// librealsense issue 3904: 0.03 at best, 0.08 as a rule).
    pub disparity_px: f64,
    /// Distance of the two imagers, metres: 50 mm (D400 series datasheet). What the second
    /// one does not see is not measured.
    pub baseline_m: f64,
    /// Pixels over which errors are alike: the size of the matching window, a design value.
    pub correlation_px: usize,
    /// Depths are multiples of this, metres: the depth unit of the cameras' 16 bit images.
    pub step_m: f64,
    /// Surfaces seen at a larger angle from their normal are not measured, radians; a
    /// design value.
    pub grazing_rad: f64,
    /// A neighbouring pixel that differs by more than this makes a depth edge, metres.
    pub edge_m: f64,
    /// Share of the pixels at a depth edge that are not measured; a design value.
    pub edge_dropout: f64,
    /// Share of the measured pixels at a depth edge that fly: the matching window holds
    /// both sides of the edge, and the depth is somewhere between them. A design value.
    pub flying: f64,
    /// Share of the measured pixels whose depth is wrong by up to [`OUTLIER_M`] either way, as
    /// false matches are; none in what is learnt from.
    pub outliers: f64,
}

/// How wrong a false match may be, metres: a design value, half a cap.
pub const OUTLIER_M: f64 = 0.1;

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
            flying: 0.1,
            outliers: 0.0,
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

impl Capture {
    /// Whether a pixel shows one of the meshes for which `is_coloured`: what a camera that sees
    /// colours beside depths tells.
    pub fn shows(&self, pixel: usize, is_coloured: impl Fn(usize) -> bool) -> bool {
        self.truth.hits[pixel].is_some_and(|hit| is_coloured(hit.mesh as usize))
    }
}

/// A depth image from the pose `camera` with the usual noise, without its ground truth.
pub fn look(
    surfaces: &[TriangleMesh],
    camera: &Pose,
    intrinsics: &Intrinsics,
    noise: &mut impl Rng,
) -> DepthImage {
    let surfaces: Vec<&TriangleMesh> = surfaces.iter().collect();
    capture(&surfaces, camera, intrinsics, &Noise::default(), noise).image
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
    let second = SecondImager::look(&truth, noise.baseline_m);
    let errors = Errors::draw(intrinsics, noise.correlation_px, rng);
    let mut depth_m = vec![0.0; truth.hits.len()];
    for (pixel, hit) in truth.hits.iter().enumerate() {
        let Some(hit) = hit else { continue };
        let (column, row) = (pixel % intrinsics.width, pixel / intrinsics.width);
        let mut seen_m = hit.depth_m;
        if let Some(beyond_m) = across_edge(&truth, column, row, hit, noise.edge_m) {
            if rng.random::<f64>() < noise.edge_dropout {
                continue;
            }
            if rng.random::<f64>() < noise.flying {
                seen_m += (beyond_m - seen_m) * uniform(rng, 0.0, 1.0);
            }
        }
        if !second.sees(column, row, hit.depth_m)
            || is_grazing(meshes, camera, intrinsics, (column, row), hit, noise.grazing_rad)
        {
            continue;
        }
        let sigma = seen_m.powi(2) * noise.disparity_px / (intrinsics.fx * noise.baseline_m);
        let mut measured = seen_m + sigma * errors.at(column, row);
        if noise.outliers > 0.0 && rng.random::<f64>() < noise.outliers {
            measured += uniform(rng, -OUTLIER_M, OUTLIER_M);
        }
        depth_m[pixel] = ((measured / noise.step_m).round() * noise.step_m).max(0.0) as f32;
    }
    Capture { image: DepthImage { intrinsics: *intrinsics, depth_m }, truth }
}

/// The depth of a neighbouring pixel that differs by more than `edge_m`, if there is one.
fn across_edge(truth: &Raster, column: usize, row: usize, hit: &Hit, edge_m: f64) -> Option<f64> {
    [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().find_map(|(dx, dy)| {
        let other = truth.at(column as isize + dx, row as isize + dy)?.depth_m;
        ((other - hit.depth_m).abs() > edge_m).then_some(other)
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
mod tests;
