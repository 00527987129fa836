#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use nalgebra::{Point3, Vector3};
use seeone_core::formats::ply::{Encoding, write_cloud};
use seeone_core::random::{generator, uniform};
use seeone_core::{Cloud, Diagnostic, HeadSize, Peg, Pose};
use seeone_plugin::{GripperCommand, Measure};
use std::fs;
use std::path::{Path, PathBuf};

const SKILL: &str = r#"schema = 1
name = "cap-wearing"
category = "cap"
summary = "Pick a cap from the table and put it on a head."

[demonstration]
cloud = "cap-wearing/demonstration.ply"
camera_xyz_m = [0.5, -0.7, 0.5]
frames.head = { xyz_m = [0.55, 0.30, 0.35], quat_xyzw = [0, 0, 0, 1] }

[[stage]]
name = "pick"
relative_to = "object"
gripper_pose = { xyz_m = [0.42, -0.18, 0.06], quat_xyzw = [1, 0, 0, 0] }
approach_m = 0.10
lift_m = 0.25
gripper = { close_n = 20.0 }

[[stage]]
name = "release"
relative_to = "head"
gripper_pose = { xyz_m = [0.62, 0.30, 0.38], quat_xyzw = [1, 0, 0, 0] }
gripper = { open_m = 0.06 }
retreat_m = 0.15
until_contact_n = 20.0
approach_m = 0.05

[methods]
perception = "nst"

[success]
measure = "worn"
tolerance_d = 0.1
"#;

const SCENE: &str = r#"schema = 1
name = "head"
object = "unseen"
[table]
friction = 0.6
[head]
pose = { xyz_m = [0.35, 0.4, 0.28], quat_xyzw = [0, 0, 0, 1] }
semi_axes_m = [0.077, 0.099, 0.110]
friction = 0.5
[camera]
pose = { xyz_m = [0.5, -0.7, 0.5], quat_xyzw = [0, 0, 0, 1] }
intrinsics = { width = 640, height = 480, fx = 384.0, fy = 384.0, cx = 319.5, cy = 239.5 }
[drop]
centre_xy_m = [0.45, -0.15]
half_extents_m = [0.25, 0.25]
crop_height_m = 0.3
"#;

/// A folder with a skill's cloud in it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("cap-wearing")).unwrap();
    let points = (0..200).map(|i| Point3::new(f64::from(i) * 1e-3, 0.0, 0.0)).collect();
    let cloud = Cloud::new(points).unwrap();
    let path = folder.path().join("cap-wearing/demonstration.ply");
    write_cloud(&path, &cloud, Encoding::Ascii).unwrap();
    folder
}

fn written(folder: &tempfile::TempDir, text: &str) -> PathBuf {
    let path = folder.path().join("a.toml");
    fs::write(&path, text).unwrap();
    path
}

fn known() -> KnownMethods {
    [(Kind::Perception, vec!["nst".into()]), (Kind::Robot, vec!["sim".into()])].into()
}

/// What is told of a file, without the folder's name.
fn told(folder: &tempfile::TempDir, text: &str) -> Vec<String> {
    let path = written(folder, text);
    let prefix = format!("{}/", folder.path().display());
    check(&path, &known()).iter().map(|told| told.to_string().replace(&prefix, "")).collect()
}

#[test]
fn a_skill_is_read_with_its_defaults() {
    let folder = folder();
    let path = written(&folder, SKILL);
    assert_eq!(check(&path, &known()), []);
    let skill = Skill::read(&path, &known()).unwrap();
    assert_eq!(skill.stages.len(), 2);
    let (pick, release) = (&skill.stages[0], &skill.stages[1]);
    assert_eq!(pick.gripper, Some(GripperCommand::Close { force_n: 20.0 }));
    assert_eq!((pick.opening_m, pick.turn_about_closing_deg, pick.retreat_m), (0.03, 90.0, 0.0));
    assert_eq!((pick.until_contact_n, release.until_contact_n), (None, Some(20.0)));
    assert_eq!(release.relative_to, RelativeTo::Frame("head".into()));
    assert_eq!(release.gripper, Some(GripperCommand::Open { opening_m: 0.06 }));
    assert_eq!(skill.measure, Measure::Worn { tolerance_d: 0.1 });
    assert_eq!(skill.methods[&Kind::Perception], "nst");
}

#[test]
fn a_skill_survives_writing() {
    let folder = folder();
    let mut skill = Skill::read(&written(&folder, SKILL), &known()).unwrap();
    skill.summary = "says \"so\"\nand \\ so".into();
    skill.stages[0].gripper_pose =
        Pose::new(Vector3::new(0.1, 1e-9, -0.3), Vector3::new(0.3, -0.4, 0.5));
    let text = skill.to_toml(folder.path()).unwrap();
    let again = Skill::read(&written(&folder, &text), &known()).unwrap();
    let rotation = |s: &Skill| s.stages[0].gripper_pose.rotation;
    assert!(rotation(&skill).angle_to(&rotation(&again)) < 1e-7);
    skill.stages[0].gripper_pose.rotation = rotation(&again);
    assert_eq!(again, skill);
    assert!(skill.to_toml(Path::new("/elsewhere")).is_err());
}

#[test]
fn a_scene_is_read_and_tells_frames_and_obstacles() {
    let folder = folder();
    let path = written(&folder, SCENE);
    assert_eq!(check(&path, &known()), []);
    let scene = Scene::read(&path, &known()).unwrap();
    assert_eq!(scene.table.soft_m, 0.03);
    assert_eq!(scene.frame("head").unwrap().translation.vector, Vector3::new(0.35, 0.4, 0.28));
    assert_eq!(scene.frame("hook"), None);
    assert_eq!(scene.obstacles().len(), 2);
    assert_eq!(scene.head().unwrap().size, HeadSize::MEDIUM);
    let large = SCENE.replace("semi_axes_m = [0.077, 0.099, 0.110]", "size = \"large\"");
    let scene = Scene::read(&written(&folder, &large), &known()).unwrap();
    assert_eq!(scene.head().unwrap().size, HeadSize::LARGE);
    let table = scene.camera_table();
    assert_eq!(table["intrinsics"]["width"].as_integer(), Some(640));
    assert_eq!(table["crop"]["floor_m"].as_float(), Some(0.0));
}

#[test]
fn a_scene_has_a_head_or_a_hook_or_both() {
    let folder = folder();
    let hook =
        "[hook]\npose = { xyz_m = [0.35, 0.6, 0.3], quat_xyzw = [0, 0, 1, 0] }\nfriction = 0.3\n";
    let (before, rest) = SCENE.split_once("[head]").unwrap();
    let (head, after) = rest.split_once("[camera]").unwrap();
    let with = |targets: &str| format!("{before}{targets}[camera]{after}");
    let alone = Scene::read(&written(&folder, &with(hook)), &known()).unwrap();
    assert_eq!((alone.head(), alone.frame("head")), (None, None));
    assert_eq!(alone.hook().unwrap().peg, Peg::COAT);
    assert_eq!(alone.frame("hook").unwrap().translation.vector, Vector3::new(0.35, 0.6, 0.3));
    // Table, peg and wall.
    assert_eq!(alone.obstacles().len(), 3);
    let both = format!("[head]{head}{hook}length_m = 0.12\n[frames]\n")
        + "person = { xyz_m = [0.6, 0.3, 0.4], quat_xyzw = [0, 0, 0, 1] }\n";
    let both = Scene::read(&written(&folder, &with(&both)), &known()).unwrap();
    assert!(both.head().is_some() && both.obstacles().len() == 4);
    assert_eq!(both.hook().unwrap().peg, Peg::of_length(0.12).unwrap());
    assert_eq!(both.frame("person").unwrap().translation.vector, Vector3::new(0.6, 0.3, 0.4));
    assert_eq!(
        told(&folder, &with("")),
        ["error[C011]: a.toml:1:1: the scene has neither a [head] nor a [hook]"]
    );
}

#[test]
fn every_measure_survives_writing_with_its_own_keys_alone() {
    let folder = folder();
    let with = |success: &str| {
        let (before, _) = SKILL.split_once("measure =").unwrap();
        format!("{before}{success}\n")
    };
    let held = Measure::Held { frame: "head".into(), within_m: 0.05 };
    for (success, measure) in [
        ("measure = \"hung\"", Measure::Hung),
        ("measure = \"held\"\nat = \"head\"\nwithin_m = 0.05", held),
    ] {
        let skill = Skill::read(&written(&folder, &with(success)), &known()).unwrap();
        assert_eq!(skill.measure, measure);
        let text = skill.to_toml(folder.path()).unwrap();
        assert_eq!(Skill::read(&written(&folder, &text), &known()).unwrap().measure, measure);
    }
    for (success, code, cause) in [
        (
            "measure = \"hung\"\ntolerance_d = 0.1",
            "S012",
            "the measure \"hung\" has no tolerance_d",
        ),
        ("measure = \"worn\"", "S011", "the measure \"worn\" needs tolerance_d"),
        ("measure = \"held\"\nat = \"head\"", "S011", "the measure \"held\" needs within_m"),
        ("measure = \"held\"\nat = \"hed\"\nwithin_m = 0.1", "S024", "no frame \"hed\""),
        ("measure = \"held\"\nat = \"head\"\nwithin_m = 2.0", "S020", "within_m = 2"),
        ("measure = \"hang\"", "S024", "did you mean \"hung\"?"),
    ] {
        let told = told(&folder, &with(success));
        let one = told.len() == 1 && told[0].contains(code) && told[0].contains(cause);
        assert!(one, "{success}: {told:?}");
    }
}

#[test]
fn faults_of_a_skill_are_told_with_place_and_hint() {
    let folder = folder();
    let cases: &[(&str, &str, &str)] = &[
        (
            "retreat_m",
            "retreet_m",
            "error[S012]: a.toml:24:1: unknown key \"retreet_m\"\n\nhint: did you mean \"retreat_m\"?",
        ),
        ("lift_m = 0.25", "lift_m = nan", "error[S003]: a.toml:16:10: nan is not a finite number"),
        ("lift_m = 0.25", "lift_m = 1e400", "error[S0"),
        (
            "lift_m = 0.25",
            "lift_m = \"high\"",
            "error[S013]: a.toml:16:10: invalid type: string \"high\", expected a number",
        ),
        (
            "lift_m = 0.25",
            "lift_m = 2.5",
            "error[S020]: a.toml:16:10: lift_m = 2.5, but it must lie in 0 to 0.5",
        ),
        (
            "approach_m = 0.05",
            "",
            "error[S023]: a.toml:25:19: no straight line leads to this pose on which contact",
        ),
        (
            "until_contact_n = 20.0",
            "until_contact_n = 0.0",
            "error[S020]: a.toml:25:19: until_contact_n = 0, but it must lie in 1 to 50",
        ),
        ("lift_m = 0.25", "lift_m = ", "error[S002]: a.toml:16:10:"),
        ("schema = 1", "schema = 2", "error[S010]: a.toml:1:10: this schema is not known"),
        ("schema = 1", "", "error[S010]: a.toml:1:1: the file does not say its schema"),
        ("name = \"cap-wearing\"", "", "error[S011]: a.toml:1:1: the key \"name\" is missing"),
        ("\"cap-wearing\"", "\"../Cap\"", "error[S021]: a.toml:2:8:"),
        (
            "[1, 0, 0, 0]",
            "[1, 1, 0, 0]",
            "error[S022]: a.toml:14:16: gripper_pose: the quaternion has length 1.4142",
        ),
        (
            "relative_to = \"object\"",
            "relative_to = \"head\"",
            "error[S023]: a.toml:13:15: the first stage",
        ),
        (
            "relative_to = \"head\"",
            "relative_to = \"haed\"",
            "error[S024]: a.toml:21:15: the demonstration has no frame \"haed\"\n\nhint: did you mean \"head\"?",
        ),
        (
            "name = \"release\"",
            "name = \"pick\"",
            "error[S021]: a.toml:20:8: a second stage is named \"pick\"",
        ),
        ("close_n = 20.0", "close_n = 20.0, open_m = 0.01", "error[S023]: a.toml:17:11:"),
        (
            "\"nst\"",
            "\"nts\"",
            "error[S024]: a.toml:29:14: there is no perception plugin \"nts\"\n\nhint: did you mean \"nst\"?",
        ),
        ("perception =", "robot =", "error[S012]: a.toml:29:1: unknown key \"robot\""),
        ("\"worn\"", "\"wron\"", "error[S024]: a.toml:32:11: there is no measure \"wron\""),
        ("cap-wearing/demonstration.ply", "../elsewhere.ply", "error[S024]: a.toml:7:9: cloud"),
        (
            "cap-wearing/demonstration.ply",
            "cap-wearing/none.ply",
            "error[S024]: a.toml:7:9: cloud: there is no file",
        ),
        ("cap-wearing/demonstration.ply", "a.toml", "error[P002]: a.toml:1:1: not a PLY file"),
    ];
    for (from, to, expected) in cases {
        let text = SKILL.replacen(from, to, 1);
        assert_ne!(text, SKILL, "{from}");
        let told = told(&folder, &text);
        assert_eq!(told.len(), 1, "{from} -> {to}: {told:?}");
        assert!(told[0].starts_with(expected), "{from} -> {to}:\n{}", told[0]);
    }
}

#[test]
fn every_fault_of_a_file_is_told_at_once() {
    let folder = folder();
    let text = SKILL.replace("= 0.10", "= 7.0").replace("= 0.25", "= -1.0").replace("worn", "won");
    assert_eq!(told(&folder, &text).len(), 3);
    assert_eq!(told(&folder, &SKILL.replace("0.25", "inf").replace("0.10", "-nan")).len(), 2);
}

#[test]
fn a_skill_without_stages_is_refused() {
    let folder = folder();
    let begin = SKILL.find("[[stage]]").unwrap();
    let text = format!("{}{}", &SKILL[..begin], &SKILL[SKILL.find("[methods]").unwrap()..]);
    assert!(
        told(&folder, &text)[0].contains("error[S023]: a.toml:1:1: the skill has no [[stage]]")
    );
}

#[test]
fn faults_of_a_scene_are_told() {
    let folder = folder();
    let cases = [
        ("[camera]", "[camra]", "error[C012]: a.toml:10:2: unknown key \"camra\""),
        ("width = 640", "width = 0", "error[C020]: a.toml:12:14: an image of 0 x 480 pixels"),
        ("width = 640", "width = -1", "error[C013]: a.toml:12:24:"),
        ("0.077", "0.0", "error[C020]: a.toml:8:15: semi_axes_m = 0"),
        (
            "semi_axes_m = [0.077, 0.099, 0.110]",
            "size = \"larg\"",
            "error[C024]: a.toml:8:8: there is no head of the size \"larg\"\n\nhint: did you mean \"large\"?",
        ),
        (
            "semi_axes_m = [0.077, 0.099, 0.110]",
            "size = \"large\"\nsemi_axes_m = [0.077, 0.099, 0.110]",
            "error[C023]: a.toml:9:15: the head has a size already",
        ),
        (
            "semi_axes_m = [0.077, 0.099, 0.110]",
            "",
            "error[C011]: a.toml:7:8: the head has neither a size nor semi_axes_m",
        ),
        ("friction = 0.5", "friction = inf", "error[C003]: a.toml:9:12"),
    ];
    for (from, to, expected) in cases {
        let told = told(&folder, &SCENE.replacen(from, to, 1));
        assert!(told[0].starts_with(expected), "{from} -> {to}:\n{}", told[0]);
    }
}

#[test]
fn a_robot_file_is_read_and_its_faults_are_told() {
    let folder = folder();
    fs::write(folder.path().join("a.urdf"), "<robot name='a'/>").unwrap();
    let text = "schema = 1\nname = \"a\"\nplugin = \"sim\"\nurdf = \"a.urdf\"\n\
                home_rad = [0.0, 1.0]\n[limits]\nacceleration_rad_s2 = 5.0\n\
                [config.motion]\nspeed = 0.5\n";
    let path = written(&folder, text);
    let robot = RobotFile::read(&path, &known()).unwrap();
    assert_eq!(robot.options.acceleration, 5.0);
    assert_eq!(robot.options.home, Some(vec![0.0, 1.0]));
    assert_eq!(robot.config[&Kind::Motion]["speed"].as_float(), Some(0.5));
    assert!(told(&folder, text)[0].starts_with("error[R0"), "the arm itself is checked too");
    let cases = [
        ("\"sim\"", "\"sin\"", "error[B024]: a.toml:3:10: there is no robot plugin \"sin\""),
        ("config.motion", "config.moton", "error[B012]: a.toml:8:9: there is no plugin kind"),
        ("\"a.urdf\"", "\"b.urdf\"", "error[B024]: a.toml:4:8: urdf: there is no file"),
    ];
    for (from, to, expected) in cases {
        let told = told(&folder, &text.replacen(from, to, 1));
        assert!(told[0].starts_with(expected), "{from} -> {to}:\n{}", told[0]);
    }
}

#[test]
fn a_file_that_cannot_be_one_is_refused() {
    let folder = folder();
    assert!(told(&folder, "schema = 1\n")[0].contains("error[F001]"));
    let path = folder.path().join("large.toml");
    fs::write(&path, vec![b'#'; (1 << 20) + 1]).unwrap();
    let told =
        |path: &Path| check(path, &known()).iter().map(Diagnostic::to_string).collect::<String>();
    assert!(told(&path).contains("but a file may have 1048576"));
    fs::write(&path, [0xff, 0xfe]).unwrap();
    assert!(told(&path).contains("byte 0 is not UTF-8"));
    assert!(told(&folder.path().join("none.toml")).contains("error[S001]"));
}

/// A file cut anywhere is either valid or told; nothing panics.
#[test]
fn a_file_cut_short_anywhere_is_told() {
    let folder = folder();
    for cut in 0..SKILL.len() - 1 {
        let told = told(&folder, &SKILL[..cut]);
        let tolerance_cut = SKILL[..cut].ends_with("tolerance_d = 0.1");
        assert!(!told.is_empty() || tolerance_cut, "accepted:\n{}", &SKILL[..cut]);
    }
}

/// A file with one character changed is either told or still means something finite;
/// nothing panics.
#[test]
fn a_changed_character_is_told_or_harmless() {
    let folder = folder();
    let mut rng = generator(5, "changed characters");
    let mut accepted = 0;
    for _ in 0..1000 {
        let mut text = SKILL.as_bytes().to_vec();
        let at = uniform(&mut rng, 0.0, text.len() as f64) as usize;
        text[at] = uniform(&mut rng, 32.0, 127.0) as u8;
        let path = written(&folder, std::str::from_utf8(&text).unwrap());
        if let Ok(skill) = Skill::read(&path, &known()) {
            accepted += 1;
            assert!(skill.stages.iter().all(|stage| {
                stage.gripper_pose.to_homogeneous().iter().all(|v| v.is_finite())
                    && (0.0..=0.5).contains(&stage.lift_m)
            }));
        }
    }
    assert!((30..900).contains(&accepted), "{accepted} of 1000 accepted");
}

#[test]
fn a_task_is_read_with_the_skills_it_names() {
    let folder = folder();
    fs::write(folder.path().join("wear.toml"), SKILL).unwrap();
    fs::create_dir(folder.path().join("tasks")).unwrap();
    let text = "schema = 1\nname = \"dress\"\n[[step]]\nname = \"any-way\"\ntries = 2\n\
                [[step.fallback]]\nname = \"one\"\nskill = \"wear\"\nrequire = [\"hand-empty\"]\n\
                for_each_object = [\"a\", \"b\"]\ntargets = { head = \"stand\" }\n\
                [[step.fallback]]\nname = \"other\"\nskill = \"wear\"\n\
                methods = { perception = \"nst\", transfer = \"snap\" }\n";
    let path = folder.path().join("tasks/a.toml");
    fs::write(&path, text).unwrap();
    assert_eq!(check(&path, &known()), []);
    let task = Task::read(&path, &known()).unwrap();
    assert_eq!((task.steps.len(), task.steps[0].tries), (1, 2));
    let Work::Fallback(ways) = &task.steps[0].work else { panic!("{task:?}") };
    assert_eq!(ways[0].objects, ["a", "b"]);
    assert_eq!(task.objects(), ["a", "b"]);
    let [one, other] = task.uses()[..] else { panic!("{task:?}") };
    assert_eq!(one.requires, [crate::run::Precondition::HandEmpty]);
    assert_eq!(one.targets["head"], "stand");
    assert_eq!(one.path, folder.path().join("wear.toml"));
    assert_eq!(one.skill.methods.get(&Kind::Transfer), None);
    assert_eq!(other.skill.methods[&Kind::Transfer], "snap");
}
