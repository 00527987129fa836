//! Ctrl-C while a robot moves: an orderly end, and at the second time an end at once.

use crate::INTERRUPTED;
use anyhow::{Context, Result};
use seeone_runtime::run::Cancel;

/// From now on Ctrl-C asks for an end of what is run; once it was asked for, it ends the
/// program.
///
/// # Errors
/// When the system has no handler to give, or this was called before.
pub fn on_ctrl_c() -> Result<Cancel> {
    let cancel = Cancel::default();
    let ordered = cancel.clone();
    let handler = move || {
        if ordered.is_ordered() {
            std::process::exit(i32::from(INTERRUPTED));
        }
        ordered.order();
    };
    ctrlc::set_handler(handler).context("Ctrl-C cannot be heeded")?;
    Ok(cancel)
}
