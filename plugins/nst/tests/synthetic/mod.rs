//! Rigid caps of ellipsoids and a brim, seen from one side: enough to see whether the
//! whole chain learns, without a simulator.

use nalgebra::{Point3, Vector3};
use seeone_core::Pose;
use seeone_core::frames::{
    CanonicalObject, Frame, FrameInfo, Index, Moment, SCHEMA, write_index, write_shard,
};
use seeone_core::random::{Generator, generator, normal, rotation, uniform};
use std::path::Path;

/// Half axes of the crown (m) and length of the visor (m).
struct Shape {
    crown: Vector3<f64>,
    visor: f64,
}

impl Shape {
    fn random(rng: &mut Generator) -> Self {
        let crown = Vector3::new(
            uniform(rng, 0.075, 0.085),
            uniform(rng, 0.09, 0.1),
            uniform(rng, 0.09, 0.14),
        );
        Self { crown, visor: uniform(rng, 0.05, 0.085) }
    }

    fn edge(&self) -> f64 {
        2.0 * self.crown.y + self.visor
    }

    /// A surface point with its outward normal, worn and centred, in metres.
    fn surface(&self, rng: &mut Generator) -> (Vector3<f64>, Vector3<f64>) {
        let centre = Vector3::new(0.0, 0.5 * self.visor, 0.5 * self.crown.z);
        if uniform(rng, 0.0, 1.0) < 0.75 {
            let n = Vector3::from_fn(|_, _| normal(rng)).normalize();
            let n = Vector3::new(n.x, n.y, n.z.abs());
            let outward = n.component_div(&self.crown).normalize();
            (n.component_mul(&self.crown) - centre, outward)
        } else {
            let (x, t) = (uniform(rng, -0.9, 0.9), uniform(rng, 0.0, 1.0));
            let y = self.crown.y * (1.0 - x * x).sqrt() + t * self.visor * (1.0 - x * x);
            (Vector3::new(x * self.crown.x, y, 0.0) - centre, Vector3::z())
        }
    }
}

fn frame(shape: &Shape, object: usize, drop: usize, rng: &mut Generator) -> Frame {
    let camera = Point3::new(0.5, -0.2, 0.7);
    let lying = Pose::from_parts(Vector3::new(0.5, 0.3, 0.1).into(), rotation(rng));
    let (mut points, mut nocs) = (Vec::new(), Vec::new());
    while points.len() < 1200 {
        let (p, n) = shape.surface(rng);
        let (seen, normal_) = (lying * Point3::from(p), lying * n);
        let is_visor = n == Vector3::z() && p.z < 0.0;
        if !is_visor && normal_.dot(&(camera - seen)) < 0.0 {
            continue;
        }
        points.push(std::array::from_fn(|i| (seen[i] + 0.001 * normal(rng)) as f32));
        nocs.push(std::array::from_fn(|i| (p[i] / shape.edge() + 0.5) as f32));
    }
    let info = FrameInfo {
        object,
        drop,
        seconds: 2.0,
        moment: if drop % 4 == 3 { Moment::Falling } else { Moment::Resting },
        camera: (&Pose::from(camera)).into(),
        object_pose: (&lying).into(),
    };
    Frame { info, points, nocs }
}

/// Writes a set of `objects` shapes with `drops` frames each.
pub fn write(folder: &Path, objects: usize, drops: usize) {
    let mut rng = generator(7, "synthetic");
    let mut index =
        Index { schema: SCHEMA, seed: 7, command: "test".into(), objects: vec![], shards: vec![] };
    for object in 0..objects {
        let shape = Shape::random(&mut rng);
        let frames: Vec<Frame> =
            (0..drops).map(|drop| frame(&shape, object, drop, &mut rng)).collect();
        let corner = |i: usize| shape.surface(&mut generator(i as u64, "mesh")).0 / shape.edge();
        index.objects.push(CanonicalObject {
            name: format!("cap-{object}"),
            vertices: (0..60).map(|i| corner(i).add_scalar(0.5).into()).collect(),
            triangles: (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
            edge_m: shape.edge(),
            round: false,
        });
        index.shards.push(frames.iter().map(|f| f.info.clone()).collect());
        write_shard(folder, object, &frames).expect("a shard");
    }
    write_index(folder, &index).expect("an index");
}
