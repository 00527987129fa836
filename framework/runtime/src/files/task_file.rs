//! Reading a task.

use super::codes::{Family, Fault};
use super::resolver::Resolver;
use super::skill_file::methods;
use super::source::Source;
use super::spanned::Spanned;
use super::{KnownMethods, Skill, SkillUse, Task, TaskStep, Work};
use crate::run::Precondition;
use schemars::JsonSchema;
use seeone_core::Diagnostic;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

/// A task file: skills put together.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "task")]
pub(super) struct RawTask {
    /// The version of the format.
    #[serde(rename = "schema")]
    #[schemars(extend("const" = 1))]
    _schema: u32,
    /// Its name: small letters, digits and hyphens.
    name: Spanned<String>,
    /// What it does, in a sentence.
    #[serde(default)]
    summary: String,
    /// Its steps: each is taken when the one before it is done.
    #[serde(default)]
    step: Vec<Spanned<RawStep>>,
}

/// A step of a task: it has one of `skill`, `sequence` and `fallback`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "step")]
struct RawStep {
    /// Its name, unique in the task.
    name: Spanned<String>,
    /// The name of a skill whose file lies beside the task or in the folder above.
    skill: Option<Spanned<String>>,
    /// Steps that are taken one after another, as long as each is done.
    sequence: Option<Spanned<Vec<Spanned<RawStep>>>>,
    /// Steps that are taken one after another, until one is done.
    fallback: Option<Spanned<Vec<Spanned<RawStep>>>>,
    /// How often the step is taken at most as long as it fails; 1 when it is not said. Before
    /// another try the hand opens and goes back to where the robot waits, and the robot looks again.
    #[schemars(range(min = 1, max = 20))]
    tries: Option<Spanned<u32>>,
    /// The object that is laid before the robot as the step begins.
    object: Option<Spanned<String>>,
    /// Objects with which the step is taken, one after another, whatever becomes of each.
    for_each_object: Option<Spanned<Vec<Spanned<String>>>>,
    /// A skill is taken with one object in sight after another, until none is: for a frame of the
    /// skill the scene's frames that it stands for in turn.
    for_each_visible: Option<Spanned<Turns>>,
    /// What must be true before a skill: `object-visible`, `hand-empty`.
    #[serde(default)]
    require: Vec<Spanned<String>>,
    /// For a frame of the skill the frame of the scene that it stands for.
    #[serde(default)]
    targets: BTreeMap<Spanned<String>, Spanned<String>>,
    /// Plugins by kind, which go before those of the skill.
    #[serde(default)]
    methods: BTreeMap<Spanned<String>, Spanned<String>>,
}

/// For a frame of a skill the scene's frames that it stands for, one after another.
type Turns = BTreeMap<Spanned<String>, Spanned<Vec<Spanned<String>>>>;

/// The tries a step may ask for.
const TRIES: RangeInclusive<u32> = 1..=20;
/// Steps within steps.
const DEEPEST: usize = 8;
/// The most steps of a task, and the most objects of a step.
const MOST: usize = 100;
/// The most runs of a task: objects within objects within tries are soon more than anybody means.
const MOST_RUNS: f64 = 1000.0;

impl Task {
    /// Reads and checks a task with the skills that it names.
    ///
    /// # Errors
    /// Every fault found, codes `T0xx`, and those of the skills.
    pub fn read(path: &Path, known: &KnownMethods) -> Result<Self, Vec<Diagnostic>> {
        let source = Source::open(Family::Task, path).map_err(|fault| vec![fault])?;
        let raw: RawTask = source.parse()?;
        let mut reader = Reader {
            resolver: Resolver::new(&source),
            known,
            names: BTreeSet::new(),
            skills: BTreeMap::new(),
        };
        let task = Task {
            name: reader.resolver.name("name", &raw.name),
            summary: raw.summary,
            steps: reader.steps(&raw.step, 0..0, 1),
        };
        let runs: f64 = task.steps.iter().map(most_runs).sum();
        if runs > MOST_RUNS {
            let cause = format!("up to {runs} runs, but a task makes at most {MOST_RUNS}");
            reader.resolver.fault(Fault::Order, raw.step[0].span(), cause);
        }
        reader.resolver.finish(task)
    }
}

/// What is known while a task is read.
struct Reader<'a> {
    resolver: Resolver<'a>,
    known: &'a KnownMethods,
    names: BTreeSet<String>,
    /// The skills read so far, `None` for one whose faults are told already.
    skills: BTreeMap<PathBuf, Option<Skill>>,
}

impl Reader<'_> {
    fn steps(&mut self, raw: &[Spanned<RawStep>], at: Range<usize>, depth: usize) -> Vec<TaskStep> {
        if raw.is_empty() {
            self.resolver.fault(Fault::Order, at, "there is no step");
        } else if depth > DEEPEST {
            let cause = format!("steps lie in steps {DEEPEST} deep at most");
            self.resolver.fault(Fault::Order, raw[0].span(), cause);
            return Vec::new();
        } else if raw.len() + self.names.len() > MOST {
            let cause = format!("a task has at most {MOST} steps");
            self.resolver.fault(Fault::Order, raw[0].span(), cause);
            return Vec::new();
        }
        raw.iter().filter_map(|raw| self.step(raw, depth)).collect()
    }

    fn step(&mut self, spanned: &Spanned<RawStep>, depth: usize) -> Option<TaskStep> {
        let raw = spanned.get_ref();
        let name = self.resolver.name("name", &raw.name);
        if !self.names.insert(name.clone()) {
            let cause = format!("a second step is named {name:?}");
            self.resolver.fault(Fault::Name, raw.name.span(), cause);
        }
        let work = match (&raw.skill, &raw.sequence, &raw.fallback) {
            (Some(skill), None, None) => self.skill_work(raw, &name, skill),
            (None, Some(steps), None) => {
                self.not_of_a_group(raw);
                Some(Work::Sequence(self.steps(steps.get_ref(), steps.span(), depth + 1)))
            }
            (None, None, Some(steps)) => {
                self.not_of_a_group(raw);
                Some(Work::Fallback(self.steps(steps.get_ref(), steps.span(), depth + 1)))
            }
            _ => {
                let cause = format!("step {name:?} must have one of skill, sequence and fallback");
                self.resolver.fault(Fault::Order, raw.name.span(), cause);
                None
            }
        };
        let (work, objects) = (work?, self.objects(raw));
        // With what is in sight every step of it is tried so often, and not all of them again.
        let tries = match work {
            Work::Visible(_) => 1,
            _ => self.tries(raw.tries.as_ref()),
        };
        Some(TaskStep { name, work, tries, objects })
    }

    fn tries(&mut self, raw: Option<&Spanned<u32>>) -> usize {
        let Some(raw) = raw else { return 1 };
        let tries = *raw.get_ref();
        if !TRIES.contains(&tries) {
            let (low, high) = TRIES.into_inner();
            let cause = format!("tries = {tries}, but it must lie in {low} to {high}");
            self.resolver.fault(Fault::Range, raw.span(), cause);
        }
        tries as usize
    }

    fn objects(&mut self, raw: &RawStep) -> Vec<String> {
        match (&raw.object, &raw.for_each_object) {
            (None, None) => Vec::new(),
            (Some(object), None) => vec![self.resolver.name("object", object)],
            (None, Some(objects)) => {
                let named = objects.get_ref();
                if named.is_empty() || named.len() > MOST {
                    let cause = format!("for_each_object names 1 to {MOST} objects");
                    self.resolver.fault(Fault::Order, objects.span(), cause);
                }
                named.iter().map(|o| self.resolver.name("for_each_object", o)).collect()
            }
            (Some(_), Some(objects)) => {
                let cause = "a step has either object or for_each_object";
                self.resolver.fault(Fault::Order, objects.span(), cause);
                Vec::new()
            }
        }
    }

    /// What only a skill can have.
    fn not_of_a_group(&mut self, raw: &RawStep) {
        let of_skills = [
            ("require", raw.require.first().map(Spanned::span)),
            ("targets", raw.targets.keys().next().map(Spanned::span)),
            ("methods", raw.methods.keys().next().map(Spanned::span)),
            ("for_each_visible", raw.for_each_visible.as_ref().map(Spanned::span)),
        ];
        for (key, at) in of_skills {
            if let Some(at) = at {
                let cause = format!("{key} is for a step with a skill");
                self.resolver.fault(Fault::Order, at, cause);
            }
        }
    }

    fn skill_use(&mut self, raw: &RawStep, name: &Spanned<String>) -> Option<SkillUse> {
        let requires = raw.require.iter().filter_map(|name| self.precondition(name)).collect();
        let methods = methods(&mut self.resolver, &raw.methods, self.known);
        let (path, mut skill) = self.skill(name)?;
        skill.methods.extend(methods);
        let targets = raw.targets.iter().map(|(frame, target)| {
            (self.frame(&skill, frame), self.resolver.name("targets", target))
        });
        let targets = targets.collect();
        Some(SkillUse { path, skill, requires, targets })
    }

    /// A skill once, or with one object in sight after another.
    fn skill_work(&mut self, raw: &RawStep, name: &str, skill: &Spanned<String>) -> Option<Work> {
        let used = self.skill_use(raw, skill)?;
        let Some(turns) = &raw.for_each_visible else { return Some(Work::Skill(Box::new(used))) };
        if raw.object.is_some() || raw.for_each_object.is_some() {
            let cause = "a step lays objects there or takes what is in sight, not both";
            self.resolver.fault(Fault::Order, turns.span(), cause);
        }
        let most = turns.get_ref().values().map(|targets| targets.get_ref().len()).max();
        let most = most.filter(|most| (1..=MOST).contains(most)).unwrap_or_else(|| {
            let cause = format!("for_each_visible names a frame with 1 to {MOST} targets");
            self.resolver.fault(Fault::Order, turns.span(), cause);
            0
        });
        let tries = self.tries(raw.tries.as_ref());
        let mut steps = vec![(name.to_owned(), used.clone()); most];
        for (frame, targets) in turns.get_ref() {
            let frame = self.frame(&used.skill, frame);
            if targets.get_ref().len() != most {
                let cause = format!("{frame:?} has fewer targets than another frame");
                self.resolver.fault(Fault::Order, targets.span(), cause);
            }
            let mut taken = BTreeSet::new();
            if let Some(again) = targets.get_ref().iter().find(|t| !taken.insert(t.get_ref())) {
                let cause = format!("{:?} is a target twice", again.get_ref());
                self.resolver.fault(Fault::Order, again.span(), cause);
            }
            for ((name, used), target) in steps.iter_mut().zip(targets.get_ref()) {
                let target = self.resolver.name("for_each_visible", target);
                *name += &format!("-{target}");
                used.targets.insert(frame.clone(), target);
            }
        }
        let steps = steps.into_iter().map(|(name, used)| TaskStep {
            name,
            work: Work::Skill(Box::new(used)),
            tries,
            objects: Vec::new(),
        });
        Some(Work::Visible(steps.collect()))
    }

    /// The name of a frame that the skill has.
    fn frame(&mut self, skill: &Skill, frame: &Spanned<String>) -> String {
        let frames = &skill.demonstration.frames;
        if !frames.contains_key(frame.get_ref()) {
            let cause = format!("skill {:?} has no frame {:?}", skill.name, frame.get_ref());
            let fault = self.resolver.source.fault(Fault::Reference, frame.span(), cause);
            let frames = frames.keys().map(String::as_str);
            self.resolver.note(fault.suggest(frame.get_ref(), frames));
        }
        frame.get_ref().clone()
    }

    fn precondition(&mut self, name: &Spanned<String>) -> Option<Precondition> {
        let found = Precondition::named(name.get_ref());
        if found.is_none() {
            let cause = format!("there is no precondition {:?}", name.get_ref());
            let fault = self.resolver.source.fault(Fault::Reference, name.span(), cause);
            let known = Precondition::ALL.map(Precondition::name);
            self.resolver.note(fault.suggest(name.get_ref(), known));
        }
        found
    }

    /// The skill of this name. Its own faults are told once, whoever names it.
    fn skill(&mut self, name: &Spanned<String>) -> Option<(PathBuf, Skill)> {
        let wanted = self.resolver.name("skill", name);
        let file = format!("{wanted}.toml");
        let folders = folders(self.resolver.source.folder());
        let Some(path) = folders.iter().map(|f| f.join(&file)).find(|path| path.is_file()) else {
            let cause =
                format!("there is no skill {wanted:?} beside the task or in the folder above");
            let fault = self.resolver.source.fault(Fault::Reference, name.span(), cause);
            let known = skills(&folders, &self.resolver.source.path);
            self.resolver.note(fault.suggest(&wanted, known.iter().map(String::as_str)));
            return None;
        };
        if !self.skills.contains_key(&path) {
            let read = Skill::read(&path, self.known);
            let read =
                read.map_err(|faults| faults.into_iter().for_each(|f| self.resolver.note(f)));
            self.skills.insert(path.clone(), read.ok());
        }
        let skill = self.skills[&path].clone()?;
        Some((path, skill))
    }
}

/// How many runs a step makes if each but the last of its tries fails at its end.
fn most_runs(step: &TaskStep) -> f64 {
    let once = match &step.work {
        Work::Skill(_) => 1.0,
        work => work.steps().iter().map(most_runs).sum(),
    };
    once * step.tries as f64 * step.objects.len().max(1) as f64
}

/// Where the skills of a task in `folder` lie.
fn folders(folder: &Path) -> [PathBuf; 2] {
    // The folder above one that is named by its end alone is not to be had from the name.
    let here = if folder == Path::new("") { Path::new(".") } else { folder };
    let above = match here.parent() {
        Some(above) if here.file_name().is_some() => above.to_owned(),
        _ => here.join(".."),
    };
    [here.to_owned(), if above == Path::new("") { ".".into() } else { above }]
}

/// The names of the files that may be skills.
fn skills(folders: &[PathBuf], task: &Path) -> BTreeSet<String> {
    let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten();
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    paths
        .filter(|path| {
            path.extension().is_some_and(|e| e == "toml") && path.file_name() != task.file_name()
        })
        .filter_map(|path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()))
        .collect()
}
