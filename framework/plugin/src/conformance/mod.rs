//! What every plugin of a kind must keep, whoever wrote it and however it is served: one
//! plain function a kind, called by the tests of the plugins and of the loader.

pub mod alignment;
pub mod transfer;
mod violation;

pub use alignment::alignment;
pub use transfer::transfer;
pub use violation::Violation;
