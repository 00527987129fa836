//! One module a verb.

pub mod check;
pub mod data;
pub mod eval;
pub mod ik;
pub mod new;
pub mod objects;
pub mod perception;
pub mod plugins;
pub mod reconstruction;
pub mod run;
pub mod sheet;
pub mod teach;
pub mod train;
