//! Point clouds as PLY, ASCII or binary little endian.
//!
//! Read is the `vertex` element, which must come first, with `x y z` of any number type
//! among any other scalar properties; what follows it (faces) is passed over. Nothing is
//! allocated on a header's word: a declared count is first held against the file's size.

mod body;
mod header;
mod write;

pub use write::{Encoding, cloud_bytes, write_cloud};

use crate::{Cloud, Diagnostic};
use std::fs;
use std::path::Path;

/// The largest file that is read.
const MOST_BYTES: u64 = 64 << 20;

/// Reads a cloud; coordinates in metres, in whatever frame the writer meant.
///
/// # Errors
/// `P001` a file that cannot be read or is too large, `P002` a header that is not
/// understood, `P003` a count that the file does not hold, `P004` a value that is no
/// finite number; all but the first with the line where the format has lines.
pub fn read_cloud(path: &Path) -> Result<Cloud, Diagnostic> {
    let unreadable = |e: std::io::Error| {
        Diagnostic::new("P001", format!("cannot read the cloud: {e}")).in_file(path)
    };
    let size = fs::metadata(path).map_err(unreadable)?.len();
    if size > MOST_BYTES {
        let cause = format!("{size} bytes, but a cloud may have {MOST_BYTES}");
        return Err(Diagnostic::new("P001", cause).in_file(path));
    }
    parse_cloud(&fs::read(path).map_err(unreadable)?, path)
}

/// Reads a cloud from the bytes of a file; `path` is only for what is told.
///
/// # Errors
/// As [`read_cloud`], `P001` excepted.
pub fn parse_cloud(bytes: &[u8], path: &Path) -> Result<Cloud, Diagnostic> {
    let (header, body) = header::parse(bytes, path)?;
    let points = match header.encoding {
        Encoding::Ascii => body::ascii(&header, body, path)?,
        Encoding::BinaryLittleEndian => body::binary(&header, body, path)?,
    };
    Cloud::new(points).map_err(|index| {
        Diagnostic::new("P004", format!("point {index} is not finite")).in_file(path)
    })
}

#[cfg(test)]
mod tests;
