//! Numbers of a system by least squares: nominal outputs as near to the recorded ones as they get.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::error::Result;
use crate::run::SystemRun;
use crate::system::OutputSystem;

/// Largest number of steps.
const STEPS: usize = 40;

/// A step that gains less than this part of the error is the last one.
const GAIN: f64 = 1e-9;

/// Part of a number by which it is moved for a derivative.
const MOVED: f64 = 1e-6;

/// How many outputs are compared at most; of more, every second, third or further one.
const MOST_OUTPUTS: usize = 40_000;

/// The system of some numbers, with its recordings.
type SystemOfNumbers<'a> = dyn Fn(&[f64]) -> Option<(OutputSystem, Vec<SystemRun>)> + Sync + 'a;

/// Numbers of a system, between bounds.
pub(crate) struct FreeNumbers<'a> {
    /// The lowest and the highest value of each.
    pub bounds: Vec<[f64; 2]>,
    /// Returns the system of some numbers, with its recordings; `None` if it is impossible.
    pub system: &'a SystemOfNumbers<'a>,
    /// The weight of each output.
    pub weights: Vec<f64>,
}

impl FreeNumbers<'_> {
    /// Returns recorded minus nominal outputs, each times its weight; `None` where a motion runs
    /// away.
    fn errors(&self, numbers: &[f64]) -> Option<DVector<f64>> {
        let (system, runs) = (self.system)(numbers)?;
        let errors = runs.iter().map(|run| system.rough_errors(run)).collect::<Result<Vec<_>>>();
        let errors = errors.ok()?;
        let p = self.weights.len();
        let count: usize = errors.iter().map(Vec::len).sum();
        let stride = p * (count / MOST_OUTPUTS / p).max(1);
        let kept = errors.iter().flatten().enumerate().filter(|(at, _)| at % stride < p);
        let errors = DVector::from_vec(kept.map(|(at, e)| e * self.weights[at % p]).collect());
        errors.iter().all(|error| error.is_finite()).then_some(errors)
    }

    /// Returns the numbers of the least sum of squared errors near `start`, by Levenberg's and
    /// Marquardt's method.
    pub(crate) fn least_squares(&self, start: &[f64]) -> Vec<f64> {
        let within = |numbers: Vec<f64>| -> Vec<f64> {
            let pairs = numbers.into_iter().zip(&self.bounds);
            pairs.map(|(number, [low, high])| number.clamp(*low, *high)).collect()
        };
        let mut numbers = within(start.to_vec());
        let Some(mut errors) = self.errors(&numbers) else { return numbers };
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let moved = |j: usize| {
                let mut other = numbers.clone();
                let [low, high] = self.bounds[j];
                let by = MOVED * numbers[j].abs().max((high - low).min(1.0)).max(1e-3);
                other[j] += if numbers[j] + by > high { -by } else { by };
                let slope =
                    |other_errors: DVector<f64>| (other_errors - &errors) / (other[j] - numbers[j]);
                self.errors(&other).map_or_else(|| errors.map(|_| 0.0), slope)
            };
            let columns: Vec<DVector<f64>> =
                (0..numbers.len()).into_par_iter().map(moved).collect();
            let slopes = DMatrix::from_columns(&columns);
            let (normal, right) = (slopes.tr_mul(&slopes), slopes.tr_mul(&errors));
            let before = errors.norm_squared();
            let mut gained = 0.0;
            while gained == 0.0 && damping < 1e9 {
                let mut damped = normal.clone();
                // A number without effect stays.
                let least = f64::MIN_POSITIVE + 1e-12 * normal.diagonal().max();
                (0..numbers.len()).for_each(|j| {
                    damped[(j, j)] = damped[(j, j)].max(least) * (1.0 + damping);
                });
                let step = damped.cholesky().map(|of| of.solve(&right));
                let next = step.map(|step| {
                    within(numbers.iter().zip(&step).map(|(number, step)| number - step).collect())
                });
                let next = next.and_then(|next| Some((self.errors(&next)?, next)));
                match next.filter(|(errors, _)| errors.norm_squared() < before) {
                    Some((better, next)) => {
                        gained = before - better.norm_squared();
                        (errors, numbers) = (better, next);
                        damping /= 5.0;
                    }
                    None => damping *= 5.0,
                }
            }
            if gained <= GAIN * before {
                break;
            }
        }
        numbers
    }
}

impl OutputSystem {
    /// Returns the system with the parameters of the least errors along recordings; itself without
    /// parameters.
    ///
    /// # Errors
    ///
    /// [`Error::System`](crate::Error::System) where they make no system.
    pub(crate) fn fitted(&self, runs: &[SystemRun]) -> Result<Self> {
        let parameters: Vec<_> = self.description().parameters.values().collect();
        if parameters.is_empty() {
            return Ok(self.clone());
        }
        let with = |numbers: &[f64]| {
            let mut description = self.description().clone();
            let own = description.parameters.values_mut();
            own.zip(numbers).for_each(|(parameter, number)| parameter.start = *number);
            Self::new(description)
        };
        let free = FreeNumbers {
            bounds: parameters.iter().map(|of| [of.low, of.high]).collect(),
            system: &|numbers| Some((with(numbers).ok()?, runs.to_vec())),
            weights: self.weights(runs),
        };
        let start: Vec<f64> = parameters.iter().map(|of| of.start).collect();
        with(&free.least_squares(&start))
    }
}
