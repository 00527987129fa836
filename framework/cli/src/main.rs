//! `seeone`: see one, do many. The one place that names the built-in plugins.

mod advice;
mod args;
mod builtin;
mod console;
mod disturbance;
mod faults;
mod files;
mod fits;
mod follow;
mod interrupt;
mod judge;
mod kept;
mod motion_table;
mod objects;
mod oracle;
mod outputs;
mod picture;
mod rate;
mod shared_cell;
mod shown;
mod simulated;
mod site;
mod tables;
mod targets;
mod threads;
mod verbs;
mod workcell;

use anyhow::Result;
use args::{Cli, EvalArgs, EvalPart, NewAction, ObjectsAction, PluginsAction, Verb};
use clap::Parser;
use faults::Faults;
use std::process::ExitCode;

/// glibc's allocator returns every large tensor to the kernel at once; half of a training
/// step went there.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// How a verb ended when nothing was wrong with what it was given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ending {
    Success,
    /// An honest "no": the attempt failed, or a check found faults.
    Failure,
    /// Ctrl-C ended it in good order: the robot stands, and what was recorded is whole.
    Interrupted,
}

/// The exit status of what Ctrl-C ended, by the shells' custom.
const INTERRUPTED: u8 = 130;

fn main() -> ExitCode {
    threads::keep_candle_to_one();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version are answers, not errors; a closed pipe ends either.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    match dispatch(&cli.verb) {
        Ok(Ending::Success) => ExitCode::SUCCESS,
        Ok(Ending::Failure) => ExitCode::from(1),
        Ok(Ending::Interrupted) => ExitCode::from(INTERRUPTED),
        Err(error) => report(&error),
    }
}

fn dispatch(verb: &Verb) -> Result<Ending> {
    match verb {
        Verb::Run(args) => verbs::run::run(args),
        Verb::Eval(EvalArgs::Skill(args)) => verbs::eval::run(args),
        Verb::Eval(EvalArgs::Part(EvalPart::Perception(args))) => verbs::perception::run(args),
        Verb::Eval(EvalArgs::Part(EvalPart::Reconstruction(args))) => {
            verbs::reconstruction::run(args)
        }
        Verb::Eval(EvalArgs::Part(EvalPart::Grasps(args))) => verbs::eval::grasps::run(args),
        Verb::Teach(args) => verbs::teach::run(args),
        Verb::Objects { action: ObjectsAction::List { json } } => verbs::objects::list(*json),
        Verb::Objects { action: ObjectsAction::Import(args) } => verbs::objects::import(args),
        Verb::Objects { action: ObjectsAction::Show { object, out } } => {
            verbs::objects::show(object, out)
        }
        Verb::Objects { action: ObjectsAction::Sheet { seed, out } } => {
            verbs::sheet::run(*seed, out)
        }
        Verb::Data(args) => verbs::data::run(args),
        Verb::Train(args) => verbs::train::run(args),
        Verb::Ik(args) => verbs::ik::run(args),
        Verb::New { action: NewAction::Skill(args) } => verbs::new::skill::run(args),
        Verb::New { action: NewAction::Robot(args) } => verbs::new::robot::run(args),
        Verb::Check(args) => verbs::check::run(args),
        Verb::Schema { kind } => verbs::schema::run(*kind),
        Verb::New { action: NewAction::Plugin(args) } => verbs::new::plugin::run(args),
        Verb::Plugins { action: PluginsAction::List { folders, json } } => {
            verbs::plugins::list(folders, *json)
        }
        Verb::Plugins { action: PluginsAction::Check { library } } => {
            verbs::plugins::check(library)
        }
        Verb::Plugins { action: PluginsAction::Probe { library } } => {
            verbs::plugins::probe(library)
        }
        Verb::Plugins { action: PluginsAction::Trust { library } } => {
            verbs::plugins::trust(library)
        }
    }
}

/// Tells the whole chain of causes on standard error and picks the exit status.
fn report(error: &anyhow::Error) -> ExitCode {
    if is_broken_pipe(error) {
        return ExitCode::SUCCESS;
    }
    match Faults::of(error) {
        Some(faults) => {
            console::tell(&faults.to_string());
            ExitCode::from(2)
        }
        None => {
            console::tell(&format!("error: {error:#}"));
            ExitCode::from(3)
        }
    }
}

fn is_broken_pipe(error: &anyhow::Error) -> bool {
    error
        .chain()
        .filter_map(|cause| cause.downcast_ref::<std::io::Error>())
        .any(|cause| cause.kind() == std::io::ErrorKind::BrokenPipe)
}
