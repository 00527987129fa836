//! The manifest beside a library: what is trusted, to the byte.

use super::library;
use crate::Kind;
use seeone_core::Diagnostic;
use seeone_core::frames::write_whole;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// A manifest larger than this is none.
const LARGEST_MANIFEST: u64 = 64 * 1024;

/// What a library was when its user decided to trust it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Manifest {
    /// The plugin's name.
    pub name: String,
    /// The plugin's kind.
    pub kind: Kind,
    /// The plugin's version.
    pub version: String,
    /// Major and minor version of the ABI.
    pub abi: (u32, u32),
    /// Size of the library in bytes.
    pub size_bytes: u64,
    /// BLAKE3 of the library.
    pub blake3: blake3::Hash,
}

/// The manifest as it is written.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields {
    schema: u32,
    name: String,
    kind: String,
    version: String,
    abi: [u32; 2],
    size_bytes: u64,
    blake3: String,
}

impl Manifest {
    /// Where the manifest of `library` lies: `libx.so` -> `libx.so.toml`.
    pub fn path_for(library: &Path) -> PathBuf {
        let mut path = library.as_os_str().to_owned();
        path.push(".toml");
        path.into()
    }

    /// Reads the manifest beside `library`.
    ///
    /// # Errors
    /// `L001` when there is none, `L002` when it is damaged.
    pub fn read_for(library: &Path) -> Result<Self, Diagnostic> {
        let path = Self::path_for(library);
        let damaged = |cause: String| Diagnostic::new("L002", cause).in_file(&path);
        let size = fs::metadata(&path).map_err(|e| {
            Diagnostic::new("L001", format!("the library has no readable manifest: {e}"))
                .in_file(&path)
                .hint(format!("if you trust it: seeone plugins trust {}", library.display()))
        })?;
        if size.len() > LARGEST_MANIFEST {
            return Err(damaged("larger than any manifest is".into()));
        }
        let text = fs::read_to_string(&path).map_err(|e| damaged(e.to_string()))?;
        let fields: Fields = toml::from_str(&text).map_err(|e| {
            let start = e.span().map_or(0, |span| span.start);
            Diagnostic::new("L002", e.message()).at_offset(&path, &text, start)
        })?;
        fields.resolve().map_err(damaged)
    }

    /// Trusts `library` as it is now: loads it **unchecked** to learn its name, kind and
    /// version, and writes its manifest beside it. For libraries whose user said so.
    ///
    /// # Errors
    /// When it is no library with a table that this host can serve, or the manifest cannot
    /// be written.
    pub fn write_for(library: &Path) -> Result<Self, Diagnostic> {
        let bytes = library::read(library)?;
        let table = library::load(library)?;
        let manifest = Self {
            name: table.name,
            kind: table.kind,
            version: table.version,
            abi: table.abi,
            size_bytes: bytes.len() as u64,
            blake3: blake3::hash(&bytes),
        };
        let path = Self::path_for(library);
        let written = toml::to_string(&manifest.fields())
            .map_err(|e| e.to_string())
            .and_then(|text| write_whole(&path, text.as_bytes()).map_err(|e| e.to_string()));
        written.map_err(|cause| Diagnostic::new("L002", cause).in_file(&path))?;
        Ok(manifest)
    }

    /// Compares a library's bytes with what is trusted.
    ///
    /// # Errors
    /// `L003` for another size, `L004` for another hash; both with both values.
    pub fn verify(&self, library: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
        let refuse = |code, what: &str, has: String, trusted: String| {
            let cause = format!("the library has {what} {has}; its manifest trusts {trusted}");
            Err(Diagnostic::new(code, cause).in_file(library).hint(format!(
                "if it was rebuilt and you trust it: seeone plugins trust {}",
                library.display()
            )))
        };
        let size = bytes.len() as u64;
        if size != self.size_bytes {
            return refuse("L003", "size", size.to_string(), self.size_bytes.to_string());
        }
        let hash = blake3::hash(bytes);
        if hash != self.blake3 {
            return refuse("L004", "BLAKE3", hash.to_string(), self.blake3.to_string());
        }
        Ok(())
    }

    fn fields(&self) -> Fields {
        Fields {
            schema: 1,
            name: self.name.clone(),
            kind: self.kind.name().to_owned(),
            version: self.version.clone(),
            abi: [self.abi.0, self.abi.1],
            size_bytes: self.size_bytes,
            blake3: self.blake3.to_string(),
        }
    }
}

impl Fields {
    fn resolve(self) -> Result<Manifest, String> {
        if self.schema != 1 {
            return Err(format!("schema is {}, not 1", self.schema));
        }
        let kind = self.kind.parse();
        let kind = kind.map_err(|()| format!("there is no plugin kind \"{}\"", self.kind))?;
        let blake3 = blake3::Hash::from_hex(&self.blake3);
        let blake3 = blake3.map_err(|_| "blake3 is not of 64 hexadecimal digits".to_owned())?;
        let [major, minor] = self.abi;
        let Self { name, version, size_bytes, .. } = self;
        Ok(Manifest { name, kind, version, abi: (major, minor), size_bytes, blake3 })
    }
}
