//! A rule that a plugin broke.

use crate::PluginError;
use std::time::{Duration, Instant};

/// What a contract's function gives.
type Answer<T> = Result<T, PluginError>;

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

/// How long a host waits for an answer unless its user says otherwise.
const PATIENCE: Duration = Duration::from_secs(60);

/// What a plugin answers to a question, which takes no longer than a host waits. (One that never
/// answers is left alone by the loader; linked, it keeps its own test for good.)
fn in_time<T>(
    patience: Duration,
    question: impl FnOnce() -> Answer<T>,
) -> Result<Answer<T>, Violation> {
    let clock = Instant::now();
    let answer = question();
    let taken = clock.elapsed();
    let rule = "an answer comes while the host waits for it";
    hold(rule, taken <= patience, || format!("after {:.1} s", taken.as_secs_f64()))?;
    Ok(answer)
}

/// The answer of a plugin to a question that it must be able to answer.
pub(super) fn answered<T>(
    rule: &'static str,
    question: impl FnOnce() -> Answer<T>,
) -> Result<T, Violation> {
    in_time(PATIENCE, question)?
        .map_err(|e| Violation { rule, detail: format!("refused with: {e}") })
}

/// Holds the rule that the plugin calls its input wrong.
pub(super) fn refused<T>(
    rule: &'static str,
    question: impl FnOnce() -> Answer<T>,
) -> Result<(), Violation> {
    match in_time(PATIENCE, question)? {
        Err(PluginError::Input(_)) => Ok(()),
        Err(other) => Err(Violation { rule, detail: format!("failed otherwise: {other}") }),
        Ok(_) => Err(Violation { rule, detail: "answered".into() }),
    }
}

/// Holds the rule that the plugin answers what `check` finds nothing wrong with, or calls its
/// input wrong: for input at the edge of what can be worked on.
pub(super) fn answered_or_refused<T>(
    rule: &'static str,
    question: impl FnOnce() -> Answer<T>,
    check: impl FnOnce(&T) -> Result<(), String>,
) -> Result<(), Violation> {
    match in_time(PATIENCE, question)? {
        Ok(answer) => check(&answer).map_err(|detail| Violation { rule, detail }),
        Err(PluginError::Input(_)) => Ok(()),
        Err(other) => Err(Violation { rule, detail: format!("failed otherwise: {other}") }),
    }
}

/// Holds the rule that the plugin ends with the caller's wish to end.
pub(super) fn cancelled<T>(
    rule: &'static str,
    question: impl FnOnce() -> Answer<T>,
) -> Result<(), Violation> {
    match in_time(PATIENCE, question)? {
        Err(PluginError::Cancelled) => Ok(()),
        Err(other) => Err(Violation { rule, detail: format!("failed otherwise: {other}") }),
        Ok(_) => Err(Violation { rule, detail: "answered".into() }),
    }
}

/// Holds the rule that an answer is what its kind may answer.
pub(super) fn sound(rule: &'static str, checked: Result<(), String>) -> Result<(), Violation> {
    checked.map_err(|detail| Violation { rule, detail })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_that_comes_too_late_is_none() {
        let late = || {
            std::thread::sleep(Duration::from_millis(20));
            Ok(())
        };
        let told = in_time(Duration::from_millis(1), late).expect_err("too late");
        assert_eq!(told.rule, "an answer comes while the host waits for it", "{told}");
        assert_eq!(in_time(PATIENCE, late).expect("in time"), Ok(()));
    }
}
