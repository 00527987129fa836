//! x
use seeone_core::random::generator;
use seeone_sim::category::cap::named;
use seeone_sim::drop::Drop;
use seeone_sim::{Settings, Surroundings};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let (cap, seed): (&str, u64) = (&a[1], a[2].parse().expect("n"));
    let c = named(cap).expect("a cap of this name");
    let table = Surroundings { table: true, ..Surroundings::default() };
    let mut w =
        Drop::draw([0.0; 2], &mut generator(seed, cap)).begin(&c, table, Settings::default());
    let mut low = 0.0f64;
    for f in 0..360 {
        w.advance();
        let z = w.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        if z < low {
            low = z;
            println!("frame {f} depth {z}");
        }
    }
    println!("rms {:.4} crossings {}", w.rms_speed(), w.crossings());
    let n = w.vertices().len();
    let mut sum = vec![0.0; n];
    let mut trace = vec![];
    for _ in 0..60 {
        let before = w.vertices().to_vec();
        w.advance();
        for (s, (a, b)) in sum.iter_mut().zip(before.iter().zip(w.vertices())) {
            *s += (a - b).norm_squared();
        }
        trace.push(w.vertices().to_vec());
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| sum[*b].total_cmp(&sum[*a]));
    let regions = |v: usize| -> Vec<String> {
        let mut r: Vec<String> = c
            .mesh()
            .triangles()
            .iter()
            .enumerate()
            .filter(|(_, t)| t.contains(&(v as u32)))
            .map(|(t, _)| format!("{:?}", c.regions()[t]))
            .collect();
        r.sort();
        r.dedup();
        r
    };
    for v in order.iter().take(12) {
        let p = w.vertices()[*v];
        let rest = c.mesh().vertices()[*v];
        println!(
            "v{v} {:.2} mm/frame {:?} at {:.3?} rest {:.3?}",
            (sum[*v] / 60.0f64).sqrt() * 1000.0,
            regions(*v),
            p.coords.as_slice(),
            rest.coords.as_slice()
        );
        // nearest far-in-rest vertex
        let mut best = (f64::INFINITY, 0);
        for u in 0..n {
            if (c.mesh().vertices()[u] - rest).norm() > 0.02 {
                let d = (w.vertices()[u] - p).norm();
                if d < best.0 {
                    best = (d, u);
                }
            }
        }
        println!("    nearest other {:.4} v{} {:?}", best.0, best.1, regions(best.1));
    }
    let still = order.iter().filter(|v| (sum[**v] / 60.0f64).sqrt() < 2e-5).count();
    println!("{still} of {n} still");
    let v = order[0];
    for t in trace.iter().take(16) {
        println!("{:.5?}", t[v].coords.as_slice());
    }
}
