use std::f64::consts::PI;

use reachtube_abstraction::ModelKind;
use reachtube_recordings::Torque;
use reachtube_robot::JointDescription;

use crate::data::problem::Problem;
use crate::data::settings::{Equations, Method};
use crate::error::Result;
use crate::next_motion::calibration::{Calibration, Gauge};
use crate::plausibility::cause::{Cause, Reading};
use crate::plausibility::evidence::{Evidence, Hypothesis, Misses, part};

/// A hypothesis is named when it lessens the unexplained part of the input by this much ...
const LEAST_GAIN: f64 = 0.1;

/// ... and to this part at most of what it is as stated.
const LARGEST_REST: f64 = 0.5;

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

/// Lags that are tried, s.
const LAGS: [f64; 8] = [0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2];

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
    let evidence = Evidence::new(problem)?;
    let stated = stated(problem);
    let scaled = calibration.filter(|found| found.factor >= LARGE_FACTOR).map(scaled_by);
    let as_stated = evidence.misses(&stated);
    let Some(rest) = part(&as_stated) else { return Ok(scaled) };
    let tried: Vec<Tried> = hypotheses(&stated)
        .into_iter()
        .map(|tried| Tried { misses: evidence.misses(&tried), reading: tried.reading })
        .collect();
    let likely = best(&tried, |_| true).filter(|(least, _)| gains(rest, *least));
    if let Some((unexplained, Tried { reading, .. })) =
        likely.filter(|_| carries_over(&as_stated, &tried))
    {
        let reading = reading.clone();
        return Ok(Some(Cause::Reading { reading, unexplained, as_stated: rest }));
    }
    if scaled.is_some() {
        return Ok(scaled);
    }
    let lost = lost_by_model(problem, &evidence, &stated, rest);
    Ok(lost.or(Some(horizon_or_parameters(problem, evidence.longest(), rest))))
}

/// A reading, and what it misses in each run.
struct Tried {
    reading: Reading,
    misses: Vec<Misses>,
}

/// Returns whether a reading that leaves `least` unexplained is named where `rest` is unexplained
/// as stated.
fn gains(rest: f64, least: f64) -> bool {
    rest - least > LEAST_GAIN && least < LARGEST_REST * rest
}

/// Returns the reading that leaves least unexplained in some runs, with that part.
fn best(tried: &[Tried], takes: impl Fn(usize) -> bool) -> Option<(f64, &Tried)> {
    let own = |tried: &&Tried| {
        let runs = tried.misses.iter().enumerate().filter(|(run, _)| takes(*run));
        part(runs.map(|(_, misses)| misses))
    };
    let scored = tried.iter().filter_map(|tried| Some((own(&tried)?, tried)));
    scored.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Returns whether readings lessen what is unexplained in runs that are left out too: for each run,
/// by the reading that is best for the other runs. A single run has none to be left out.
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
    evidence: &Evidence,
    stated: &Hypothesis,
    rest: f64,
) -> Option<Cause> {
    let settings = problem.settings();
    if settings.abstraction.model != ModelKind::One {
        return None;
    }
    let at = |q: &[f64]| {
        evidence.unexplained(&Hypothesis { inertia_at: Some(q.to_vec()), ..stated.clone() })
    };
    let origin = &settings.expansion_point.q;
    let lost = at(origin)?;
    if lost < LEAST_GAIN + rest || rest > LARGEST_REST * lost {
        return None;
    }
    let (mean, distance) = evidence.positions(origin);
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

/// Returns what was stated.
fn stated(problem: &Problem) -> Hypothesis {
    let n = problem.joints();
    Hypothesis {
        reading: Reading::Stated,
        torque: problem.settings().torque,
        time: 1.0,
        angle: 1.0,
        torque_factors: vec![1.0; n],
        columns: (0..n).collect(),
        lag: 0.0,
        inertia_at: None,
        softened: false,
    }
}

/// Returns what is tried instead.
fn hypotheses(stated: &Hypothesis) -> Vec<Hypothesis> {
    let mut all = Vec::new();
    let mut add = |reading: Reading, change: &dyn Fn(&mut Hypothesis)| {
        let mut hypothesis = Hypothesis { reading, ..stated.clone() };
        change(&mut hypothesis);
        all.push(hypothesis);
    };
    for (reading, factor) in [
        (Reading::TorqueUnit(1e-3), 1e-3),
        (Reading::TorqueUnit(1e3), 1e3),
        (Reading::OppositeSigns, -1.0),
    ] {
        add(reading, &|h| h.torque_factors.iter_mut().for_each(|f| *f = factor));
    }
    for kind in [Torque::Compensated, Torque::Motor, Torque::Link] {
        if kind != stated.torque {
            add(Reading::Kind(kind), &|h| h.torque = kind);
        }
    }
    if stated.torque == Torque::Motor {
        add(Reading::Filtered, &|h| h.softened = true);
    }
    add(Reading::Milliseconds, &|h| h.time = 1e-3);
    add(Reading::Degrees, &|h| h.angle = PI / 180.0);
    for lag in LAGS {
        add(Reading::Lag(lag), &|h| h.lag = lag);
    }
    let n = stated.columns.len();
    for i in 0..n {
        add(Reading::OppositeSign(i + 1), &|h| h.torque_factors[i] = -1.0);
        for j in i + 1..n {
            add(Reading::Swapped(i + 1, j + 1), &|h| h.columns.swap(i, j));
        }
    }
    all
}
