//! The state of a search between rounds.

use std::collections::HashMap;

use reachtube_reach::Hyperrectangle;
use serde::{Deserialize, Serialize};

use crate::data::shape::Shape;
use crate::data::side::Side;
use crate::sets::UncertaintySets;
use crate::tube::direction::Direction;
use crate::tube::judged::{Along, At, Judged};

/// Part of the largest radius or centre below which a change counts as settled.
const SETTLED: f64 = 1e-5;

/// Part of the cost below which its change counts as settled too: where the program has several
/// answers, the sets may wander among them.
const SAME_COST: f64 = 1e-6;

/// Centres get less freedom when a change exceeds this part of the one before.
const SHRINKS: f64 = 0.8;

/// The state of the search between rounds: everything that the next round depends on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SearchState {
    /// Number of rounds done.
    pub rounds: usize,
    /// How often the reachable sets were computed.
    pub reachable_sets: usize,
    /// The cost of the linearised sets after the last round.
    pub cost: f64,
    /// The change of the sets by that round's program.
    pub change: f64,
    /// How far centres may move in the next round, in parts of the largest centre or radius of
    /// their kind.
    pub freedom: f64,
    /// The sets after the last round.
    pub sets: UncertaintySets,
    /// The rows that must be reached with a margin, because they were not enclosed.
    pub margins: Vec<Margin>,
    /// The directions in which points were outside the computed sets.
    #[serde(default)]
    pub directions: Vec<Direction>,
}

/// A row that must be reached with a margin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Margin {
    pub case: usize,
    pub sample: usize,
    pub state: usize,
    pub side: Side,
    /// rad or rad/s.
    pub margin: f64,
}

impl SearchState {
    /// Returns the state before the first round: no uncertainty.
    pub(crate) fn start(Shape { states, inputs, .. }: Shape) -> Self {
        let (initial_set, input_set) = (Hyperrectangle::zero(states), Hyperrectangle::zero(inputs));
        let sets = UncertaintySets { initial_set, input_set, noise_set: None };
        Self {
            rounds: 0,
            reachable_sets: 0,
            cost: 0.0,
            change: f64::MAX,
            freedom: f64::MAX,
            sets,
            margins: Vec::new(),
            directions: Vec::new(),
        }
    }

    /// Takes the sets that a program gave, with their cost, and returns whether they have settled.
    /// Where answers jump back and forth, as answers of the same cost may do, centres get less
    /// freedom.
    pub(crate) fn take(&mut self, kinds: &[Vec<usize>], sets: &UncertaintySets, cost: f64) -> bool {
        let change = change(kinds, &self.sets, sets);
        if change > SHRINKS * self.change {
            self.freedom = 0.5 * self.freedom.min(change);
        }
        let is_settled = change <= SETTLED || (cost - self.cost).abs() <= SAME_COST * cost;
        self.sets = sets.clone();
        (self.change, self.cost, self.rounds) = (change, cost, self.rounds + 1);
        is_settled
    }

    /// Returns the bounds of the centres of X0 and U in the next round, for the states of each kind
    /// and the inputs; none when they are free.
    pub(crate) fn centre_bounds(&self, kinds: &[Vec<usize>]) -> Vec<[f64; 2]> {
        if self.freedom == f64::MAX {
            return Vec::new();
        }
        let (x, u) = (&self.sets.initial_set, &self.sets.input_set);
        let mut bounds = vec![[0.0; 2]; x.dimension() + u.dimension()];
        let mut around = |set: &Hyperrectangle, first: usize, kind: &[usize]| {
            let reach = self.freedom * largest(set, kind);
            for &i in kind {
                bounds[first + i] = [set.centre[i] - reach, set.centre[i] + reach];
            }
        };
        kinds.iter().for_each(|kind| around(x, 0, kind));
        around(u, x.dimension(), &(0..u.dimension()).collect::<Vec<_>>());
        bounds
    }

    pub(crate) fn asked(&self) -> Vec<(At, Vec<f64>)> {
        self.directions.iter().map(|known| (known.at, known.direction.clone())).collect()
    }

    /// Takes how far reachable sets reach, and adds the directions in which points are outside
    /// them, with the points `along` that are furthest along these. Returns their number.
    pub(crate) fn take_points(&mut self, judged: &Judged, along: Vec<Along>) -> usize {
        for (index, reach) in &judged.reaches {
            let direction = &mut self.directions[*index];
            (direction.reach, direction.further) = (*reach, None);
        }
        let new = judged.furthest.iter().zip(along).map(|(((at, _), point), along)| Direction {
            at: *at,
            direction: point.direction.clone(),
            along,
            reach: point.reach.unwrap_or_default(),
            further: None,
        });
        self.directions.extend(new);
        judged.furthest.len()
    }

    /// Adds margins; margins of one row add up.
    pub(crate) fn add(&mut self, missing: Vec<Margin>) {
        self.change = f64::MAX;
        let places = self.margins.iter().enumerate().map(|(at, margin)| (margin.row(), at));
        let known: HashMap<_, usize> = places.collect();
        for new in missing {
            match known.get(&new.row()) {
                Some(&at) => self.margins[at].margin += new.margin,
                None => self.margins.push(new),
            }
        }
    }
}

impl Margin {
    fn row(&self) -> (usize, usize, usize, Side) {
        (self.case, self.sample, self.state, self.side)
    }
}

/// Returns the largest change of a centre or radius, in parts of the largest of its kind: states of
/// one kind, such as positions, or inputs.
fn change(kinds: &[Vec<usize>], old: &UncertaintySets, new: &UncertaintySets) -> f64 {
    let of_kind = |old: &Hyperrectangle, new: &Hyperrectangle, kind: &[usize]| {
        let pairs = |x: &[f64], y: &[f64]| -> f64 {
            kind.iter().map(|&i| (x[i] - y[i]).abs()).fold(0.0, f64::max)
        };
        let change = pairs(&old.centre, &new.centre).max(pairs(&old.radius, &new.radius));
        if change == 0.0 { 0.0 } else { change / largest(new, kind) }
    };
    let inputs: Vec<usize> = (0..new.input_set.dimension()).collect();
    let of_states = kinds.iter().map(|kind| of_kind(&old.initial_set, &new.initial_set, kind));
    of_states.fold(of_kind(&old.input_set, &new.input_set, &inputs), f64::max)
}

/// Returns the largest magnitude of a centre or radius.
fn largest(set: &Hyperrectangle, kind: &[usize]) -> f64 {
    let sizes = kind.iter().flat_map(|&i| [set.centre[i], set.radius[i]]);
    sizes.fold(0.0, |max, x| max.max(x.abs()))
}
