//! How large a head is: what scenes name, planners avoid and simulations collide with.

use nalgebra::Vector3;

/// Semi-axes of the medium head's cranium, metres, along x (ear to ear), y (where the face
/// looks) and z (up): a breadth of 154 mm and a length of 198 mm, the means of men in
/// ANSUR II within a millimetre. As an ellipse they give a circumference of 0.555 m.
pub const HEAD_SEMI_AXES_M: [f64; 3] = [0.077, 0.099, 0.110];

/// Smallest and largest semi-axis of a head, metres: circumferences well beyond the 0.445
/// to 0.645 m that EN 960 has head forms for.
pub const SEMI_AXIS_M: [f64; 2] = [0.05, 0.15];

/// The size of a head: the semi-axes of its cranium. Ears and neck grow with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadSize {
    semi_axes_m: [f64; 3],
}

impl HeadSize {
    /// A circumference of 0.535 m.
    pub const SMALL: Self = Self::scaled(0.535);
    /// A circumference of 0.555 m.
    pub const MEDIUM: Self = Self { semi_axes_m: HEAD_SEMI_AXES_M };
    /// A circumference of 0.580 m.
    pub const LARGE: Self = Self::scaled(0.580);
    /// The sizes with their names.
    pub const NAMED: [(&'static str, Self); 3] =
        [("small", Self::SMALL), ("medium", Self::MEDIUM), ("large", Self::LARGE)];

    /// The medium head scaled to a circumference.
    const fn scaled(circumference_m: f64) -> Self {
        let [x, y, z] = HEAD_SEMI_AXES_M;
        let scale = circumference_m / 0.5551;
        Self { semi_axes_m: [x * scale, y * scale, z * scale] }
    }

    /// The size of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|(known, _)| *known == name).map(|(_, size)| size)
    }

    /// A cranium of these semi-axes in metres; `None` when one of them is not that of a
    /// head.
    pub fn of_semi_axes(semi_axes_m: [f64; 3]) -> Option<Self> {
        let possible = |a: &f64| (SEMI_AXIS_M[0]..=SEMI_AXIS_M[1]).contains(a);
        semi_axes_m.iter().all(possible).then_some(Self { semi_axes_m })
    }

    /// Semi-axes of the cranium along the head's x, y and z, metres.
    pub fn semi_axes_m(&self) -> Vector3<f64> {
        Vector3::from(self.semi_axes_m)
    }

    /// Length around the widest level, metres (Ramanujan's first formula for an ellipse).
    pub fn circumference_m(&self) -> f64 {
        let [a, b, _] = self.semi_axes_m;
        std::f64::consts::PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_their_circumferences() {
        for ((name, size), expected) in HeadSize::NAMED.into_iter().zip([0.535, 0.555, 0.580]) {
            assert!((size.circumference_m() - expected).abs() < 5e-4, "{name}");
            assert_eq!(HeadSize::named(name), Some(size));
        }
        assert_eq!(HeadSize::named("huge"), None);
        assert!(HeadSize::of_semi_axes([0.0, 0.1, 0.1]).is_none());
        assert!(HeadSize::of_semi_axes([f64::NAN, 0.1, 0.1]).is_none());
        assert_eq!(HeadSize::of_semi_axes(HEAD_SEMI_AXES_M), Some(HeadSize::MEDIUM));
    }
}
