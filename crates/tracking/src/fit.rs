//! The nominal error of a joint with the smallest radius that holds its rows: a linear program,
//! whose rows are added where they are violated.

use microlp::{ComparisonOp, OptimizationDirection, Problem, Variable};

use crate::basis::TERMS;
use crate::error::{Error, Result};

/// Rows are added until none is violated by more than this part of the radius.
const TOLERANCE: f64 = 1e-6;

/// Largest number of rounds of added rows; each adds two rows, so that fewer suffice by far.
const ROUNDS: usize = 200;

/// The error of one joint at some samples, and the terms that it may depend on.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rows {
    /// The actual position minus the commanded one, rad.
    pub error: Vec<f64>,
    /// 1, ṙ, r̈.
    pub terms: Vec<[f64; TERMS]>,
}

/// A nominal error θ · (1, ṙ, r̈) and the largest distance of the rows from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Centred {
    pub factors: [f64; TERMS],
    pub radius: f64,
}

impl Rows {
    /// Returns the error of a row without its nominal part.
    pub(crate) fn rest(&self, row: usize, factors: &[f64; TERMS]) -> f64 {
        let nominal = factors.iter().zip(&self.terms[row]).map(|(a, b)| a * b).sum::<f64>();
        self.error[row] - nominal
    }

    /// Returns the largest distance of some rows from a nominal error.
    pub(crate) fn furthest(
        &self,
        rows: impl Iterator<Item = usize>,
        factors: &[f64; TERMS],
    ) -> f64 {
        rows.map(|row| self.rest(row, factors).abs()).fold(0.0, f64::max)
    }

    /// Returns the rows with the largest and the smallest rest.
    fn ends(&self, rows: impl Iterator<Item = usize>, factors: &[f64; TERMS]) -> [(usize, f64); 2] {
        let mut ends = [(0, f64::NEG_INFINITY), (0, f64::INFINITY)];
        for row in rows {
            let rest = self.rest(row, factors);
            if rest > ends[0].1 {
                ends[0] = (row, rest);
            }
            if rest < ends[1].1 {
                ends[1] = (row, rest);
            }
        }
        ends
    }

    /// Returns the nominal error of the first `used` terms from which some rows are the least far.
    /// `near` is a guess.
    ///
    /// # Errors
    ///
    /// [`Error::Program`] where the solver fails.
    pub(crate) fn centred(
        &self,
        rows: impl Iterator<Item = usize> + Clone,
        used: usize,
        near: &[f64; TERMS],
    ) -> Result<Centred> {
        // Each unknown in units in which it matters as much as the others.
        let size = |term: usize| rows.clone().map(move |row| self.terms[row][term].abs());
        let largest = |term: usize| size(term).fold(0.0, f64::max);
        let units: [f64; TERMS] = std::array::from_fn(largest);
        let scale = self.furthest(rows.clone(), near);
        if scale == 0.0 {
            return Ok(Centred { factors: *near, radius: 0.0 });
        }
        let unknown: Vec<usize> = (0..used).filter(|term| units[*term] > 0.0).collect();
        let mut factors: [f64; TERMS] =
            std::array::from_fn(|term| if unknown.contains(&term) { near[term] } else { 0.0 });
        let start = factors;
        let (mut radius, mut sides) = (0.0, Vec::new());
        for _ in 0..ROUNDS {
            let ends = self.ends(rows.clone(), &factors);
            if ends.iter().all(|(_, rest)| rest.abs() <= radius * (1.0 + TOLERANCE)) {
                break;
            }
            sides.extend(ends.map(|(row, _)| {
                let terms = unknown.iter().map(|term| self.terms[row][*term] / units[*term]);
                (terms.collect(), self.rest(row, &start) / scale)
            }));
            let found = least(&sides, unknown.len())?;
            for (term, value) in unknown.iter().zip(&found) {
                factors[*term] = start[*term] + value * scale / units[*term];
            }
            radius = found[unknown.len()] * scale;
        }
        Ok(Centred { factors, radius: self.furthest(rows, &factors) })
    }
}

/// Returns the θ, `count` numbers, and the ρ of min ρ subject to |rest - θ · terms| <= ρ for all
/// rows (terms, rest).
fn least(rows: &[(Vec<f64>, f64)], count: usize) -> Result<Vec<f64>> {
    let mut problem = Problem::new(OptimizationDirection::Minimize);
    let free = (f64::NEG_INFINITY, f64::INFINITY);
    let mut variables: Vec<Variable> = (0..count).map(|_| problem.add_var(0.0, free)).collect();
    variables.push(problem.add_var(1.0, (0.0, f64::INFINITY)));
    for (terms, rest) in rows {
        for sign in [1.0, -1.0] {
            let row = variables.iter().zip(terms.iter().map(|term| sign * term).chain([1.0]));
            let row: Vec<(Variable, f64)> = row
                .filter(|(_, factor)| *factor != 0.0)
                .map(|(of, factor)| (*of, factor))
                .collect();
            problem.add_constraint(&row, ComparisonOp::Ge, sign * rest);
        }
    }
    let failed = |error: microlp::Error| Error::Program(error.to_string());
    let interrupted = |_| Error::Program("the solver was interrupted".into());
    let solution = problem.solve().map_err(failed)?.into_solution().map_err(interrupted)?;
    Ok(variables.iter().map(|of| solution.var_value(*of)).collect())
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    fn rows(errors: &[f64], speeds: &[f64]) -> Rows {
        let terms = speeds.iter().map(|v| [1.0, *v, v * v - 1.0]).collect();
        Rows { error: errors.to_vec(), terms }
    }

    #[test]
    fn the_middle_of_errors_is_their_best_offset() {
        let rows = rows(&[0.25, -0.5, 0.125, 1.0], &[1.0, 2.0, 3.0, 4.0]);
        let Centred { factors, radius } = rows.centred(0..4, 1, &[0.0; 3]).unwrap();
        assert!((factors[0] - 0.25).abs() < 1e-9 && factors[1..] == [0.0, 0.0], "{factors:?}");
        assert!((radius - 0.75).abs() < 1e-9);
    }

    #[test]
    fn no_other_nominal_error_is_nearer() {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let speeds: Vec<f64> = (0..2000).map(|_| random.random_range(-1.5..1.5)).collect();
        let error = |v: &f64| 2e-4 - 9e-3 * v + 3e-4 * (v * v - 1.0);
        let noise = |random: &mut Xoshiro256PlusPlus| random.random_range(-1e-4..1e-4);
        let errors: Vec<f64> = speeds.iter().map(|v| error(v) + noise(&mut random)).collect();
        let rows = rows(&errors, &speeds);
        let found = rows.centred(0..2000, 3, &[0.0; 3]).unwrap();
        assert!((found.factors[1] + 9e-3).abs() < 1e-5, "{found:?}");
        assert!(found.radius < 1e-4, "{found:?}");
        for _ in 0..10_000 {
            let step =
                |size: f64, random: &mut Xoshiro256PlusPlus| random.random_range(-size..size);
            let mut other = found.factors;
            other.iter_mut().for_each(|factor| *factor += step(1e-6, &mut random));
            let radius = rows.furthest(0..2000, &other);
            assert!(radius > found.radius * (1.0 - 1e-6), "{other:?}: {radius}");
        }
    }
}
