//! The joints' positions in a part of a step.

use reachtube_conform::SuiteReach;
use reachtube_scalar::Interval;

/// A part of step `step`, between two fractions of it in [0, 1].
#[derive(Debug, Clone, Copy)]
pub(super) struct PartOfStep {
    pub step: usize,
    pub from: f64,
    pub to: f64,
}

impl PartOfStep {
    pub(super) fn whole(step: usize) -> Self {
        Self { step, from: 0.0, to: 1.0 }
    }

    /// Returns both halves. The fractions are dyadic, so they are exact.
    pub(super) fn halves(self) -> [Self; 2] {
        let middle = 0.5 * (self.from + self.to);
        [Self { to: middle, ..self }, Self { from: middle, ..self }]
    }

    /// Returns an upper bound of the time of its end, s.
    pub(super) fn end(self, reach: &SuiteReach) -> f64 {
        let [start, end] = [0, 1].map(|next| Interval::point(reach.times[self.step + next]));
        (start + (end - start) * self.to).hi().next_up()
    }

    /// Encloses the positions, n, over the part: they stay within s (1 - s) h times the width of
    /// the tube in the velocity of the line between the positions at both samples, where s is the
    /// fraction of the step.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    pub(super) fn positions(self, reach: &SuiteReach, positions: &mut Vec<Interval>) {
        let (n, k) = (reach.dimension / 2, self.step);
        let tube = reach.tube.bounds(k);
        let duration = Interval::point(reach.times[k + 1].next_up()) - reach.times[k].next_down();
        let fraction = Interval::point(self.from).hull(Interval::point(self.to));
        let parabola = (fraction * (Interval::ONE - fraction)).hi().min(0.25);
        let at = |k: usize, i: usize| {
            let index = k * reach.dimension + i;
            Interval::point(reach.lower[index]).hull(Interval::point(reach.upper[index]))
        };
        positions.clear();
        positions.extend((0..n).map(|i| {
            let (here, next) = (at(k, i), at(k + 1, i));
            let line = |s: f64| here * (Interval::ONE - s) + next * s;
            let bulge = (duration * parabola * tube[n + i].width()).hi();
            let near = line(self.from).hull(line(self.to)) + Interval::centred(0.0, bulge);
            near.intersection(tube[i]).unwrap_or(tube[i])
        }));
    }
}
