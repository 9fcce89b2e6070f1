//! Whether recorded torques are what the robot's description needs, up to sign and size.

use reachtube_diagnose::{Contradiction, Described};
use reachtube_finding::{Finding, Remedy, Severity};
use reachtube_identify::prepare::{Flaw, FlawOutcome, PreparedLog, RawLog};
use reachtube_identify::signals;
use reachtube_recordings::{Run, Torque, dead_torques};
use reachtube_robot::Robot;

use crate::findings::contradiction;

/// Number of findings about wrong samples.
const LISTED: usize = 3;

/// Returns what contradicts the robot's description in the torques of filtered recordings, and a
/// finding if most joints' torques do not follow it. The torques must still contain gravity. A
/// description that is no body, or whose links have no mass, has no torques to compare with.
pub(crate) fn contradictions(
    robot: &Robot,
    kind: Torque,
    logs: &[PreparedLog],
    cut_off: f64,
) -> (Vec<Finding>, Option<Finding>) {
    let n = robot.joint_count();
    let is_bare = robot.inertial_parameters().iter().all(|parameter| *parameter == 0.0);
    if is_bare || robot.check_physical().is_err() || logs.is_empty() {
        return (Vec::new(), None);
    }
    let (found, count) = Described::new(robot, kind, signals(logs, cut_off)).contradictions();
    (found.iter().map(|found| described(robot, found)).collect(), few_explained(count, n))
}

/// Makes the finding about a contradiction to the description.
fn described(robot: &Robot, found: &Contradiction) -> Finding {
    let severity = if found.is_certain { Severity::Failure } else { Severity::Warning };
    let names: Vec<&str> =
        found.joints.iter().map(|joint| robot.joints()[*joint].name.as_str()).collect();
    let remedy = found.remedy.clone().map(|[setting, value, effect]| Remedy {
        setting: setting.into(),
        value,
        effect: effect.into(),
    });
    Finding {
        severity,
        place: (!names.is_empty()).then(|| names.join(", ")),
        numbers: found.number.iter().map(|(name, value)| (name.to_string(), *value)).collect(),
        remedy,
        ..contradiction(&found.text)
    }
}

/// Returns a finding if a description explains the torque of few joints of all.
fn few_explained(joints: usize, of: usize) -> Option<Finding> {
    let text = format!(
        "the description explains the torque of {joints} of {of} joints only: it may be of another \
         robot, or its joints may be in another order"
    );
    let numbers = [("joints".to_string(), joints as f64)].into();
    (2 * joints < of).then(|| Finding { numbers, ..contradiction(&text) })
}

/// Returns the recordings' samples that cannot be right, and were not left out, as findings.
pub(crate) fn wrong(logs: &[&RawLog]) -> Vec<Finding> {
    let finding = |flaw: &Flaw| {
        let severity = match flaw.outcome {
            FlawOutcome::LeftOut => return None,
            FlawOutcome::Contradiction => Severity::Failure,
            FlawOutcome::Named => Severity::Warning,
        };
        let place = Some(flaw.place.clone());
        Some(Finding { severity, place, ..contradiction(&flaw.text) })
    };
    let mut found: Vec<Finding> =
        logs.iter().flat_map(|log| &log.flaws).filter_map(finding).collect();
    found.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    let more = found.len().saturating_sub(LISTED);
    found.truncate(LISTED);
    if let Some(last) = found.last_mut().filter(|_| more > 0) {
        last.text += &format!(" {more} recordings or joints more have such samples.");
    }
    found
}

/// Returns the joints that move while their torque stays the same in every sample, as a finding.
pub(crate) fn unmeasured(robot: &Robot, logs: &[&RawLog]) -> Option<Finding> {
    let runs: Vec<&Run> = logs.iter().map(|log| &log.run).collect();
    let joints = dead_torques(&runs);
    let names: Vec<&str> = joints.iter().map(|i| robot.joints()[*i].name.as_str()).collect();
    let value = runs.first()?.torque(0).get(*joints.first()?)?;
    let text = format!(
        "the torque of {} is {value} in every sample, although the joint moves: it was not \
         measured, and there is no model without it",
        names.join(", ")
    );
    let remedy = Remedy {
        setting: "lock".into(),
        value: String::new(),
        effect: "holds joints at given positions and removes them from the robot.".into(),
    };
    let place = Some(names.join(", "));
    Some(Finding { place, remedy: Some(remedy), ..contradiction(&text) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pendulum, and a log of it whose torques are `factor` times what it needs.
    fn recorded(factor: f64) -> (Robot, RawLog) {
        let robot = crate::pendulum::pendulum();
        let times: Vec<f64> = (0..500).map(|k| 0.01 * f64::from(k)).collect();
        let state = |t: &f64| [(2.0 * t).sin(), 2.0 * (2.0 * t).cos()];
        let torque = |t: &f64| {
            let [q, qd] = state(t);
            factor * robot.inverse_dynamics(&[q], &[qd], &[-4.0 * q])[0]
        };
        let states = times.iter().flat_map(state).collect();
        let torques = times.iter().map(torque).collect();
        let run = reachtube_recordings::Run::new(1, times, states, torques).unwrap();
        let raw = RawLog::new("log", "log.csv", run);
        (robot, raw)
    }

    #[test]
    fn torques_of_another_sign_or_size_are_named() {
        let found = |factor: f64| -> Vec<String> {
            let (robot, raw) = recorded(factor);
            let log = reachtube_identify::prepare::unfiltered(&raw, &[]).unwrap();
            let (found, few) = contradictions(&robot, Torque::Motor, &[log], 10.0);
            assert_eq!(few, None);
            found.iter().map(ToString::to_string).collect()
        };
        assert_eq!(found(1.0), Vec::<String>::new());
        assert!(
            found(-1.0)[0].starts_with("All recorded torques have the opp"),
            "{:?}",
            found(-1.0)
        );
        assert!(found(0.1)[0].contains("of hinge are 0.1"), "{:?}", found(0.1));
    }

    #[test]
    fn a_description_that_explains_few_joints_is_named() {
        let text = |joints: usize| few_explained(joints, 6).map(|found| found.text);
        assert_eq!(text(3), None);
        assert!(text(1).is_some_and(|text| text.contains("1 of 6 joints only")));
    }

    #[test]
    fn torques_that_were_not_measured_are_named() {
        let found = |factor: f64| {
            let (robot, raw) = recorded(factor);
            unmeasured(&robot, &[&raw]).map(|finding| finding.text)
        };
        assert_eq!(found(1.0), None);
        let text = found(0.0).unwrap();
        assert!(text.starts_with("The torque of hinge is 0 in every sample"), "{text}");
    }
}
