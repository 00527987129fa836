//! Why a plugin could not work on what it was given.

/// A plugin's refusal or failure; the host adds which plugin it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PluginError {
    /// The plugin's own table of the configuration is wrong.
    #[error("configuration: {0}")]
    Configuration(String),
    /// What was handed over cannot be worked on (empty, too few points, not finite).
    #[error("{0}")]
    Input(String),
    /// A file that the plugin needs is missing or damaged.
    #[error("{0}")]
    Resource(String),
    /// A fault inside the plugin, a caught panic among them.
    #[error("internal fault: {0}")]
    Internal(String),
    /// The caller asked for an end before the work was done, and there was one.
    #[error("interrupted")]
    Cancelled,
}
