//! An end that is asked for from outside.

use seeone_plugin::PluginError;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Asks a run, or a task, for an end: from another thread, or from a signal's handler. The robot
/// then stops at its next sample, no further step begins, and the recording is written.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Asks for an end, for good.
    pub fn order(&self) {
        self.0.store(true, Ordering::Release);
    }

    /// Whether an end was asked for.
    pub fn is_ordered(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }

    /// Goes on as long as no end was asked for.
    ///
    /// # Errors
    /// [`PluginError::Cancelled`] once one was.
    pub(super) fn check(&self) -> Result<(), PluginError> {
        if self.is_ordered() { Err(PluginError::Cancelled) } else { Ok(()) }
    }
}
