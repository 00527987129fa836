//! The library's side: a Rust plugin behind a table.

use super::message::Message;
use super::table::{
    ABI_MAJOR, ABI_MINOR, AlignmentTable, Header, MAGIC, OutcomeRecord, PairsRecord, SetupRecord,
    Span, Status, kind_code,
};
use crate::{Alignment, Correspondences, Kind, PluginError, Setup};
use nalgebra::Point3;
use std::any::Any;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Makes a dynamic library (`crate-type = ["cdylib"]`) of an alignment:
/// `export_alignment!("name", constructor)`, where the constructor is a
/// `fn(&Setup) -> Result<impl Alignment, PluginError>`. Once a library.
#[macro_export]
macro_rules! export_alignment {
    ($name:literal, $construct:path) => {
        struct Exported;

        impl $crate::abi::export::ExportedAlignment for Exported {
            const NAME: &'static str = $name;
            const VERSION: &'static str = env!("CARGO_PKG_VERSION");

            fn construct(
                setup: &$crate::Setup,
            ) -> Result<Box<dyn $crate::Alignment>, $crate::PluginError> {
                Ok(Box::new($construct(setup)?))
            }
        }

        /// Returns the library's table.
        #[unsafe(no_mangle)]
        pub extern "C" fn seeone_plugin() -> *const $crate::abi::table::Header {
            static TABLE: $crate::abi::table::AlignmentTable =
                $crate::abi::export::alignment_table::<Exported>();
            $crate::abi::export::silence_panics();
            &raw const TABLE.header
        }
    };
}

/// What [`export_alignment!`](crate::export_alignment) makes a table of.
pub trait ExportedAlignment: 'static {
    /// The plugin's name.
    const NAME: &'static str;
    /// The plugin's version.
    const VERSION: &'static str;

    /// Builds the plugin.
    ///
    /// # Errors
    /// What the plugin's own constructor refuses.
    fn construct(setup: &Setup) -> Result<Box<dyn Alignment>, PluginError>;
}

/// The table of `E`.
pub const fn alignment_table<E: ExportedAlignment>() -> AlignmentTable {
    let Some(kind) = kind_code(Kind::Alignment) else { panic!("alignments have a code") };
    AlignmentTable {
        header: Header {
            magic: MAGIC,
            abi_major: ABI_MAJOR,
            abi_minor: ABI_MINOR,
            size: size_of::<AlignmentTable>() as u64,
            kind,
            reserved: 0,
            name: Span::of(E::NAME.as_bytes()),
            version: Span::of(E::VERSION.as_bytes()),
            build_id: Span::of(concat!("seeone-plugin ", env!("CARGO_PKG_VERSION")).as_bytes()),
        },
        create: Some(create::<E>),
        align: Some(align),
        release: Some(release),
    }
}

/// A panic reaches the host as an error's text; the library's own copy of the standard
/// library shall not print it beside that, where the host's hook has no say.
pub fn silence_panics() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| std::panic::set_hook(Box::new(|_| {})));
}

/// The plugin behind an instance pointer; boxed twice to make the pointer thin.
type Instance = Box<dyn Alignment>;

unsafe extern "C" fn create<E: ExportedAlignment>(
    setup: *const SetupRecord,
    instance: *mut *mut c_void,
    message: *mut Message,
) -> Status {
    guarded(message, || {
        // SAFETY: the host lends a valid record for the call.
        let setup = unsafe { setup.as_ref() }.ok_or_else(missing)?;
        // SAFETY: as above, and its spans with it.
        let (config, root) = unsafe { (text(setup.config)?, text(setup.root)?) };
        let config = config
            .parse::<toml::Table>()
            .map_err(|e| PluginError::Configuration(e.message().to_owned()))?;
        let setup = Setup {
            config: &config,
            root: Path::new(root),
            seed: setup.seed,
            world: None,
            robot: None,
        };
        if instance.is_null() {
            return Err(missing());
        }
        let plugin: Box<Instance> = Box::new(E::construct(&setup)?);
        // SAFETY: the host lends a place for one pointer; it is not null.
        unsafe { instance.write(Box::into_raw(plugin).cast()) };
        Ok(())
    })
}

unsafe extern "C" fn align(
    instance: *const c_void,
    pairs: *const PairsRecord,
    outcome: *mut OutcomeRecord,
    message: *mut Message,
) -> Status {
    guarded(message, || {
        // SAFETY: made by `create`, not yet released, and shared only (`Alignment: Sync`).
        let plugin = unsafe { instance.cast::<Instance>().as_ref() }.ok_or_else(missing)?;
        // SAFETY: the host lends a valid record for the call.
        let pairs = unsafe { pairs.as_ref() }.ok_or_else(missing)?;
        // SAFETY: as above, and its spans with it.
        let (source, target, weights) =
            unsafe { (pairs.source.slice(), pairs.target.slice(), pairs.weights.slice()) };
        let points = |rows: Option<&[[f64; 3]]>| -> Result<Vec<Point3<f64>>, PluginError> {
            Ok(rows.ok_or_else(missing)?.iter().map(|p| Point3::from(*p)).collect())
        };
        let found = plugin.align(&Correspondences {
            source: &points(source)?,
            target: &points(target)?,
            weights: weights.ok_or_else(missing)?,
            fixed_scale: (pairs.has_fixed_scale != 0).then_some(pairs.fixed_scale),
        })?;
        if outcome.is_null() {
            return Err(missing());
        }
        // SAFETY: the host lends a place for one outcome; it is not null.
        unsafe { outcome.write(OutcomeRecord::from(&found)) };
        Ok(())
    })
}

unsafe extern "C" fn release(instance: *mut c_void) {
    if instance.is_null() {
        return;
    }
    let dropped = catch_unwind(|| {
        // SAFETY: made by `create` from such a box, and released once.
        drop(unsafe { Box::from_raw(instance.cast::<Instance>()) });
    });
    // A plugin that panics while it ends has nobody left to tell.
    let _ = dropped;
}

fn missing() -> PluginError {
    PluginError::Internal("the host passed no record where one is due".into())
}

/// The text of a span.
///
/// # Safety
/// As [`Span::slice`].
unsafe fn text<'a>(span: Span<u8>) -> Result<&'a str, PluginError> {
    // SAFETY: the caller's promise.
    let bytes = unsafe { span.slice() }.ok_or_else(missing)?;
    std::str::from_utf8(bytes).map_err(|_| PluginError::Input("a text is not UTF-8".into()))
}

/// Runs `work` so that neither an error nor a panic leaves it but as a status and a text.
fn guarded(message: *mut Message, work: impl FnOnce() -> Result<(), PluginError>) -> Status {
    let ended = catch_unwind(AssertUnwindSafe(work));
    let result = ended.unwrap_or_else(|panic| Err(PluginError::Internal(told(&*panic))));
    let Err(error) = result else { return Status::OK };
    let (status, text) = Status::of(error);
    // SAFETY: the host lends null or a valid message.
    if let Some(message) = unsafe { message.as_mut() } {
        // SAFETY: with a buffer of the capacity that it names.
        unsafe { message.write(&text) };
    }
    status
}

/// What a panic said.
fn told(panic: &(dyn Any + Send)) -> String {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("the plugin panicked: {}", text.unwrap_or("without a text"))
}
