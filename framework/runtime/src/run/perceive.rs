//! Where does each observed point lie in the canonical state: on the object that was
//! shown, and on this one?

use super::act::Acted;
use super::assignment::Assignment;
use super::bench::Bench;
use super::observe::Seen;
use super::schedule::leave;
use super::step::{Failed, Step};
use crate::plugins::Plugins;
use crate::transfer::Placement;
use bevy_ecs::prelude::*;
use seeone_plugin::{CanonicalCloud, Observation};

/// The canonical clouds of a run. The demonstration goes through the same plugins as the
/// instance: whatever those get wrong the same way on both then cancels.
#[derive(Component, Clone, Debug)]
pub struct Perceived {
    /// Of the object that was shown.
    pub demonstration: CanonicalCloud,
    /// Of this object.
    pub instance: CanonicalCloud,
}

pub(super) fn perceive(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<(Entity, &Assignment, &Seen, Option<&Acted>), Without<Failed>>,
) {
    for (run, assignment, seen, acted) in &runs {
        let shown = Observation {
            depth: None,
            cloud: assignment.demonstration.clone(),
            camera_position: assignment.skill.demonstration.camera_position,
        };
        let perceived = bench.step(Step::Perceive, |plugins| {
            let demonstration =
                perceived(plugins, &shown).map_err(|e| format!("the demonstration: {e}"))?;
            of_the_category(plugins, &demonstration)
                .map_err(|e| format!("the demonstration: {e}"))?;
            let instance = perceived(plugins, &seen.0)?;
            // What was tried already is what it is, however it hangs or lies now.
            if acted.is_none() {
                of_the_category(plugins, &instance)?;
            }
            Ok(Perceived { demonstration, instance })
        });
        leave(&mut commands, run, perceived);
    }
}

/// What the perception says of `observation`, if it is sound.
pub(super) fn perceived(
    plugins: &mut Plugins,
    observation: &Observation,
) -> Result<CanonicalCloud, String> {
    let cloud = plugins.perception.perceive(observation).map_err(|e| e.to_string())?;
    sound(&cloud).map(|()| cloud)
}

/// What is seen is no object of the category, or more than one, where its points lie off their
/// canonical coordinates by more than this for each cube of the confidence, metres: an object that is
/// folded is far off its canonical shape, but surely so (`docs/decisions/0030-no-cap.md`).
const MOST_DOUBT_M: f64 = 0.06;

fn of_the_category(plugins: &Plugins, cloud: &CanonicalCloud) -> Result<(), String> {
    let placement = Placement::new(plugins.alignment.as_ref(), cloud);
    let fit = placement.map_err(|e| e.to_string())?.global().transform;
    let confidences: Vec<f64> = cloud.weights().collect();
    let total: f64 = confidences.iter().sum();
    let pairs = cloud.points.iter().zip(&cloud.nocs).zip(&confidences);
    let squares = pairs.map(|((point, nocs), weight)| weight * (point - fit * nocs).norm_squared());
    let off_m = (squares.sum::<f64>() / total).sqrt();
    let confidence = total / confidences.len() as f64;
    // A confidence of zero everywhere is no number, and no doubt is smaller.
    if off_m / confidence.powi(3) <= MOST_DOUBT_M {
        return Ok(());
    }
    Err(format!(
        "what is seen is no object of the skill's category, or more than one: it lies {:.0} mm off \
         the shape that it is taken for, with a confidence of {confidence:.2}",
        off_m * 1e3
    ))
}

/// What no plugin may hand on: vectors of unequal length, numbers that are not finite.
fn sound(cloud: &CanonicalCloud) -> Result<(), String> {
    let n = cloud.len();
    let equal = cloud.nocs.len() == n
        && cloud.confidence.len() == n
        && cloud.features.len() == n * cloud.feature_width;
    let finite = cloud.points.iter().chain(&cloud.nocs).all(|p| p.iter().all(|v| v.is_finite()))
        && cloud.confidence.iter().flatten().all(|v| (0.0..=1.0).contains(v))
        && cloud.features.iter().all(|v| v.is_finite());
    match (equal, finite) {
        (true, true) => Ok(()),
        (false, _) => Err("the perception's vectors differ in length".into()),
        (_, false) => Err("the perception gave numbers that are not finite or no share".into()),
    }
}
