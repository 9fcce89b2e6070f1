//! Findings about contradictions among the recordings and with the robot.

use crate::code::Code;
use reachtube_conform::next_motion::LeftOut;
use reachtube_diagnose::Hypothesis;
use reachtube_finding::{Finding, Severity};
use reachtube_identify::Implausible;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::choices::Choices;

/// Makes the finding that the recordings contradict the robot, so that no model of them is
/// acceptable.
pub(crate) fn contradiction(text: &str) -> Finding {
    Finding::new(Severity::Failure, Code::Contradiction, sentence(text))
}

/// Makes the finding about an implausible result of an identification. Only columns that are wrong
/// make the model unacceptable.
pub(crate) fn implausible(result: &Implausible) -> Finding {
    let severity = if result.columns.is_some() { Severity::Failure } else { Severity::Warning };
    let mut text = result.text.clone();
    if let Some(Hypothesis::Degrees | Hypothesis::TorqueUnit(_)) = result.columns {
        text += "; or the description is of another robot";
    }
    Finding { severity, ..contradiction(&text) }
}

/// Says that links of a description have inertias that no body has, if some have: a warning where
/// the robot was identified without them, else a note.
pub(crate) fn impossible_links(
    robot: &Robot,
    is_identified: bool,
) -> (Option<String>, Option<Finding>) {
    let links = robot.description().impossible_links().join(", ");
    if links.is_empty() {
        return (None, None);
    }
    let text = format!("no body has the mass and inertia of the links that {links} move");
    if !is_identified {
        return (Some(format!("{text}; they are used as they are described")), None);
    }
    let text = format!("{text}: only the geometry of the description is used");
    let severity = Severity::Warning;
    (None, Some(Finding { severity, place: Some(links), ..contradiction(&text) }))
}

/// Returns a note if torques were measured behind the gears and the description has motors.
pub(crate) fn ignored_motors(robot: &Robot, torque: Torque) -> Option<String> {
    let motors = robot.joints().iter().filter(|joint| joint.armature > 0.0);
    let names: Vec<&str> = motors.map(|joint| joint.name.as_str()).collect();
    (torque == Torque::Link && !names.is_empty()).then(|| {
        format!(
            "the inertia of the motors of {} is not used: torques behind the gears do not drive it",
            names.join(", ")
        )
    })
}

/// Makes the warning that a horizon \[s\] is shorter than half a period of the cut-off, if it is.
pub(crate) fn measures_the_filter(horizon: f64, shortest: f64) -> Option<Finding> {
    let text = format!(
        "the horizon of {horizon} s is shorter than half a period of the cut-off, {shortest:.2} s: \
         its sets show what the low-pass does, and not what the robot does"
    );
    (horizon < shortest).then(|| warning(Code::ShortHorizon, &text))
}

/// Makes the warning that no allowance of the sets encloses a motion that was left out.
pub(crate) fn not_enclosed(left_out: &LeftOut) -> Finding {
    let motion = &left_out.motion;
    let text = format!(
        "no allowance of U makes the sets of the other motions enclose {motion}, which was left \
         out: they do not carry over to it; record more motions, or hold it out to look at it"
    );
    Finding { place: Some(motion.clone()), ..warning(reachtube_conform::Code::LeftOut, &text) }
}

pub(crate) fn warning(code: impl Into<reachtube_finding::Code>, text: &str) -> Finding {
    Finding::new(Severity::Warning, code, sentence(text))
}

/// Ends a clause as a sentence. A path or a name that it begins with stays as it is.
fn sentence(text: &str) -> String {
    let word = text.split(' ').next().unwrap_or_default();
    let is_name = !word.chars().all(|c| c.is_ascii_lowercase());
    let (first, rest) = text.split_at(usize::from(!is_name && !word.is_empty()));
    format!("{}{rest}.", first.to_ascii_uppercase())
}

/// What no factor of the torques mends, by the numbers of the findings.
const NOT_OF_TORQUES: [&str; 3] = ["gravity", "angle", "offset"];

/// Makes contradictions in the torques warnings if their factors are given: they state that the
/// torques are right.
pub(crate) fn unless_accepted(findings: Vec<Finding>, given: &Choices) -> Vec<Finding> {
    if given.gains.is_empty() {
        return findings;
    }
    let accepted = |finding: Finding| {
        let is_of_torques = NOT_OF_TORQUES.iter().all(|name| !finding.numbers.contains_key(*name));
        let severity = if is_of_torques { Severity::Warning } else { finding.severity };
        Finding { severity, ..finding }
    };
    findings.into_iter().map(accepted).collect()
}
