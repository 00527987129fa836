//! What is let pass, and how far things are to keep apart.

/// What is let pass at a posture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rules {
    /// The fingers may touch obstacles other than the table.
    pub fingers_may_touch: bool,
    /// A ball about what hangs in the hand keeps this far from every obstacle, metres from
    /// its centre.
    pub held_radius_m: Option<f64>,
}

/// Distances of a checker.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margins {
    /// What the robot keeps from obstacles, metres. From itself and the table it keeps none.
    pub clearance_m: f64,
    /// How far ahead of the tool frame the centre of what hangs in the hand is, metres.
    pub held_ahead_m: f64,
}
