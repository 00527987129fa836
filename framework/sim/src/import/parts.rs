//! Which part of the cap each triangle belongs to.

use super::ImportFault;
use super::clean::boundary;
use super::fit::Hem;
use super::sheet::{Sheet, edges_of};
use crate::object::Region;
use std::collections::BTreeSet;

/// A brim's triangle looks up or down by at least this (cosine to the vertical), or it lies
/// clearly in front of the crown.
const BRIM_FLATNESS: f64 = 0.4;
const CLEARLY_OUTSIDE: f64 = 1.2;
/// The brim lies below this share of the crown's height.
const BRIM_HEIGHT: f64 = 0.4;
/// A brim smaller than this share of the area is none.
const SMALLEST_BRIM: f64 = 0.05;
/// The hem's boundary lies below this share of the crown's height.
const HEM_HEIGHT: f64 = 0.2;
/// Half of the angle of the stiffened front, as a tangent (60 degrees).
const FRONT_TANGENT: f64 = 1.732;

/// A cap taken apart.
pub struct Parts {
    /// The region of every triangle.
    pub regions: Vec<Region>,
    /// The vertices of the rim: where the crown ends, in the open or at the brim. Never
    /// empty.
    pub rim: BTreeSet<u32>,
}

impl Parts {
    /// Takes an upright sheet apart.
    ///
    /// # Errors
    /// [`ImportFault::NotACap`] when there is no brim.
    pub fn find(sheet: &Sheet, hem: &Hem) -> Result<Self, ImportFault> {
        let brim = brim(sheet, hem)?;
        let rim = rim(sheet, hem, &brim);
        if rim.is_empty() {
            return Err(ImportFault::NotACap("it has no opening"));
        }
        let regions = regions(sheet, hem, &brim, &rim);
        Ok(Self { regions, rim })
    }
}

/// Vertices of the crown at the brim and along its low boundary.
fn rim(sheet: &Sheet, hem: &Hem, brim: &BTreeSet<usize>) -> BTreeSet<u32> {
    let (_, high) = sheet.bounds();
    let top = hem.centre.z + HEM_HEIGHT * (high.z - hem.centre.z);
    let in_brim: BTreeSet<u32> = brim.iter().flat_map(|i| sheet.triangles[*i]).collect();
    let in_crown: BTreeSet<u32> = (0..sheet.triangles.len())
        .filter(|i| !brim.contains(i))
        .flat_map(|i| sheet.triangles[i])
        .collect();
    let edge_of_crown: BTreeSet<u32> = boundary(sheet)
        .into_iter()
        .flat_map(|(a, b)| [a, b])
        .filter(|v| sheet.vertices[*v as usize].z < top && !in_brim.contains(v))
        .collect();
    in_brim.intersection(&in_crown).chain(&edge_of_crown).copied().collect()
}

fn regions(sheet: &Sheet, hem: &Hem, brim: &BTreeSet<usize>, rim: &BTreeSet<u32>) -> Vec<Region> {
    let region = |i: usize| {
        let c = sheet.centre(i) - hem.centre;
        if brim.contains(&i) {
            Region::Brim
        } else if sheet.triangles[i].iter().any(|v| rim.contains(v)) {
            Region::Hem
        } else if c.y > 0.0 && c.x.abs() < FRONT_TANGENT * c.y {
            Region::Front
        } else {
            Region::Crown
        }
    };
    (0..sheet.triangles.len()).map(region).collect()
}

/// The largest connected set of triangles that stick out in front of the hem.
fn brim(sheet: &Sheet, hem: &Hem) -> Result<BTreeSet<usize>, ImportFault> {
    let (_, high) = sheet.bounds();
    let top = hem.centre.z + BRIM_HEIGHT * (high.z - hem.centre.z);
    let mut candidates: BTreeSet<usize> = (0..sheet.triangles.len())
        .filter(|i| {
            let (c, n) = (sheet.centre(*i), sheet.normal(*i));
            let flat = n.z.abs() > BRIM_FLATNESS * n.norm();
            let reach = hem.reach(&c);
            c.y > hem.centre.y && c.z < top && (reach > 1.0 && flat || reach > CLEARLY_OUTSIDE)
        })
        .collect();
    let edges = sheet.edges();
    let area = |part: &BTreeSet<usize>| part.iter().map(|i| sheet.normal(*i).norm()).sum::<f64>();
    let mut largest = BTreeSet::new();
    while let Some(start) = candidates.pop_first() {
        let mut part = BTreeSet::from([start]);
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            let neighbours = edges_of(&sheet.triangles[i]);
            for other in neighbours.iter().filter_map(|e| edges.get(e)).flatten() {
                if candidates.remove(other) {
                    part.insert(*other);
                    open.push(*other);
                }
            }
        }
        if area(&part) > area(&largest) {
            largest = part;
        }
    }
    let total: f64 = (0..sheet.triangles.len()).map(|i| sheet.normal(i).norm()).sum();
    if area(&largest) < SMALLEST_BRIM * total {
        return Err(ImportFault::NotACap("nothing in front of the hem looks like a brim"));
    }
    Ok(largest)
}
