//! General advice by the code of a fault, for faults whose finder knew none in particular.

use seeone_core::Diagnostic;

/// The fault with advice: its own, or else what helps with any fault of its code.
pub fn complete(fault: Diagnostic) -> Diagnostic {
    match (&fault.hint, general(fault.code)) {
        (None, Some(advice)) => fault.hint(advice),
        _ => fault,
    }
}

fn general(code: &str) -> Option<&'static str> {
    let (family, number) = code.split_at_checked(1)?;
    match (family, number) {
        ("S" | "T" | "C" | "B", number) => file(number),
        ("R", _) => Some("mend the URDF, or the robot file that names its links and joints"),
        ("P", _) => Some("give a PLY cloud such as `seeone teach` writes"),
        ("I", "001") => Some("name a JSON file of at most 64 MiB that is there and may be read"),
        ("I", "003") => Some("write finite numbers: JSON knows neither NaN nor Infinity"),
        ("I", "005") => Some(
            "a pose is [[r, r, r, x], [r, r, r, y], [r, r, r, z], [0, 0, 0, 1]], metres, its rotation orthonormal",
        ),
        ("I", _) => Some("see `seeone ik --help` for what the file holds"),
        ("L", _) => Some("give a plugin's library with the manifest of `seeone plugins trust`"),
        ("O", "004") => Some("make object files with `seeone objects import`"),
        ("O", _) => Some("see `seeone objects import --help`"),
        ("M", "001" | "003") => Some("see `seeone plugins list`"),
        ("M", "002") => Some(
            "mend what it names, or its table: [config.KIND] of the robot file, [camera] of the scene",
        ),
        ("M", "005") => Some("choose another scene with --scene"),
        ("N", "003") => Some("name another place with --out"),
        ("N" | "W", _) => Some("make weights with `seeone train`"),
        ("F", "001") => Some(
            "skills, tasks, scenes, robots, objects, clouds, weights and libraries are checked",
        ),
        _ => None,
    }
}

/// The files that a user writes share the numbers of their faults.
fn file(number: &str) -> Option<&'static str> {
    Some(match number {
        "001" => "name a text file of at most 1 MiB that is there and may be read",
        "002" => "the file is TOML; compare it with one that came with seeone",
        "003" => "write a finite number",
        "011" | "012" | "013" | "023" => "compare the file with one that came with seeone",
        "020" => "choose a value within the range",
        "021" => "rename it",
        "022" => "a pose is { xyz_m = [x, y, z], quat_xyzw = [x, y, z, w] }, of unit length",
        "030" => "compare the table with what the plugin's source documents of it",
        "024" => "paths are relative to the folder of the file that names them",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_of_the_finder_goes_before_general_advice() {
        let hint = |fault| complete(fault).hint.unwrap_or_default();
        assert_eq!(hint(Diagnostic::new("S003", "nan")), "write a finite number");
        assert_eq!(hint(Diagnostic::new("S003", "nan").hint("mine")), "mine");
        assert_eq!(hint(Diagnostic::new("X999", "unheard of")), "");
    }
}
