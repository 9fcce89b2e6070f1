//! What torques show that a robot leaves unexplained: that they come late, or a payload.

use std::path::PathBuf;

use reachtube_arm::ArmModel;
use reachtube_conform::{Code, Model};
use reachtube_diagnose::{NeededTorques, ShownPayload, payload, remaining_lag, torque_lag};
use reachtube_finding::{Finding, Severity};
use reachtube_identify::prepare::{PreparedLog, prepare};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;
use reachtube_scalar::number::counted;

use crate::error::Result;
use crate::findings::{contradiction, warning};
use crate::held_out::Recording;
use crate::prepared::Later;
use crate::robot::{BETTER, Evidence, Nominal, percent};

/// Number of recordings that are named.
const NAMED: usize = 3;

/// Later recordings leave this many times as much unexplained as a model's own if they have a cause
/// of their own.
const MORE: f64 = 1.5;

/// Times that a lag is taken off and looked for again.
const ROUNDS: usize = 3;

/// Part of a robot's mass below which a payload is not named.
const LEAST_MASS: f64 = 0.01;

impl Evidence<'_> {
    /// Returns findings about what the chosen robot leaves unexplained: a lag of the torques, with
    /// which the choice of the robot, made again, explains clearly more of them, or payloads.
    pub(crate) fn unexplained_causes(
        &self,
        described: &Robot,
        chosen: &Nominal,
    ) -> Result<Vec<Finding>> {
        if self.torque == Torque::Compensated {
            return Ok(Vec::new());
        }
        let recorded = self.filtered()?;
        let robot = driven(&chosen.robot, self.torque);
        let needed = needed(&robot, &recorded, &chosen.logs);
        if let Some(lag) = torque_lag(&needed, robot.joint_count()) {
            let (lag, parts) = self.without_lag(described, chosen, lag)?;
            return Ok((parts[1] < BETTER * parts[0])
                .then(|| late(lag, parts))
                .into_iter()
                .collect());
        }
        // What all recordings show is what the description has wrong.
        let shown = Shown::of(&robot, &recorded, &needed);
        let differ = shown.count() < recorded.len() || shown.is_of_both_signs();
        Ok(shown
            .words(recorded.len())
            .filter(|_| differ)
            .map(|text| mild(&text))
            .into_iter()
            .collect())
    }

    /// Takes a lag, s, off the torques, and chooses the robot again: the one that was chosen has
    /// taken some of it for friction. Returns the lag with what then was left of it, and which part
    /// of the torques is unexplained with it and without it.
    fn without_lag(
        &self,
        described: &Robot,
        chosen: &Nominal,
        mut lag: f64,
    ) -> Result<(f64, [f64; 2])> {
        let with = self.unexplained_part(chosen)?;
        let mut without = with;
        for _ in 0..ROUNDS {
            let motions: Vec<Recording> =
                self.motions.iter().map(|motion| motion.with_earlier_torques(lag)).collect();
            let (rest, one_joint) = (self.rest.clone(), self.one_joint.clone());
            let evidence = Evidence { motions: &motions, rest, one_joint, ..*self };
            let robot = match chosen.is_identified {
                true => {
                    evidence.unjudged(described, &format!("identify without {lag} s of lag"))?
                }
                false => chosen.robot.clone(),
            };
            let again = evidence.prepared(&robot)?;
            without = evidence.unexplained_part(&again)?;
            let recorded = evidence.filtered()?;
            let needed = needed(&driven(&robot, self.torque), &recorded, &again.logs);
            let Some(step) = needed.first().map(|log| log.step) else { break };
            let rest = remaining_lag(&needed, robot.joint_count()).unwrap_or(0.0);
            // Torques were moved by whole samples.
            lag = (lag / step).round() * step + rest;
            if rest.abs() < 0.5 * step {
                break;
            }
        }
        Ok((lag, [with, without]))
    }
}

/// Returns what later recordings show that the robot of a model leaves unexplained: a lag of their
/// torques, or payloads. They are read as by [`prepared`](crate::prepared). The list is empty for
/// a model that takes recordings as they are, or has no use for torques.
///
/// # Errors
///
/// As [`prepared`](crate::prepared).
pub fn unexplained_by_model(model: &Model, paths: &[PathBuf]) -> Result<Vec<Finding>> {
    let Some(preparation) = &model.preparation else { return Ok(Vec::new()) };
    let Some(cut_off) = preparation.cut_off else { return Ok(Vec::new()) };
    let later = Later::read(model, preparation, paths)?;
    if preparation.torque == Torque::Compensated || model.arm().settings.equations.is_kinematic() {
        return Ok(Vec::new());
    }
    let recorded = prepare(&later.raw, &later.settings, cut_off, None)?.logs;
    let robot = driven(&later.robot, preparation.torque);
    let inputs = later.logs()?;
    let needed = needed(&robot, &recorded, &inputs);
    // Recordings that the robot explains as well as the model's own have no cause of their own.
    let own = model.input_error.iter().map(|error| error * error).sum::<f64>().sqrt();
    if missed(&needed, robot.joint_count()) < MORE * own {
        return Ok(Vec::new());
    }
    let found = match torque_lag(&needed, robot.joint_count()) {
        Some(lag) => Some(lag_words(lag, "")),
        None => Shown::of(&robot, &recorded, &needed).words(recorded.len()),
    };
    Ok(found.iter().map(|text| warning(Code::Cause, text)).collect())
}

/// Returns the robot that torques drive: behind the gears, the one without motors.
fn driven(robot: &Robot, torque: Torque) -> Robot {
    match torque {
        Torque::Link => robot.without_motors(),
        Torque::Motor | Torque::Compensated => robot.clone(),
    }
}

fn mild(text: &str) -> Finding {
    Finding { severity: Severity::Warning, ..contradiction(text) }
}

/// Makes the finding about a lag, with which parts of the torques are unexplained as they are and
/// without it.
fn late(lag: f64, [stated, without]: [f64; 2]) -> Finding {
    let (stated, without) = (percent(stated), percent(without));
    let gain = format!(": without that lag, {without} of them is unexplained in place of {stated}");
    Finding { numbers: [("lag".to_string(), lag)].into(), ..mild(&lag_words(lag, &gain)) }
}

fn lag_words(lag: f64, gain: &str) -> String {
    let [later, earlier] = if lag > 0.0 { ["later", "earlier"] } else { ["earlier", "later"] };
    let ms = (1e3 * lag).abs().round();
    format!(
        "the torques come {ms} ms {later} than the motion that they belong to{gain}; move their \
         columns {earlier} by {ms} ms, or record torques and positions with one clock"
    )
}

/// Recordings that show a payload, by their names: with more at the last link than the robot, and
/// with less.
struct Shown {
    heavier: Vec<(String, ShownPayload)>,
    lighter: Vec<(String, ShownPayload)>,
}

impl Shown {
    fn of(robot: &Robot, logs: &[PreparedLog], needed: &[NeededTorques]) -> Self {
        let mass: f64 = robot.inertial_parameters().iter().step_by(10).sum();
        let of_log = |(log, needed): (&PreparedLog, &NeededTorques)| {
            let found = payload(robot, needed)?;
            (found.mass.abs() > LEAST_MASS * mass).then(|| (log.name.clone(), found))
        };
        let found = logs.iter().zip(needed).filter_map(of_log);
        let (heavier, lighter) = found.partition(|(_, payload)| payload.mass > 0.0);
        Self { heavier, lighter }
    }

    fn count(&self) -> usize {
        self.heavier.len() + self.lighter.len()
    }

    fn is_of_both_signs(&self) -> bool {
        !self.heavier.is_empty() && !self.lighter.is_empty()
    }

    /// Returns a clause about the recordings, of all, whose last link is heavier than the robot's,
    /// or than in lighter ones, and what that explains; `None` if there are none.
    fn words(&self, of: usize) -> Option<String> {
        let Self { heavier, lighter } = self;
        let mean = |found: &[(String, ShownPayload)], value: &dyn Fn(&ShownPayload) -> f64| {
            found.iter().map(|(_, payload)| value(payload)).sum::<f64>() / found.len().max(1) as f64
        };
        let mass = |found| mean(found, &|payload| payload.mass);
        let named = if heavier.is_empty() { lighter } else { heavier };
        let all = [&heavier[..], lighter].concat();
        let names: Vec<&str> = named.iter().take(NAMED).map(|(name, _)| name.as_str()).collect();
        let more = match named.len() - names.len() {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let (kg, than) = match (heavier.is_empty(), lighter.is_empty()) {
            (true, _) => (-mass(lighter), "less than the robot's"),
            (_, true) => (mass(heavier), "more than the robot's"),
            _ => (mass(heavier) - mass(lighter), "more than in the others"),
        };
        (!all.is_empty()).then(|| {
            format!(
                "in {}{more} ({} of {}) the last link has {kg:.1} kg {than}: that explains {} of \
                 what is unexplained there; make a model for each payload, or give the tool in the \
                 description",
                names.join(", "),
                named.len(),
                counted(of, "recording"),
                percent(mean(&all, &|payload| payload.explained))
            )
        })
    }
}

/// Returns the norm over the joints of the root mean square of what is unexplained, N m.
fn missed(needed: &[NeededTorques], joints: usize) -> f64 {
    let rows: usize = needed.iter().map(|log| log.needed.len() / joints).sum();
    let of_log = |log: &NeededTorques| -> f64 {
        let missed = log.recorded.iter().zip(&log.needed).map(|(a, b)| (a - b) * (a - b));
        missed.sum()
    };
    (needed.iter().map(of_log).sum::<f64>() / rows.max(1) as f64).sqrt()
}

/// Returns filtered torques beside what the robot needs for their motions: what was taken off them
/// to give the model's `inputs`, which is filtered alike, and the rest of its equations of motion.
fn needed<'a>(
    robot: &Robot,
    recorded: &'a [PreparedLog],
    inputs: &'a [PreparedLog],
) -> Vec<NeededTorques<'a>> {
    let of_log = |(recorded, inputs): (&'a PreparedLog, &'a PreparedLog)| {
        let at = |k: usize| {
            let (q, qd) = (inputs.q(k), inputs.qd(k));
            let of_motion = robot.motion_torque(q, qd, inputs.qdd(k)) + robot.viscous_torque(qd);
            let taken = recorded.tau(k).iter().zip(inputs.tau(k)).map(|(tau, input)| tau - input);
            taken.zip(&of_motion).map(|(taken, of_motion)| taken + of_motion).collect::<Vec<f64>>()
        };
        NeededTorques {
            step: recorded.step,
            motion: [&inputs.q, &inputs.qd, &inputs.qdd],
            recorded: &recorded.tau,
            needed: (0..recorded.len()).flat_map(at).collect(),
        }
    };
    recorded.iter().zip(inputs).map(of_log).collect()
}
