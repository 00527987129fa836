//! Inner loops compiled for the vector unit that the machine has.

use pulp::{Arch, NullaryFnOnce};

struct Loop<F>(F);

impl<R, F: FnMut() -> R> NullaryFnOnce for Loop<F> {
    type Output = R;

    #[inline(always)]
    fn call(mut self) -> R {
        (self.0)()
    }
}

/// Runs `f`, compiled once for each instruction set and chosen at run time. Mark the
/// closure `#[inline(always)]`: what is not inlined keeps the baseline's instructions.
///
/// (`pulp` takes closures by `FnOnce`, for which the compiler puts a function in between
/// that is never inlined; hence the detour.)
#[inline(always)]
pub fn vectorize<R>(f: impl FnMut() -> R) -> R {
    Arch::new().dispatch(Loop(f))
}
