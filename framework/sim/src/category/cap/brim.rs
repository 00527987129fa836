//! The brim: a sheet of rows that grows from the front of the hem.

use super::crown::hem_angle;
use super::resolution::Resolution;
use super::shape::Shape;
use nalgebra::{Point3, Vector3};

/// The brim's own vertices and its triangles, which share the hem's vertices.
pub struct Brim {
    /// Vertices to be appended to the crown's, metres.
    pub vertices: Vec<Point3<f64>>,
    /// Triangles over crown and brim vertices, counter-clockwise from above.
    pub triangles: Vec<[u32; 3]>,
}

/// Hem vertices on each side of the front that the brim reaches.
fn reach(shape: &Shape, resolution: Resolution) -> isize {
    (shape.brim_half_angle / hem_angle(resolution, 1)).round() as isize
}

/// Builds the brim on a finished crown.
///
/// The outline closes onto the hem at both ends, so the outermost columns are a fan: a
/// column of vanishing length would give edges too short to simulate.
pub fn build(shape: &Shape, resolution: Resolution, crown: &[Point3<f64>]) -> Brim {
    let reach = reach(shape, resolution);
    let rows = resolution.brim_rows();
    let on_hem = |j| crown[resolution.hem_vertex(j)];
    let columns: Vec<isize> = (1 - reach..reach).collect();
    let half_width = on_hem(reach).x.abs().max(on_hem(reach / 2).x.abs());
    let mut vertices = Vec::with_capacity(columns.len() * rows);
    for &j in &columns {
        let across = j as f64 / reach as f64;
        let tangent = on_hem(j + 1) - on_hem(j - 1);
        for row in 1..=rows {
            let along = row as f64 / rows as f64;
            vertices.push(point(shape, on_hem(j), &tangent, [across, along], half_width));
        }
    }
    Brim { vertices, triangles: triangles(resolution, crown.len(), &columns) }
}

fn point(
    shape: &Shape,
    start: Point3<f64>,
    tangent: &Vector3<f64>,
    [across, along]: [f64; 2],
    half_width: f64,
) -> Point3<f64> {
    let away = Vector3::new(tangent.y, -tangent.x, 0.0).normalize();
    let heading = away.lerp(&Vector3::y(), shape.brim_forwardness).normalize();
    let length = shape.brim_length * (1.0 - across.abs().powf(shape.brim_squareness)).powf(0.6);
    let mut p = start + heading * (length * along);
    let aside = (p.x / half_width).powi(2).min(1.5) - (start.x / half_width).powi(2);
    p.z -= shape.brim_slope.tan() * length * along
        + shape.brim_side_drop * (aside.max(0.0) + across.powi(2) * along.powf(0.7))
        + shape.brim_tip_drop * along.powi(2) * (1.0 - across.powi(2));
    p
}

fn triangles(resolution: Resolution, crown_vertices: usize, columns: &[isize]) -> Vec<[u32; 3]> {
    let rows = resolution.brim_rows();
    let vertex = |column: usize, row: usize| {
        if row == 0 {
            resolution.hem_vertex(columns[column]) as u32
        } else {
            (crown_vertices + column * rows + row - 1) as u32
        }
    };
    let mut all = Vec::new();
    for column in 0..columns.len() - 1 {
        for row in 0..rows {
            let [a, b] = [vertex(column, row), vertex(column + 1, row)];
            let [c, d] = [vertex(column, row + 1), vertex(column + 1, row + 1)];
            // The diagonal leans the same way on both sides of the middle.
            if 2 * column < columns.len() - 1 {
                all.extend([[a, c, d], [a, d, b]]);
            } else {
                all.extend([[a, c, b], [b, c, d]]);
            }
        }
    }
    let last = columns.len() - 1;
    let (right, left) = (
        resolution.hem_vertex(columns[0] - 1) as u32,
        resolution.hem_vertex(columns[last] + 1) as u32,
    );
    for row in 0..rows {
        all.push([vertex(0, row), right, vertex(0, row + 1)]);
        all.push([vertex(last, row), vertex(last, row + 1), left]);
    }
    debug_assert!(columns.len() < resolution.hem(), "a brim does not overlap itself");
    all
}
