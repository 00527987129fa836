//! Ten thousand spoilt files: each is either taken with every value finite and in its range, or
//! refused with a place. Nothing panics.

use seeone_core::random::{Generator, generator, uniform};
use seeone_core::{Diagnostic, Pose};
use seeone_plugin::{GripperCommand, Kind, Measure};
use seeone_runtime::files::{RobotFile, Scene, Skill, Stage, Task, TaskStep, Work};
use seeone_runtime::{Family, KnownMethods};
use std::fs;
use std::path::{Path, PathBuf};

/// The sound files that are spoilt.
const FILES: [(&str, Family); 10] = [
    ("skills/cap-wearing.toml", Family::Skill),
    ("skills/cap-handing-over.toml", Family::Skill),
    ("skills/cap-hanging.toml", Family::Skill),
    ("skills/tasks/dress.toml", Family::Task),
    ("skills/tasks/tidy-caps.toml", Family::Task),
    ("scenes/head.toml", Family::Scene),
    ("scenes/hook.toml", Family::Scene),
    ("scenes/hooks.toml", Family::Scene),
    ("robots/ur5-ag95-sim.toml", Family::Robot),
    ("skills/tasks/every-way.toml", Family::Task),
];
const SPOILT: usize = 10_000;

/// A task with every composition.
const EVERY_WAY: &str = "schema = 1
name = \"every-way\"
[[step]]
name = \"caps\"
for_each_object = [\"cap-unseen-01\", \"cap-unseen-02\"]
tries = 2
[[step.fallback]]
name = \"one\"
skill = \"cap-wearing\"
require = [\"object-visible\"]
targets = { head = \"head\" }
[[step.fallback]]
name = \"both\"
[[step.fallback.sequence]]
name = \"first\"
skill = \"cap-wearing\"
methods = { transfer = \"snap\" }
[[step.fallback.sequence]]
name = \"second\"
object = \"cap-unseen-03\"
skill = \"cap-wearing\"
";

/// What a value or a key may be replaced by.
const ODD: [&str; 36] = [
    "nan",
    "-nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e309",
    "1e-320",
    "0",
    "-0.0",
    "-1",
    "0x10",
    "9223372036854775807",
    "9223372036854775808",
    "true",
    "\"\"",
    "\"text\"",
    "\"\\u0000\"",
    "[]",
    "[[]]",
    "[1.0]",
    "[0, 0, 0]",
    "[1e300, 1e300, 1e300]",
    "{}",
    "{ a = 1 }",
    "1979-05-27",
    "''",
    "\"../../etc/passwd\"",
    "\"/\"",
    "\"object\"",
    "\"head\"",
    "0.5",
    "1",
    "20",
    "\"é\"",
    "# gone",
];

#[test]
fn a_spoilt_file_is_taken_whole_or_refused_with_a_place() {
    let folder = copies();
    let known: KnownMethods = [
        (Kind::Transfer, vec!["feature-match".to_owned(), "snap".to_owned()]),
        (Kind::Robot, vec!["ur5-ag95-sim".to_owned()]),
    ]
    .into();
    let sound: Vec<String> = FILES
        .iter()
        .map(|(name, _)| fs::read_to_string(folder.path().join(name)).expect("a file"))
        .collect();
    let mut rng = generator(11, "spoilt files");
    let (mut taken, mut refused) = (0, 0);
    for index in 0..SPOILT {
        let which = index % FILES.len();
        let (name, family) = FILES[which];
        let text = spoilt(&sound[which], &mut rng);
        let path =
            folder.path().join(Path::new(name).parent().expect("a folder")).join("spoilt.toml");
        fs::write(&path, &text).expect("a written file");
        match read(family, &path, &known) {
            Ok(()) => taken += 1,
            Err(faults) => {
                refused += 1;
                assert!(!faults.is_empty(), "no fault is told of:\n{text}");
                for fault in faults {
                    let place = fault.place.as_ref().expect("a fault lies in a file");
                    let located = place.at.is_some_and(|(line, column)| line > 0 && column > 0);
                    // A file that cannot be read at all, and a URDF's faults, have no line.
                    let whole = fault.code.ends_with("001") || fault.code.starts_with('R');
                    assert!(located || whole, "{fault}\n{text}");
                }
            }
        }
    }
    assert!(taken > SPOILT / 20 && refused > SPOILT / 4, "{taken} taken, {refused} refused");
}

/// A folder with copies of the sound files and of what they name.
fn copies() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let repository = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let others = [
        "skills/cap-wearing/demonstration.ply",
        "skills/cap-wearing/result.ply",
        "skills/cap-handing-over/demonstration.ply",
        "skills/cap-hanging/demonstration.ply",
        "robots/ur5-ag95.urdf",
    ];
    for name in FILES.iter().map(|(name, _)| *name).chain(others) {
        let to = folder.path().join(name);
        fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        match fs::copy(repository.join(name), &to) {
            Ok(_) => {}
            Err(_) => fs::write(&to, EVERY_WAY).expect("a written file"),
        }
    }
    folder
}

/// One to three changes of a text.
fn spoilt(text: &str, rng: &mut Generator) -> String {
    let mut text = text.to_owned();
    for _ in 0..=pick(rng, 3) {
        text = changed(&text, rng);
    }
    text
}

fn changed(text: &str, rng: &mut Generator) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return ODD[pick(rng, ODD.len())].to_owned();
    }
    let (at, other) = (pick(rng, lines.len()), pick(rng, lines.len()));
    match pick(rng, 8) {
        0 => _ = lines.remove(at),
        1 => lines.insert(other, lines[at].clone()),
        2 => lines.swap(at, other),
        3 => lines.truncate(at),
        // A value for another.
        4 | 5 => {
            let key = lines[at].split('=').next().unwrap_or_default().to_owned();
            lines[at] = format!("{key}= {}", ODD[pick(rng, ODD.len())]);
        }
        // A number within a line for another.
        6 => {
            let numbers: Vec<(usize, &str)> =
                lines[at].match_indices(|c: char| c.is_ascii_digit()).collect();
            if let Some((begin, _)) = numbers.get(pick(rng, numbers.len().max(1))) {
                let odd = ODD[pick(rng, ODD.len())];
                lines[at] = format!("{}{odd}{}", &lines[at][..*begin], &lines[at][begin + 1..]);
            }
        }
        // A character for another.
        _ => {
            let mut characters: Vec<char> = lines[at].chars().collect();
            if !characters.is_empty() {
                let which = pick(rng, characters.len());
                characters[which] = char::from(32 + pick(rng, 95) as u8);
            }
            lines[at] = characters.into_iter().collect();
        }
    }
    lines.join("\n") + "\n"
}

fn pick(rng: &mut Generator, below: usize) -> usize {
    uniform(rng, 0.0, below as f64) as usize
}

/// Reads a file, and looks at every value of one that is taken.
fn read(family: Family, path: &Path, known: &KnownMethods) -> Result<(), Vec<Diagnostic>> {
    match family {
        Family::Skill => skill(&Skill::read(path, known)?),
        Family::Task => task(&Task::read(path, known)?),
        Family::Scene => scene(&Scene::read(path, known)?),
        Family::Robot => {
            let file = RobotFile::read(path, known)?;
            robot(&file);
            let model = file.model().map_err(|fault| vec![fault])?;
            assert!(model.tool_pose(model.home()).to_homogeneous().iter().all(|v| v.is_finite()));
        }
    }
    Ok(())
}

fn skill(skill: &Skill) {
    assert!(!skill.stages.is_empty());
    let camera = skill.demonstration.camera_position;
    assert!(camera.iter().all(|v| v.abs() <= 10.0));
    skill.demonstration.frames.values().for_each(pose);
    for Stage { gripper_pose, approach_m, opening_m, retreat_m, lift_m, gripper, .. } in
        &skill.stages
    {
        pose(gripper_pose);
        [approach_m, retreat_m, lift_m].into_iter().for_each(|line| within(*line, 0.0, 0.5));
        within(*opening_m, 0.0, 0.2);
        match gripper {
            Some(GripperCommand::Close { force_n }) => within(*force_n, 0.0, 200.0),
            Some(GripperCommand::Open { opening_m }) => within(*opening_m, 0.0, 0.2),
            None => {}
        }
    }
    for stage in &skill.stages {
        within(stage.turn_about_closing_deg, 0.0, 180.0);
        stage.until_contact_n.iter().for_each(|force| within(*force, 1.0, 50.0));
    }
    if let Some(result) = &skill.result {
        within(result.within_m, 1e-3, 1.0);
        within(result.within_deg, 1.0, 180.0);
        assert!(skill.demonstration.frames.contains_key(&result.frame));
    }
    match &skill.measure {
        Measure::Worn { tolerance_d: share } => within(*share, 1e-3, 1.0),
        Measure::Held { within_m, .. } => within(*within_m, 1e-3, 1.0),
        Measure::Hung => {}
    }
}

fn task(task: &Task) {
    assert!(!task.steps.is_empty());
    task.uses().iter().for_each(|used| skill(&used.skill));
    task.steps.iter().for_each(step);
}

fn step(of: &TaskStep) {
    within(of.tries as f64, 1.0, 20.0);
    assert!(of.objects.len() <= 100);
    let steps = of.work.steps();
    assert_eq!(steps.is_empty(), matches!(of.work, Work::Skill(_)));
    steps.iter().for_each(step);
}

fn scene(scene: &Scene) {
    within(scene.table.height_m, -5.0, 5.0);
    within(scene.table.soft_m, 0.0, 0.2);
    within(scene.table.friction, 0.0, 2.0);
    pose(&scene.camera);
    scene.places.values().for_each(pose);
    if let Some(head) = scene.head() {
        pose(&head.pose);
        within(head.friction, 0.0, 2.0);
        head.size.semi_axes_m().iter().for_each(|axis| within(*axis, 0.05, 0.15));
    }
    for hook in scene.hooks() {
        pose(&hook.pose);
        within(hook.friction, 0.0, 2.0);
        within(hook.peg.length_m(), 0.06, 0.16);
    }
    let lens = &scene.intrinsics;
    [lens.fx, lens.fy].into_iter().for_each(|focal| within(focal, 1.0, 1e5));
    [lens.cx, lens.cy].into_iter().for_each(|point| within(point, -1e5, 1e5));
    assert!((1..=4 << 20).contains(&(lens.width * lens.height)));
    scene.drop.centre.iter().for_each(|v| within(*v, -5.0, 5.0));
    scene.drop.half_extents_m.iter().for_each(|v| within(*v, 0.01, 5.0));
    within(scene.drop.crop_height_m, 0.01, 5.0);
    scene.drop.apart_m.iter().for_each(|apart| within(*apart, 0.01, 1.0));
    assert!(scene.beside.is_empty() || scene.head().is_none());
    for one in &scene.beside {
        one.centre.iter().for_each(|v| within(*v, -5.0, 5.0));
    }
    scene.standing.iter().for_each(|solid| pose(&solid.pose));
}

fn robot(robot: &RobotFile) {
    let options = &robot.options;
    pose(&options.base);
    within(options.acceleration, 0.1, 100.0);
    within(options.jerk, 1.0, 1e5);
    options.home.iter().flatten().for_each(|q| within(*q, -100.0, 100.0));
    options.gripper.force_n.iter().for_each(|force| within(*force, 0.0, 1e4));
    for (opening_m, reach_m) in &options.gripper.reach_m {
        within(*opening_m, 0.0, 1.0);
        within(*reach_m, 0.0, 1.0);
    }
}

fn pose(pose: &Pose) {
    pose.translation.vector.iter().for_each(|v| within(*v, -10.0, 10.0));
    assert!((pose.rotation.norm() - 1.0).abs() < 1e-9, "{}", pose.rotation);
}

fn within(value: f64, low: f64, high: f64) {
    assert!((low..=high).contains(&value), "{value} is not in {low} to {high}");
}
