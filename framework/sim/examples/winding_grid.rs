//! Computes the winding number of a cap of about 1,000 vertices on a 128^3 grid, for
//! comparison with other programs: `winding_grid NAME FOLDER` writes the canonical mesh as
//! `mesh.obj`, and as `winding.f64` the numbers (little-endian, z fastest) about the centres
//! of the unit cube's voxels.

use nalgebra::Point3;
use seeone_core::winding::Exact;
use seeone_sim::category::cap::{self, Resolution};
use seeone_sim::{Settings, worn::worn};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::PathBuf;
use std::time::Instant;

const VOXELS: usize = 128;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().ok_or("which cap?")?;
    let folder = PathBuf::from(arguments.next().ok_or("which folder?")?);
    let object = cap::named_at(&name, Resolution::FINE).ok_or("there is no such cap")?;
    let mesh = worn(&object, &Settings::default())?.canonical.mesh()?;

    let start = Instant::now();
    let step = 1.0 / VOXELS as f64;
    let low = Point3::from([0.5 * step; 3]);
    let winding = Exact::new(&mesh).grid(&low, step, [VOXELS; 3]);
    let seconds = start.elapsed().as_secs_f64();

    let mut obj = String::new();
    for v in mesh.vertices() {
        writeln!(obj, "v {} {} {}", v.x, v.y, v.z)?;
    }
    for [a, b, c] in mesh.triangles().iter().map(|t| t.map(|v| v + 1)) {
        writeln!(obj, "f {a} {b} {c}")?;
    }
    fs::create_dir_all(&folder)?;
    fs::write(folder.join("mesh.obj"), obj)?;
    let bytes: Vec<u8> = winding.iter().flat_map(|w| w.to_le_bytes()).collect();
    fs::write(folder.join("winding.f64"), bytes)?;
    let (vertices, triangles) = (mesh.vertices().len(), mesh.triangles().len());
    let points = winding.len();
    writeln!(
        std::io::stdout(),
        "{name}: {vertices} vertices, {triangles} triangles, {points} points in {seconds:.3} s"
    )?;
    Ok(())
}
