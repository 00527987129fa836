//! A rule that a plugin broke.

/// Which rule of its kind a plugin broke, and with what.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("breaks the rule \"{rule}\": {detail}")]
pub struct Violation {
    /// The rule in words.
    pub rule: &'static str,
    /// What was seen instead.
    pub detail: String,
}

/// Holds a rule: `detail` is only worked out when it is broken.
pub(super) fn hold(
    rule: &'static str,
    kept: bool,
    detail: impl FnOnce() -> String,
) -> Result<(), Violation> {
    if kept { Ok(()) } else { Err(Violation { rule, detail: detail() }) }
}

/// The answer of a plugin to a question that it must be able to answer.
pub(super) fn answered<T>(
    rule: &'static str,
    answer: Result<T, crate::PluginError>,
) -> Result<T, Violation> {
    answer.map_err(|e| Violation { rule, detail: format!("refused with: {e}") })
}

/// Holds the rule that the plugin calls its input wrong.
pub(super) fn refused<T>(
    rule: &'static str,
    answer: Result<T, crate::PluginError>,
) -> Result<(), Violation> {
    match answer {
        Err(crate::PluginError::Input(_)) => Ok(()),
        Err(other) => Err(Violation { rule, detail: format!("failed otherwise: {other}") }),
        Ok(_) => Err(Violation { rule, detail: "answered".into() }),
    }
}

/// Holds the rule that the plugin answers what `check` finds nothing wrong with, or calls its
/// input wrong: for input at the edge of what can be worked on.
pub(super) fn answered_or_refused<T>(
    rule: &'static str,
    answer: Result<T, crate::PluginError>,
    check: impl FnOnce(&T) -> Result<(), String>,
) -> Result<(), Violation> {
    match answer {
        Ok(answer) => check(&answer).map_err(|detail| Violation { rule, detail }),
        Err(crate::PluginError::Input(_)) => Ok(()),
        Err(other) => Err(Violation { rule, detail: format!("failed otherwise: {other}") }),
    }
}

/// Holds the rule that an answer is what its kind may answer.
pub(super) fn sound(rule: &'static str, checked: Result<(), String>) -> Result<(), Violation> {
    checked.map_err(|detail| Violation { rule, detail })
}
