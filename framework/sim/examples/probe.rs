#![allow(clippy::all, clippy::print_stdout, clippy::unwrap_used, missing_docs, reason="scratch")]
use nalgebra::*;
use seeone_core::random::{generator, rotation};
use seeone_sim::*;
use seeone_sim::category::cap;
fn main() {
    let mode = std::env::args().nth(1).unwrap();
    let name = std::env::args().nth(2).unwrap_or("cap-unseen-07".into());
    let sub: usize = std::env::args().nth(3).map_or(40, |s| s.parse().unwrap());
    let o = cap::named(if name == "all" {"cap-unseen-07"} else {&name}).unwrap();
    println!("{} v {} t {} mass {:.4} soft {}", name, o.mesh().vertices().len(), o.mesh().triangles().len(), o.mass(), o.softness_hz());
    for r in Region::ALL { println!("{r:?} {:?}", o.materials()[r.index()]); }
    println!("bounds {:?}", o.mesh().bounds());
    let settings = Settings { substeps: sub, ..Settings::default() };
    if mode == "drop" {
        for k in 0..6 {
            let mut rng = generator(k, "probe");
            let r = rotation(&mut rng);
            let low = o.mesh().vertices().iter().map(|p| (r * p).z).fold(f64::INFINITY, f64::min);
            let pose = seeone_core::Pose::from_parts(Translation3::new(0.0, 0.0, 0.10 - low), r);
            let mut w = World::new(&o, &pose, Surroundings { table: true, ..Default::default() }, settings);
            let t = std::time::Instant::now();
            let s = w.settle(6.0);
            let cpu = t.elapsed().as_secs_f64();
            let minz = w.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            println!("{k}: {:?} rms {:.4} def {:.4} strain {:.4?} res {:.4} minz {:.5} fault {:?} RT {:.2}", s, w.rms_speed(), w.deformation_rms_speed(), w.strain(), w.shape_residual(), minz, w.fault(), w.time() / cpu);
        }
    } else if mode == "wear" {
        // canonical orientation, hem at a height on the head
        for hem in [-0.01, 0.02, 0.05f64] {
        let head = Head { pose: seeone_core::Pose::translation(0.0, 0.0, 0.3) };
        let pose = seeone_core::Pose::translation(0.0, 0.0, 0.3 + hem);
        let mut w = World::new(&o, &pose, Surroundings { table: true, head: Some(head), ..Default::default() }, settings);
        println!("start sd {:?}", w.min_signed_distance_to_head());
        let t = std::time::Instant::now();
        let s = w.settle(6.0);
        let cpu = t.elapsed().as_secs_f64();
        println!("{:?} rms {:.4} def {:.4} strain {:.4?} res {:.4} sd {:?} com {:?} fault {:?} RT {:.2}", s, w.rms_speed(), w.deformation_rms_speed(), w.strain(), w.shape_residual(), w.min_signed_distance_to_head(), w.centre_of_mass(), w.fault(), w.time() / cpu);
        let before = w.vertices().to_vec();
        for _ in 0..180 { w.advance(); }
        let creep = w.vertices().iter().zip(&before).map(|(a,b)| (a-b).norm()).fold(0.0, f64::max);
        println!("creep {creep:.5}");
        w.set_gravity(Vector3::new(0.0,0.0,9.81));
        let c = w.centre_of_mass();
        for _ in 0..60 { w.advance(); }
        println!("upside: com moved {:.3}", (w.centre_of_mass()-c).norm());
        }
    }
    if mode == "grasp" || mode == "fold" || mode == "table" {
        for force in [20.0, 5.0, 1.0, 0.5, 0.2f64] {
        let fold = mode == "fold";
        let head = Head { pose: seeone_core::Pose::translation(0.0, 0.0, 0.3) };
        let low = o.mesh().bounds().0.z;
        let (pose, sur) = if mode == "grasp" { (seeone_core::Pose::translation(0.0, 0.0, 0.32), Surroundings { table: true, head: Some(head), ..Default::default() }) } else { (seeone_core::Pose::translation(0.0, 0.0, 0.005 - low), Surroundings { table: true, ..Default::default() }) };
        let mut w = World::new(&o, &pose, sur, settings);
        if mode == "table" { w = World::new(&o, &seeone_core::Pose::translation(0.0,0.0,0.5), Surroundings::default(), Settings{gravity: Vector3::zeros(), ..settings}); } else { println!("{:?}", w.settle(4.0)); }
        // grasp target
        let (tip, rot, open) = if fold {
            let top = w.vertices().iter().fold(Point3::new(0.0,0.0,-1.0), |a, p| if p.z > a.z { *p } else { a });
            (top - Vector3::new(0.0,0.0,0.012), seeone_core::pose::rotation_from_approach(&-Vector3::z(), &Vector3::y()), 0.05)
        } else {
            let front = w.vertices().iter().fold(Point3::new(0.0,-1.0,0.0), |a, p| if p.y > a.y { *p } else { a });
            // brim direction
            let bv = o.vertices_of(Region::Brim);
            let mid = bv.iter().map(|v| w.vertices()[*v]).filter(|p| p.x.abs() < 0.01).fold(front, |a, p| if (p-front).norm() < 0.04 && (p-front).norm()>0.015 { p } else { a });
            let dir = (mid - front).normalize();
            (front + dir * 0.018, seeone_core::pose::rotation_from_approach(&dir, &Vector3::z()), 0.03)
        };
        let at = |p: Point3<f64>, back: f64| seeone_core::Pose::from_parts(Translation3::from((p - rot * Vector3::z() * (0.010 + back)).coords), rot);
        for k in 0..60 { w.move_hand(&Hand { pose: at(tip, 0.1 * (1.0 - k as f64 / 59.0)), opening_m: open }); w.advance(); }
        println!("arrived {:?} com {:?}", w.hand_state(), w.centre_of_mass());
        w.close(force);
        let mut k = 0;
        while !w.hand_state().closed && k < 120 { w.advance(); k += 1; }
        println!("closed after {k} frames {:?} strain {:.3?} res {:.4}", w.hand_state(), w.strain(), w.shape_residual());
        let c0 = w.centre_of_mass(); w.set_gravity(settings.gravity);
        let start = w.hand().unwrap().pose;
        let n = 72;
        for k in 1..=n { let s = k as f64 / n as f64; let s = s*s*(3.0-2.0*s); w.move_hand(&Hand{ pose: Translation3::new(0.0,0.0,0.3*s) * start, opening_m: open }); w.advance(); if k % 24 == 0 {println!("  {:?} rms {:.3}", w.hand_state(), w.rms_speed());} }
        let t = std::time::Instant::now();
        for _ in 0..60 { w.advance(); }
        println!("force {force}: rise {:?} {:?} rms {:.4} def {:.4} strain {:.3?} res {:.4} fault {:?} RT {:.2}", w.centre_of_mass()-c0, w.hand_state(), w.rms_speed(), w.deformation_rms_speed(), w.strain(), w.shape_residual(), w.fault(), 1.0/t.elapsed().as_secs_f64());
        w.open(0.05);
        let c=w.centre_of_mass();
        for _ in 0..30 { w.advance(); }
        println!("  opened: fell {:?}", w.centre_of_mass()-c);
        }
    }

    if mode == "survey" {
        for name in cap::names(cap::Set::Unseen) {
            let o = cap::named(&name).unwrap();
            let mut line = format!("{name} v{} B{:.4} ", o.mesh().vertices().len(), o.materials()[2].bending_n_m);
            for k in 0..2 {
                let mut rng = generator(k + 100, &name);
                let r = rotation(&mut rng);
                let low = o.mesh().vertices().iter().map(|p| (r * p).z).fold(f64::INFINITY, f64::min);
                let pose = seeone_core::Pose::from_parts(Translation3::new(0.0, 0.0, 0.12 - low), r);
                let mut w = World::new(&o, &pose, Surroundings { table: true, ..Default::default() }, settings);
                let s = w.settle(6.0);
                let minz = w.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
                line += &format!("| {:.2} {} rms {:.1} def {:.1} strain {:.4} {:.3} res {:.1} z {:.2} {:?}", s.seconds, s.at_rest, w.rms_speed()*1e3, w.deformation_rms_speed()*1e3, w.strain().0, w.strain().1, w.shape_residual()*1e3, minz*1e3, w.fault().is_some());
            }
            let head = Head { pose: seeone_core::Pose::translation(0.0, 0.0, 0.3) };
            let mut w = World::new(&o, &seeone_core::Pose::translation(0.0, 0.0, 0.3+0.03), Surroundings { table: true, head: Some(head), ..Default::default() }, settings);
            let s = w.settle(4.0);
            let b = w.vertices().to_vec();
            for _ in 0..120 { w.advance(); }
            let creep = w.vertices().iter().zip(&b).map(|(a,b)| (a-b).norm()).fold(0.0, f64::max);
            line += &format!("|| worn {:.2} {} sd {:.2} creep {:.2} hem z {:.3}", s.seconds, s.at_rest, w.min_signed_distance_to_head().unwrap()*1e3, creep*1e3, w.vertices().iter().map(|p|p.z).fold(f64::INFINITY,f64::min)-0.3);
            println!("{line}");
        }
    }

    if mode == "ceiling" {
        for name in cap::names(cap::Set::Unseen).iter().take(8) {
            let o = cap::named(name).unwrap();
            let Some(g) = seeone_sim::expert::VisorGrasp::of(&o, 0.3) else { println!("{name} no visor"); continue };
            let head = Head { pose: seeone_core::Pose::translation(0.0, 0.0, 0.3) };
            let sur = Surroundings { table: true, head: Some(head), ..Default::default() };
            let mut w = World::new(&o, &seeone_core::Pose::translation(0.0, 0.0, 0.3+0.03), sur, settings);
            w.settle(4.0);
            let vt = w.vertices().to_vec();
            let mut w = World::new(&o, &seeone_core::Pose::translation(0.0, 0.0, 0.5), Surroundings::default(), Settings { gravity: Vector3::zeros(), ..settings });
            let tool = g.tool_on(w.vertices());
            w.move_hand(&Hand { pose: tool, opening_m: 0.03 });
            w.close(20.0);
            for _ in 0..40 { w.advance(); }
            let held = w.hand_state();
            // carry: fresh world with the head is not possible: emulate by surroundings from the start
            let mut w = World::new(&o, &seeone_core::Pose::translation(0.0, 0.0, 0.5), sur, Settings { gravity: Vector3::zeros(), ..settings });
            let tool = g.tool_on(w.vertices());
            w.move_hand(&Hand { pose: tool, opening_m: 0.03 });
            w.close(20.0);
            for _ in 0..40 { w.advance(); }
            w.set_gravity(settings.gravity);
            let goal = g.tool_on(&vt);
            // where is the tool relative to the brim now
            let off = g.tool_on(w.vertices()).inverse() * w.hand().unwrap().pose;
            let goal = goal * off;
            let start = w.hand().unwrap().pose;
            let mut worst: f64 = 0.0; let mut lost = false;
            for k in 1..=120 { let s = k as f64/120.0; let s = s*s*(3.0-2.0*s); let p = start.lerp_slerp(&goal, s); w.move_hand(&Hand{pose:p, opening_m:0.03}); w.advance(); worst = worst.max(w.hand_state().slip_m); if w.hand_state().held_points == 0 && !lost { lost = true; println!("   lost at {s:.2}"); } }
            for _ in 0..20 { w.advance(); }
            let err = |w: &World| w.vertices().iter().zip(&vt).map(|(a,b)|(a-b).norm()).sum::<f64>() / vt.len() as f64;
            let e0 = err(&w);
            w.open(0.05);
            for _ in 0..30 { w.advance(); }
            let e1 = err(&w);
            let here = w.hand().unwrap().pose;
            for k in 1..=60 { let s = k as f64/60.0; w.move_hand(&Hand{pose: here * Translation3::new(0.0,0.0,-0.18*s), opening_m: 0.05}); w.advance(); }
            let s = w.settle(3.0);
            println!("{name} held {} lost {lost} before {:.1} mm opened {:.1} after {:.1} mm /d {:.4} {:?}", held.held_points, e0*1e3, e1*1e3, err(&w)*1e3, err(&w)/o.mesh().diameter(), s.at_rest);
        }
    }

    if mode == "cross" {
        let mut total = 0; let mut bad = 0;
        for name in cap::names(cap::Set::Train).iter().take(40).filter(|n| name.starts_with("all") || **n == name) {
            let o = cap::named(name).unwrap();
            for k in 0..2 {
                let mut rng = generator(k + 100, name);
                let r = rotation(&mut rng);
                let low = o.mesh().vertices().iter().map(|p| (r * p).z).fold(f64::INFINITY, f64::min);
                let pose = seeone_core::Pose::from_parts(Translation3::new(0.0, 0.0, 0.12 - low), r);
                let mut w = World::new(&o, &pose, Surroundings { table: true, ..Default::default() }, settings);
                let s = w.settle(6.0);
                let c = crossings(&w.mesh());
                total += 1;
                if c > 0 || !s.at_rest || w.fault().is_some() || w.shape_residual() > 0.025 { bad += 1; println!("{name} {k}: rest crossings {} crossings {c} brim from {:?} {s:?} {:?} res {:.4}", crossings(o.mesh()), o.vertices_of(Region::Brim).iter().max(), w.fault(), w.shape_residual()); }
            }
        }
        println!("{bad} of {total}");
    }
}
fn crossings(m: &seeone_core::TriangleMesh) -> usize {
    let v = m.vertices();
    let mut n = 0;
    let mut edges = std::collections::BTreeSet::new();
    for t in m.triangles() { for k in 0..3 { let (a,b)=(t[k],t[(k+1)%3]); edges.insert((a.min(b),a.max(b))); } }
    for (a,b) in edges { for t in m.triangles() {
        if t.contains(&a) || t.contains(&b) { continue; }
        let (p,q) = (v[a as usize], v[b as usize]);
        let [x,y,z] = t.map(|i| v[i as usize]);
        let nn = (y-x).cross(&(z-x));
        let (d0,d1) = ((p-x).dot(&nn),(q-x).dot(&nn));
        if d0*d1 >= 0.0 { continue; }
        let h = p + (q-p)*(d0/(d0-d1));
        let s0=(y-x).cross(&(h-x)).dot(&nn); let s1=(z-y).cross(&(h-y)).dot(&nn); let s2=(x-z).cross(&(h-z)).dot(&nn);
        if s0>0.0 && s1>0.0 && s2>0.0 { n+=1; if std::env::var("WHERE").is_ok() { println!("   edge {a}-{b} tri {t:?} at {:.3} {:.3} {:.3} len {:.4}", h.x, h.y, h.z, (q-p).norm()); } }
    } }
    n
}
