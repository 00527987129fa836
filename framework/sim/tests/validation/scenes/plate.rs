//! Flat pieces of cloth on a lattice of equilateral triangles: the mesh on which springs and
//! hinges have the moduli that their material names, in every direction.

use nalgebra::{Point3, Vector3};
use seeone_core::{Pose, TriangleMesh};
use seeone_sim::{Material, Object, Region, Settings, Surroundings, World};

/// Cap fabric without bending stiffness to speak of.
pub const LIMP: Material = Material { density_kg_m2: 0.3, bending_n_m: 1e-9, thickness_m: 1e-3 };

/// A rectangle in the plane z = 0: straight columns of vertices along y, half a triangle's
/// height apart from x = 0 on, in the middle y = 0.
#[derive(Clone, Copy, Debug)]
pub struct Plate {
    /// Length of an edge, metres.
    pub edge_m: f64,
    /// Rows of triangles along x: one less than there are columns.
    pub strips: usize,
    /// Edges along y.
    pub across: usize,
    /// What it is made of.
    pub material: Material,
}

impl Plate {
    /// Distance between two columns, metres.
    pub fn pitch_m(&self) -> f64 {
        self.edge_m * 0.75f64.sqrt()
    }

    /// From the first to the last column, metres.
    pub fn length_m(&self) -> f64 {
        self.pitch_m() * self.strips as f64
    }

    /// The `y` of the vertices of a column: an odd one is shifted by half an edge, and ends
    /// in halves so that the plate's sides are straight.
    fn column(&self, index: usize) -> Vec<f64> {
        let n = self.across as f64;
        let steps: Vec<f64> = if index.is_multiple_of(2) {
            (0..=self.across).map(|j| j as f64).collect()
        } else {
            let inner = (0..self.across).map(|j| j as f64 + 0.5);
            [0.0].into_iter().chain(inner).chain([n]).collect()
        };
        steps.iter().map(|s| (s - n / 2.0) * self.edge_m).collect()
    }

    /// Indices of the vertices of the column `index`.
    pub fn vertices_of(&self, index: usize) -> std::ops::Range<usize> {
        let start = (0..index).map(|i| self.column(i).len()).sum();
        start..start + self.column(index).len()
    }

    /// The object. Nothing but springs and hinges holds it together: no clusters.
    pub fn object(&self) -> Object {
        let columns: Vec<Vec<f64>> = (0..=self.strips).map(|i| self.column(i)).collect();
        let vertices = columns
            .iter()
            .enumerate()
            .flat_map(|(i, c)| c.iter().map(move |y| (i as f64, *y)))
            .map(|(i, y)| Point3::new(i * self.pitch_m(), y, 0.0))
            .collect();
        let triangles: Vec<[u32; 3]> =
            (0..self.strips).flat_map(|i| self.between(i, &columns[i], &columns[i + 1])).collect();
        let regions = vec![Region::Crown; triangles.len()];
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        Object::new("plate", "plate", mesh, regions, [self.material; 4], 0.0).unwrap()
    }

    /// Triangles between the columns `index` and the next: from the lower end always on to
    /// whichever side's next vertex is lower.
    fn between(&self, index: usize, left: &[f64], right: &[f64]) -> Vec<[u32; 3]> {
        let (a, b) = (self.vertices_of(index).start, self.vertices_of(index + 1).start);
        let (mut i, mut j) = (0, 0);
        let mut triangles = Vec::new();
        while i + 1 < left.len() || j + 1 < right.len() {
            let next = |side: &[f64], k: usize| side.get(k + 1).copied().unwrap_or(f64::INFINITY);
            let (p, q) = (a + i, b + j);
            if next(right, j) <= next(left, i) {
                triangles.push([p as u32, q as u32, q as u32 + 1]);
                j += 1;
            } else {
                triangles.push([p as u32, q as u32, p as u32 + 1]);
                i += 1;
            }
        }
        triangles
    }

    /// A world with nothing but this plate under gravity (0, 0, -9.81) m/s2. `damping` is in
    /// 1/s; what comes to rest does so at the same place whatever its value.
    pub fn world(&self, substeps: usize, damping: f64) -> World {
        let gravity = Vector3::new(0.0, 0.0, -9.81);
        let settings =
            Settings { substeps, gravity, velocity_damping: damping, self_contact: false };
        World::new(&self.object(), &Pose::identity(), Surroundings::default(), settings)
    }

    /// Mean position of the vertices of a column.
    pub fn middle(&self, world: &World, index: usize) -> Point3<f64> {
        let range = self.vertices_of(index);
        let count = range.len() as f64;
        (world.vertices()[range].iter().map(|p| p.coords).sum::<Vector3<f64>>() / count).into()
    }

    /// Puts the column `i` of the plate at `at(i)`, x and z, its vertices' y unchanged.
    pub fn bend(&self, world: &mut World, at: impl Fn(usize) -> (f64, f64)) {
        let placed: Vec<Point3<f64>> = (0..=self.strips)
            .flat_map(|i| self.column(i).into_iter().map(move |y| (i, y)))
            .map(|(i, y)| Point3::new(at(i).0, y, at(i).1))
            .collect();
        world.set_vertices(&placed).unwrap();
    }

    /// Pins the given columns where they are.
    pub fn pin(&self, world: &mut World, columns: &[usize]) {
        let pinned: Vec<usize> = columns.iter().flat_map(|i| self.vertices_of(*i)).collect();
        world.pin(&pinned).unwrap();
    }
}
