use super::*;
use nalgebra::Point3;

fn cloud() -> Cloud {
    let points = vec![Point3::new(0.1, -0.2, 0.3), Point3::new(1e-9, 2.5, -7.0)];
    Cloud::new(points).expect("finite")
}

fn told(text: &str) -> String {
    match parse_cloud(text.as_bytes(), Path::new("a.ply")) {
        Ok(_) => "accepted".into(),
        Err(diagnostic) => diagnostic.to_string(),
    }
}

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 2\n\
                      property float x\nproperty float y\nproperty float z\n";

#[test]
fn both_encodings_give_the_same_cloud_back_to_the_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    for encoding in [Encoding::Ascii, Encoding::BinaryLittleEndian] {
        let path = folder.path().join("a.ply");
        write_cloud(&path, &cloud(), encoding).expect("written");
        assert_eq!(read_cloud(&path).expect("read"), cloud());
    }
}

#[test]
fn passes_over_other_properties_and_elements() {
    let mut bytes = b"ply\r\nformat binary_little_endian 1.0\nelement vertex 1\n\
        property uchar red\nproperty float x\nproperty float y\nproperty short s\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    bytes.push(9);
    bytes.extend(1.0f32.to_le_bytes());
    bytes.extend(2.0f32.to_le_bytes());
    bytes.extend(5i16.to_le_bytes());
    bytes.extend(3.0f32.to_le_bytes());
    bytes.extend([3, 0, 0, 0, 0]);
    let cloud = parse_cloud(&bytes, Path::new("a.ply")).expect("read");
    assert_eq!(cloud.points(), [Point3::new(1.0, 2.0, 3.0)]);
}

#[test]
fn a_count_that_the_file_does_not_hold_is_refused() {
    let bytes = cloud_bytes(&cloud(), Encoding::BinaryLittleEndian);
    for cut in 1..48 {
        let told = parse_cloud(&bytes[..bytes.len() - cut], Path::new("a.ply")).expect_err("cut");
        assert_eq!(told.code, "P003", "{told}");
    }
    let huge = "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\n\
                property float x\nproperty float y\nproperty float z\nend_header\nabc";
    assert!(told(huge).contains("declares 99999999999 points, the file holds 0"));
    assert!(told(&format!("{HEADER}end_header\n1 2 3\n")).contains("P003"));
    assert!(told(&format!("{HEADER}end_header\n1 2 3\n4 5 6\n7 8 9\n")).contains("P003"));
}

#[test]
fn a_fault_is_told_with_its_line() {
    let cases = [
        ("obj\n", "a.ply:1:1: not a PLY file"),
        ("ply\nformat ascii 2.0\n", "a.ply:2:1:"),
        ("ply\nelement face 2\n", "a.ply:2:1: the vertices must be the first element"),
        (HEADER, "does not end with"),
        (&format!("{HEADER}end_header\n1 2 3\n4 nan 6\n"), "a.ply:9:1: \"nan\" is no finite"),
        (&format!("{HEADER}end_header\n1 2 3\n4 6\n"), "a.ply:9:1: 2 numbers"),
        ("ply\nformat ascii 1.0\nelement vertex 0\nproperty quad x\n", "a.ply:4:1: unknown number"),
        (
            "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n",
            "property \"y\"",
        ),
    ];
    for (text, expected) in cases {
        let told = told(text);
        assert!(told.contains(expected), "{told}");
    }
}
