//! Worst-case motions: the starts and inputs that take the linearisation furthest, simulated with
//! the model itself, which reaches further or less far.

use rayon::prelude::*;
use reachtube_ode::{Ensemble, InitialValueProblem};
use reachtube_reach::Nonlinear;
use reachtube_scalar::Lanes;

use crate::data::case::Case;
use crate::data::side::Side;
use crate::nominal::simulate::BOUND;
use crate::sets::UncertaintySets;
use crate::tube::sensitivity::Sensitivity;
use crate::tube::state_sensitivities::Node;

/// Rows whose recordings stay below this part of the linearised radius get no correction: a small
/// one would not make them decide.
const NEAR: f64 = 0.5;

/// For each sample, state and side, by how much the model reaches further than its linearisation;
/// negative if it reaches less far. It is found at some samples and interpolated between them.
#[derive(Debug, Clone)]
pub(super) struct Correction {
    /// Samples x 2n x 2.
    further: Vec<f64>,
    states: usize,
    /// The earliest time (s) at which a worst-case motion diverged.
    pub runs_away: Option<f64>,
}

impl Correction {
    pub(super) fn none(samples: usize, states: usize) -> Self {
        Self { further: vec![0.0; samples * states * 2], states, runs_away: None }
    }

    /// Returns the correction of one row, rad or rad/s.
    pub(super) fn at(&self, k: usize, i: usize, side: Side) -> f64 {
        self.further[(k * self.states + i) * 2 + usize::from(side == Side::Lower)]
    }

    /// Simulates the worst-case motions of `case` under `sets`.
    ///
    /// # Guarantee
    ///
    /// Inner, unrounded: at the nodes each corrected bound is the state of a motion of the model.
    pub(super) fn new(
        system: &dyn Nonlinear,
        case: &Case,
        sets: &UncertaintySets,
        sensitivity: &Sensitivity,
    ) -> Self {
        let states = case.states();
        let found =
            sensitivity.nodes.par_iter().map(|node| at_node(system, case, sets, sensitivity, node));
        let found: Vec<(Vec<f64>, bool)> = found.collect();
        let mut correction = Self::none(case.grid.len(), states);
        let (mut from, mut before) = (0, &vec![0.0; states * 2]);
        for (node, (further, ran_away)) in sensitivity.nodes.iter().zip(&found) {
            for k in from..=node.sample {
                let weight = (k - from) as f64 / (node.sample - from).max(1) as f64;
                let row = &mut correction.further[k * states * 2..(k + 1) * states * 2];
                for ((own, x), y) in row.iter_mut().zip(before).zip(further) {
                    *own = x + weight * (y - x);
                }
            }
            if *ran_away && correction.runs_away.is_none() {
                correction.runs_away = Some(case.grid.times()[node.sample]);
            }
            (from, before) = (node.sample, further);
        }
        correction
    }
}

/// Returns the corrections at one sample, 2n x 2 (upper, lower), and whether a motion diverged,
/// which counts as no correction.
fn at_node(
    system: &dyn Nonlinear,
    case: &Case,
    sets: &UncertaintySets,
    sensitivity: &Sensitivity,
    node: &Node,
) -> (Vec<f64>, bool) {
    let (k, states) = (node.sample, case.states());
    let radii = reach(case, sets, sensitivity, k);
    let nominal = &sensitivity.nominal[k * states..(k + 1) * states];
    let is_near = |&(i, side): &(usize, Side)| {
        let measured = match side {
            Side::Upper => case.measured.upper(k, i),
            Side::Lower => case.measured.lower(k, i),
        };
        side.sign() * (measured - nominal[i]) > NEAR * radii[i]
    };
    let all = (0..states).flat_map(|i| [(i, Side::Upper), (i, Side::Lower)]);
    let places: Vec<(usize, Side)> = all.filter(is_near).collect();
    let motions: Vec<_> =
        places.iter().map(|&(i, side)| worst_case(system, case, sets, node, i, side)).collect();
    let runs: Vec<InitialValueProblem> =
        motions.iter().map(|(start, inputs)| InitialValueProblem { start, inputs }).collect();
    let mut further = vec![0.0; 2 * states];
    let coordinates = system.lift(&case.start).len();
    let mut ensemble = Ensemble::<Lanes<8>>::new(coordinates).bounded_by(BOUND);
    let times = &case.grid.times()[..=k];
    let outcomes = ensemble.integrate(
        &mut *system.field_of_many(),
        times,
        sensitivity.substeps,
        &runs,
        |run, sample, x| {
            if sample == k {
                let (i, side) = places[run];
                let at = 2 * i + usize::from(side == Side::Lower);
                further[at] = side.sign() * (x[i] - nominal[i]) - radii[i];
            }
        },
    );
    (further, outcomes.iter().any(|outcome| !outcome.is_reached()))
}

fn reach(case: &Case, sets: &UncertaintySets, sensitivity: &Sensitivity, k: usize) -> Vec<f64> {
    let radii = || sets.initial_set.radius.iter().chain(&sets.input_set.radius);
    let of_state = |i: usize| {
        let (_, gains) = sensitivity.row(k, i);
        gains.iter().zip(radii()).map(|(gain, r)| gain * r).sum()
    };
    (0..case.states()).map(of_state).collect()
}

/// Returns the start and inputs that take the linearisation furthest.
fn worst_case(
    system: &dyn Nonlinear,
    case: &Case,
    sets: &UncertaintySets,
    node: &Node,
    i: usize,
    side: Side,
) -> (Vec<f64>, Vec<f64>) {
    let (n, states) = (case.parts(), case.states());
    let base = case.start.clone();
    let vertex = |centre: f64, radius: f64, sign: f64| centre + side.sign() * sign * radius;
    let (x0, u) = (&sets.initial_set, &sets.input_set);
    let start: Vec<f64> = (0..states)
        .map(|j| base[j] + vertex(x0.centre[j], x0.radius[j], node.start[i * states + j]))
        .collect();
    let input = |at: usize| {
        let part = at % n;
        case.inputs[at] + vertex(u.centre[part], u.radius[part], node.input[at * states + i])
    };
    (system.lift(&start), (0..node.sample * n).map(input).collect())
}
