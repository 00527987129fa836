//! Numbers and truths, a cell each.

use super::{Put, Reader, Take, malformed};
use crate::PluginError;

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
