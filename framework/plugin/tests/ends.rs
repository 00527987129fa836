//! The suite catches plugins that do not end when they are asked to.

use seeone_core::robot::RobotModel;
use seeone_plugin::conformance::{self, StillWorld, arm};
use seeone_plugin::{
    Action, Felt, IkQuery, IkStatus, JointTrajectory, Kinematics, Motion, MotionOutcome,
    MotionTask, PluginError, Program, Robot, RobotSample, RobotState, Watch, World, motion::Step,
};

/// A planner without obstacles that goes straight from posture to posture.
struct Straight {
    /// What it makes of an error of the kinematics.
    after: fn(&dyn Kinematics, &RobotModel, PluginError) -> Result<MotionOutcome, PluginError>,
}

impl Motion for Straight {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        task.check(robot)?;
        let (mut at, mut steps) = (task.start.to_vec(), Vec::new());
        for key in task.key_poses {
            let stage = key.stage.clone();
            let found = match kinematics.solve(robot, &IkQuery::new(&key.pose, &at)) {
                Ok(found) => found,
                Err(error) => return (self.after)(kinematics, robot, error),
            };
            if found.status == IkStatus::Infeasible {
                let reason = found.reason.unwrap_or_default();
                return Ok(MotionOutcome::Infeasible { stage, reason });
            }
            let positions = vec![std::mem::replace(&mut at, found.joints.clone()), found.joints];
            let moved = Action::Move(JointTrajectory { period_s: 2.0, positions });
            steps.push(Step { stage: stage.clone(), purpose: "transit", action: moved });
            let grip = key.gripper.map(Action::Grip);
            steps.extend(grip.map(|action| Step { stage, purpose: "grip", action }));
        }
        Ok(MotionOutcome::Planned { program: Program { steps }, cost: 0.0 })
    }
}

#[test]
fn a_planner_that_goes_on_without_its_kinematics_is_caught() {
    let ends = Straight { after: |_, _, error| Err(error) };
    conformance::motion(&ends).expect("conforms");
    let answers = Straight {
        after: |_, _, error| {
            let (stage, reason) = ("take".into(), error.to_string());
            Ok(MotionOutcome::Infeasible { stage, reason })
        },
    };
    let caught = conformance::motion(&answers).expect_err("it answers");
    assert_eq!(caught.rule, "a plan ends with the error of its kinematics", "{caught}");
    let asks_again = Straight {
        after: |kinematics, robot, error| {
            let target = robot.tool_pose(robot.home());
            kinematics.solve(robot, &IkQuery::new(&target, robot.home())).and(Err(error))
        },
    };
    let caught = conformance::motion(&asks_again).expect_err("it asks again");
    assert_eq!(caught.rule, "kinematics that want an end are asked no more", "{caught}");
}

/// An arm that is where its trajectory is.
struct Placed {
    world: StillWorld,
    model: RobotModel,
    joints: Vec<f64>,
    heeds: Heeds,
}

/// Which wish to end it hears.
#[derive(Clone, Copy, PartialEq)]
enum Heeds {
    Every,
    /// It goes on to the end, and tells the watcher's error then.
    AtItsEnd,
    /// It ends, and says that all is well.
    Silently,
    /// It does not stand when it is told to.
    NoStop,
}

impl Robot for Placed {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        let opening_m = self.world.state()?.opening_m;
        Ok(RobotState { joints: self.joints.clone(), opening_m })
    }

    fn execute(&mut self, action: &Action, watch: &mut Watch) -> Result<Felt, PluginError> {
        let mut ended = Ok(());
        match action {
            Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => {
                trajectory.check_from(&self.model, &self.joints, 0.02)?;
                for joints in &trajectory.positions {
                    self.joints.clone_from(joints);
                    self.world.advance(&self.model.tool_pose(joints))?;
                    let (time_s, state) = (self.world.state()?.time_s, self.state()?);
                    ended = ended.and_then(|()| watch(&RobotSample { time_s, state }));
                    if ended.is_err() && self.heeds != Heeds::AtItsEnd {
                        break;
                    }
                }
            }
            Action::Grip(command) => self.world.grip(*command)?,
        }
        if self.heeds != Heeds::Silently {
            ended?;
        }
        let opening_m = self.world.state()?.opening_m;
        Ok(Felt { opening_m, holding: false, contact: false })
    }

    fn stop(&mut self) -> Result<(), PluginError> {
        if self.heeds == Heeds::NoStop {
            self.joints[0] += 0.01;
        }
        Ok(())
    }
}

#[test]
fn a_robot_that_does_not_end_when_it_is_asked_to_is_caught() {
    let model = arm();
    let held = |heeds: Heeds| {
        conformance::robot(&model, &|| {
            let (world, joints) = (StillWorld::default(), model.home().to_vec());
            Ok(Box::new(Placed { world, model: model.clone(), joints, heeds }))
        })
    };
    held(Heeds::Every).expect("conforms");
    let ends = "an action ends when the watcher asks for it, with the watcher's error";
    for (heeds, rule) in [
        (Heeds::AtItsEnd, "a robot that was interrupted is on its way, and not at its end"),
        (Heeds::Silently, ends),
        (Heeds::NoStop, "a robot that is stopped holds its position"),
    ] {
        let caught = held(heeds).expect_err(rule);
        assert_eq!(caught.rule, rule, "{caught}");
    }
}
