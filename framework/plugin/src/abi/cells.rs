//! Messages as rows of 8-byte cells: what is written, and read back with every count checked.

mod geometry;
mod lists;
mod numbers;

use crate::PluginError;

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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point3, UnitQuaternion};
    use seeone_core::{Pose, Similarity};

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
