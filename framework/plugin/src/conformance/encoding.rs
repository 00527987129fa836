//! The rules of kind `encoding`.

use super::violation::{Violation, answered, hold, refused, sound};
use crate::{CanonicalCloud, Encoding, Field};
use nalgebra::Point3;
use seeone_core::random::{generator, uniform};

/// A canonical cloud of `count` points of a dome, whose `width` features are smooth functions
/// of the place.
pub fn cloud(count: usize, width: usize) -> CanonicalCloud {
    let mut rng = generator(0, "conformance-encoding");
    let mut cloud = CanonicalCloud { feature_width: width, ..CanonicalCloud::default() };
    for _ in 0..count {
        let (x, y) = (uniform(&mut rng, 0.1, 0.9), uniform(&mut rng, 0.1, 0.9));
        let z = 0.2 + 0.5 * (1.0 - (2.0 * x - 1.0).powi(2)) * (1.0 - (2.0 * y - 1.0).powi(2));
        let nocs = Point3::new(x, y, z);
        cloud.points.push(nocs * 0.28);
        cloud.nocs.push(nocs);
        cloud.confidence.push([0.8; 3]);
        cloud.features.extend((0..width).map(|k| ((k + 1) as f64 * nocs[k % 3]).sin() as f32));
    }
    cloud
}

/// `count` places in and, by a tenth, around the cube.
fn queries(count: usize) -> Vec<Point3<f64>> {
    let mut rng = generator(1, "conformance-encoding");
    let mut draw = || uniform(&mut rng, -0.1, 1.1);
    (0..count).map(|_| Point3::new(draw(), draw(), draw())).collect()
}

/// Holds every rule of the kind. `width` is the number of features a point that the encoding
/// takes.
///
/// # Errors
/// The first rule that `plugin` breaks.
pub fn encoding(plugin: &mut dyn Encoding, width: usize) -> Result<(), Violation> {
    let rule = "finite in, finite and of the queries' length out";
    let first = answered(rule, || plugin.encode(&cloud(400, width)))?;
    for count in [0, 1, 333] {
        let asked = queries(count);
        sound(rule, first.features(&asked).check(count))?;
        if let Some(winding) = first.winding(&asked) {
            let kept = winding.len() == count && winding.iter().all(|w| w.is_finite());
            hold(rule, kept, || format!("{} winding numbers for {count}", winding.len()))?;
        }
    }

    let rule = "the same input gives the same bytes";
    let again = answered(rule, || plugin.encode(&cloud(400, width)))?;
    let places = queries(64);
    let same = |a: &dyn Field, b: &dyn Field| {
        a.features(&places) == b.features(&places) && a.winding(&places) == b.winding(&places)
    };
    hold(rule, same(&*first, &*again), || "two fields differ".into())?;

    let rule = "a field stays as it is while others come and go";
    let before = first.features(&places);
    drop(answered(rule, || plugin.encode(&cloud(200, width)))?);
    hold(rule, first.features(&places) == before, || "it changed".into())?;

    refused("an empty cloud is refused", || plugin.encode(&CanonicalCloud::default()))?;
    let mut short = cloud(50, width);
    short.features.pop();
    refused("features that are missing are refused", || plugin.encode(&short))?;
    let mut short = cloud(50, width);
    short.nocs.pop();
    refused("a point without canonical coordinates is refused", || plugin.encode(&short))?;
    let mut broken = cloud(50, width);
    broken.nocs[7].y = f64::NAN;
    refused("a coordinate that is not finite is refused", || plugin.encode(&broken))?;
    let mut broken = cloud(50, width);
    if let Some(feature) = broken.features.first_mut() {
        *feature = f32::INFINITY;
    }
    refused("a feature that is not finite is refused", || plugin.encode(&broken))
}
