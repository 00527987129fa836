//! What crosses: the layout of every record, fixed for one major version of the ABI. The
//! header for C, `include/seeone_plugin.h`, is made of this file and of `methods.rs`.

use super::message::Message;
use crate::{Kind, PluginError};
use std::ffi::c_void;

/// First eight bytes of every table: `SEEONE` and two zeros on a little-endian machine.
pub const MAGIC: u64 = 0x0000_454E_4F45_4553;

/// Must be equal on both sides: layouts, messages or meanings changed.
pub const ABI_MAJOR: u32 = 3;

/// May differ: functions were appended to the end of a table, whose `size` tells, or methods and
/// codes to those that there were.
pub const ABI_MINOR: u32 = 0;

/// The one symbol that a library exports, of type [`Entry`].
pub const ENTRY: &[u8] = b"seeone_plugin";

/// Returns the library's table of this index, from zero, which stays valid and unchanged for
/// good; null beyond the last.
pub type Entry = unsafe extern "C" fn(index: u32) -> *const Header;

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

    /// The slice of a span; none for a null, misaligned or impossibly long one with elements.
    ///
    /// # Safety
    /// The elements must be initialised, and stay so and unchanged for `'a`.
    pub unsafe fn slice<'a>(self) -> Option<&'a [T]> {
        if self.len == 0 {
            return Some(&[]);
        }
        let bytes = self.len.checked_mul(size_of::<T>())?;
        if self.data.is_null() || !self.data.is_aligned() || isize::try_from(bytes).is_err() {
            return None;
        }
        // SAFETY: neither null, misaligned nor too long; the rest is the caller's promise.
        Some(unsafe { std::slice::from_raw_parts(self.data, self.len) })
    }
}

/// How a call ended. Any other code than those named here counts as `INTERNAL`.
#[repr(transparent)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Status(pub i32);

impl Status {
    /// It worked.
    pub const OK: Self = Self(0);
    /// The plugin's table of the configuration is wrong.
    pub const CONFIGURATION: Self = Self(1);
    /// What was handed over cannot be worked on.
    pub const INPUT: Self = Self(2);
    /// A file that the plugin needs is missing or damaged.
    pub const RESOURCE: Self = Self(3);
    /// A fault inside the plugin, a caught panic among them.
    pub const INTERNAL: Self = Self(4);
    /// The caller asked for an end before the work was done, and there was one.
    pub const CANCELLED: Self = Self(5);

    /// The code and the text of an error.
    pub fn of(error: PluginError) -> (Self, String) {
        match error {
            PluginError::Configuration(text) => (Self::CONFIGURATION, text),
            PluginError::Input(text) => (Self::INPUT, text),
            PluginError::Resource(text) => (Self::RESOURCE, text),
            PluginError::Internal(text) => (Self::INTERNAL, text),
            PluginError::Cancelled => (Self::CANCELLED, error.to_string()),
        }
    }

    /// The error of this code and `text`, of which something is made where it is blank.
    ///
    /// # Errors
    /// Every code but [`Status::OK`].
    pub fn result(self, text: String) -> Result<(), PluginError> {
        let text = if text.trim().is_empty() {
            format!("it failed with status {} and said nothing", self.0)
        } else {
            text
        };
        match self {
            Self::OK => Ok(()),
            Self::CONFIGURATION => Err(PluginError::Configuration(text)),
            Self::INPUT => Err(PluginError::Input(text)),
            Self::RESOURCE => Err(PluginError::Resource(text)),
            Self::CANCELLED => Err(PluginError::Cancelled),
            _ => Err(PluginError::Internal(text)),
        }
    }
}

/// Where the called side leaves its answer: it calls `give` once, with cells that need to be
/// valid during that call alone.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Answer {
    /// Handed to `give` unchanged.
    pub target: *mut c_void,
    /// Takes a copy of the answer.
    pub give: Option<unsafe extern "C" fn(target: *mut c_void, cells: Span<u64>)>,
}

/// Answers one message: `method` of `methods.rs` with its request. What is lent may be called
/// until this call returns. May be null where nothing answers.
pub type Call = Option<
    unsafe extern "C" fn(
        object: *mut c_void,
        method: u64,
        request: Span<u64>,
        lent: Span<Service>,
        answer: *const Answer,
        message: *mut Message,
    ) -> Status,
>;

/// Something that answers messages, lent to the called side. It may be called from any thread.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Service {
    /// Handed to `call` unchanged.
    pub object: *mut c_void,
    /// Answers; null when nothing is lent.
    pub call: Call,
}

/// The beginning of every table, in every version.
#[repr(C)]
#[derive(Debug)]
pub struct Header {
    /// `MAGIC`.
    pub magic: u64,
    /// The ABI's major version that the library was built for.
    pub abi_major: u32,
    /// The ABI's minor version that the library was built for.
    pub abi_minor: u32,
    /// Bytes of the whole table, this header among them.
    pub size: u64,
    /// The plugin's kind, one of `KIND_...`.
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

/// The table of one plugin. No function may unwind; a null one is refused. The calls on
/// one instance, from `create` to `release`, come one after the other; with the host's usual
/// patience, which ends with a plugin that does not return, all from one thread.
#[repr(C)]
#[derive(Debug)]
pub struct Table {
    /// What every table begins with.
    pub header: Header,
    /// Builds a plugin from its setup and leaves it behind `instance`. The world may be called
    /// until the plugin is released.
    pub create: Option<
        unsafe extern "C" fn(
            setup: Span<u64>,
            world: Service,
            instance: *mut *mut c_void,
            message: *mut Message,
        ) -> Status,
    >,
    /// Answers one message; the object is the instance.
    pub call: Call,
    /// Ends a plugin; called once, after every other call on it.
    pub release: Option<unsafe extern "C" fn(instance: *mut c_void)>,
}

// SAFETY: a table is immutable, and its pointers lead to static text and functions.
unsafe impl Sync for Table {}
// SAFETY: as above.
unsafe impl Send for Table {}

/// `alignment`.
pub const KIND_ALIGNMENT: u32 = 1;
/// `camera`.
pub const KIND_CAMERA: u32 = 2;
/// `perception`.
pub const KIND_PERCEPTION: u32 = 3;
/// `encoding`.
pub const KIND_ENCODING: u32 = 4;
/// `transfer`.
pub const KIND_TRANSFER: u32 = 5;
/// `kinematics`.
pub const KIND_KINEMATICS: u32 = 6;
/// `motion`.
pub const KIND_MOTION: u32 = 7;
/// `robot`.
pub const KIND_ROBOT: u32 = 8;

/// The number of a kind.
pub const fn kind_code(kind: Kind) -> u32 {
    match kind {
        Kind::Alignment => KIND_ALIGNMENT,
        Kind::Camera => KIND_CAMERA,
        Kind::Perception => KIND_PERCEPTION,
        Kind::Encoding => KIND_ENCODING,
        Kind::Transfer => KIND_TRANSFER,
        Kind::Kinematics => KIND_KINEMATICS,
        Kind::Motion => KIND_MOTION,
        Kind::Robot => KIND_ROBOT,
    }
}

/// The kind of a number.
pub fn kind_of(code: u32) -> Option<Kind> {
    Kind::ALL.into_iter().find(|kind| kind_code(*kind) == code)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{offset_of, size_of};

    /// The layout of ABI 3 on 64-bit machines, in numbers: whoever changes one of them must
    /// raise [`ABI_MAJOR`].
    #[test]
    #[cfg(target_pointer_width = "64")]
    fn the_layout_is_the_golden_one() {
        assert_eq!(&MAGIC.to_le_bytes(), b"SEEONE\0\0");
        assert_eq!((ABI_MAJOR, kind_code(Kind::Alignment)), (3, 1));

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

        assert_eq!(offset_of!(Table, create), 80);
        assert_eq!(offset_of!(Table, call), 88);
        assert_eq!(offset_of!(Table, release), 96);
        assert_eq!(size_of::<Table>(), 104);

        assert_eq!(offset_of!(Answer, give), 8);
        assert_eq!(size_of::<Answer>(), 16);
        assert_eq!(offset_of!(Service, call), 8);
        assert_eq!(size_of::<Service>(), 16);

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
            assert_eq!(status.result(text), Err(error));
        }
        let told = Status(77).result(String::new()).expect_err("no status");
        assert!(told.to_string().contains("status 77 and said nothing"), "{told}");
    }

    #[test]
    fn every_kind_has_its_number() {
        for kind in Kind::ALL {
            assert_eq!(kind_of(kind_code(kind)), Some(kind));
        }
        assert_eq!(kind_of(99), None);
    }
}
