//! Faults in what the user gave: one or several, told together and each with advice.

use crate::advice;
use anyhow::Error;
use seeone_core::Diagnostic;
use std::fmt;

/// The most faults that are told: one unclosed bracket makes a fault of every later line.
const MOST_TOLD: usize = 5;

/// Every fault that was found in a file; never empty.
#[derive(Debug)]
pub struct Faults(pub Vec<Diagnostic>);

impl Faults {
    /// The faults that an error comes from; none when nothing given was wrong.
    pub fn of(error: &Error) -> Option<Self> {
        error.chain().find_map(|cause| {
            let one = cause.downcast_ref::<Diagnostic>().map(std::slice::from_ref);
            let all = one.or_else(|| cause.downcast_ref::<Self>().map(|faults| &faults.0[..]))?;
            Some(Self(all.iter().cloned().map(advice::complete).collect()))
        })
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.0.iter().take(MOST_TOLD).enumerate() {
            let gap = if index == 0 { "" } else { "\n\n" };
            write!(f, "{gap}{fault}")?;
        }
        match self.0.len().saturating_sub(MOST_TOLD) {
            0 => Ok(()),
            more => write!(f, "\n\nand {more} more; `seeone check` tells all"),
        }
    }
}

impl std::error::Error for Faults {}
