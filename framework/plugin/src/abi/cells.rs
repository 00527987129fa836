//! Messages as rows of 8-byte cells: what is written, and read back with every count checked.

use crate::PluginError;
use nalgebra::{Point3, Quaternion, Translation3, UnitQuaternion, Vector3};
use seeone_core::{Pose, Similarity};

/// How far from one the length of a quaternion may be.
const UNIT_TOLERANCE: f64 = 1e-9;

/// Written to a message.
pub trait Put {
    /// Appends the cells of this.
    fn put(&self, to: &mut Vec<u64>);

    /// Appends the cells of several, without their count.
    fn put_all(all: &[Self], to: &mut Vec<u64>)
    where
        Self: Sized,
    {
        all.iter().for_each(|one| one.put(to));
    }
}

/// Read from a message.
pub trait Take: Sized {
    /// Reads one off the front.
    ///
    /// # Errors
    /// [`PluginError::Internal`] where the message ends too early or holds nonsense.
    fn take(from: &mut Reader) -> Result<Self, PluginError>;

    /// Reads several, without their count, which is no more than there are cells.
    ///
    /// # Errors
    /// As [`Take::take`].
    fn take_all(count: usize, from: &mut Reader) -> Result<Vec<Self>, PluginError> {
        let mut taken = Vec::with_capacity(count);
        for _ in 0..count {
            taken.push(Self::take(from)?);
        }
        Ok(taken)
    }
}

/// A message being read.
#[derive(Debug)]
pub struct Reader<'a>(&'a [u64]);

impl<'a> Reader<'a> {
    /// Reads a whole message as one `T`.
    ///
    /// # Errors
    /// As [`Take::take`], and for cells that are left over.
    pub fn whole<T: Take>(cells: &'a [u64]) -> Result<T, PluginError> {
        let mut reader = Self(cells);
        let taken = T::take(&mut reader)?;
        match reader.0.len() {
            0 => Ok(taken),
            left => Err(malformed(format!("{left} cells are left over at its end"))),
        }
    }

    /// The next `count` cells.
    fn cells(&mut self, count: usize) -> Result<&'a [u64], PluginError> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(|| {
            malformed(format!(
                "it ends where {count} more cells are due, {} are left",
                self.0.len()
            ))
        })?;
        self.0 = rest;
        Ok(taken)
    }

    /// How many elements follow, which have at least one cell each.
    fn count(&mut self) -> Result<usize, PluginError> {
        let count = u64::take(self)?;
        usize::try_from(count).ok().filter(|count| *count <= self.0.len()).ok_or_else(|| {
            malformed(format!("it counts {count} where {} cells are left", self.0.len()))
        })
    }

    /// A count of things that are packed several to a cell, with their cells.
    fn packed(&mut self, per_cell: usize) -> Result<(usize, &'a [u64]), PluginError> {
        let count = u64::take(self)?;
        let most = self.0.len().saturating_mul(per_cell);
        let count =
            usize::try_from(count).ok().filter(|count| *count <= most).ok_or_else(|| {
                malformed(format!("it counts {count} where {} cells are left", self.0.len()))
            })?;
        Ok((count, self.cells(count.div_ceil(per_cell))?))
    }
}

/// The message of `parts`, one after the other.
pub fn message(parts: &[&dyn Put]) -> Vec<u64> {
    let mut cells = Vec::new();
    parts.iter().for_each(|part| part.put(&mut cells));
    cells
}

/// A message that is not what it should be.
pub fn malformed(cause: String) -> PluginError {
    PluginError::Internal(format!("a message is malformed: {cause}"))
}

/// Fields of a structure, in their order.
macro_rules! fields {
    ($type:ty { $($field:ident),* $(,)? }) => {
        impl $crate::abi::cells::Put for $type {
            fn put(&self, to: &mut Vec<u64>) {
                $($crate::abi::cells::Put::put(&self.$field, to);)*
            }
        }

        impl $crate::abi::cells::Take for $type {
            fn take(from: &mut $crate::abi::cells::Reader) -> Result<Self, $crate::PluginError> {
                Ok(Self { $($field: $crate::abi::cells::Take::take(from)?),* })
            }
        }
    };
}
pub(super) use fields;

impl Put for () {
    fn put(&self, _: &mut Vec<u64>) {}
}

impl Take for () {
    fn take(_: &mut Reader) -> Result<Self, PluginError> {
        Ok(())
    }
}

impl Put for u64 {
    fn put(&self, to: &mut Vec<u64>) {
        to.push(*self);
    }
}

impl Take for u64 {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        Ok(from.cells(1)?[0])
    }
}

impl Put for usize {
    fn put(&self, to: &mut Vec<u64>) {
        to.push(*self as u64);
    }
}

impl Take for usize {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let number = u64::take(from)?;
        number.try_into().map_err(|_| malformed(format!("{number} is too large a number")))
    }
}

impl Put for u32 {
    fn put(&self, to: &mut Vec<u64>) {
        to.push(u64::from(*self));
    }
}

impl Take for u32 {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let number = u64::take(from)?;
        number.try_into().map_err(|_| malformed(format!("{number} is too large a number")))
    }
}

impl Put for bool {
    fn put(&self, to: &mut Vec<u64>) {
        to.push(u64::from(*self));
    }
}

impl Take for bool {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        match u64::take(from)? {
            0 => Ok(false),
            1 => Ok(true),
            other => Err(malformed(format!("{other} is neither 0 nor 1"))),
        }
    }
}

impl Put for f64 {
    fn put(&self, to: &mut Vec<u64>) {
        to.push(self.to_bits());
    }
}

impl Take for f64 {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        u64::take(from).map(f64::from_bits)
    }
}

impl<T: Put, const N: usize> Put for [T; N] {
    fn put(&self, to: &mut Vec<u64>) {
        T::put_all(self, to);
    }
}

impl<T: Take, const N: usize> Take for [T; N] {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let taken = (0..N).map(|_| T::take(from)).collect::<Result<Vec<T>, _>>()?;
        taken.try_into().map_err(|_| malformed(format!("{N} elements were due")))
    }
}

impl<T: Put> Put for [T] {
    fn put(&self, to: &mut Vec<u64>) {
        self.len().put(to);
        T::put_all(self, to);
    }
}

impl<T: Put> Put for &[T] {
    fn put(&self, to: &mut Vec<u64>) {
        (**self).put(to);
    }
}

impl<T: Put> Put for Vec<T> {
    fn put(&self, to: &mut Vec<u64>) {
        self.as_slice().put(to);
    }
}

impl<T: Take> Take for Vec<T> {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let count = from.count()?;
        T::take_all(count, from)
    }
}

/// Single-precision numbers, two a cell.
impl Put for Vec<f32> {
    fn put(&self, to: &mut Vec<u64>) {
        self.len().put(to);
        let half = |value: Option<&f32>| u64::from(value.map_or(0, |v| v.to_bits()));
        to.extend(self.chunks(2).map(|pair| half(pair.first()) | half(pair.get(1)) << 32));
    }
}

impl Take for Vec<f32> {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let (count, cells) = from.packed(2)?;
        let halves = cells.iter().flat_map(|cell| [*cell as u32, (*cell >> 32) as u32]);
        Ok(halves.take(count).map(f32::from_bits).collect())
    }
}

impl Put for str {
    fn put(&self, to: &mut Vec<u64>) {
        self.len().put(to);
        to.extend(self.as_bytes().chunks(8).map(|chunk| {
            let mut cell = [0; 8];
            cell[..chunk.len()].copy_from_slice(chunk);
            u64::from_ne_bytes(cell)
        }));
    }
}

impl Put for &str {
    fn put(&self, to: &mut Vec<u64>) {
        (**self).put(to);
    }
}

impl Put for String {
    fn put(&self, to: &mut Vec<u64>) {
        self.as_str().put(to);
    }
}

impl Take for String {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let (count, cells) = from.packed(8)?;
        let bytes = cells.iter().flat_map(|cell| cell.to_ne_bytes()).take(count).collect();
        String::from_utf8(bytes).map_err(|_| malformed("a text is not UTF-8".into()))
    }
}

impl<T: Put> Put for Option<T> {
    fn put(&self, to: &mut Vec<u64>) {
        self.is_some().put(to);
        self.iter().for_each(|some| some.put(to));
    }
}

impl<T: Take> Take for Option<T> {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        bool::take(from)?.then(|| T::take(from)).transpose()
    }
}

impl<A: Put, B: Put> Put for (A, B) {
    fn put(&self, to: &mut Vec<u64>) {
        self.0.put(to);
        self.1.put(to);
    }
}

impl<A: Take, B: Take> Take for (A, B) {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        Ok((A::take(from)?, B::take(from)?))
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    fn back<T: Put + Take + PartialEq + std::fmt::Debug>(value: T) {
        let cells = message(&[&value]);
        assert_eq!(Reader::whole::<T>(&cells).expect("whole"), value);
        for length in 0..cells.len() {
            assert!(Reader::whole::<T>(&cells[..length]).is_err(), "{length} of {value:?}");
        }
    }

    #[test]
    fn what_is_written_is_read_and_nothing_shorter() {
        back("".to_owned());
        back("exactly8".to_owned());
        back("größer als acht".to_owned());
        back(vec![1.5f32, -0.0, 3.25]);
        back(vec![Point3::new(1.0, 2.0, 3.0), Point3::new(-1e300, 0.0, 5e-324)]);
        back(vec![vec![1.0, 2.0], Vec::new()]);
        back((Some("x".to_owned()), None::<u64>));
        back(Pose::translation(1.0, 2.0, 3.0));
        back(Similarity::from_scaling(2.5));
        back([true, false]);
    }

    #[test]
    fn counts_are_not_believed() {
        let huge = [u64::MAX, 1, 2];
        assert!(Reader::whole::<Vec<f64>>(&huge).is_err());
        assert!(Reader::whole::<Vec<f32>>(&huge).is_err());
        assert!(Reader::whole::<String>(&huge).is_err());
        assert!(Reader::whole::<Vec<()>>(&huge).is_err());
        assert!(Reader::whole::<bool>(&[2]).is_err());
        assert!(Reader::whole::<u32>(&[1 << 40]).is_err());
        let told = Reader::whole::<u64>(&[1, 2]).expect_err("one too many").to_string();
        assert!(told.contains("1 cells are left over"), "{told}");
        let zeros = Reader::whole::<Pose>(&[0; 7]).expect_err("no rotation").to_string();
        assert!(zeros.contains("unit length"), "{zeros}");
    }

    #[test]
    fn a_rotation_keeps_its_bits() {
        let rotation = UnitQuaternion::from_euler_angles(0.1, 0.2, 0.3);
        let back: UnitQuaternion<f64> = Reader::whole(&message(&[&rotation])).expect("whole");
        assert_eq!(back.coords, rotation.coords);
    }
}
