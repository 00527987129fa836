//! Where vertical lines go through a mesh.
//!
//! Seen from above, a triangle covers a point if the point's ray along +x leaves it: an odd
//! edge is crossed. Each edge tells by itself whether the ray crosses it, the same for all
//! triangles that share it, so no line slips through between two triangles or is counted
//! twice, wherever it goes through an edge or a vertex. An end at the height of the ray
//! counts as below it, and a point on an edge lies right of it: as if it were moved by an
//! infinitely small way along +x and by an infinitely smaller one along +y.

use super::cross;
use crate::TriangleMesh;
use nalgebra::Point3;

/// All vertical lines with one y.
pub struct Row {
    y: f64,
    slices: Vec<Slice>,
}

/// A triangle cut by the vertical plane of a row: one of its edges goes up through the row
/// (towards +y), the other down.
struct Slice {
    up: Cut,
    down: Cut,
}

/// An edge cut by the vertical plane of a row.
struct Cut {
    /// Its end with the smaller y, and the other.
    ends: [Point3<f64>; 2],
    /// Where the plane cuts it.
    x: f64,
    z: f64,
}

/// The crossings of one vertical line: the height of each, and +1 where the line leaves
/// through the surface upward, -1 where it enters.
pub struct Crossings(Vec<(f64, f64)>);

impl Row {
    /// The triangles of `mesh` that the plane of this `y` cuts.
    pub fn new(mesh: &TriangleMesh, y: f64) -> Self {
        let slice = |index: usize| {
            let [a, b, c] = mesh.corners(index);
            let (mut up, mut down) = (None, None);
            for [from, to] in [[a, b], [b, c], [c, a]] {
                match (from.y <= y, to.y <= y) {
                    (true, false) => up = Some(Cut::new([from, to], y)),
                    (false, true) => down = Some(Cut::new([to, from], y)),
                    _ => {}
                }
            }
            Some(Slice { up: up?, down: down? })
        };
        Self { y, slices: (0..mesh.triangles().len()).filter_map(slice).collect() }
    }

    /// What the vertical line at `x` of this row crosses.
    pub fn column(&self, x: f64) -> Crossings {
        let crossing = |slice: &Slice| {
            let Slice { up, down } = slice;
            let sign = match (up.is_right_of(x, self.y), down.is_right_of(x, self.y)) {
                (true, false) => 1.0,
                (false, true) => -1.0,
                _ => return None,
            };
            // A triangle seen edge-on has no width: any height between its edges is as good.
            let share = (x - up.x) / (down.x - up.x);
            let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
            Some((up.z + share * (down.z - up.z), sign))
        };
        Crossings(self.slices.iter().filter_map(crossing).collect())
    }
}

impl Cut {
    fn new(ends: [Point3<f64>; 2], y: f64) -> Self {
        let [lower, upper] = ends;
        let share = (y - lower.y) / (upper.y - lower.y);
        let cut = lower + (upper - lower) * share;
        Self { ends, x: cut.x, z: cut.z }
    }

    fn is_right_of(&self, x: f64, y: f64) -> bool {
        let [lower, upper] = self.ends.map(|end| [end.x - x, end.y - y]);
        cross(lower, upper) > 0.0
    }
}

impl Crossings {
    /// How often the line leaves the surface above `z`, less how often it enters.
    pub fn above(&self, z: f64) -> f64 {
        self.0.iter().filter(|(height, _)| *height > z).map(|(_, sign)| sign).sum()
    }
}
