//! Caps made by others: from a triangle mesh of any scale, resolution and direction to an
//! object that can be simulated.

mod clean;
mod fit;
mod parts;
mod remesh;
mod sheet;

use crate::category::cap::CATEGORY;
use crate::object::{Material, Object, ObjectFault};
use nalgebra::{Matrix3, Point3, Vector3};
use sheet::Sheet;
use std::path::{Path, PathBuf};

/// A direction along an axis of the imported file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "each name says it all")]
pub enum Axis {
    PlusX,
    MinusX,
    PlusY,
    MinusY,
    PlusZ,
    MinusZ,
}

impl Axis {
    /// The unit vector.
    pub fn vector(self) -> Vector3<f64> {
        match self {
            Self::PlusX => Vector3::x(),
            Self::MinusX => -Vector3::x(),
            Self::PlusY => Vector3::y(),
            Self::MinusY => -Vector3::y(),
            Self::PlusZ => Vector3::z(),
            Self::MinusZ => -Vector3::z(),
        }
    }
}

impl std::str::FromStr for Axis {
    type Err = String;

    /// Reads `+x`, `-x`, `+y`, `-y`, `+z` or `-z`; the plus may be left out.
    fn from_str(text: &str) -> Result<Self, String> {
        match text.to_ascii_lowercase().as_str() {
            "+x" | "x" => Ok(Self::PlusX),
            "-x" => Ok(Self::MinusX),
            "+y" | "y" => Ok(Self::PlusY),
            "-y" => Ok(Self::MinusY),
            "+z" | "z" => Ok(Self::PlusZ),
            "-z" => Ok(Self::MinusZ),
            _ => Err(format!("\"{text}\" is no axis; known: +x, -x, +y, -y, +z, -z")),
        }
    }
}

/// How to read a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The file's direction from the hem to the crown.
    pub up: Axis,
    /// The file's direction in which the brim points; found from the shape when absent.
    pub front: Option<Axis>,
    /// Length of the hem that the cap shall have, metres: 0.45 to 0.70.
    pub circumference_m: f64,
}

impl Default for Options {
    /// Y up, front found, a hem that sits on the head as the generated caps do.
    fn default() -> Self {
        Self { up: Axis::PlusY, front: None, circumference_m: 0.545 }
    }
}

/// Largest number of triangles that is read.
pub const LARGEST_MESH: usize = 200_000;
/// Largest file that is read, bytes.
const LARGEST_FILE: u64 = 64 << 20;
/// Edge length that the simulation wants, metres.
const EDGE_M: f64 = 0.0118;

/// Why a mesh was refused.
#[derive(Debug, thiserror::Error)]
pub enum ImportFault {
    /// The file cannot be read.
    #[error("{0} cannot be read: {1}")]
    Unreadable(PathBuf, std::io::Error),
    /// The file is larger than 64 MiB.
    #[error("the file has {0} bytes; at most 64 MiB are read")]
    TooLarge(u64),
    /// The file is no OBJ.
    #[error("the file is not a valid OBJ: {0}")]
    NotObj(tobj::LoadError),
    /// There is no triangle, or none of any area.
    #[error("the mesh has no faces")]
    NoFaces,
    /// More triangles than [`LARGEST_MESH`].
    #[error("the mesh has {0} triangles; at most {LARGEST_MESH} are read")]
    TooManyTriangles(usize),
    /// A vertex is NaN or infinite.
    #[error("vertex {0} is not finite")]
    NotFinite(usize),
    /// A face names a vertex that is not there.
    #[error("a face names vertex {0}, which is not there")]
    OutOfRange(u32),
    /// A front along the axis that points up.
    #[error("the front axis must be at a right angle to the up axis")]
    FrontIsUp,
    /// A circumference no head has.
    #[error("a hem of {0} m fits no head; give 0.45 to 0.70 m")]
    Circumference(f64),
    /// The shape is not that of a cap.
    #[error("the mesh does not look like a cap: {0}")]
    NotACap(&'static str),
    /// The finished numbers make no object.
    #[error("the mesh makes no object: {0}")]
    Object(#[from] ObjectFault),
}

/// Reads the OBJ file `path` as a cap that is called `name`.
///
/// # Errors
/// The first fault found; nothing is guessed about a mesh that does not look like a cap.
pub fn cap_from_obj(path: &Path, name: &str, options: &Options) -> Result<Object, ImportFault> {
    let unreadable = |e| ImportFault::Unreadable(path.to_owned(), e);
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > LARGEST_FILE {
        return Err(ImportFault::TooLarge(size));
    }
    let bytes = std::fs::read(path).map_err(unreadable)?;
    let load = tobj::LoadOptions { triangulate: true, single_index: false, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut bytes.as_slice(), &load, |_| {
        // Colours are of no use here: a missing material library is no fault.
        Ok(Default::default())
    })
    .map_err(ImportFault::NotObj)?;
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for model in models {
        let offset = vertices.len() as u32;
        let flat = model.mesh.positions;
        vertices.extend(
            flat.chunks_exact(3)
                .map(|c| Point3::new(f64::from(c[0]), f64::from(c[1]), f64::from(c[2]))),
        );
        let indices = model.mesh.indices.chunks_exact(3);
        triangles.extend(indices.map(|t| [t[0] + offset, t[1] + offset, t[2] + offset]));
    }
    cap_from_triangles(vertices, triangles, name, options)
}

/// Makes a cap that is called `name` of raw vertices (any unit) and triangles (any order).
///
/// # Errors
/// The first fault found.
pub fn cap_from_triangles(
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
    name: &str,
    options: &Options,
) -> Result<Object, ImportFault> {
    check(&vertices, &triangles, options)?;
    let turn = upright(options)?;
    let vertices = vertices.into_iter().map(|v| turn * v).collect();
    let mut sheet = Sheet { vertices, triangles };
    clean::clean(&mut sheet)?;
    clean::outer_wall(&mut sheet);
    clean::clean(&mut sheet)?;
    if options.front.is_none() {
        fit::turn_front_to_y(&mut sheet)?;
    }
    fit::scale_to_hem(&mut sheet, options.circumference_m)?;
    remesh::remesh(&mut sheet, EDGE_M);
    clean::clean(&mut sheet)?;
    let hem = fit::Hem::find(&sheet)?;
    let parts = parts::Parts::find(&sheet, &hem)?;
    fit::fit_rim(&mut sheet, &parts.rim, options.circumference_m);
    let mesh = sheet.into_mesh()?;
    Ok(Object::new(name, CATEGORY, mesh, parts.regions, MATERIALS, SOFTNESS_HZ)?)
}

/// Materials of a cap of which only the shape is known: the middle of what caps are made of.
const MATERIALS: [Material; 4] = [
    Material { density_kg_m2: 0.52, bending_n_m: 1e-4, thickness_m: 0.001 },
    Material { density_kg_m2: 0.57, bending_n_m: 5e-3, thickness_m: 0.0012 },
    Material { density_kg_m2: 0.80, bending_n_m: 0.1, thickness_m: 0.0028 },
    Material { density_kg_m2: 1.04, bending_n_m: 4e-4, thickness_m: 0.0015 },
];
/// Whole-object frequency of such a cap.
const SOFTNESS_HZ: f64 = 4.7;

fn check(
    vertices: &[Point3<f64>],
    triangles: &[[u32; 3]],
    options: &Options,
) -> Result<(), ImportFault> {
    if !(0.45..=0.70).contains(&options.circumference_m) {
        return Err(ImportFault::Circumference(options.circumference_m));
    }
    if triangles.is_empty() {
        return Err(ImportFault::NoFaces);
    }
    if triangles.len() > LARGEST_MESH {
        return Err(ImportFault::TooManyTriangles(triangles.len()));
    }
    if let Some(i) = vertices.iter().position(|v| !v.coords.iter().all(|c| c.is_finite())) {
        return Err(ImportFault::NotFinite(i));
    }
    match triangles.iter().flatten().find(|v| **v as usize >= vertices.len()) {
        Some(v) => Err(ImportFault::OutOfRange(*v)),
        None => Ok(()),
    }
}

/// The rotation that turns the file's up to +z and its front, if known, to +y.
fn upright(options: &Options) -> Result<Matrix3<f64>, ImportFault> {
    let up = options.up.vector();
    let front = match options.front {
        Some(axis) => axis.vector(),
        None => Vector3::new(up.y, up.z, up.x),
    };
    if up.dot(&front).abs() > 0.5 {
        return Err(ImportFault::FrontIsUp);
    }
    Ok(Matrix3::from_columns(&[front.cross(&up), front, up]).transpose())
}

#[cfg(test)]
mod tests;
