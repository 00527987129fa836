//! A skill with one object in sight after another.

use super::*;

/// After its run nothing is in sight any more.
const LAST: Behaviour = Behaviour { clears: true, ..WELL };

/// A step that hangs what is in sight on three hooks in turn.
fn on_three_hooks(fake: &FakeCell, tries: usize) -> Vec<TaskStep> {
    let on = |hook: &str| TaskStep { tries, ..skill(fake, &format!("hang-{hook}")) };
    vec![step("hang", Work::Visible(["left", "middle", "right"].map(on).to_vec()))]
}

fn tidied(tries: usize, behaviours: &[Behaviour]) -> Carried {
    let fake = FakeCell::new();
    let steps = on_three_hooks(&fake, tries);
    carried(fake, steps, behaviours)
}

#[test]
fn it_goes_on_as_long_as_an_object_is_in_sight() {
    let two = tidied(1, &[WELL, LAST]);
    let tree = "task:done(hang:done(hang-left:done hang-middle:done hang-right:skipped))";
    assert_eq!(two.tree(), tree);
    assert_eq!(two.outcome.success, Some(true));
    let hang = &two.outcome.tree.steps[0];
    assert_eq!(hang.composition, Composition::Visible);
    // The hand goes out of the camera's view before the next look.
    assert_eq!(hang.steps[0].runs[0].stages[0].name, "observe");
    assert_eq!(hang.steps[1].runs[0].stages[0].name, "withdraw");
    let three = tidied(1, &[WELL, WELL, LAST]);
    assert_eq!(three.outcome.reason, "worn within 0.04 d");
}

#[test]
fn an_empty_table_is_done() {
    let fake = FakeCell::new();
    let steps = [skill(&fake, "first"), on_three_hooks(&fake, 1).remove(0)];
    let empty = carried(fake, steps.to_vec(), &[LAST]);
    assert!(
        empty
            .tree()
            .contains("hang:done(hang-left:skipped hang-middle:skipped hang-right:skipped)")
    );
    assert_eq!(empty.outcome.success, Some(true));
    assert_eq!(empty.outcome.reason, "nothing of the object is in sight");
}

#[test]
fn what_is_left_without_a_target_is_told() {
    let left = tidied(1, &[WELL]);
    let tree = "task:failed(hang:failed(hang-left:done hang-middle:done hang-right:done))";
    assert_eq!(left.tree(), tree);
    assert_eq!(left.outcome.reason, "hang: an object is left in sight, but no target for it");
}

#[test]
fn a_turn_that_fails_is_tried_again_and_leaves_the_others_theirs() {
    let again = tidied(2, &[MISS, WELL, LAST]);
    assert_eq!(again.outcome.success, Some(true));
    assert_eq!(again.outcome.tree.steps[0].steps[0].tries, 2);
    let lost = tidied(1, &[WELL, MISS, LAST]);
    let tree = "task:failed(hang:failed(hang-left:done hang-middle:failed hang-right:done))";
    assert_eq!(lost.tree(), tree);
    assert_eq!(lost.outcome.reason, "hang: hang-middle: pick: closed on nothing, at 0.0 mm");
}

#[test]
fn a_camera_that_breaks_down_between_turns_fails_the_step() {
    let broken = Behaviour { fails: Some("observe"), panics: true, ..WELL };
    let told = tidied(1, &[broken]).outcome;
    let reason = "hang: a plugin panicked: broken observe";
    assert_eq!((told.success, told.reason.as_str()), (Some(false), reason));
}
