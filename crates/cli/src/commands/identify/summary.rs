//! The text that `identify` prints.

use reachtube::identify::{
    BaseParameter, FrictionFit, Identification, InertiaFit, JointError, JointFit, JointFriction,
    LogValidation, PhysicalFit, PositionOffset, WindowErrors,
};

use reachtube::units::ColumnUnit;
use reachtube_robot::JointKind;

use super::laws::laws;
use crate::table::table;
use reachtube::number::four_decimals;

/// Largest number of recordings that are listed.
const MOST_RECORDINGS: usize = 40;

/// Returns the result of `identify`, with one section per step.
pub(super) fn summary(found: &Identification) -> String {
    [
        format!("{}: identified\n", found.description.name),
        gravity(found),
        friction(found),
        inertia(found),
        laws(found),
        gains(found),
        offsets(found),
        validation(found),
        windows(found),
    ]
    .concat()
}

fn names(found: &Identification) -> Vec<&str> {
    found.description.joints.iter().map(|joint| joint.name.as_str()).collect()
}

fn joint_header<'a>(first: &'a str, found: &'a Identification) -> Vec<&'a str> {
    std::iter::once(first).chain(names(found)).collect()
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn gravity(found: &Identification) -> String {
    let Some(gravity) = &found.gravity else {
        return "\n1. gravity: no poses at rest or slow motions are given; step 3 identifies it\n"
            .into();
    };
    let row = |(joint, name): (usize, &str)| {
        [
            vec![name.into()],
            gravity_cells(gravity.at_rest.get(joint), &|value| force(found).cell(joint, value)),
            gravity_cells(gravity.in_motion.get(joint), &|value| force(found).cell(joint, value)),
        ]
        .concat()
    };
    let rows: Vec<_> = names(found).into_iter().enumerate().map(row).collect();
    let header = [
        "joint",
        &force(found).head("at rest: tau rms"),
        "residual",
        "relative",
        "moving: tau rms",
        "residual",
        "relative",
    ];
    format!(
        "\n1. gravity: {} poses at rest, {} samples of slow motions\n{}",
        gravity.rests,
        gravity.slow_samples,
        table(&header, &rows)
    )
}

/// Returns the unit of torques.
fn force(found: &Identification) -> ColumnUnit {
    ColumnUnit::new(&found.description.kinds(), JointKind::force_unit)
}

fn gravity_cells(fit: Option<&JointFit>, force: &dyn Fn(String) -> String) -> Vec<String> {
    let torque = |value| force(four_decimals(value));
    match fit {
        Some(fit) => vec![torque(fit.torque), torque(fit.residual), percent(fit.relative())],
        None => vec!["-".into(); 3],
    }
}

fn friction(found: &Identification) -> String {
    if found.friction.is_empty() {
        return "\n2. friction: no slow motions of single joints are given; step 3 identifies it\n"
            .into();
    }
    let kind = |name: &str| {
        let own = found.description.joints.iter().find(|joint| joint.name == name);
        own.map_or_else(JointKind::default, |joint| joint.kind)
    };
    let kinds: Vec<_> = found.friction.iter().map(|fit| kind(&fit.joint.joint)).collect();
    let force = ColumnUnit::new(&kinds, JointKind::force_unit);
    let row = |(i, fit): (usize, &FrictionFit)| friction_row(&fit.joint, &|x| force.cell(i, x));
    let rows: Vec<_> = found.friction.iter().enumerate().map(row).collect();
    let header = [
        "joint",
        "R2",
        "R2 without gravity",
        &force.head("residual"),
        "samples (independent)",
        "Coulomb a1..a8",
        "viscous v1..v3",
    ];
    format!("\n2. friction, with the gravity torque as load\n{}", table(&header, &rows))
}

fn friction_row(joint: &JointFriction, force: &dyn Fn(String) -> String) -> Vec<String> {
    let list =
        |values: &[f64]| values.iter().map(|v| format!("{v:.3}")).collect::<Vec<_>>().join(" ");
    vec![
        joint.joint.clone(),
        format!("{:.5}", joint.r2),
        format!("{:.4}", joint.r2_without_gravity),
        force(four_decimals(joint.residual)),
        format!("{} ({:.0})", joint.samples.0, joint.samples.1),
        list(&joint.coefficients.coulomb),
        list(&joint.coefficients.viscous),
    ]
}

fn inertia(found: &Identification) -> String {
    let fit = &found.inertia;
    let rows: Vec<_> =
        names(found).into_iter().enumerate().map(|(j, name)| inertia_row(found, j, name)).collect();
    let header = [
        "joint",
        "samples (independent)",
        &force(found).head("tau rms"),
        "residual",
        "relative",
        "residual, physical",
        "outliers",
    ];
    format!(
        "\n3. inertial parameters: {} of {} combinations determined, condition number {} (relative \
         singular values beside the rank cut: {:.0e} | {:.0e})\n{}{}{}",
        fit.determined,
        fit.parameters.len(),
        four_decimals(fit.condition),
        fit.gap[0],
        fit.gap[1],
        table(&header, &rows),
        parameters(fit),
        fit.physical.as_ref().map(physical).unwrap_or_default()
    )
}

fn inertia_row(found: &Identification, j: usize, name: &str) -> Vec<String> {
    let torque = |value| force(found).cell(j, four_decimals(value));
    let fit = &found.inertia;
    let joint = &fit.joints[j];
    let physical = fit.physical.as_ref().map(|physical| torque(physical.residuals[j][1]));
    vec![
        name.into(),
        format!("{} ({:.0})", joint.rows, joint.independent),
        torque(joint.torque),
        torque(joint.residual),
        percent(joint.relative()),
        physical.unwrap_or_else(|| "-".into()),
        percent(joint.outliers),
    ]
}

fn parameters(fit: &InertiaFit) -> String {
    let row = |parameter: &BaseParameter| {
        let relative = parameter.standard_error / parameter.least_squares.abs();
        vec![
            four_decimals(parameter.value),
            four_decimals(parameter.least_squares),
            four_decimals(parameter.standard_error),
            if relative < 10.0 { percent(relative) } else { "-".into() },
            four_decimals(parameter.described),
            parameter.name.clone(),
        ]
    };
    let rows: Vec<_> = fit.parameters.iter().map(row).collect();
    let header = [
        "value",
        "least squares",
        "standard error",
        "relative",
        "in the description",
        "combination (SI units)",
    ];
    table(&header, &rows)
}

/// Reports what it costs that every link is a physical body.
fn physical(physical: &PhysicalFit) -> String {
    let plain = match &physical.plain_impossible {
        Some(why) => format!("plain least squares gives a robot that cannot exist: {why}"),
        None => "the mass matrix of plain least squares is positive definite".into(),
    };
    format!(
        "{plain}\nphysical links raise the sum of squared residuals by {} standard deviations \
         squared (objective within {} of its minimum)\n",
        four_decimals(physical.cost),
        four_decimals(physical.gap)
    )
}

fn gains(found: &Identification) -> String {
    let gains: Vec<String> = found
        .gains
        .iter()
        .map(|gain| format!("{:.3} ± {:.3}", gain.gain, gain.standard_error))
        .collect();
    format!(
        "torque gains for which the joints agree best (± standard error): {}\n",
        gains.join(", ")
    )
}

/// Returns the offsets of the positions, and the size from which on one would be reported.
fn offsets(found: &Identification) -> String {
    if found.offsets.is_empty() {
        return String::new();
    }
    let unit = ColumnUnit::new(&found.description.kinds(), JointKind::position_unit);
    let list = |cell: &dyn Fn(&PositionOffset) -> Option<String>| {
        let cell = |(j, joint)| cell(joint).map_or("-".into(), |value| unit.cell(j, value));
        found.offsets.iter().enumerate().map(cell).collect::<Vec<_>>().join(", ")
    };
    let own = |joint: &PositionOffset| {
        Some(format!("{:.4} ± {:.4}", joint.offset?, joint.standard_error?))
    };
    let limit = |joint: &PositionOffset| Some(format!("{:.3}", joint.limit?));
    format!(
        "{} that explain the torque best, each alone (± standard error): {}\nsmaller offsets may \
        be errors of the model: {}\n",
        unit.head("offsets of the positions"),
        list(&own),
        list(&limit)
    )
}

fn validation(found: &Identification) -> String {
    let recordings = if found.held_out {
        "recordings held out"
    } else {
        "the recordings of the fit, since none were held out"
    };
    let cell = |joint: &JointError| {
        let part = |part: Option<f64>| part.map_or("-".into(), percent);
        if joint.samples == 0 {
            return format!("at rest (-; {})", part(joint.relative_all));
        }
        format!(
            "{} ({}; {}) {}",
            part(joint.relative),
            part(joint.relative_plain),
            part(joint.relative_all),
            joint.r2.map_or("-".into(), |r2| format!("{r2:.4}"))
        )
    };
    let row = |log: &LogValidation| {
        std::iter::once(log.log.clone()).chain(log.joints.iter().map(cell)).collect()
    };
    // The last row is for all recordings.
    let left_out = found.validation.len().saturating_sub(MOST_RECORDINGS);
    let shown = found.validation.iter().enumerate();
    let shown = shown.filter(|(k, _)| *k + 1 < MOST_RECORDINGS || *k + 1 == found.validation.len());
    let rows: Vec<Vec<String>> = shown.map(|(_, log)| row(log)).collect();
    let left_out = match left_out {
        0 => String::new(),
        count => format!("  ({count} more recordings are not shown; --json has all)\n"),
    };
    format!(
        "\n4. torque predicted on {recordings}: relative error while the joint moves (of plain \
         least squares; with standstill), R2\n{}{left_out}",
        table(&joint_header("log", found), &rows)
    )
}

fn windows(found: &Identification) -> String {
    let kinds = found.description.kinds();
    let q = ColumnUnit::new(&kinds, JointKind::position_unit);
    let qd = ColumnUnit::new(&kinds, JointKind::velocity_unit);
    let row = |windows: &WindowErrors| {
        let some_end = windows.diverged < windows.windows;
        let error = |error: f64| if some_end { four_decimals(error) } else { "-".into() };
        let cell = |j: usize| {
            format!(
                "{} ({}; {})",
                q.cell(j, error(windows.q[j])),
                q.cell(j, four_decimals(windows.motion[j])),
                qd.cell(j, error(windows.qd[j]))
            )
        };
        let head = format!(
            "{} s, {} windows, {} diverged",
            windows.duration, windows.windows, windows.diverged
        );
        std::iter::once(head).chain((0..windows.q.len()).map(cell)).collect()
    };
    let rows: Vec<Vec<String>> = found.windows.iter().map(row).collect();
    format!(
        "\n5. motion simulated from the recorded torque: {} at the end of each window ({}; {})\n{}",
        q.head("rms position error"),
        q.head("rms motion"),
        qd.head("rms velocity error"),
        table(&joint_header("window", found), &rows)
    )
}
