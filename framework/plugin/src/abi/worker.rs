//! The thread on which one loaded plugin lives.
//!
//! A call that does not return cannot be ended from outside. So a loaded plugin is called on a
//! thread of its own, for which the host waits no longer than its patience; then the plugin and
//! its thread are left alone for good. Nothing that crosses to the thread is borrowed: requests
//! are moved, and what is lent is called through a channel, on the host's own thread, which is
//! closed when the host has gone on.

use super::callee::{Callee, Lasting, ask, lend};
use super::instance::{Named, create};
use super::methods::Method;
use super::table::Table;
use crate::PluginError;
use std::ffi::c_void;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// As much stack as a program's first thread has.
const STACK_BYTES: usize = 8 << 20;

/// How often either side looks whether the other has something for it before it goes to sleep: some
/// 20 us, for waking a thread takes longer than most calls do.
const LOOKS: u32 = 1_000;

/// What comes so soon that it is not worth going to sleep for.
fn soon<T>(from: &Receiver<T>) -> Option<T> {
    (0..LOOKS).find_map(|_| {
        std::hint::spin_loop();
        from.try_recv().ok()
    })
}

/// A loaded plugin, called on its own thread.
#[derive(Debug)]
pub(super) struct Worker {
    named: Named,
    patience: Duration,
    jobs: Mutex<Option<Sender<Job>>>,
    ended: Mutex<Receiver<()>>,
    lost: Arc<AtomicBool>,
}

/// The world of a plugin, for as long as it is not left alone: one that was only slow moves
/// nothing after the host has gone on.
struct Revocable {
    world: Box<dyn Callee>,
    lost: Arc<AtomicBool>,
}

impl Callee for Revocable {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        if self.lost.load(Ordering::Acquire) {
            return Err(gone());
        }
        self.world.call(method, request, lent)
    }
}

/// The error of a plugin that comes too late.
fn gone() -> PluginError {
    PluginError::Internal("the host has gone on without an answer".into())
}

/// One call, moved to the thread.
struct Job {
    method: Method,
    request: Vec<u64>,
    lent: usize,
    events: Sender<Event>,
}

/// What the thread tells the caller meanwhile.
enum Event {
    /// The plugin calls what it was lent.
    Called {
        index: usize,
        method: Method,
        request: Vec<u64>,
        /// What the plugin lends for that call; it waits for the answer.
        lent: Vec<&'static dyn Callee>,
        answer: Sender<Result<Vec<u64>, PluginError>>,
    },
    /// The call is over.
    Done(Result<Vec<u64>, PluginError>),
}

/// What stands on the plugin's thread for what the host lent.
struct Proxy {
    index: usize,
    events: Sender<Event>,
}

impl Callee for Proxy {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        let (answer, answered) = channel();
        // SAFETY: only the lifetime changes; `recv` below keeps this frame until the host has
        // answered or has dropped the channel, after which it uses none of it.
        let lent = lent.iter().map(|one| unsafe { lengthened(*one) }).collect();
        let called =
            Event::Called { index: self.index, method, request: request.to_vec(), lent, answer };
        self.events.send(called).map_err(|_| gone())?;
        soon(&answered).map_or_else(|| answered.recv().map_err(|_| gone()), Ok)?
    }
}

/// The same reference for longer than it is valid.
///
/// # Safety
/// It must not be used after the referent has gone.
unsafe fn lengthened<'a>(callee: &'a (dyn Callee + 'a)) -> &'static (dyn Callee + 'static) {
    // SAFETY: references that differ in their lifetimes alone; the caller's promise.
    unsafe { std::mem::transmute(callee) }
}

impl Worker {
    /// Builds the plugin of a table, on its thread.
    ///
    /// # Errors
    /// What the plugin refuses about its setup, or when it takes longer than `patience`.
    pub(super) fn start(
        table: &'static Table,
        named: Named,
        setup: Vec<u64>,
        world: Option<Box<dyn Callee>>,
        patience: Duration,
    ) -> Result<Arc<Self>, PluginError> {
        let (jobs, todo) = channel::<Job>();
        let (born, birth) = channel();
        let (over, ended) = channel();
        let lost = Arc::new(AtomicBool::new(false));
        let revocable =
            |world| -> Box<dyn Callee> { Box::new(Revocable { world, lost: Arc::clone(&lost) }) };
        let world = world.map(revocable).map(Lasting::new);
        let live = move || {
            // The world is freed after the plugin; one that is left alone keeps this frame, and
            // with it the world.
            match create(table, &setup, world.as_ref()) {
                Err(error) => _ = born.send(Err(error)),
                Ok(instance) => {
                    _ = born.send(Ok(()));
                    while let Some(job) = soon(&todo).or_else(|| todo.recv().ok()) {
                        work(table, instance, job);
                    }
                    if let Some(release) = table.release {
                        // SAFETY: created by this table on this thread, released once, after
                        // every call on it.
                        unsafe { release(instance) };
                    }
                }
            }
            _ = over.send(());
        };
        let thread = thread::Builder::new().name(named.to_string()).stack_size(STACK_BYTES);
        let started = thread.spawn(live);
        started.map_err(|e| PluginError::Resource(format!("no thread for the plugin: {e}")))?;
        let worker =
            Self { named, patience, jobs: Mutex::new(Some(jobs)), ended: Mutex::new(ended), lost };
        match birth.recv_timeout(patience) {
            Ok(Ok(())) => Ok(Arc::new(worker)),
            Ok(Err(error)) => Err(worker.named.fault("create", error)),
            Err(_) => {
                let error = worker.lose();
                Err(worker.named.fault("create", error))
            }
        }
    }

    /// Leaves the plugin alone for good.
    fn lose(&self) -> PluginError {
        self.lost.store(true, Ordering::Release);
        let patience = self.patience.as_secs_f64();
        PluginError::Internal(format!("no sign of life for {patience} s; it is left alone"))
    }
}

impl Callee for Worker {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        // One call at a time: the lock is held until the answer.
        let jobs = self.jobs.lock().unwrap_or_else(PoisonError::into_inner);
        let alone = || PluginError::Internal("it is left alone since it gave no answer".into());
        if self.lost.load(Ordering::Acquire) {
            return Err(alone());
        }
        let (events, told) = channel();
        let job = Job { method, request: request.to_vec(), lent: lent.len(), events };
        jobs.as_ref().ok_or_else(alone)?.send(job).map_err(|_| alone())?;
        loop {
            match soon(&told).map_or_else(|| told.recv_timeout(self.patience), Ok) {
                Ok(Event::Done(result)) => return result,
                Ok(Event::Called { index, method, request, lent: theirs, answer }) => {
                    // What is lent lives while its lender waits, which it does until `answer`
                    // is used or dropped; both come after this call.
                    _ = answer.send(lent[index].call(method, &request, &theirs));
                }
                Err(RecvTimeoutError::Timeout) => return Err(self.lose()),
                Err(RecvTimeoutError::Disconnected) => return Err(gone()),
            }
        }
    }

    fn blame(&self, method: Method, error: PluginError) -> PluginError {
        self.named.fault(method.name(), error)
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        *self.jobs.get_mut().unwrap_or_else(PoisonError::into_inner) = None;
        if !self.lost.load(Ordering::Acquire) {
            let ended = self.ended.get_mut().unwrap_or_else(PoisonError::into_inner);
            // One that does not end in time is left alone like any other.
            _ = ended.recv_timeout(self.patience);
        }
    }
}

/// Does one call.
fn work(table: &Table, instance: *mut c_void, job: Job) {
    let Job { method, request, lent, events } = job;
    let proxies: Vec<Proxy> =
        (0..lent).map(|index| Proxy { index, events: events.clone() }).collect();
    // SAFETY: the instance lives, on this thread.
    let answered = unsafe { ask(table.call, instance, method, &request, &lend(&proxies)) };
    // The caller may have gone on.
    _ = events.send(Event::Done(answered));
}
