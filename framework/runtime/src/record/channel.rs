//! The channels of a recording and the schemas of their messages.

use serde_json::{Value, json};

/// A channel of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Channel {
    /// What is needed to repeat the run.
    Run,
    /// Canonical clouds.
    Cloud,
    /// Grasps.
    Candidates,
    /// Tool poses.
    KeyPoses,
    /// The program.
    Trajectory,
    /// Where the robot was.
    Robot,
    /// Where the object was.
    Object,
    /// How steps and stages ended.
    Stages,
    /// How the run ended.
    Verdict,
}

impl Channel {
    /// Every channel, in the order in which a file declares them.
    pub const ALL: [Channel; 9] = [
        Channel::Run,
        Channel::Cloud,
        Channel::Candidates,
        Channel::KeyPoses,
        Channel::Trajectory,
        Channel::Robot,
        Channel::Object,
        Channel::Stages,
        Channel::Verdict,
    ];

    /// The topic.
    pub fn topic(self) -> &'static str {
        match self {
            Channel::Run => "/run",
            Channel::Cloud => "/cloud",
            Channel::Candidates => "/candidates",
            Channel::KeyPoses => "/key_poses",
            Channel::Trajectory => "/trajectory",
            Channel::Robot => "/robot",
            Channel::Object => "/object",
            Channel::Stages => "/stages",
            Channel::Verdict => "/verdict",
        }
    }

    /// The name of the messages' schema.
    pub(super) fn schema_name(self) -> String {
        format!("seeone.{}", &self.topic()[1..])
    }

    /// The JSON schema of the messages.
    pub(super) fn schema(self) -> Value {
        let keys: &[(&str, &str)] = match self {
            Channel::Run => &[
                ("skill", "string"),
                ("object", "string"),
                ("robot", "string"),
                ("scene", "object"),
                ("seed", "integer"),
                ("methods", "object"),
                ("provenance", "object"),
            ],
            Channel::Cloud => {
                &[("of", "string"), ("points", "array"), ("nocs", "array"), ("confidence", "array")]
            }
            Channel::Candidates => {
                &[("demonstrated", "object"), ("scale_m", "number"), ("candidates", "array")]
            }
            Channel::KeyPoses => {
                &[("grasp", "integer"), ("turn_deg", "number"), ("key_poses", "array")]
            }
            Channel::Trajectory => &[("cost", "number"), ("steps", "array")],
            Channel::Robot => &[("joints", "array"), ("opening_m", "number")],
            Channel::Object => &[("vertices", "array")],
            Channel::Stages => &[("name", "string"), ("ok", "boolean"), ("reason", "string")],
            Channel::Verdict => &[
                ("grasped", "boolean"),
                ("success", "boolean"),
                ("error_m", "number"),
                ("error_d", "number"),
                ("tilt_deg", "number"),
                ("nose_up_deg", "number"),
                ("yaw_deg", "number"),
                ("reason", "string"),
            ],
        };
        let properties: serde_json::Map<String, Value> =
            keys.iter().map(|(key, kind)| ((*key).to_owned(), json!({ "type": kind }))).collect();
        json!({ "title": self.schema_name(), "type": "object", "properties": properties })
    }
}
