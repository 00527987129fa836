//! What is let pass, and how far things are to keep apart.

/// What is let pass at a posture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rules<'a> {
    /// The fingers may touch obstacles other than the table.
    pub fingers_may_touch: bool,
    /// How near what is carried may come to things; left out, as near as the arm may.
    pub room: Option<&'a Room>,
}

/// How near what is carried may come to each thing, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Room {
    /// Above each table's top.
    pub(crate) tables: Vec<f64>,
    /// From each thing that stands there.
    pub(crate) standing: Vec<f64>,
}

/// Distances that are kept from obstacles, metres. From itself the robot keeps none, nor the arm
/// from the table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margins {
    /// Of the robot.
    pub clearance_m: f64,
    /// Of what it carries, which sways and sags.
    pub carried_m: f64,
}
