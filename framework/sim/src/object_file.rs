//! Objects as files: TOML, one table an object, at most 1 MiB.

use crate::object::{Material, Object, ObjectFault, Region, Symmetry};
use nalgebra::Point3;
use seeone_core::TriangleMesh;
use seeone_core::mesh::MeshFault;
use serde::{Deserialize, Serialize};

/// Largest file that is read, bytes.
pub const LARGEST_FILE: usize = 1 << 20;

/// Why a text is no object.
#[derive(Debug, thiserror::Error)]
pub enum ObjectFileFault {
    /// More than [`LARGEST_FILE`].
    #[error("the file has {0} bytes; at most {LARGEST_FILE} are read")]
    TooLarge(usize),
    /// No TOML, or not the keys of an object. Its span tells where.
    #[error("{0}")]
    Syntax(#[from] toml::de::Error),
    /// Another format version.
    #[error("schema {0} is not known, only 1")]
    Schema(u32),
    /// A region that is none.
    #[error("region \"{0}\" is not known; known: c (crown), f (front), b (brim), h (hem)")]
    Region(char),
    /// Vertices and triangles that make no mesh.
    #[error("{0}")]
    Mesh(#[from] MeshFault),
    /// A mesh and materials that make no object.
    #[error("{0}")]
    Object(#[from] ObjectFault),
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields {
    schema: u32,
    name: String,
    category: String,
    softness_hz: f64,
    #[serde(default, skip_serializing_if = "Symmetry::is_none")]
    symmetry: Symmetry,
    /// One letter for each triangle.
    regions: String,
    vertices_m: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    crown: MaterialFields,
    front: MaterialFields,
    brim: MaterialFields,
    hem: MaterialFields,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialFields {
    density_kg_m2: f64,
    bending_n_m: f64,
    thickness_m: f64,
}

impl From<&Material> for MaterialFields {
    fn from(m: &Material) -> Self {
        Self {
            density_kg_m2: m.density_kg_m2,
            bending_n_m: m.bending_n_m,
            thickness_m: m.thickness_m,
        }
    }
}

impl From<MaterialFields> for Material {
    fn from(m: MaterialFields) -> Self {
        Self {
            density_kg_m2: m.density_kg_m2,
            bending_n_m: m.bending_n_m,
            thickness_m: m.thickness_m,
        }
    }
}

/// The object as TOML text.
///
/// # Errors
/// When TOML cannot express it; no object is known for which that holds.
pub fn to_toml(object: &Object) -> Result<String, toml::ser::Error> {
    let material = |region: Region| (&object.materials()[region.index()]).into();
    toml::to_string(&Fields {
        schema: 1,
        name: object.name().to_owned(),
        category: object.category().to_owned(),
        softness_hz: object.softness_hz(),
        symmetry: object.symmetry(),
        regions: object.regions().iter().map(|r| letter(*r)).collect(),
        vertices_m: object.mesh().vertices().iter().map(|v| v.coords.into()).collect(),
        triangles: object.mesh().triangles().to_vec(),
        crown: material(Region::Crown),
        front: material(Region::Front),
        brim: material(Region::Brim),
        hem: material(Region::Hem),
    })
}

/// Reads what [`to_toml`] wrote.
///
/// # Errors
/// The first fault found.
pub fn from_toml(text: &str) -> Result<Object, ObjectFileFault> {
    if text.len() > LARGEST_FILE {
        return Err(ObjectFileFault::TooLarge(text.len()));
    }
    let fields: Fields = toml::from_str(text)?;
    if fields.schema != 1 {
        return Err(ObjectFileFault::Schema(fields.schema));
    }
    let regions = fields.regions.chars().map(region).collect::<Result<_, _>>()?;
    let vertices = fields.vertices_m.into_iter().map(Point3::from).collect();
    let mesh = TriangleMesh::new(vertices, fields.triangles)?;
    let materials = [fields.crown, fields.front, fields.brim, fields.hem].map(Material::from);
    let (name, softness_hz) = (fields.name, fields.softness_hz);
    let object = Object::new(name, fields.category, mesh, regions, materials, softness_hz)?;
    Ok(object.with_symmetry(fields.symmetry))
}

fn letter(region: Region) -> char {
    match region {
        Region::Crown => 'c',
        Region::Front => 'f',
        Region::Brim => 'b',
        Region::Hem => 'h',
    }
}

fn region(letter_read: char) -> Result<Region, ObjectFileFault> {
    let found = Region::ALL.into_iter().find(|r| letter(*r) == letter_read);
    found.ok_or(ObjectFileFault::Region(letter_read))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::cap;

    fn text() -> String {
        to_toml(&cap::named("cap-unseen-03").expect("a cap")).expect("TOML")
    }

    #[test]
    fn an_object_survives_writing_and_reading() {
        let text = text();
        assert!(text.len() < LARGEST_FILE / 4, "{} bytes", text.len());
        assert_eq!(from_toml(&text).expect("read"), cap::named("cap-unseen-03").expect("a cap"));
    }

    #[test]
    fn a_round_hat_stays_round_and_others_do_not_speak_of_it() {
        let hat = cap::named("cap-unseen-03").expect("a cap").with_symmetry(Symmetry::Round);
        let text = to_toml(&hat).expect("TOML");
        assert!(text.contains("symmetry = \"round\""));
        assert_eq!(from_toml(&text).expect("read"), hat);
        assert!(!to_toml(&hat.with_symmetry(Symmetry::None)).expect("TOML").contains("symmetry"));
    }

    #[test]
    fn what_is_no_object_is_refused() {
        let good = text();
        let cases = [
            ("schema = 1", "schema = 2", "schema 2 is not known"),
            ("category =", "kategory =", "kategory"),
            ("softness_hz = ", "softness_hz = -", "softness"),
            ("regions = \"", "regions = \"x", "region \"x\""),
            ("regions = \"", "regions = \"c", "regions were given"),
        ];
        for (from, to, told) in cases {
            let fault = from_toml(&good.replacen(from, to, 1)).expect_err("refused");
            assert!(fault.to_string().contains(told), "{fault}");
        }
        assert!(matches!(from_toml(&" ".repeat(2 << 20)), Err(ObjectFileFault::TooLarge(_))));
    }
}
