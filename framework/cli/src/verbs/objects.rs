//! `objects`: list the generated ones, import a mesh, draw either.

use crate::args::ImportArgs;
use crate::objects::{resolve, write};
use crate::outputs::make_folder;
use crate::picture::{colors, write_png};
use crate::{Ending, console};
use anyhow::Result;
use nalgebra::Vector3;
use seeone_core::{Diagnostic, Intrinsics};
use seeone_sim::category::cap::{self, Entry};
use seeone_sim::depth_camera::looking_at;
use seeone_sim::import::{Axis, ImportFault, Options, cap_from_obj};
use seeone_sim::picture::{Colored, Paint, render};
use seeone_sim::scenery;
use std::path::Path;

/// Where an object is drawn from, metres, and with what lens.
const EYE: Vector3<f64> = Vector3::new(0.38, 0.42, 0.34);
const SUBJECT: Vector3<f64> = Vector3::new(0.0, 0.02, 0.05);
const LENS: Intrinsics =
    Intrinsics { width: 960, height: 720, fx: 1100.0, fy: 1100.0, cx: 479.5, cy: 359.5 };
/// A worn hem sits above the widest line of the head: the generated caps that fit the
/// simulated head of 0.556 m have hems of 0.545 m.
const HEM_TO_HEAD: f64 = 0.98;
const GROUND: [f64; 3] = [0.80, 0.77, 0.71];

/// Lists every generated object with its template and its sets.
///
/// # Errors
/// When standard output has gone.
pub fn list(json: bool) -> Result<Ending> {
    let entries = cap::catalogue();
    if json {
        console::answer(&serde_json::to_string_pretty(&entries)?)?;
    } else {
        for Entry { name, set, template, paper_40, .. } in entries {
            let part = if paper_40 { ", paper-40" } else { "" };
            console::answer(&format!("{name:18}  {template:8}  {set}{part}"))?;
        }
    }
    Ok(Ending::Success)
}

/// Turns a mesh into an object file.
///
/// # Errors
/// A diagnostic for a mesh, an axis or a size that makes no object.
pub fn import(args: &ImportArgs) -> Result<Ending> {
    let axis = |flag: &str, text: &str| {
        text.parse::<Axis>().map_err(|cause| {
            Diagnostic::new("O002", format!("{flag}: {cause}"))
                .hint("write for example --up +y --front +z")
        })
    };
    let options = Options {
        up: axis("--up", &args.up)?,
        front: args.front.as_deref().map(|text| axis("--front", text)).transpose()?,
        circumference_m: args.head_circumference * HEM_TO_HEAD,
    };
    let name = args.mesh.file_stem().and_then(|stem| stem.to_str()).unwrap_or("imported");
    let object =
        cap_from_obj(&args.mesh, name, &options).map_err(|fault| told(&args.mesh, &fault))?;
    write(&object, &args.out)?;
    console::tell(&format!(
        "{}: {} vertices, {} triangles, {:.0} g -> {}",
        object.name(),
        object.mesh().vertices().len(),
        object.mesh().triangles().len(),
        object.mass() * 1e3,
        args.out.display()
    ));
    Ok(Ending::Success)
}

fn told(mesh: &Path, fault: &ImportFault) -> Diagnostic {
    let diagnostic = Diagnostic::new("O003", fault.to_string()).in_file(mesh);
    match fault {
        ImportFault::NotACap(_) | ImportFault::FrontIsUp => {
            diagnostic.hint("check --up and --front: the axes of the mesh as it is in its file")
        }
        ImportFault::TooManyTriangles(_) | ImportFault::TooLarge(_) => {
            diagnostic.hint("decimate it first; a simulated cap has about a thousand triangles")
        }
        ImportFault::Circumference(_) => diagnostic.hint("--head-circumference is in metres"),
        _ => diagnostic,
    }
}

/// Draws an object in its rest shape.
///
/// # Errors
/// When there is no such object, or the picture cannot be written.
pub fn show(object: &str, out: &Path) -> Result<Ending> {
    let object = resolve(object)?;
    if let Some(folder) = out.parent() {
        make_folder(folder)?;
    }
    let (low, _) = object.mesh().bounds();
    let ground = scenery::rectangle([0.0, 0.0], [1.2, 1.2], low.z);
    let scene = [
        Colored { mesh: &ground, paint: Paint::Plain(GROUND) },
        Colored { mesh: object.mesh(), paint: Paint::PerTriangle(colors(&object)) },
    ];
    write_png(&render(&scene, &looking_at(&EYE, &SUBJECT), &LENS), out)?;
    console::tell(&format!("{} -> {}", object.name(), out.display()));
    Ok(Ending::Success)
}
