//! A plugin that a table built.

use super::callee::{Callee, Lasting, NO_SERVICE, ask, missing};
use super::message::with_message;
use super::methods::Method;
use super::table::{Span, Table};
use crate::{Kind, PluginError};
use std::ffi::c_void;
use std::fmt;
use std::sync::{Mutex, PoisonError};

/// Which plugin it is, for its faults.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) kind: Kind,
    pub(super) name: String,
}

impl fmt::Display for Named {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} plugin \"{}\"", self.kind, self.name)
    }
}

impl Named {
    /// A fault with the plugin and the entry that it is of; what a plugin says of its input and
    /// its configuration needs none.
    pub(super) fn fault(&self, entry: &str, error: PluginError) -> PluginError {
        match error {
            PluginError::Internal(text) => {
                PluginError::Internal(format!("{self} in \"{entry}\": {text}"))
            }
            other => other,
        }
    }
}

/// Builds the plugin. The world must last until the plugin is released.
pub(super) fn create(
    table: &Table,
    setup: &[u64],
    world: Option<&Lasting>,
) -> Result<*mut c_void, PluginError> {
    let create = table.create.ok_or_else(missing)?;
    let world = world.map_or(NO_SERVICE, Lasting::service);
    let mut instance = std::ptr::null_mut();
    let (status, text) = with_message(|message| {
        // SAFETY: the setup is valid for the call, and the world until the release.
        unsafe { create(Span::of(setup), world, &mut instance, message) }
    });
    status.result(text)?;
    if instance.is_null() {
        return Err(PluginError::Internal("it built nothing".into()));
    }
    Ok(instance)
}

/// A loaded plugin that is called on the caller's own thread, for as long as it likes.
pub(super) struct Direct {
    named: Named,
    table: &'static Table,
    /// Locked for each call: they come one after the other.
    instance: Mutex<Instance>,
    /// What the plugin may call until it is released.
    _world: Option<Lasting>,
}

struct Instance(*mut c_void);

// SAFETY: the ABI demands of an instance that any thread may call it, one after the other.
unsafe impl Send for Instance {}

impl Direct {
    /// Builds the plugin of a table.
    ///
    /// # Errors
    /// What the plugin refuses about its setup.
    pub(super) fn start(
        table: &'static Table,
        named: Named,
        setup: &[u64],
        world: Option<Box<dyn Callee>>,
    ) -> Result<Self, PluginError> {
        let world = world.map(Lasting::new);
        let built = create(table, setup, world.as_ref());
        let instance = built.map_err(|error| named.fault("create", error))?;
        Ok(Self { named, table, instance: Mutex::new(Instance(instance)), _world: world })
    }
}

impl Callee for Direct {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        let instance = self.instance.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the instance lives, and is locked.
        unsafe { ask(self.table.call, instance.0, method, request, lent) }
    }

    fn blame(&self, method: Method, error: PluginError) -> PluginError {
        self.named.fault(method.name(), error)
    }
}

impl Drop for Direct {
    fn drop(&mut self) {
        let instance = self.instance.get_mut().unwrap_or_else(PoisonError::into_inner);
        if let Some(release) = self.table.release {
            // SAFETY: created by this table, released once, after every call on it.
            unsafe { release(instance.0) };
        }
    }
}
