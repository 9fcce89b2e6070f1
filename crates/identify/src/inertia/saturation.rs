//! Friction that saturates: a part of dry friction that has not built up at standstill yet.
//!
//! Friction of strain-wave gears often rises steeply at low speeds and levels off. A cubic that
//! bends so falls at higher speeds, and the nearest cubic that rises is nearly a line.

use crate::inertia::fit::InertiaFit;
use crate::inputs::Inputs;
use crate::regression::residuals::robust_standard_deviation;
use crate::samples::{KnownTorque, Samples};
use nalgebra::{DMatrix, DVector};
use reachtube_robot::friction::Stribeck;
use reachtube_robot::{FrictionDescription, Parameter, ParameterKind, Robot};
use serde::Serialize;

/// Number of stretches of the samples that are held out in turn.
const STRETCHES: usize = 8;

/// Number of speeds that are tried.
const SPEEDS: usize = 12;

/// Range of the speeds that are tried, in parts of the highest recorded speed. The low-pass blurs
/// the step of dry friction, which looks like friction that saturates at a lower speed. Friction
/// with a higher one does not level off within the recordings.
const RANGE: [f64; 2] = [0.15, 0.5];

/// Rows with residuals beyond this many robust standard deviations are not used.
const OUTLIER: f64 = 4.0;

/// Columns of the regression: sign(q̇), 1, q̇ and the part that builds up.
const COLUMNS: usize = 4;

/// Columns that take part, tried in this order: friction dissipates only if the coefficients of
/// sign(q̇), q̇ and the part that builds up are at least 0.
const CHOICES: [&[usize]; 4] = [&[0, 1, 2, 3], &[0, 1, 3], &[1, 2, 3], &[1, 3]];

/// Friction of a joint that saturates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SaturatingFriction {
    /// Name of the joint.
    pub joint: String,
    /// Dry friction that builds up with speed \[N m\].
    pub builds_up: f64,
    /// Speed over which it does \[rad/s\].
    pub speed: f64,
    /// Root mean square of the joint's residuals \[N m\] in the exciting motions: with the friction
    /// of the fit before, and over stretches held out in turn with friction that saturates.
    pub held_out: [f64; 2],
}

/// A trial that was accepted: the law, and the joint's friction with it.
pub(crate) struct Accepted {
    pub law: SaturatingFriction,
    pub friction: FrictionDescription,
}

/// Tries friction that saturates on each joint whose friction the fit `inertia` determines; `known`
/// is the robot whose friction was subtracted.
///
/// It is accepted only if it predicts held-out stretches better than the friction of the fit, which
/// has seen them, by more than two standard errors of the gain.
pub(crate) fn saturating(
    [robot, known]: [&Robot; 2],
    inertia: &InertiaFit,
    inputs: &Inputs,
) -> Vec<Option<Accepted>> {
    let (logs, torque) = (&inputs.excitation, KnownTorque::Friction(known));
    let samples = Samples::in_motion(robot, &inertia.columns, logs, &inputs.sampling, &torque);
    let residuals = samples.residuals(&inertia.values);
    let of_joint = |joint: usize| {
        let rows = JointRows::new(&samples, &residuals, (inertia, known), joint)?;
        rows.accepted(known.description().joints[joint].friction, &robot.joints()[joint].name)
    };
    (0..samples.joints).map(of_joint).collect()
}

/// The rows of one joint without the torque of the links.
struct JointRows {
    /// Velocity \[rad/s\], friction \[N m\] and residual \[N m\] of each row.
    rows: Vec<[f64; 3]>,
    speeds: Vec<f64>,
    /// For each speed and stretch, the Gram matrix of the columns and the friction.
    grams: Vec<Vec<DMatrix<f64>>>,
}

impl JointRows {
    /// Returns the rows of a joint; `None` if its friction was not fitted, or has another law.
    fn new(
        samples: &Samples,
        residuals: &[f64],
        (inertia, known): (&InertiaFit, &Robot),
        joint: usize,
    ) -> Option<Self> {
        let place = |kind: ParameterKind| {
            inertia.columns.iter().position(|column| *column == Parameter { joint, kind })
        };
        let of_velocity = place(ParameterKind::Viscous1)?;
        let fitted = [
            ParameterKind::Coulomb,
            ParameterKind::Offset,
            ParameterKind::Viscous1,
            ParameterKind::Viscous2,
            ParameterKind::Viscous3,
        ];
        let fitted: Vec<usize> = fitted.into_iter().filter_map(place).collect();
        let own = &known.joints()[joint].friction;
        if own.stribeck.is_some() {
            return None;
        }
        let used = (joint..samples.len()).step_by(samples.joints).filter(|r| samples.used[*r]);
        let used: Vec<usize> = used.collect();
        let sizes: Vec<f64> = used.iter().map(|r| residuals[*r]).collect();
        let limit = OUTLIER * robust_standard_deviation(&sizes);
        let row = |r: usize| {
            let (row, qd) = (samples.row(r), samples.row(r)[of_velocity]);
            let friction: f64 = fitted.iter().map(|c| row[*c] * inertia.values[*c]).sum();
            [qd, residuals[r] + friction + own.viscous.torque(&qd), residuals[r]]
        };
        let kept = used.into_iter().filter(|r| residuals[*r].abs() <= limit && limit > 0.0);
        let rows: Vec<[f64; 3]> = kept.map(row).collect();
        let fastest = rows.iter().map(|[qd, ..]| qd.abs()).fold(0.0, f64::max);
        if rows.len() < STRETCHES * COLUMNS || fastest <= 0.0 {
            return None;
        }
        let speeds = geometric(RANGE.map(|part| part * fastest), SPEEDS);
        let stretches = || rows.chunks(rows.len().div_ceil(STRETCHES));
        let of_speed = |speed: &f64| stretches().map(|part| gram(part, *speed)).collect();
        Some(Self { grams: speeds.iter().map(of_speed).collect(), speeds, rows })
    }

    /// Returns friction that saturates if it predicts held-out stretches better; `known` is the
    /// friction that was subtracted.
    fn accepted(&self, known: FrictionDescription, joint: &str) -> Option<Accepted> {
        let total: Vec<DMatrix<f64>> = self.grams.iter().map(|parts| parts.iter().sum()).collect();
        let length = self.rows.len().div_ceil(STRETCHES);
        let sum = |part: &[[f64; 3]]| part.iter().map(|[.., residual]| residual.powi(2)).sum();
        let without: Vec<f64> = self.rows.chunks(length).map(sum).collect();
        let of_stretch = |stretch: usize| {
            let others = total.iter().zip(&self.grams).map(|(all, parts)| all - &parts[stretch]);
            let others: Vec<DMatrix<f64>> = others.collect();
            let (at, x) = best(&others)?;
            Some(squares(&self.grams[at][stretch], &x))
        };
        let with: Vec<f64> = (0..without.len()).map(of_stretch).collect::<Option<_>>()?;
        if !gains(&without, &with) {
            return None;
        }
        let (at, x) = best(&total)?;
        let size = |squares: &[f64]| (squares.iter().sum::<f64>() / self.rows.len() as f64).sqrt();
        let (speed, builds_up) = (self.speeds[at], x[3]);
        let law = SaturatingFriction {
            joint: joint.into(),
            builds_up,
            speed,
            held_out: [size(&without), size(&with)],
        };
        let mut friction = known;
        for (quadrant, sign) in [1.0, -1.0, -1.0, 1.0].into_iter().enumerate() {
            friction.coulomb[2 * quadrant] += sign * (x[0] + builds_up) + x[1];
        }
        friction.viscous = [x[2], 0.0, 0.0];
        friction.stribeck = Some(Stribeck { excess: -builds_up, speed });
        Some(Accepted { law, friction })
    }
}

/// Returns the Gram matrix of rows [sign(q̇), 1, q̇, what builds up, friction].
fn gram(rows: &[[f64; 3]], speed: f64) -> DMatrix<f64> {
    let law = Stribeck { excess: -1.0, speed };
    let mut gram = DMatrix::zeros(COLUMNS + 1, COLUMNS + 1);
    for [qd, friction, _] in rows {
        let sign = qd.signum();
        let row = DVector::from_vec(vec![sign, 1.0, *qd, sign + law.torque(*qd), *friction]);
        gram.syger(1.0, &row, &row, 1.0);
    }
    gram.fill_upper_triangle_with_lower_triangle();
    gram
}

/// Returns the best speed's index and solution, among friction that dissipates and builds up.
fn best(grams: &[DMatrix<f64>]) -> Option<(usize, DVector<f64>)> {
    let fits = grams.iter().enumerate().filter_map(|(at, gram)| {
        let solved = CHOICES.into_iter().filter_map(|columns| solve(gram, columns));
        let dissipates = |x: &DVector<f64>| x[0] >= 0.0 && x[2] >= 0.0 && x[3] > 0.0;
        let x = solved.into_iter().find(dissipates)?;
        Some((squares(gram, &x), at, x))
    });
    fits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, at, x)| (at, x))
}

/// Returns `count` numbers from the first to the second, each the same factor above the one before.
fn geometric([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    let ratio = (high / low).powf(1.0 / (count - 1) as f64);
    (0..count).map(|k| low * ratio.powi(k as i32)).collect()
}

/// Solves the normal equations in some columns; the other entries of the result are 0. The result
/// is `None` if they do not determine it.
fn solve(gram: &DMatrix<f64>, columns: &[usize]) -> Option<DVector<f64>> {
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
fn squares(gram: &DMatrix<f64>, x: &DVector<f64>) -> f64 {
    let z = x.clone().push(-1.0);
    (z.transpose() * gram * &z)[(0, 0)].max(0.0)
}

/// Returns whether a law predicts held-out parts better, given the sums of squared residuals of
/// each part without and with it: by more than two standard errors of the mean gain.
///
/// The rule favours the simpler law, since the best of several laws looks better than it is.
fn gains(without: &[f64], with: &[f64]) -> bool {
    let gains: Vec<f64> = without.iter().zip(with).map(|(a, b)| a - b).collect();
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (count - 1.0);
    count >= 3.0 && mean > 0.0 && mean > 2.0 * (variance / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::gains;

    #[test]
    fn a_gain_counts_only_beyond_two_standard_errors() {
        assert!(gains(&[1.0, 1.1, 0.9, 1.0], &[0.8, 0.9, 0.8, 0.7]));
        // One part alone gains, and the others lose a little.
        assert!(!gains(&[1.0, 1.0, 1.0, 4.0], &[1.1, 1.1, 1.1, 2.0]));
        assert!(!gains(&[1.0, 1.0, 1.0], &[1.0, 1.0, 1.0]));
        assert!(!gains(&[1.0, 1.0], &[0.1, 0.1]));
    }
}
