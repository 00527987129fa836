//! Settles caps on the head and tells how they sit:
//! `survey train|validation|unseen|NAME|FILE.obj`

use rayon::prelude::*;
use seeone_sim::category::cap::{self, Set};
use seeone_sim::import::{ImportFault, Options, cap_from_obj};
use seeone_sim::{Object, Region, Settings, worn::worn};
use std::error::Error;
use std::io::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let which = std::env::args().nth(1).unwrap_or_else(|| "unseen".into());
    let names = match Set::ALL.into_iter().find(|s| s.name() == which) {
        Some(set) => cap::names(set),
        None => vec![which],
    };
    let lines: Vec<String> = names.par_iter().map(|name| line(name)).collect();
    let mut out = std::io::stdout().lock();
    writeln!(out, "name vertices mass_g d_m edge_m front_hem_z back_hem_z apex_z brim_low_z")?;
    for line in lines {
        writeln!(out, "{line}")?;
    }
    Ok(())
}

fn object(name: &str) -> Result<Object, ImportFault> {
    match cap::named(name) {
        Some(cap) => Ok(cap),
        None => cap_from_obj(Path::new(name), "imported", &Options::default()),
    }
}

fn line(name: &str) -> String {
    let object = match object(name) {
        Ok(object) => object,
        Err(fault) => return format!("{name}: {fault}"),
    };
    let worn = match worn(&object, &Settings::default()) {
        Ok(worn) => worn,
        Err(fault) => return format!("{name}: {fault}"),
    };
    let hem = object.vertices_of(Region::Hem);
    let y = |v: &usize| worn.vertices[*v].y;
    let z_at = |v: Option<usize>| v.map_or(f64::NAN, |v| worn.vertices[v].z);
    let front = z_at(hem.iter().copied().max_by(|a, b| y(a).total_cmp(&y(b))));
    let back = z_at(hem.iter().copied().min_by(|a, b| y(a).total_cmp(&y(b))));
    let apex = worn.vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
    let brim = object.vertices_of(Region::Brim);
    let low = brim.iter().map(|v| worn.vertices[*v].z).fold(f64::INFINITY, f64::min);
    format!(
        "{name} {} {:.0} {:.3} {:.3} {front:.3} {back:.3} {apex:.3} {low:.3}",
        object.mesh().vertices().len(),
        object.mass() * 1e3,
        worn.diameter_m,
        worn.canonical.edge_m,
    )
}
