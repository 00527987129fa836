//! `objects sheet`: contact sheets of what the simulation makes.

use crate::objects::resolve;
use crate::outputs::make_folder;
use crate::picture::{MAT, SKIN, colors, montage, write_png};
use crate::{Ending, console};
use anyhow::{Context, Result};
use nalgebra::Vector3;
use rayon::prelude::*;
use seeone_core::random::generator;
use seeone_core::{DepthImage, Intrinsics, Pose, TriangleMesh};
use seeone_sim::category::cap::{self, Set, Template};
use seeone_sim::depth_camera::{Noise, capture, looking_at};
use seeone_sim::drop::Drop;
use seeone_sim::object::Object;
use seeone_sim::picture::{Colored, Paint, Picture, render};
use seeone_sim::worn::worn;
use seeone_sim::{Head, Settings, Surroundings, scenery};
use std::f64::consts::TAU;
use std::path::Path;

/// From where things are seen: from their middle, on the side of the lamp, metres.
const AWAY: Vector3<f64> = Vector3::new(0.42, -0.46, 0.40);
/// The mat is drawn this much lower than it lies: it would shine through what rests on it.
const MAT_LOWERED_M: f64 = 0.003;
/// Drops of one object of each template.
const DROPS: usize = 5;
/// A drop is given this long to come to rest, seconds.
const SETTLE_S: f64 = 6.0;
/// The depth camera's distance from the objects that it sees, metres.
const CAMERA_M: f64 = 0.6;
/// The colours of a depth image return after this depth, metres.
const RAINBOW_M: f64 = 0.15;

/// An object at rest after a drop, in `world`.
struct Rested {
    object: Object,
    mesh: TriangleMesh,
}

/// Draws the four sheets into `folder`.
///
/// # Errors
/// When an object has no worn state or a file cannot be written.
pub fn run(seed: u64, folder: &Path) -> Result<Ending> {
    make_folder(folder)?;
    let rested = drops(seed)?;
    let write = |name: &str, panels: &[Picture], columns: usize| {
        let path = folder.join(name);
        console::tell(&path.display().to_string());
        write_png(&montage(panels, columns), &path)
    };
    write("caps.png", &each(&all(), at_rest)?, 14)?;
    write("canonical.png", &each(&cap::names(Set::Unseen), on_the_head)?, 5)?;
    write("drops.png", &rested.par_iter().map(on_the_mat).collect::<Vec<_>>(), DROPS)?;
    write("depth.png", &depths(&rested, seed), 3)?;
    Ok(Ending::Success)
}

/// Names of all objects, template by template.
fn all() -> Vec<String> {
    let members = || Set::DISJOINT.into_iter().flat_map(Set::members);
    let of = |template| members().filter(move |(_, member)| member.template == template);
    Template::ALL.into_iter().flat_map(|t| of(t).map(|(name, _)| name)).collect()
}

/// One panel for each of the named objects.
fn each(names: &[String], panel: fn(&Object) -> Result<Picture>) -> Result<Vec<Picture>> {
    names.par_iter().map(|name| panel(&resolve(name)?)).collect()
}

/// The last object of each template, which no network is trained on, `DROPS` times.
fn drops(seed: u64) -> Result<Vec<Rested>> {
    let last = |template| {
        let mut members = Set::DISJOINT.into_iter().flat_map(Set::members);
        members.rfind(|(_, member)| member.template == template).map(|(name, _)| name)
    };
    let names: Vec<String> = Template::ALL.into_iter().filter_map(last).collect();
    (0..names.len() * DROPS)
        .into_par_iter()
        .map(|i| {
            let object = resolve(&names[i / DROPS])?;
            let mut rng = generator(seed, &format!("sheet/{}/drop-{}", object.name(), i % DROPS));
            let table = Surroundings { table: true, ..Surroundings::default() };
            let mut world =
                Drop::draw([0.0, 0.0], &mut rng).begin(&object, table, Settings::default());
            world.settle(SETTLE_S);
            Ok(Rested { mesh: world.mesh(), object })
        })
        .collect()
}

/// An object as it is made.
fn at_rest(object: &Object) -> Result<Picture> {
    let mesh = towards_the_eye(object.mesh())?;
    Ok(render(&[painted(object, &mesh)], &beside(&mesh), &lens([92, 76], 185.0)))
}

/// An object's canonical state: worn, on the head.
fn on_the_head(object: &Object) -> Result<Picture> {
    let settled = worn(object, &Settings::default()).with_context(|| object.name().to_owned())?;
    let mesh = object.mesh().with_vertices(settled.vertices).context("the worn shape")?;
    let mesh = towards_the_eye(&mesh)?;
    let head = towards_the_eye(&scenery::head(&Head::medium(Pose::identity())))?;
    let skin = Colored { mesh: &head, paint: Paint::Plain(SKIN) };
    let camera = looking_at(&(AWAY + Vector3::z() * 0.04), &(Vector3::z() * 0.02));
    Ok(render(&[skin, painted(object, &mesh)], &camera, &lens([208, 208], 420.0)))
}

/// An object at rest on the mat.
fn on_the_mat(rested: &Rested) -> Picture {
    let mat = mat();
    let scene =
        [Colored { mesh: &mat, paint: Paint::Plain(MAT) }, painted(&rested.object, &rested.mesh)];
    render(&scene, &beside(&rested.mesh), &lens([192, 144], 330.0))
}

/// The first drop of each object in colour, in true depth, and as the depth camera sees it.
fn depths(rested: &[Rested], seed: u64) -> Vec<Picture> {
    let (table, mat) = (scenery::table(), mat());
    let view = lens([224, 168], 330.0);
    let panels = |first: &Rested| {
        let target = middle(&first.mesh);
        let eye = target + Vector3::new(0.0, -0.3, 1.0).normalize() * CAMERA_M;
        let camera = looking_at(&eye, &target);
        let meshes = [&first.mesh, &table];
        let mut rng = generator(seed, &format!("sheet/{}/depth", first.object.name()));
        let shot = capture(&meshes, &camera, &view, &Noise::default(), &mut rng);
        let true_depth =
            shot.truth.hits.iter().map(|hit| hit.map_or(0.0, |hit| hit.depth_m as f32)).collect();
        let scene =
            [painted(&first.object, &first.mesh), Colored { mesh: &mat, paint: Paint::Plain(MAT) }];
        [
            render(&scene, &camera, &view),
            rainbow(&DepthImage { intrinsics: view, depth_m: true_depth }),
            rainbow(&shot.image),
        ]
    };
    rested.par_iter().step_by(DROPS).flat_map_iter(panels).collect()
}

/// A depth image in colours that go round once every `RAINBOW_M`; black where there is no
/// depth.
fn rainbow(image: &DepthImage) -> Picture {
    let color = |depth_m: &f32| {
        let turn = f64::from(*depth_m) / RAINBOW_M;
        let wave = |k: f64| (255.0 * (0.55 + 0.4 * (TAU * (turn + k / 3.0)).cos())).round() as u8;
        if *depth_m > 0.0 { [wave(0.0), wave(1.0), wave(2.0)] } else { [0; 3] }
    };
    let Intrinsics { width, height, .. } = image.intrinsics;
    Picture { width, height, rgb: image.depth_m.iter().flat_map(color).collect() }
}

fn painted<'a>(object: &Object, mesh: &'a TriangleMesh) -> Colored<'a> {
    Colored { mesh, paint: Paint::PerTriangle(colors(object)) }
}

/// The mesh with what was its front, +y, towards -y.
fn towards_the_eye(mesh: &TriangleMesh) -> Result<TriangleMesh> {
    let turned = mesh.vertices().iter().map(|v| [-v.x, -v.y, v.z].into()).collect();
    mesh.with_vertices(turned).context("a mesh that is turned")
}

fn mat() -> TriangleMesh {
    scenery::rectangle([0.0, 0.0], [3.0, 3.0], -MAT_LOWERED_M)
}

/// A camera that looks at the middle of a mesh.
fn beside(mesh: &TriangleMesh) -> Pose {
    looking_at(&(middle(mesh) + AWAY), &middle(mesh))
}

fn middle(mesh: &TriangleMesh) -> Vector3<f64> {
    let (low, high) = mesh.bounds();
    nalgebra::center(&low, &high).coords
}

/// A lens with its centre in the middle of the picture.
fn lens([width, height]: [usize; 2], focal_px: f64) -> Intrinsics {
    let centre = |pixels: usize| (pixels as f64 - 1.0) / 2.0;
    Intrinsics { width, height, fx: focal_px, fy: focal_px, cx: centre(width), cy: centre(height) }
}
