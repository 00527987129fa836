//! The picture of a run: four moments side by side, drawn by the project's own rasteriser.

use crate::outputs::write_file;
use crate::simulated::SimulatedCell;
use crate::workcell::Workcell;
use anyhow::{Context, Result, anyhow};
use nalgebra::{Point3, Vector3};
use seeone_core::{Intrinsics, TriangleMesh};
use seeone_plugin::RobotState;
use seeone_runtime::run::{Acted, Finished};
use seeone_sim::depth_camera::looking_at;
use seeone_sim::object::{Object, Region};
use seeone_sim::picture::{Color, Colored, Paint, Picture, render};
use seeone_sim::scenery;
use std::path::Path;

/// Where the picture is taken from, and what it looks at, in `world`, metres.
const EYE: Vector3<f64> = Vector3::new(1.35, -0.55, 0.80);
const SUBJECT: Vector3<f64> = Vector3::new(0.28, 0.12, 0.17);
/// One of the four panels.
const PANEL: Intrinsics =
    Intrinsics { width: 640, height: 480, fx: 640.0, fy: 640.0, cx: 319.5, cy: 239.5 };

/// The mat's colour.
pub const MAT: Color = [0.80, 0.77, 0.71];
/// The colour of heads.
pub const SKIN: Color = [0.87, 0.69, 0.57];
/// The colour of hooks and of the wall behind them.
const WOOD: Color = [0.70, 0.62, 0.50];
const ARM: Color = [0.72, 0.76, 0.80];
const CROWN: Color = [0.16, 0.32, 0.62];
const FRONT: Color = [0.20, 0.38, 0.70];
const BRIM: Color = [0.80, 0.22, 0.17];
const HEM: Color = [0.10, 0.18, 0.38];

/// The cell at one moment.
struct Moment {
    robot: RobotState,
    /// The vertices of all objects, one after another.
    object: Vec<Point3<f64>>,
}

/// A picture that is begun before the run and finished after it.
pub struct RunPicture {
    before: Moment,
}

impl RunPicture {
    /// Remembers the cell as it is now.
    ///
    /// # Errors
    /// When the simulated cell broke down.
    pub fn before(workcell: &Workcell, cell: &SimulatedCell) -> Result<Self> {
        let cell = cell.cell.lock().map_err(|_| anyhow!("the simulated cell broke down"))?;
        let robot =
            RobotState { joints: workcell.robot.home().to_vec(), opening_m: cell.opening_m() };
        Ok(Self { before: Moment { robot, object: cell.all_vertices().copied().collect() } })
    }

    /// Draws the start, the lift, the moment before the last stage and the end of `finished`
    /// into the PNG file `path`.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn finish(
        self,
        workcell: &Workcell,
        cell: &SimulatedCell,
        finished: &Finished,
        path: &Path,
    ) -> Result<()> {
        let (objects, standing) = {
            let cell = cell.cell.lock().map_err(|_| anyhow!("the simulated cell broke down"))?;
            let head = cell.head_mesh().map(|mesh| (mesh, SKIN));
            let hooks = cell.hook_meshes().into_iter().map(|mesh| (mesh, WOOD));
            let objects: Vec<Object> = cell.objects().cloned().collect();
            (objects, head.into_iter().chain(hooks).collect::<Vec<_>>())
        };
        let mut moments = vec![self.before];
        moments.extend(moments_of(workcell, finished));
        let panels = moments
            .iter()
            .map(|moment| panel(workcell, &objects, &standing, moment))
            .collect::<Result<Vec<_>>>()?;
        write_png(&montage(&panels, 2), path)
    }
}

/// The ends of the first and of the last stage but one, and the end of the run, as far as
/// the run came.
fn moments_of(workcell: &Workcell, finished: &Finished) -> Vec<Moment> {
    let Some(acted) = finished.left::<Acted>() else { return Vec::new() };
    let Some(first) = acted.robot.first() else { return Vec::new() };
    let mut ends = Vec::new();
    let mut time = first.time_s;
    for stage in &workcell.skill.stages {
        // Tries that closed on nothing took their time, too.
        let told = || finished.outcome.stages.iter().filter(|told| told.name == stage.name);
        if !told().any(|told| told.ok) {
            break;
        }
        time += told().map(|told| told.seconds).sum::<f64>();
        ends.push(time);
    }
    let chosen = match ends.as_slice() {
        [] => vec![f64::INFINITY],
        [only] => vec![*only, f64::INFINITY],
        [first, .., before_last, _] => vec![*first, *before_last, f64::INFINITY],
        [first, _] => vec![*first, f64::INFINITY],
    };
    chosen.into_iter().filter_map(|time| moment_at(acted, time)).collect()
}

/// The last samples at or before `time_s`.
fn moment_at(acted: &Acted, time_s: f64) -> Option<Moment> {
    let limit = time_s + 1e-6;
    let robot = acted.robot.iter().rfind(|sample| sample.time_s <= limit)?;
    let object = acted.object.iter().rfind(|snapshot| snapshot.time_s <= limit)?;
    Some(Moment {
        robot: robot.state.clone(),
        object: object.vertices.iter().map(|v| Point3::from(*v)).collect(),
    })
}

fn panel(
    workcell: &Workcell,
    objects: &[Object],
    standing: &[(TriangleMesh, Color)],
    moment: &Moment,
) -> Result<Picture> {
    let table = scenery::table();
    let caps = shapes(objects, &moment.object)?;
    let arm = workcell.robot.meshes(&moment.robot.joints, moment.robot.opening_m);
    let mut scene = vec![Colored { mesh: &table, paint: Paint::Plain(MAT) }];
    for (object, mesh) in objects.iter().zip(&caps) {
        scene.push(Colored { mesh, paint: Paint::PerTriangle(colors(object)) });
    }
    for (mesh, color) in standing {
        scene.push(Colored { mesh, paint: Paint::Plain(*color) });
    }
    scene.extend(arm.iter().map(|mesh| Colored { mesh, paint: Paint::Plain(ARM) }));
    Ok(render(&scene, &looking_at(&EYE, &SUBJECT), &PANEL))
}

/// The meshes of `objects` whose vertices are given one after another.
fn shapes(objects: &[Object], vertices: &[Point3<f64>]) -> Result<Vec<TriangleMesh>> {
    let mut rest = vertices;
    let mut shape = |object: &Object| {
        let (own, others) = rest.split_at_checked(object.mesh().vertices().len())?;
        rest = others;
        object.mesh().with_vertices(own.to_vec()).ok()
    };
    objects.iter().map(|object| shape(object).context("the object's shape")).collect()
}

/// The colour of every triangle of an object, by region.
pub fn colors(object: &Object) -> Vec<Color> {
    let color = |region: &Region| match region {
        Region::Crown => CROWN,
        Region::Front => FRONT,
        Region::Brim => BRIM,
        Region::Hem => HEM,
    };
    object.regions().iter().map(color).collect()
}

/// Panels of one size, `columns` a row; white where the last row is not full.
pub fn montage(panels: &[Picture], columns: usize) -> Picture {
    let columns = panels.len().min(columns);
    let rows = panels.len().div_ceil(columns.max(1));
    let (width, height) = panels.first().map_or((0, 0), |panel| (panel.width, panel.height));
    let mut rgb = vec![255; 3 * columns * width * rows * height];
    for (index, panel) in panels.iter().enumerate() {
        let (left, top) = (index % columns * width, index / columns * height);
        for row in 0..height {
            let from = 3 * row * width;
            let to = 3 * ((top + row) * columns * width + left);
            rgb[to..to + 3 * width].copy_from_slice(&panel.rgb[from..from + 3 * width]);
        }
    }
    Picture { width: columns * width, height: rows * height, rgb }
}

/// Writes a picture as PNG, in one step.
///
/// # Errors
/// When the file cannot be written.
pub fn write_png(picture: &Picture, path: &Path) -> Result<()> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, picture.width as u32, picture.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgb)?;
    writer.finish()?;
    Ok(write_file(path, &bytes)?)
}
