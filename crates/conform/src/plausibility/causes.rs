use reachtube_abstraction::ModelKind;
use reachtube_diagnose::{Change, Hypothesis, RobotMisfit, gains};
use reachtube_recordings::Run;
use reachtube_robot::JointDescription;

use crate::data::problem::Problem;
use crate::data::settings::{Equations, Method};
use crate::error::Result;
use crate::next_motion::calibration::{Calibration, Gauge};
use crate::plausibility::cause::Cause;

/// Number of runs that are looked at, at most.
const RUNS: usize = 8;

/// The inertia at the mean of the positions is named when the unexplained part is this part at most
/// of that at the expansion point.
const LARGEST_OF_MEAN: f64 = 0.7;

/// Calibration is named when it scaled the sets by this factor or more.
const LARGE_FACTOR: f64 = 2.0;

/// A robot that leaves less than this part of the input unexplained is not to blame for sets that
/// widen over a long time ...
const LARGEST_OF_GOOD: f64 = 0.25;

/// ... which is longer than this, s.
const LONG: f64 = 1.0;

/// Returns what most likely makes an answer implausible: the reading of the recordings under which
/// the robot's dynamics agree best with them, where it is much better than the one that was
/// stated, and otherwise a calibration that scaled the sets by much. `None` where the recordings
/// are too short to show one.
///
/// # Errors
///
/// As [`Problem::run`].
pub(super) fn likely_cause(
    problem: &Problem,
    calibration: Option<&Calibration>,
) -> Result<Option<Cause>> {
    let misfit = RobotMisfit::new(problem.robot(), first_runs(problem)?);
    let stated = Change::none(problem.settings().torque, problem.joints());
    let scaled = calibration.filter(|found| found.factor >= LARGE_FACTOR).map(scaled_by);
    let Some((rest, reading)) = misfit.reading(&stated) else { return Ok(scaled) };
    if let Some((hypothesis, unexplained)) = reading {
        let clause = hypothesis.clause(problem.robot());
        let kind = match hypothesis {
            Hypothesis::Kind(kind) => Some(kind),
            _ => None,
        };
        return Ok(Some(Cause::Reading { clause, kind, unexplained, as_stated: rest }));
    }
    if scaled.is_some() {
        return Ok(scaled);
    }
    let lost = lost_by_model(problem, &misfit, &stated, rest);
    Ok(lost.or(Some(horizon_or_parameters(problem, misfit.longest(), rest))))
}

/// Returns the first run of some of the problem's suites.
///
/// # Errors
///
/// As [`Problem::run`].
fn first_runs(problem: &Problem) -> Result<Vec<Run>> {
    let suites = &problem.recordings().suites;
    let stride = suites.len().div_ceil(RUNS).max(1);
    let firsts = suites.iter().step_by(stride).map(|suite| suite.totals.first);
    firsts.map(|run| Ok(problem.run(run)?.into_owned())).collect()
}

/// Returns the cause where the recordings mean what was stated, and the robot leaves `unexplained`
/// of the input: recordings as long as `longest`, s, or else parameters. What was applied already
/// is no remedy.
fn horizon_or_parameters(problem: &Problem, longest: f64, unexplained: f64) -> Cause {
    if unexplained < LARGEST_OF_GOOD && longest > LONG {
        return Cause::Horizon { unexplained, longest };
    }
    let description = problem.robot().description();
    let errors = |joint: &JointDescription| joint.friction.standard_errors.is_some();
    let is_identified = description.joints.iter().any(errors);
    let is_fitted = problem.setup().drive.is_fitted();
    Cause::Parameters { unexplained, is_identified, is_fitted, longest }
}

/// Returns which motion that was held out made the sets as large as they are.
fn scaled_by(Calibration { fitted, gauges, factor, .. }: &Calibration) -> Cause {
    let far = |a: &&Gauge, b: &&Gauge| a.gauge.total_cmp(&b.gauge);
    let motion = gauges.iter().max_by(far).map_or("", |gauge| gauge.motion.as_str());
    Cause::HeldOut { motion: motion.into(), fitted: fitted.clone(), factor: *factor }
}

/// Returns what the constant inertia of model 1 does not explain, where the robot itself leaves
/// `rest` unexplained, and the model much more.
fn lost_by_model(
    problem: &Problem,
    misfit: &RobotMisfit,
    stated: &Change,
    rest: f64,
) -> Option<Cause> {
    let settings = problem.settings();
    if settings.abstraction.model != ModelKind::One {
        return None;
    }
    let at =
        |q: &[f64]| misfit.unexplained(&Change { inertia_at: Some(q.to_vec()), ..stated.clone() });
    let origin = &settings.expansion_point.q;
    let lost = at(origin)?;
    if !gains(lost, rest) {
        return None;
    }
    let (mean, distance) = misfit.positions(origin);
    let unexplained = at(&mean)?;
    let is_mean_better = unexplained < LARGEST_OF_MEAN * lost;
    if settings.equations == Equations::Robot {
        return is_mean_better.then_some(Cause::ExpansionPoint { distance, mean });
    }
    Some(Cause::ConstantInertia {
        by_robot: rest,
        by_model: lost,
        distance,
        about_mean: is_mean_better.then_some((mean, unexplained)),
        can_follow_robot: settings.abstraction.order == 1 && settings.method == Method::Program,
    })
}
