//! Robot files and the descriptions of arms that they name.

use crate::support::{Bench, seeone};
use crate::{ROBOT, SKILL, each_is_refused, refused};

const URDF: &str = "robots/ur5-ag95.urdf";

#[test]
fn a_wrong_robot_is_told() {
    each_is_refused(
        ROBOT,
        &[
            ("syntax", "plugin", "plugin = ", "B002", ""),
            ("unknown plugin", "plugin", "plugin = \"ur5-sim\"", "B024", "ur5-ag95-sim"),
            ("missing URDF", "urdf", "urdf = \"none.urdf\"", "B024", "none.urdf"),
            ("no acceleration", "acceleration_rad_s2", "acceleration_rad_s2 = 0.0", "B020", ""),
            ("no jerk", "jerk_rad_s3", "jerk_rad_s3 = -1.0", "B020", "jerk_rad_s3"),
            ("unknown kind", "[limits]", "[config.magic]\na = 1\n[limits]", "B012", "magic"),
        ],
    );
    let changes: [(&str, &str, &str, &str, &str); 5] = [
        ("no URDF", "<robot", "<rowboat", "R002", "ur5-ag95.urdf"),
        ("lower above upper", "lower=\"-6.28", "lower=\"66.28", "R002", "upper position limit"),
        ("not finite", "lower=\"-6.28", "lower=\"NaN\" was=\"", "R002", "NaN"),
        ("unknown link", "child link=\"", "child link=\"no_", "R004", "ur5-ag95.urdf"),
        ("cut short", "</robot>", "", "R002", "ur5-ag95.urdf"),
    ];
    for (case, from, to, code, cause) in changes {
        let bench = Bench::new();
        let text = bench.text(URDF);
        assert!(text.contains(from), "{case}");
        bench.write(URDF, text.replacen(from, to, 1));
        refused(case, &bench, &bench.run(&[]), code, &[cause]);
    }
    for (case, line, code) in [
        ("home of two joints", "home_rad = [0.0, 1.0]", "R0"),
        ("home out of the limits", "home_rad = [0.0, 0.0, 9.0, 0.0, 0.0, 0.0]", "R0"),
        ("unknown tool", "tool_link = \"tpc\"", "R0"),
        ("unknown pair", "never = [[\"elbow\", \"tool0\"],", "R016"),
    ] {
        let bench = Bench::new();
        bench.set_line(ROBOT, &line[..8], line);
        let call = bench.run(&[]);
        assert_eq!(call.status, Some(2), "{case}: {}", call.stderr);
        assert!(call.stderr.contains(&format!("error[{code}")), "{case}: {}", call.stderr);
        assert!(call.stderr.contains("hint: "), "{case}: {}", call.stderr);
    }
    let bench = Bench::new();
    let skill = bench.arg(SKILL);
    let missing =
        seeone(["run", &skill, "--robot", "robots/none.toml", "--out", &bench.arg("out")]);
    refused("missing", &bench, &missing, "B001", &["robots/none.toml"]);
}
