//! Points, rotations and poses.

use super::{Put, Reader, Take, malformed};
use crate::PluginError;
use nalgebra::{Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use seeone_core::{Pose, Similarity};

/// How far from one the length of a quaternion may be.
const UNIT_TOLERANCE: f64 = 1e-9;

impl Put for Point3<f64> {
    fn put(&self, to: &mut Vec<u64>) {
        to.extend([self.x, self.y, self.z].map(f64::to_bits));
    }

    /// In one go: most of what crosses is points.
    fn put_all(all: &[Self], to: &mut Vec<u64>) {
        // SAFETY: a point is its three numbers in a row (below), a number as large as a cell and
        // no more aligned, and any bits of it are a cell.
        to.extend_from_slice(unsafe {
            std::slice::from_raw_parts(all.as_ptr().cast(), 3 * all.len())
        });
    }
}

// What the copies above and below go by.
const _: () = assert!(size_of::<Point3<f64>>() == 3 * size_of::<u64>());
const _: () = assert!(align_of::<Point3<f64>>() == align_of::<u64>());

impl Take for Point3<f64> {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let cells = from.cells(3)?;
        let [x, y, z] = [cells[0], cells[1], cells[2]].map(f64::from_bits);
        Ok(Self::new(x, y, z))
    }

    fn take_all(count: usize, from: &mut Reader) -> Result<Vec<Self>, PluginError> {
        let cells = from.cells(count.saturating_mul(3))?;
        // SAFETY: three cells a point, as aligned as one, and any three cells are a point.
        Ok(unsafe { std::slice::from_raw_parts(cells.as_ptr().cast(), count) }.to_vec())
    }
}

impl Put for Vector3<f64> {
    fn put(&self, to: &mut Vec<u64>) {
        Point3::from(*self).put(to);
    }
}

impl Take for Vector3<f64> {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        Point3::take(from).map(|point| point.coords)
    }
}

impl Put for UnitQuaternion<f64> {
    fn put(&self, to: &mut Vec<u64>) {
        to.extend(<[f64; 4]>::from(self.coords).map(f64::to_bits));
    }
}

impl Take for UnitQuaternion<f64> {
    /// To the bit, so that nothing is normalised anew.
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let coords = <[f64; 4]>::take(from)?;
        let quaternion = Quaternion::from(nalgebra::Vector4::from(coords));
        if (quaternion.norm() - 1.0).abs() < UNIT_TOLERANCE {
            Ok(Self::new_unchecked(quaternion))
        } else {
            Err(malformed(format!("the quaternion {coords:?} is not of unit length")))
        }
    }
}

impl Put for Pose {
    fn put(&self, to: &mut Vec<u64>) {
        self.translation.vector.put(to);
        self.rotation.put(to);
    }
}

impl Take for Pose {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let translation = Translation3::from(Vector3::take(from)?);
        Ok(Self::from_parts(translation, UnitQuaternion::take(from)?))
    }
}

impl Put for Similarity {
    fn put(&self, to: &mut Vec<u64>) {
        self.isometry.put(to);
        self.scaling().put(to);
    }
}

impl Take for Similarity {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let (pose, scale) = <(Pose, f64)>::take(from)?;
        if scale.is_finite() && scale > 0.0 {
            Ok(Self::from_isometry(pose, scale))
        } else {
            Err(malformed(format!("the scale {scale} is not a positive number")))
        }
    }
}
