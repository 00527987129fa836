//! From a checked URDF tree and a few options to the robot model.

use super::gripper::{Finger, GripperModel, GripperOptions};
use super::urdf::{Tree, lengths, pose};
use super::{Joint, Link, RobotModel, Shape, Solid};
use crate::{Diagnostic, Pose};
use nalgebra::{Unit, Vector3};
use std::path::Path;
use urdf_rs::{Geometry, JointType};

/// What a URDF does not say about a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotOptions {
    /// Pose of the URDF's root link in `world`.
    pub base: Pose,
    /// The URDF link whose frame is the tool frame (TCP).
    pub tool_link: String,
    /// Where the arm waits, radians; `None` for zero, or the nearest limit to it.
    pub home: Option<Vec<f64>>,
    /// Largest acceleration of every joint, radians a second squared.
    pub acceleration: f64,
    /// Largest jerk of every joint, radians a second cubed.
    pub jerk: f64,
    /// Pairs of URDF links that always touch or never can; left out of collision checks.
    pub unchecked_pairs: Vec<[String; 2]>,
    /// The gripper.
    pub gripper: GripperOptions,
}

/// All that a robot model is made of, without any file.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotDescription {
    /// The URDF as it was written.
    pub urdf: String,
    /// What it does not say.
    pub options: RobotOptions,
}

impl Default for RobotOptions {
    /// At the world's origin, tool link `tcp`, 10 rad/s^2 and 100 rad/s^3 (robot descriptions
    /// give neither; a six-axis arm is driven gently so, and reaches its largest acceleration
    /// in 100 ms), every pair checked, an AG-95.
    fn default() -> Self {
        Self {
            base: Pose::identity(),
            tool_link: "tcp".into(),
            home: None,
            acceleration: 10.0,
            jerk: 100.0,
            unchecked_pairs: Vec::new(),
            gripper: GripperOptions::default(),
        }
    }
}

impl RobotModel {
    /// Reads a robot: the chain of revolute and fixed joints from the root to the tool
    /// link is the arm; the two prismatic joints beside it are the fingers.
    ///
    /// # Errors
    /// A [`Diagnostic`] with the file and the element: `R001` to `R006` for a broken URDF
    /// (unreadable, no URDF, duplicate name, dangling link, not one tree, not finite),
    /// `R007` limits or speed, `R008` axis, `R010` tool link, `R011` joint type, `R012`
    /// geometry, `R013` home, `R014` gripper, `R015` another option, `R016` a pair of bodies.
    pub fn from_urdf(file: &Path, options: &RobotOptions) -> Result<Self, Diagnostic> {
        Self::from_tree(&Tree::read(file)?, options)
    }

    /// Reads the robot that [`RobotModel::description`] gave: the same to the bit.
    ///
    /// # Errors
    /// As [`RobotModel::from_urdf`], for the file `robot.urdf`.
    pub fn from_description(description: &RobotDescription) -> Result<Self, Diagnostic> {
        let tree = Tree::parse(Path::new("robot.urdf"), description.urdf.clone())?;
        Self::from_tree(&tree, &description.options)
    }

    fn from_tree(tree: &Tree, options: &RobotOptions) -> Result<Self, Diagnostic> {
        for (what, limit) in [("acceleration", options.acceleration), ("jerk", options.jerk)] {
            if !(limit.is_finite() && limit > 0.0) {
                return Err(tree.fault("R015", format!("the {what} limit must be positive")));
            }
        }
        let names = || tree.links().iter().map(|link| link.name.as_str());
        if let Some(unknown) =
            options.unchecked_pairs.iter().flatten().find(|n| !names().any(|l| l == *n))
        {
            let cause = format!("an unchecked pair names \"{unknown}\", which is no link");
            return Err(tree.fault("R016", cause).suggest(unknown, names()));
        }
        if !options.base.to_homogeneous().iter().all(|v| v.is_finite()) {
            return Err(tree.fault("R015", "the base pose must be finite".into()));
        }
        let (joints, tool) = chain(tree, &options.tool_link)?;
        let mut parts =
            Parts { links: vec![Link::default(); joints.len() + 1], ..Parts::default() };
        let arm: Vec<&str> = joints.iter().map(Joint::name).collect();
        parts.collect(tree, tree.root(), Place::Arm(0), Pose::identity(), &arm)?;
        let gripper = gripper(tree, &mut parts, &options.gripper, &tool, &arm)?;
        let mut robot = Self {
            name: tree.name().to_owned(),
            base: options.base,
            home: joints.iter().map(|j| 0.0f64.clamp(j.lower, j.upper)).collect(),
            joints,
            links: parts.links,
            tool,
            acceleration: options.acceleration,
            jerk: options.jerk,
            unchecked_pairs: options.unchecked_pairs.clone(),
            gripper,
            urdf: tree.text().into(),
            tool_link: options.tool_link.clone(),
        };
        if let Some(home) = &options.home {
            robot.check_home(home).map_err(|cause| tree.fault("R013", cause))?;
            robot.home.clone_from(home);
        }
        Ok(robot)
    }

    fn check_home(&self, home: &[f64]) -> Result<(), String> {
        if home.len() != self.joints.len() {
            let (given, wanted) = (home.len(), self.joints.len());
            return Err(format!("home has {given} positions, the arm {wanted} joints"));
        }
        match self.joints.iter().zip(home).find(|(joint, q)| !joint.allows(**q)) {
            None => Ok(()),
            Some((joint, q)) => Err(format!(
                "home: joint \"{}\" at {q:.4} rad is outside {:.4}..{:.4}",
                joint.name, joint.lower, joint.upper
            )),
        }
    }
}

/// The arm's joints, each origin in the link before it, and the tool in the last link.
fn chain(tree: &Tree, tool_link: &str) -> Result<(Vec<Joint>, Pose), Diagnostic> {
    let mut joints = Vec::new();
    let mut since_last = Pose::identity();
    for joint in tree.path_to(tool_link)? {
        since_last *= pose(&joint.origin);
        match joint.joint_type {
            JointType::Fixed => {}
            JointType::Revolute => {
                joints.push(revolute(tree, joint, since_last)?);
                since_last = Pose::identity();
            }
            _ => {
                let cause = format!(
                    "joint \"{}\": the arm may have revolute and fixed joints only",
                    joint.name
                );
                return Err(tree.fault("R011", cause));
            }
        }
    }
    if joints.is_empty() {
        let cause = format!("no revolute joint lies between the root and \"{tool_link}\"");
        return Err(tree.fault("R010", cause));
    }
    Ok((joints, since_last))
}

fn revolute(tree: &Tree, joint: &urdf_rs::Joint, origin: Pose) -> Result<Joint, Diagnostic> {
    let told =
        |code, cause: String| Err(tree.fault(code, format!("joint \"{}\": {cause}", joint.name)));
    let limit = &joint.limit;
    if limit.lower >= limit.upper {
        return told("R007", format!("limits {}..{} leave no room", limit.lower, limit.upper));
    }
    if limit.velocity <= 0.0 {
        return told("R007", format!("the largest speed is {} rad/s", limit.velocity));
    }
    let Some(axis) = Unit::try_new(Vector3::from(joint.axis.xyz.0), 1e-6) else {
        return told("R008", "the axis has no direction".into());
    };
    Ok(Joint {
        name: joint.name.clone(),
        origin,
        axis,
        lower: limit.lower,
        upper: limit.upper,
        velocity: limit.velocity,
    })
}

/// What a URDF link is rigid with.
#[derive(Clone, Copy)]
enum Place {
    Arm(usize),
    Finger(usize),
}

/// The bodies by what they move with, and the finger joints met on the way.
#[derive(Default)]
struct Parts<'a> {
    links: Vec<Link>,
    /// Joint, the arm link it hangs on, and its pose there.
    fingers: Vec<(&'a urdf_rs::Joint, usize, Pose, Link)>,
}

impl<'a> Parts<'a> {
    /// Adds the bodies of `link`, which sits at `at` in its place, and of all below it.
    fn collect(
        &mut self,
        tree: &'a Tree,
        link: &'a str,
        place: Place,
        at: Pose,
        arm: &[&str],
    ) -> Result<(), Diagnostic> {
        let bodies = bodies(tree, link, &at)?;
        let target = match place {
            Place::Arm(index) => &mut self.links[index],
            Place::Finger(index) => &mut self.fingers[index].3,
        };
        target.collision.extend(bodies.collision);
        target.visual.extend(bodies.visual);
        for joint in tree.joints_on(link) {
            let origin = at * pose(&joint.origin);
            let (place, at) = match (place, &joint.joint_type) {
                (_, JointType::Fixed) => (place, origin),
                (Place::Arm(index), _) if arm.contains(&joint.name.as_str()) => {
                    (Place::Arm(index + 1), Pose::identity())
                }
                (Place::Arm(index), JointType::Prismatic) => {
                    self.fingers.push((joint, index, origin, Link::default()));
                    (Place::Finger(self.fingers.len() - 1), Pose::identity())
                }
                _ => {
                    let cause = format!(
                        "joint \"{}\": beside the arm only two prismatic finger joints may move",
                        joint.name
                    );
                    return Err(tree.fault("R011", cause));
                }
            };
            self.collect(tree, &joint.child.link, place, at, arm)?;
        }
        Ok(())
    }
}

/// The bodies of one URDF link that sits at `at` in what it is rigid with.
fn bodies(tree: &Tree, name: &str, at: &Pose) -> Result<Link, Diagnostic> {
    let mut bodies = Link::default();
    let Some(link) = tree.links().iter().find(|l| l.name == name) else {
        return Ok(bodies);
    };
    let solid = |origin: &urdf_rs::Pose, geometry: &Geometry| {
        Ok(Solid {
            part: name.to_owned(),
            shape: shape(geometry)
                .map_err(|e| tree.fault("R012", format!("link \"{name}\": {e}")))?,
            pose: at * pose(origin),
        })
    };
    for collision in &link.collision {
        bodies.collision.push(solid(&collision.origin, &collision.geometry)?);
    }
    for visual in &link.visual {
        bodies.visual.push(solid(&visual.origin, &visual.geometry)?);
    }
    Ok(bodies)
}

fn shape(geometry: &Geometry) -> Result<Shape, &'static str> {
    if lengths(geometry).iter().any(|v| *v <= 0.0) {
        return Err("a length of its geometry is not positive");
    }
    match *geometry {
        Geometry::Box { size } => Ok(Shape::Box { half_m: Vector3::from(size.0) * 0.5 }),
        Geometry::Cylinder { radius, length } => {
            Ok(Shape::Cylinder { radius_m: radius, length_m: length })
        }
        Geometry::Capsule { radius, length } => {
            Ok(Shape::Capsule { radius_m: radius, length_m: length })
        }
        Geometry::Sphere { radius } => Ok(Shape::Sphere { radius_m: radius }),
        Geometry::Mesh { .. } => {
            Err("meshes are not supported, use boxes, cylinders, capsules and spheres")
        }
    }
}

/// The gripper: two equal prismatic joints on one link, which is the palm.
fn gripper<'a>(
    tree: &'a Tree,
    parts: &mut Parts<'a>,
    options: &GripperOptions,
    tool: &Pose,
    arm: &[&str],
) -> Result<GripperModel, Diagnostic> {
    let told = |cause: &str| tree.fault("R014", format!("gripper: {cause}"));
    let fingers = std::mem::take(&mut parts.fingers);
    let Ok([a, b]) = <[_; 2]>::try_from(fingers) else {
        return Err(told("it must have two prismatic finger joints"));
    };
    let palm = a.0.parent.link.as_str();
    if b.0.parent.link != palm || (a.1, b.1) != (arm.len(), arm.len()) {
        return Err(told("both fingers must hang on one palm behind the last joint"));
    }
    let (one, other) = (&a.0.limit, &b.0.limit);
    if one.lower != 0.0 || one.upper <= 0.0 || (one.lower, one.upper) != (other.lower, other.upper)
    {
        return Err(told("both fingers must move from 0 (closed) to one positive upper limit"));
    }
    let [low, high] = options.force_n;
    if !(low.is_finite() && high.is_finite() && 0.0 < low && low <= high) {
        return Err(told("the force range must be positive and rising"));
    }
    let table = &options.reach_m;
    if table.is_empty()
        || table.iter().any(|(opening, reach)| !(opening.is_finite() && reach.is_finite()))
        || table.windows(2).any(|pair| pair[0].0 >= pair[1].0)
    {
        return Err(told("the reach table must be finite with rising openings"));
    }
    let stroke_m = 2.0 * one.upper;
    let finger = |(joint, _, closed, link): (&urdf_rs::Joint, usize, Pose, Link)| {
        Vector3::from(joint.axis.xyz.0)
            .try_normalize(1e-6)
            .map(|axis| Finger { closed, axis, link })
            .ok_or_else(|| told("a finger's axis has no direction"))
    };
    let last = &mut parts.links[arm.len()];
    let split = |solids: &mut Vec<Solid>| solids.extract_if(.., |s| s.part == palm).collect();
    Ok(GripperModel {
        stroke_m,
        options: options.clone(),
        palm: Link { collision: split(&mut last.collision), visual: split(&mut last.visual) },
        fingers: [finger(a)?, finger(b)?],
        approach: tool.rotation * Vector3::z(),
    })
}
