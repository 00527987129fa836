//! Stretching: one distance constraint per edge.

use super::colouring::by_colour;
use super::lanes::{self, LANES, Lanes, each, from_lane, into_lane};
use super::topology::Edge;
use nalgebra::Point3;
use seeone_core::TriangleMesh;
use seeone_core::vectorize::vectorize;

/// Membrane stiffness E t of cap fabric, N/m. A woven twill reaches 2 to 5 kN/m; above
/// this an unconverged sweep gains nothing but worst-edge strain.
const MEMBRANE_N_M: f64 = 2.0e3;

#[derive(Clone, Copy, Debug)]
struct Spring {
    ends: [usize; 2],
    rest_m: f64,
    stiffness_n_m: f64,
}

/// Every edge of a shell as an XPBD distance constraint (Macklin et al. 2016).
///
/// Each substep sweeps it twice, backward before bending and forward after it, with half
/// the stiffness each time: the two sweeps are each other's transpose in the mass metric,
/// so that their product has real eigenvalues and cannot pump energy. A one-way sweep
/// has complex ones, and does.
#[derive(Clone, Debug)]
pub struct Stretch {
    springs: Vec<Spring>,
    /// The same, as they are solved.
    batches: Vec<Batch>,
}

impl Stretch {
    /// Springs over the edges of the rest shape `mesh`, coloured, with border edges last
    /// so that the opening keeps its length best.
    pub fn new(mesh: &TriangleMesh, edges: &[Edge]) -> Self {
        let spring = |edge: &Edge| {
            let [a, b] = edge.ends.map(|v| mesh.vertices()[v]);
            let squared = (b - a).norm_squared();
            let area: f64 = edge.triangles.iter().map(|t| area(mesh, *t)).sum();
            Spring {
                ends: edge.ends,
                rest_m: squared.sqrt(),
                stiffness_n_m: MEMBRANE_N_M * area / squared.max(f64::MIN_POSITIVE),
            }
        };
        let (border, inside): (Vec<&Edge>, Vec<&Edge>) = edges.iter().partition(|e| e.is_border());
        let mut springs: Vec<Spring> = inside.into_iter().map(spring).collect();
        let apart = by_colour(&mut springs, mesh.vertices().len(), |s| s.ends);
        let inside = apart.into_iter().flat_map(|run| springs[run].chunks(LANES));
        // One after the other: coloured, a swinging strip's border gains energy.
        let border: Vec<Spring> = border.into_iter().map(spring).collect();
        let batches = inside.chain(border.chunks(1)).map(Batch::new).collect();
        springs.extend(border);
        Self { springs, batches }
    }

    /// The sweep before bending.
    pub fn solve_backward(&self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        vectorize(
            #[inline(always)]
            || {
                for batch in self.batches.iter().rev() {
                    batch.solve(position, inverse_mass, h);
                }
            },
        );
    }

    /// The sweep after bending.
    pub fn solve_forward(&self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        vectorize(
            #[inline(always)]
            || {
                for batch in &self.batches {
                    batch.solve(position, inverse_mass, h);
                }
            },
        );
    }

    /// Elastic energy, J.
    pub fn energy(&self, position: &[Point3<f64>]) -> f64 {
        let energy = |s: &Spring| s.stiffness_n_m * s.excess(position).powi(2) / 2.0;
        self.springs.iter().map(energy).sum()
    }

    /// Mean and largest absolute strain over the edges.
    pub fn strain(&self, position: &[Point3<f64>]) -> (f64, f64) {
        let add = |(sum, worst): (f64, f64), e: f64| (sum + e, worst.max(e));
        let (sum, worst) = self.strains(position).fold((0.0, 0.0), add);
        (sum / self.springs.len().max(1) as f64, worst)
    }

    /// The absolute strain that `share` (0 to 1) of the edges do not exceed.
    pub fn strain_quantile(&self, position: &[Point3<f64>], share: f64) -> f64 {
        let mut strains: Vec<f64> = self.strains(position).collect();
        strains.sort_unstable_by(f64::total_cmp);
        let last = strains.len().saturating_sub(1);
        strains.get((share.clamp(0.0, 1.0) * last as f64).ceil() as usize).copied().unwrap_or(0.0)
    }

    fn strains(&self, position: &[Point3<f64>]) -> impl Iterator<Item = f64> {
        self.springs.iter().map(|s| s.excess(position).abs() / s.rest_m)
    }
}

impl Spring {
    fn excess(&self, position: &[Point3<f64>]) -> f64 {
        (position[self.ends[1]] - position[self.ends[0]]).norm() - self.rest_m
    }
}

/// Springs that share no vertex.
#[derive(Clone, Debug)]
struct Batch {
    ends: lanes::Batch<2>,
    rest_m: Lanes,
    stiffness_n_m: Lanes,
}

impl Batch {
    /// One to [`LANES`] springs.
    fn new(springs: &[Spring]) -> Self {
        Self {
            ends: lanes::Batch::new(springs, |s| s.ends),
            rest_m: each(springs, |s| s.rest_m),
            stiffness_n_m: each(springs, |s| s.stiffness_n_m),
        }
    }

    #[inline(always)]
    fn solve(&self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        let points = self.ends.gather(|v| position[v].coords);
        let masses = self.ends.masses(inverse_mass);
        let mut apart = lanes::vectors();
        let mut push = [0.0; LANES];
        for l in 0..LANES {
            let [a, b] = from_lane(&points, l);
            let along = b - a;
            into_lane(&mut apart, l, &[along, -along]);
            let length = along.norm();
            // Half the stiffness in each of the two sweeps.
            let compliance = 2.0 / (self.stiffness_n_m[l] * h * h);
            let impulse =
                (length - self.rest_m[l]) / ((masses[0][l] + masses[1][l] + compliance) * length);
            push[l] = if length > 0.0 { impulse } else { 0.0 };
        }
        self.ends.apply(position, &apart, &masses, &push);
    }
}

/// Area of the triangle `index`, m2.
pub fn area(mesh: &TriangleMesh, index: usize) -> f64 {
    let [a, b, c] = mesh.corners(index);
    (b - a).cross(&(c - a)).norm() / 2.0
}
