//! How far corresponding grasps differ between the objects of a category, in the cube.

use nalgebra::Point3;
use seeone_core::TriangleMesh;

/// Standard deviations over the objects of a category, in cube units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraspSpread {
    /// Forward, along the visor.
    pub y: f64,
    /// Upward.
    pub z: f64,
}

impl GraspSpread {
    /// The spread of the visor's tip, where a demonstration grasps, over canonical meshes:
    /// where a search over canonical grasps may look (Eq. 9 leaves that open), because
    /// elsewhere the features are flat and a free search drifts. `None` for fewer than two
    /// meshes with a tip.
    pub fn of<'a>(meshes: impl IntoIterator<Item = &'a TriangleMesh>) -> Option<Self> {
        let tips: Vec<Point3<f64>> = meshes.into_iter().filter_map(tip).collect();
        if tips.len() < 2 {
            return None;
        }
        let deviation = |axis: usize| {
            let mean = tips.iter().map(|t| t[axis]).sum::<f64>() / tips.len() as f64;
            let squares: f64 = tips.iter().map(|t| (t[axis] - mean).powi(2)).sum();
            (squares / (tips.len() - 1) as f64).sqrt()
        };
        Some(Self { y: deviation(1), z: deviation(2) })
    }
}

/// The foremost point (largest y) of a canonical mesh in its mirror plane x = 0.5.
fn tip(mesh: &TriangleMesh) -> Option<Point3<f64>> {
    let crossing = |a: Point3<f64>, b: Point3<f64>| {
        let (before, after) = (a.x - 0.5, b.x - 0.5);
        (before * after <= 0.0 && before != after)
            .then(|| a + (b - a) * (before / (before - after)))
    };
    (0..mesh.triangles().len())
        .map(|i| mesh.corners(i))
        .flat_map(|[a, b, c]| [crossing(a, b), crossing(b, c), crossing(c, a)])
        .flatten()
        .max_by(|a, b| a.y.total_cmp(&b.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_caps::cap;
    use crate::test_clouds::growth;

    #[test]
    fn crowns_of_different_height_move_the_tip_up_and_down_only() {
        let caps: Vec<TriangleMesh> = (0..8).map(|i| cap(growth(i))).collect();
        let spread = GraspSpread::of(&caps).expect("a spread");
        assert!(spread.z > 0.02 && spread.y < 0.01, "{spread:?}");
        assert!(GraspSpread::of(&caps[..1]).is_none());
        let tip = tip(&caps[0]).expect("a tip");
        assert!((tip.x - 0.5).abs() < 1e-9 && tip.y > 0.99, "{tip}");
    }
}
