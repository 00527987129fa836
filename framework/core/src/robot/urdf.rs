//! A URDF as a checked tree of links: unique names, nothing dangling, one root, no
//! cycle, every number finite.

use crate::{Diagnostic, Pose};
use nalgebra::{Translation3, UnitQuaternion};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use urdf_rs::{Geometry, Joint, Link, Robot};

/// A URDF in which every joint names two links that are there, every link but the root
/// hangs on exactly one joint, and every number is finite.
pub(super) struct Tree {
    file: PathBuf,
    text: String,
    robot: Robot,
    root: String,
}

impl Tree {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// `R001` unreadable, `R002` no URDF, `R003` a name twice, `R004` a joint names a
    /// link that is not there, `R005` not one tree, `R006` a number that is not finite.
    pub(super) fn read(file: &Path) -> Result<Self, Diagnostic> {
        let text = fs::read_to_string(file)
            .map_err(|e| Diagnostic::new("R001", format!("cannot be read: {e}")).in_file(file))?;
        Self::parse(file, text)
    }

    /// Checks the text of a file.
    ///
    /// # Errors
    /// As [`Tree::read`], but for `R001`.
    pub(super) fn parse(file: &Path, text: String) -> Result<Self, Diagnostic> {
        let robot = urdf_rs::read_from_string(&text)
            .map_err(|e| Diagnostic::new("R002", format!("is no URDF: {e}")).in_file(file))?;
        unique("link", robot.links.iter().map(|l| &l.name))
            .and_then(|()| unique("joint", robot.joints.iter().map(|j| &j.name)))
            .and_then(|()| finite(&robot))
            .and_then(|()| root(&robot))
            .map(|root| Self { file: file.to_owned(), text, robot, root })
            .map_err(|fault| fault.in_file(file))
    }

    /// The URDF as it was written.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    pub(super) fn name(&self) -> &str {
        &self.robot.name
    }

    pub(super) fn root(&self) -> &str {
        &self.root
    }

    /// A fault of this file.
    pub(super) fn fault(&self, code: &'static str, cause: String) -> Diagnostic {
        Diagnostic::new(code, cause).in_file(&self.file)
    }

    pub(super) fn links(&self) -> &[Link] {
        &self.robot.links
    }

    /// The joints that hang on `link`, in the file's order.
    pub(super) fn joints_on<'a>(&'a self, link: &'a str) -> impl Iterator<Item = &'a Joint> {
        self.robot.joints.iter().filter(move |joint| joint.parent.link == link)
    }

    /// The joints from the root to `link`, root first.
    ///
    /// # Errors
    /// `R010` when there is no such link.
    pub(super) fn path_to(&self, link: &str) -> Result<Vec<&Joint>, Diagnostic> {
        let names = || self.robot.links.iter().map(|l| l.name.as_str());
        if !names().any(|name| name == link) {
            let cause = format!("there is no tool link \"{link}\"");
            return Err(self.fault("R010", cause).suggest(link, names()));
        }
        let mut path = Vec::new();
        let mut at = link;
        while let Some(joint) = self.robot.joints.iter().find(|j| j.child.link == at) {
            path.push(joint);
            at = &joint.parent.link;
        }
        path.reverse();
        Ok(path)
    }
}

/// A pose as a URDF writes it: fixed-axis roll, pitch, yaw after a translation.
pub(super) fn pose(origin: &urdf_rs::Pose) -> Pose {
    let ([x, y, z], [roll, pitch, yaw]) = (origin.xyz.0, origin.rpy.0);
    Pose::from_parts(
        Translation3::new(x, y, z),
        UnitQuaternion::from_euler_angles(roll, pitch, yaw),
    )
}

fn unique<'a>(what: &str, names: impl Iterator<Item = &'a String>) -> Result<(), Diagnostic> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(Diagnostic::new("R003", format!("two {what}s are called \"{name}\"")));
        }
    }
    Ok(())
}

/// The one link that no joint carries, after following every joint from it.
fn root(robot: &Robot) -> Result<String, Diagnostic> {
    let names: BTreeSet<&str> = robot.links.iter().map(|l| l.name.as_str()).collect();
    let mut parent_of = BTreeMap::new();
    for joint in &robot.joints {
        let (parent, child) = (joint.parent.link.as_str(), joint.child.link.as_str());
        if let Some(missing) = [parent, child].into_iter().find(|link| !names.contains(link)) {
            let cause = format!("joint \"{}\": there is no link \"{missing}\"", joint.name);
            return Err(Diagnostic::new("R004", cause).suggest(missing, names.iter().copied()));
        }
        if parent_of.insert(child, parent).is_some() {
            let cause = format!("joint \"{}\": link \"{child}\" hangs on two joints", joint.name);
            return Err(Diagnostic::new("R005", cause));
        }
    }
    let roots: Vec<&str> = names.iter().copied().filter(|l| !parent_of.contains_key(l)).collect();
    let [root] = roots[..] else {
        let cause = if roots.is_empty() {
            "the joints form a cycle: no link is the root".into()
        } else {
            format!("{} links hang on no joint: {}", roots.len(), roots.join(", "))
        };
        return Err(Diagnostic::new("R005", cause));
    };
    // With one root and one parent a link, whatever is not under the root is in a cycle
    // or below one.
    for link in &names {
        let above = |at: &&str| parent_of.get(at).copied();
        let mut above = std::iter::successors(above(link), above).take(names.len());
        if above.any(|at| at == *link) {
            let cause = format!("link \"{link}\" is in a cycle of joints");
            return Err(Diagnostic::new("R005", cause));
        }
    }
    Ok(root.to_owned())
}

fn finite(robot: &Robot) -> Result<(), Diagnostic> {
    let check = |what: &str, name: &str, numbers: &[f64]| {
        if numbers.iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        Err(Diagnostic::new("R006", format!("{what} \"{name}\": a number is not finite")))
    };
    for joint in &robot.joints {
        let (origin, limit) = (&joint.origin, &joint.limit);
        check("joint", &joint.name, &origin.xyz.0)?;
        check("joint", &joint.name, &origin.rpy.0)?;
        check("joint", &joint.name, &joint.axis.xyz.0)?;
        check("joint", &joint.name, &[limit.lower, limit.upper, limit.velocity, limit.effort])?;
    }
    for link in &robot.links {
        let inertial = &link.inertial;
        check("link", &link.name, &inertial.origin.xyz.0)?;
        check("link", &link.name, &inertial.origin.rpy.0)?;
        check("link", &link.name, &[inertial.mass.value])?;
        let visual = link.visual.iter().map(|v| (&v.origin, &v.geometry));
        for (origin, geometry) in
            visual.chain(link.collision.iter().map(|c| (&c.origin, &c.geometry)))
        {
            check("link", &link.name, &origin.xyz.0)?;
            check("link", &link.name, &origin.rpy.0)?;
            check("link", &link.name, &lengths(geometry))?;
        }
    }
    Ok(())
}

/// The numbers of a geometry.
pub(super) fn lengths(geometry: &Geometry) -> Vec<f64> {
    match geometry {
        Geometry::Box { size } => size.0.to_vec(),
        Geometry::Cylinder { radius, length } | Geometry::Capsule { radius, length } => {
            vec![*radius, *length]
        }
        Geometry::Sphere { radius } => vec![*radius],
        Geometry::Mesh { scale, .. } => scale.iter().flat_map(|s| s.0).collect(),
    }
}
