//! Constraints side by side, in the lanes of the machine's vector unit.
//!
//! Constraints that share no vertex move it as one after the other would, to the bit. What
//! they need of their vertices is gathered first; loops over lanes then hold arithmetic
//! alone, for the compiler to vectorise; and what comes of it is handed out again.

#![expect(clippy::needless_range_loop, reason = "a lane is an index into many arrays at once")]

use nalgebra::Vector3;
use std::array::from_fn;

/// Constraints of a batch.
pub const LANES: usize = 8;
/// One number for each of them.
pub type Lanes = [f64; LANES];
/// A vector at each of a constraint's `N` vertices: by vertex, axis, lane.
pub type Vectors<const N: usize> = [[Lanes; 3]; N];

/// Vectors of no length.
#[inline(always)]
pub fn vectors<const N: usize>() -> Vectors<N> {
    [[[0.0; LANES]; 3]; N]
}

/// The vertices of up to [`LANES`] constraints of `N` vertices each.
#[derive(Clone, Debug)]
pub struct Batch<const N: usize> {
    /// Lanes beyond the last constraint repeat the first.
    vertices: [[u32; N]; LANES],
    /// How many constraints there are.
    count: usize,
}

impl<const N: usize> Batch<N> {
    /// Of one to [`LANES`] constraints, `of` tells their vertices.
    pub fn new<T>(constraints: &[T], of: impl Fn(&T) -> [usize; N]) -> Self {
        let vertices = |c: &T| of(c).map(|v| v as u32);
        Self { vertices: each(constraints, vertices), count: constraints.len() }
    }

    /// The vertices in one lane.
    #[inline(always)]
    pub fn vertices(&self, lane: usize) -> [usize; N] {
        self.vertices[lane].map(|v| v as usize)
    }

    /// The vector that each vertex has.
    #[inline(always)]
    pub fn gather(&self, of: impl Fn(usize) -> Vector3<f64>) -> Vectors<N> {
        let mut vectors = vectors();
        for l in 0..LANES {
            into_lane(&mut vectors, l, &self.vertices(l).map(&of));
        }
        vectors
    }

    /// The inverse mass that each vertex has.
    #[inline(always)]
    pub fn masses(&self, inverse_mass: &[f64]) -> [Lanes; N] {
        let mut masses = [[0.0; LANES]; N];
        for l in 0..LANES {
            let vertices = self.vertices(l);
            for n in 0..N {
                masses[n][l] = inverse_mass[vertices[n]];
            }
        }
        masses
    }

    /// Adds to what each vertex has `impulse` along the constraint's `gradient` there, by the
    /// vertex's inverse mass.
    #[inline(always)]
    pub fn apply<T: std::ops::AddAssign<Vector3<f64>>>(
        &self,
        to: &mut [T],
        gradient: &Vectors<N>,
        masses: &[Lanes; N],
        impulse: &Lanes,
    ) {
        let mut moved = *masses;
        for moved in &mut moved {
            for l in 0..LANES {
                moved[l] *= impulse[l];
            }
        }
        for l in 0..self.count {
            let (vertices, gradient) = (self.vertices(l), from_lane(gradient, l));
            for n in 0..N {
                to[vertices[n]] += gradient[n] * moved[n][l];
            }
        }
    }
}

/// What `of` tells of up to [`LANES`] constraints; lanes beyond the last repeat the first.
pub fn each<T, R>(constraints: &[T], of: impl Fn(&T) -> R) -> [R; LANES] {
    from_fn(|l| of(constraints.get(l).unwrap_or(&constraints[0])))
}

/// The vectors of one lane.
#[inline(always)]
pub fn from_lane<const N: usize>(vectors: &Vectors<N>, l: usize) -> [Vector3<f64>; N] {
    from_fn(|n| Vector3::new(vectors[n][0][l], vectors[n][1][l], vectors[n][2][l]))
}

/// Puts vectors into one lane.
#[inline(always)]
pub fn into_lane<const N: usize>(vectors: &mut Vectors<N>, l: usize, of: &[Vector3<f64>; N]) {
    for n in 0..N {
        for axis in 0..3 {
            vectors[n][axis][l] = of[n][axis];
        }
    }
}
