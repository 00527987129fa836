//! Settles caps on the head and tells how they sit:
//! `survey [--head small|medium|large] SET|TEMPLATE|NAME|FILE.obj...`

use nalgebra::Vector3;
use rayon::prelude::*;
use seeone_sim::category::cap::{self, Set};
use seeone_sim::import::{ImportFault, Options, cap_from_obj};
use seeone_sim::rigid_fit::rigid_fit;
use seeone_sim::worn::worn_on;
use seeone_sim::{HeadSize, Object, Region, Settings};
use std::error::Error;
use std::io::Write;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut given: Vec<String> = std::env::args().skip(1).collect();
    let mut size = HeadSize::MEDIUM;
    if let Some(at) = given.iter().position(|a| a == "--head") {
        let flag: Vec<String> = given.drain(at..(at + 2).min(given.len())).collect();
        size = flag.get(1).and_then(|s| HeadSize::named(s)).ok_or("no head has this size")?;
    }
    let names: Vec<String> = given.into_iter().flat_map(names).collect();
    let lines: Vec<String> = names.par_iter().map(|name| line(name, size)).collect();
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "name template vertices mass_g tilt_deg d_m edge_m front_hem_z back_hem_z apex_z brim_low_z"
    )?;
    for line in lines {
        writeln!(out, "{line}")?;
    }
    Ok(())
}

/// The names of a set, those of a template's caps, or the one name.
fn names(which: String) -> Vec<String> {
    if let Some(set) = Set::ALL.into_iter().find(|set| set.name() == which) {
        return cap::names(set);
    }
    let members = Set::DISJOINT.into_iter().flat_map(Set::members);
    let of_template: Vec<String> =
        members.filter(|(_, m)| m.template.name() == which).map(|(name, _)| name).collect();
    if of_template.is_empty() { vec![which] } else { of_template }
}

fn object(name: &str) -> Result<Object, ImportFault> {
    match cap::named(name) {
        Some(cap) => Ok(cap),
        None => cap_from_obj(Path::new(name), "imported", &Options::default()),
    }
}

fn line(name: &str, size: HeadSize) -> String {
    let object = match object(name) {
        Ok(object) => object,
        Err(fault) => return format!("{name}: {fault}"),
    };
    let template = cap::member(name).map_or("imported", |member| member.template.name());
    let worn = match worn_on(&object, size, &Settings::default()) {
        Ok(worn) => worn,
        Err(fault) => return format!("{name} {template}: {fault}"),
    };
    let turn = rigid_fit(object.mesh().vertices(), &worn.vertices).rotation;
    let tilt_deg = (turn * Vector3::z()).angle(&Vector3::z()).to_degrees();
    let hem = object.vertices_of(Region::Hem);
    let y = |v: &usize| worn.vertices[*v].y;
    let z_at = |v: Option<usize>| v.map_or(f64::NAN, |v| worn.vertices[v].z);
    let front = z_at(hem.iter().copied().max_by(|a, b| y(a).total_cmp(&y(b))));
    let back = z_at(hem.iter().copied().min_by(|a, b| y(a).total_cmp(&y(b))));
    let apex = worn.vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
    let brim = object.vertices_of(Region::Brim);
    let low = brim.iter().map(|v| worn.vertices[*v].z).fold(f64::INFINITY, f64::min);
    format!(
        "{name} {template} {} {:.0} {tilt_deg:.1} {:.3} {:.3} {front:.3} {back:.3} {apex:.3} {low:.3}",
        object.mesh().vertices().len(),
        object.mass() * 1e3,
        worn.diameter_m,
        worn.canonical.edge_m,
    )
}
