//! Sampled states of the exact reachable sets of the paper's arm: none that a motion reaches is
//! called unreachable, and none that is proved reachable lies beyond a direction.

use std::collections::HashMap;
use std::sync::Arc;

use crate::common::{Random, conform_all, read, shared, step};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use reachtube_abstraction::{ExpansionPoint, linear_model};
use reachtube_conform::{Settings, UncertaintySets};
use reachtube_reach::{
    Disturbance, LinearSystem, Membership, MembershipProof, Place, Propagation, SampleGenerators,
    TimeGrid,
};
use reachtube_robot::Robot;

/// How far inside a state has to lie to be proved, in parts of the set.
const SLACK: f64 = 1e-6;

/// Samples of each suite at which states are drawn.
const SAMPLES: usize = 16;

/// The suites.
const SUITES: [&str; 4] = ["A", "B", "D", "E"];

/// One sample of the reachable set: its generators by a series of its own, scaled by the radii of
/// the sets, and the library's.
struct Sampled {
    generators: DMatrix<f64>,
    hull: Vec<f64>,
    set: Membership,
}

/// How many states were drawn inside, and how many drawn from the hull were found on which side.
#[derive(Debug, Default)]
struct Counts {
    motions: usize,
    inside: usize,
    outside: usize,
}

/// e^{Ah} and what inputs do within one time step h, by a series of its own.
type Step = (DMatrix<f64>, DMatrix<f64>);

/// Returns the steps of a grid. Steps of one length are computed once.
fn steps(system: &LinearSystem, times: &[f64]) -> Vec<Arc<Step>> {
    let (n, m) = (system.states(), system.inputs());
    let unit = |size: usize, j: usize| DVector::from_fn(size, |i, _| f64::from(i == j));
    let none = [n, m].map(DVector::zeros);
    let of_length = |h: f64| {
        let moved: Vec<DVector<f64>> =
            (0..n).map(|i| step(system, h, &unit(n, i), &none[1])).collect();
        let pushed: Vec<DVector<f64>> =
            (0..m).map(|j| step(system, h, &none[0], &unit(m, j))).collect();
        Arc::new((DMatrix::from_columns(&moved), DMatrix::from_columns(&pushed)))
    };
    let mut known: HashMap<u64, Arc<Step>> = HashMap::new();
    let mut of_pair = |pair: &[f64]| {
        let h = pair[1] - pair[0];
        Arc::clone(known.entry(h.to_bits()).or_insert_with(|| of_length(h)))
    };
    times.windows(2).map(&mut of_pair).collect()
}

impl Sampled {
    /// Takes the reachable set after the given steps.
    fn new(steps: &[Arc<Step>], sets: &UncertaintySets, rows: &SampleGenerators) -> Self {
        let (n, k) = (sets.initial_set.radius.len(), steps.len());
        // Backward from the last sample, so that every generator is one product.
        let mut transition = DMatrix::identity(n, n);
        let mut columns = Vec::new();
        for (moved, pushed) in steps.iter().rev().map(|step| &**step) {
            for (j, pushed) in pushed.column_iter().enumerate() {
                columns.push(&transition * pushed * sets.input_set.radius[j]);
            }
            transition *= moved;
        }
        columns.extend((0..n).map(|i| transition.column(i) * sets.initial_set.radius[i]));
        let generators = DMatrix::from_columns(&columns);
        let states: Vec<usize> = (0..n).collect();
        let radii = [&sets.initial_set.radius[..], &sets.input_set.radius, &vec![0.0; n]];
        Self {
            hull: generators.row_iter().map(|row| row.lp_norm(1)).collect(),
            set: Membership::new(&rows.at(k, radii, &states, 1)),
            generators,
        }
    }

    /// Judges `count` states.
    fn judge(&self, count: usize, seed: u64) -> Counts {
        let mut random = Random(seed);
        let proof = MembershipProof::new(&self.set).expect("the generators span the states");
        let (n, mut work, mut counts) = (self.hull.len(), self.set.workspace(), Counts::default());
        let none = vec![0.0; n];
        for at in 0..count {
            // A motion under random disturbances, every fourth one at the corners of the sets.
            if at % 2 == 0 {
                let factor = |_, _| match random.signed() {
                    x if at % 4 == 0 => x.signum(),
                    x => x,
                };
                let factors = DVector::from_fn(self.generators.ncols(), factor);
                let x = (&self.generators * factors) * (1.0 - 2.0 * SLACK);
                let scaled = &x / (1.0 - SLACK);
                assert_eq!(self.set.locate(scaled.as_slice(), 1e-9, &mut work), Place::Inside);
                assert!(proof.holds(x.as_slice(), &none, 1.0 - SLACK, &mut work), "{at}");
                counts.motions += 1;
                continue;
            }
            // A state of the hull, about the middle or anywhere.
            let size = random.signed().abs();
            let d: Vec<f64> = self.hull.iter().map(|r| size * r * random.signed()).collect();
            match self.set.locate(&d, 1e-9, &mut work) {
                Place::Outside { direction, ratio } => {
                    let l = DVector::from_column_slice(&direction);
                    let reach = self.generators.tr_mul(&l).lp_norm(1);
                    let along = l.dot(&DVector::from_column_slice(&d));
                    assert!(along > reach && (along / reach / ratio - 1.0).abs() < 1e-6, "{at}");
                    counts.outside += 1;
                }
                Place::Inside => {
                    let scaled: Vec<f64> = d.iter().map(|x| x / (1.0 - SLACK)).collect();
                    let is_well_inside = self.set.locate(&scaled, 1e-9, &mut work) == Place::Inside;
                    let is_proved = proof.holds(&d, &none, 1.0 - SLACK, &mut work);
                    assert!(!is_well_inside || is_proved, "{at}");
                    counts.inside += 1;
                }
                Place::Unknown => panic!("{at}: no answer"),
            }
        }
        counts
    }
}

/// Draws `count` states of each suite of the paper's arm, in the exact reachable sets of X0 and U
/// in the notion hull, which are found soonest.
fn tell_apart(count: usize) {
    let robot = Robot::lwa4p();
    let problem = read(&robot, &shared("schunk_lwa4p"), &SUITES, &Settings::default());
    let sets = conform_all(&problem).sets;
    let system = linear_model(&robot, &ExpansionPoint::zero(6)).unwrap();
    let cases = problem.cases().unwrap();
    assert_eq!(cases.len(), SUITES.len());
    for (case, name) in cases.iter().zip(SUITES) {
        let times = case.grid.times();
        let steps = steps(&system, times);
        let grid = TimeGrid::from_times(times).unwrap();
        let propagation = Propagation::new(&system, &grid).unwrap();
        let rows = SampleGenerators::new(&propagation, Disturbance::Sample, 1).unwrap();
        let of_sample = |at: usize| {
            let k = ((at + 1) * (times.len() - 1)) / SAMPLES;
            let seed = (at + 1) as u64;
            Sampled::new(&steps[..k], &sets, &rows).judge(count / SAMPLES, seed)
        };
        let counts =
            (0..SAMPLES).into_par_iter().map(of_sample).reduce(Counts::default, |a, b| Counts {
                motions: a.motions + b.motions,
                inside: a.inside + b.inside,
                outside: a.outside + b.outside,
            });
        println!("suite {name}: {counts:?}");
        assert!(counts.inside > count / 200 && counts.outside > count / 200, "{counts:?}");
    }
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn states_of_the_papers_arm_are_told_apart() {
    tell_apart(640);
}

#[test]
#[ignore = "needs the recordings in ../shared; takes long: a million states of each suite"]
fn a_million_states_of_each_suite_of_the_papers_arm_are_told_apart() {
    tell_apart(1_000_000);
}
