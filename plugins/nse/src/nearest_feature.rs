//! The paper's "without NSE": the perception's own features, carried to where nothing was
//! observed.

use crate::NseError;
use nalgebra::Point3;
use seeone_plugin::{CanonicalCloud, Encoding, Features, Field, PluginError};

/// Observed points that a query sees.
const NEIGHBOURS: usize = 8;
/// Distance, in cube units, below which neighbours count equally: two NOCS bins, which is
/// about the perception's own error.
const SOFTENING: f64 = 2.0 / 64.0;

/// Interpolates features between the observed points in canonical space. It has no weights
/// and works on any perception.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearestFeature;

impl Encoding for NearestFeature {
    fn encode(&mut self, cloud: &CanonicalCloud) -> Result<Box<dyn Field>, PluginError> {
        let refuse = |why: &str| Err(NseError::Cloud(why.into()).into());
        let width = cloud.feature_width;
        if cloud.is_empty() || width == 0 {
            return refuse("it has no points or no features");
        }
        cloud.check().map_err(NseError::Cloud)?;
        let points = cloud.nocs.iter().copied().zip(cloud.weights()).collect();
        Ok(Box::new(NearestField { points, features: cloud.features.clone(), width }))
    }
}

/// Observed canonical points with their confidences and features.
struct NearestField {
    points: Vec<(Point3<f64>, f64)>,
    features: Vec<f32>,
    width: usize,
}

impl NearestField {
    /// Squared distance and index of the points nearest to `query`, nearest first.
    fn nearest(&self, query: &Point3<f64>) -> Vec<(f64, usize)> {
        let mut distances: Vec<(f64, usize)> = self
            .points
            .iter()
            .enumerate()
            .map(|(i, (p, _))| ((p - query).norm_squared(), i))
            .collect();
        let order = |a: &(f64, usize), b: &(f64, usize)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        if distances.len() > NEIGHBOURS {
            distances.select_nth_unstable_by(NEIGHBOURS - 1, order);
            distances.truncate(NEIGHBOURS);
        }
        distances.sort_by(order);
        distances
    }
}

impl Field for NearestField {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let mut values = vec![0.0; queries.len() * self.width];
        for (query, row) in queries.iter().zip(values.chunks_exact_mut(self.width)) {
            let nearest = self.nearest(query);
            // A cloud without any confidence still has nearest points.
            let share = |(squared, i): &(f64, usize)| {
                (self.points[*i].1 + 1e-6) / (squared + SOFTENING * SOFTENING)
            };
            let total: f64 = nearest.iter().map(share).sum();
            for neighbour in &nearest {
                let share = (share(neighbour) / total) as f32;
                let features = &self.features[neighbour.1 * self.width..][..self.width];
                row.iter_mut().zip(features).for_each(|(to, from)| *to += share * from);
            }
        }
        Features { width: self.width, values }
    }

    fn winding(&self, _queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_clouds::cloud;

    #[test]
    fn near_a_point_it_is_like_that_points_features_and_everywhere_within_their_range() {
        let cloud = cloud(1, 400);
        let field = NearestFeature.encode(&cloud).expect("a field");
        let width = cloud.feature_width;
        let there = field.features(&cloud.nocs);
        assert_eq!(there.width, width);
        let own = Features { width, values: cloud.features.clone() };
        let mut shifted = own.values.clone();
        shifted.rotate_left(7 * width);
        let shifted = Features { width, values: shifted };
        assert!(there.mean_difference(&own) < 0.3 * there.mean_difference(&shifted));
        let far = field.features(&[Point3::new(9.0, -3.0, 2.0)]);
        assert!(far.values.iter().all(|v| v.abs() <= 1.0));
        assert!(field.winding(&cloud.nocs).is_none());
    }

    #[test]
    fn a_confident_neighbour_counts_more() {
        let cloud = CanonicalCloud {
            points: vec![Point3::origin(); 2],
            nocs: vec![Point3::new(0.4, 0.5, 0.5), Point3::new(0.6, 0.5, 0.5)],
            confidence: vec![[1.0, 1.0, 0.9], [1.0, 1.0, 0.1]],
            features: vec![1.0, 0.0],
            feature_width: 1,
        };
        let field = NearestFeature.encode(&cloud).expect("a field");
        let middle = field.features(&[Point3::new(0.5, 0.5, 0.5)]);
        assert!((middle.values[0] - 0.9).abs() < 1e-4, "{:?}", middle.values);
        assert!(NearestFeature.encode(&CanonicalCloud::default()).is_err());
    }
}
