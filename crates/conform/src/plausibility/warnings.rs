use reachtube_recordings::State;
use serde::{Deserialize, Serialize};

use crate::data::problem::Problem;
use crate::data::settings::NominalStart;
use crate::error::Result;
use crate::next_motion::calibration::Calibration;
use crate::plausibility::causes::likely_cause;
use crate::plausibility::nominal_fit::NominalFit;
use crate::sets::UncertaintySets;

/// X0 that reaches further than the recorded starts by more than this factor is remarked ...
const FACTOR_OF_STARTS: f64 = 10.0;

/// ... where that is also more than this part of the recorded motion.
const PART_OF_MOTION: f64 = 0.02;

/// A nominal motion that explains less than this part of a velocity's variance is remarked.
const LEAST_EXPLAINED: f64 = 0.5;

/// A remark that an answer is implausible, although the sets enclose the recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Warning {
    /// What is remarked.
    pub kind: WarningKind,
    /// The joints that it is about, from 1; none where it is about all.
    pub joints: Vec<usize>,
    /// The remark in words.
    pub text: String,
}

/// What a warning remarks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WarningKind {
    /// The reachable set is more than twice as wide as the recorded motion.
    ReachableSetSize,
    /// X0 is wider than the recorded motion.
    InitialSetSize,
    /// The positions of X0 reach much further than the recorded starts.
    InitialSetStarts,
    /// 0 lies outside X0 by more than the noise of the sensors.
    InitialSetOffset,
    /// U reaches beyond the recorded input.
    InputSetSize,
    /// V is nearly as wide as the recorded motion.
    NoiseSetSize,
    /// The nominal motion explains little of the recorded one.
    Unexplained,
    /// What most likely caused the other warnings.
    Cause,
    /// The fitted nominal model needs larger sets than the identified one for motions that it was
    /// not fitted to.
    Overfitted,
}

impl WarningKind {
    /// All kinds that are about single joints, in the order of the warnings.
    const OF_JOINTS: [Self; 7] = [
        Self::ReachableSetSize,
        Self::InitialSetSize,
        Self::InitialSetStarts,
        Self::InitialSetOffset,
        Self::InputSetSize,
        Self::NoiseSetSize,
        Self::Unexplained,
    ];

    /// Returns the words before the list of states.
    fn words(self) -> &'static str {
        match self {
            Self::ReachableSetSize => {
                "the reachable set is more than twice as wide as the recorded motion (largest \
                 width, range of the recordings)"
            }
            Self::InitialSetSize => {
                "X0 is wider than the recorded motion and covers what the model does not explain \
                 (width, range of the recordings)"
            }
            Self::InitialSetStarts => {
                "X0 reaches much further than the recorded starts and covers what happens later; \
                 an initial limit (--initial-limit positions) leaves that to U (reach, furthest \
                 start)"
            }
            Self::InitialSetOffset => {
                "X0 does not contain 0, so that no nominal motion starts in it (distance)"
            }
            Self::InputSetSize => {
                "U reaches beyond the recorded inputs (reach, largest recorded input)"
            }
            Self::NoiseSetSize => {
                "V is so wide that hardly any motion is left to explain (width, range of the \
                 recordings)"
            }
            Self::Unexplained => {
                "the nominal motions explain little of the recorded velocities (part of the \
                 variance)"
            }
            Self::Cause | Self::Overfitted => "",
        }
    }
}

/// What is remarked of one joint.
struct Remark {
    kind: WarningKind,
    joint: usize,
    text: String,
}

/// Returns what is remarkable about `sets` beside the recordings of `problem`, and the most likely
/// cause where anything is. `radii` are the largest radii of the reachable set, for each state
/// that is checked. `calibration` is how the sets were scaled, if they were.
///
/// # Errors
///
/// As [`Problem::run`].
pub(crate) fn warnings(
    problem: &Problem,
    sets: &UncertaintySets,
    radii: &[f64],
    fit: &NominalFit,
    calibration: Option<&Calibration>,
) -> Result<Vec<Warning>> {
    let n = problem.joints();
    let mut remarks: Vec<Remark> =
        (0..2 * n).flat_map(|i| of_state(problem, sets, radii.get(i), fit, i)).collect();
    remarks.extend((0..n).filter_map(|joint| of_input(problem, sets, fit, joint)));
    let of_kind = |kind: WarningKind| {
        let of: Vec<&Remark> = remarks.iter().filter(|remark| remark.kind == kind).collect();
        let texts: Vec<&str> = of.iter().map(|remark| remark.text.as_str()).collect();
        let mut joints: Vec<usize> = of.iter().map(|remark| remark.joint).collect();
        joints.sort_unstable();
        joints.dedup();
        let text = format!("{}: {}", kind.words(), texts.join("; "));
        (!of.is_empty()).then_some(Warning { kind, joints, text })
    };
    let mut found: Vec<Warning> = WarningKind::OF_JOINTS.into_iter().filter_map(of_kind).collect();
    // X0 takes over from U where that is cheaper, whatever the recordings are.
    if found.iter().any(|warning| warning.kind != WarningKind::InitialSetStarts) {
        let text = likely_cause(problem, calibration)?;
        found.push(Warning { kind: WarningKind::Cause, joints: Vec::new(), text });
    }
    Ok(found)
}

/// Returns what is remarkable about state `i`.
fn of_state(
    problem: &Problem,
    sets: &UncertaintySets,
    radius: Option<&f64>,
    fit: &NominalFit,
    i: usize,
) -> Vec<Remark> {
    let state = State::from_index(i, problem.joints());
    let unit = state.kind.unit(problem.robot().kinds()[state.joint]);
    let [low, high] = fit.recorded[i];
    let (range, sensor) = (high - low, problem.sensor_noise().radius[i]);
    let (from, to) = sets.initial_set.bounds(i);
    let (width, noise) = (to - from, sets.noise_radius(i));
    let largest = radius.map_or(0.0, |radius| 2.0 * radius);
    let beside = |size: f64| format!("{state} {} {unit}, {}", short(size), short(range));
    let mut remarks = Vec::new();
    let mut remark = |kind, text| remarks.push(Remark { kind, joint: state.joint + 1, text });
    if largest > 2.0 * (range + sensor) {
        remark(WarningKind::ReachableSetSize, beside(largest));
    }
    if width > range + 2.0 * sensor && width > 1e-6 {
        remark(WarningKind::InitialSetSize, beside(width));
    }
    let (reach, start) = (to.max(-from), fit.farthest_starts[i].max(sensor));
    let is_position = i < problem.joints();
    if is_position && reach > (FACTOR_OF_STARTS * start).max(PART_OF_MOTION * range) {
        let text = format!("{state} {} {unit}, {}", short(reach), short(fit.farthest_starts[i]));
        remark(WarningKind::InitialSetStarts, text);
    }
    let offset = from.max(-to);
    let allowed = match problem.settings().nominal {
        NominalStart::Mean => sensor.max(0.05 * range),
        NominalStart::Own => sensor,
    };
    if offset > allowed.max(1e-6) {
        remark(WarningKind::InitialSetOffset, format!("{state} {} {unit}", short(offset)));
    }
    if 4.0 * noise > range && noise > 1e-6 {
        remark(WarningKind::NoiseSetSize, beside(2.0 * noise));
    }
    if let Some(part) = fit.explained[i].filter(|part| !is_position && *part < LEAST_EXPLAINED) {
        let part = if part <= 0.0 { "nothing".into() } else { format!("{:.0} %", 100.0 * part) };
        remark(WarningKind::Unexplained, format!("{state} {part}"));
    }
    remarks
}

/// Returns the remark that U reaches beyond the recorded input of `joint` (from 0).
fn of_input(
    problem: &Problem,
    sets: &UncertaintySets,
    fit: &NominalFit,
    joint: usize,
) -> Option<Remark> {
    let (low, high) = sets.input_set.bounds(joint);
    let (reach, largest) = (high.max(-low), fit.largest_input[joint]);
    (reach > largest && reach > 1e-6).then(|| Remark {
        kind: WarningKind::InputSetSize,
        joint: joint + 1,
        text: format!(
            "joint {} {} {}, {}",
            joint + 1,
            short(reach),
            problem.robot().kinds()[joint].force_unit(),
            short(largest)
        ),
    })
}

/// Formats a size to three digits.
fn short(value: f64) -> String {
    let exponent = if value > 0.0 { value.log10().floor() as i32 } else { 0 };
    match exponent {
        -3..=4 => format!("{value:.*}", (2 - exponent).max(0) as usize),
        _ => format!("{value:.2e}"),
    }
}
