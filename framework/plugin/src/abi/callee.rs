//! Whatever answers messages, on either side, and how it crosses.

use super::message::{Message, with_message};
use super::methods::Method;
use super::table::{Answer, Call, Service, Span, Status};
use crate::PluginError;
use std::any::Any;
use std::ffi::c_void;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// Something that answers messages: a plugin, or what is lent to one.
pub trait Callee: Send + Sync {
    /// Answers one message.
    ///
    /// # Errors
    /// What the contract's function refuses, or why it could not be asked.
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError>;

    /// Says in a fault of this callee whose it is.
    fn blame(&self, _method: Method, error: PluginError) -> PluginError {
        error
    }
}

/// What leads to a callee answers as it does.
macro_rules! forwarded {
    ($($pointer:ty),+) => {$(
        impl<C: Callee + ?Sized> Callee for $pointer {
            fn call(
                &self,
                method: Method,
                request: &[u64],
                lent: &[&dyn Callee],
            ) -> Result<Vec<u64>, PluginError> {
                (**self).call(method, request, lent)
            }

            fn blame(&self, method: Method, error: PluginError) -> PluginError {
                (**self).blame(method, error)
            }
        }
    )+};
}
forwarded!(Arc<C>, &C);

/// `all` as what is lent for a call.
pub(super) fn lend<'a, C: Callee + 'a>(
    all: impl IntoIterator<Item = &'a C>,
) -> Vec<&'a dyn Callee> {
    all.into_iter().map(|one| one as &dyn Callee).collect()
}

/// The error of a method that a callee does not have.
pub(super) fn not_answered(method: Method) -> PluginError {
    PluginError::Internal(format!("\"{}\" is asked of what cannot answer it", method.name()))
}

/// What the other side lent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foreign(Service);

// SAFETY: the ABI demands of a service that any thread may call it, until the time for which
// it is lent is over; whoever makes a `Foreign` sees to that time.
unsafe impl Send for Foreign {}
// SAFETY: as above.
unsafe impl Sync for Foreign {}

impl Foreign {
    /// What was lent; none when nothing was.
    ///
    /// # Safety
    /// `service` must be null, or one whose `call` may be called with its object from any
    /// thread for as long as the `Foreign` or a copy of it is used.
    pub(super) unsafe fn new(service: Service) -> Option<Self> {
        service.call.map(|_| Self(service))
    }
}

impl Callee for Foreign {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        // SAFETY: the promise of whoever made this.
        unsafe { ask(self.0.call, self.0.object, method, request, lent) }
    }
}

/// Calls across the border.
///
/// # Safety
/// `call` must be null, or callable with `object` now and on this thread.
pub(super) unsafe fn ask(
    call: Call,
    object: *mut c_void,
    method: Method,
    request: &[u64],
    lent: &[&dyn Callee],
) -> Result<Vec<u64>, PluginError> {
    let call = call.ok_or_else(missing)?;
    let services: Vec<Service> = lent.iter().map(service).collect();
    let mut given: Option<Vec<u64>> = None;
    let answer = Answer { target: (&raw mut given).cast(), give: Some(take) };
    let (status, text) = with_message(|message| {
        let (request, services) = (Span::of(request), Span::of(&services));
        // SAFETY: the caller's promise; the records and what they lead to live for the call.
        unsafe { call(object, method as u64, request, services, &answer, message) }
    });
    status.result(text)?;
    given.ok_or_else(|| PluginError::Internal("it gave no answer".into()))
}

/// Copies what is given into the vector that waits for it.
unsafe extern "C" fn take(target: *mut c_void, cells: Span<u64>) {
    // SAFETY: `target` is that of the answer, made in `ask`, which has not returned.
    let waiting = unsafe { target.cast::<Option<Vec<u64>>>().as_mut() };
    // SAFETY: what is given is valid during this call.
    let cells = unsafe { cells.slice() };
    if let (Some(waiting), Some(cells)) = (waiting, cells) {
        *waiting = Some(cells.to_vec());
    }
}

/// A callee of this side as a service. The reference must live for as long as it is lent.
fn service(callee: &&dyn Callee) -> Service {
    Service { object: std::ptr::from_ref(callee).cast_mut().cast(), call: Some(serve_lent) }
}

/// Answers a call of what [`service`] made.
unsafe extern "C" fn serve_lent(
    object: *mut c_void,
    method: u64,
    request: Span<u64>,
    lent: Span<Service>,
    answer: *const Answer,
    message: *mut Message,
) -> Status {
    // SAFETY: the other side hands back the object of the service while it is lent.
    let Some(callee) = (unsafe { object.cast::<&dyn Callee>().as_ref() }) else {
        return Status::INTERNAL;
    };
    // SAFETY: the other side's records are valid for the call.
    unsafe {
        serve(method, request, lent, answer, message, |method, request, lent| {
            callee.call(method, request, &lend(lent))
        })
    }
}

/// A callee of this side that is lent for longer than one call.
pub(super) struct Lasting(Box<Box<dyn Callee>>);

impl Lasting {
    pub(super) fn new(callee: Box<dyn Callee>) -> Self {
        Self(Box::new(callee))
    }

    /// The callee as a service, until this is dropped.
    pub(super) fn service(&self) -> Service {
        let object = std::ptr::from_ref(&*self.0).cast_mut().cast();
        Service { object, call: Some(serve_lasting) }
    }
}

/// Answers a call of what [`Lasting`] made.
unsafe extern "C" fn serve_lasting(
    object: *mut c_void,
    method: u64,
    request: Span<u64>,
    lent: Span<Service>,
    answer: *const Answer,
    message: *mut Message,
) -> Status {
    // SAFETY: the other side hands back the object of the service while it is lent.
    let Some(callee) = (unsafe { object.cast::<Box<dyn Callee>>().as_ref() }) else {
        return Status::INTERNAL;
    };
    let callee: &dyn Callee = &**callee;
    // SAFETY: a reference to a callee that lives for the call, and the other side's records.
    unsafe {
        let object = std::ptr::from_ref(&callee).cast_mut().cast();
        serve_lent(object, method, request, lent, answer, message)
    }
}

/// Lends nothing.
pub(super) const NO_SERVICE: Service = Service { object: std::ptr::null_mut(), call: None };

/// Answers a call from the other side with `work`, whose errors and panics leave as a status
/// and a text.
///
/// # Safety
/// The spans, the answer and the message must be null or valid for the call.
pub(super) unsafe fn serve(
    method: u64,
    request: Span<u64>,
    lent: Span<Service>,
    answer: *const Answer,
    message: *mut Message,
    work: impl FnOnce(Method, &[u64], &[Foreign]) -> Result<Vec<u64>, PluginError>,
) -> Status {
    guarded(message, || {
        // SAFETY: the caller's promise.
        let (request, lent, answer) = unsafe { (request.slice(), lent.slice(), answer.as_ref()) };
        let (Some(request), Some(lent), Some(answer)) = (request, lent, answer) else {
            return Err(missing());
        };
        let number = method;
        let method = Method::of(number)
            .ok_or_else(|| PluginError::Internal(format!("there is no method {number}")))?;
        let lent: Vec<Foreign> = lent
            .iter()
            // SAFETY: lent for this call, and used in it alone.
            .map(|service| unsafe { Foreign::new(*service) }.ok_or_else(missing))
            .collect::<Result<_, _>>()?;
        let cells = work(method, request, &lent)?;
        let give = answer.give.ok_or_else(missing)?;
        // SAFETY: the answer is valid for the call, and the cells live through it.
        unsafe { give(answer.target, Span::of(&cells)) };
        Ok(())
    })
}

/// The other side left out a record.
pub(super) fn missing() -> PluginError {
    PluginError::Internal("a record is missing where one is due".into())
}

/// Runs `work` so that neither an error nor a panic leaves it but as a status and a text.
pub(super) fn guarded(
    message: *mut Message,
    work: impl FnOnce() -> Result<(), PluginError>,
) -> Status {
    let ended = catch_unwind(AssertUnwindSafe(work));
    let result = ended.unwrap_or_else(|panic| Err(PluginError::Internal(told(&*panic))));
    let Err(error) = result else { return Status::OK };
    let (status, text) = Status::of(error);
    // SAFETY: the other side lends null or a valid message.
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
    format!("a panic: {}", text.unwrap_or("without a text"))
}

/// Ends the plugin's step with `error`, in functions that return no result.
pub(super) fn unanswered(error: PluginError) -> ! {
    // Not by `panic!`, whose hook would print what the step's failure tells anyway.
    std::panic::resume_unwind(Box::new(error.to_string()))
}
