//! Models of an arm with a prismatic joint, against its equations of motion in closed form.

use reachtube_abstraction::{ExpansionPoint, Linearisation, ModelKind, PolynomialModel};
use reachtube_ode::InitialValueProblem;
use reachtube_reach::{
    Flowpipe, FlowpipeSettings, Hyperrectangle, Nonlinear, TimeGrid, UncertainInput,
};
use reachtube_robot::Robot;

use crate::common::{KINDS, largest, number, numbers, simulated, truth};

/// A polar manipulator: a turntable with an inertia of 0.4 kg m², and a load of 3 kg that a slide
/// moves along its radius. The viscous friction of the slide is 5 N s/m.
const POLAR: &str = r#"
schema_version = 1
name = "polar"

[[joint]]
name = "table"
placement = {}
armature = 0.4
friction = { viscous = [0.5, 0.0, 0.0] }

[[joint]]
name = "slide"
type = "prismatic"
placement = {}
axis = [1.0, 0.0, 0.0]
mass = 3.0
position_limits = [0.1, 1.2]
friction = { viscous = [5.0, 0.0, 0.0] }
"#;

fn polar() -> Robot {
    Robot::from_toml(POLAR, "polar.toml").unwrap()
}

fn model(kind: ModelKind, order: u32) -> PolynomialModel {
    let point = ExpansionPoint::from_values(&[0.2, 0.6], 2).unwrap();
    PolynomialModel::new(&polar(), kind, order, &point).unwrap()
}

/// Returns (θ̈, r̈): (0.4 + 3 r²) θ̈ = u1 - 0.5 θ̇ - 6 r ṙ θ̇ and 3 r̈ = u2 - 5 ṙ + 3 r θ̇².
fn closed_form(r: f64, qd: &[f64], u: &[f64]) -> [f64; 2] {
    let [turn, slide] = [qd[0], qd[1]];
    [
        (u[0] - 0.5 * turn - 6.0 * r * slide * turn) / (0.4 + 3.0 * r * r),
        (u[1] - 5.0 * slide + 3.0 * r * turn * turn) / 3.0,
    ]
}

/// Returns a state and an input at most `size` from the expansion point.
fn near(seed: &mut u64, size: f64) -> [Vec<f64>; 3] {
    let offset = numbers(seed, 2, size);
    [vec![0.2 + offset[0], 0.6 + offset[1]], numbers(seed, 2, size), numbers(seed, 2, size)]
}

/// Model 2 has the mass matrix of the expansion point and exact Coriolis terms; the error of model
/// 3 falls with the power p + 1 of the distance.
#[test]
fn models_are_those_of_the_closed_form() {
    let (mut seed, robot) = (3, polar());
    let two = model(ModelKind::Two, 4);
    assert_eq!(two.variable_names(), ["qd1", "qd2", "s1", "q2", "c1", "one2", "u1", "u2"]);
    assert!(two.to_string().contains(" qd1 qd2 q2\n"), "{two}");
    for _ in 0..50 {
        let [q, qd, u] = near(&mut seed, 0.3);
        let exact = closed_form(q[1], &qd, &u);
        assert!(largest(truth(&robot, &q, &qd, &u).iter().zip(exact).map(|(a, b)| a - b)) < 1e-12);
        let x = two.state(&q, &qd);
        assert_eq!(x[4..], [q[0].sin(), q[1], q[0].cos(), 1.0]);
        let rate = two.rate(&x, &u);
        let inertia = |r: f64| 0.4 + 3.0 * r * r;
        assert!((rate[2] * inertia(0.6) - exact[0] * inertia(q[1])).abs() < 1e-12);
        assert!((rate[3] - exact[1]).abs() < 1e-12);
        // The extra states are sine, position, cosine and 1.
        assert_eq!(rate[4..], [qd[0] * q[0].cos(), qd[1], -qd[0] * q[0].sin(), 0.0]);
    }
    let error = |order: u32, size: f64| {
        let (three, mut seed) = (model(ModelKind::Three, order), 7);
        let at = |_| {
            let [q, qd, u] = near(&mut seed, size);
            let rate = three.rate(&three.state(&q, &qd), &u);
            let exact = closed_form(q[1], &qd, &u);
            largest([rate[2] - exact[0], rate[3] - exact[1]])
        };
        largest((0..200).map(at))
    };
    for order in 2..=4 {
        let ratio = error(order, 0.1) / error(order, 0.05);
        let expected = 2f64.powi(order as i32 + 1);
        assert!((0.6..1.7).contains(&(ratio / expected)), "order {order}: {ratio}, {expected}");
    }
}

#[test]
fn derivatives_are_slopes() {
    let mut seed = 13;
    for kind in KINDS {
        let model = model(kind, 3);
        let mut linearisation = Linearisation::new(&model);
        let [q, qd, u] = near(&mut seed, 0.3);
        let (a, b) = linearisation.at(&[&q[..], &qd].concat(), &u);
        let h = 1e-5;
        for k in 0..6 {
            let at = |sign: f64| {
                let mut z = [&q[..], &qd, &u].concat();
                z[k] += sign * h;
                model.rate(&model.state(&z[..2], &z[2..4]), &z[4..])
            };
            let (above, below) = (at(1.0), at(-1.0));
            for i in 0..4 {
                let slope = (above[i] - below[i]) / (2.0 * h);
                let found = if k < 4 { a[(i, k)] } else { b[(i, k - 4)] };
                assert!((found - slope).abs() < 1e-7 * (1.0 + slope.abs()), "{kind:?}: {i}, {k}");
            }
        }
    }
}

/// Simulated runs of each model lie in its flowpipe.
#[test]
fn flowpipes_enclose_runs() {
    let mut seed = 11;
    let times: Vec<f64> = (0..=25).map(|k| 0.004 * f64::from(k)).collect();
    for (kind, order) in [(ModelKind::One, 1), (ModelKind::Two, 4), (ModelKind::Three, 3)] {
        let model = model(kind, order);
        let system = model.polynomial_system().unwrap();
        let (centre, nominal) = ([0.3, 0.7, 0.8, -0.3], numbers(&mut seed, 2 * 25, 4.0));
        let (initial, disturbance) = (0.003, 0.2);
        let flowpipe = Flowpipe::new(
            system,
            &TimeGrid::uniform(0.004, 26),
            &centre,
            &Hyperrectangle { centre: vec![0.0; 4], radius: vec![initial; 4] },
            &UncertainInput {
                measured: &nominal,
                set: &Hyperrectangle { centre: vec![0.0; 2], radius: vec![disturbance; 2] },
            },
            &FlowpipeSettings::default(),
        )
        .unwrap();
        assert!(flowpipe.is_reached(), "{kind:?}");
        for _ in 0..20 {
            let mut moved = |values: &[f64], size: f64| -> Vec<f64> {
                values.iter().map(|v| v + size * number(&mut seed).signum()).collect()
            };
            let start = moved(&centre, initial);
            let inputs = moved(&nominal, disturbance);
            let start = model.state(&start[..2], &start[2..]);
            let run = simulated::<f64>(
                &model,
                &times,
                &[InitialValueProblem { start: &start, inputs: &inputs }],
            );
            for (k, x) in run.chunks(model.states()).enumerate() {
                for (value, set) in x.iter().zip(flowpipe.sample(k)) {
                    // The integrator is exact to 1e-9 here.
                    let inside = set.lo() - 1e-9 <= *value && *value <= set.hi() + 1e-9;
                    assert!(inside, "{kind:?} sample {k}: {value} {set:?}");
                }
            }
        }
        let spread = flowpipe.sample(25).iter().map(|set| set.width()).fold(0.0, f64::max);
        assert!(spread < 0.1, "{kind:?}: {spread}");
    }
}

#[test]
fn a_file_is_the_same_model() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    for kind in KINDS {
        let model = model(kind, 3);
        std::fs::write(&path, model.to_json()).unwrap();
        assert_eq!(PolynomialModel::load(&path).unwrap().records(), model.records());
    }
}
