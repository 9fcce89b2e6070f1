//! The trial of the Stribeck effect on the slow motions of one joint.

use crate::friction::form::CoulombForm;
use crate::friction::model::FrictionModel;
use crate::friction::sample::FrictionSample;
use crate::held_out::gains;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Number of stretches of the samples that are held out in turn.
const STRETCHES: usize = 8;

/// Number of speeds of each of the two scans, the second between the neighbours of the best.
const SPEEDS: usize = 24;

/// Samples slower than the Stribeck speed that each direction needs.
const MIN_SLOW: usize = 8;

/// Quantile of the speeds at which the scan starts, and share of the highest at which it ends.
const SCAN: [f64; 2] = [0.05, 0.5];

/// What the trial of the Stribeck effect on a joint has found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StribeckTrial {
    /// Root mean square of the torque residual over stretches of the slow motions that were held
    /// out in turn \[N m\], without and with the effect.
    pub held_out: [f64; 2],
    /// Whether the friction of the joint has the effect.
    pub accepted: bool,
    /// Reason why it does not.
    pub reason: Option<String>,
}

/// Tries the Stribeck effect on samples with these row weights: the speed by a scan, the rest by
/// least squares. Returns the trial and the speed \[rad/s\] where the effect is accepted.
///
/// The effect is accepted only if it predicts held-out stretches better, by more than two standard
/// errors of the gain. Each stretch gets a speed of its own, so that the scan is held out too.
pub(super) fn try_stribeck(
    form: CoulombForm,
    samples: &[FrictionSample],
    weights: &[f64],
) -> (StribeckTrial, Option<f64>) {
    let range = scan_range(samples);
    let scan = StribeckScan::new(form, samples, weights, &geometric(range, SPEEDS));
    let (without, with) = scan.held_out();
    let size = |squares: &[f64]| (squares.iter().sum::<f64>() / samples.len() as f64).sqrt();
    let held_out = [size(&without), size(&with)];
    let refused =
        |reason: String| (StribeckTrial { held_out, accepted: false, reason: Some(reason) }, None);
    if !gains(&without, &with) {
        return refused("held-out slow motions are not predicted better with it".into());
    }
    let Some((best, _)) = scan.best(&scan.total()) else {
        return refused("friction does not rise toward standstill".into());
    };
    if best == 0 {
        let slowest = range[0];
        return refused(format!(
            "the slow motions show friction down to {slowest:.4} rad/s (m/s) only, and the effect \
             would lie below; record slower ones"
        ));
    }
    let near = [scan.speeds[best - 1], scan.speeds[(best + 1).min(SPEEDS - 1)]];
    let fine = StribeckScan::new(form, samples, weights, &geometric(near, SPEEDS));
    let speed = fine.best(&fine.total()).map_or(scan.speeds[best], |(at, _)| fine.speeds[at]);
    let slower = |forward: bool| {
        let slow = |s: &&FrictionSample| s.qd.abs() < speed && (s.qd > 0.0) == forward;
        samples.iter().filter(slow).count()
    };
    if slower(true).min(slower(false)) < MIN_SLOW {
        return refused(format!(
            "too few samples are slower than {speed:.4} rad/s (m/s) in both directions; record more"
        ));
    }
    (StribeckTrial { held_out, accepted: true, reason: None }, Some(speed))
}

/// Returns the slowest and the fastest Stribeck speed that the samples can show.
fn scan_range(samples: &[FrictionSample]) -> [f64; 2] {
    let mut speeds: Vec<f64> = samples.iter().map(|s| s.qd.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    let slowest = speeds[(SCAN[0] * speeds.len() as f64) as usize];
    let fastest = SCAN[1] * speeds.last().copied().unwrap_or(0.0);
    [slowest, fastest.max(1.1 * slowest)]
}

/// Returns `count` numbers from the first to the second, each the same factor above the one before.
pub(crate) fn geometric([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    let ratio = (high / low).powf(1.0 / (count - 1) as f64);
    (0..count).map(|k| low * ratio.powi(k as i32)).collect()
}

/// The normal equations of every stretch of the samples at every speed of a scan.
struct StribeckScan {
    speeds: Vec<f64>,
    /// Columns without the Stribeck effect.
    columns: usize,
    /// For each speed and stretch, the Gram matrix of rows [a, y].
    grams: Vec<Vec<DMatrix<f64>>>,
}

impl StribeckScan {
    fn new(form: CoulombForm, samples: &[FrictionSample], weights: &[f64], speeds: &[f64]) -> Self {
        let length = samples.len().div_ceil(STRETCHES);
        let gram = |speed: f64, stretch: usize| {
            let model = FrictionModel { form, stribeck: Some(speed) };
            let width = model.columns() + 1;
            let rows = stretch * length..((stretch + 1) * length).min(samples.len());
            let mut gram = DMatrix::zeros(width, width);
            for k in rows {
                let mut row = model.row(&samples[k]);
                row.push(samples[k].torque);
                let row = DVector::from_vec(row) * weights[k];
                gram.syger(1.0, &row, &row, 1.0);
            }
            gram.fill_upper_triangle_with_lower_triangle();
            gram
        };
        let of_speed = |speed: &f64| (0..STRETCHES).map(|stretch| gram(*speed, stretch)).collect();
        Self {
            columns: form.columns(),
            grams: speeds.iter().map(of_speed).collect(),
            speeds: speeds.to_vec(),
        }
    }

    /// Returns the Gram matrix of all stretches for each speed.
    fn total(&self) -> Vec<DMatrix<f64>> {
        self.grams.iter().map(|stretches| stretches.iter().sum()).collect()
    }

    /// Returns the best speed's index and solution, among the speeds at which friction rises toward
    /// standstill.
    fn best(&self, grams: &[DMatrix<f64>]) -> Option<(usize, DVector<f64>)> {
        let all: Vec<usize> = (0..=self.columns).collect();
        let fits = grams.iter().enumerate().filter_map(|(at, gram)| {
            let x = solve(gram, &all).filter(|x| x[self.columns] > 0.0)?;
            Some((squares(gram, &x), at, x))
        });
        fits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at, x)| (at, x))
    }

    /// Returns the sum of squared residuals of each stretch, held out in turn, without and with
    /// the effect.
    fn held_out(&self) -> (Vec<f64>, Vec<f64>) {
        let total = self.total();
        let base: Vec<usize> = (0..self.columns).collect();
        let of_stretch = |stretch: usize| {
            let others: Vec<DMatrix<f64>> =
                total.iter().zip(&self.grams).map(|(all, parts)| all - &parts[stretch]).collect();
            let without = solve(&others[0], &base);
            let error = |at: usize, x: &DVector<f64>| squares(&self.grams[at][stretch], x);
            let without = without.map_or(f64::INFINITY, |x| error(0, &x));
            let with = self.best(&others).map_or(without, |(at, x)| error(at, &x));
            (without, with)
        };
        (0..STRETCHES).map(of_stretch).unzip()
    }
}

/// Solves the normal equations in some columns; the other entries of the result are 0. The result
/// is `None` where they do not determine it.
pub(crate) fn solve(gram: &DMatrix<f64>, columns: &[usize]) -> Option<DVector<f64>> {
    let last = gram.ncols() - 1;
    let scale: Vec<f64> = columns.iter().map(|c| gram[(*c, *c)].sqrt()).collect();
    if scale.iter().any(|scale| *scale <= 0.0) {
        return None;
    }
    let p = columns.len();
    let entry = |i: usize, j: usize| gram[(columns[i], columns[j])] / (scale[i] * scale[j]);
    let right = DVector::from_fn(p, |i, _| gram[(columns[i], last)] / scale[i]);
    let unit = DMatrix::from_fn(p, p, entry).cholesky()?.solve(&right);
    let mut x = DVector::zeros(last);
    (0..p).for_each(|i| x[columns[i]] = unit[i] / scale[i]);
    Some(x)
}

/// Returns the sum of squared residuals of rows with this Gram matrix.
pub(crate) fn squares(gram: &DMatrix<f64>, x: &DVector<f64>) -> f64 {
    let z = x.clone().push(-1.0);
    (z.transpose() * gram * &z)[(0, 0)].max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::fit::{FrictionFit, fit_with_stribeck};
    use rand::RngExt;
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::SeedableRng;

    /// Fits slow swings down to a speed \[rad/s\], whose torque is written out anew: Coulomb
    /// friction 3 N m, viscous friction 6 N m s/rad, and a rise of `excess` below 0.08 rad/s.
    fn fitted(excess: f64, slowest: f64, seed: u64) -> FrictionFit {
        let mut generator = SplitMix64::seed_from_u64(seed);
        let mut random = || generator.random::<f64>() - 0.5;
        let sample = |k: usize| {
            let t = 0.06 * k as f64;
            let (qd, qdd) = (0.6 * (0.7 * t).sin(), 0.42 * (0.7 * t).cos());
            let load = 5.0 * (0.11 * t).cos();
            let rise = excess / (qd * qd / 0.0064).exp();
            let torque = (3.0 + rise) * qd / qd.abs() + 6.0 * qd + 1.7 * qdd + 0.2 * random();
            FrictionSample { qd, qdd, load, torque, factors: [1.0; 2] }
        };
        let samples: Vec<_> = (1..1000).map(sample).filter(|s| s.qd.abs() > slowest).collect();
        fit_with_stribeck("joint", &samples, 0.6).unwrap()
    }

    #[test]
    fn excess_and_speed_are_recovered_within_their_errors() {
        let mut within = 0;
        for seed in 1..=10 {
            let found = fitted(1.2, 0.005, seed).joint;
            let (law, error) =
                (found.coefficients.stribeck.unwrap(), found.standard_errors.stribeck.unwrap());
            let off =
                [(law.excess - 1.2).abs() / error.excess, (law.speed - 0.08).abs() / error.speed];
            assert!(off.iter().all(|off| *off < 4.0), "{law:?} ± {error:?}");
            assert!(error.excess < 0.1 && error.speed < 0.01, "{error:?}");
            within += off.iter().filter(|off| **off < 2.0).count();
            let [without, with] = found.stribeck.unwrap().held_out;
            assert!(with < 0.9 * without, "{without} {with}");
        }
        assert!(within >= 16, "{within} of 20 within two standard errors");
    }

    #[test]
    fn an_effect_that_is_not_there_or_not_shown_is_refused_with_the_reason() {
        let refused: Vec<String> = (1..=10)
            .filter_map(|seed| fitted(0.0, 0.005, seed).joint.stribeck.unwrap().reason)
            .collect();
        assert!(refused.len() >= 9, "{refused:?}");
        assert!(refused[0].contains("held-out slow motions are not predicted better"));
        let fast = fitted(1.2, 0.3, 1).joint;
        assert_eq!(fast.coefficients.stribeck, None);
        assert!(!fast.stribeck.unwrap().accepted);
    }
}
