//! The choices that come before the robot: filter, expansion, and the noise of the sensors.

use reachtube_arm::Equations;
use reachtube_conform::settings::NominalStart;
use reachtube_identify::prepare::{PrepareSettings, RawLog, cut_off};
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::choices::LARGEST_GROWTH;
use crate::chooser::Chooser;
use crate::cut::rounded;
use crate::error::Result;
use crate::mean_position::mean_position;
use crate::noise::noise;
use crate::steps::Steps;
use crate::trial::Trial;

/// Chooses the filter, the model of deviations about the mean of the motion, and what the noise of
/// the sensors is. Returns them with the cut-off, Hz, for `robot` as described.
pub(crate) fn first_choices<'a, 'b: 'a>(
    chooser: &mut Chooser<'b>,
    journal: &'a Steps<'a>,
    robot: &Robot,
    torque: Torque,
    raw: &[&RawLog],
    settings: &PrepareSettings,
) -> Result<(Trial<'a>, f64)> {
    let given = chooser.choices.clone();
    let is_filtered = torque != Torque::Compensated;
    let cut_off = cut_off(raw, &PrepareSettings { cut_off: given.cut_off, ..settings.clone() })?;
    let cut_off = rounded(cut_off);
    if is_filtered {
        let reason = "1.5 times the bandwidth of the motions beyond their noise";
        chooser.choose("cut-off", format!("{cut_off} Hz"), why(given.cut_off.is_some(), reason));
        chooser.choices.cut_off = Some(cut_off);
    }
    let reason = why(given.expansion.is_some(), "the mean position of the motions");
    let expansion = given.expansion.unwrap_or_else(|| mean_position(raw));
    chooser.choose("expansion", list(&expansion), reason);
    chooser.choices.expansion = Some(expansion.clone());
    let measured = || noise(raw, is_filtered.then_some(cut_off));
    let reason = match is_filtered {
        true => "5 standard deviations before the filter, less the noise that the filter removes",
        false => "5 standard deviations",
    };
    let reason = why(given.sensor_noise.is_some(), reason);
    let sensor_noise = given.sensor_noise.unwrap_or_else(measured);
    let (q, qd) = sensor_noise.split_at(sensor_noise.len() / 2);
    let most = |radii: &[f64]| radii.iter().copied().fold(0.0, f64::max);
    let value = format!("up to {:.1e} rad and {:.1e} rad/s", most(q), most(qd));
    chooser.choose("sensor-noise", value, reason);
    chooser.choices.sensor_noise = Some(sensor_noise.clone());
    let equations = given.equations.unwrap_or(Equations::Robot);
    let nominal = if is_filtered { NominalStart::Past } else { NominalStart::Mean };
    let robot = robot.clone();
    let (allowance, fit, progress) = (given.allowance, None, chooser.progress);
    let trial = Trial {
        robot,
        torque,
        expansion,
        sensor_noise,
        equations,
        nominal,
        input_doubling: None,
        allowance,
        largest_outside: chooser.choices.largest_outside(),
        largest_growth: chooser.choices.largest_growth.unwrap_or(LARGEST_GROWTH),
        folds: &[],
        fit,
        progress,
        journal,
    };
    Ok((trial, cut_off))
}

/// Returns the reason of a choice: it was given, or it was made.
fn why(is_given: bool, reason: &'static str) -> &'static str {
    if is_given { "given" } else { reason }
}

fn list(values: &[f64]) -> String {
    values.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
