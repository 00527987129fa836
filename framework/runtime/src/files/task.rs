//! A task: skills put together.

use super::Skill;
use crate::run::Precondition;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A task. One that was read from a file has at least one step, and no two steps of one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// Its name.
    pub name: String,
    /// What it does, in a sentence.
    pub summary: String,
    /// Its steps: each is taken when the one before it is done.
    pub steps: Vec<TaskStep>,
}

/// A step of a task.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskStep {
    /// Its name, unique in the task.
    pub name: String,
    /// What is done.
    pub work: Work,
    /// How often it is done at most as long as it fails; one or more.
    pub tries: usize,
    /// The objects it is done with, one after another, each laid before the robot as its turn
    /// comes; none for whatever lies there.
    pub objects: Vec<String>,
}

/// What is done in a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// A skill.
    Skill(Box<SkillUse>),
    /// One step after another, as long as each is done; never empty.
    Sequence(Vec<TaskStep>),
    /// One step after another, until one is done; never empty.
    Fallback(Vec<TaskStep>),
    /// One step after another, as long as an object is in sight; never empty. With the last of
    /// them none may be left.
    Visible(Vec<TaskStep>),
}

impl Work {
    /// The steps that lie in it.
    pub fn steps(&self) -> &[TaskStep] {
        match self {
            Self::Skill(_) => &[],
            Self::Sequence(steps) | Self::Fallback(steps) | Self::Visible(steps) => steps,
        }
    }
}

/// A skill as a task uses it.
#[derive(Clone, Debug, PartialEq)]
pub struct SkillUse {
    /// The skill's file.
    pub path: PathBuf,
    /// The skill, its methods those of the task where the task names any.
    pub skill: Skill,
    /// What must be true before.
    pub requires: Vec<Precondition>,
    /// For a frame of the skill the frame of the scene that it stands for.
    pub targets: BTreeMap<String, String>,
}

impl Task {
    /// Every use of a skill, in the order of the file.
    pub fn uses(&self) -> Vec<&SkillUse> {
        let mut uses = Vec::new();
        self.steps.iter().for_each(|step| step.collect(&mut uses));
        uses
    }

    /// The objects that its steps name, in the order of the file.
    pub fn objects(&self) -> Vec<&str> {
        let mut objects = Vec::new();
        self.steps.iter().for_each(|step| step.objects(&mut objects));
        objects
    }
}

impl TaskStep {
    fn objects<'a>(&'a self, objects: &mut Vec<&'a str>) {
        objects.extend(self.objects.iter().map(String::as_str));
        self.work.steps().iter().for_each(|step| step.objects(objects));
    }

    fn collect<'a>(&'a self, uses: &mut Vec<&'a SkillUse>) {
        if let Work::Skill(skill) = &self.work {
            uses.push(skill);
        }
        self.work.steps().iter().for_each(|step| step.collect(uses));
    }
}
