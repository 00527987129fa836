//! Scenes with a known answer, and what the world makes of them. The tests hold every line
//! to its tolerance; `examples/mechanics.rs` prints them as a table.

#![allow(clippy::unwrap_used, dead_code, reason = "the tests and an example each use a share")]

#[path = "../../common/mod.rs"]
pub mod common;

pub mod bending;
pub mod check;
pub mod contact;
pub mod hanging;
pub mod plate;
pub mod reference;
pub mod symmetry;

use check::Check;

/// Every scene, in the order of the table.
pub const ALL: [fn() -> Vec<Check>; 9] = [
    contact::falls,
    contact::slopes,
    hanging::sags,
    hanging::catenaries,
    hanging::swings,
    bending::cantilevers,
    bending::visors,
    symmetry::symmetries,
    reference::hammocks,
];
