//! The observed sheet near a gripper: help for transfer plugins that lay the gripper's
//! middle onto what was seen.

use crate::CanonicalCloud;
use nalgebra::Point3;
use seeone_core::Pose;

/// Which predicted points speak for the sheet at a place; lengths in canonical units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Near {
    /// Those whose x and y lie within the radius, at any height.
    Column(f64),
    /// Those that lie within the radius.
    Ball(f64),
}

impl Near {
    fn includes(self, place: &Point3<f64>, point: &Point3<f64>) -> bool {
        let offset = point - place;
        match self {
            Near::Column(radius) => offset.xy().norm() <= radius,
            Near::Ball(radius) => offset.norm() <= radius,
        }
    }
}

/// What of the cloud lies near a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Median canonical z of its points.
    pub height: f64,
    /// Number of points.
    pub points: usize,
    /// Mean confidence of its points in `[0, 1]`: the geometric mean over the axes of
    /// each, averaged.
    pub confidence: f64,
}

/// The sheet of `cloud` near `place` (canonical), or none where no point was seen.
pub fn sheet(cloud: &CanonicalCloud, place: &Point3<f64>, near: Near) -> Option<Sheet> {
    let (mut heights, mut confidence) = (Vec::new(), 0.0);
    for (point, weight) in cloud.nocs.iter().zip(cloud.weights()) {
        if near.includes(place, point) {
            heights.push(point.z);
            confidence += weight.max(0.0).cbrt().min(1.0);
        }
    }
    let points = heights.len();
    heights.sort_by(f64::total_cmp);
    let height = *heights.get(points / 2)?;
    let below = heights[(points - 1) / 2];
    Some(Sheet { height: 0.5 * (height + below), points, confidence: confidence / points as f64 })
}

/// `pose` (canonical) raised or lowered along canonical z until its origin lies at
/// `height`. A category's sheets differ in height far more than sideways, as the canonical
/// cube is centred on the bounding box; so the closing axis of a tilted gripper is not
/// followed.
pub fn raised_to(pose: &Pose, height: f64) -> Pose {
    let mut raised = *pose;
    raised.translation.z = height;
    raised
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(points: &[[f64; 3]]) -> CanonicalCloud {
        let nocs: Vec<_> = points.iter().map(|p| Point3::from(*p)).collect();
        CanonicalCloud {
            points: nocs.clone(),
            confidence: vec![[0.5; 3]; nocs.len()],
            nocs,
            ..CanonicalCloud::default()
        }
    }

    #[test]
    fn takes_the_median_of_what_is_near() {
        let cloud = cloud(&[
            [0.5, 0.9, 0.30],
            [0.5, 0.9, 0.32],
            [0.52, 0.9, 0.34],
            [0.5, 0.9, 0.90],
            [0.5, 0.2, 0.99],
        ]);
        let place = Point3::new(0.5, 0.9, 0.31);
        let column = sheet(&cloud, &place, Near::Column(0.1)).expect("seen");
        assert_eq!(column.points, 4);
        assert!((column.height - 0.33).abs() < 1e-12);
        assert!((column.confidence - 0.5).abs() < 1e-12);
        let ball = sheet(&cloud, &place, Near::Ball(0.1)).expect("seen");
        assert_eq!((ball.points, ball.height), (3, 0.32));
    }

    #[test]
    fn sees_nothing_where_nothing_is() {
        assert_eq!(sheet(&cloud(&[[0.5; 3]]), &Point3::origin(), Near::Ball(0.1)), None);
    }
}
