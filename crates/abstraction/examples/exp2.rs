//! x
use reachtube_abstraction::*;
use reachtube_robot::Robot;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let robot = Robot::load(&a[1]).unwrap();
    let n = robot.joint_count();
    let kind = ModelKind::try_from(a[2].parse::<u32>().unwrap()).unwrap();
    let order: u32 = a[3].parse().unwrap();
    let boxes: usize = a[5].parse().unwrap();
    let at: Vec<f64> = a.get(6).map_or(vec![0.3, -0.4, 0.2, -1.6, 0.5, 1.8, 0.7], |s| {
        s.split(',').map(|x| x.parse().unwrap()).collect()
    });
    let point = ExpansionPoint::from_values(&at[..n], n).unwrap();
    let model = PolynomialModel::new(&robot, kind, order, &point).unwrap();
    let radii: Vec<f64> = a[4].split(',').map(|x| x.parse().unwrap()).collect();
    let b = OperatingBox::about(&point, &radii).unwrap();
    let t0 = Instant::now();
    let r = model.bound_remainder(&b, boxes).unwrap();
    let ratio: Vec<String> = r
        .bounds
        .iter()
        .zip(&r.sampled_error)
        .map(|(b, s)| match b {
            Some([l, h]) => format!("{:.2}", l.abs().max(h.abs()) / s),
            None => "none".into(),
        })
        .collect();
    println!(
        "{} {} {} {}: {:?} {} boxes; ratios {}",
        a[1],
        a[2],
        order,
        a[4],
        t0.elapsed(),
        r.boxes,
        ratio.join(" ")
    );
}
