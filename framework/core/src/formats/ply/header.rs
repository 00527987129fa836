//! The header: encoding, number of vertices, and where in a vertex x, y and z lie.

use super::Encoding;
use crate::Diagnostic;
use std::path::Path;

/// A number type of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn named(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Size in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// What a reader must know of a header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    /// Declared number of vertices.
    pub(super) vertices: usize,
    /// Types of a vertex' properties, in order.
    pub(super) properties: Vec<Scalar>,
    /// Indices of x, y and z among the properties.
    pub(super) xyz: [usize; 3],
    /// Whether other elements follow the vertices.
    pub(super) more: bool,
    /// Lines of the header, the last one included.
    pub(super) lines: usize,
}

/// Splits a file into its header and the rest.
pub(super) fn parse<'a>(bytes: &'a [u8], path: &Path) -> Result<(Header, &'a [u8]), Diagnostic> {
    let mut reading = Reading::default();
    let mut rest = bytes;
    let mut number = 0;
    loop {
        number += 1;
        let fault = |cause: String| Diagnostic::new("P002", cause).at_line(path, number, 1);
        let end = rest
            .iter()
            .position(|b| *b == b'\n')
            .ok_or_else(|| fault("the header does not end with \"end_header\"".into()))?;
        let line = std::str::from_utf8(&rest[..end])
            .map_err(|_| fault("the header is not text".into()))?
            .trim_end_matches('\r');
        rest = &rest[end + 1..];
        if line.trim_end() == "end_header" {
            return reading.finish(number).map(|header| (header, rest)).map_err(fault);
        }
        reading.line(number, line).map_err(fault)?;
    }
}

/// What the lines so far have said.
#[derive(Default)]
struct Reading {
    encoding: Option<Encoding>,
    vertices: Option<usize>,
    names: Vec<String>,
    properties: Vec<Scalar>,
    more: bool,
}

impl Reading {
    fn line(&mut self, number: usize, line: &str) -> Result<(), String> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match (number, words.as_slice()) {
            (1, ["ply"]) => {}
            (1, _) => return Err("not a PLY file: the first line is not \"ply\"".into()),
            (_, ["format", "ascii", "1.0"]) => self.encoding = Some(Encoding::Ascii),
            (_, ["format", "binary_little_endian", "1.0"]) => {
                self.encoding = Some(Encoding::BinaryLittleEndian);
            }
            (_, ["format", ..]) => {
                return Err(format!("{line:?} is neither ASCII nor binary little endian 1.0"));
            }
            (_, ["comment" | "obj_info", ..] | []) => {}
            (_, ["element", name, count]) => self.element(name, count)?,
            (_, ["property", ..]) if self.more => {}
            (_, ["property", kind, name]) if self.vertices.is_some() => {
                let scalar =
                    Scalar::named(kind).ok_or_else(|| format!("unknown number type {kind:?}"))?;
                self.properties.push(scalar);
                self.names.push((*name).to_owned());
            }
            _ => return Err(format!("{line:?} has no meaning here")),
        }
        Ok(())
    }

    fn element(&mut self, name: &str, count: &str) -> Result<(), String> {
        match (name, self.vertices) {
            ("vertex", None) => {
                let count = count.parse().map_err(|_| format!("{count:?} is no count"))?;
                self.vertices = Some(count);
            }
            (_, None) => return Err("the vertices must be the first element".into()),
            ("vertex", Some(_)) => return Err("the vertices are declared twice".into()),
            (_, Some(_)) => self.more = true,
        }
        Ok(())
    }

    fn finish(self, lines: usize) -> Result<Header, String> {
        let at = |axis: &str| {
            self.names
                .iter()
                .position(|name| name == axis)
                .ok_or_else(|| format!("the vertices have no property {axis:?}"))
        };
        Ok(Header {
            encoding: self.encoding.ok_or("the format is not declared")?,
            vertices: self.vertices.ok_or("no vertices are declared")?,
            xyz: [at("x")?, at("y")?, at("z")?],
            more: self.more,
            properties: self.properties,
            lines,
        })
    }
}
