//! Cloth that hangs: stretched by its own weight, as a catenary, as a pendulum.

use super::check::Check;
use super::common::advance;
use super::plate::{LIMP, Plate};
use nalgebra::Vector3;
use seeone_sim::{Material, World};

const GRAVITY: f64 = 9.81;
/// Membrane stiffness E t of the shell, N/m.
const MEMBRANE_N_M: f64 = 2.0e3;

/// A sheet of fabric may be stretched by its own weight by this share at most and count as
/// inextensible.
const INEXTENSIBLE: f64 = 0.005;

/// A sheet hangs from one of its edges. Hooke's law over a weight that grows from the free
/// edge: its own weight lengthens it by rho g L^2 / (2 E t).
///
/// A sweep over the springs takes back what gravity added since the last, h^2 g at every
/// vertex, from wherever the sheet stands, so that at rest it hangs lower by a share of about
/// k w h^2 (stiffness and inverse mass of a spring). At the usual 40 substeps that is little
/// where the sheet is heavy for its stiffness, so that its sag can be seen. Cap fabric is light
/// and stiff: it shall not be stretched visibly, and by what the formula says once the substeps
/// are short enough. See [`resolution`].
pub fn sags() -> Vec<Check> {
    let of = |density: f64, edge_m: f64, substeps| {
        let edge = edge_m * 1e3;
        format!(
            "hanging sheet of 0.3 m, {density} kg/m2, edges of {edge:.0} mm, {substeps} substeps"
        )
    };
    let sags = |density, edge_m, substeps| {
        let quantity = format!("{}: sag", of(density, edge_m, substeps));
        let sag = sag(density, edge_m, substeps);
        Check::share(quantity, "rho g L^2 / (2 E t)", "m", sag, 0.10)
    };
    let holds = |edge_m| {
        let quantity = format!("{}: longer", of(LIMP.density_kg_m2, edge_m, 40));
        let longer = sag(LIMP.density_kg_m2, edge_m, 40).1 / 0.3;
        Check::at_most(quantity, "inextensible", "of its length", longer, INEXTENSIBLE)
    };
    vec![
        sags(30.0, 0.02, 40),
        sags(30.0, 0.01, 40),
        holds(0.02),
        holds(0.01),
        sags(LIMP.density_kg_m2, 0.02, 320),
        sags(LIMP.density_kg_m2, 0.01, 640),
    ]
}

/// A row of the table of what 40 substeps resolve.
pub struct Resolution {
    /// Weight of the sheet, kg/m2.
    pub density_kg_m2: f64,
    /// Its sag by the formula, metres, on edges of 20 and of 10 mm.
    pub sags_m: [f64; 2],
    /// Deviation of the sag from the formula as a share of it, on either.
    pub deviations: [f64; 2],
}

/// The sag at 40 substeps over the weight of the sheet.
pub fn resolution() -> Vec<Resolution> {
    let row = |density_kg_m2| {
        let sags = [0.02, 0.01].map(|edge_m| sag(density_kg_m2, edge_m, 40));
        Resolution {
            density_kg_m2,
            sags_m: sags.map(|(expected, _)| expected),
            deviations: sags.map(|(expected, sunk)| sunk / expected - 1.0),
        }
    };
    [LIMP.density_kg_m2, 1.0, 3.0, 10.0, 30.0, 100.0].map(row).into()
}

/// What the pendulum on edges of 10 mm gains with elastic energy at 40, 80 and 160 substeps, as
/// a share of its swing's.
pub fn elastic_gains() -> [(usize, f64); 3] {
    [40, 80, 160].map(|substeps| (substeps, swing(0.01, substeps).gained_with_elastic))
}

/// How far the free edge of a sheet of so much weight (kg/m2) sinks by it, metres, by the
/// formula and in the world.
fn sag(density_kg_m2: f64, edge_m: f64, substeps: usize) -> (f64, f64) {
    let strips = (0.3 / (edge_m * 0.75f64.sqrt())).round() as usize;
    let across = (0.1 / edge_m).round() as usize;
    let material = Material { density_kg_m2, ..LIMP };
    let plate = Plate { edge_m, strips, across, material };
    let mut world = plate.world(substeps, 20.0);
    plate.bend(&mut world, |i| (0.0, -plate.pitch_m() * i as f64));
    plate.pin(&mut world, &[0]);
    advance(&mut world, 1.5);
    let length = plate.length_m();
    let sunk = -plate.middle(&world, strips).z - length;
    (density_kg_m2 * GRAVITY * length.powi(2) / (2.0 * MEMBRANE_N_M), sunk)
}

/// A limp strip pinned at both ends hangs as a catenary, z = a cosh(x / a).
pub fn catenaries() -> Vec<Check> {
    let check = |edge_m: f64| {
        let edge = edge_m * 1e3;
        let quantity = format!("strip of 0.4 m pinned at both ends, edges of {edge:.0} mm: off");
        Check::at_most(quantity, "a cosh(x / a)", "spans", catenary(edge_m, 0.4, 40), 0.01)
    };
    vec![check(0.02), check(0.01)]
}

/// Largest vertical distance of a limp strip pinned at both ends from the catenary of its
/// length, as a share of its span of 0.75 lengths.
fn catenary(edge_m: f64, length_m: f64, substeps: usize) -> f64 {
    let strips = (length_m / (edge_m * 0.75f64.sqrt())).round() as usize;
    let plate = Plate { edge_m, strips, across: 1, material: LIMP };
    let (length, span) = (plate.length_m(), 0.75 * plate.length_m());
    let mut world = plate.world(substeps, 10.0);
    // A V of the right length.
    let depth = (length.powi(2) - span.powi(2)).sqrt() / strips as f64;
    plate.bend(&mut world, |i| {
        let side = i.min(strips - i) as f64;
        (span * (i as f64 / strips as f64 - 0.5), -depth * side)
    });
    plate.pin(&mut world, &[0, strips]);
    advance(&mut world, 4.0);
    let parameter = catenary_parameter(span, length);
    let ends = parameter * (span / (2.0 * parameter)).cosh();
    let off = |i: usize| {
        let p = plate.middle(&world, i);
        p.z - (parameter * (p.x / parameter).cosh() - ends)
    };
    (0..=strips).map(|i| off(i).abs()).fold(0.0, f64::max) / span
}

/// The `a` of z = a cosh(x / a) for a chain of `length` over `span`: 2 a sinh(span / 2 a) =
/// length, by bisection.
fn catenary_parameter(span: f64, length: f64) -> f64 {
    let (mut low, mut high) = (0.01 * span, 100.0 * span);
    for _ in 0..200 {
        let a = 0.5 * (low + high);
        if 2.0 * a * (span / (2.0 * a)).sinh() > length { low = a } else { high = a }
    }
    low
}

/// A limp strip swings about its upper edge without damping, let go straight and inclined by
/// 10 degrees. The first mode of a hanging chain is J0(2.4048 sqrt(z / L)), z from the free
/// end, and its period 2 pi / (1.2024 sqrt(g / L)) (Daniel Bernoulli 1732).
///
/// The strip is all but inextensible, so the energy of its swing is that of motion and
/// position, and must not grow. With the elastic energy it must not either, but only where
/// the springs are converged: elsewhere they are longer than their stiffness allows and are
/// charged with more than they could ever give back ([`elastic_gains`]).
pub fn swings() -> Vec<Check> {
    let mut checks = Vec::new();
    for (edge_m, substeps, converged) in [(0.02, 40, true), (0.01, 40, false), (0.01, 80, true)] {
        let Swing { period_s, gained, gained_with_elastic } = swing(edge_m, substeps);
        let of = format!("edges of {:.0} mm, {substeps} substeps", edge_m * 1e3);
        let period = format!("pendulum strip of 0.3 m, {of}: period");
        checks.push(Check::share(period, "2 pi / (1.2024 sqrt(g / L))", "s", period_s, 0.03));
        let grows =
            |quantity, gained| Check::at_most(quantity, "never grows", "of it", gained, 0.01);
        checks.push(grows("energy of the swing gained", gained));
        if converged {
            checks.push(grows("the same with elastic energy", gained_with_elastic));
        }
    }
    checks
}

/// What the strip did in 4 s.
struct Swing {
    /// By the formula, and the mean of those measured, s.
    period_s: (f64, f64),
    /// Largest energy of motion and position above that of the start, as a share of what the
    /// swing has.
    gained: f64,
    /// The same with elastic energy.
    gained_with_elastic: f64,
}

/// The modes are orthogonal, so that the strip's projection on the first swings with its
/// frequency, whatever else the strip does.
fn swing(edge_m: f64, substeps: usize) -> Swing {
    let strips = (0.3 / (edge_m * 0.75f64.sqrt())).round() as usize;
    let plate = Plate { edge_m, strips, across: 1, material: LIMP };
    let length = plate.length_m();
    let mut world = plate.world(substeps, 0.0);
    let (sin, cos) = 10f64.to_radians().sin_cos();
    plate.bend(&mut world, |i| {
        let along = plate.pitch_m() * i as f64;
        (sin * along, -cos * along)
    });
    plate.pin(&mut world, &[0]);
    // Under a gravity along it the strip takes up its own weight.
    world.set_gravity(Vector3::new(sin, 0.0, -cos) * GRAVITY);
    advance(&mut world, 1.0);
    world.set_gravity(Vector3::z() * -GRAVITY);
    let weight = world.mass() * GRAVITY;
    let reach = world.centre_of_mass().coords.norm();
    let of_swing = weight * reach * (1.0 - cos);
    let energies = |world: &World| {
        let moving = world.kinetic_energy() + weight * world.centre_of_mass().z;
        [moving, moving + world.elastic_energy()]
    };
    let start = energies(&world);
    let mut most = start;
    let projection = |world: &World| {
        let shape = |i: usize| bessel_j0(2.404_826 * (1.0 - i as f64 / strips as f64).sqrt());
        (0..strips).map(|i| plate.middle(world, i).x * shape(i)).sum::<f64>()
            + plate.middle(world, strips).x / 2.0
    };
    let (mut before, mut crossings) = (projection(&world), Vec::new());
    for frame in 1..=240 {
        world.advance();
        let now = projection(&world);
        if before * now < 0.0 {
            crossings.push((f64::from(frame) - now / (now - before)) / 60.0);
        }
        before = now;
        let now = energies(&world);
        most = [most[0].max(now[0]), most[1].max(now[1])];
    }
    let halves = crossings.len() - 1;
    let expected_s = std::f64::consts::TAU / (1.2024 * (GRAVITY / length).sqrt());
    let period_s = 2.0 * (crossings[halves] - crossings[0]) / halves as f64;
    Swing {
        period_s: (expected_s, period_s),
        gained: (most[0] - start[0]) / of_swing,
        gained_with_elastic: (most[1] - start[1]) / of_swing,
    }
}

/// Bessel's function of order zero by its power series; for |x| < 5.
fn bessel_j0(x: f64) -> f64 {
    let quarter = -x * x / 4.0;
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 1..30 {
        term *= quarter / f64::from(k * k);
        sum += term;
    }
    sum
}
