//! Seeded randomness: every number that a run draws comes from here, so that a seed is
//! the whole story.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rand::{Rng, RngExt, SeedableRng};

/// The project's generator.
pub type Generator = rand_pcg::Pcg64;

/// An independent generator for each `(seed, stream)`: streams keep, say, the drop's
/// draws apart from the camera's noise, whatever either consumes.
pub fn generator(seed: u64, stream: &str) -> Generator {
    let mut key = [0u8; 32];
    key.copy_from_slice(blake3::hash(format!("{seed}/{stream}").as_bytes()).as_bytes());
    Generator::from_seed(key)
}

/// A uniform draw from `low..high`.
pub fn uniform(rng: &mut impl Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.random::<f64>()
}

/// A standard normal draw (Box-Muller; one of the pair is discarded so that a draw
/// consumes the same amount whatever came before).
pub fn normal(rng: &mut impl Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (std::f64::consts::TAU * rng.random::<f64>()).cos()
}

/// A direction uniform on the sphere.
pub fn direction(rng: &mut impl Rng) -> Vector3<f64> {
    let z = uniform(rng, -1.0, 1.0);
    let angle = uniform(rng, 0.0, std::f64::consts::TAU);
    let r = (1.0 - z * z).sqrt();
    Vector3::new(r * angle.cos(), r * angle.sin(), z)
}

/// A rotation uniform over SO(3) (Shoemake 1992).
pub fn rotation(rng: &mut impl Rng) -> UnitQuaternion<f64> {
    let (u, a, b) = (
        rng.random::<f64>(),
        uniform(rng, 0.0, std::f64::consts::TAU),
        uniform(rng, 0.0, std::f64::consts::TAU),
    );
    let (s, t) = ((1.0 - u).sqrt(), u.sqrt());
    UnitQuaternion::from_quaternion(Quaternion::new(
        t * b.cos(),
        s * a.sin(),
        s * a.cos(),
        t * b.sin(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_is_the_whole_story_and_streams_are_apart() {
        let draw = |seed, stream| normal(&mut generator(seed, stream));
        assert_eq!(draw(1, "drop"), draw(1, "drop"));
        assert_ne!(draw(1, "drop"), draw(1, "camera"));
        assert_ne!(draw(1, "drop"), draw(2, "drop"));
    }
}
