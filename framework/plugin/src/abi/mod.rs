//! The C ABI by which a plugin is served from a dynamic library.
//!
//! A library exports one function, `seeone_plugin`, which returns a table: a header that
//! never changes its layout, then the functions of the plugin's kind. Spans, numbers,
//! status codes, a caller's buffer for the text of an error, and the configuration as UTF-8
//! TOML are all that crosses; memory is freed on the side that took it. The kinds served
//! this way are those of [`table::kind_code`].
//!
//! - [`export_alignment!`](crate::export_alignment) makes a library of a plugin.
//! - [`Library`] checks the library's size and BLAKE3 against its [`Manifest`] **before**
//!   it is loaded: loading a truncated library ends the process, and a flipped bit mostly
//!   goes unnoticed. A loaded library is never unloaded.
//! - [`LoadedAlignment`] is the plugin behind the same trait as a linked one.
#![allow(unsafe_code, reason = "foreign functions; each block proves itself")]

pub mod export;
pub mod library;
pub mod loaded_alignment;
pub mod manifest;
pub mod message;
pub mod table;

pub use library::Library;
pub use loaded_alignment::LoadedAlignment;
pub use manifest::Manifest;
