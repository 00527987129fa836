//! The simulated cell as the composition root sees it: made from scene and object, shared
//! with the plugins, and read by the judge.

use crate::judge::{CellJudge, Wearing};
use crate::objects;
use crate::shared_cell::SharedCell;
use anyhow::{Context, Result, anyhow};
use nalgebra::Point3;
use seeone_core::Diagnostic;
use seeone_core::random::generator;
use seeone_plugin::World;
use seeone_runtime::files::Scene;
use seeone_sim::cell::Cell;
use seeone_sim::drop::Drop;
use seeone_sim::object::Object;
use seeone_sim::surroundings::{Frictions, Head, Hook, Surroundings};
use seeone_sim::world::Settings;
use seeone_sim::worn::{Worn, worn_on};
use std::sync::{Arc, Mutex};

/// A simulated cell and, where it has a head, what its object looks like when it is worn.
pub struct SimulatedCell {
    /// Shared with the camera and robot plugins.
    pub cell: Arc<Mutex<Cell>>,
    scene: Scene,
    wearing: Option<Arc<Wearing>>,
}

impl SimulatedCell {
    /// Drops `object` into the scene, and whatever lies there besides, and lets all come to rest.
    ///
    /// # Errors
    /// When there is a head on which the object cannot be worn at all, an object beside it that
    /// is none or finds no room, or the simulation diverged.
    pub fn drop(scene: &Scene, object: Object, seed: u64) -> Result<Self> {
        check(scene)?;
        let settings = Settings::default();
        let head = scene.head().map(|head| Head { pose: head.pose, size: head.size });
        let wearing = head.map(|head| wearing(&object, head, &settings)).transpose()?;
        let standard = Frictions::default();
        let surroundings = Surroundings {
            table: true,
            head,
            hooks: scene
                .hooks()
                .iter()
                .map(|hook| Hook { pose: hook.pose, peg: hook.peg })
                .collect(),
            frictions: Frictions {
                table: scene.table.friction,
                head: scene.head().map_or(standard.head, |head| head.friction),
                hook: scene.hook().map_or(standard.hook, |hook| hook.friction),
                ..standard
            },
        };
        let centre = [scene.drop.centre.x, scene.drop.centre.y];
        let drop = Drop::draw(centre, &mut generator(seed, "drop"));
        let mut cell = Cell::after_drop(object, &drop, surroundings, settings)
            .map_err(|fault| anyhow!(fault))?;
        for (index, beside) in (1..).zip(&scene.beside) {
            let object = objects::for_attempt(&beside.object, seed.wrapping_add(index))?;
            let mut rng = generator(seed, &format!("drop-{index}"));
            cell.drop_beside(&object, beside.centre.into(), settings, &mut rng)
                .map_err(|fault| anyhow!(fault))?;
        }
        Ok(Self {
            cell: Arc::new(Mutex::new(cell)),
            scene: scene.clone(),
            wearing: wearing.map(Arc::new),
        })
    }

    /// Puts what was dropped into `other` in the place of this cell's object: plugins that hold a
    /// handle of this cell see it from then on, and the hand stays where it is.
    ///
    /// # Errors
    /// When either simulated cell broke down.
    pub fn exchange(&mut self, other: Self) -> Result<()> {
        let broken = || anyhow!("the simulated cell broke down");
        let mut here = self.cell.lock().map_err(|_| broken())?;
        let mut there = other.cell.lock().map_err(|_| broken())?;
        std::mem::swap(&mut *here, &mut *there);
        if let Some(hand) = there.world().hand() {
            here.place_hand(&hand.pose);
        }
        (self.scene, self.wearing) = (other.scene.clone(), other.wearing.clone());
        Ok(())
    }

    /// The cell as plugins are given it.
    pub fn world(&self) -> Arc<dyn World> {
        Arc::new(self.shared())
    }

    fn shared(&self) -> SharedCell {
        SharedCell(Arc::clone(&self.cell))
    }

    /// The judge of this cell.
    pub fn judge(&self) -> CellJudge {
        CellJudge::new(self.shared(), self.scene.clone(), self.wearing.clone())
    }

    /// What its object looks like when it is worn on this cell's head; none where there is no head.
    pub fn worn(&self) -> Option<&Worn> {
        self.wearing.as_ref().map(|wearing| &wearing.worn)
    }

    /// The worn state on this cell's head, in `world`, metres.
    ///
    /// # Errors
    /// When there is no head.
    pub fn worn_vertices(&self) -> Result<Vec<Point3<f64>>> {
        let wearing = self.wearing.as_ref().context("the scene has no head")?;
        Ok(wearing.worn.vertices.iter().map(|v| wearing.head.pose * v).collect())
    }
}

fn wearing(object: &Object, head: Head, settings: &Settings) -> Result<Wearing, Diagnostic> {
    let worn = worn_on(object, head.size, settings).map_err(|fault| {
        Diagnostic::new("O006", format!("object \"{}\": {fault}", object.name()))
            .hint("import it for another --head-circumference, or choose another object")
    })?;
    Ok(Wearing { head, worn })
}

/// What the simulated world has one form of.
fn check(scene: &Scene) -> Result<(), Diagnostic> {
    if scene.table.height_m != 0.0 {
        let cause = format!("the simulated table's top is z = 0, not {} m", scene.table.height_m);
        return Err(Diagnostic::new("C030", cause).hint("move the robot's base instead"));
    }
    Ok(())
}
