use crate::error::{Error, Result};
use crate::prepare::changes::{LogChange, described};
use crate::prepare::log::PreparedLog;
use crate::prepare::low_pass::{LowPass, TRANSIENT_PERIODS};
use crate::prepare::raw_log::RawLog;
use crate::prepare::resample::median_step;
use crate::prepare::settings::{PrepareSettings, VelocitySource, gain_of_each_joint};
use crate::prepare::signals::Signals;
use rayon::prelude::*;
use reachtube_diagnose::median;
use reachtube_recordings::Torque;
use reachtube_robot::friction::Coulomb;
use reachtube_robot::{Joint, Robot};

/// Relative difference up to which two sample times count as the same.
const SAME_STEP: f64 = 0.25;

/// Samples that must remain between the ends.
const MIN_SAMPLES: usize = 8;

/// Prepared logs and how they were changed.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// The logs in the order given.
    pub logs: Vec<PreparedLog>,
    /// Cut-off frequency of the low-pass \[Hz\].
    pub cut_off: f64,
    /// Changes to the recordings, one sentence each.
    pub changes: Vec<String>,
}

/// Prepares recordings for regression with a low-pass of cut-off `cut_off` \[Hz\].
///
/// Samples become evenly spaced, gains are applied to torques, and positions, velocities and
/// torques are filtered without phase shift. Accelerations are derivatives of the velocity. Both
/// ends, where the filter extrapolates, are cut by 2.5 periods of the cut-off.
///
/// `compensated` takes gravity and dry friction of this robot off the torques, which are then the
/// input u of (11). Near standstill, friction holds a joint ([`Robot::input_from_holding_torque`]).
/// What is subtracted is filtered as the torques are: where a joint turns, friction steps, and the
/// filtered torque does not. An input that is computed from filtered torques misses up to twice the
/// friction about every turn.
///
/// # Errors
///
/// [`Error::TooShort`] and [`Error::SampledTooSlowly`] name a recording that does not suit the
/// cut-off; [`Error::GainCount`] and [`Error::Gain`].
pub fn prepare(
    raw: &[RawLog],
    settings: &PrepareSettings,
    cut_off: f64,
    compensated: Option<&Robot>,
) -> Result<Prepared> {
    let steps = raw.iter().filter_map(|log| median_step(&log.run.times));
    let common = median(steps).unwrap_or(0.0);
    let done: Vec<(PreparedLog, LogChange)> = raw
        .par_iter()
        .map(|log| prepare_one(log, settings, cut_off, common, compensated))
        .collect::<Result<_>>()?;
    let (logs, changes): (Vec<PreparedLog>, Vec<LogChange>) = done.into_iter().unzip();
    let mut changes =
        described(logs.iter().map(PreparedLog::len).sum(), &changes, settings, cut_off);
    changes.extend(raw.iter().filter_map(|log| log.filled_gaps(settings.max_gap)));
    changes.extend(compensated.map(compensation));
    let has_motors = |robot: &&Robot| {
        settings.torque == Some(Torque::Link)
            && robot.joints().iter().any(|joint| joint.armature > 0.0)
    };
    changes.extend(compensated.filter(has_motors).map(|_| {
        "torques behind the gears do not drive the motors: this is the input of the robot without \
         `armature`, which `conform` then needs"
            .to_string()
    }));
    Ok(Prepared { logs, cut_off, changes })
}

/// Samples a recording evenly and filters nothing: for torques that are a model's input already, in
/// which a low-pass would blur the steps. `gains` multiply the torques; an empty list stands for 1.
/// Accelerations are derivatives of the velocity.
///
/// # Errors
///
/// [`Error::TooShort`] for a recording of one sample; [`Error::GainCount`] and [`Error::Gain`].
pub fn unfiltered(raw: &RawLog, gains: &[f64]) -> Result<PreparedLog> {
    let step = median_step(&raw.run.times).ok_or_else(|| Error::TooShort {
        log: raw.name.clone(),
        samples: raw.run.len(),
        duration: raw.run.duration(),
        cut_off: f64::INFINITY,
    })?;
    let gains = gain_of_each_joint(gains, raw.run.joints)?;
    Ok(Signals { raw, filter: None, step }.log(&gains, false))
}

/// Describes what was subtracted from the torques.
fn compensation(robot: &Robot) -> String {
    let has_friction = |joint: &Joint| {
        joint.friction.coulomb != Coulomb::default() || joint.friction.stribeck.is_some()
    };
    let [what, rest] = if robot.joints().iter().any(has_friction) {
        ["gravity and dry friction", ""]
    } else {
        ["gravity", "; there is no dry friction in its description"]
    };
    format!(
        "subtracted {what} of {} from tau, filtered like tau: tau is now the input u (--torque \
         compensated){rest}",
        robot.name()
    )
}

/// Returns how long a recording is at least \[s\] of which a low-pass of `cut_off` \[Hz\] leaves
/// samples, if they are `step` \[s\] apart; and the part of it that the ends take.
#[must_use]
pub fn shortest(cut_off: f64, step: f64) -> [f64; 2] {
    let ends = 2.0 * TRANSIENT_PERIODS / cut_off;
    // Twice as many samples, for steps that differ from one recording to the next.
    [ends + 2.0 * MIN_SAMPLES as f64 * step, ends]
}

/// Prepares one recording.
///
/// Recordings sampled at nearly the same rate get the same sample time, `common` \[s\], so that
/// repeats can be compared sample by sample.
pub(crate) fn prepare_one(
    raw: &RawLog,
    settings: &PrepareSettings,
    cut_off: f64,
    common: f64,
    compensated: Option<&Robot>,
) -> Result<(PreparedLog, LogChange)> {
    let too_short = || Error::TooShort {
        log: raw.name.clone(),
        samples: raw.run.len(),
        duration: raw.run.duration(),
        cut_off,
    };
    // One even sample time.
    let usual = median_step(&raw.run.times).ok_or_else(too_short)?;
    let step = if (usual / common - 1.0).abs() < SAME_STEP { common } else { usual };
    // Filtered signals of all joints.
    let filter = LowPass::new(cut_off, step.recip()).ok_or_else(|| Error::SampledTooSlowly {
        log: raw.name.clone(),
        rate: step.recip(),
        cut_off,
    })?;
    let signals = Signals { raw, filter: Some(filter), step };
    let differentiated = match settings.velocity {
        VelocitySource::Recorded => false,
        VelocitySource::Differentiated => true,
        VelocitySource::Quieter => signals.is_differentiated_quieter() || signals.lag(),
    };
    let gains = settings.gain_of_each_joint(raw.run.joints)?;
    let mut log = signals.log(&gains, differentiated);
    log.before = signals.before(cut_off, differentiated);
    if let Some(robot) = compensated {
        signals.compensate(&mut log, robot);
    }
    // Ends without the filter's extrapolation.
    let end = (TRANSIENT_PERIODS / (cut_off * step)).ceil() as usize;
    let samples = log.len();
    if samples < 2 * end + MIN_SAMPLES {
        return Err(too_short());
    }
    let deviation = |pair: &[f64]| (pair[1] - pair[0] - usual).abs();
    let jitter = raw.run.times.windows(2).map(deviation).fold(0.0, f64::max);
    let change = LogChange { median_step: usual, jitter, differentiated };
    Ok((log.interval(end..samples - end), change))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::cut_off::cut_off;
    use reachtube_recordings::Run;
    use std::f64::consts::PI;

    fn wave() -> RawLog {
        let times: Vec<f64> =
            (0..800).map(|k| 0.01 * k as f64 + if k % 3 == 1 { 0.002 } else { 0.0 }).collect();
        let (states, torques) = (|t: &f64| [t.sin(), t.cos()], |t: &f64| 2.0 * t.sin());
        let run = Run {
            joints: 1,
            start: 0.0,
            states: times.iter().flat_map(states).collect(),
            torques: times.iter().map(torques).collect(),
            times,
            temperatures: vec![],
            before: vec![],
            sha256: String::new(),
        };
        RawLog::new("wave", "wave.csv", run)
    }

    #[test]
    fn a_slow_wave_and_its_derivatives_pass_unchanged() {
        for velocity in [VelocitySource::Recorded, VelocitySource::Differentiated] {
            let settings =
                PrepareSettings { gains: vec![3.0], velocity, ..PrepareSettings::default() };
            let prepared = prepare(&[wave()], &settings, 4.0, None).unwrap();
            let log = &prepared.logs[0];
            for k in 0..log.len() {
                let t = log.time(k);
                let off =
                    [log.q(k)[0] - t.sin(), log.qd(k)[0] - t.cos(), log.tau(k)[0] - 6.0 * t.sin()];
                assert!(off.iter().all(|x| x.abs() < 5e-4), "{t}: {off:?}");
                // The extended ends have no curvature. The error of that decays to 0.1 % within the
                // 2.5 periods that are cut.
                let off = log.qdd(k)[0] + t.sin();
                assert!(off.abs() < 2e-3, "{t}: {off}");
            }
            assert!(
                prepared.changes.iter().any(|change| change.contains("multiplied by [3.0]")),
                "{:?}",
                prepared.changes
            );
        }
    }

    #[test]
    fn the_input_of_a_joint_that_turns_is_free_of_its_friction() {
        let robot = "schema_version = 1\nname = \"turning\"\n[[joint]]\nname = \"joint\"\n\
                     dh = { a = 0.0, alpha = 0.0, theta = 0.0, d = 0.0 }\nmass = 1.0\n\
                     com = [0.0, 0.0, 0.0]\ninertia = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]\n\
                     friction = { coulomb = [3.0, 0.0, -3.0, 0.0, -3.0, 0.0, 3.0, 0.0] }\n";
        let robot = Robot::from_toml(robot, "turning").unwrap();
        let mut raw = wave();
        // The joint turns twice and then rests, pushed less than its friction holds.
        let velocity = |t: f64| if t < 2.5 * PI { t.cos() } else { 0.0 };
        let torque = |t: f64| match velocity(t) {
            0.0 => 1.0,
            moving => 2.0 * t.sin() + 3.0 * moving.signum(),
        };
        let states = |t: &f64| [if velocity(*t) == 0.0 { 1.0 } else { t.sin() }, velocity(*t)];
        raw.run.times = (0..2000).map(|k| 0.01 * f64::from(k)).collect();
        raw.run.states = raw.run.times.iter().flat_map(states).collect();
        raw.run.torques = raw.run.times.iter().map(|t| torque(*t)).collect();
        let settings = PrepareSettings::default();
        let furthest = |robot: Option<&Robot>| {
            let log = prepare(&[raw.clone()], &settings, 4.0, robot).unwrap().logs.remove(0);
            let input = |k: usize| match robot {
                Some(_) => log.tau(k)[0],
                None => log.tau(k)[0] - 3.0 * log.qd(k)[0].signum(),
            };
            let expected = |t: f64| if velocity(t) == 0.0 { 0.0 } else { 2.0 * t.sin() };
            // The stop itself is a step of the input, which the filter softens.
            let away = |k: &usize| (log.time(*k) - 2.5 * PI).abs() > 0.5;
            let off = |k: usize| (input(k) - expected(log.time(k))).abs();
            (0..log.len()).filter(away).map(off).max_by(f64::total_cmp).unwrap()
        };
        let (compensated, as_recorded) = (furthest(Some(&robot)), furthest(None));
        // A tenth of the friction, and more than all of it.
        assert!(compensated < 0.3 && as_recorded > 3.0, "{compensated} {as_recorded}");
    }

    #[test]
    fn gains_that_do_not_fit_the_joints_are_errors() {
        for (gains, problem) in [
            (vec![1.0, 1.0], "gains: 2 given; give one for each of the 1 joints"),
            (vec![f64::NAN], "gains: gain 1 is NaN"),
            (vec![0.0], "gains: gain 1 is 0"),
        ] {
            let settings = PrepareSettings { gains: gains.clone(), ..PrepareSettings::default() };
            let filtered = prepare(&[wave()], &settings, 4.0, None).unwrap_err().to_string();
            let as_recorded = unfiltered(&wave(), &gains).unwrap_err().to_string();
            assert!([&filtered, &as_recorded].iter().all(|e| e.contains(problem)), "{filtered}");
        }
    }

    #[test]
    fn recordings_that_do_not_suit_the_cut_off_are_errors() {
        let settings = PrepareSettings { cut_off: Some(70.0), ..PrepareSettings::default() };
        assert!(
            cut_off(&[&wave()], &settings)
                .unwrap_err()
                .to_string()
                .contains("half the sample rate")
        );
        let mut short = wave();
        short.run.times.truncate(30);
        assert!(
            prepare(&[short], &PrepareSettings::default(), 3.0, None)
                .unwrap_err()
                .to_string()
                .contains("too few")
        );
    }
}
