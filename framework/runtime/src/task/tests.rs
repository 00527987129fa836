#![allow(clippy::unwrap_used, reason = "tests")]

mod visible;

use super::node::Composition;
use super::*;
use crate::fakes::{Behaviour, FakeCell};
use crate::files::{SkillUse, Task, TaskStep, Work};
use crate::methods::Methods;
use crate::plugins::Plugins;
use crate::run::{Cancel, Precondition};
use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::convert::Infallible;
use std::rc::Rc;

/// A cell in which every run has a behaviour of its own, the last one again and again.
struct Behaving {
    fake: Rc<FakeCell>,
    behaviours: VecDeque<Behaviour>,
    /// What was asked of the cell.
    asked: Rc<RefCell<Vec<String>>>,
}

impl Cell for Behaving {
    fn present(&mut self, object: &str, _: &mut Plugins) -> Result<String, String> {
        self.asked.borrow_mut().push(format!("lay {object}"));
        if object == "lost" { Err("it is lost".into()) } else { Ok(object.to_owned()) }
    }

    fn equip(&mut self, methods: &Methods, plugins: &mut Plugins) -> Result<(), String> {
        let transfer = methods.name(seeone_plugin::Kind::Transfer);
        self.asked.borrow_mut().push(format!("equip {transfer}"));
        let behaviour = self.behaviours[0];
        if self.behaviours.len() > 1 {
            self.behaviours.pop_front();
        }
        *plugins = self.fake.plugins(behaviour);
        Ok(())
    }
}

const WELL: Behaviour = Behaviour {
    fails: None,
    panics: false,
    unreachable: None,
    refuses: 0,
    blocks_after: None,
    misses: 0,
    drops: false,
    touches: false,
    slips: false,
    blind: false,
    holds: false,
    spoils: false,
    clears: false,
    falls: 0,
    leans_deg: 0.0,
};
const MISS: Behaviour = Behaviour { misses: 1, ..WELL };
const BLIND: Behaviour = Behaviour { blind: true, ..WELL };

/// What came of a task.
struct Carried {
    outcome: TaskOutcome,
    asked: Vec<String>,
    told: Vec<TaskEvent>,
}

impl Carried {
    /// The tree in a line: `dress:done(wear:failed)`.
    fn tree(&self) -> String {
        fn line(step: &StepOutcome) -> String {
            let state = format!("{:?}", step.state).to_lowercase();
            match step.steps.iter().map(line).collect::<Vec<_>>().join(" ") {
                steps if steps.is_empty() => format!("{}:{state}", step.name),
                steps => format!("{}:{state}({steps})", step.name),
            }
        }
        line(&self.outcome.tree)
    }

    fn laid(&self) -> Vec<&str> {
        self.asked.iter().filter_map(|asked| asked.strip_prefix("lay ")).collect()
    }
}

fn skill(fake: &FakeCell, name: &str) -> TaskStep {
    let used = SkillUse {
        path: "cap-wearing.toml".into(),
        skill: fake.skill.clone(),
        requires: Vec::new(),
        targets: BTreeMap::new(),
    };
    TaskStep { name: name.into(), work: Work::Skill(Box::new(used)), tries: 1, objects: Vec::new() }
}

fn step(name: &str, work: Work) -> TaskStep {
    TaskStep { name: name.into(), work, tries: 1, objects: Vec::new() }
}

fn carried(fake: FakeCell, steps: Vec<TaskStep>, behaviours: &[Behaviour]) -> Carried {
    let fake = Rc::new(fake);
    let task = Task { name: "task".into(), summary: String::new(), steps };
    let asked = Rc::new(RefCell::new(Vec::new()));
    let told = Rc::new(RefCell::new(Vec::new()));
    let cell = Box::new(Behaving {
        fake: Rc::clone(&fake),
        behaviours: behaviours.to_vec().into(),
        asked: Rc::clone(&asked),
    });
    let (telling, mut now) = (Rc::clone(&told), 0.0);
    let hooks = TaskHooks {
        clock: Box::new(move || {
            now += 0.5;
            now
        }),
        progress: Box::new(move |event: &TaskEvent| telling.borrow_mut().push(event.clone())),
        cancel: Cancel::default(),
    };
    let mut prepare = |_: &SkillUse| Ok::<_, Infallible>(fake.assignment());
    let outcome = run_task(&task, &mut prepare, fake.plugins(WELL), cell, hooks).unwrap();
    Carried { outcome, asked: asked.take(), told: told.take() }
}

#[test]
fn a_sequence_is_done_when_each_step_is() {
    let fake = FakeCell::new();
    let steps = vec![skill(&fake, "first"), skill(&fake, "second")];
    let done = carried(fake, steps, &[WELL]);
    assert_eq!(done.tree(), "task:done(first:done second:done)");
    assert_eq!(done.outcome.success, Some(true));
    assert_eq!(done.outcome.reason, "worn within 0.04 d");
    assert_eq!(done.outcome.tree.steps[1].runs.len(), 1);
    let json = serde_json::to_value(&done.outcome).unwrap();
    assert_eq!(json["tree"]["steps"][0]["state"], "done");
    assert_eq!(json["tree"]["steps"][0]["composition"], "skill");
    assert_eq!(json["tree"]["steps"][0]["runs"][0]["stages"][0]["name"], "observe");
}

#[test]
fn a_sequence_ends_at_the_step_that_fails_and_skips_the_rest() {
    let fake = FakeCell::new();
    let steps = vec![skill(&fake, "first"), skill(&fake, "second"), skill(&fake, "third")];
    let failed = carried(fake, steps, &[WELL, MISS]);
    assert_eq!(failed.tree(), "task:failed(first:done second:failed third:skipped)");
    assert_eq!(failed.outcome.success, Some(false));
    assert_eq!(failed.outcome.reason, "second: pick: closed on nothing, at 0.0 mm");
}

#[test]
fn a_failed_step_is_tried_again_after_the_hand_went_back() {
    let fake = FakeCell::new();
    let steps = vec![TaskStep { tries: 3, ..skill(&fake, "wear") }];
    let again = carried(fake, steps.clone(), &[MISS, BLIND, WELL]);
    assert_eq!(again.tree(), "task:done(wear:done)");
    let wear = &again.outcome.tree.steps[0];
    assert_eq!((wear.tries, wear.runs.len()), (3, 3));
    let stages = |run: usize| {
        wear.runs[run].stages.iter().map(|stage| stage.name.as_str()).collect::<Vec<_>>()
    };
    assert_eq!(stages(0), ["observe", "perceive", "encode", "transfer", "plan", "pick", "judge"]);
    assert_eq!(stages(1), ["withdraw", "observe", "judge"]);
    assert_eq!(stages(2)[..2], ["withdraw", "observe"]);
    assert_eq!(again.outcome.success, Some(true));

    let never = carried(FakeCell::new(), steps, &[BLIND]);
    assert_eq!(never.tree(), "task:failed(wear:failed)");
    assert_eq!(never.outcome.tree.steps[0].tries, 3);
    assert_eq!(never.outcome.reason, "wear: observe: nothing of the object is in sight");
}

#[test]
fn a_sequence_that_is_tried_again_begins_with_its_first_step() {
    let fake = FakeCell::new();
    let steps = vec![skill(&fake, "first"), skill(&fake, "second")];
    let both = TaskStep { tries: 2, ..step("both", Work::Sequence(steps)) };
    let done = carried(fake, vec![both], &[WELL, MISS, WELL]);
    assert_eq!(done.tree(), "task:done(both:done(first:done second:done))");
    let both = &done.outcome.tree.steps[0];
    assert_eq!(both.tries, 2);
    assert_eq!(both.steps.iter().map(|s| s.runs.len()).collect::<Vec<_>>(), [2, 2]);
}

#[test]
fn a_fallback_ends_with_the_first_step_that_is_done() {
    let ways = |fake: &FakeCell| {
        let mut other = skill(fake, "other-way");
        if let Work::Skill(used) = &mut other.work {
            used.skill.summary = "another way".into();
        }
        let ways = vec![skill(fake, "one-way"), other, skill(fake, "last-way")];
        vec![step("any-way", Work::Fallback(ways)), skill(fake, "after")]
    };
    let fake = FakeCell::new();
    let steps = ways(&fake);
    let done = carried(fake, steps, &[MISS, WELL]);
    assert_eq!(
        done.tree(),
        "task:done(any-way:done(one-way:failed other-way:done last-way:skipped) after:done)"
    );
    assert_eq!(done.outcome.success, Some(true));
    let fake = FakeCell::new();
    let steps = ways(&fake);
    let failed = carried(fake, steps, &[BLIND]);
    assert_eq!(
        failed.tree(),
        "task:failed(any-way:failed(one-way:failed other-way:failed last-way:failed) after:skipped)"
    );
    let sight = "observe: nothing of the object is in sight";
    let told = format!("any-way: one-way: {sight}; other-way: {sight}; last-way: {sight}");
    assert_eq!(failed.outcome.reason, told);
}

#[test]
fn every_object_has_its_turn_whatever_becomes_of_the_others() {
    let fake = FakeCell::new();
    let objects = ["one", "lost", "two", "three"].map(str::to_owned).to_vec();
    let steps = vec![TaskStep { objects, tries: 2, ..skill(&fake, "wear") }];
    let each = carried(fake, steps, &[MISS, WELL, BLIND, BLIND, WELL]);
    assert_eq!(
        each.tree(),
        "task:failed(wear:failed(wear-one:done wear-lost:failed wear-two:failed wear-three:done))"
    );
    // Another try looks again at what lies there: nothing is laid there anew.
    assert_eq!(each.laid(), ["one", "lost", "two", "three"]);
    let wear = &each.outcome.tree.steps[0];
    assert_eq!(wear.composition, Composition::Each);
    assert_eq!(wear.steps.iter().map(|s| s.runs.len()).collect::<Vec<_>>(), [2, 0, 2, 1]);
    assert_eq!(wear.steps[0].object.as_deref(), Some("one"));
    assert_eq!(wear.steps[3].runs[0].object, "three");
    assert_eq!(
        each.outcome.reason,
        "wear: wear-lost: lost cannot be laid there: it is lost; \
         wear-two: observe: nothing of the object is in sight"
    );
}

#[test]
fn what_must_be_true_before_is_asked_before_anything_moves() {
    let requiring = |requires: Vec<Precondition>, behaviour: Behaviour| {
        let fake = FakeCell::new();
        let mut wear = skill(&fake, "wear");
        if let Work::Skill(used) = &mut wear.work {
            used.requires = requires;
        }
        carried(fake, vec![wear], &[behaviour])
    };
    let both = vec![Precondition::HandEmpty, Precondition::ObjectVisible];
    let done = requiring(both.clone(), WELL);
    assert_eq!(done.outcome.tree.steps[0].runs[0].stages[0].name, "require");
    assert_eq!(done.outcome.success, Some(true));
    let blind = requiring(both.clone(), BLIND);
    assert_eq!(
        blind.outcome.reason,
        "wear: require: object-visible: nothing of the object is in sight"
    );
    let names: Vec<&str> =
        blind.outcome.tree.steps[0].runs[0].stages.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["require", "judge"]);
    let full = Behaviour { holds: true, ..WELL };
    assert_eq!(
        requiring(both, full).outcome.reason,
        "wear: require: hand-empty: something is between the pads"
    );
}

#[test]
fn a_verdict_is_told_and_decides_nothing() {
    let fake = FakeCell::new();
    let steps = vec![TaskStep { tries: 3, ..skill(&fake, "first") }, skill(&fake, "second")];
    let spoilt = Behaviour { spoils: true, ..WELL };
    let told = carried(fake, steps, &[spoilt, WELL]);
    assert_eq!(told.tree(), "task:done(first:done second:done)");
    assert_eq!(told.outcome.tree.steps[0].tries, 1);
    assert_eq!(told.outcome.success, Some(false));
}

#[test]
fn a_binding_names_the_target_and_the_methods() {
    let mut fake = FakeCell::new();
    let assignment = fake.assignment();
    let bound = |targets: BTreeMap<String, String>| {
        crate::run::Assignment::bound(
            fake.skill.clone(),
            fake.scene.clone(),
            assignment.robot().clone(),
            assignment.methods().clone(),
            &targets,
        )
    };
    assert!(bound([("head".to_owned(), "head".to_owned())].into()).is_ok());
    let told = bound([("head".to_owned(), "shelf".to_owned())].into()).unwrap_err();
    assert_eq!(told.code, "M005");
    assert!(told.cause.contains("\"shelf\""), "{}", told.cause);
    // A skill whose frame has another name than the scene's is bound to it.
    let head = fake.skill.demonstration.frames.remove("head").unwrap();
    fake.skill.demonstration.frames.insert("top".into(), head);
    fake.skill.stages[1].relative_to = crate::files::RelativeTo::Frame("top".into());
    let bound = |targets: BTreeMap<String, String>| {
        crate::run::Assignment::bound(
            fake.skill.clone(),
            fake.scene.clone(),
            assignment.robot().clone(),
            assignment.methods().clone(),
            &targets,
        )
    };
    assert!(bound(BTreeMap::new()).is_err());
    assert!(bound([("top".to_owned(), "head".to_owned())].into()).is_ok());
}

#[test]
fn steps_are_told_with_their_depth_as_they_begin_and_end() {
    let fake = FakeCell::new();
    let steps = vec![TaskStep { tries: 2, ..skill(&fake, "wear") }];
    let told = carried(fake, steps, &[MISS, WELL]).told;
    let begun: Vec<(usize, &str)> = told
        .iter()
        .filter(|event| event.state == State::Underway)
        .map(|event| (event.depth, event.name.as_str()))
        .collect();
    assert_eq!(begun, [(0, "task"), (1, "wear")]);
    let observed = told.iter().filter(|event| event.name == "observe").collect::<Vec<_>>();
    assert_eq!((observed.len(), observed[0].depth, observed[0].state), (2, 2, State::Done));
    let ended = told.last().unwrap();
    assert_eq!((ended.name.as_str(), ended.depth, ended.state), ("task", 0, State::Done));
    assert!(ended.seconds > told[told.len() - 2].seconds);
    assert_eq!(told[told.len() - 2].name, "wear");
}

#[test]
fn a_task_that_is_interrupted_ends_with_the_run_under_way() {
    let fake = Rc::new(FakeCell::new());
    let task = Task {
        name: "task".into(),
        summary: String::new(),
        steps: vec![TaskStep { tries: 9, ..skill(&fake, "first") }, skill(&fake, "second")],
    };
    let behaviours = [WELL].into();
    let cell = Box::new(Behaving { fake: Rc::clone(&fake), behaviours, asked: Rc::default() });
    let cancel = Cancel::default();
    let ordered = cancel.clone();
    let progress = Box::new(move |event: &TaskEvent| {
        if event.name == "pick" {
            ordered.order();
        }
    });
    let hooks = TaskHooks { progress, cancel, ..TaskHooks::default() };
    let mut prepare = |_: &SkillUse| Ok::<_, Infallible>(fake.assignment());
    let outcome = run_task(&task, &mut prepare, fake.plugins(WELL), cell, hooks).unwrap();
    let (told, asked) = (Vec::new(), Vec::new());
    let carried = Carried { outcome, asked, told };
    assert_eq!(carried.tree(), "task:failed(first:failed second:skipped)");
    assert_eq!(carried.outcome.success, Some(false));
    assert_eq!(carried.outcome.reason, "release: interrupted");
    assert_eq!(carried.outcome.tree.steps[0].runs.len(), 1, "no other try");
}

#[test]
fn every_run_of_a_task_is_recorded_under_its_number_and_step() {
    let fake = Rc::new(FakeCell::new());
    let folder = fake.folder.path().to_owned();
    let task = Task {
        name: "task".into(),
        summary: String::new(),
        steps: vec![TaskStep { tries: 2, ..skill(&fake, "wear") }],
    };
    let cell = Box::new(Behaving {
        fake: Rc::clone(&fake),
        behaviours: [MISS, WELL].into(),
        asked: Rc::default(),
    });
    let mut prepare = |_: &SkillUse| {
        let mut assignment = fake.assignment();
        assignment.recording = Some(folder.join("task.mcap"));
        Ok::<_, Infallible>(assignment)
    };
    let hooks = TaskHooks::default();
    let outcome = run_task(&task, &mut prepare, fake.plugins(WELL), cell, hooks).unwrap();
    let paths = outcome.tree.steps[0].runs.iter().map(|run| run.recording.clone().unwrap());
    let names: Vec<_> = paths.map(|path| path.strip_prefix(&folder).unwrap().to_owned()).collect();
    assert_eq!(names, ["task-01-wear.mcap", "task-02-wear.mcap"].map(std::path::PathBuf::from));
    for name in names {
        crate::record::read(&folder.join(name)).unwrap();
    }
}
