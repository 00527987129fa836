//! The codes of what can be wrong with a file: a letter for the kind of file, a number for
//! the kind of fault. A code keeps its meaning for ever.

/// The kinds of files a user writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// A skill: what was demonstrated.
    Skill,
    /// A task: skills put together.
    Task,
    /// A scene: what stands where.
    Scene,
    /// A robot: which plugin moves which arm.
    Robot,
}

/// The kinds of faults.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// Missing, too large or not text.
    Unreadable,
    /// Not TOML.
    Syntax,
    /// NaN or infinite.
    NotFinite,
    /// `schema` is missing or unknown.
    Schema,
    /// A key is missing.
    MissingKey,
    /// A key has no meaning there.
    UnknownKey,
    /// A value of another type than the key's.
    WrongType,
    /// A value outside its range.
    Range,
    /// Not a name of small letters, digits and hyphens.
    Name,
    /// Not a pose.
    Pose,
    /// The order or number of things is wrong.
    Order,
    /// Names something that there is not.
    Reference,
}

impl Family {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::Skill, Self::Task, Self::Scene, Self::Robot];

    /// The name used on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Skill => "skill",
            Self::Task => "task",
            Self::Scene => "scene",
            Self::Robot => "robot",
        }
    }

    /// The code of a fault in a file of this family.
    pub(super) fn code(self, fault: Fault) -> &'static str {
        let [skill, task, scene, robot] = match fault {
            Fault::Unreadable => ["S001", "T001", "C001", "B001"],
            Fault::Syntax => ["S002", "T002", "C002", "B002"],
            Fault::NotFinite => ["S003", "T003", "C003", "B003"],
            Fault::Schema => ["S010", "T010", "C010", "B010"],
            Fault::MissingKey => ["S011", "T011", "C011", "B011"],
            Fault::UnknownKey => ["S012", "T012", "C012", "B012"],
            Fault::WrongType => ["S013", "T013", "C013", "B013"],
            Fault::Range => ["S020", "T020", "C020", "B020"],
            Fault::Name => ["S021", "T021", "C021", "B021"],
            Fault::Pose => ["S022", "T022", "C022", "B022"],
            Fault::Order => ["S023", "T023", "C023", "B023"],
            Fault::Reference => ["S024", "T024", "C024", "B024"],
        };
        match self {
            Self::Skill => skill,
            Self::Task => task,
            Self::Scene => scene,
            Self::Robot => robot,
        }
    }
}
