//! The manifest beside a library: what is trusted, to the byte.

use super::library::{self, PluginId};
use super::table::ABI_MAJOR;
use seeone_core::Diagnostic;
use seeone_core::frames::write_whole;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// The version of the manifest's own form.
const SCHEMA: u32 = 2;

/// A manifest larger than this is none.
const LARGEST_MANIFEST: u64 = 64 * 1024;

/// What a library was when its user decided to trust it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Manifest {
    /// Its plugins.
    pub plugins: Vec<PluginId>,
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
    abi_major: u32,
    size_bytes: u64,
    blake3: String,
    #[serde(rename = "plugin")]
    plugins: Vec<PluginFields>,
}

/// One of its plugins.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PluginFields {
    name: String,
    kind: String,
    version: String,
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

    /// Trusts `library` as it is now: loads it **unchecked** to learn what plugins it
    /// has, and writes its manifest beside it. For libraries whose user said so.
    ///
    /// # Errors
    /// When it is no library with a table that this host can serve, or the manifest cannot
    /// be written.
    pub fn write_for(library: &Path) -> Result<Self, Diagnostic> {
        let bytes = library::read(library)?;
        let offers = library::load(library)?;
        let manifest = Self {
            plugins: offers.into_iter().map(|offer| offer.id).collect(),
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
            schema: SCHEMA,
            abi_major: ABI_MAJOR,
            size_bytes: self.size_bytes,
            blake3: self.blake3.to_string(),
            plugins: self.plugins.iter().map(PluginFields::from).collect(),
        }
    }
}

impl From<&PluginId> for PluginFields {
    fn from(id: &PluginId) -> Self {
        let (name, version) = (id.name.clone(), id.version.clone());
        Self { name, kind: id.kind.name().to_owned(), version }
    }
}

impl PluginFields {
    fn resolve(self) -> Result<PluginId, String> {
        let Self { name, kind, version } = self;
        let known = kind.parse().map_err(|()| format!("there is no plugin kind \"{kind}\""))?;
        Ok(PluginId { name, kind: known, version })
    }
}

impl Fields {
    fn resolve(self) -> Result<Manifest, String> {
        if self.schema != SCHEMA {
            return Err(format!("schema is {}, not {SCHEMA}", self.schema));
        }
        if self.abi_major != ABI_MAJOR {
            return Err(format!("it is for ABI {}, not {ABI_MAJOR}", self.abi_major));
        }
        let blake3 = blake3::Hash::from_hex(&self.blake3);
        let blake3 = blake3.map_err(|_| "blake3 is not of 64 hexadecimal digits".to_owned())?;
        let plugins = self.plugins.into_iter().map(PluginFields::resolve);
        let plugins = plugins.collect::<Result<_, _>>()?;
        Ok(Manifest { plugins, size_bytes: self.size_bytes, blake3 })
    }
}
