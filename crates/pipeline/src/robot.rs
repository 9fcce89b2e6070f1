//! The robot: as described, or identified from the recordings.

use std::collections::BTreeMap;
use std::path::Path;

use reachtube_diagnose::Hypothesis;
use reachtube_finding::{Finding, Severity};
use reachtube_identify::prepare::{
    LogEntry, PrepareSettings, PreparedLog, RawLog, prepare, unfiltered,
};
use reachtube_identify::{
    IdentifySettings, Implausible, ModelSettings, identify, identify_unjudged,
};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::error::Result;
use crate::findings::{contradiction, implausible};
use crate::held_out::Recording;
use crate::plausible::{contradictions, unmeasured, wrong};
use crate::trial::Trial;
use crate::windows::Prepared;

/// A description that leaves less than this part of the torque unexplained is taken as it is.
const GOOD: f64 = 0.1;

/// The identified robot must leave less than this part of what the description leaves.
pub(crate) const BETTER: f64 = 0.8;

/// Length of the windows over which torque is compared, s, and their number.
const WINDOW: f64 = 0.1;
const MOST_WINDOWS: usize = 200;

/// A robot, with the recordings prepared for it.
#[derive(Debug)]
pub(crate) struct Nominal {
    pub robot: Robot,
    pub logs: Vec<PreparedLog>,
    /// Whether it was identified from the recordings.
    pub is_identified: bool,
    /// Why.
    pub reason: String,
    /// Contradictions of the recordings to the robot or to rigid-body dynamics.
    pub findings: Vec<Finding>,
    /// Whether an identification found that columns are exchanged.
    pub is_swapped: bool,
}

/// What the choice of the robot needs.
pub(crate) struct Evidence<'a> {
    /// Poses at rest.
    pub rest: Vec<LogEntry>,
    /// Motions of one joint at a time.
    pub one_joint: Vec<LogEntry>,
    /// Exciting motions.
    pub motions: &'a [Recording],
    /// The kind of the torques.
    pub torque: Torque,
    /// How recordings are prepared.
    pub settings: &'a PrepareSettings,
    /// Cut-off frequency of the low-pass, Hz.
    pub cut_off: f64,
    /// The trial without a robot of its own.
    pub trial: &'a Trial<'a>,
}

impl Evidence<'_> {
    /// Chooses between the robot as described and the robot identified from the recordings: the one
    /// that `given` says, or else the identified one if it explains the torque clearly better.
    ///
    /// # Errors
    ///
    /// As [`identify`], if the description is no alternative.
    pub(crate) fn choose(&self, described: &Robot, given: Option<bool>) -> Result<Nominal> {
        let (mut contradictions, few_explained) = self.contradictions(described)?;
        let chosen = self.chosen(described, given);
        let mut chosen = chosen.map_err(|error| error.because(&contradictions))?;
        // An identification blames columns if the description is of another robot.
        let is_wrong = chosen.findings.iter().any(|other| other.severity == Severity::Failure);
        if is_wrong && contradictions.is_empty() {
            contradictions.extend(few_explained);
        }
        // What contradicts the description has tried more, unless columns are exchanged, which
        // only an identification tells; that then has no other cause.
        let is_certain = contradictions.iter().any(|found| found.severity == Severity::Failure);
        if is_certain && !chosen.is_swapped {
            chosen.findings.clear();
        }
        if !chosen.is_swapped {
            chosen.findings.splice(0..0, contradictions);
        }
        let is_named = chosen.findings.iter().any(|found| found.numbers.contains_key("lag"));
        if !is_certain && !chosen.is_swapped && !is_named {
            let causes = self.unexplained_causes(described, &chosen)?;
            chosen.findings.splice(0..0, causes);
        }
        Ok(chosen)
    }

    /// Chooses the robot, with the findings of an identification.
    fn chosen(&self, described: &Robot, given: Option<bool>) -> Result<Nominal> {
        let is_input = self.torque == Torque::Compensated;
        if is_input {
            // No robot is identified from its input.
            described.check_physical()?;
        }
        let is_physical = described.check_physical().map(|_| ());
        let own = match (given, &is_physical) {
            (Some(true), _) | (_, Err(_)) => None,
            (_, Ok(())) => {
                let nominal = self.prepared(described)?;
                let error = self.unexplained(&nominal)?;
                Some((nominal, error))
            }
        };
        match own {
            // Compensated torques are the input of the robot that is described.
            Some((nominal, error)) if given == Some(false) || error < GOOD || is_input => {
                let left = percent(error);
                let why = if given.is_some() { "given; " } else { "" };
                let reason =
                    format!("{why}the description leaves {left} of the torque unexplained");
                Ok(Nominal { reason, ..nominal })
            }
            Some((nominal, error)) => self.better(described, nominal, error),
            None => {
                let identified = self.identified(described)?;
                let after = percent(self.unexplained(&identified)?);
                let why = match is_physical {
                    Ok(()) => "given".into(),
                    Err(problem) => format!("the description is no body ({problem})"),
                };
                let reason =
                    format!("{why}; the identified robot leaves {after} of the torque open");
                Ok(Nominal { reason, ..identified })
            }
        }
    }

    /// Returns the identified robot if it explains the torque clearly better than the description,
    /// which leaves the part `error` of it unexplained.
    fn better(&self, described: &Robot, nominal: Nominal, error: f64) -> Result<Nominal> {
        let identified = match self.identified(described) {
            Ok(identified) => identified,
            Err(failure) => {
                let left = percent(error);
                let reason = format!(
                    "the description leaves {left} of the torque unexplained, but the robot could \
                     not be identified: {failure}"
                );
                let findings = unexplained_by_any(error).into_iter().collect();
                return Ok(Nominal { reason, findings, ..nominal });
            }
        };
        let after = self.unexplained(&identified)?;
        let reason = format!(
            "of the torque, the description leaves {} unexplained and the identified robot {}",
            percent(error),
            percent(after)
        );
        let (findings, is_swapped) = (identified.findings.clone(), identified.is_swapped);
        let best = if after < BETTER * error { identified } else { nominal };
        Ok(Nominal { reason, findings, is_swapped, ..best })
    }

    /// Returns what contradicts the description in the recorded torques, and a finding if most
    /// joints' torques do not follow it.
    fn contradictions(&self, described: &Robot) -> Result<(Vec<Finding>, Option<Finding>)> {
        let logs: Vec<&RawLog> = self.motions.iter().map(|motion| &*motion.log).collect();
        if let Some(finding) = unmeasured(described, &logs) {
            return Ok((vec![finding], None));
        }
        let mut found = wrong(&logs);
        if self.torque == Torque::Compensated {
            return Ok((found, None));
        }
        let logs = self.filtered()?;
        let (of_torques, few) = contradictions(described, self.torque, &logs, self.cut_off);
        found.extend(of_torques);
        Ok((found, few))
    }

    /// Returns the recordings as the robot's are, with their torques.
    pub(crate) fn filtered(&self) -> Result<Vec<PreparedLog>> {
        let raw: Vec<RawLog> =
            self.motions.iter().map(|motion| RawLog::clone(&motion.log)).collect();
        if self.torque == Torque::Compensated {
            let logs = raw.iter().map(|log| unfiltered(log, &self.settings.gains));
            return Ok(logs.collect::<std::result::Result<_, _>>()?);
        }
        Ok(prepare(&raw, self.settings, self.cut_off, None)?.logs)
    }

    /// Identifies the robot from what is not held out.
    pub(crate) fn identified(&self, described: &Robot) -> Result<Nominal> {
        let (settings, none) = (self.identify_settings(), Path::new(""));
        let (description, implausible_results): (_, Vec<Implausible>) =
            self.trial.journal.step("identify", || {
                let found = identify(described, &settings, none, &|_, _| ())?;
                Ok((found.description, found.implausible))
            })?;
        let nominal = self.prepared(&Robot::from_description(&description)?)?;
        let findings = implausible_results.iter().map(implausible).collect();
        let mut columns = implausible_results.iter().map(|result| result.columns);
        let is_swapped = columns.any(|fault| matches!(fault, Some(Hypothesis::Swap(..))));
        Ok(Nominal { is_identified: true, findings, is_swapped, ..nominal })
    }

    /// Identifies the robot from what is not held out and shows none of some motions, and prepares
    /// all recordings for it.
    pub(crate) fn identified_without(
        &self,
        described: &Robot,
        motions: &[&str],
    ) -> Result<Nominal> {
        let is_left_out = |recording: &&Recording| motions.contains(&&*recording.motion);
        let others = self.motions.iter().filter(|recording| !is_left_out(recording));
        let others: Vec<Recording> = others.cloned().collect();
        let (rest, one_joint) = (self.rest.clone(), self.one_joint.clone());
        let evidence = Evidence { motions: &others, rest, one_joint, ..*self };
        let name = format!("identify without {}", motions.join(", "));
        self.prepared(&evidence.unjudged(described, &name)?)
    }

    /// Identifies the robot without judging it, which is the step `name` of the job.
    pub(crate) fn unjudged(&self, described: &Robot, name: &str) -> Result<Robot> {
        let settings = self.identify_settings();
        let description = self
            .trial
            .journal
            .step(name, || Ok(identify_unjudged(described, &settings, Path::new(""))?))?;
        Ok(Robot::from_description(&description)?)
    }

    fn identify_settings(&self) -> IdentifySettings {
        IdentifySettings {
            rest: self.rest.clone(),
            one_joint: self.one_joint.clone(),
            excitation: self.motions.iter().map(Recording::entry).collect(),
            prepare: PrepareSettings { cut_off: Some(self.cut_off), ..self.settings.clone() },
            model: ModelSettings {
                motor_inertia: self.torque != Torque::Link,
                physical: Some(true),
                windows: vec![0.5],
                ..ModelSettings::default()
            },
            ..IdentifySettings::default()
        }
    }

    pub(crate) fn prepared(&self, robot: &Robot) -> Result<Nominal> {
        let raw: Vec<RawLog> =
            self.motions.iter().map(|motion| RawLog::clone(&motion.log)).collect();
        let logs = prepare_for(&raw, robot, self.torque, self.settings, self.cut_off)?;
        let (reason, findings) = (String::new(), Vec::new());
        let (is_identified, is_swapped) = (false, false);
        Ok(Nominal { robot: robot.clone(), logs, is_identified, reason, findings, is_swapped })
    }

    /// Returns the part of the torque that a robot does not explain: the mean over the joints of
    /// the root mean square of what is left by the root mean square of the torque, both filtered
    /// alike.
    fn unexplained(&self, nominal: &Nominal) -> Result<f64> {
        let of = if nominal.is_identified { "identified robot" } else { "description" };
        let part = self.trial.journal.step(&format!("torque, {of}"), || {
            let part = self.unexplained_part(nominal)?;
            Ok(part.is_finite().then_some(part))
        })?;
        Ok(part.unwrap_or(f64::INFINITY))
    }

    pub(crate) fn unexplained_part(&self, nominal: &Nominal) -> Result<f64> {
        let none = BTreeMap::new();
        let (from_start, divides, simulated, shortest) = (false, false, false, 0.0);
        let (logs, origins) = (&*nominal.logs, &none);
        let recordings = Prepared { logs, origins, from_start, divides, simulated, shortest };
        let windows = recordings.cut(WINDOW, MOST_WINDOWS)?;
        let trial = Trial { robot: nominal.robot.clone(), ..self.trial.clone() };
        let answer = match trial.run(windows) {
            Ok(answer) => answer,
            Err(error) if trial.progress.is_cancelled() => return Err(error),
            // A model that diverges explains nothing.
            Err(_) => return Ok(f64::INFINITY),
        };
        let errors = answer.found.input_error;
        // The torques are filtered as the errors are, which contain no noise beyond the cut-off.
        let logs = self.filtered()?;
        let torque = |joint: usize| {
            let values = logs.iter().flat_map(|log| log.tau.iter().skip(joint).step_by(log.joints));
            let (sum, count) =
                values.fold((0.0, 0usize), |(sum, count), tau| (sum + tau * tau, count + 1));
            (sum / count.max(1) as f64).sqrt()
        };
        let parts = errors.iter().enumerate().map(|(joint, error)| error / torque(joint).max(1e-9));
        Ok(parts.sum::<f64>() / errors.len() as f64)
    }
}

/// Makes the finding that a description, which leaves a part of the torque unexplained, explains no
/// more than a robot that needs no torque, and that no other was found.
fn unexplained_by_any(part: f64) -> Option<Finding> {
    let left = percent(part);
    let text = format!(
        "the torques are not what this robot needs: its description leaves {left} of them \
         unexplained, and no robot with these joints was found that explains them; check their \
         kind, unit and signs, and whether they were measured"
    );
    (part >= 1.0).then(|| contradiction(&text))
}

/// Filters recordings and turns their torques into the input of a robot's model. Torques that are
/// the input already are not filtered.
///
/// # Errors
///
/// As [`prepare`].
pub(crate) fn prepare_for(
    raw: &[RawLog],
    robot: &Robot,
    torque: Torque,
    settings: &PrepareSettings,
    cut_off: f64,
) -> Result<Vec<PreparedLog>> {
    if torque == Torque::Compensated {
        let logs = raw.iter().map(|log| unfiltered(log, &settings.gains));
        return Ok(logs.collect::<Result<_, _>>()?);
    }
    Ok(prepare(raw, settings, cut_off, Some(robot))?.logs)
}

/// Returns whether the velocities of most logs are the differentiated positions.
pub(crate) fn are_differentiated(logs: &[PreparedLog]) -> bool {
    2 * logs.iter().filter(|log| log.differentiated).count() > logs.len()
}

pub(crate) fn percent(part: f64) -> String {
    if part.is_finite() { format!("{:.0} %", 100.0 * part) } else { "all".into() }
}
