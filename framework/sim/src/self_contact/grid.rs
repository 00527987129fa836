//! Points sorted into cubic cells.

use nalgebra::{Point3, Vector3};

/// Cells along one axis at most; a scattered cloud gets larger cells instead of more.
const CELLS_PER_AXIS: usize = 48;

/// Points by cell, in a counting sort over the cloud's bounding box: ascending indices
/// inside a cell, no hashing, no allocation once it has grown.
#[derive(Clone, Debug, Default)]
pub struct Grid {
    low: Point3<f64>,
    cell_m: f64,
    counts: [usize; 3],
    /// Where each cell's points start in `order`; one entry more than cells.
    starts: Vec<u32>,
    /// The points, cell by cell, with their indices.
    sorted: Vec<(Point3<f64>, u32)>,
    cell_of: Vec<u32>,
}

impl Grid {
    /// Sorts `points` into cells of `cell_m` metres or more. The points must be finite.
    pub fn fill(&mut self, points: &[Point3<f64>], cell_m: f64) {
        let mut low = Point3::from(Vector3::repeat(f64::INFINITY));
        let mut high = Point3::from(Vector3::repeat(f64::NEG_INFINITY));
        for p in points {
            low = low.inf(p);
            high = high.sup(p);
        }
        self.low = low;
        self.cell_m = cell_m.max((high - low).max() / CELLS_PER_AXIS as f64);
        self.counts = [0, 1, 2].map(|k| ((high[k] - low[k]) / self.cell_m) as usize + 1);

        let cells = self.counts.iter().product::<usize>();
        self.starts.clear();
        self.starts.resize(cells + 1, 0);
        self.cell_of.clear();
        for p in points {
            let [x, y, z] = self.cell(p);
            let cell = self.index(x, y, z);
            self.cell_of.push(cell as u32);
            self.starts[cell + 1] += 1;
        }
        for cell in 0..cells {
            self.starts[cell + 1] += self.starts[cell];
        }
        self.sorted.clear();
        self.sorted.resize(points.len(), (Point3::origin(), 0));
        // Backwards, with the end of each cell as the cursor, leaves indices ascending
        // and `starts` shifted down to where it belongs.
        for (index, cell) in self.cell_of.iter().enumerate().rev() {
            let end = &mut self.starts[*cell as usize + 1];
            *end -= 1;
            self.sorted[*end as usize] = (points[index], index as u32);
        }
        self.starts.remove(0);
        self.starts.push(points.len() as u32);
    }

    /// Visits every point of the box around `corners` that is `reach` wider on each side.
    pub fn for_each_around(&self, corners: &[Point3<f64>; 3], reach: f64, visit: impl FnMut(u32)) {
        let [a, b, c] = corners;
        let margin = Vector3::repeat(reach);
        self.for_each_within(&(a.inf(b).inf(c) - margin), &(a.sup(b).sup(c) + margin), visit);
    }

    /// Visits every point of the box from `low` to `high`.
    fn for_each_within(&self, low: &Point3<f64>, high: &Point3<f64>, mut visit: impl FnMut(u32)) {
        let (first, last) = (self.cell(low), self.cell(high));
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                let row = self.index(first[0], y, z)..=self.index(last[0], y, z);
                let range = self.starts[*row.start()] as usize..self.starts[row.end() + 1] as usize;
                for (p, index) in &self.sorted[range] {
                    // Without a branch an axis: which of them fails cannot be predicted.
                    if (0..3).fold(true, |all, k| all & (low[k] <= p[k]) & (p[k] <= high[k])) {
                        visit(*index);
                    }
                }
            }
        }
    }

    fn cell(&self, p: &Point3<f64>) -> [usize; 3] {
        // The conversion saturates at zero; beyond the last cell is clamped to it.
        [0, 1, 2].map(|k| (((p[k] - self.low[k]) / self.cell_m) as usize).min(self.counts[k] - 1))
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{generator, uniform};

    #[test]
    fn finds_the_same_points_as_looking_at_each() {
        let mut rng = generator(1, "grid");
        let mut draw = || Point3::from([0, 1, 2].map(|_| uniform(&mut rng, -0.1, 0.2)));
        let points: Vec<_> = (0..300).map(|_| draw()).collect();
        let mut grid = Grid::default();
        grid.fill(&points, 0.02);
        for _ in 0..20 {
            let (a, b) = (draw(), draw());
            let (low, high) = (a.inf(&b), a.sup(&b));
            let mut found = Vec::new();
            grid.for_each_within(&low, &high, |p| found.push(p));
            found.sort_unstable();
            let inside = |p: &Point3<f64>| (0..3).all(|k| low[k] <= p[k] && p[k] <= high[k]);
            let truth: Vec<u32> = (0..300).filter(|i| inside(&points[*i as usize])).collect();
            assert_eq!(found, truth);
        }
    }
}
