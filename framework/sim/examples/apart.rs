//! Searches the seed of each template: the first whose caps are no near-duplicates.
//! `apart [MOST_SEEDS]`

use rayon::prelude::*;
use seeone_sim::category::cap::apart::{NEAR_DUPLICATE, distance, normalised};
use seeone_sim::category::cap::{Resolution, Template, drawn};
use std::error::Error;
use std::io::Write;

fn main() -> Result<(), Box<dyn Error>> {
    let most: u64 = std::env::args().nth(1).map_or(Ok(200), |n| n.parse())?;
    for template in Template::ALL {
        for seed in 0..most {
            let caps: Vec<_> =
                drawn(template, seed, Resolution::default()).par_iter().map(normalised).collect();
            let pairs = (0..caps.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
            let all: Vec<f64> = pairs.map(|(i, j)| distance(&caps[i], &caps[j])).collect();
            let nearest = all.iter().copied().fold(f64::INFINITY, f64::min);
            let near = all.iter().filter(|d| **d < NEAR_DUPLICATE).count();
            let mean = all.iter().sum::<f64>() / all.len() as f64;
            let name = template.name();
            writeln!(
                std::io::stdout(),
                "{name} seed {seed}: mean {mean:.4}, nearest {nearest:.4}, {near} near-duplicates"
            )?;
            if near == 0 {
                break;
            }
        }
    }
    Ok(())
}
