//! The repair of the solver's answer: sets that satisfy every row up to rounding.

use crate::program::program::{Program, ROUNDING};
use crate::program::reached::Reached;
use crate::sets::UncertaintySets;

impl Program<'_> {
    /// Returns the cost of the sets, in mean steps, once they satisfy every row.
    pub(crate) fn repaired_cost(&self, sets: &UncertaintySets) -> f64 {
        self.cost_in_steps(&self.repaired(sets))
    }

    /// Returns the sets with radii that are larger, so that every row holds up to rounding: all by
    /// the worst ratio, or each that has no limit by a term of the same cost, whichever costs less.
    /// The solver meets a row to a part of the largest row, so a small one may miss most of its
    /// reach.
    pub(crate) fn repaired(&self, sets: &UncertaintySets) -> UncertaintySets {
        let (ratio, factor, terms) = self.missing_parts(sets);
        let scaled = sets.inflated(ratio, 0.0);
        let mut widened = sets.clone();
        let UncertaintySets { initial_set, input_set, .. } = &mut widened;
        let radii = initial_set.radius.iter_mut().chain(&mut input_set.radius);
        let widening = radii.zip(&terms).filter(|(_, term)| **term > 0.0);
        widening.for_each(|(radius, term)| *radius += factor * term);
        if self.cost_in_steps(&widened) < self.cost_in_steps(&scaled) { widened } else { scaled }
    }

    /// Returns what every row needs to hold: the factor of all radii, at least 1, which is the
    /// largest ratio of what a row needs to what the radii give it; or else the factor of terms
    /// that are added to the radii, and these terms, of the same cost each, but for radii that have
    /// a limit. That factor is infinite if the radii without a limit are in no row.
    fn missing_parts(&self, sets: &UncertaintySets) -> (f64, f64, Vec<f64>) {
        let unknowns = self.unknowns(sets);
        let largest = self.cost.iter().copied().fold(0.0, f64::max);
        let is_limited = |j: usize| self.limits.of_start(j).is_finite();
        let term =
            |(j, w): (usize, &f64)| if *w > 0.0 && !is_limited(j) { largest / w } else { 0.0 };
        let terms: Vec<f64> = self.cost.iter().enumerate().map(term).collect();
        let negligible = ROUNDING * self.scale;
        let (mut ratio, mut factor) = (1.0_f64, 0.0_f64);
        for Reached { index: (b, k, i, _), excess, radius } in self.all_reached(&unknowns) {
            if radius > negligible {
                ratio = ratio.max(1.0 + excess / radius);
            }
            if excess > negligible {
                factor = factor.max(excess / self.row(b, k, i).1.dot(&terms));
            }
        }
        (ratio, factor, terms)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use reachtube_reach::Hyperrectangle;

    use crate::data::envelope::Envelope;
    use crate::data::settings::Settings;
    use crate::data::shape::Shape;
    use crate::program::block::Block;
    use crate::program::layout::Limits;
    use crate::program::program::Program;
    use crate::sets::UncertaintySets;

    /// A mass that is pushed for one second from rest, and comes 1 m and 1 m/s further than the
    /// nominal one. X0 may hardly be larger than nothing, so U has to cover it.
    #[test]
    fn a_repair_keeps_the_limits_of_the_initial_set() {
        let row = |entries: [f64; 3]| [entries, entries].concat();
        let coefficients =
            [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 1.0]].map(row).concat();
        let mut envelope = Envelope::new(2);
        envelope.include(0, &[0.0, 0.0, 1.0, 1.0]);
        let (times, scale) = ([0.0, 1.0].into(), [].into());
        let block = Block { times, coefficients: Arc::new(coefficients), scale, envelope };
        let settings = Settings::default();
        let shape = Shape::of_states(2, 1);
        let limits = Limits { noise: None, start: Some(vec![1e-9; 2]) };
        let program = Program::new((&settings, shape), &[1.0; 2], vec![block]).with_limits(limits);
        let set = |radius: Vec<f64>| Hyperrectangle { centre: vec![0.0; radius.len()], radius };
        let sets = UncertaintySets {
            initial_set: set(vec![0.0; 2]),
            input_set: set(vec![1.5]),
            noise_set: None,
        };
        let repaired = program.repaired(&sets);
        assert_eq!(repaired.initial_set, sets.initial_set);
        assert!((repaired.input_set.radius[0] - 2.0).abs() < 1e-12, "{repaired:?}");
    }
}
