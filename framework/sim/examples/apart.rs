//! Searches the seeds of each template: the first whose usual caps are no near-duplicates of
//! each other, and the first whose wide ones are none of those that are not trained on.
//! `apart [MOST_SEEDS]`

use nalgebra::Point3;
use rayon::prelude::*;
use seeone_sim::category::cap::apart::{NEAR_DUPLICATE, distance, normalised};
use seeone_sim::category::cap::{Breadth, Resolution, Set, Template, drawn};
use std::error::Error;
use std::io::Write;

type Cloud = Vec<Point3<f64>>;

fn main() -> Result<(), Box<dyn Error>> {
    let most: u64 = std::env::args().nth(1).map_or(Ok(200), |n| n.parse())?;
    for template in Template::ALL {
        search(template, Breadth::Usual, most, |caps| {
            let pairs = (0..caps.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
            pairs.map(|(i, j)| distance(&caps[i], &caps[j])).collect()
        })?;
        let tried = not_trained_on(template);
        search(template, Breadth::Wide, most, |caps| {
            let pairs = caps.iter().flat_map(|wide| tried.iter().map(move |cap| (wide, cap)));
            pairs.map(|(wide, cap)| distance(wide, cap)).collect()
        })?;
    }
    Ok(())
}

/// The template's caps that choices are made and results are reported on.
fn not_trained_on(template: Template) -> Vec<Cloud> {
    let members = [Set::Validation, Set::Unseen].into_iter().flat_map(Set::members);
    let own = members.filter(|(_, member)| member.template == template);
    own.map(|(name, member)| normalised(&member.object(&name, Resolution::default()))).collect()
}

fn search(
    template: Template,
    breadth: Breadth,
    most: u64,
    distances: impl Fn(&[Cloud]) -> Vec<f64>,
) -> Result<(), Box<dyn Error>> {
    for seed in 0..most {
        let caps = drawn(template, breadth, seed, Resolution::default());
        let caps: Vec<Cloud> = caps.par_iter().map(normalised).collect();
        let all = distances(&caps);
        let nearest = all.iter().copied().fold(f64::INFINITY, f64::min);
        let near = all.iter().filter(|d| **d < NEAR_DUPLICATE).count();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let name = template.name();
        writeln!(
            std::io::stdout(),
            "{name} {breadth:?} seed {seed}: mean {mean:.4}, nearest {nearest:.4}, {near} near-duplicates"
        )?;
        if near == 0 {
            break;
        }
    }
    Ok(())
}
