//! What the network sees of a canonical cloud.

use crate::NseError;
use seeone_core::similarity_fit::robust_similarity;
use seeone_plugin::CanonicalCloud;

/// Columns besides the perception's features: raw and canonical coordinates, confidence.
pub const OWN_COLUMNS: usize = 9;

/// A canonical cloud as the network takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// The voxel positions of the points: their canonical coordinates.
    pub(crate) positions: Vec<[f32; 3]>,
    /// One row a point: raw coordinates, canonical coordinates, confidence, features.
    pub(crate) rows: Vec<f32>,
    /// Length of a row.
    pub(crate) columns: usize,
}

impl Input {
    /// Lays a cloud out for the network.
    ///
    /// The paper feeds raw coordinates, whose frame it leaves open. Here they are carried
    /// into the cube by the robust similarity between the points and their canonical
    /// coordinates, so that they do not depend on where the object lies: what is left of
    /// them beside the canonical ones is the deformation.
    ///
    /// # Errors
    /// [`NseError::Cloud`] when the cloud is too small or degenerate for that similarity,
    /// holds a number that is not finite, or its tables differ in length.
    pub fn new(cloud: &CanonicalCloud) -> Result<Self, NseError> {
        let (count, width) = (cloud.len(), cloud.feature_width);
        let refuse = |why: &str| Err(NseError::Cloud(why.into()));
        let lengths = [cloud.nocs.len(), cloud.confidence.len()];
        if lengths != [count; 2] || cloud.features.len() != count * width {
            return refuse("its tables differ in length");
        }
        if !cloud.features.iter().all(|v| v.is_finite()) {
            return refuse("a feature is not finite");
        }
        if !cloud.confidence.iter().flatten().all(|v| v.is_finite()) {
            return refuse("a confidence is not finite");
        }
        let weights: Vec<f64> = cloud.weights().map(|w| w.max(1e-6)).collect();
        let Some(to_cube) = robust_similarity(&cloud.points, &cloud.nocs, &weights) else {
            return refuse("no similarity carries its points to their canonical coordinates");
        };
        let columns = OWN_COLUMNS + width;
        let mut rows = Vec::with_capacity(count * columns);
        let centred = |v: f64| (2.0 * (v - 0.5)) as f32;
        for (i, (point, nocs)) in cloud.points.iter().zip(&cloud.nocs).enumerate() {
            rows.extend((to_cube * point).iter().map(|v| centred(*v).clamp(-2.0, 2.0)));
            rows.extend(nocs.iter().map(|v| centred(*v)));
            rows.extend(cloud.confidence[i].map(|v| v as f32));
            rows.extend_from_slice(&cloud.features[i * width..][..width]);
        }
        let positions = cloud.nocs.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
        Ok(Self { positions, rows, columns })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_clouds::cloud;
    use nalgebra::Vector3;
    use seeone_core::Similarity;

    #[test]
    fn does_not_depend_on_where_the_object_lies() {
        let here = cloud(0, 200);
        let mut there = here.clone();
        let moved =
            Similarity::new(Vector3::new(0.4, -2.0, 1.0), Vector3::new(1.0, 2.0, -0.5), 1.3);
        there.points.iter_mut().for_each(|p| *p = moved * *p);
        let (a, b) = (Input::new(&here).expect("a"), Input::new(&there).expect("b"));
        let worst = a.rows.iter().zip(&b.rows).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn refuses_what_is_no_cloud() {
        let whole = cloud(0, 50);
        let mut short = whole.clone();
        short.nocs.pop();
        let mut unfinished = whole.clone();
        unfinished.features[7] = f32::NAN;
        for bad in [CanonicalCloud::default(), short, unfinished] {
            assert!(matches!(Input::new(&bad), Err(NseError::Cloud(_))));
        }
    }
}
