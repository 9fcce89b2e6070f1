//! The nominal error of a joint with the smallest set that holds its rows: a linear program, whose
//! rows are added where they are violated.

use microlp::{ComparisonOp, OptimizationDirection, Problem, Variable};

use crate::basis::TERMS;
use crate::error::{Error, Result};

/// Rows are added until none is violated by more than this part of the set.
const TOLERANCE: f64 = 1e-6;

/// A joint whose command spans less than this stands still, and has no lag, rad or m.
const STILL: f64 = 1e-3;

/// A half-width that nothing is divided by.
const TINY: f64 = 1e-300;

/// Largest number of rounds of added rows.
const ROUNDS: usize = 100;

/// The error of one joint at some samples, and what it may depend on.
#[derive(Debug, Clone, Default)]
pub(crate) struct JointErrors {
    /// The actual position minus the commanded one, rad.
    pub error: Vec<f64>,
    /// The commanded position, rad.
    pub command: Vec<f64>,
    /// 1, ṙ, r̈ and the direction.
    pub terms: Vec<[f64; TERMS]>,
}

/// What a set depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SetForm {
    /// The terms of the nominal error.
    pub terms: &'static [usize],
    /// Whether the half-width grows with the commanded speed.
    pub grows: bool,
}

/// A nominal error θ · (1, ṙ, r̈, direction) and a half-width ρ0 + ρ1 |ṙ| about it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct TrackedSet {
    pub factors: [f64; TERMS],
    pub radius: [f64; 2],
}

impl TrackedSet {
    /// Returns the half-width at a commanded speed.
    pub(crate) fn half_width(&self, speed: f64) -> f64 {
        self.radius[0] + self.radius[1] * speed.abs()
    }
}

impl JointErrors {
    /// Returns the error of a row without its nominal part.
    pub(crate) fn rest(&self, row: usize, factors: &[f64; TERMS]) -> f64 {
        let nominal = factors.iter().zip(&self.terms[row]).map(|(a, b)| a * b).sum::<f64>();
        self.error[row] - nominal
    }

    pub(crate) fn half_width(&self, row: usize, set: &TrackedSet) -> f64 {
        set.half_width(self.terms[row][1])
    }

    /// Returns the mean half-width of a set over all rows.
    pub(crate) fn mean_half_width(&self, set: &TrackedSet) -> f64 {
        let count = self.terms.len();
        (0..count).map(|row| self.half_width(row, set)).sum::<f64>() / count as f64
    }

    /// Returns the largest part of a set that some rows need; more than 1 is outside. A set without
    /// width holds rows without a rest.
    pub(crate) fn needed(&self, rows: impl Iterator<Item = usize>, set: &TrackedSet) -> f64 {
        let of = |row: usize| match self.rest(row, &set.factors).abs() {
            0.0 => 0.0,
            rest => rest / self.half_width(row, set),
        };
        rows.map(of).fold(0.0, f64::max)
    }

    /// Returns the row that is the furthest above its set, and the one furthest below.
    fn ends(&self, rows: impl Iterator<Item = usize>, set: &TrackedSet) -> [(usize, f64); 2] {
        let mut ends = [(0, f64::NEG_INFINITY); 2];
        for row in rows {
            let (rest, width) = (self.rest(row, &set.factors), self.half_width(row, set));
            for (end, beyond) in ends.iter_mut().zip([rest - width, -rest - width]) {
                if beyond > end.1 {
                    *end = (row, beyond);
                }
            }
        }
        ends
    }

    /// Returns the set of a form that holds some rows with the least mean half-width. At rest, its
    /// half-width is at least `least`; `near` is a guess.
    ///
    /// # Errors
    ///
    /// [`Error::Program`] where the solver fails.
    pub(crate) fn smallest(
        &self,
        rows: impl Iterator<Item = usize> + Clone,
        form: SetForm,
        least: f64,
        near: &TrackedSet,
    ) -> Result<TrackedSet> {
        let mut set = TrackedSet { factors: [0.0; TERMS], radius: [least, 0.0] };
        form.terms.iter().for_each(|term| set.factors[*term] = near.factors[*term]);
        let RowSizes { units, furthest, mean_speed } = self.scale(rows.clone(), &mut set);
        if furthest == 0.0 {
            return Ok(set);
        }
        let terms = form.terms.iter().copied().filter(|term| units[*term] > 0.0);
        let terms: Vec<usize> = terms.collect();
        let grows = form.grows && units[1] > 0.0;
        let mut program = LeastWidth {
            unknowns: terms.len(),
            mean: grows.then(|| mean_speed / units[1]),
            least: least / furthest,
            rows: Vec::new(),
        };
        let start = set.factors;
        for _ in 0..ROUNDS {
            let ends = self.ends(rows.clone(), &set);
            let beyond = ends.map(|(row, beyond)| beyond / self.half_width(row, &set).max(TINY));
            if !program.rows.is_empty() && beyond.iter().all(|part| *part <= TOLERANCE) {
                break;
            }
            program.rows.extend(ends.map(|(row, _)| WidthRow {
                terms: terms.iter().map(|term| self.terms[row][*term] / units[*term]).collect(),
                speed: if grows { self.terms[row][1].abs() / units[1] } else { 0.0 },
                rest: self.rest(row, &start) / furthest,
            }));
            let found = program.solve()?;
            for (term, value) in terms.iter().zip(&found) {
                set.factors[*term] = start[*term] + value * furthest / units[*term];
            }
            let growth =
                found.get(terms.len() + 1).map_or(0.0, |value| value * furthest / units[1]);
            set.radius = [found[terms.len()] * furthest, growth];
        }
        let grown = self.needed(rows, &set).max(1.0);
        set.radius.iter_mut().for_each(|radius| *radius *= grown);
        Ok(set)
    }

    /// Returns units of the unknowns in which each matters as much as the others. A joint that
    /// stands still has an offset only, in `set` too.
    fn scale(&self, rows: impl Iterator<Item = usize>, set: &mut TrackedSet) -> RowSizes {
        let mut units = [0.0f64; TERMS];
        let (mut speed, mut count) = (0.0, 0usize);
        let mut span = [f64::INFINITY, f64::NEG_INFINITY];
        let mut furthest = set.radius[0];
        for row in rows {
            let sizes = units.iter_mut().zip(&self.terms[row]);
            sizes.for_each(|(unit, term)| *unit = unit.max(term.abs()));
            furthest = furthest.max(self.rest(row, &set.factors).abs());
            (speed, count) = (speed + self.terms[row][1].abs(), count + 1);
            span = [span[0].min(self.command[row]), span[1].max(self.command[row])];
        }
        if span[1] - span[0] < STILL {
            units[1..].fill(0.0);
            set.factors[1..].fill(0.0);
        }
        RowSizes { units, furthest, mean_speed: speed / count as f64 }
    }
}

/// The sizes of the numbers in rows.
struct RowSizes {
    /// The largest size of each term, or 0 for one that does not count.
    units: [f64; TERMS],
    /// The largest distance from a guess.
    furthest: f64,
    /// The mean commanded speed.
    mean_speed: f64,
}

/// The program min ρ0 + mean ρ1 subject to |rest - θ · terms| <= ρ0 + ρ1 speed, ρ0 >= least.
struct LeastWidth {
    /// The number of terms.
    unknowns: usize,
    /// The mean speed, if there is a ρ1.
    mean: Option<f64>,
    least: f64,
    rows: Vec<WidthRow>,
}

struct WidthRow {
    terms: Vec<f64>,
    speed: f64,
    rest: f64,
}

impl LeastWidth {
    /// Returns θ, ρ0 and, if there is one, ρ1.
    fn solve(&self) -> Result<Vec<f64>> {
        let mut problem = Problem::new(OptimizationDirection::Minimize);
        let infinity = f64::INFINITY;
        let free = (0..self.unknowns).map(|_| problem.add_var(0.0, (-infinity, infinity)));
        let mut variables: Vec<Variable> = free.collect();
        variables.push(problem.add_var(1.0, (self.least, infinity)));
        variables.extend(self.mean.map(|mean| problem.add_var(mean, (0.0, infinity))));
        for WidthRow { terms, speed, rest } in &self.rows {
            for sign in [1.0, -1.0] {
                let factors = terms.iter().map(|term| sign * term).chain([1.0, *speed]);
                let row = variables.iter().copied().zip(factors);
                let row: Vec<(Variable, f64)> = row.filter(|(_, factor)| *factor != 0.0).collect();
                problem.add_constraint(&row, ComparisonOp::Ge, sign * rest);
            }
        }
        let failed = |error: microlp::Error| Error::Program(error.to_string());
        let interrupted = |_| Error::Program("the solver was interrupted".into());
        let solution = problem.solve().map_err(failed)?.into_solution().map_err(interrupted)?;
        Ok(variables.iter().map(|of| solution.var_value(*of)).collect())
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    fn rows(errors: &[f64], speeds: &[f64]) -> JointErrors {
        let terms = speeds.iter().map(|v| [1.0, *v, v * v - 1.0, v.signum()]).collect();
        JointErrors { error: errors.to_vec(), command: speeds.to_vec(), terms }
    }

    #[test]
    fn the_middle_of_errors_is_their_best_offset() {
        let rows = rows(&[0.25, -0.5, 0.125, 1.0], &[1.0, 2.0, 3.0, 4.0]);
        let form = SetForm { terms: &[0], grows: false };
        let found = rows.smallest(0..4, form, 0.0, &TrackedSet::default()).unwrap();
        assert!((found.factors[0] - 0.25).abs() < 1e-9, "{found:?}");
        assert_eq!((&found.factors[1..], found.radius[1]), (&[0.0; 3][..], 0.0));
        assert!((found.radius[0] - 0.75).abs() < 1e-9);
        let wide = rows.smallest(0..4, form, 2.0, &TrackedSet::default()).unwrap();
        assert_eq!(wide.radius, [2.0, 0.0]);
    }

    /// No other set near the one that was found holds all rows and is smaller.
    #[test]
    fn no_other_set_is_smaller() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let mut uniform = |size: f64| random.random_range(-size..size);
        let speeds: Vec<f64> = (0..2000).map(|_| uniform(1.5)).collect();
        let nominal = |v: f64| 2e-4 - 9e-3 * v + 3e-4 * (v * v - 1.0) - 4e-4 * v.signum();
        let noisy = speeds.iter().map(|v| nominal(*v) + uniform(1e-4 + 1e-3 * v.abs()));
        let rows = rows(&noisy.collect::<Vec<f64>>(), &speeds);
        let mean_speed = speeds.iter().map(|v| v.abs()).sum::<f64>() / 2000.0;
        for grows in [false, true] {
            let form = SetForm { terms: &[0, 1, 2, 3], grows };
            let found = rows.smallest(0..2000, form, 0.0, &TrackedSet::default()).unwrap();
            assert!(rows.needed(0..2000, &found) <= 1.0 + 1e-12);
            if grows {
                assert!((found.factors[1] + 9e-3).abs() < 1e-4, "{found:?}");
                assert!((0.9e-3..1.01e-3).contains(&found.radius[1]), "{found:?}");
            }
            for _ in 0..3000 {
                let mut other = found;
                other.factors.iter_mut().for_each(|factor| *factor += uniform(1e-6));
                if grows {
                    other.radius[1] = (other.radius[1] + uniform(1e-6)).max(0.0);
                }
                // The least half-width at rest with which it holds all rows.
                let beyond = |row| {
                    let rest: f64 = rows.rest(row, &other.factors);
                    rest.abs() - other.radius[1] * speeds[row].abs()
                };
                other.radius[0] = (0..2000).map(beyond).fold(0.0, f64::max);
                let mean = |set: &TrackedSet| set.half_width(mean_speed);
                assert!(mean(&other) > mean(&found) * (1.0 - 1e-6), "{other:?}");
            }
        }
    }
}
