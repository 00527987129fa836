//! The level set of a field on a regular grid, by marching tetrahedra (Doi and Koide 1991):
//! fewer cases than marching cubes, none of them ambiguous.

use crate::surface::Triangle;
use nalgebra::{Point3, Vector3};

/// Values at the nodes of a cube's grid, from corner to corner of the unit cube.
pub struct Grid {
    /// Nodes along an edge, two or more.
    side: usize,
    /// Node `(i, j, k)` at `(i * side + j) * side + k`.
    values: Vec<f64>,
}

/// The six tetrahedra around a cube's diagonal, by corners: bit 2 is x, bit 1 y, bit 0 z.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 4, 6, 7], [0, 4, 5, 7], [0, 2, 6, 7], [0, 2, 3, 7], [0, 1, 5, 7], [0, 1, 3, 7]];

impl Grid {
    /// The nodes of a grid of `side` nodes along an edge, in the order of its values.
    pub fn nodes(side: usize) -> Vec<Point3<f64>> {
        let at = |i: usize| i as f64 / (side - 1) as f64;
        let place = |n: usize| [n / (side * side), n / side % side, n % side].map(at);
        (0..side.pow(3)).map(|n| Point3::from(place(n))).collect()
    }

    /// The grid of these values; nothing when they are not `side` cubed.
    pub fn new(side: usize, values: Vec<f64>) -> Option<Self> {
        (side >= 2 && values.len() == side.pow(3)).then_some(Self { side, values })
    }

    /// Where the field passes `level` at least as steeply as `least_slope` (per cube edge).
    ///
    /// The winding number of an open surface also passes 1/2 in the opening, gently: without
    /// a least slope that phantom sheet would count as surface.
    pub fn level_set(&self, level: f64, least_slope: f64) -> Vec<Triangle> {
        let slopes: Vec<f64> = (0..self.values.len()).map(|n| self.slope(n)).collect();
        let mut found = Vec::new();
        let n = self.side - 1;
        for (i, j, k) in
            (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k))))
        {
            let corner = |c: usize| self.number(i + (c >> 2), j + (c >> 1 & 1), k + (c & 1));
            let values: [f64; 8] = std::array::from_fn(|c| self.values[corner(c)] - level);
            if values.iter().all(|v| *v < 0.0) || values.iter().all(|v| *v >= 0.0) {
                continue;
            }
            let steepest = (0..8).map(|c| slopes[corner(c)]).fold(0.0, f64::max);
            if steepest < least_slope {
                continue;
            }
            let place = |c: usize| {
                let at = |i: usize, bit: usize| (i + bit) as f64 / n as f64;
                Point3::new(at(i, c >> 2), at(j, c >> 1 & 1), at(k, c & 1))
            };
            for corners in TETRAHEDRA {
                cut(corners.map(|c| (place(c), values[c])), &mut found);
            }
        }
        found
    }

    fn number(&self, i: usize, j: usize, k: usize) -> usize {
        (i * self.side + j) * self.side + k
    }

    /// Length of the gradient at a node, per cube edge.
    fn slope(&self, number: usize) -> f64 {
        let side = self.side;
        let at = [number / (side * side), number / side % side, number % side];
        let strides = [side * side, side, 1];
        let gradient = Vector3::from_fn(|axis, _| {
            let back = usize::from(at[axis] > 0);
            let ahead = usize::from(at[axis] + 1 < side);
            let change = self.values[number + ahead * strides[axis]]
                - self.values[number - back * strides[axis]];
            change * (side - 1) as f64 / (back + ahead) as f64
        });
        gradient.norm()
    }
}

/// Where a tetrahedron of corners and values is zero.
fn cut(corners: [(Point3<f64>, f64); 4], found: &mut Vec<Triangle>) {
    let (inside, outside): (Vec<_>, Vec<_>) = corners.into_iter().partition(|(_, v)| *v >= 0.0);
    let between =
        |a: &(Point3<f64>, f64), b: &(Point3<f64>, f64)| a.0 + (b.0 - a.0) * (a.1 / (a.1 - b.1));
    match (inside.as_slice(), outside.as_slice()) {
        ([one], [a, b, c]) | ([a, b, c], [one]) => {
            found.push([between(one, a), between(one, b), between(one, c)]);
        }
        ([a, b], [c, d]) => {
            let [ac, ad, bc, bd] = [between(a, c), between(a, d), between(b, c), between(b, d)];
            found.extend([[ac, ad, bd], [ac, bd, bc]]);
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(triangles: &[Triangle]) -> f64 {
        triangles.iter().map(|[a, b, c]| 0.5 * (b - a).cross(&(c - a)).norm()).sum()
    }

    #[test]
    fn a_ball_has_its_surface_and_a_radius() {
        let centre = Point3::new(0.48, 0.52, 0.5);
        let values = Grid::nodes(48).iter().map(|p| 0.3 - (p - centre).norm()).collect();
        let ball = Grid::new(48, values).expect("a grid").level_set(0.0, 0.5);
        let expected = 4.0 * std::f64::consts::PI * 0.09;
        assert!((area(&ball) / expected - 1.0).abs() < 0.01, "{}", area(&ball));
        assert!(ball.iter().flatten().all(|p| ((p - centre).norm() - 0.3).abs() < 2e-3));
    }

    #[test]
    fn what_is_too_gentle_is_no_surface() {
        let plane = |slope: f64| {
            let values = Grid::nodes(16).iter().map(|p| slope * (p.x - 0.47)).collect();
            Grid::new(16, values).expect("a grid").level_set(0.0, 2.0)
        };
        assert!(plane(1.9).is_empty());
        assert!((area(&plane(2.1)) - 1.0).abs() < 1e-9);
        assert!(Grid::new(16, vec![0.0; 7]).is_none());
    }
}
