//! The three models against the dynamics they stand for.

use reachtube_abstraction::{
    ExpansionPoint, ModelField, ModelKind, OperatingBox, PolynomialModel, linear_model,
};
use reachtube_ode::{DormandPrince, Ensemble, Run, Tolerance};
use reachtube_reach::{Flowpipe, FlowpipeSettings, Hyperrectangle, TimeGrid, UncertainInput};
use reachtube_robot::{DrivenBy, Robot, RobotField, Workspace};
use reachtube_scalar::{Interval, Lanes, Lanewise, TaylorPolynomial};

const KINDS: [ModelKind; 3] = [ModelKind::One, ModelKind::Two, ModelKind::Three];

/// A reproducible number in [-1, 1].
fn number(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn numbers(seed: &mut u64, count: usize, scale: f64) -> Vec<f64> {
    (0..count).map(|_| scale * number(seed)).collect()
}

/// q̈ of (10) by articulated bodies: u drives what gravity and Coulomb friction are taken off of.
fn truth(robot: &Robot, q: &[f64], qd: &[f64], u: &[f64]) -> Vec<f64> {
    let n = robot.joint_count();
    let (sin, cos) = robot.sin_cos(q);
    let mut ws = Workspace::new(robot);
    let mut torque = vec![0.0; n];
    robot.gravity(&sin, &cos, &mut ws, &mut torque);
    for i in 0..n {
        torque[i] += u[i] - robot.joints()[i].friction.viscous.torque(&qd[i]);
    }
    let mut qdd = vec![0.0; n];
    robot.aba(&sin, &cos, qd, &torque, &mut ws, &mut qdd);
    qdd
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(f64::abs).fold(0.0, f64::max)
}

fn model(robot: &Robot, kind: ModelKind, order: u32) -> PolynomialModel {
    PolynomialModel::new(robot, kind, order, &ExpansionPoint::zero(robot.joint_count())).unwrap()
}

#[test]
fn at_order_one_the_three_models_are_one_linear_system() {
    let robot = Robot::lwa4p();
    let linear = linear_model(&robot, &ExpansionPoint::zero(6)).unwrap();
    for kind in KINDS {
        let system = model(&robot, kind, 1).linear_system().unwrap();
        let scale = linear.a().amax();
        assert!((system.a() - linear.a()).amax() < 1e-14 * scale, "{kind:?}");
        assert!((system.b() - linear.b()).amax() < 1e-14 * linear.b().amax(), "{kind:?}");
        assert!(system.drift().amax() < 1e-14, "{kind:?}");
    }
    let error = model(&robot, ModelKind::Two, 3).linear_system().unwrap_err().to_string();
    assert!(error.contains("not linear") && error.contains("use order 1"), "{error}");
}

#[test]
fn model_1_is_complete_at_order_3() {
    let robot = Robot::lwa4p();
    let (third, ninth) = (model(&robot, ModelKind::One, 3), model(&robot, ModelKind::One, 9));
    assert_eq!((third.degree(), ninth.degree()), (3, 3));
    assert!(
        third.acceleration().iter().zip(ninth.acceleration()).all(|(a, b)| a.terms() == b.terms())
    );
}

/// p_max = 12 for the LWA 4P: from there on M_m(q_a) q̈ = u - c - τ_v holds to rounding, and no
/// earlier.
#[test]
fn coriolis_terms_of_model_2_are_exact_from_order_12() {
    let robot = Robot::lwa4p();
    let mass = robot.mass_matrix(&[0.0; 6]);
    let mut seed = 3;
    for (order, exact) in [(11, false), (12, true), (14, true)] {
        let model = model(&robot, ModelKind::Two, order);
        assert_eq!(model.degree(), order.min(12));
        let mut worst: f64 = 0.0;
        for _ in 0..50 {
            let (q, qd, u) = (
                numbers(&mut seed, 6, 3.0),
                numbers(&mut seed, 6, 1.2),
                numbers(&mut seed, 6, 10.0),
            );
            let rate = model.rate(&model.state(&q, &qd), &u);
            let expected =
                mass.clone().cholesky().unwrap().solve(&nalgebra::DVector::from_fn(6, |i, _| {
                    u[i] - robot.coriolis_torque(&q, &qd)[i] - robot.viscous_torque(&qd)[i]
                }));
            let scale = largest(expected.iter().copied());
            worst = worst.max(largest((0..6).map(|i| rate[6 + i] - expected[i])) / scale);
        }
        assert_eq!(worst < 1e-12, exact, "order {order}: {worst}");
    }
}

/// Near the expansion point the error of model 3 falls with the power p + 1 of the distance.
#[test]
fn model_3_is_a_taylor_polynomial_of_the_forward_dynamics() {
    let robot = Robot::lwa4p();
    let mut seed = 8;
    let point = ExpansionPoint::from_values(
        &[numbers(&mut seed, 6, 1.5), numbers(&mut seed, 6, 0.6), numbers(&mut seed, 6, 5.0)]
            .concat(),
        6,
    )
    .unwrap();
    let direction =
        [numbers(&mut seed, 6, 1.0), numbers(&mut seed, 6, 1.0), numbers(&mut seed, 6, 5.0)];
    for order in 1..=4u32 {
        let model = PolynomialModel::new(&robot, ModelKind::Three, order, &point).unwrap();
        let error = |t: f64| {
            let along = |at: &[f64], d: &[f64]| -> Vec<f64> {
                at.iter().zip(d).map(|(a, d)| a + t * d).collect()
            };
            let (q, qd, u) = (
                along(&point.q, &direction[0]),
                along(&point.qd, &direction[1]),
                along(&point.u, &direction[2]),
            );
            let (rate, expected) =
                (model.rate(&model.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
            largest((0..6).map(|i| rate[6 + i] - expected[i]))
        };
        let slope = (error(0.04) / error(0.02)).log2();
        assert!((slope - f64::from(order + 1)).abs() < 0.3, "order {order}: slope {slope}");
    }
}

#[test]
fn intervals_enclose_numbers_and_derivatives_are_slopes() {
    let robot = Robot::lwa4p();
    let mut seed = 21;
    for (kind, order) in
        [(ModelKind::One, 3), (ModelKind::Two, 5), (ModelKind::Two, 12), (ModelKind::Three, 3)]
    {
        let model = model(&robot, kind, order);
        let derivatives = model.derivatives();
        for _ in 0..20 {
            let (q, qd, u) = (
                numbers(&mut seed, 6, 1.0),
                numbers(&mut seed, 6, 1.0),
                numbers(&mut seed, 6, 5.0),
            );
            let x = model.state(&q, &qd);
            let wide = |values: &[f64]| -> Vec<Interval> {
                values.iter().map(|v| Interval::centred(*v, 0.01)).collect()
            };
            let (rate, boxed) = (model.rate(&x, &u), model.rate(&wide(&x), &wide(&u)));
            assert!(rate.iter().zip(&boxed).all(|(r, b)| b.contains(*r)));
            let z: Vec<f64> =
                x[6..].iter().chain(&u).zip(model.origin()).map(|(z, o)| z - o).collect();
            let (place, h) = ((number(&mut seed).abs() * z.len() as f64) as usize, 1e-5);
            let at = |sign: f64| {
                let mut z = z.clone();
                z[place] += sign * h;
                model.acceleration()[2].evaluate(&z)
            };
            let slope = derivatives[2][place].evaluate(&z);
            assert!((slope - (at(1.0) - at(-1.0)) / (2.0 * h)).abs() < 1e-6 * (1.0 + slope.abs()));
        }
    }
}

#[test]
fn files_keep_every_bit() {
    let robot = Robot::lwa4p();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    for (kind, order) in
        [(ModelKind::One, 3), (ModelKind::Two, 4), (ModelKind::Two, 12), (ModelKind::Three, 3)]
    {
        let model = model(&robot, kind, order);
        std::fs::write(&path, model.to_json()).unwrap();
        let read = PolynomialModel::load(&path).unwrap();
        assert_eq!(
            read.acceleration().iter().map(TaylorPolynomial::terms).collect::<Vec<_>>(),
            model.acceleration().iter().map(TaylorPolynomial::terms).collect::<Vec<_>>()
        );
        assert_eq!((read.kind(), read.order(), read.origin()), (kind, order, model.origin()));
    }
}

#[test]
fn what_does_not_fit_is_refused_with_a_remedy() {
    let robot = Robot::lwa4p();
    let zero = ExpansionPoint::zero(6);
    let refusal =
        |kind, order| PolynomialModel::new(&robot, kind, order, &zero).unwrap_err().to_string();
    assert!(refusal(ModelKind::One, 0).contains("order 1 at least"));
    let large = refusal(ModelKind::Three, 20);
    assert!(large.contains("GB for its terms") && large.contains("order 10 fits"), "{large}");
    assert!(
        refusal(ModelKind::Two, 40).contains("order 31 at most"),
        "{}",
        refusal(ModelKind::Two, 40)
    );
}

/// The states at the samples of all runs, one after the other.
fn simulated<S: Lanewise + reachtube_scalar::Powers>(
    model: &PolynomialModel,
    times: &[f64],
    runs: &[Run<'_>],
) -> Vec<f64> {
    let mut states = vec![0.0; runs.len() * times.len() * model.states()];
    let place = |run: usize, sample: usize| (run * times.len() + sample) * model.states();
    let mut field = ModelField::<S>::new(model);
    let outcomes =
        Ensemble::new(model.states()).integrate(&mut field, times, 4, runs, |run, sample, x| {
            states[place(run, sample)..][..x.len()].copy_from_slice(x);
        });
    assert!(outcomes.iter().all(|outcome| outcome.is_reached()));
    states
}

#[test]
fn simulated_models_are_one_motion_in_every_way() {
    let (robot, mut seed) = (Robot::lwa4p(), 5);
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    let inputs = numbers(&mut seed, 6 * 25, 3.0);
    for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 12), (ModelKind::Three, 4)] {
        let model = model(&robot, kind, order);
        let starts: Vec<Vec<f64>> = (0..6)
            .map(|_| model.state(&numbers(&mut seed, 6, 0.1), &numbers(&mut seed, 6, 0.1)))
            .collect();
        let runs: Vec<_> = starts.iter().map(|start| Run { start, inputs: &inputs }).collect();
        let alone = simulated::<f64>(&model, &times, &runs);
        assert_eq!(alone, simulated::<Lanes<4>>(&model, &times, &runs), "{kind:?}");
        let states = model.states();
        let fine = Tolerance { relative: 1e-10, absolute: 1e-10 };
        let mut solver = DormandPrince::new(states, fine);
        let outcome =
            solver.simulate(&mut ModelField::new(&model), &times, runs[0], |sample, x| {
                let error = largest(x.iter().zip(&alone[sample * states..]).map(|(a, b)| a - b));
                assert!(error < 1e-7, "{kind:?}: {error} at sample {sample}");
            });
        assert!(outcome.is_reached());
    }
}

/// Near the expansion point the models of high order move as the robot does.
#[test]
fn a_simulated_model_3_moves_as_the_robot() {
    let (robot, mut seed) = (Robot::lwa4p(), 9);
    let model = model(&robot, ModelKind::Three, 6);
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    let inputs = numbers(&mut seed, 6 * 25, 3.0);
    let (q, qd) = (numbers(&mut seed, 6, 0.1), numbers(&mut seed, 6, 0.1));
    let (start, body) = (model.state(&q, &qd), [q, qd].concat());
    let mut motion = Vec::new();
    let mut solver = DormandPrince::new(12, Tolerance::default());
    let run = Run { start: &body, inputs: &inputs };
    let mut field = RobotField::new(&robot, DrivenBy::Input);
    assert!(solver.simulate(&mut field, &times, run, |_, x| motion.push(x.to_vec())).is_reached());
    let mut solver = DormandPrince::new(24, Tolerance::default());
    let run = Run { start: &start, inputs: &inputs };
    let outcome = solver.simulate(&mut ModelField::new(&model), &times, run, |sample, x| {
        let error = largest(x.iter().zip(&motion[sample]).map(|(a, b)| a - b));
        assert!(error < 1e-4, "{error} at sample {sample}");
    });
    assert!(outcome.is_reached());
    let travelled = largest(motion[25].iter().zip(&motion[0]).map(|(a, b)| a - b));
    assert!(travelled > 0.05, "{travelled}");
}

/// The bound holds at 20,000 states and is not far above the largest error found.
#[test]
fn what_models_leave_out_is_bounded() {
    let robot = Robot::lwa4p();
    let mut seed = 5;
    for (kind, order, radii, boxes, times) in [
        (ModelKind::One, 1, [0.2, 0.3, 2.0], 64, 2.0),
        (ModelKind::Two, 4, [0.2, 0.3, 2.0], 8, 3.0),
        (ModelKind::Three, 3, [0.1, 0.3, 2.0], 8, 4.0),
    ] {
        let model = model(&robot, kind, order);
        let operating_box = OperatingBox::about(model.expansion_point(), &radii).unwrap();
        let remainder = model.bound_remainder(&operating_box, boxes).unwrap();
        let bounds: Vec<[f64; 2]> = remainder.bounds.iter().map(|b| b.unwrap()).collect();
        for _ in 0..20_000 {
            let [q, qd, u] = radii.map(|radius| numbers(&mut seed, 6, radius));
            let (rate, exact) = (model.rate(&model.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
            for i in 0..6 {
                let error = exact[i] - rate[6 + i];
                assert!(
                    bounds[i][0] <= error && error <= bounds[i][1],
                    "{kind:?}: joint {i}: {error} {:?}",
                    bounds[i]
                );
            }
        }
        for (bound, seen) in bounds.iter().zip(&remainder.seen) {
            assert!(largest(*bound) < times * seen, "{kind:?}: {bound:?} where {seen} was seen");
        }
    }
}

/// Over a box so wide that the mass matrix is not known to be invertible there is no bound, and
/// that is said.
#[test]
fn no_bound_is_an_answer() {
    let robot = Robot::lwa4p();
    let model = model(&robot, ModelKind::One, 1);
    let whole = OperatingBox::about(model.expansion_point(), &[3.1, 1.2, 10.0]).unwrap();
    assert!(model.bound_remainder(&whole, 4).unwrap().bounds.iter().all(Option::is_none));
    let refusal = |radii: &[f64]| {
        let outside = OperatingBox::about(model.expansion_point(), radii);
        outside.and_then(|b| model.bound_remainder(&b, 4)).unwrap_err().to_string()
    };
    assert!(
        refusal(&[0.1, 1.3, 1.0]).contains("beyond the limits [-1.2, 1.2]"),
        "{}",
        refusal(&[0.1, 1.3, 1.0])
    );
    assert!(refusal(&[4.0, 1.0, 1.0]).contains("joint1"));
    assert!(refusal(&[0.1, -1.0, 1.0]).contains("0 or more"));
    assert!(refusal(&[0.1, 1.0]).contains("give 3"));
}

/// Simulated behaviours of each model, with starts and inputs from their sets, lie in its flowpipe.
#[test]
fn flowpipes_of_the_models_hold_their_behaviours() {
    let (robot, mut seed) = (Robot::lwa4p(), 11);
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 4), (ModelKind::Three, 3)] {
        let model = model(&robot, kind, order);
        let system = model.polynomial_system().unwrap();
        let (q, qd) = (numbers(&mut seed, 6, 0.2), numbers(&mut seed, 6, 0.3));
        let nominal = numbers(&mut seed, 6 * 25, 2.0);
        let (initial, disturbance) = (0.003, 0.2);
        let flowpipe = Flowpipe::new(
            &system,
            &TimeGrid::uniform(0.004, 26),
            &[q.clone(), qd.clone()].concat(),
            &Hyperrectangle { center: vec![0.0; 12], radius: vec![initial; 12] },
            &UncertainInput {
                measured: &nominal,
                set: &Hyperrectangle { center: vec![0.0; 6], radius: vec![disturbance; 6] },
            },
            &FlowpipeSettings::default(),
        )
        .unwrap();
        assert!(flowpipe.is_reached(), "{kind:?}");
        for _ in 0..20 {
            let moved = |values: &[f64], seed: &mut u64, size: f64| -> Vec<f64> {
                values.iter().map(|v| v + size * number(seed).signum()).collect()
            };
            let start =
                model.state(&moved(&q, &mut seed, initial), &moved(&qd, &mut seed, initial));
            let inputs = moved(&nominal, &mut seed, disturbance);
            let behaviour =
                simulated::<f64>(&model, &times, &[Run { start: &start, inputs: &inputs }]);
            for (k, x) in behaviour.chunks(model.states()).enumerate() {
                for (value, set) in x.iter().zip(flowpipe.sample(k)) {
                    // The integrator is exact to 1e-9 here.
                    assert!(
                        set.lo() - 1e-9 <= *value && *value <= set.hi() + 1e-9,
                        "{kind:?} sample {k}: {value} {set:?}"
                    );
                }
            }
        }
        let spread = flowpipe.sample(25).iter().map(|set| set.width()).fold(0.0, f64::max);
        assert!(spread < 0.2, "{kind:?}: {spread}");
    }
}

#[test]
fn a_robot_of_seven_joints_has_28_variables() {
    let robot = Robot::from_toml(SEVEN_JOINTS, "seven joints").unwrap();
    let mut seed = 77;
    let [two, three] = [(ModelKind::Two, 14), (ModelKind::Three, 3)]
        .map(|(kind, order)| model(&robot, kind, order));
    assert_eq!((two.layout().variables(), three.states()), (28, 28));
    let [q, qd, u] = [0.05, 0.05, 0.5].map(|scale| numbers(&mut seed, 7, scale));
    let (rate, expected) = (three.rate(&three.state(&q, &qd), &u), truth(&robot, &q, &qd, &u));
    let error = largest((0..7).map(|i| rate[7 + i] - expected[i]));
    assert!(error < 1e-3 * largest(expected.iter().copied()), "{error} of {expected:?}");
    let mass = robot.mass_matrix(&[0.0; 7]).cholesky().unwrap();
    let load = nalgebra::DVector::from_vec(u.clone()) - robot.coriolis_torque(&q, &qd);
    let (rate, expected) = (two.rate(&two.state(&q, &qd), &u), mass.solve(&load));
    assert!(
        largest((0..7).map(|i| rate[7 + i] - expected[i])) < 1e-12 * expected.amax(),
        "Coriolis terms are exact"
    );
}

/// An arm with the axes of a usual seven-joint one; masses and lengths are made up.
const SEVEN_JOINTS: &str = r#"
    schema_version = 1
    name = "seven joints"
    convention = "modified"
    joint = [
        { name = "1", dh = { a = 0.0, alpha = 0.0, theta = 0.0, d = 0.3 }, mass = 3.0, com = [0.0, 0.02, -0.1], inertia = [0.03, 0.0, 0.0, 0.03, 0.0, 0.01], armature = 0.5 },
        { name = "2", dh = { a = 0.0, alpha = -1.5707963267948966, theta = 0.0, d = 0.0 }, mass = 3.0, com = [0.0, -0.1, 0.02], inertia = [0.03, 0.0, 0.0, 0.01, 0.0, 0.03], armature = 0.5 },
        { name = "3", dh = { a = 0.0, alpha = 1.5707963267948966, theta = 0.0, d = 0.3 }, mass = 2.0, com = [0.03, 0.02, -0.05], inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01], armature = 0.4 },
        { name = "4", dh = { a = 0.08, alpha = 1.5707963267948966, theta = 0.0, d = 0.0 }, mass = 2.0, com = [-0.04, 0.08, 0.02], inertia = [0.02, 0.0, 0.0, 0.01, 0.0, 0.02], armature = 0.4 },
        { name = "5", dh = { a = -0.08, alpha = -1.5707963267948966, theta = 0.0, d = 0.38 }, mass = 1.5, com = [0.0, 0.03, -0.1], inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.004], armature = 0.2 },
        { name = "6", dh = { a = 0.0, alpha = 1.5707963267948966, theta = 0.0, d = 0.0 }, mass = 1.0, com = [0.05, 0.0, 0.0], inertia = [0.002, 0.0, 0.0, 0.004, 0.0, 0.004], armature = 0.2 },
        { name = "7", dh = { a = 0.088, alpha = 1.5707963267948966, theta = 0.0, d = 0.1 }, mass = 0.7, com = [0.01, 0.0, 0.06], inertia = [0.002, 0.0, 0.0, 0.002, 0.0, 0.001], armature = 0.2 },
    ]
"#;
