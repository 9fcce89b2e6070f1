use crate::plausibility::fault::{Columns, Fault};
use crate::prepare::log::{PreparedLog, spread};
use crate::regression::residuals::root_mean_square;
use crate::samples::{KnownTorque, Samples, Sampling};
use rayon::prelude::*;
use reachtube_robot::{BaseParameters, Parameter, Robot};
use std::f64::consts::{FRAC_PI_2, PI};

/// A fault is reported if the product of the joints' shares of the squared residuals that remain
/// without it is below this value.
const REMAINING: f64 = 0.1;

/// Number of samples that suffice to recognise a fault.
const ENOUGH_SAMPLES: f64 = 300.0;

/// Largest number of recordings in which a fault is searched.
const MOST_LOGS: usize = 64;

/// Offsets of a position that are tried \[rad\].
const OFFSETS: [f64; 9] = [0.1, -0.1, 0.3, -0.3, 0.8, -0.8, FRAC_PI_2, -FRAC_PI_2, PI];

/// Lags of torques that are tried \[s\].
const LAGS: [f64; 8] = [0.02, -0.02, 0.05, -0.05, 0.1, -0.1, 0.2, -0.2];

/// Rounds in which the size of an offset or lag is refined, each with half the step.
const REFINEMENTS: usize = 7;

/// A fault and what remains of the squared residuals without it.
pub(super) struct LikeliestFault {
    /// The fault.
    pub fault: Fault,
    /// Logarithm of the product of the joints' shares.
    score: f64,
    /// The joint whose squared residuals drop most, and the share that remains of them.
    pub clearest: (usize, f64),
}

/// Searches for the one fault of the columns that explains the torque best.
///
/// The likelihood decides, with an unknown standard deviation of each joint: a fault counts as much
/// on a joint with little torque as on one with much. The result is `None` if no fault explains
/// enough. Where the recordings do not determine all combinations of parameters (`is_determined`),
/// a false reading may explain a short motion better than the right one, because the open
/// parameters adapt to it. Only degrees are then looked for.
pub(super) fn find_fault(
    robot: &Robot,
    logs: &[PreparedLog],
    samples: &Samples,
    sampling: &Sampling,
    is_determined: bool,
) -> Option<LikeliestFault> {
    let thinned = ENOUGH_SAMPLES * samples.joints as f64 / samples.len().max(1) as f64;
    let sampling = Sampling { rate: sampling.rate * thinned.min(1.0), ..sampling.clone() };
    let columns = independent_columns(robot, &samples.columns);
    let logs: Vec<PreparedLog> = spread(logs, MOST_LOGS).into_iter().cloned().collect();
    let here = residual_sizes(robot, &columns, &logs, &sampling)?;
    let without = |fault: Fault| {
        let logs: Vec<PreparedLog> = logs.iter().map(|log| fault.corrected(robot, log)).collect();
        let sampling = fault.corrected_sampling(robot, &sampling);
        let sizes = residual_sizes(robot, &columns, &logs, &sampling)?;
        let shares = sizes.iter().zip(&here).map(|(size, here)| (size / here).powi(2));
        let score = shares.clone().map(f64::ln).sum();
        let clearest = shares.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(LikeliestFault { fault, score, clearest })
    };
    let better = |a: &LikeliestFault, b: &LikeliestFault| a.score.total_cmp(&b.score);
    let candidates = if is_determined { candidates(robot) } else { vec![Fault::Degrees] };
    let mut best = candidates.into_par_iter().filter_map(without).min_by(better)?;
    // The size of an offset or lag.
    let mut step = 0.5 * best.fault.size().unwrap_or(0.0);
    for _ in 0..REFINEMENTS {
        let fault = best.fault;
        let sizes = [-step, step].map(|step| fault.size().map(|size| size + step));
        let faults = sizes.into_iter().flatten().filter_map(|size| fault.with_size(size));
        best = faults.filter_map(without).chain([best]).min_by(better)?;
        step *= 0.5;
    }
    (best.score < REMAINING.ln()).then_some(best)
}

/// Returns all faults that are tried for a robot.
fn candidates(robot: &Robot) -> Vec<Fault> {
    let (n, mut faults) = (robot.joint_count(), vec![Fault::Degrees]);
    for joint in 0..n {
        faults.extend(Columns::CASES.map(|columns| Fault::Sign { joint, columns }));
        faults.extend(OFFSETS.map(|offset| Fault::Offset { joint, offset }));
        faults.extend(LAGS.map(|delay| Fault::Lag { joint: Some(joint), delay }));
        for other in joint + 1..n {
            let swap = |columns| Fault::Swap { joints: [joint, other], columns };
            faults.extend(Columns::CASES.map(swap));
        }
    }
    faults.extend(LAGS.map(|delay| Fault::Lag { joint: None, delay }));
    faults
}

/// Returns the parameters whose columns of the regressor are independent.
pub(super) fn independent_columns(robot: &Robot, columns: &[Parameter]) -> Vec<Parameter> {
    let base = BaseParameters::of_robot(robot, columns);
    base.independent().iter().map(|k| columns[*k]).collect()
}

/// Returns the root mean square of the torque of each joint that no parameters explain \[N m\].
///
/// The second of two fits weights each joint by its residuals. The result is `None` for too few
/// samples, which any parameters would fit.
fn residual_sizes(
    robot: &Robot,
    columns: &[Parameter],
    logs: &[PreparedLog],
    sampling: &Sampling,
) -> Option<Vec<f64>> {
    let samples = Samples::in_motion(robot, columns, logs, sampling, &KnownTorque::None);
    let used = samples.used.iter().filter(|used| **used).count();
    if used < 2 * columns.len() {
        return None;
    }
    let size = |values: &[f64], joint: usize| {
        let values = samples.joint_values(values, joint).concat();
        root_mean_square(values.into_iter()).max(f64::MIN_POSITIVE)
    };
    let mut sizes: Vec<f64> = (0..samples.joints).map(|j| size(&samples.torque, j)).collect();
    for _ in 0..2 {
        let weights: Vec<f64> =
            (0..samples.len()).map(|r| sizes[r % samples.joints].recip()).collect();
        let factor = samples.weighted_factor(&weights);
        let residuals = samples.residuals(&factor.r.solve_upper_triangular(&factor.z)?);
        sizes = (0..samples.joints).map(|j| size(&residuals, j)).collect();
    }
    Some(sizes)
}
