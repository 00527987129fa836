//! Stretching: one distance constraint per edge.

use super::colouring::by_colour;
use super::topology::Edge;
use nalgebra::Point3;
use seeone_core::TriangleMesh;

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
    /// Those inside a rigid part, which keeps their lengths without them.
    idle: Vec<Spring>,
}

impl Stretch {
    /// Springs over the edges of the rest shape `mesh`, coloured, with border edges last
    /// so that the opening keeps its length best. `rigid` tells whether vertices belong to
    /// one rigid part.
    pub fn new(mesh: &TriangleMesh, edges: &[Edge], rigid: &dyn Fn(&[usize]) -> bool) -> Self {
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
        let (idle, edges): (Vec<&Edge>, Vec<&Edge>) = edges.iter().partition(|e| rigid(&e.ends));
        let (border, inside): (Vec<&Edge>, Vec<&Edge>) =
            edges.into_iter().partition(|e| e.is_border());
        let mut springs: Vec<Spring> = inside.into_iter().map(spring).collect();
        by_colour(&mut springs, mesh.vertices().len(), |s| s.ends);
        springs.extend(border.into_iter().map(spring));
        Self { springs, idle: idle.into_iter().map(spring).collect() }
    }

    /// The sweep before bending.
    pub fn solve_backward(&self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        self.springs.iter().rev().for_each(|s| s.solve(position, inverse_mass, h));
    }

    /// The sweep after bending.
    pub fn solve_forward(&self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        self.springs.iter().for_each(|s| s.solve(position, inverse_mass, h));
    }

    /// Elastic energy, J.
    pub fn energy(&self, position: &[Point3<f64>]) -> f64 {
        let energy = |s: &Spring| s.stiffness_n_m * s.excess(position).powi(2) / 2.0;
        self.all().map(energy).sum()
    }

    /// Mean and largest absolute strain over the edges.
    pub fn strain(&self, position: &[Point3<f64>]) -> (f64, f64) {
        let add = |(sum, worst): (f64, f64), e: f64| (sum + e, worst.max(e));
        let (sum, worst) = self.strains(position).fold((0.0, 0.0), add);
        (sum / self.all().count().max(1) as f64, worst)
    }

    /// The absolute strain that `share` (0 to 1) of the edges do not exceed.
    pub fn strain_quantile(&self, position: &[Point3<f64>], share: f64) -> f64 {
        let mut strains: Vec<f64> = self.strains(position).collect();
        strains.sort_unstable_by(f64::total_cmp);
        let last = strains.len().saturating_sub(1);
        strains.get((share.clamp(0.0, 1.0) * last as f64).ceil() as usize).copied().unwrap_or(0.0)
    }

    fn strains(&self, position: &[Point3<f64>]) -> impl Iterator<Item = f64> {
        self.all().map(|s| s.excess(position).abs() / s.rest_m)
    }

    fn all(&self) -> impl Iterator<Item = &Spring> {
        self.springs.iter().chain(&self.idle)
    }
}

impl Spring {
    fn excess(&self, position: &[Point3<f64>]) -> f64 {
        (position[self.ends[1]] - position[self.ends[0]]).norm() - self.rest_m
    }

    #[inline]
    fn solve(&self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        let [a, b] = self.ends;
        let (wa, wb) = (inverse_mass[a], inverse_mass[b]);
        let apart = position[b] - position[a];
        let length = apart.norm();
        if wa + wb <= 0.0 || length <= 0.0 {
            return;
        }
        let compliance = 2.0 / (self.stiffness_n_m * h * h);
        let push = (length - self.rest_m) / ((wa + wb + compliance) * length);
        position[a] += apart * (wa * push);
        position[b] -= apart * (wb * push);
    }
}

/// Area of the triangle `index`, m2.
pub fn area(mesh: &TriangleMesh, index: usize) -> f64 {
    let [a, b, c] = mesh.corners(index);
    (b - a).cross(&(c - a)).norm() / 2.0
}
