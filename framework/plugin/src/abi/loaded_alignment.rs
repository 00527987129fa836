//! An alignment behind a table.

use super::message::with_message;
use super::table::{AlignmentTable, OutcomeRecord, PairsRecord, SetupRecord, Span};
use crate::{Alignment, AlignmentOutcome, Correspondences, PluginError, Setup};
use nalgebra::{Point3, Quaternion, Translation3, UnitQuaternion};
use seeone_core::Similarity;
use std::ffi::c_void;

/// How far from one the length of an answered quaternion may be.
const UNIT_TOLERANCE: f64 = 1e-9;

/// An alignment served from a dynamic library.
#[derive(Debug)]
pub struct LoadedAlignment {
    table: &'static AlignmentTable,
    instance: *mut c_void,
}

// SAFETY: the ABI demands of `align` what `Alignment: Send + Sync` demands of a linked
// plugin; the instance is released once, by the owner.
unsafe impl Send for LoadedAlignment {}
// SAFETY: as above.
unsafe impl Sync for LoadedAlignment {}

impl LoadedAlignment {
    /// Builds the plugin of a table.
    pub(super) fn new(table: &'static AlignmentTable, setup: &Setup) -> Result<Self, PluginError> {
        let config = setup.config.to_string();
        let root = setup
            .root
            .to_str()
            .ok_or_else(|| PluginError::Configuration("the folder's path is not UTF-8".into()))?;
        let record = SetupRecord {
            config: Span::of(config.as_bytes()),
            root: Span::of(root.as_bytes()),
            seed: setup.seed,
        };
        let create = table.create.ok_or_else(incomplete)?;
        let mut instance = std::ptr::null_mut();
        // SAFETY: the records are valid for the call.
        let call = |message| unsafe { create(&record, &mut instance, message) };
        let (status, text) = with_message(call);
        status.result(|| text)?;
        if instance.is_null() {
            return Err(PluginError::Internal("the library built no plugin".into()));
        }
        Ok(Self { table, instance })
    }
}

impl Alignment for LoadedAlignment {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        let rows = |points: &[Point3<f64>]| points.iter().map(|p| p.coords.into()).collect();
        let (source, target): (Vec<[f64; 3]>, Vec<[f64; 3]>) =
            (rows(pairs.source), rows(pairs.target));
        let record = PairsRecord {
            source: Span::of(&source),
            target: Span::of(&target),
            weights: Span::of(pairs.weights),
            fixed_scale: pairs.fixed_scale.unwrap_or_default(),
            has_fixed_scale: pairs.fixed_scale.is_some().into(),
        };
        let align = self.table.align.ok_or_else(incomplete)?;
        let mut outcome = OutcomeRecord::default();
        // SAFETY: the instance lives, and the records are valid for the call.
        let call = |message| unsafe { align(self.instance, &record, &mut outcome, message) };
        let (status, text) = with_message(call);
        status.result(|| text)?;
        outcome.resolve()
    }
}

impl Drop for LoadedAlignment {
    fn drop(&mut self) {
        if let Some(release) = self.table.release {
            // SAFETY: created by this table, released once, after every call on it.
            unsafe { release(self.instance) };
        }
    }
}

fn incomplete() -> PluginError {
    PluginError::Internal("a function of the library's table is missing".into())
}

impl From<&AlignmentOutcome> for OutcomeRecord {
    fn from(outcome: &AlignmentOutcome) -> Self {
        let isometry = outcome.transform.isometry;
        Self {
            rotation_xyzw: isometry.rotation.coords.into(),
            translation: isometry.translation.vector.into(),
            scale: outcome.transform.scaling(),
            residual: outcome.residual,
            inlier_share: outcome.inlier_share,
            condition: outcome.condition,
        }
    }
}

impl OutcomeRecord {
    /// The outcome, to the bit, once it is known to be one.
    fn resolve(&self) -> Result<AlignmentOutcome, PluginError> {
        let quaternion = Quaternion::from(nalgebra::Vector4::from(self.rotation_xyzw));
        let share = 0.0..=1.0;
        let sound = (quaternion.norm() - 1.0).abs() < UNIT_TOLERANCE
            && self.translation.iter().all(|v| v.is_finite())
            && self.scale.is_finite()
            && self.scale > 0.0
            && self.residual.is_finite()
            && self.residual >= 0.0
            && share.contains(&self.inlier_share)
            && share.contains(&self.condition);
        if !sound {
            return Err(PluginError::Internal(format!("the library answered nonsense: {self:?}")));
        }
        let rotation = UnitQuaternion::new_unchecked(quaternion);
        let translation = Translation3::from(self.translation);
        Ok(AlignmentOutcome {
            transform: Similarity::from_parts(translation, rotation, self.scale),
            residual: self.residual,
            inlier_share: self.inlier_share,
            condition: self.condition,
        })
    }
}
