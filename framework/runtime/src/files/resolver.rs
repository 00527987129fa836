//! From what a file says to what it means: checks values and gathers every fault, so that
//! a user mends a file in one go.

use super::codes::Fault;
use super::exactly::Exactly;
use super::pose::RawPose;
use super::source::Source;
use super::spanned::Spanned;
use nalgebra::Vector3;
use seeone_core::pose::PoseFields;
use seeone_core::{Diagnostic, Pose};
use std::ops::{Range, RangeInclusive};
use std::path::{Component, Path, PathBuf};

/// The longest name.
const LONGEST_NAME: usize = 64;
/// The farthest coordinate of a pose, metres: no robot's room is larger.
const FARTHEST_M: f64 = 10.0;

/// Whether a skill, a robot or anything else that a file names may be called so: at most 64 small
/// letters, digits and hyphens, a letter first.
pub fn is_name(name: &str) -> bool {
    name.len() <= LONGEST_NAME
        && name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
}

/// Checks values of one file. A check that fails leaves its fault here and gives back a
/// stand-in, which nobody sees: [`Resolver::finish`] then gives the faults instead.
pub(super) struct Resolver<'a> {
    pub(super) source: &'a Source,
    faults: Vec<Diagnostic>,
}

impl<'a> Resolver<'a> {
    pub(super) fn new(source: &'a Source) -> Self {
        Self { source, faults: Vec::new() }
    }

    /// The value, or the faults if there were any.
    pub(super) fn finish<T>(self, value: T) -> Result<T, Vec<Diagnostic>> {
        if self.faults.is_empty() { Ok(value) } else { Err(self.faults) }
    }

    /// Notes a fault.
    pub(super) fn fault(&mut self, fault: Fault, at: Range<usize>, cause: impl Into<String>) {
        let fault = self.source.fault(fault, at, cause);
        self.note(fault);
    }

    /// Notes a fault that is already told.
    pub(super) fn note(&mut self, fault: Diagnostic) {
        self.faults.push(fault);
    }

    /// A number within a range.
    pub(super) fn number(
        &mut self,
        key: &str,
        value: &Spanned<f64>,
        range: RangeInclusive<f64>,
    ) -> f64 {
        if !range.contains(value.get_ref()) {
            let (low, high) = range.into_inner();
            let cause = format!("{key} = {}, but it must lie in {low} to {high}", value.get_ref());
            self.fault(Fault::Range, value.span(), cause);
        }
        *value.get_ref()
    }

    /// A number within a range, or what is meant when it is not said.
    pub(super) fn number_or(
        &mut self,
        key: &str,
        value: Option<&Spanned<f64>>,
        default: f64,
        range: RangeInclusive<f64>,
    ) -> f64 {
        value.map_or(default, |value| self.number(key, value, range))
    }

    /// Numbers each within a range.
    pub(super) fn numbers<const N: usize>(
        &mut self,
        key: &str,
        value: &Spanned<Exactly<f64, N>>,
        range: RangeInclusive<f64>,
    ) -> [f64; N] {
        let Exactly(numbers) = value.get_ref();
        // The first that lies outside says it for all.
        if let Some(number) = numbers.iter().find(|number| !range.contains(number)) {
            self.number(key, &Spanned::new(value.span(), *number), range);
        }
        *numbers
    }

    /// Three lengths or coordinates, each within a range.
    pub(super) fn vector(
        &mut self,
        key: &str,
        value: &Spanned<Exactly<f64, 3>>,
        range: RangeInclusive<f64>,
    ) -> Vector3<f64> {
        self.numbers(key, value, range).into()
    }

    /// A pose: in the room, and its quaternion of unit length.
    pub(super) fn pose(&mut self, key: &str, value: &Spanned<RawPose>) -> Pose {
        let fields = PoseFields::from(value.get_ref());
        if let Some(far) = fields.xyz_m.iter().find(|v| v.abs() > FARTHEST_M) {
            let cause = format!(
                "{key}: a coordinate of {far}, but it must lie in -{FARTHEST_M} to {FARTHEST_M}"
            );
            self.fault(Fault::Range, value.span(), cause);
        }
        fields.resolve().unwrap_or_else(|cause| {
            self.fault(Fault::Pose, value.span(), format!("{key}: {cause}"));
            Pose::identity()
        })
    }

    /// A name: small letters, digits and hyphens, beginning with a letter.
    pub(super) fn name(&mut self, key: &str, value: &Spanned<String>) -> String {
        let name = value.get_ref();
        if !is_name(name) {
            let cause = format!(
                "{key} = {name:?}, but a name is made of at most {LONGEST_NAME} small letters, \
                 digits and hyphens and begins with a letter"
            );
            self.fault(Fault::Name, value.span(), cause);
        }
        name.clone()
    }

    /// The name of a place in the scene: none that means another thing.
    pub(super) fn place_name(&mut self, key: &str, value: &Spanned<String>) -> String {
        if ["object", "head", "hook"].contains(&value.get_ref().as_str()) {
            let cause = format!("{:?} is no name for a place: it means another", value.get_ref());
            self.fault(Fault::Name, value.span(), cause);
        }
        self.name(key, value)
    }

    /// A file below the folder of this one: the path from here.
    pub(super) fn file(&mut self, key: &str, value: &Spanned<String>) -> PathBuf {
        let relative = Path::new(value.get_ref());
        let inside = !value.get_ref().is_empty()
            && relative.components().all(|part| matches!(part, Component::Normal(_)));
        let path = self.source.folder().join(relative);
        if !inside {
            let cause =
                format!("{key} = {:?} does not lie in the file's own folder", value.get_ref());
            self.fault(Fault::Reference, value.span(), cause);
        } else if !path.is_file() {
            let cause = format!("{key}: there is no file {}", path.display());
            self.fault(Fault::Reference, value.span(), cause);
        }
        path
    }
}
