//! The simulated cell as plugins are given it.

use seeone_core::Pose;
use seeone_plugin::{PluginError, Surface, World, WorldState};
use seeone_sim::cell::{Cell, FRAME_S};
use std::sync::{Arc, Mutex, MutexGuard};

/// The simulated cell, which camera, robot and judge share: locked for as long as one call of it.
pub struct SharedCell(pub Arc<Mutex<Cell>>);

impl SharedCell {
    /// Locks it.
    ///
    /// # Errors
    /// When whoever had it broke down.
    pub fn lock(&self) -> Result<MutexGuard<'_, Cell>, PluginError> {
        self.0.lock().map_err(|_| PluginError::Internal("the simulated cell broke down".into()))
    }
}

impl World for SharedCell {
    fn state(&self) -> Result<WorldState, PluginError> {
        let cell = self.lock()?;
        Ok(WorldState {
            time_s: cell.time_s(),
            frame_s: FRAME_S,
            opening_m: cell.opening_m(),
            fingers_move: cell.fingers_move(),
            pads_feel_load: cell.pads_feel_load(),
            load_n: cell.load_n(),
        })
    }

    fn place_hand(&self, pose: &Pose) -> Result<(), PluginError> {
        self.lock()?.place_hand(pose);
        Ok(())
    }

    fn advance(&self, pose: &Pose) -> Result<(), PluginError> {
        self.lock()?.advance(pose).map_err(PluginError::Internal)
    }

    fn close_fingers(&self, force_n: f64) -> Result<(), PluginError> {
        self.lock()?.close(force_n);
        Ok(())
    }

    fn open_fingers(&self, opening_m: f64) -> Result<(), PluginError> {
        self.lock()?.open(opening_m);
        Ok(())
    }

    fn surfaces(&self) -> Result<Vec<Surface>, PluginError> {
        let cell = self.lock()?;
        let coloured = |is_object| move |mesh| Surface { mesh, is_object };
        let objects = cell.object_meshes().into_iter().map(coloured(true));
        Ok(objects.chain(cell.scenery_meshes().into_iter().map(coloured(false))).collect())
    }
}
