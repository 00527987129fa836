//! A deformable object: its rest shape, what it is made of, and where.

use seeone_core::TriangleMesh;
use serde::{Deserialize, Serialize};

/// Which part of a cap a triangle belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Region {
    /// The soft dome.
    Crown,
    /// The stiffened front panels (buckram).
    Front,
    /// The visor.
    Brim,
    /// The sweat band along the opening.
    Hem,
}

impl Region {
    /// Every region, in the order of [`Object::materials`].
    pub const ALL: [Self; 4] = [Self::Crown, Self::Front, Self::Brim, Self::Hem];

    /// Index into [`Object::materials`].
    pub const fn index(self) -> usize {
        self as usize
    }
}

/// A thin shell's material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Mass per area, kg/m2.
    pub density_kg_m2: f64,
    /// Bending stiffness B, N m.
    pub bending_n_m: f64,
    /// Thickness, metres.
    pub thickness_m: f64,
}

impl Material {
    /// Bending stiffness above which a region counts as rigid: a moulded visor has 0.05 to
    /// 0.3 N m, and sweeps at this resolution cannot tell it from a wet one without a
    /// rigid cluster.
    const RIGID_BENDING_N_M: f64 = 0.02;

    /// Whether a region of it keeps its shape whatever happens.
    pub fn is_rigid(&self) -> bool {
        self.bending_n_m >= Self::RIGID_BENDING_N_M
    }
}

/// What can be turned about the object's z axis without being another state of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Symmetry {
    /// Nothing: it has a front.
    #[default]
    None,
    /// All of it: a hat whose front nobody could name.
    Round,
}

impl Symmetry {
    /// Whether it has a front.
    pub fn is_none(&self) -> bool {
        *self == Self::None
    }
}

/// Why numbers do not describe an object.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ObjectFault {
    /// Not one region for each triangle.
    #[error("{regions} regions were given for {triangles} triangles")]
    Regions {
        /// How many regions were given.
        regions: usize,
        /// How many triangles the mesh has.
        triangles: usize,
    },
    /// A vertex that no triangle of any area touches: it would weigh nothing.
    #[error("vertex {0} belongs to no triangle of any area")]
    LooseVertex(usize),
    /// A material that is not finite and positive.
    #[error("the material of {0:?} must have finite numbers above zero")]
    Material(Region),
    /// A softness that is not finite, or negative.
    #[error("the softness must be a finite frequency of at least zero")]
    Softness,
}

/// A deformable object in its rest shape. Every number is finite, every vertex has mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Object {
    name: String,
    category: String,
    mesh: TriangleMesh,
    regions: Vec<Region>,
    materials: [Material; 4],
    softness_hz: f64,
    symmetry: Symmetry,
}

impl Object {
    /// Checks and takes an object. `mesh` is the rest shape in metres and in canonical
    /// orientation (z up, visor along +y, hem near z = 0); `regions` has one entry per
    /// triangle; `materials` are indexed by [`Region::index`]; `softness_hz` is the
    /// frequency at which the whole object returns to its rest shape (0: never).
    ///
    /// # Errors
    /// The first fault found.
    pub fn new(
        name: impl Into<String>,
        category: impl Into<String>,
        mesh: TriangleMesh,
        regions: Vec<Region>,
        materials: [Material; 4],
        softness_hz: f64,
    ) -> Result<Self, ObjectFault> {
        let triangles = mesh.triangles().len();
        if regions.len() != triangles {
            return Err(ObjectFault::Regions { regions: regions.len(), triangles });
        }
        for (region, m) in Region::ALL.into_iter().zip(&materials) {
            let numbers = [m.density_kg_m2, m.bending_n_m, m.thickness_m];
            if !numbers.iter().all(|v| v.is_finite() && *v > 0.0) {
                return Err(ObjectFault::Material(region));
            }
        }
        if !softness_hz.is_finite() || softness_hz < 0.0 {
            return Err(ObjectFault::Softness);
        }
        let object = Self {
            name: name.into(),
            category: category.into(),
            mesh,
            regions,
            materials,
            softness_hz,
            symmetry: Symmetry::None,
        };
        match object.vertex_masses().iter().position(|m| *m <= 0.0) {
            Some(vertex) => Err(ObjectFault::LooseVertex(vertex)),
            None => Ok(object),
        }
    }

    /// The same object with this symmetry; [`Self::new`] gives none.
    #[must_use]
    pub fn with_symmetry(self, symmetry: Symmetry) -> Self {
        Self { symmetry, ..self }
    }

    /// What can be turned about z without being another state of it.
    pub fn symmetry(&self) -> Symmetry {
        self.symmetry
    }

    /// Its name, unique within a set.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The category it belongs to, e.g. `cap`.
    pub fn category(&self) -> &str {
        &self.category
    }

    /// Rest shape: metres, z up, visor along +y, hem near z = 0.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The region of each triangle.
    pub fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// Materials, indexed by [`Region::index`].
    pub fn materials(&self) -> &[Material; 4] {
        &self.materials
    }

    /// Material of the triangle `index`.
    pub fn material(&self, index: usize) -> &Material {
        &self.materials[self.regions[index].index()]
    }

    /// Frequency of the whole object's return to its rest shape, Hz.
    pub fn softness_hz(&self) -> f64 {
        self.softness_hz
    }

    /// Mass of each vertex, kg: a third of every adjoining triangle's.
    pub fn vertex_masses(&self) -> Vec<f64> {
        let mut masses = vec![0.0; self.mesh.vertices().len()];
        for (i, t) in self.mesh.triangles().iter().enumerate() {
            let [a, b, c] = self.mesh.corners(i);
            let area = (b - a).cross(&(c - a)).norm() / 2.0;
            for v in t {
                masses[*v as usize] += self.material(i).density_kg_m2 * area / 3.0;
            }
        }
        masses
    }

    /// Total mass, kg.
    pub fn mass(&self) -> f64 {
        self.vertex_masses().iter().sum()
    }

    /// Ascending indices of the vertices that a triangle of `region` touches.
    pub fn vertices_of(&self, region: Region) -> Vec<usize> {
        let mut touched = vec![false; self.mesh.vertices().len()];
        for (t, _) in self.mesh.triangles().iter().zip(&self.regions).filter(|(_, r)| **r == region)
        {
            t.iter().for_each(|v| touched[*v as usize] = true);
        }
        (0..touched.len()).filter(|v| touched[*v]).collect()
    }
}
