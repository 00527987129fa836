//! The vertices themselves.

use super::header::{Header, Scalar};
use crate::Diagnostic;
use nalgebra::Point3;
use std::path::Path;

fn miscounted(header: &Header, there: usize, path: &Path) -> Diagnostic {
    let cause = format!("the header declares {} points, the file holds {there}", header.vertices);
    Diagnostic::new("P003", cause).in_file(path).hint("the file is cut short or miswritten")
}

/// One vertex a line.
pub(super) fn ascii(
    header: &Header,
    body: &[u8],
    path: &Path,
) -> Result<Vec<Point3<f64>>, Diagnostic> {
    let text = std::str::from_utf8(body)
        .map_err(|_| Diagnostic::new("P004", "the points are not text").in_file(path))?;
    let lines: Vec<(usize, &str)> = text
        .lines()
        .enumerate()
        .map(|(i, line)| (header.lines + 1 + i, line))
        .filter(|(_, line)| !line.trim().is_empty())
        .collect();
    if lines.len() < header.vertices || (lines.len() > header.vertices && !header.more) {
        return Err(miscounted(header, lines.len(), path));
    }
    lines[..header.vertices]
        .iter()
        .map(|(number, line)| {
            let words: Vec<&str> = line.split_whitespace().collect();
            let fault = |cause: String| Diagnostic::new("P004", cause).at_line(path, *number, 1);
            if words.len() != header.properties.len() {
                let (has, wants) = (words.len(), header.properties.len());
                return Err(fault(format!("{has} numbers, where the header declares {wants}")));
            }
            let [x, y, z] = header.xyz.map(|index| {
                let value: Option<f64> = words[index].parse().ok();
                value
                    .filter(|v| v.is_finite())
                    .ok_or_else(|| fault(format!("{:?} is no finite number", words[index])))
            });
            Ok(Point3::new(x?, y?, z?))
        })
        .collect()
}

/// Vertices of equal size one after another.
pub(super) fn binary(
    header: &Header,
    body: &[u8],
    path: &Path,
) -> Result<Vec<Point3<f64>>, Diagnostic> {
    let stride: usize = header.properties.iter().map(|scalar| scalar.size()).sum();
    let there = body.len() / stride;
    let exact = there == header.vertices && body.len().is_multiple_of(stride);
    if there < header.vertices || !(exact || header.more) {
        return Err(miscounted(header, there, path));
    }
    let places = header.xyz.map(|index| {
        let offset: usize = header.properties[..index].iter().map(|scalar| scalar.size()).sum();
        (offset, header.properties[index])
    });
    Ok(body
        .chunks_exact(stride)
        .take(header.vertices)
        .map(|vertex| {
            let [x, y, z] = places.map(|(offset, scalar)| number(scalar, &vertex[offset..]));
            Point3::new(x, y, z)
        })
        .collect())
}

/// The little endian number at the start of `bytes`, which hold at least its size.
fn number(scalar: Scalar, bytes: &[u8]) -> f64 {
    let mut raw = [0; 8];
    raw[..scalar.size()].copy_from_slice(&bytes[..scalar.size()]);
    let [a, b, c, d, ..] = raw;
    match scalar {
        Scalar::I8 => f64::from(i8::from_le_bytes([a])),
        Scalar::U8 => f64::from(a),
        Scalar::I16 => f64::from(i16::from_le_bytes([a, b])),
        Scalar::U16 => f64::from(u16::from_le_bytes([a, b])),
        Scalar::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
        Scalar::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
        Scalar::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
        Scalar::F64 => f64::from_le_bytes(raw),
    }
}
