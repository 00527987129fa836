//! The recording of a run: one MCAP file of JSON messages.
//!
//! | topic | one message |
//! |---|---|
//! | `/run` | a run: everything that is needed to repeat it |
//! | `/cloud` | an object: points, canonical coordinates, confidence |
//! | `/candidates` | a run: the grasps found, best first |
//! | `/key_poses` | a run: the tool poses planned for |
//! | `/trajectory` | a run: the planned program |
//! | `/robot` | a moment: joints and opening |
//! | `/object` | a moment: the object's vertices |
//! | `/stages` | a step or stage: how it ended |
//! | `/verdict` | a run: how it ended |
//!
//! Lengths are metres in `world`, rounded to 0.01 mm; angles radians. Times are those of
//! the cell's clock in nanoseconds, zero for what was found before the robot moved; no
//! other clock is read, so the same run gives the same bytes.

mod channel;
mod messages;
mod read;
mod write;

pub use channel::Channel;
pub use read::{Entry, Recording, read};

pub(crate) use messages::{Record, pose};
pub(crate) use write::write;

#[cfg(test)]
mod tests;
