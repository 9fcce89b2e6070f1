//! The tube contains the states between the samples.

use nalgebra::DVector;
use reachtube_reach::{
    Disturbance, Hyperrectangle, IntervalVector, LinearSystem, Propagation, ReachSets, StepBounds,
    StepRadii, TimeGrid, Trajectory, step,
};
use reachtube_scalar::Interval;

use crate::arm::arm;
use crate::random::Random;
use crate::rational::system;

/// Number of simulated states in each step.
const PARTS: usize = 8;

/// Largest rounding error of the simulation.
const ROUNDING: f64 = 1e-12;

struct Case {
    propagation: Propagation,
    initial: Hyperrectangle,
    input: Hyperrectangle,
    inputs: Vec<f64>,
    start: Vec<f64>,
    nominal: Trajectory,
    reach: ReachSets,
    tube: StepBounds,
}

impl Case {
    fn new(system: &LinearSystem, grid: &TimeGrid, disturbance: Disturbance, size: f64) -> Self {
        let (n, m) = (system.states(), system.inputs());
        let set =
            |n: usize, x: f64| Hyperrectangle { centre: vec![0.3 * x; n], radius: vec![x; n] };
        let (initial, input) = (set(n, 0.01 * size), set(m, 0.5 * size));
        let propagation = Propagation::new(system, grid).unwrap();
        let inputs: Vec<f64> =
            (0..grid.len() * m).map(|at| 2.0 * (0.3 * at as f64).sin()).collect();
        let start = vec![0.25; n];
        let nominal = propagation.solve(
            &IntervalVector::from_iterator(n, start.iter().map(|&x| Interval::point(x))),
            &inputs,
        );
        let reach =
            ReachSets::new(&propagation, &disturbance.input_gains(&propagation), &initial, &input);
        let radii = StepRadii::new(&propagation, disturbance, &initial, &input);
        let tube = StepBounds::new(&propagation, &nominal, &inputs, &reach, &input, &radii);
        Self { propagation, initial, input, inputs, start, nominal, reach, tube }
    }

    /// Simulates one disturbance and fails where the state leaves the tube.
    ///
    /// The disturbance takes a new value at each part of a step for which `moves` is true.
    fn assert_inside(&self, seed: u64, moves: impl Fn(usize, usize) -> bool) {
        let (n, m) = (self.initial.dimension(), self.input.dimension());
        let mut random = Random::new(seed);
        let mut vertex = |set: &Hyperrectangle| -> Vec<f64> {
            (0..set.dimension()).map(|i| set.centre[i] + set.radius[i] * random.sign()).collect()
        };
        let mut x =
            DVector::from_vec(self.start.clone()) + DVector::from_vec(vertex(&self.initial));
        let mut disturbance = DVector::from_vec(vertex(&self.input));
        for k in 0..self.tube.len() {
            let part =
                step(self.propagation.system(), self.propagation.grid().interval(k) / PARTS as f64);
            let (phi, gamma) = (part.phi.map(|x| x.mid()), part.gamma.map(|x| x.mid()));
            let drift = part.drift.map(|x| x.mid());
            let nominal = DVector::from_column_slice(&self.inputs[k * m..(k + 1) * m]);
            for at in 0..PARTS {
                if moves(k, at) {
                    disturbance = DVector::from_vec(vertex(&self.input));
                }
                self.assert_holds(k, &x);
                x = &phi * x + &gamma * (&nominal + &disturbance) + &drift;
            }
            self.assert_holds(k, &x);
        }
        assert_eq!(x.len(), n);
    }

    fn assert_holds(&self, k: usize, x: &DVector<f64>) {
        for (i, (bound, &x)) in self.tube.bounds(k).iter().zip(x.iter()).enumerate() {
            assert!(
                bound.lo() - ROUNDING <= x && x <= bound.hi() + ROUNDING,
                "{x} leaves {bound:?}: state {i}, step {k}"
            );
        }
    }

    /// Returns the hull at sample k in state i, around the nominal motion.
    fn hull(&self, k: usize, i: usize) -> Interval {
        let nominal = self.nominal.state(k)[i];
        let deviation =
            Interval::new(self.reach.lower_outer(k, i), self.reach.upper_outer(k, i)).unwrap();
        Interval::point(nominal.mid()) + deviation
    }

    /// Returns the mean, over steps and states, of the width of the tube divided by the width of
    /// the hull of the two samples, minus 1.
    fn overhead(&self) -> f64 {
        let n = self.initial.dimension();
        let ratio = |k: usize, i: usize| {
            self.tube.bounds(k)[i].width() / self.hull(k, i).hull(self.hull(k + 1, i)).width() - 1.0
        };
        let all = (0..self.tube.len()).flat_map(|k| (0..n).map(move |i| (k, i)));
        all.map(|(k, i)| ratio(k, i)).sum::<f64>() / (self.tube.len() * n) as f64
    }
}

fn jittered(samples: usize, h: f64) -> TimeGrid {
    let time = |k: usize| (k as f64 + 0.33 * (1.7 * k as f64).sin()) * h;
    TimeGrid::from_times(&(0..samples).map(time).collect::<Vec<_>>()).unwrap()
}

fn cases(disturbance: Disturbance) -> Vec<Case> {
    let oscillator = system(&[&[0.0, 9.0], &[-9.0, -0.5]], &[&[0.0], &[1.0]], &[0.4, 0.0]);
    vec![
        Case::new(&arm(), &TimeGrid::uniform(0.01, 60), disturbance, 1.0),
        Case::new(&arm(), &jittered(60, 0.01), disturbance, 1.0),
        Case::new(&oscillator, &TimeGrid::uniform(0.05, 60), disturbance, 1.0),
        Case::new(&oscillator, &jittered(60, 0.05), disturbance, 0.001),
    ]
}

#[test]
fn disturbances_stay_inside_between_the_samples() {
    for case in cases(Disturbance::Constant) {
        (1..60).for_each(|seed| case.assert_inside(seed, |_, _| false));
    }
    for case in cases(Disturbance::Sample) {
        (1..60).for_each(|seed| {
            case.assert_inside(seed, |k, at| at == 0 && (k as u64).is_multiple_of(1 + seed % 5))
        });
    }
    for case in cases(Disturbance::Measurable) {
        (1..60).for_each(|seed| {
            case.assert_inside(seed, |k, at| {
                ((k * PARTS + at) as u64).is_multiple_of(1 + seed % 20)
            })
        });
    }
}

#[test]
fn the_tube_contains_the_hulls_at_both_samples() {
    for disturbance in [Disturbance::Constant, Disturbance::Sample, Disturbance::Measurable] {
        for case in cases(disturbance) {
            for (k, i) in (0..case.tube.len())
                .flat_map(|k| (0..case.initial.dimension()).map(move |i| (k, i)))
            {
                let widened = case.tube.bounds(k)[i] + Interval::centred(0.0, ROUNDING);
                assert!(
                    widened.encloses(&case.hull(k, i)) && widened.encloses(&case.hull(k + 1, i)),
                    "{k} {i}"
                );
            }
        }
    }
}

#[test]
fn a_peak_between_two_samples_is_inside() {
    // The solution cos 20 t has no uncertainty. The samples 0.05 s before and after the peak are
    // both cos 1.
    let turning = system(&[&[0.0, 20.0], &[-20.0, 0.0]], &[&[0.0], &[0.0]], &[0.0, 0.0]);
    let propagation = Propagation::new(&turning, &TimeGrid::uniform(0.1, 2)).unwrap();
    let (initial, input) = (Hyperrectangle::zero(2), Hyperrectangle::zero(1));
    let start =
        IntervalVector::from_vec(vec![Interval::point(1f64.cos()), Interval::point(1f64.sin())]);
    let nominal = propagation.solve(&start, &[0.0, 0.0]);
    let gains = Disturbance::Sample.input_gains(&propagation);
    let reach = ReachSets::new(&propagation, &gains, &initial, &input);
    let radii = StepRadii::new(&propagation, Disturbance::Sample, &initial, &input);
    let tube = StepBounds::new(&propagation, &nominal, &[0.0, 0.0], &reach, &input, &radii);
    assert!(
        tube.bounds(0)[0].hi() >= 1.0
            && nominal.state(0)[0].hi() < 0.55
            && nominal.state(1)[0].hi() < 0.55
    );
}

#[test]
fn a_radius_that_peaks_between_two_samples_is_inside() {
    // Here e^{At} = [cos sin; -sin cos] and Γ(t) = (sin t, cos t - 1). |sin| has the same value at
    // 60° and 120°, and is 1 between.
    let turning = system(&[&[0.0, 1.0], &[-1.0, 0.0]], &[&[1.0], &[0.0]], &[0.0, 0.0]);
    let propagation =
        Propagation::new(&turning, &TimeGrid::uniform(std::f64::consts::FRAC_PI_3, 3)).unwrap();
    let set = |radius: &[f64]| Hyperrectangle {
        centre: vec![0.0; radius.len()],
        radius: radius.to_vec(),
    };
    let nominal = propagation.solve(&IntervalVector::from_element(2, Interval::ZERO), &[0.0; 3]);
    for (initial, input, state) in
        [(set(&[1.0, 0.0]), set(&[0.0]), 1), (set(&[0.0, 0.0]), set(&[1.0]), 0)]
    {
        let gains = Disturbance::Constant.input_gains(&propagation);
        let reach = ReachSets::new(&propagation, &gains, &initial, &input);
        let radii = StepRadii::new(&propagation, Disturbance::Constant, &initial, &input);
        let tube = StepBounds::new(&propagation, &nominal, &[0.0; 3], &reach, &input, &radii);
        let bound = tube.bounds(1)[state];
        assert!(reach.upper_outer(1, state) < 0.87 && reach.upper_outer(2, state) < 0.87);
        assert!(bound.hi() >= 1.0 && bound.lo() <= -1.0, "{bound:?}");
    }
}

#[test]
fn the_overhead_shrinks_with_the_step() {
    for disturbance in [Disturbance::Constant, Disturbance::Sample] {
        let overhead = |h: f64, count: usize| {
            Case::new(&arm(), &TimeGrid::uniform(h, count), disturbance, 1.0).overhead()
        };
        let [coarse, middle, fine] =
            [(0.016, 26), (0.004, 101), (0.001, 401)].map(|(h, count)| overhead(h, count));
        println!(
            "{disturbance:?}: width of the tube over the hull of its samples, minus 1: \
             {coarse:.4} {middle:.5} {fine:.6}"
        );
        assert!(
            middle < 0.5 * coarse && fine < 0.5 * middle && fine < 0.01,
            "{coarse} {middle} {fine}"
        );
    }
}
