//! The C ABI by which plugins are served from a dynamic library.
//!
//! A library exports one function, `seeone_plugin`, which returns a table for each of its
//! plugins: a header that never changes its layout, then the functions `create`, `call` and
//! `release`. Questions and answers are rows of 8-byte cells ([`methods`]); they, status codes
//! and a caller's buffer for the text of an error are all that crosses. Memory is freed on the
//! side that took it. What a plugin may call in turn, a field or the simulated world, is lent
//! to it as a service that answers such messages too.
//!
//! - [`export_plugins!`](crate::export_plugins) makes a library of plugins.
//! - [`Library`] checks the library's size and BLAKE3 against its [`Manifest`] **before**
//!   it is loaded: loading a truncated library ends the process, and a flipped bit mostly
//!   goes unnoticed. A loaded library is never unloaded.
//! - [`LoadedPlugin`] is the plugin behind the same trait as a linked one, on a thread of its
//!   own, which is left alone when it gives no sign of life.
#![allow(unsafe_code, reason = "foreign functions; each block proves itself")]

mod callee;
mod cells;
pub mod export;
mod instance;
mod kinds;
pub mod library;
pub mod manifest;
pub mod message;
pub mod methods;
pub mod table;
mod worker;

pub use library::{Library, LoadedPlugin, Offer};
pub use manifest::Manifest;
