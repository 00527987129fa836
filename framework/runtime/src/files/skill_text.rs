//! Writing a skill, as `teach` does: text that reads back to the same skill.

use super::{RelativeTo, Skill, Stage};
use seeone_core::pose::PoseFields;
use seeone_core::{Diagnostic, Pose};
use seeone_plugin::{GripperCommand, Measure};
use std::fmt::Write;
use std::path::Path;

impl Skill {
    /// The text of this skill's file, which lies in `folder`: the cloud is named from there.
    ///
    /// # Errors
    /// `S024` when a cloud does not lie below `folder`.
    pub fn to_toml(&self, folder: &Path) -> Result<String, Diagnostic> {
        let mut text = String::from("schema = 1\n");
        line(&mut text, "name", quoted(&self.name));
        line(&mut text, "category", quoted(&self.category));
        line(&mut text, "summary", quoted(&self.summary));
        text.push_str("\n[demonstration]\n");
        line(&mut text, "cloud", quoted(&below(folder, &self.demonstration.cloud)?));
        let camera: [f64; 3] = self.demonstration.camera_position.into();
        line(&mut text, "camera_xyz_m", numbers(&camera));
        for (name, frame) in &self.demonstration.frames {
            line(&mut text, &format!("frames.{name}"), pose(frame));
        }
        for stage in &self.stages {
            stage_text(&mut text, stage);
        }
        if !self.methods.is_empty() {
            text.push_str("\n[methods]\n");
            for (kind, name) in &self.methods {
                line(&mut text, kind.name(), quoted(name));
            }
        }
        if let Some(result) = &self.result {
            text.push_str("\n[result]\n");
            line(&mut text, "cloud", quoted(&below(folder, &result.cloud)?));
            line(&mut text, "relative_to", quoted(&result.frame));
            line(&mut text, "within_m", number(result.within_m));
            line(&mut text, "within_deg", number(result.within_deg));
        }
        success_text(&mut text, &self.measure);
        Ok(text)
    }
}

/// The path of a cloud from `folder`.
fn below(folder: &Path, cloud: &Path) -> Result<String, Diagnostic> {
    let path = cloud.strip_prefix(folder).map_err(|_| {
        Diagnostic::new("S024", "the cloud does not lie in the skill's own folder").in_file(cloud)
    })?;
    Ok(path.to_string_lossy().into_owned())
}

fn success_text(text: &mut String, measure: &Measure) {
    text.push_str("\n[success]\n");
    line(text, "measure", quoted(measure.name()));
    match measure {
        Measure::Worn { tolerance_d } => line(text, "tolerance_d", number(*tolerance_d)),
        Measure::Hung => {}
        Measure::Held { frame, within_m } => {
            line(text, "at", quoted(frame));
            line(text, "within_m", number(*within_m));
        }
    }
}

fn stage_text(text: &mut String, stage: &Stage) {
    text.push_str("\n[[stage]]\n");
    line(text, "name", quoted(&stage.name));
    line(
        text,
        "relative_to",
        match &stage.relative_to {
            RelativeTo::Object => quoted("object"),
            RelativeTo::Frame(name) => quoted(name),
        },
    );
    line(text, "gripper_pose", pose(&stage.gripper_pose));
    line(text, "approach_m", number(stage.approach_m));
    line(text, "opening_m", number(stage.opening_m));
    if let Some(force_n) = stage.until_contact_n {
        line(text, "until_contact_n", number(force_n));
    }
    match stage.gripper {
        Some(GripperCommand::Close { force_n }) => {
            line(text, "gripper", format!("{{ close_n = {} }}", number(force_n)));
        }
        Some(GripperCommand::Open { opening_m }) => {
            line(text, "gripper", format!("{{ open_m = {} }}", number(opening_m)));
        }
        None => {}
    }
    line(text, "retreat_m", number(stage.retreat_m));
    line(text, "lift_m", number(stage.lift_m));
    line(text, "turn_about_closing_deg", number(stage.turn_about_closing_deg));
    if stage.onward {
        line(text, "onward", "true");
    }
}

fn line(text: &mut String, key: &str, value: impl AsRef<str>) {
    writeln!(text, "{key} = {}", value.as_ref()).expect("a string takes any text");
}

fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}

/// The shortest text that reads back to the same number, with a point in it.
fn number(value: f64) -> String {
    toml::Value::from(value).to_string()
}

fn numbers(values: &[f64]) -> String {
    format!("[{}]", values.iter().copied().map(number).collect::<Vec<_>>().join(", "))
}

fn pose(pose: &Pose) -> String {
    let fields = PoseFields::from(pose);
    format!("{{ xyz_m = {}, quat_xyzw = {} }}", numbers(&fields.xyz_m), numbers(&fields.quat_xyzw))
}
