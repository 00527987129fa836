//! Messages of the world that robots and cameras are given.

use super::{Remote, anything};
use crate::abi::callee::{Callee, not_answered};
use crate::abi::cells::{Put, Reader, Take, fields, malformed, message};
use crate::abi::methods::Method;
use crate::{PluginError, Surface, World, WorldState};
use seeone_core::{Pose, TriangleMesh};
use std::sync::Arc;

fields!(WorldState { time_s, frame_s, opening_m, fingers_move, pads_feel_load, load_n });
fields!(Surface { mesh, is_object });

impl Put for TriangleMesh {
    fn put(&self, to: &mut Vec<u64>) {
        self.vertices().put(to);
        self.triangles().put(to);
    }
}

impl Take for TriangleMesh {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let (vertices, triangles) = Take::take(from)?;
        TriangleMesh::new(vertices, triangles).map_err(|fault| malformed(fault.to_string()))
    }
}

impl<C: Callee> World for Remote<C> {
    fn state(&self) -> Result<WorldState, PluginError> {
        self.ask(Method::WorldState, &[], &[], anything)
    }

    fn place_hand(&self, pose: &Pose) -> Result<(), PluginError> {
        self.ask(Method::PlaceHand, &message(&[pose]), &[], anything)
    }

    fn advance(&self, pose: &Pose) -> Result<(), PluginError> {
        self.ask(Method::Advance, &message(&[pose]), &[], anything)
    }

    fn close_fingers(&self, force_n: f64) -> Result<(), PluginError> {
        self.ask(Method::CloseFingers, &message(&[&force_n]), &[], anything)
    }

    fn open_fingers(&self, opening_m: f64) -> Result<(), PluginError> {
        self.ask(Method::OpenFingers, &message(&[&opening_m]), &[], anything)
    }

    fn surfaces(&self) -> Result<Vec<Surface>, PluginError> {
        self.ask(Method::Surfaces, &[], &[], anything)
    }
}

/// A world that plugins are given.
pub(in crate::abi) struct WorldCallee(pub(in crate::abi) Arc<dyn World>);

impl Callee for WorldCallee {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        _: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        let world = &self.0;
        match method {
            Method::WorldState => return Ok(message(&[&world.state()?])),
            Method::Surfaces => return Ok(message(&[&world.surfaces()?])),
            Method::PlaceHand => world.place_hand(&finite(Reader::whole(request)?)?),
            Method::Advance => world.advance(&finite(Reader::whole(request)?)?),
            Method::CloseFingers => world.close_fingers(positive(Reader::whole(request)?)?),
            Method::OpenFingers => world.open_fingers(positive(Reader::whole(request)?)?),
            other => Err(not_answered(other)),
        }
        .map(|()| Vec::new())
    }
}

/// A pose that the world may be moved to.
fn finite(pose: Pose) -> Result<Pose, PluginError> {
    let sound = pose.translation.vector.iter().all(|v| v.is_finite());
    sound.then_some(pose).ok_or_else(|| malformed("a pose of the hand is not finite".into()))
}

/// A force or an opening that the fingers may be given.
fn positive(number: f64) -> Result<f64, PluginError> {
    let sound = number.is_finite() && number >= 0.0;
    sound.then_some(number).ok_or_else(|| malformed(format!("the fingers are given {number}")))
}
