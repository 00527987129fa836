//! Pictures of a scene: our own rasteriser, one lamp with soft shadows, light from the sky,
//! darkened creases, and anti-aliasing by 2 x 2 samples a pixel.

mod light;
mod surface;

use crate::raster::rasterize;
use light::{Lamp, crease_shade};
use nalgebra::Vector3;
use seeone_core::{Intrinsics, Pose, TriangleMesh};
use surface::Surface;

/// A colour: red, green and blue as the eye reads them (sRGB), each 0 to 1.
pub type Color = [f64; 3];

/// How a mesh is coloured.
#[derive(Clone, Debug)]
pub enum Paint {
    /// One colour all over.
    Plain(Color),
    /// One colour for each triangle; triangles beyond the list's end are grey.
    PerTriangle(Vec<Color>),
}

/// A mesh in `world` with its colours.
#[derive(Clone, Debug)]
pub struct Colored<'a> {
    /// The mesh, metres, in `world`.
    pub mesh: &'a TriangleMesh,
    /// Its colours.
    pub paint: Paint,
}

/// A picture: eight bits for red, green and blue of every pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// `3 x width x height` bytes.
    pub rgb: Vec<u8>,
}

/// Samples along each edge of a pixel.
const SAMPLES: usize = 2;
/// Colours of the background above and below.
const BACKDROP: [Color; 2] = [[0.93, 0.945, 0.96], [0.80, 0.83, 0.87]];

/// Draws `scene` as a camera of these intrinsics sees it from `camera` (pose in `world`).
pub fn render(scene: &[Colored], camera: &Pose, intrinsics: &Intrinsics) -> Picture {
    let fine = finer(intrinsics);
    let meshes: Vec<&TriangleMesh> = scene.iter().map(|c| c.mesh).collect();
    let surfaces: Vec<Surface> = scene.iter().map(|c| Surface::new(c.mesh)).collect();
    let raster = rasterize(&meshes, camera, &fine);
    let lamp = Lamp::over(&meshes);
    let eye = camera.translation.vector;
    let light = |pixel: usize| -> Vector3<f64> {
        let (column, row) = (pixel % fine.width, pixel / fine.width);
        let Some(hit) = &raster.hits[pixel] else { return backdrop(row, fine.height) };
        let surface = &surfaces[hit.mesh as usize];
        let point = camera * fine.deproject(column, row, hit.depth_m);
        let (normal, outside) = surface.normal_towards(hit, &(eye - point.coords));
        let base = linear(scene[hit.mesh as usize].paint.color(hit.triangle as usize));
        let base = if outside { base } else { base * 0.55 };
        let crease = crease_shade(&raster, column, row, hit.depth_m);
        base.component_mul(&lamp.light_at(&point, &normal, &eye)) * crease
    };
    let mut rgb = Vec::with_capacity(3 * intrinsics.width * intrinsics.height);
    for row in 0..intrinsics.height {
        for column in 0..intrinsics.width {
            let mut sum = Vector3::zeros();
            for (dy, dx) in (0..SAMPLES).flat_map(|y| (0..SAMPLES).map(move |x| (y, x))) {
                sum += light((row * SAMPLES + dy) * fine.width + column * SAMPLES + dx);
            }
            rgb.extend(encoded(&(sum / (SAMPLES * SAMPLES) as f64)));
        }
    }
    Picture { width: intrinsics.width, height: intrinsics.height, rgb }
}

impl Paint {
    fn color(&self, triangle: usize) -> Color {
        match self {
            Self::Plain(color) => *color,
            Self::PerTriangle(colors) => colors.get(triangle).copied().unwrap_or([0.5; 3]),
        }
    }
}

/// The same view with more pixels.
fn finer(camera: &Intrinsics) -> Intrinsics {
    let s = SAMPLES as f64;
    // A pixel's centre lies at its whole number, so its left edge at one half less.
    let shifted = |c: f64| (c + 0.5) * s - 0.5;
    Intrinsics {
        width: camera.width * SAMPLES,
        height: camera.height * SAMPLES,
        fx: camera.fx * s,
        fy: camera.fy * s,
        cx: shifted(camera.cx),
        cy: shifted(camera.cy),
    }
}

fn backdrop(row: usize, rows: usize) -> Vector3<f64> {
    linear(BACKDROP[0]).lerp(&linear(BACKDROP[1]), row as f64 / rows as f64)
}

/// sRGB to linear light (power law 2.2).
fn linear(color: Color) -> Vector3<f64> {
    Vector3::from(color).map(|v| v.clamp(0.0, 1.0).powf(2.2))
}

/// Linear light to sRGB bytes.
fn encoded(light: &Vector3<f64>) -> [u8; 3] {
    (*light).map(|v| (v.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0).round() as u8).into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth_camera::{D435I, looking_at};
    use crate::scenery;
    use crate::surroundings::Head;

    fn pixel(picture: &Picture, column: usize, row: usize) -> [u8; 3] {
        let i = 3 * (row * picture.width + column);
        [picture.rgb[i], picture.rgb[i + 1], picture.rgb[i + 2]]
    }

    #[test]
    fn colours_fall_where_the_things_are() {
        let table = scenery::table();
        let head = scenery::head(&Head::medium(Pose::translation(0.0, 0.0, 0.11)));
        let scene = [
            Colored { mesh: &table, paint: Paint::Plain([0.2, 0.3, 0.8]) },
            Colored { mesh: &head, paint: Paint::Plain([0.8, 0.2, 0.1]) },
        ];
        let camera = looking_at(&Vector3::new(0.0, -0.7, 0.5), &Vector3::new(0.0, 0.0, 0.1));
        let small = Intrinsics { width: 160, height: 120, fx: 96.0, fy: 96.0, cx: 79.5, cy: 59.5 };
        let picture = render(&scene, &camera, &small);
        assert_eq!(picture.rgb.len(), 3 * 160 * 120);
        let [r, _, b] = pixel(&picture, 80, 60);
        assert!(r > b, "the head is red");
        let [r, _, b] = pixel(&picture, 10, 110);
        assert!(b > r, "the table is blue");
    }

    #[test]
    fn the_finer_camera_sees_the_same_rays() {
        let fine = finer(&D435I);
        let coarse = D435I.deproject(100, 200, 1.0);
        let (a, b) = (fine.deproject(200, 400, 1.0), fine.deproject(201, 401, 1.0));
        assert!((coarse.coords - (a.coords + b.coords) / 2.0).norm() < 1e-12);
    }
}
