//! Draws caps as worn, generated ones or from OBJ files, side by side:
//! `contact_sheet FILE.png NAME...`

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::{Intrinsics, Pose, TriangleMesh};
use seeone_sim::category::cap;
use seeone_sim::depth_camera::looking_at;
use seeone_sim::import::{Options, cap_from_obj};
use seeone_sim::picture::{Color, Colored, Paint, render};
use seeone_sim::{Head, Object, Region, Settings, scenery, worn::worn};
use std::error::Error;
use std::fs::File;
use std::path::Path;

const COLUMNS: usize = 4;
const SPACING_M: f64 = 0.36;
const SKIN: Color = [0.86, 0.72, 0.62];
const GROUND: Color = [0.62, 0.66, 0.68];
const VIEW: Intrinsics =
    Intrinsics { width: 1200, height: 720, fx: 1300.0, fy: 1300.0, cx: 599.5, cy: 359.5 };

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("which file?")?;
    let mut parts: Vec<(TriangleMesh, Paint)> = Vec::new();
    for (i, name) in arguments.enumerate() {
        let cap = match cap::named(&name) {
            Some(cap) => cap,
            None => cap_from_obj(Path::new(&name), "imported", &Options::default())?,
        };
        let place = Vector3::new((i % COLUMNS) as f64, -((i / COLUMNS) as f64), 0.0) * SPACING_M;
        let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, -2.5);
        let head = Pose::from_parts(Translation3::from(place + Vector3::z() * 0.16), turn);
        let on_head: Vec<Point3<f64>> =
            worn(&cap, &Settings::default())?.vertices.iter().map(|v| head * v).collect();
        parts.push((scenery::head(&Head::medium(head)), Paint::Plain(SKIN)));
        parts.push((cap.mesh().with_vertices(on_head)?, paint(&cap, i)));
    }
    let rows = parts.len().div_ceil(2 * COLUMNS);
    let middle = Vector3::new(1.5, -0.5 * (rows - 1) as f64, 0.45) * SPACING_M;
    let ground = scenery::rectangle([middle.x, middle.y], [8.0, 8.0], 0.0);
    parts.push((ground, Paint::Plain(GROUND)));
    let scene: Vec<Colored> =
        parts.iter().map(|(mesh, paint)| Colored { mesh, paint: paint.clone() }).collect();
    let eye = middle + Vector3::new(0.0, -1.45, 1.0);
    let picture = render(&scene, &looking_at(&eye, &middle), &VIEW);
    let (width, height) = (VIEW.width as u32, VIEW.height as u32);
    let mut encoder = png::Encoder::new(File::create(file)?, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(&picture.rgb)?;
    Ok(())
}

/// Crown and brim in one of a few pairs of colours.
fn paint(cap: &Object, number: usize) -> Paint {
    const PAIRS: [[Color; 2]; 4] = [
        [[0.17, 0.30, 0.52], [0.78, 0.25, 0.20]],
        [[0.20, 0.42, 0.33], [0.20, 0.42, 0.33]],
        [[0.85, 0.83, 0.78], [0.20, 0.22, 0.26]],
        [[0.72, 0.45, 0.16], [0.30, 0.22, 0.16]],
    ];
    let [crown, brim] = PAIRS[number % PAIRS.len()];
    let shade = |c: Color, by: f64| c.map(|v| v * by);
    let color = |region: &Region| match region {
        Region::Crown => crown,
        Region::Front => shade(crown, 1.08),
        Region::Hem => shade(crown, 0.85),
        Region::Brim => brim,
    };
    Paint::PerTriangle(cap.regions().iter().map(color).collect())
}
