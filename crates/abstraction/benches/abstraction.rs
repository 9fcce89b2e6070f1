//! Models of the LWA 4P: how long they take to make, their evaluation beside the dynamics that they
//! stand for, sine and cosine given, and their reachable sets.
//! `cargo bench -p reachtube --bench abstraction`.

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel};
use reachtube_reach::{Flowpipe, FlowpipeSettings, Hyperrectangle, TimeGrid, UncertainInput};
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Lanes, Lanewise, Powers};

fn main() {
    divan::main();
}

fn model(kind: u32, order: u32) -> PolynomialModel {
    let kind = ModelKind::try_from(kind).unwrap();
    PolynomialModel::new(&Robot::lwa4p(), kind, order, &ExpansionPoint::zero(6)).unwrap()
}

/// M_m and c as exact polynomials in (q̇, sin q, cos q).
#[divan::bench(sample_count = 20)]
fn make_mass_matrix_and_coriolis_terms() -> usize {
    let dynamics = Robot::lwa4p().polynomial_dynamics::<f64>().unwrap();
    dynamics.christoffel().iter().flatten().map(|c| c.term_count()).sum()
}

#[divan::bench(args = [(1, 3), (2, 5), (2, 12), (3, 3), (3, 5)], sample_count = 10)]
fn make((kind, order): (u32, u32)) -> PolynomialModel {
    model(kind, order)
}

/// Items are non-constant terms, in each lane.
#[divan::bench(types = [f64, Lanes<8>], args = [(1, 1), (1, 3), (2, 3), (2, 5), (2, 7), (2, 12), (3, 3), (3, 5)])]
fn evaluate<S: Lanewise + Powers>(bencher: Bencher, (kind, order): (u32, u32)) {
    let model = model(kind, order);
    let x: Vec<S> = model.state(&[0.3; 6], &[0.5; 6]).into_iter().map(S::from).collect();
    let (u, mut ws, mut rate) =
        ([S::from(2.0); 6], model.workspace(), vec![S::zero(); model.states()]);
    bencher.counter(ItemsCount::new(model.term_count() * S::LANES)).bench_local(|| {
        model.rate_into(black_box(&x), black_box(&u), &mut ws, &mut rate);
        black_box(&rate);
    });
}

/// A state of the robot at which its forward dynamics is evaluated.
struct Truth<S> {
    robot: Robot,
    /// sin q, cos q, q̇, torque.
    state: [Vec<S>; 4],
    ws: Workspace<S>,
    qdd: Vec<S>,
}

impl<S: Lanewise> Truth<S> {
    fn new() -> Self {
        let robot = Robot::lwa4p();
        let state = [0.3_f64.sin(), 0.3_f64.cos(), 0.5, 2.0].map(|value| vec![S::from(value); 6]);
        Self { ws: Workspace::new(&robot), robot, state, qdd: vec![S::zero(); 6] }
    }
}

/// Composite bodies, Newton-Euler and the factorisation.
#[divan::bench(types = [f64, Lanes<8>])]
fn forward_dynamics<S: Lanewise>(bencher: Bencher) {
    let mut t = Truth::<S>::new();
    bencher.counter(ItemsCount::new(S::LANES)).bench_local(|| {
        let [sin, cos, qd, tau] = black_box(&t.state);
        t.robot.forward_dynamics(sin, cos, qd, tau, &mut t.ws, &mut t.qdd);
        black_box(&t.qdd);
    });
}

/// Articulated bodies.
#[divan::bench(types = [f64, Lanes<8>])]
fn aba<S: Lanewise>(bencher: Bencher) {
    let mut t = Truth::<S>::new();
    bencher.counter(ItemsCount::new(S::LANES)).bench_local(|| {
        let [sin, cos, qd, tau] = black_box(&t.state);
        t.robot.aba(sin, cos, qd, tau, &mut t.ws, &mut t.qdd);
        black_box(&t.qdd);
    });
}

/// Radii of U, N m: about those that the linear model needs for the recordings of the paper, and of
/// the states, in rad and rad/s.
const INPUT: [f64; 6] = [1.2, 2.2, 2.5, 0.7, 0.16, 0.5];
const STATE: [f64; 2] = [0.005, 0.03];

/// Samples at 250 Hz that a model at rest is followed for, with all generators; each item is one
/// that was reached.
#[divan::bench(args = [(1, 3, 1251), (2, 5, 1251), (2, 5, 251), (2, 12, 251), (3, 3, 251)], sample_count = 10)]
fn flowpipe(bencher: Bencher, (kind, order, samples): (u32, u32, usize)) {
    let system = model(kind, order).polynomial_system().unwrap();
    let radius = [[STATE[0]; 6], [STATE[1]; 6]].concat();
    let initial = Hyperrectangle { center: vec![0.0; 12], radius };
    let set = Hyperrectangle { center: vec![0.0; 6], radius: INPUT.to_vec() };
    let (grid, held) = (TimeGrid::uniform(0.004, samples), vec![0.0; 6 * samples]);
    let input = UncertainInput { measured: &held, set: &set };
    let follow = || {
        Flowpipe::new(
            black_box(&system),
            &grid,
            &[0.0; 12],
            &initial,
            &input,
            &FlowpipeSettings::default(),
        )
        .unwrap()
    };
    bencher.counter(ItemsCount::new(follow().len())).bench(follow);
}
