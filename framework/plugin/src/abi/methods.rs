//! What can be asked: the messages of each kind of plugin and of what is lent to it.
//!
//! A message is a row of 8-byte cells. A number, a truth (0 or 1) and a count are one cell
//! each; real numbers are IEEE doubles. A text is its count of bytes and the bytes, filled up
//! with zeros to whole cells; features and depths are a count and single-precision numbers, two
//! a cell, filled up likewise. A list is its count and its elements. What may be missing is a
//! truth and, where it is there, the thing. A point is x, y, z; a pose is x, y, z and the
//! quaternion x, y, z, w; a similarity is a pose and a scale.

/// The questions, each with its request `->` its answer.
#[repr(u64)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Camera: nothing `->` depth image or none (width, height, fx, fy, cx, cy, depths), list
    /// of points, the camera's position.
    Observe = 1,
    /// Perception: an observation as above `->` a canonical cloud: points, canonical points,
    /// confidences (three each), features, features a point.
    Perceive = 2,
    /// Encoding: a canonical cloud `->` the number of a new field.
    Encode = 3,
    /// Encoding, or a field that is lent (number 0): a field's number, list of points `->`
    /// features a point, features.
    Features = 4,
    /// As above: a field's number, list of points `->` list of winding numbers, or none.
    Winding = 5,
    /// Encoding: a field's number, which is not used again `->` nothing.
    Forget = 6,
    /// Alignment: list of points, list of points, list of weights, a fixed scale or none `->`
    /// similarity, residual, share of inliers, condition.
    Align = 7,
    /// Transfer, lent the fields of demonstration and instance: demonstrated pose, its scale,
    /// canonical cloud, the instance's scale, gripper points `->` list of candidates: pose,
    /// loss, confidence, whether to lay on the surface, origin (text).
    Transfer = 8,
    /// Kinematics, lent a clearance where there is one: the robot or none (the one of the
    /// setup), target pose, joints to start near, whether continuous, period or none `->`
    /// whether solved, joints, position error, rotation error, steps, contact or none (two
    /// names, distance, wanted distance), reason or none.
    Solve = 9,
    /// Motion, lent kinematics: the robot or none (the one of the setup), start joints,
    /// whether holding, points of what is carried, key poses, obstacles `->` 1, program, cost; or
    /// 0, stage, reason.
    Plan = 10,
    /// Robot: nothing `->` joints, opening.
    State = 11,
    /// Robot, lent a watcher: an action `->` opening, whether holding, whether contact.
    Execute = 12,
    /// A clearance that is lent: joints `->` contact or none.
    Contact = 13,
    /// A clearance that is lent: joints, distance `->` list of proximities: margin, normal
    /// (point), two carriers or none each (link, point).
    Proximities = 14,
    /// A watcher that is lent: seconds, joints, opening `->` nothing. Any code but `OK` asks the
    /// robot to stop and to end the action with that code.
    Watch = 15,
    /// The world: nothing `->` seconds, seconds a frame, opening, whether the fingers move,
    /// whether the pads feel a load, the load (point).
    WorldState = 16,
    /// The world: pose of the hand, at once `->` nothing.
    PlaceHand = 17,
    /// The world: pose of the hand at the end of one frame `->` nothing.
    Advance = 18,
    /// The world: force `->` nothing.
    CloseFingers = 19,
    /// The world: opening `->` nothing.
    OpenFingers = 20,
    /// The world: nothing `->` list of surfaces: points, list of triangles
    /// (three numbers each), whether it has the colour of the objects to be taken.
    Surfaces = 21,
    /// Robot: nothing `->` nothing. It stands still where it is.
    Stop = 22,
}

impl Method {
    /// Every method, in order.
    pub const ALL: [Method; 22] = [
        Method::Observe,
        Method::Perceive,
        Method::Encode,
        Method::Features,
        Method::Winding,
        Method::Forget,
        Method::Align,
        Method::Transfer,
        Method::Solve,
        Method::Plan,
        Method::State,
        Method::Execute,
        Method::Contact,
        Method::Proximities,
        Method::Watch,
        Method::WorldState,
        Method::PlaceHand,
        Method::Advance,
        Method::CloseFingers,
        Method::OpenFingers,
        Method::Surfaces,
        Method::Stop,
    ];

    /// The method of a number.
    pub fn of(number: u64) -> Option<Method> {
        Self::ALL.into_iter().find(|method| *method as u64 == number)
    }

    /// What it is called in errors: the function of the contract.
    pub fn name(self) -> &'static str {
        match self {
            Method::Observe => "observe",
            Method::Perceive => "perceive",
            Method::Encode => "encode",
            Method::Features => "features",
            Method::Winding => "winding",
            Method::Forget => "forget",
            Method::Align => "align",
            Method::Transfer => "transfer",
            Method::Solve => "solve",
            Method::Plan => "plan",
            Method::State => "state",
            Method::Execute => "execute",
            Method::Contact => "contact",
            Method::Proximities => "proximities",
            Method::Watch => "watch",
            Method::WorldState => "world state",
            Method::PlaceHand => "place hand",
            Method::Advance => "advance",
            Method::CloseFingers => "close fingers",
            Method::OpenFingers => "open fingers",
            Method::Surfaces => "surfaces",
            Method::Stop => "stop",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_the_golden_ones() {
        for (i, method) in Method::ALL.into_iter().enumerate() {
            assert_eq!(method as u64, i as u64 + 1);
            assert_eq!(Method::of(i as u64 + 1), Some(method));
        }
        assert_eq!((Method::of(0), Method::of(23)), (None, None));
    }
}
