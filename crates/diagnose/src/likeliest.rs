use std::f64::consts::{FRAC_PI_2, PI};

use rayon::prelude::*;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::change::Change;
use crate::hypothesis::{Columns, Hypothesis};
use crate::signals::{Signals, move_alike};

/// A fault is reported if the product of the joints' shares of the squared residuals that remain
/// without it is below this value.
const REMAINING: f64 = 0.1;

/// Offsets of a position that are tried, rad.
const OFFSETS: [f64; 9] = [0.1, -0.1, 0.3, -0.3, 0.8, -0.8, FRAC_PI_2, -FRAC_PI_2, PI];

/// Lags of torques that are tried, s.
const LAGS: [f64; 8] = [0.02, -0.02, 0.05, -0.05, 0.1, -0.1, 0.2, -0.2];

/// Rounds in which the size of an offset or lag is refined, each with half the step.
const REFINEMENTS: usize = 7;

/// What remains unexplained of recorded torques.
pub(crate) trait Misfit: Sync {
    /// Returns the robot.
    fn robot(&self) -> &Robot;

    /// Returns the recordings.
    fn recordings(&self) -> &[Signals<'_>];

    /// Returns the root mean square of what remains of each joint's torque, N m, as `change` reads
    /// the recordings; `None` for too few samples, which anything would explain.
    fn sizes(&self, change: &Change) -> Option<Vec<f64>>;
}

/// A fault of the columns, and what remains of the squared residuals without it.
struct Tried {
    fault: Hypothesis,
    /// Logarithm of the product of the joints' shares.
    score: f64,
    /// The joint whose squared residuals drop most, and the share that remains of them.
    clearest: (usize, f64),
}

/// Searches for the one fault of the columns that explains the torque best. Returns it with the
/// joint whose squared residuals drop most, and the share that remains of them.
///
/// The likelihood decides, with an unknown standard deviation of each joint: a fault counts as much
/// on a joint with little torque as on one with much. The result is `None` if no fault explains
/// enough. Where the recordings do not determine all combinations of parameters (`is_determined`),
/// a false reading may explain a short motion better than the right one, because the open
/// parameters adapt to it. Only degrees are then looked for.
pub(crate) fn likeliest_fault(
    misfit: &dyn Misfit,
    is_determined: bool,
) -> Option<(Hypothesis, (usize, f64))> {
    let (robot, n) = (misfit.robot(), misfit.robot().joint_count());
    let stated = Change::none(Torque::Motor, n);
    let here = misfit.sizes(&stated)?;
    let without = |fault: Hypothesis| {
        let sizes = misfit.sizes(&fault.change(robot, &stated))?;
        let shares = sizes.iter().zip(&here).map(|(size, here)| (size / here).powi(2));
        let score = shares.clone().map(f64::ln).sum();
        let clearest = shares.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Tried { fault, score, clearest })
    };
    let better = |a: &Tried, b: &Tried| a.score.total_cmp(&b.score);
    let mut faults = faults(n);
    faults.retain(|fault| is_determined || *fault == Hypothesis::Degrees);
    // Columns of joints that move alike have the same effect.
    faults.retain(|fault| match fault {
        Hypothesis::Swap(joints, _) => !move_alike(misfit.recordings(), n, *joints),
        _ => true,
    });
    let mut best = faults.into_par_iter().filter_map(without).min_by(better)?;
    // The size of an offset or lag.
    let mut step = 0.5 * best.fault.size().unwrap_or(0.0);
    for _ in 0..REFINEMENTS {
        let fault = best.fault;
        let sizes = [-step, step].map(|step| fault.size().map(|size| size + step));
        let faults = sizes.into_iter().flatten().filter_map(|size| fault.with_size(size));
        best = faults.filter_map(without).chain([best]).min_by(better)?;
        step *= 0.5;
    }
    (best.score < REMAINING.ln()).then_some((best.fault, best.clearest))
}

fn faults(joints: usize) -> Vec<Hypothesis> {
    let mut all = vec![Hypothesis::Degrees];
    for joint in 0..joints {
        all.extend(Columns::CASES.map(|columns| Hypothesis::Sign(joint, columns)));
        all.extend(OFFSETS.map(|offset| Hypothesis::Offset(joint, offset)));
        all.extend(LAGS.map(|delay| Hypothesis::Lag(Some(joint), delay)));
        for other in joint + 1..joints {
            let swap = |columns| Hypothesis::Swap([joint, other], columns);
            all.extend(Columns::CASES.map(swap));
        }
    }
    all.extend(LAGS.map(|delay| Hypothesis::Lag(None, delay)));
    all
}
