//! x
#![allow(warnings, clippy::all)]
use seeone_motion::*; use seeone_qp_ik::*; use seeone_plugin::*; use seeone_plugin::motion::*; use seeone_core::robot::*; use seeone_core::Pose; use std::time::Instant; use std::path::Path;
use nalgebra::*;
use std::collections::BTreeMap;
fn rot(axis:Unit<Vector3<f64>>,a:f64)->UnitQuaternion<f64>{UnitQuaternion::from_axis_angle(&axis,a)}
fn main(){
 let a:Vec<f64>=std::env::args().skip(1).map(|s|s.parse().unwrap()).collect();
 // cx cy hx hy hz headyaw_deg base_yaw_deg tau_deg soft
 let (cx,cy,hx,hy,hz,hyaw,tau,soft)=(a[0],a[1],a[2],a[3],a[4],a[5].to_radians(),a[6].to_radians(),a[7]);
 let bz=a[8]; let verbose=a.len()>9;
 let home=vec![0.0,-1.9,1.9,-1.57,-1.57,0.0];
 let robot=RobotModel::from_urdf(Path::new("robots/ur5-ag95.urdf"),&RobotOptions{base:Pose::translation(0.0,0.0,bz),home:Some(home.clone()),..RobotOptions::default()}).unwrap();
 let ik=QpIk::new(IkConfig::default(),1).unwrap(); let planner=Planner::new(MotionConfig::default(),1).unwrap();
 let obstacles=[Obstacle::Table{height_m:0.0,soft_m:soft},Obstacle::Ellipsoid{name:"head".into(),centre:Point3::new(hx,hy,hz),rotation:rot(Vector3::z_axis(),hyaw),semi_axes_m:Vector3::new(0.077,0.099,0.110)}];
 // grasp in cap frame (origin cap centre bottom plane, z up, visor +y)
 let z=Vector3::new(0.0,-tau.cos(),-tau.sin()); let y=Vector3::new(0.0,-tau.sin(),tau.cos()); 
 let g0=Pose::from_parts(Translation3::new(0.0,0.155,0.0), seeone_core::pose::rotation_from_approach(&z,&y));
 let mut ok=[0u32;2];let mut times=vec![];let mut itimes=vec![];let mut why:BTreeMap<String,u32>=BTreeMap::new();let n=if verbose {24} else {12};let mut alts=0;let mut altok=0;let mut dur=vec![];
 let mut failyaw=vec![];
 for side in 0..2 { for k in 0..n {
  let yaw=std::f64::consts::TAU*k as f64/n as f64;
  let roll=if side==0{0.0}else{std::f64::consts::PI}; let h=if side==0{0.025}else{0.09};
  let cap=Pose::from_parts(Translation3::new(cx,cy,h), rot(Vector3::z_axis(),yaw)*rot(Vector3::y_axis(),roll));
  let worn=Pose::from_parts(Translation3::new(hx,hy,hz+0.05), rot(Vector3::z_axis(),hyaw));
  let mut any=false;
  for phi in [-90.0f64,-60.,-30.,0.,30.,60.,90.]{for flip in 0..2{
   let g=g0*Pose::from_parts(Translation3::identity(),rot(Vector3::y_axis(),phi.to_radians())*rot(Vector3::z_axis(),flip as f64*std::f64::consts::PI));
   let pick=cap*g; let rel=worn*g; let mid=Translation3::new(0.0,0.0,0.15)*rel;
   let key=|s:&str,p:Pose,ap,gr,re,li|KeyPose{stage:s.into(),pose:p,approach_m:ap,opening_m:0.03,gripper:gr,retreat_m:re,lift_m:li};
   let keys=[key("pick",pick,0.10,Some(GripperCommand::Close{force_n:45.0}),0.0,0.25),key("above",mid,0.0,None,0.0,0.0),key("release",rel,0.0,Some(GripperCommand::Open{opening_m:0.03}),0.15,0.0)];
   let b=Instant::now();
   let o=planner.plan(&robot,&ik,&MotionTask{start:&home,key_poses:&keys,obstacles:&obstacles}).unwrap();
   let t=b.elapsed().as_secs_f64()*1e3; alts+=1;
   match o{MotionOutcome::Planned{program,cost}=>{any=true;altok+=1;times.push(t);dur.push(program.duration_s());},MotionOutcome::Infeasible{stage,reason}=>{itimes.push(t);
     let short:String=reason.split(|c:char|c.is_ascii_digit()).next().unwrap().into(); let short=if short.contains("out of reach"){short}else{format!("{} {}",reason.split(':').next().unwrap(),reason.rsplit(": ").next().unwrap().chars().filter(|c|!c.is_ascii_digit()).collect::<String>())};
     *why.entry(format!("{stage} {short}")).or_default()+=1;}}
  }}
  if any{ok[side]+=1}else{failyaw.push((side,(yaw.to_degrees()) as i32));}
 }}
 let q=|v:&mut Vec<f64>|{v.sort_by(f64::total_cmp);if v.is_empty(){String::new()}else{format!("median {:.1} p95 {:.1} max {:.1}",v[v.len()/2],v[v.len()*95/100],v[v.len()-1])}};
 println!("cap {cx},{cy} head {hx},{hy},{hz} yaw {:.0} tau {:.0} soft {soft} base {bz}: upright {}/{n} upside {}/{n}; alternatives {altok}/{alts}; ms planned {} | infeasible {}; dur s {}",a[5],a[6],ok[0],ok[1],q(&mut times),q(&mut itimes),q(&mut dur));
 if verbose {println!("fail {}",failyaw.len());let mut w:Vec<_>=why.into_iter().collect();w.sort_by_key(|x|-(x.1 as i32));for (k,v) in w.iter().take(14){println!("  {v} {k}");}}
}
