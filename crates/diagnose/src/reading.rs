use reachtube_recordings::Torque;

use crate::change::Change;
use crate::hypothesis::{Columns, Hypothesis};
use crate::robot_misfit::{Misses, RobotMisfit, part};

/// A hypothesis is named when it lessens the unexplained part of the input by this much ...
const LEAST_GAIN: f64 = 0.1;

/// ... and to this part at most of what it is as stated.
const LARGEST_REST: f64 = 0.5;

/// Lags that are tried, s.
const LAGS: [f64; 8] = [0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2];

impl RobotMisfit<'_> {
    /// Returns the part of the input that is not explained as stated, and the hypothesis that
    /// explains most with the part that is not explained under it, if it gains much, also in runs
    /// that are left out. `None` if the recordings are too short.
    #[must_use]
    pub fn reading(&self, stated: &Change) -> Option<(f64, Option<(Hypothesis, f64)>)> {
        let as_stated = self.misses(stated);
        let rest = part(&as_stated)?;
        let tried: Vec<Tried> = hypotheses(stated)
            .into_iter()
            .map(|hypothesis| {
                let change = hypothesis.change(self.robot, stated);
                Tried { misses: self.misses(&change), hypothesis }
            })
            .collect();
        let likely = best(&tried, |_| true).filter(|(least, _)| gains(rest, *least));
        let likely = likely.filter(|_| carries_over(&as_stated, &tried));
        Some((rest, likely.map(|(unexplained, tried)| (tried.hypothesis, unexplained))))
    }
}

/// Returns whether a reading that leaves `least` unexplained gains much if `rest` is unexplained
/// otherwise.
#[must_use]
pub fn gains(rest: f64, least: f64) -> bool {
    rest - least > LEAST_GAIN && least < LARGEST_REST * rest
}

/// A hypothesis, and what it misses in each run.
struct Tried {
    hypothesis: Hypothesis,
    misses: Vec<Misses>,
}

/// Returns the hypothesis that leaves least unexplained in some runs, with that part.
fn best(tried: &[Tried], takes: impl Fn(usize) -> bool) -> Option<(f64, &Tried)> {
    let own = |tried: &&Tried| {
        let runs = tried.misses.iter().enumerate().filter(|(run, _)| takes(*run));
        part(runs.map(|(_, misses)| misses))
    };
    let scored = tried.iter().filter_map(|tried| Some((own(&tried)?, tried)));
    scored.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns whether hypotheses lessen what is unexplained in runs that are left out too: for each
/// run, by the one that is best for the other runs. A single run has none to be left out.
fn carries_over(as_stated: &[Misses], tried: &[Tried]) -> bool {
    if as_stated.len() < 2 {
        return true;
    }
    let left_out = |left_out: usize| {
        let (_, best) = best(tried, |run| run != left_out)?;
        Some(&best.misses[left_out])
    };
    let misses: Option<Vec<&Misses>> = (0..as_stated.len()).map(left_out).collect();
    let least = misses.and_then(part);
    part(as_stated).zip(least).is_some_and(|(rest, least)| gains(rest, least))
}

fn hypotheses(stated: &Change) -> Vec<Hypothesis> {
    let units = [1e-3, 1e3].map(Hypothesis::TorqueUnit);
    let mut all = [&units[..], &[Hypothesis::OppositeTorques]].concat();
    let kinds = [Torque::Compensated, Torque::Motor, Torque::Link];
    all.extend(kinds.into_iter().filter(|kind| *kind != stated.torque).map(Hypothesis::Kind));
    all.extend((stated.torque == Torque::Motor).then_some(Hypothesis::Filtered));
    all.push(Hypothesis::Degrees);
    all.extend(LAGS.map(|delay| Hypothesis::Lag(None, delay)));
    let (n, columns) = (stated.torque_columns.len(), Columns::Torque);
    for joint in 0..n {
        all.push(Hypothesis::Sign(joint, columns));
        let swap = |other| Hypothesis::Swap([joint, other], columns);
        all.extend((joint + 1..n).map(swap));
    }
    all
}
