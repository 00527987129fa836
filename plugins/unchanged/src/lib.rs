//! The baselines of every table: the demonstrated canonical pose taken as it is
//! ([`Unchanged`]), and the same laid onto the sheet that was seen there ([`Snap`]).

mod snap;
mod unchanged;

pub use snap::Snap;
pub use unchanged::Unchanged;
