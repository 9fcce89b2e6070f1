use std::f64::consts::PI;

use reachtube_abstraction::ModelKind;
use reachtube_recordings::Torque;

use crate::data::problem::Problem;
use crate::data::settings::{Equations, Method};
use crate::error::Result;
use crate::next_motion::calibration::{Calibration, Gauge};
use crate::plausibility::evidence::{Evidence, Hypothesis};

/// A hypothesis is named when it lessens the unexplained part of the input by this much ...
const LEAST_GAIN: f64 = 0.1;

/// ... and to this part at most of what it is as stated.
const LARGEST_REST: f64 = 0.5;

/// The inertia at the mean of the positions is named when the unexplained part is this part at most
/// of that at the expansion point.
const LARGEST_OF_MEAN: f64 = 0.7;

/// Calibration is named when it scaled the sets by this factor or more.
const LARGE_FACTOR: f64 = 2.0;

/// Lags that are tried, s.
const LAGS: [f64; 8] = [0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2];

/// Returns, in words, what most likely makes an answer implausible: the reading of the recordings
/// under which the robot's dynamics agree best with them, where it is much better than the one
/// that was stated, and otherwise a calibration that scaled the sets by much.
///
/// # Errors
///
/// As [`Problem::run`].
pub(super) fn likely_cause(problem: &Problem, calibration: Option<&Calibration>) -> Result<String> {
    let evidence = Evidence::new(problem)?;
    let stated = stated(problem);
    let rest = evidence.unexplained(&stated);
    let tried = hypotheses(&stated);
    let scored = tried.iter().map(|hypothesis| (evidence.unexplained(hypothesis), hypothesis));
    let best = scored.min_by(|a, b| a.0.total_cmp(&b.0));
    let percent = |part: f64| format!("{:.0} %", 100.0 * part.min(1.0));
    let likely =
        best.filter(|(least, _)| rest - least > LEAST_GAIN && *least < LARGEST_REST * rest);
    if let Some((least, hypothesis)) = likely {
        return Ok(format!(
            "the most likely cause: {}. So read, {} of the recorded input is not explained by the \
             recorded motion, and {} as stated",
            hypothesis.words,
            percent(least),
            percent(rest)
        ));
    }
    if let Some(calibration) = calibration.filter(|found| found.factor >= LARGE_FACTOR) {
        return Ok(scaled_by(calibration));
    }
    Ok(lost_by_model(problem, &evidence, &stated, rest).unwrap_or_else(|| {
        let remedy = if problem.setup().correction.is_some() {
            "the nominal model was fitted for small sets already, so record more motions, or cut \
             them into shorter windows (`reachtube prepare --window`)"
        } else {
            "check the robot's parameters, for example with `reachtube identify`, or fit the \
             nominal model for small sets (--fit)"
        };
        format!(
            "units, signs, kind of torque, order of joints and lags fit, but {} of the recorded \
             input does not follow from the recorded motion: {remedy}",
            percent(rest)
        )
    }))
}

/// Returns, in words, which motion that was held out made the sets as large as they are.
fn scaled_by(Calibration { fitted, gauges, factor, .. }: &Calibration) -> String {
    let far = |a: &&Gauge, b: &&Gauge| a.gauge.total_cmp(&b.gauge);
    let motion = gauges.iter().max_by(far).map_or("", |gauge| gauge.motion.as_str());
    format!(
        "the most likely cause: motion {motion}, which was held out, is unlike the motions that \
         the sets were found with ({}), so that calibration scaled these sets by {factor:.2}; \
         record more motions to find the sets with, among them some like {motion}",
        fitted.join(", ")
    )
}

/// Returns, in words, what the constant inertia of model 1 does not explain, where the robot itself
/// leaves `rest` unexplained, and the model much more.
fn lost_by_model(
    problem: &Problem,
    evidence: &Evidence,
    stated: &Hypothesis,
    rest: f64,
) -> Option<String> {
    let settings = problem.settings();
    if settings.abstraction.model != ModelKind::One {
        return None;
    }
    let at = |q: &[f64]| {
        evidence.unexplained(&Hypothesis { inertia_at: Some(q.to_vec()), ..stated.clone() })
    };
    let origin = &settings.expansion_point.q;
    let lost = at(origin);
    if lost < LEAST_GAIN + rest || rest > LARGEST_REST * lost {
        return None;
    }
    let (mean, distance) = evidence.positions(origin);
    let percent = |part: f64| format!("{:.0} %", 100.0 * part.min(1.0));
    let about_mean = at(&mean);
    let point = mean.iter().map(|q| format!("{q:.2}")).collect::<Vec<_>>().join(",");
    let is_mean_better = about_mean < LARGEST_OF_MEAN * lost;
    if settings.equations == Equations::Robot {
        return is_mean_better.then(|| {
            format!(
                "the nominal motions follow the robot, and deviations from them the inertia at the \
                 expansion point, from which the positions lie up to {distance:.2} rad: \
                 --expansion={point} is the mean of the positions"
            )
        });
    }
    let better = if is_mean_better {
        format!(
            "with --expansion={point}, the mean of the positions, {} is not; ",
            percent(about_mean)
        )
    } else {
        String::new()
    };
    let remedy = if settings.abstraction.order == 1 && settings.method == Method::Program {
        "with --equations robot the nominal motions follow the robot"
    } else {
        "model 3 of order 2 (--model 3 --order 2) knows how the inertia changes"
    };
    Some(format!(
        "the robot explains the recordings, and model 1 does not: {} of the recorded input is not \
         explained by the robot, and {} by the inertia at the expansion point, from which the \
         positions lie up to {distance:.2} rad; {better}{remedy}; shorter windows lessen what is \
         missed",
        percent(rest),
        percent(lost),
    ))
}

/// Returns what was stated.
fn stated(problem: &Problem) -> Hypothesis {
    let n = problem.joints();
    Hypothesis {
        words: String::new(),
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
    let mut add = |words: String, change: &dyn Fn(&mut Hypothesis)| {
        let mut hypothesis = stated.clone();
        hypothesis.words = words;
        change(&mut hypothesis);
        all.push(hypothesis);
    };
    for (words, factor) in [
        ("the torques are in N mm, not in N m", 1e-3),
        ("the torques are in kN m, not in N m", 1e3),
        ("the torques have the opposite sign", -1.0),
    ] {
        add(words.into(), &|h| h.torque_factors.iter_mut().for_each(|f| *f = factor));
    }
    for kind in [Torque::Compensated, Torque::Motor, Torque::Link] {
        if kind != stated.torque {
            let word = format!("{kind:?}").to_lowercase();
            add(format!("the torques are of the kind `{word}` (--torque {word})"), &|h| {
                h.torque = kind;
            });
        }
    }
    if stated.torque == Torque::Motor {
        let words = "dry friction steps where joints turn and rest, and the recorded torques do \
                     not, as where they were filtered; `reachtube prepare --compensate` writes \
                     inputs that are free of it";
        add(words.into(), &|h| h.softened = true);
    }
    add("the times are in ms, not in s".into(), &|h| h.time = 1e-3);
    let degrees = "positions and velocities are in degrees, not in rad";
    add(degrees.into(), &|h| h.angle = PI / 180.0);
    for lag in LAGS {
        let words = format!("the torques are about {lag} s later than the motion");
        add(words, &|h| h.lag = lag);
    }
    let n = stated.columns.len();
    for i in 0..n {
        let words = format!("the torque of joint {} has the opposite sign", i + 1);
        add(words, &|h| h.torque_factors[i] = -1.0);
        for j in i + 1..n {
            let words = format!("the torques of joints {} and {} are swapped", i + 1, j + 1);
            add(words, &|h| h.columns.swap(i, j));
        }
    }
    all
}
