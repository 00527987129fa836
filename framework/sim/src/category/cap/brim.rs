//! The brim: a sheet of rows that grows from the hem, in front or all round.

use super::crown::Dome;
use super::resolution::Resolution;
use super::shape::Shape;
use super::template::{BrimPattern, Pattern};
use nalgebra::{Point3, Vector3};

/// The brim's own vertices and its triangles, which share the hem's vertices.
#[derive(Default)]
pub struct Brim {
    /// Vertices to be appended to the crown's, metres.
    pub vertices: Vec<Point3<f64>>,
    /// Triangles over crown and brim vertices, counter-clockwise from above.
    pub triangles: Vec<[u32; 3]>,
}

/// Builds the brim of `shape` on the finished crown of `dome`.
pub fn build(
    shape: &Shape,
    pattern: &Pattern,
    resolution: Resolution,
    dome: &Dome<'_>,
    crown: &[Point3<f64>],
) -> Brim {
    let rows = |part: f64| ((resolution.brim_rows() as f64 * part).round() as usize).max(2);
    match (pattern.brim, pattern.front_reach(resolution)) {
        (BrimPattern::Front { rows: part, .. }, Some(reach)) => {
            let sheet = Sheet { resolution, rows: rows(part), first: 1 - reach, last: reach - 1 };
            let half_width = [reach, reach / 2]
                .map(|j| crown[resolution.hem_vertex(j)].x.abs())
                .into_iter()
                .fold(0.0, f64::max);
            let vertices = sheet.vertices(crown, |j, start, away, along| {
                let across = dome.hem_angle(j) / shape.brim_half_angle;
                front_point(shape, start, away, [across, along], half_width)
            });
            let mut triangles = sheet.triangles(crown.len());
            triangles.extend(sheet.fans(crown.len()));
            Brim { vertices, triangles }
        }
        (BrimPattern::Round { rows: part }, _) => {
            let last = resolution.hem() as isize;
            let sheet = Sheet { resolution, rows: rows(part), first: 0, last };
            let vertices = sheet.vertices(crown, |_, start, away, along| {
                let length = shape.brim_length * along;
                let fall = shape.brim_slope.sin() * length + shape.brim_tip_drop * along.powi(2);
                start + away * (shape.brim_slope.cos() * length) - Vector3::z() * fall
            });
            Brim { vertices, triangles: sheet.triangles(crown.len()) }
        }
        _ => Brim::default(),
    }
}

/// A point of a front brim, `across` from its middle (0) to its ends (-1, 1) and `along` from
/// the hem (0) to its edge (1).
fn front_point(
    shape: &Shape,
    start: Point3<f64>,
    away: Vector3<f64>,
    [across, along]: [f64; 2],
    half_width: f64,
) -> Point3<f64> {
    let heading = away.lerp(&Vector3::y(), shape.brim_forwardness).normalize();
    let length = shape.brim_length * (1.0 - across.abs().powf(shape.brim_squareness)).powf(0.6);
    let mut p = start + heading * (length * along);
    let aside = (p.x / half_width).powi(2).min(1.5) - (start.x / half_width).powi(2);
    p.z -= shape.brim_slope.tan() * length * along
        + shape.brim_side_drop * (aside.max(0.0) + across.powi(2) * along.powf(0.7))
        + shape.brim_tip_drop * along.powi(2) * (1.0 - across.powi(2));
    p
}

/// Columns of `rows` vertices on the hem vertices `first..=last`. A sheet that ends where it
/// began is closed: its last column is its first.
struct Sheet {
    resolution: Resolution,
    rows: usize,
    first: isize,
    last: isize,
}

impl Sheet {
    fn is_closed(&self) -> bool {
        (self.last - self.first) as usize == self.resolution.hem()
    }

    fn columns(&self) -> usize {
        (self.last - self.first) as usize + usize::from(!self.is_closed())
    }

    /// Vertices, column by column, from the column's hem index, its vertex on the hem, the
    /// direction away from the hem and the part of the way to the edge.
    fn vertices(
        &self,
        crown: &[Point3<f64>],
        point: impl Fn(isize, Point3<f64>, Vector3<f64>, f64) -> Point3<f64>,
    ) -> Vec<Point3<f64>> {
        let on_hem = |j| crown[self.resolution.hem_vertex(j)];
        let mut all = Vec::with_capacity(self.columns() * self.rows);
        for j in (self.first..).take(self.columns()) {
            let tangent = on_hem(j + 1) - on_hem(j - 1);
            let away = Vector3::new(tangent.y, -tangent.x, 0.0).normalize();
            for row in 1..=self.rows {
                all.push(point(j, on_hem(j), away, row as f64 / self.rows as f64));
            }
        }
        all
    }

    /// Index of a vertex by column and row; row 0 is the hem. The sheet's own vertices begin
    /// at `base`.
    fn vertex(&self, base: usize, column: usize, row: usize) -> u32 {
        let column = column % self.columns();
        let index = match row {
            0 => self.resolution.hem_vertex(self.first + column as isize),
            _ => base + column * self.rows + row - 1,
        };
        index as u32
    }

    fn triangles(&self, base: usize) -> Vec<[u32; 3]> {
        let strips = (self.last - self.first) as usize;
        let mut all = Vec::with_capacity(2 * strips * self.rows);
        for column in 0..strips {
            for row in 0..self.rows {
                let [a, b] = [column, column + 1].map(|c| self.vertex(base, c, row));
                let [c, d] = [column, column + 1].map(|c| self.vertex(base, c, row + 1));
                // The diagonal leans the same way on both sides of the middle.
                if 2 * column < strips {
                    all.extend([[a, c, d], [a, d, b]]);
                } else {
                    all.extend([[a, c, b], [b, c, d]]);
                }
            }
        }
        all
    }

    /// The outline closes onto the hem at both ends, so the outermost columns are a fan: a
    /// column of vanishing length would give edges too short to simulate.
    fn fans(&self, base: usize) -> Vec<[u32; 3]> {
        let [right, left] =
            [self.first - 1, self.last + 1].map(|j| self.resolution.hem_vertex(j) as u32);
        let end = self.columns() - 1;
        (0..self.rows)
            .flat_map(|row| {
                let [a, b] = [row, row + 1].map(|row| self.vertex(base, 0, row));
                let [c, d] = [row, row + 1].map(|row| self.vertex(base, end, row));
                [[a, right, b], [c, d, left]]
            })
            .collect()
    }
}
