//! What crosses: the layout of every record, fixed for one major version of the ABI.

use super::message::Message;
use crate::{Kind, PluginError};
use std::ffi::c_void;

/// First eight bytes of every table, `SEEONE` and two zeros in memory order.
pub const MAGIC: u64 = u64::from_ne_bytes(*b"SEEONE\0\0");

/// Must be equal on both sides: layouts or meanings changed.
pub const ABI_MAJOR: u32 = 1;

/// May differ: functions were appended to the end of a table, whose `size` tells.
pub const ABI_MINOR: u32 = 0;

/// The one symbol that a library exports, of type [`Entry`].
pub const ENTRY: &[u8] = b"seeone_plugin";

/// Returns the library's table, which stays valid and unchanged for good.
pub type Entry = unsafe extern "C" fn() -> *const Header;

/// Borrowed elements in a row; `data` may be anything when `len` is zero.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Span<T> {
    /// The first element.
    pub data: *const T,
    /// Number of elements.
    pub len: usize,
}

impl<T> Span<T> {
    /// The span of a slice.
    pub const fn of(slice: &[T]) -> Self {
        Self { data: slice.as_ptr(), len: slice.len() }
    }

    /// The slice of a span; none for a null or misaligned one with elements.
    ///
    /// # Safety
    /// The elements must be initialised, and stay so and unchanged for `'a`.
    pub unsafe fn slice<'a>(self) -> Option<&'a [T]> {
        if self.len == 0 {
            return Some(&[]);
        }
        if self.data.is_null() || !self.data.is_aligned() {
            return None;
        }
        // SAFETY: neither null nor misaligned; the rest is the caller's promise.
        Some(unsafe { std::slice::from_raw_parts(self.data, self.len) })
    }
}

/// How a call ended. Any other code than those named here counts as [`Status::INTERNAL`].
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub i32);

impl Status {
    /// It worked.
    pub const OK: Self = Self(0);
    /// [`PluginError::Configuration`].
    pub const CONFIGURATION: Self = Self(1);
    /// [`PluginError::Input`].
    pub const INPUT: Self = Self(2);
    /// [`PluginError::Resource`].
    pub const RESOURCE: Self = Self(3);
    /// [`PluginError::Internal`], a caught panic among them.
    pub const INTERNAL: Self = Self(4);

    /// The code and the text of an error.
    pub fn of(error: PluginError) -> (Self, String) {
        match error {
            PluginError::Configuration(text) => (Self::CONFIGURATION, text),
            PluginError::Input(text) => (Self::INPUT, text),
            PluginError::Resource(text) => (Self::RESOURCE, text),
            PluginError::Internal(text) => (Self::INTERNAL, text),
        }
    }

    /// The error of this code.
    ///
    /// # Errors
    /// Every code but [`Status::OK`].
    pub fn result(self, text: impl FnOnce() -> String) -> Result<(), PluginError> {
        match self {
            Self::OK => Ok(()),
            Self::CONFIGURATION => Err(PluginError::Configuration(text())),
            Self::INPUT => Err(PluginError::Input(text())),
            Self::RESOURCE => Err(PluginError::Resource(text())),
            _ => Err(PluginError::Internal(text())),
        }
    }
}

/// The beginning of every table, the same for every kind.
#[repr(C)]
#[derive(Debug)]
pub struct Header {
    /// [`MAGIC`].
    pub magic: u64,
    /// [`ABI_MAJOR`] of the library.
    pub abi_major: u32,
    /// [`ABI_MINOR`] of the library.
    pub abi_minor: u32,
    /// Bytes of the whole table, this header among them.
    pub size: u64,
    /// [`kind_code`] of the plugin.
    pub kind: u32,
    /// Zero.
    pub reserved: u32,
    /// The plugin's name, UTF-8.
    pub name: Span<u8>,
    /// The plugin's version, UTF-8.
    pub version: Span<u8>,
    /// What the library was built with, UTF-8; for people.
    pub build_id: Span<u8>,
}

/// The number of a kind; none for kinds that are served linked only.
pub const fn kind_code(kind: Kind) -> Option<u32> {
    match kind {
        Kind::Alignment => Some(1),
        _ => None,
    }
}

/// What a plugin is built from: [`crate::Setup`] without the robot and the simulated world.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SetupRecord {
    /// The plugin's own table as TOML, UTF-8.
    pub config: Span<u8>,
    /// The folder against which it resolves paths, UTF-8.
    pub root: Span<u8>,
    /// The seed of the run.
    pub seed: u64,
}

/// [`crate::Correspondences`].
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct PairsRecord {
    /// Where the points are: x, y, z.
    pub source: Span<[f64; 3]>,
    /// Where they shall go: x, y, z.
    pub target: Span<[f64; 3]>,
    /// Weight of each pair.
    pub weights: Span<f64>,
    /// The scale to keep, when `has_fixed_scale` is not zero.
    pub fixed_scale: f64,
    /// Whether the scale is fixed.
    pub has_fixed_scale: u64,
}

/// [`crate::AlignmentOutcome`].
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutcomeRecord {
    /// Rotation of the transform, scalar last, of unit length.
    pub rotation_xyzw: [f64; 4],
    /// Shift of the transform.
    pub translation: [f64; 3],
    /// Scale of the transform.
    pub scale: f64,
    /// Root mean square residual of the inliers.
    pub residual: f64,
    /// Share of the weight that was kept.
    pub inlier_share: f64,
    /// How well the rotation is determined.
    pub condition: f64,
}

/// The table of kind `alignment`. No function may unwind; a null one is refused.
#[repr(C)]
#[derive(Debug)]
pub struct AlignmentTable {
    /// What every table begins with.
    pub header: Header,
    /// Builds a plugin and leaves it behind the second argument.
    pub create:
        Option<unsafe extern "C" fn(*const SetupRecord, *mut *mut c_void, *mut Message) -> Status>,
    /// Aligns; may be called from several threads at once on one plugin.
    pub align: Option<
        unsafe extern "C" fn(
            *const c_void,
            *const PairsRecord,
            *mut OutcomeRecord,
            *mut Message,
        ) -> Status,
    >,
    /// Ends a plugin; called once, after every other call on it.
    pub release: Option<unsafe extern "C" fn(*mut c_void)>,
}

// SAFETY: a table is immutable, and its pointers lead to static text and functions.
unsafe impl Sync for AlignmentTable {}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    /// The layout of ABI 1.0 on 64-bit machines, in numbers: whoever changes one of them
    /// must raise [`ABI_MAJOR`].
    #[test]
    #[cfg(target_pointer_width = "64")]
    fn the_layout_is_the_golden_one() {
        assert_eq!(&MAGIC.to_ne_bytes(), b"SEEONE\0\0");
        assert_eq!((ABI_MAJOR, kind_code(Kind::Alignment)), (1, Some(1)));

        assert_eq!(offset_of!(Span<u8>, data), 0);
        assert_eq!(offset_of!(Span<u8>, len), 8);

        assert_eq!(offset_of!(Header, magic), 0);
        assert_eq!(offset_of!(Header, abi_major), 8);
        assert_eq!(offset_of!(Header, abi_minor), 12);
        assert_eq!(offset_of!(Header, size), 16);
        assert_eq!(offset_of!(Header, kind), 24);
        assert_eq!(offset_of!(Header, name), 32);
        assert_eq!(offset_of!(Header, version), 48);
        assert_eq!(offset_of!(Header, build_id), 64);
        assert_eq!(size_of::<Header>(), 80);

        assert_eq!(offset_of!(AlignmentTable, create), 80);
        assert_eq!(offset_of!(AlignmentTable, align), 88);
        assert_eq!(offset_of!(AlignmentTable, release), 96);
        assert_eq!(size_of::<AlignmentTable>(), 104);

        assert_eq!(offset_of!(SetupRecord, root), 16);
        assert_eq!(offset_of!(SetupRecord, seed), 32);
        assert_eq!(size_of::<SetupRecord>(), 40);

        assert_eq!(offset_of!(PairsRecord, target), 16);
        assert_eq!(offset_of!(PairsRecord, weights), 32);
        assert_eq!(offset_of!(PairsRecord, fixed_scale), 48);
        assert_eq!(offset_of!(PairsRecord, has_fixed_scale), 56);
        assert_eq!(size_of::<PairsRecord>(), 64);

        assert_eq!(offset_of!(OutcomeRecord, translation), 32);
        assert_eq!(offset_of!(OutcomeRecord, scale), 56);
        assert_eq!(offset_of!(OutcomeRecord, residual), 64);
        assert_eq!(offset_of!(OutcomeRecord, inlier_share), 72);
        assert_eq!(offset_of!(OutcomeRecord, condition), 80);
        assert_eq!(size_of::<OutcomeRecord>(), 88);

        assert_eq!(offset_of!(Message, capacity), 8);
        assert_eq!(offset_of!(Message, length), 16);
        assert_eq!(size_of::<Message>(), 24);
    }

    #[test]
    fn every_error_survives_the_crossing() {
        for error in [
            PluginError::Configuration("a".into()),
            PluginError::Input("b".into()),
            PluginError::Resource("c".into()),
            PluginError::Internal("d".into()),
        ] {
            let (status, text) = Status::of(error.clone());
            assert_eq!(status.result(|| text), Err(error));
        }
        assert!(matches!(Status(77).result(String::new), Err(PluginError::Internal(_))));
    }
}
