//! The library's side: Rust plugins behind tables.

use super::callee::{Foreign, guarded, lend, missing, serve};
use super::cells::Reader;
use super::kinds::{Remote, SetupMessage, served};
use super::message::Message;
use super::methods::Method;
use super::table::{
    ABI_MAJOR, ABI_MINOR, Answer, Header, MAGIC, Service, Span, Status, Table, kind_code,
};
use crate::{
    Alignment, Camera, Encoding, Kind, Kinematics, Motion, Perception, PluginError, Robot, Setup,
    Transfer, World,
};
use seeone_core::robot::RobotModel;
use std::ffi::c_void;
use std::panic::catch_unwind;
use std::path::Path;
use std::sync::Arc;

/// Makes a dynamic library (`crate-type = ["cdylib"]`) of plugins, once a library:
///
/// ```ignore
/// seeone_plugin::export_plugins! {
///     Transfer "snap" => my_crate::Snap::from_setup,
///     Transfer "unchanged" => my_crate::Unchanged::from_setup,
/// }
/// ```
///
/// Each constructor is a `fn(&Setup) -> Result<impl KIND, PluginError>`.
#[macro_export]
macro_rules! export_plugins {
    ($($kind:ident $name:literal => $construct:path),+ $(,)?) => {
        /// Returns the library's table of this index; null beyond the last.
        #[unsafe(no_mangle)]
        pub extern "C" fn seeone_plugin(index: u32) -> *const $crate::abi::table::Header {
            static TABLES: &[$crate::abi::table::Table] = &[$({
                struct Exported;

                impl $crate::abi::export::Exported for Exported {
                    const KIND: $crate::Kind = $crate::Kind::$kind;
                    const NAME: &'static str = $name;
                    const VERSION: &'static str = env!("CARGO_PKG_VERSION");

                    fn construct(
                        setup: &$crate::Setup,
                    ) -> Result<$crate::abi::export::Plugin, $crate::PluginError> {
                        let plugin = Box::new($construct(setup)?);
                        Ok($crate::abi::export::Plugin::$kind(plugin))
                    }
                }

                $crate::abi::export::table::<Exported>()
            }),+];
            $crate::abi::export::silence_panics();
            TABLES.get(index as usize).map_or(std::ptr::null(), |table| &raw const table.header)
        }
    };
}

/// A plugin of any kind.
pub enum Plugin {
    /// Kind `alignment`.
    Alignment(Box<dyn Alignment>),
    /// Kind `camera`.
    Camera(Box<dyn Camera>),
    /// Kind `perception`.
    Perception(Box<dyn Perception>),
    /// Kind `encoding`.
    Encoding(Box<dyn Encoding>),
    /// Kind `transfer`.
    Transfer(Box<dyn Transfer>),
    /// Kind `kinematics`.
    Kinematics(Box<dyn Kinematics>),
    /// Kind `motion`.
    Motion(Box<dyn Motion>),
    /// Kind `robot`.
    Robot(Box<dyn Robot>),
}

/// What [`export_plugins!`](crate::export_plugins) makes a table of.
pub trait Exported: 'static {
    /// The plugin's kind.
    const KIND: Kind;
    /// The plugin's name.
    const NAME: &'static str;
    /// The plugin's version.
    const VERSION: &'static str;

    /// Builds the plugin, of this kind.
    ///
    /// # Errors
    /// What the plugin's own constructor refuses.
    fn construct(setup: &Setup) -> Result<Plugin, PluginError>;
}

/// The table of `E`.
pub const fn table<E: Exported>() -> Table {
    Table {
        header: Header {
            magic: MAGIC,
            abi_major: ABI_MAJOR,
            abi_minor: ABI_MINOR,
            size: size_of::<Table>() as u64,
            kind: kind_code(E::KIND),
            reserved: 0,
            name: Span::of(E::NAME.as_bytes()),
            version: Span::of(E::VERSION.as_bytes()),
            build_id: Span::of(concat!("seeone-plugin ", env!("CARGO_PKG_VERSION")).as_bytes()),
        },
        create: Some(create::<E>),
        call: Some(call),
        release: Some(release),
    }
}

/// A panic reaches the host as an error's text; the library's own copy of the standard
/// library shall not print it beside that, where the host's hook has no say.
pub fn silence_panics() {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| std::panic::set_hook(Box::new(|_| {})));
}

/// A plugin behind an instance pointer.
struct Instance {
    plugin: Living,
    /// The robot of its setup.
    robot: Option<Arc<RobotModel>>,
}

/// A plugin with what it has made.
enum Living {
    Encoding(served::Encoding),
    Other(Plugin),
}

impl Instance {
    fn answer(
        &mut self,
        method: Method,
        request: &[u64],
        lent: &[Foreign],
    ) -> Result<Vec<u64>, PluginError> {
        let robot = self.robot.as_ref();
        let plugin = match &mut self.plugin {
            Living::Encoding(fields) => return fields.served(method, request),
            Living::Other(plugin) => plugin,
        };
        match plugin {
            Plugin::Alignment(plugin) => served::alignment(plugin.as_ref(), method, request),
            Plugin::Camera(plugin) => served::camera(plugin.as_mut(), method, request),
            Plugin::Perception(plugin) => served::perception(plugin.as_mut(), method, request),
            Plugin::Encoding(_) => Err(missing()),
            Plugin::Transfer(plugin) => served::transfer(plugin.as_ref(), method, request, lent),
            Plugin::Kinematics(plugin) => {
                served::kinematics(plugin.as_ref(), robot, method, request, &lend(lent))
            }
            Plugin::Motion(plugin) => served::motion(plugin.as_ref(), robot, method, request, lent),
            Plugin::Robot(plugin) => served::robot(plugin.as_mut(), method, request, lent),
        }
    }
}

unsafe extern "C" fn create<E: Exported>(
    setup: Span<u64>,
    world: Service,
    instance: *mut *mut c_void,
    message: *mut Message,
) -> Status {
    guarded(message, || {
        // SAFETY: the host lends valid cells for the call.
        let setup = unsafe { setup.slice() }.ok_or_else(missing)?;
        let SetupMessage { config, root, seed, robot } = Reader::whole(setup)?;
        let config = config
            .parse::<toml::Table>()
            .map_err(|e| PluginError::Configuration(e.message().to_owned()))?;
        // SAFETY: the host lends the world until the plugin is released; a plugin drops what it
        // was built from by then.
        let world = unsafe { Foreign::new(world) }
            .map(|world| Arc::new(Remote::new(world, None)) as Arc<dyn World>);
        let robot = robot.map(Arc::new);
        if instance.is_null() {
            return Err(missing());
        }
        let plugin = E::construct(&Setup {
            config: &config,
            root: Path::new(&root),
            seed,
            robot: robot.as_deref(),
            world,
        })?;
        let plugin = match plugin {
            Plugin::Encoding(encoding) => Living::Encoding(served::Encoding::new(encoding)),
            other => Living::Other(other),
        };
        let built = Box::new(Instance { plugin, robot });
        // SAFETY: the host lends a place for one pointer; it is not null.
        unsafe { instance.write(Box::into_raw(built).cast()) };
        Ok(())
    })
}

unsafe extern "C" fn call(
    instance: *mut c_void,
    method: u64,
    request: Span<u64>,
    lent: Span<Service>,
    answer: *const Answer,
    message: *mut Message,
) -> Status {
    // SAFETY: made by `create`, not yet released, and used by one call at a time.
    let Some(instance) = (unsafe { instance.cast::<Instance>().as_mut() }) else {
        return Status::INTERNAL;
    };
    // SAFETY: the host's records are valid for the call.
    unsafe {
        serve(method, request, lent, answer, message, |method, request, lent| {
            instance.answer(method, request, lent)
        })
    }
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
