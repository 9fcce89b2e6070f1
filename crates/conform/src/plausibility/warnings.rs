use reachtube_finding::Finding;
use reachtube_recordings::State;

use crate::data::problem::Problem;
use crate::data::signals::Signals;
use crate::error::Result;
use crate::next_motion::calibration::Calibration;
use crate::plausibility::causes::likely_cause;
use crate::plausibility::nominal_fit::NominalFit;
use crate::plausibility::remark::Remark;
use crate::result::code::Code;
use crate::result::findings::plausibility::of_remarks;
use crate::sets::UncertaintySets;

/// X0 that reaches further than the recorded starts by more than this factor is remarked ...
const FACTOR_OF_STARTS: f64 = 10.0;

/// ... where that is also more than this part of the recorded motion.
const PART_OF_MOTION: f64 = 0.02;

/// A nominal motion that explains less than this part of a velocity's variance is remarked.
const LEAST_EXPLAINED: f64 = 0.5;

/// A centre of U below this part of the largest input is not remarked.
const PART_OF_INPUT: f64 = 0.01;

/// U of fewer RMS errors of its part's input than this counts as 0 ...
const FEW_ERRORS: f64 = 0.1;

/// ... which is remarked if U of another part has more errors than this.
const MANY_ERRORS: f64 = 10.0;

/// What is remarked of single parts, in the order of the warnings.
const OF_PARTS: [Code; 11] = [
    Code::ReachableSetSize,
    Code::InitialSetSize,
    Code::InitialSetStarts,
    Code::InitialSetOffset,
    Code::InputSetSize,
    Code::InputSetOffset,
    Code::InputSetZero,
    Code::NoiseSetSize,
    Code::Unexplained,
    Code::FrictionRange,
    Code::FallingFriction,
];

/// Warnings that need no other cause. X0 covers what U covers otherwise if that is cheaper,
/// whatever the recordings are, and friction is a cause of its own.
const OWN_CAUSE: [Code; 3] = [Code::InitialSetStarts, Code::FrictionRange, Code::FallingFriction];

/// Returns what is remarkable about `sets` beside the recordings of `problem`, and the most likely
/// cause where anything is. `radii` are the largest radii of the reachable set, for each state
/// that is checked. `input_error` is the error of each part's input, n, N m. `calibration` is
/// how the sets were scaled, if they were.
pub(crate) fn warnings(
    problem: &Problem,
    sets: &UncertaintySets,
    radii: &[f64],
    fit: &NominalFit,
    input_error: &[f64],
    calibration: Option<&Calibration>,
) -> Result<Vec<Finding>> {
    let n = problem.inputs();
    let mut remarks: Vec<Remark> =
        (0..2 * n).flat_map(|i| of_state(problem, sets, radii.get(i), fit, i)).collect();
    remarks.extend((0..n).filter_map(|part| of_input(problem, sets, fit, part)));
    remarks.extend((0..n).filter_map(|part| offset(problem, sets, fit, part)));
    remarks.extend(zeros(problem.signals(), sets, input_error));
    let drive = &problem.setup().drive;
    for code in [Code::FrictionRange, Code::FallingFriction] {
        remarks.extend((0..n).filter_map(|part| drive.remark(code, part, &|i| fit.recorded[i])));
    }
    let of_code = |code: Code| {
        let of: Vec<&Remark> = remarks.iter().filter(|remark| remark.code == code).collect();
        of_remarks(code, &of, problem.signals())
    };
    let mut found: Vec<Finding> = OF_PARTS.into_iter().filter_map(of_code).collect();
    if found.iter().any(|warning| !OWN_CAUSE.iter().any(|own| warning.code == *own)) {
        let cause = likely_cause(problem, calibration)?;
        found.extend(cause);
    }
    Ok(found)
}

/// Returns a warning where the recordings of a problem are faster than the recordings that friction
/// was fitted to.
pub(crate) fn friction_warning(problem: &Problem) -> Option<Finding> {
    let recorded = |i| problem.recorded_bounds(i);
    let of = |part| problem.setup().drive.remark(Code::FrictionRange, part, &recorded);
    let remarks: Vec<Remark> = (0..problem.parts().len()).filter_map(of).collect();
    of_remarks(Code::FrictionRange, &remarks.iter().collect::<Vec<_>>(), problem.signals())
}

fn of_state(
    problem: &Problem,
    sets: &UncertaintySets,
    radius: Option<&f64>,
    fit: &NominalFit,
    i: usize,
) -> Vec<Remark> {
    let state = State::from_index(i, problem.inputs());
    let unit = problem.signals().unit(state);
    let [low, high] = fit.recorded[i];
    let (range, sensor) = (high - low, problem.sensor_noise().radius[i]);
    let (from, to) = sets.initial_set.bounds(i);
    let (width, noise) = (to - from, sets.noise_radius(i));
    let largest = radius.map_or(0.0, |radius| 2.0 * radius);
    let beside = |size: f64| format!("{state} {} {unit}, {}", short(size), short(range));
    let mut remarks = Vec::new();
    let mut remark = |code, text| remarks.push(Remark { code, part: state.part + 1, text });
    if largest > 2.0 * (range + sensor) {
        remark(Code::ReachableSetSize, beside(largest));
    }
    if width > range + 2.0 * sensor && width > 1e-6 {
        remark(Code::InitialSetSize, beside(width));
    }
    let (reach, start) = (to.max(-from), fit.farthest_starts[i].max(sensor));
    let is_position = i < problem.inputs();
    if is_position && reach > (FACTOR_OF_STARTS * start).max(PART_OF_MOTION * range) {
        let text = format!("{state} {} {unit}, {}", short(reach), short(fit.farthest_starts[i]));
        remark(Code::InitialSetStarts, text);
    }
    let offset = from.max(-to);
    let allowed = match problem.settings().nominal.is_measured() {
        true => sensor,
        false => sensor.max(0.05 * range),
    };
    if offset > allowed.max(1e-6) {
        remark(Code::InitialSetOffset, format!("{state} {} {unit}", short(offset)));
    }
    if 4.0 * noise > range && noise > 1e-6 {
        remark(Code::NoiseSetSize, beside(2.0 * noise));
    }
    if let Some(part) = fit.explained[i].filter(|part| !is_position && *part < LEAST_EXPLAINED) {
        let part = if part <= 0.0 { "nothing".into() } else { format!("{:.0} %", 100.0 * part) };
        remark(Code::Unexplained, format!("{state} {part}"));
    }
    remarks
}

/// Returns the remark that U reaches beyond the recorded input of `part` (from 0).
fn of_input(
    problem: &Problem,
    sets: &UncertaintySets,
    fit: &NominalFit,
    part: usize,
) -> Option<Remark> {
    let (low, high) = sets.input_set.bounds(part);
    let (reach, largest) = (high.max(-low), fit.largest_input[part]);
    // Where nothing is recorded, there is nothing to compare with.
    (reach > largest && largest > 1e-6).then(|| Remark {
        code: Code::InputSetSize,
        part: part + 1,
        text: format!(
            "{} {} {} {}, {}",
            problem.signals().noun,
            part + 1,
            short(reach),
            problem.signals().inputs[part].unit,
            short(largest)
        ),
    })
}

/// Returns the remark that U of `part` (from 0) lies away from 0 by more than its radius.
fn offset(
    problem: &Problem,
    sets: &UncertaintySets,
    fit: &NominalFit,
    part: usize,
) -> Option<Remark> {
    let (low, high) = sets.input_set.bounds(part);
    let is_away = low > 0.0 || high < 0.0;
    let centre = 0.5 * (low + high);
    (is_away && centre.abs() > PART_OF_INPUT * fit.largest_input[part]).then(|| Remark {
        code: Code::InputSetOffset,
        part: part + 1,
        text: format!(
            "{} {} {}{} {}, {}",
            problem.signals().noun,
            part + 1,
            if centre < 0.0 { "-" } else { "" },
            short(centre.abs()),
            problem.signals().inputs[part].unit,
            short(0.5 * (high - low))
        ),
    })
}

/// Returns remarks on parts whose U is 0 beside their input error, if U of another part is many
/// times its own error.
fn zeros(signals: &Signals, sets: &UncertaintySets, input_error: &[f64]) -> Vec<Remark> {
    let reach = |part: usize| {
        let (low, high) = sets.input_set.bounds(part);
        high.max(-low)
    };
    let parts = || input_error.iter().enumerate().filter(|(_, error)| **error > 0.0);
    let takes_over = parts().any(|(part, error)| reach(part) > MANY_ERRORS * error);
    let is_zero = |(part, error): &(usize, &f64)| reach(*part) < FEW_ERRORS * **error;
    let remark = |(part, error): (usize, &f64)| Remark {
        code: Code::InputSetZero,
        part: part + 1,
        text: format!(
            "{} {} {} {}, {}",
            signals.noun,
            part + 1,
            short(reach(part)),
            signals.inputs[part].unit,
            short(*error)
        ),
    };
    if takes_over { parts().filter(is_zero).map(remark).collect() } else { Vec::new() }
}

/// Formats a size to three digits.
fn short(value: f64) -> String {
    let exponent = if value > 0.0 { value.log10().floor() as i32 } else { 0 };
    match exponent {
        -3..=4 => format!("{value:.*}", (2 - exponent).max(0) as usize),
        _ => format!("{value:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use reachtube_reach::Hyperrectangle;

    use super::*;
    use crate::data::signals::Signal;

    #[test]
    fn a_set_of_0_is_remarked_if_another_part_covers_its_error() {
        let input = Signal { name: "tau".into(), unit: "N m".into() };
        let signals = Signals { inputs: vec![input; 2], ..Signals::default() };
        let zeros_of = |radius: [f64; 2]| -> Vec<usize> {
            let set = |radius: Vec<f64>| Hyperrectangle { centre: vec![0.0; 2], radius };
            let (initial_set, input_set) = (set(vec![0.0; 2]), set(radius.to_vec()));
            let sets = UncertaintySets { initial_set, input_set, noise_set: None };
            let remarks = zeros(&signals, &sets, &[0.1, 0.2]);
            assert!(remarks.iter().all(|remark| remark.code == Code::InputSetZero));
            remarks.iter().map(|remark| remark.part).collect()
        };
        assert_eq!(zeros_of([0.0, 2.1]), [1]);
        assert_eq!(zeros_of([1.1, 0.01]), [2]);
        // Each part covers its own error, or no other part takes over.
        assert!(zeros_of([0.2, 2.1]).is_empty() && zeros_of([0.0, 1.9]).is_empty());
    }
}
