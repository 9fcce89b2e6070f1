//! What `identify` prints about friction laws.

use reachtube::identify::{
    FrictionFit, Identification, JointWarming, LawGain, SaturatingFriction, StribeckTrial,
    WarmingCandidate, WarmingFit,
};
use reachtube::number::four_decimals;
use reachtube::units::ColumnUnit;
use reachtube_robot::JointKind;
use reachtube_robot::friction::WarmingBy;

use crate::table::table;

/// Returns the section about friction laws; it is empty where none was asked for or found.
pub(super) fn laws(found: &Identification) -> String {
    let saturating = saturating(found);
    let Some(gain) = &found.laws else {
        let title = if saturating.is_empty() { "" } else { "\nfriction laws\n" };
        return format!("{title}{saturating}");
    };
    let stribeck = stribeck(found);
    let warming = found.warming.as_ref().map_or_else(String::new, |fit| warming(found, fit));
    format!("\nfriction laws\n{saturating}{stribeck}{warming}{}", gains(found, gain))
}

/// Returns the unit of torques.
fn force(found: &Identification) -> ColumnUnit {
    ColumnUnit::new(&found.description.kinds(), JointKind::force_unit)
}

/// Returns the table of the joints whose friction saturates.
fn saturating(found: &Identification) -> String {
    if found.saturating.is_empty() {
        return String::new();
    }
    let row = |law: &SaturatingFriction| {
        let numbers = [law.held_out[0], law.held_out[1], law.builds_up, law.speed];
        let numbers = numbers.into_iter().map(four_decimals);
        std::iter::once(law.joint.clone()).chain(numbers).collect()
    };
    let header =
        ["friction saturates", "residual without", "held-out residual with", "builds up", "over"];
    table(&header, &found.saturating.iter().map(row).collect::<Vec<_>>())
}

/// Returns the table of the Stribeck effect of each joint that was tried.
fn stribeck(found: &Identification) -> String {
    let tried = |fit: &FrictionFit| {
        fit.joint.stribeck.as_ref().map(|trial| (fit.joint.clone(), trial.clone()))
    };
    let tried: Vec<_> = found.friction.iter().filter_map(tried).collect();
    if tried.is_empty() {
        return String::new();
    }
    let row = |(joint, trial): &(reachtube::identify::JointFriction, StribeckTrial)| {
        let [excess, speed] = match (joint.coefficients.stribeck, joint.standard_errors.stribeck) {
            (Some(law), Some(error)) => [
                format!("{} ± {}", four_decimals(law.excess), four_decimals(error.excess)),
                format!("{} ± {}", four_decimals(law.speed), four_decimals(error.speed)),
            ],
            _ => ["-".into(), "-".into()],
        };
        vec![
            joint.joint.clone(),
            four_decimals(trial.held_out[0]),
            four_decimals(trial.held_out[1]),
            excess,
            speed,
            trial.reason.clone().unwrap_or_else(|| "accepted".into()),
        ]
    };
    let header = ["Stribeck effect", "held-out residual without", "with", "excess", "speed", ""];
    table(&header, &tried.iter().map(row).collect::<Vec<_>>())
}

/// Returns the comparison of the laws of warming and the law of each joint.
fn warming(found: &Identification, fit: &WarmingFit) -> String {
    if fit.candidates.is_empty() {
        return String::new();
    }
    let candidate = |candidate: &WarmingCandidate| {
        vec![name(candidate.by, candidate.time_constant), four_decimals(candidate.held_out)]
    };
    let candidates: Vec<_> = fit.candidates.iter().map(candidate).collect();
    let unit = force(found);
    let row = |(i, joint): (usize, &JointWarming)| {
        let law = joint.law.map_or_else(
            || {
                vec![
                    "no law predicts held-out parts better".into(),
                    "-".into(),
                    "-".into(),
                    "-".into(),
                ]
            },
            |law| {
                let rates = [law.coulomb, law.viscous].into_iter().zip(joint.standard_errors);
                let mut cells = vec![name(law.by, law.time_constant), format!("{}", law.reference)];
                cells.extend(rates.map(|(rate, error)| format!("{rate:.5} ± {error:.5}")));
                cells
            },
        );
        let held_out = joint.held_out.map(|residual| unit.cell(i, four_decimals(residual)));
        [vec![joint.joint.clone()], law, held_out.to_vec()].concat()
    };
    let rows: Vec<_> = fit.joints.iter().enumerate().map(row).collect();
    let header = [
        "warming",
        "law",
        "reference",
        "Coulomb rate",
        "viscous rate",
        &unit.head("held-out residual without"),
        "with",
    ];
    let parts = format!("residual over held-out {}, relative", fit.held_out_parts);
    format!("{}{}", table(&["friction by", &parts], &candidates), table(&header, &rows))
}

fn name(by: WarmingBy, time_constant: Option<f64>) -> String {
    match by {
        WarmingBy::Temperature => "temperature [°C]".into(),
        WarmingBy::Runs => "logarithm of runs".into(),
        WarmingBy::Thermal => {
            format!("thermal state, {} runs", time_constant.unwrap_or_default())
        }
    }
}

/// Returns the residuals without and with the laws.
fn gains(found: &Identification, gain: &LawGain) -> String {
    let unit = force(found);
    let row = |((i, joint), (before, after)): ((usize, &_), (&f64, &f64))| {
        let joint: &reachtube_robot::JointDescription = joint;
        let change = if *before > 0.0 { 100.0 * (after / before - 1.0) } else { 0.0 };
        vec![
            joint.name.clone(),
            unit.cell(i, four_decimals(*before)),
            unit.cell(i, four_decimals(*after)),
            format!("{change:+.1} %"),
        ]
    };
    let joints = found.description.joints.iter().enumerate();
    let rows: Vec<_> = joints.zip(gain.before.iter().zip(&gain.after)).map(row).collect();
    let what = if gain.held_out { "validation recordings" } else { "exciting motions" };
    let head = unit.head(&format!("{what}: residual without laws"));
    table(&["joint", &head, "with", "change"], &rows)
}
