//! What can go wrong in a world.

/// Why a world stopped.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WorldFault {
    /// A position or velocity was no longer finite; the world stays at the frame before.
    #[error("the simulation diverged {seconds:.2} s after its start")]
    Diverged {
        /// When, s.
        seconds: f64,
    },
}

/// Why vertices cannot be placed, pinned or pushed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlacementFault {
    /// Too many or too few.
    #[error("{given} vertices were given for an object of {needed}")]
    Count {
        /// How many were given.
        given: usize,
        /// How many the object has.
        needed: usize,
    },
    /// A position or force that is not finite.
    #[error("what was given for vertex {0} is not finite")]
    NotFinite(usize),
    /// A vertex that the object does not have.
    #[error("vertex {vertex} was named, of an object of {vertices}")]
    Unknown {
        /// The vertex that was named.
        vertex: usize,
        /// How many the object has.
        vertices: usize,
    },
}
