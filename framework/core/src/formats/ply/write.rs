//! Writing: `x y z` as 64-bit numbers, so that reading gives the same cloud to the bit.

use crate::{Cloud, Diagnostic};
use std::fs;
use std::path::Path;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// As text, shortest form that reads back to the same number.
    Ascii,
    /// As bytes, least significant first.
    BinaryLittleEndian,
}

impl Encoding {
    fn name(self) -> &'static str {
        match self {
            Self::Ascii => "ascii",
            Self::BinaryLittleEndian => "binary_little_endian",
        }
    }
}

/// The bytes of a PLY file of `cloud`.
pub fn cloud_bytes(cloud: &Cloud, encoding: Encoding) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {} 1.0\ncomment metres\nelement vertex {}\n\
         property double x\nproperty double y\nproperty double z\nend_header\n",
        encoding.name(),
        cloud.len()
    )
    .into_bytes();
    for point in cloud.points() {
        match encoding {
            Encoding::Ascii => {
                bytes.extend(format!("{} {} {}\n", point.x, point.y, point.z).bytes());
            }
            Encoding::BinaryLittleEndian => {
                bytes.extend(point.coords.iter().flat_map(|v| v.to_le_bytes()));
            }
        }
    }
    bytes
}

/// Writes `cloud` to `path`, under another name first, so that what is there is whole.
///
/// # Errors
/// `P001` when the file cannot be written.
pub fn write_cloud(path: &Path, cloud: &Cloud, encoding: Encoding) -> Result<(), Diagnostic> {
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    fs::write(&partial, cloud_bytes(cloud, encoding))
        .and_then(|()| fs::rename(&partial, path))
        .map_err(|e| Diagnostic::new("P001", format!("cannot write the cloud: {e}")).in_file(path))
}
