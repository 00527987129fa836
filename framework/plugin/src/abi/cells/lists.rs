//! Lists, texts, what may be missing, and pairs.

use super::{Put, Reader, Take, malformed};
use crate::PluginError;

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
