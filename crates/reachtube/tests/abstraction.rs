use reachtube::abstraction::*;
use reachtube_robot::{Robot, Workspace};
#[test]
fn probe() {
    let robot = Robot::lwa4p();
    for kind in [ModelKind::One, ModelKind::Two, ModelKind::Three] {
        for p in [1, 2, 3, 4, 5, 7, 12] {
            if kind == ModelKind::Three && p > 5 {
                continue;
            }
            let t = std::time::Instant::now();
            let m = PolynomialModel::new(&robot, kind, p, &ExpansionPoint::zero(6)).unwrap();
            let made = t.elapsed();
            let q = [0.1, -0.2, 0.15, 0.3, -0.1, 0.2];
            let qd = [0.5, -0.3, 0.4, 0.2, -0.6, 0.1];
            let u = [3.0, -2.0, 1.0, 4.0, 0.5, -0.3];
            let x = m.state(&q, &qd);
            let mut ws = m.workspace();
            let mut rate = vec![0.0; m.states()];
            let t = std::time::Instant::now();
            for _ in 0..100 {
                m.rate_into(&x, &u, &mut ws, &mut rate);
            }
            let e = t.elapsed() / 100;
            let (s, c) = robot.sin_cos(&q);
            let tau: Vec<f64> =
                (0..6).map(|i| u[i] - robot.joints()[i].friction.viscous.torque(&qd[i])).collect();
            let mut w = Workspace::new(&robot);
            let mut bias = vec![0.0; 6];
            robot.gravity(&s, &c, &mut w, &mut bias);
            let tau: Vec<f64> = tau.iter().zip(&bias).map(|(t, g)| t + g).collect();
            let mut qdd = vec![0.0; 6];
            robot.aba(&s, &c, &qd, &tau, &mut w, &mut qdd);
            let err: Vec<f64> = (0..6).map(|i| ((rate[6 + i] - qdd[i]) * 1e6).round() / 1e6).collect();
            println!(
                "{kind:?} {p} made {made:?} degree {} terms {} eval {e:?} err {err:?}",
                m.degree(),
                m.term_count()
            );
        }
    }
}
