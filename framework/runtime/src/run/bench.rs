//! Where a run's plugins stand, and who is told of what they do.

use super::cancel::Cancel;
use super::step::{Failed, StageEvent, Step};
use crate::plugins::Plugins;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What is told of a robot that does not answer.
pub(super) const UNREACHABLE: &str =
    "the robot may be moving and where it is is not known, so use its emergency stop";

/// What the caller hands in.
pub struct Hooks {
    /// Seconds of any clock that only goes forward; for the report's timings alone.
    pub clock: Box<dyn FnMut() -> f64>,
    /// Told of every step and stage as it ends.
    pub progress: Box<dyn FnMut(&StageEvent)>,
    /// Ends the run from outside.
    pub cancel: Cancel,
}

impl Default for Hooks {
    /// A clock that stands still, and nobody told.
    fn default() -> Self {
        let cancel = Cancel::default();
        Self { clock: Box::new(|| 0.0), progress: Box::new(|_| {}), cancel }
    }
}

/// The plugins with what is to be reported of their work. The one resource of the ECS
/// world that is not plain data.
pub(crate) struct Bench {
    pub(crate) plugins: Plugins,
    hooks: Hooks,
    pub(super) events: Vec<StageEvent>,
    pub(super) timings_ms: Vec<(Step, f64)>,
}

impl Bench {
    pub(crate) fn new(plugins: Plugins, hooks: Hooks) -> Self {
        Self { plugins, hooks, events: Vec::new(), timings_ms: Vec::new() }
    }

    /// Seconds of the clock that was handed in.
    pub(crate) fn now(&mut self) -> f64 {
        (self.hooks.clock)()
    }

    /// Forgets what it told of the run before.
    pub(super) fn begin(&mut self) {
        self.events.clear();
        self.timings_ms.clear();
    }

    /// Whether anybody can tell how the cell really is.
    pub(super) fn has_judge(&self) -> bool {
        self.plugins.judge.is_some()
    }

    /// What ends the run from outside.
    pub(crate) fn cancel(&self) -> &Cancel {
        &self.hooks.cancel
    }

    /// Stops the robot after a run that failed. One that does not answer is told of: nothing here can
    /// reach it any more.
    pub(super) fn stop_robot(&mut self) {
        let robot = &mut self.plugins.robot;
        let stopped = guarded(|| robot.stop().map_err(|e| e.to_string()));
        if let Err(reason) = stopped {
            let reason = Some(format!("{UNREACHABLE}: {reason}"));
            self.tell(StageEvent { name: "stop".into(), ok: false, seconds: 0.0, reason });
        }
    }

    /// Does the work of a step, timed and told. A panic of a plugin is a failure of the
    /// step and not the end of the host.
    pub(super) fn step<T>(
        &mut self,
        step: Step,
        work: impl FnOnce(&mut Plugins) -> Result<T, String>,
    ) -> Result<T, Failed> {
        let (done, seconds) = self.timed(step, |plugins, _| work(plugins));
        self.tell(StageEvent {
            name: step.name().into(),
            ok: done.is_ok(),
            seconds,
            reason: done.as_ref().err().cloned(),
        });
        done.map_err(|reason| Failed { stage: step.name().into(), reason })
    }

    /// Does and times the work of a step that tells of its own stages by the second
    /// argument of `work`; with the seconds it took. Once the run was interrupted nothing is done
    /// any more but to record it.
    pub(super) fn timed<T>(
        &mut self,
        step: Step,
        work: impl FnOnce(&mut Plugins, &mut dyn FnMut(StageEvent)) -> Result<T, String>,
    ) -> (Result<T, String>, f64) {
        if step != Step::Record
            && let Err(interrupted) = self.hooks.cancel.check()
        {
            return (Err(interrupted.to_string()), 0.0);
        }
        let start = (self.hooks.clock)();
        let Self { plugins, hooks, events, .. } = self;
        let mut tell = |event: StageEvent| {
            (hooks.progress)(&event);
            events.push(event);
        };
        let done = guarded(|| work(plugins, &mut tell));
        let seconds = (self.hooks.clock)() - start;
        // Of all tries together.
        match self.timings_ms.binary_search_by_key(&step, |(timed, _)| *timed) {
            Ok(at) => self.timings_ms[at].1 += seconds * 1e3,
            Err(at) => self.timings_ms.insert(at, (step, seconds * 1e3)),
        }
        (done, seconds)
    }

    /// Reports one step or stage.
    pub(super) fn tell(&mut self, event: StageEvent) {
        (self.hooks.progress)(&event);
        self.events.push(event);
    }
}

/// What comes of `work` of a plugin, whose panic is a failure like any other.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|panic| Err(format!("a plugin panicked: {}", told(&*panic))))
}

fn told(panic: &(dyn Any + Send)) -> &str {
    panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("without a message")
}
