//! The boundary of a mesh, and the curtain that hangs on it from infinity above.

use super::cross;
use crate::TriangleMesh;
use nalgebra::Point3;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A point in the same column as a vertex is moved along +x by this and along +y by its
/// square: further than zero, and far less than any distance in a mesh. The crossings make
/// the same choice.
const NUDGE: f64 = 1e-30;
/// Factors after which a running product is brought back to the size of one.
const FACTORS: usize = 4;

/// The boundary of the triangles' sum: the edges at which they do not cancel.
#[derive(Clone, Debug)]
pub struct Boundary {
    vertices: Vec<Point3<f64>>,
    /// From vertex, to vertex; an edge that is left over twice is there twice.
    edges: Vec<[usize; 2]>,
}

impl Boundary {
    /// Adds up the directed edges of all triangles.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let mut left_over: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for [a, b, c] in mesh.triangles() {
            for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                *left_over.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        let mut numbers: BTreeMap<u32, usize> = BTreeMap::new();
        let (mut vertices, mut edges) = (Vec::new(), Vec::new());
        for (edge, count) in left_over.into_iter().filter(|(_, count)| *count != 0) {
            let [low, high] = edge.map(|v| {
                *numbers.entry(v).or_insert_with(|| {
                    vertices.push(mesh.vertices()[v as usize]);
                    vertices.len() - 1
                })
            });
            let directed = if count > 0 { [low, high] } else { [high, low] };
            edges.extend((0..count.abs()).map(|_| directed));
        }
        Self { vertices, edges }
    }
}

/// The curtain of a boundary, seen from the points of one column.
///
/// For the directions from a point to `a` and `b`, projected stereographically from the
/// zenith to the complex numbers `s = (x + iy) / r` with `r = distance - height`, the solid
/// angle of zenith, `a`, `b` is `-2 arg(1 + conj(s_a) s_b)`. Here `z_ab` is that number times
/// `r_a r_b`: `r_a r_b + (a . b) + i (a x b)` with the products taken in the plane.
pub struct Curtain<'a> {
    boundary: &'a Boundary,
    /// Squared distance of each vertex from the column.
    squared: Vec<f64>,
    edges: Vec<Strip>,
}

/// What an edge's `z_ab` has in common along the column.
struct Strip {
    ends: [usize; 2],
    dot: f64,
    cross: f64,
}

impl<'a> Curtain<'a> {
    /// Not placed yet: without strips.
    pub fn new(boundary: &'a Boundary) -> Self {
        Self { boundary, squared: Vec::new(), edges: Vec::new() }
    }

    /// Moves on to the column at `[x, y]`.
    pub fn place(&mut self, [x, y]: [f64; 2]) {
        let Boundary { vertices, edges } = self.boundary;
        let seen = |v: usize| [vertices[v].x - x, vertices[v].y - y];
        self.squared.clear();
        self.squared.extend((0..vertices.len()).map(|v| {
            let [x, y] = seen(v);
            x * x + y * y + NUDGE * NUDGE
        }));
        self.edges.clear();
        self.edges.extend(edges.iter().map(|ends| {
            let [a, b] = ends.map(seen);
            let exact = cross(a, b);
            let nudged = NUDGE * (a[1] - b[1]) + NUDGE * NUDGE * (b[0] - a[0]);
            Strip {
                ends: *ends,
                dot: a[0] * b[0] + a[1] * b[1] - NUDGE * (a[0] + b[0]) + NUDGE * NUDGE,
                cross: if exact == 0.0 { nudged } else { exact },
            }
        }));
    }

    /// The sum of `arg z_ab` in turns about the points of the column with these `z`.
    pub fn turns<const N: usize>(&self, z: [f64; N]) -> [f64; N] {
        let reaches: Vec<[f64; N]> = self
            .boundary
            .vertices
            .iter()
            .zip(&self.squared)
            .map(|(vertex, squared)| z.map(|z| reach(*squared, vertex.z - z)))
            .collect();
        let (mut re, mut im, mut turns) = ([1.0; N], [0.0; N], [0.0; N]);
        for strips in self.edges.chunks(FACTORS) {
            for strip in strips {
                let [a, b] = strip.ends.map(|v| &reaches[v]);
                // An angle beyond half a turn comes out at the other end of the range.
                let wrap = if strip.cross >= 0.0 { 1.0 } else { -1.0 };
                for l in 0..N {
                    let z = a[l] * b[l] + strip.dot;
                    let product =
                        [re[l] * z - im[l] * strip.cross, re[l] * strip.cross + im[l] * z];
                    let beyond = if strip.cross >= 0.0 {
                        im[l] >= 0.0 && product[1] < 0.0
                    } else {
                        im[l] < 0.0 && product[1] >= 0.0
                    };
                    turns[l] += if beyond { wrap } else { 0.0 };
                    [re[l], im[l]] = product;
                }
            }
            for l in 0..N {
                let size = 1.0 / re[l].abs().max(im[l].abs());
                (re[l], im[l]) = (re[l] * size, im[l] * size);
            }
        }
        // Minus zero would be half a turn off.
        std::array::from_fn(|l| turns[l] + (im[l] + 0.0).atan2(re[l]) / TAU)
    }
}

/// Distance less height of what lies `height` above a point and `squared.sqrt()` beside it,
/// without cancellation where it is nearly overhead.
#[inline(always)]
fn reach(squared: f64, height: f64) -> f64 {
    let sum = (squared + height * height).sqrt() + height.abs();
    if height > 0.0 { squared / sum } else { sum }
}
