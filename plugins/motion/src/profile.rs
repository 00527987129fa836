//! The fastest way from rest to rest along a line of unit length within limits of speed,
//! acceleration and jerk: a trapezoid of acceleration up and one down (Lambrechts, Boerlage
//! and Steinbuch 2005; what Ruckig finds for this case).

/// Largest speed, acceleration and jerk, each positive, in lengths of the line and seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    pub(crate) speed: f64,
    pub(crate) acceleration: f64,
    pub(crate) jerk: f64,
}

/// How far, how fast, and how that changes, at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    pub(crate) position: f64,
    pub(crate) speed: f64,
    pub(crate) acceleration: f64,
    pub(crate) jerk: f64,
}

/// From 0 to 1: jerk up, hold, jerk down, cruise, and the same backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile {
    jerk: f64,
    /// Of jerk, of constant acceleration, of constant speed, seconds.
    ramp: f64,
    hold: f64,
    cruise: f64,
}

impl Profile {
    /// The fastest within `limits`.
    pub(crate) fn fastest(limits: &Limits) -> Self {
        let Limits { speed, acceleration, jerk } = *limits;
        // The largest speed that there is room for: half the length to gain it, half to lose it.
        let rise = acceleration / jerk;
        let held = 0.5 * acceleration * ((rise * rise + 4.0 / acceleration).sqrt() - rise);
        let never_held = (0.5 * jerk.sqrt()).powf(2.0 / 3.0);
        let peak = if held >= acceleration * rise { held } else { never_held };
        let top = peak.min(speed);
        let (ramp, hold) = if top >= acceleration * rise {
            (rise, top / acceleration - rise)
        } else {
            ((top / jerk).sqrt(), 0.0)
        };
        let cruise = (1.0 / top - (2.0 * ramp + hold)).max(0.0);
        Self { jerk, ramp, hold, cruise }
    }

    /// How long it takes, seconds.
    pub(crate) fn duration(&self) -> f64 {
        4.0 * self.ramp + 2.0 * self.hold + self.cruise
    }

    /// Where it is after `share` of its duration.
    pub(crate) fn at(&self, share: f64) -> Moment {
        let half = 0.5 * self.duration();
        let time = share.clamp(0.0, 1.0) * self.duration();
        if time <= half {
            return self.gaining(time);
        }
        // The way back: the same seen from the end.
        let mirrored = self.gaining(self.duration() - time);
        Moment {
            position: 1.0 - mirrored.position,
            acceleration: -mirrored.acceleration,
            ..mirrored
        }
    }

    /// The first half.
    fn gaining(&self, time: f64) -> Moment {
        let start = Moment { position: 0.0, speed: 0.0, acceleration: 0.0, jerk: self.jerk };
        let segments = [
            (self.ramp, self.jerk),
            (self.hold, 0.0),
            (self.ramp, -self.jerk),
            (f64::INFINITY, 0.0),
        ];
        let (mut at, mut left) = (start, time.max(0.0));
        for (length, jerk) in segments {
            at.jerk = jerk;
            let part = left.min(length);
            at = at.after(part);
            left -= part;
            if left <= 0.0 {
                break;
            }
        }
        at
    }
}

impl Moment {
    /// After `time` of constant jerk.
    fn after(self, time: f64) -> Self {
        let Self { position, speed, acceleration, jerk } = self;
        Self {
            position: position + time * (speed + time * (0.5 * acceleration + time * jerk / 6.0)),
            speed: speed + time * (acceleration + 0.5 * time * jerk),
            acceleration: acceleration + time * jerk,
            jerk,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
    use seeone_core::random::{Generator, generator, uniform};

    /// Limits that make every kind of profile.
    fn drawn(rng: &mut Generator) -> Limits {
        let mut decade = |low, high| 10f64.powf(uniform(rng, low, high));
        Limits { speed: decade(-1.0, 2.0), acceleration: decade(-1.0, 2.5), jerk: decade(0.0, 4.0) }
    }

    #[test]
    fn keeps_its_limits_and_arrives_at_rest() {
        let mut rng = generator(1, "profiles");
        for _ in 0..20_000 {
            let limits = drawn(&mut rng);
            let profile = Profile::fastest(&limits);
            let mut before = 0.0;
            for k in 0..=40 {
                let at = profile.at(f64::from(k) / 40.0);
                assert!(
                    (-1e-12..=1.0 + 1e-12).contains(&at.position) && at.position >= before - 1e-12
                );
                assert!(at.speed >= -1e-9 && at.speed <= limits.speed * (1.0 + 1e-9), "{limits:?}");
                assert!(at.acceleration.abs() <= limits.acceleration * (1.0 + 1e-9), "{limits:?}");
                assert!(at.jerk.abs() <= limits.jerk * (1.0 + 1e-9));
                before = at.position;
            }
            let end = profile.at(1.0);
            assert!((end.position - 1.0).abs() < 1e-12 && end.speed.abs() < 1e-9, "{end:?}");
            // The two halves meet.
            let (a, b) = (profile.at(0.5), profile.at(0.5 + 1e-12));
            assert!((a.position - b.position).abs() < 1e-6, "{limits:?}: {a:?} {b:?}");
            assert!((a.position - 0.5).abs() < 1e-6, "{limits:?}: {a:?}");
        }
    }

    #[test]
    fn is_as_fast_as_ruckig() {
        let mut rng = generator(2, "profiles");
        let mut ruckig = Ruckig::<1, ThrowErrorHandler>::new(None, 0.008);
        for _ in 0..2000 {
            let limits = drawn(&mut rng);
            let mut input = InputParameter::new(None);
            input.target_position[0] = 1.0;
            input.max_velocity[0] = limits.speed;
            input.max_acceleration[0] = limits.acceleration;
            input.max_jerk[0] = limits.jerk;
            let mut trajectory = Trajectory::new(None);
            ruckig.calculate(&input, &mut trajectory).expect("a trajectory");
            let (ours, theirs) = (Profile::fastest(&limits).duration(), trajectory.get_duration());
            assert!((ours - theirs).abs() < 1e-9 * theirs.max(1.0), "{limits:?}: {ours} {theirs}");
        }
    }
}
