//! What a set holds, and that it is the same whoever makes it.

use super::*;
use crate::category::cap;
use nalgebra::Point3;
use seeone_core::frames::CanonicalObject;
use seeone_core::pose::PoseFields;
use std::fs;

const FRAMES: usize = 26;

fn some(number: usize) -> NonZeroUsize {
    NonZeroUsize::new(number).expect("some")
}

fn plan() -> Plan {
    let names = ["cap-train-000", "cap-unseen-07"];
    Plan {
        objects: names.map(|name| cap::named(name).expect("a cap")).to_vec(),
        frames: some(FRAMES),
        views: some(2),
        seed: 5,
        command: "test".into(),
    }
}

/// One set for all that is asked of it.
#[test]
fn a_set_is_exact_labelled_resumed_and_the_same_on_one_thread() {
    let [one, many] = [0, 1].map(|_| tempfile::tempdir().expect("a folder"));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    let first = pool.install(|| generate(&plan(), one.path(), &|_| ())).expect("made");
    generate(&plan(), many.path(), &|_| ()).expect("made");
    for name in ["frames-0000.safetensors", "frames-0001.safetensors", "index.json"] {
        let read = |folder: &Path| fs::read(folder.join(name)).expect("a file");
        assert!(read(one.path()) == read(many.path()), "{name} differs");
    }
    assert_eq!(first.frames(), FRAMES, "{first:?}");
    assert!(first.held >= 2 && first.falling >= 2 && 2 * first.resting >= FRAMES, "{first:?}");

    let again = generate(&plan(), one.path(), &|_| ()).expect("made");
    assert_eq!((first.resumed, again.resumed), (0, 2));
    assert_eq!(first, Summary { resumed: 0, ..again });
    let other = generate(&Plan { seed: 4, ..plan() }, one.path(), &|_| ()).expect_err("in the way");
    assert_eq!(other.code, "D011");

    let index = frames::read_index(one.path()).expect("an index");
    for (number, infos) in index.shards.iter().enumerate() {
        assert_eq!(infos.len(), FRAMES / 2);
        for frame in frames::read_shard(one.path(), number, infos).expect("frames") {
            labelled(&frame, &index.objects[number]);
        }
    }
}

/// The labels lie on the canonical mesh, and the pose carries them near the points.
fn labelled(frame: &Frame, object: &CanonicalObject) {
    assert!(frame.points.len() <= view::MOST_POINTS);
    for n in &frame.nocs {
        let near = object.vertices.iter().any(|v| {
            (0..3).map(|k| (v[k] - f64::from(n[k])).powi(2)).sum::<f64>() < 0.08f64.powi(2)
        });
        assert!(near, "{n:?} is far from the canonical mesh");
    }
    let resolve = |pose: &PoseFields| pose.resolve().expect("a pose");
    let (object_pose, camera) = (resolve(&frame.info.object_pose), resolve(&frame.info.camera));
    let mut off: Vec<f64> = Vec::new();
    for (p, n) in frame.points.iter().zip(&frame.nocs) {
        let p = Point3::from(p.map(f64::from));
        let canonical = n.map(|c| (f64::from(c) - 0.5) * object.edge_m);
        off.push((object_pose * Point3::from(canonical) - p).norm());
        assert!((camera.inverse() * p).z > 0.2, "in front of the camera");
    }
    off.sort_by(f64::total_cmp);
    let median = off[off.len() / 2];
    assert!(median < 0.03, "{:?}: points are {median} m from the rigid pose", frame.info);
    let lowest = frame.points.iter().map(|p| p[2]).fold(f32::INFINITY, f32::min);
    match frame.info.moment {
        Moment::Held => assert!(lowest > 0.02, "{lowest}"),
        Moment::Resting => assert!(lowest < 0.05, "{lowest}"),
        Moment::Falling => assert!(frame.info.seconds > 0.1),
    }
}

#[test]
fn frames_are_shared_out_evenly() {
    let shares = |frames| {
        let plan = Plan { frames: some(frames), ..plan() };
        (0..plan.seen()).map(|number| plan.frames_of(number)).collect::<Vec<_>>()
    };
    assert_eq!([shares(7), shares(2), shares(1)], [vec![4, 3], vec![1, 1], vec![1]]);
}
