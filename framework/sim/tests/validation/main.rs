//! The world against analytic mechanics, symmetry, and another solver.

mod reruns;
mod scenes;

use scenes::check::Check;
use scenes::{bending, contact, hanging, reference, symmetry};

/// Holds every line to its tolerance.
fn hold(checks: &[Check]) {
    let failed: Vec<String> =
        checks.iter().filter(|c| !c.holds()).map(ToString::to_string).collect();
    assert!(!checks.is_empty() && failed.is_empty(), "\n{}", failed.join("\n"));
}

#[test]
fn free_fall_follows_half_g_t_squared() {
    hold(&contact::falls());
}

#[test]
fn coulomb_friction_sticks_below_its_angle_and_slides_as_it_should_above() {
    hold(&contact::slopes());
}

#[test]
fn a_hanging_sheet_is_stretched_by_its_weight() {
    hold(&hanging::sags());
}

#[test]
fn a_strip_pinned_at_both_ends_is_a_catenary() {
    hold(&hanging::catenaries());
}

#[test]
fn a_hanging_strip_swings_with_its_period_and_gains_no_energy() {
    hold(&hanging::swings());
}

#[test]
fn a_cantilever_droops_as_a_beam_does() {
    hold(&bending::cantilevers());
}

#[test]
fn a_visor_hardly_bends() {
    hold(&bending::visors());
}

#[test]
fn scale_and_direction_do_not_matter() {
    hold(&symmetry::symmetries());
}

#[test]
fn another_solver_finds_the_same_shape() {
    hold(&reference::hammocks());
}
