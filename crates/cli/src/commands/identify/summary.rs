//! The text that `identify` prints.

use std::fmt::Write;

use reachtube::identify::{Identification, JointFit, LogValidation, WindowErrors};

use crate::numbers::number;
use crate::table::table;

pub fn summary(found: &Identification) -> String {
    let mut text = format!("{}: identified\n", found.description.name);
    gravity(&mut text, found);
    friction(&mut text, found);
    inertia(&mut text, found);
    gains(&mut text, found);
    validation(&mut text, found);
    windows(&mut text, found);
    text
}

fn names(found: &Identification) -> Vec<&str> {
    found.description.joints.iter().map(|joint| joint.name.as_str()).collect()
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn gravity(text: &mut String, found: &Identification) {
    let Some(gravity) = &found.gravity else {
        text.push_str("\n1. gravity: no poses at rest and no slow motions; it is part of 3\n");
        return;
    };
    let _ = writeln!(
        text,
        "\n1. gravity: {} poses at rest, {} samples of slow motions",
        gravity.rests, gravity.slow_samples
    );
    let row = |joint: usize| {
        let cells = |fits: &[JointFit]| match fits.get(joint) {
            Some(fit) => vec![number(fit.torque), number(fit.residual), percent(fit.relative())],
            None => vec!["-".into(); 3],
        };
        [vec![names(found)[joint].to_string()], cells(&gravity.at_rest), cells(&gravity.in_motion)]
            .concat()
    };
    let rows: Vec<Vec<String>> = (0..names(found).len()).map(row).collect();
    let header = [
        "joint",
        "at rest: tau rms [N m]",
        "residual",
        "part",
        "moving: tau rms",
        "residual",
        "part",
    ];
    text.push_str(&table(&header, &rows));
}

fn friction(text: &mut String, found: &Identification) {
    if found.friction.is_empty() {
        text.push_str("\n2. friction: no motions of one slow joint; it is part of 3\n");
        return;
    }
    text.push_str("\n2. friction, with the gravity torque as load\n");
    let list =
        |values: &[f64]| values.iter().map(|v| format!("{v:.3}")).collect::<Vec<_>>().join(" ");
    let rows: Vec<Vec<String>> = found
        .friction
        .iter()
        .map(|fit| {
            let joint = &fit.joint;
            vec![
                joint.joint.clone(),
                format!("{:.5}", joint.r2),
                format!("{:.4}", joint.r2_without_gravity),
                number(joint.residual),
                format!("{} ({:.0})", joint.samples.0, joint.samples.1),
                list(&joint.coefficients.coulomb),
                list(&joint.coefficients.viscous),
            ]
        })
        .collect();
    let header = [
        "joint",
        "R2",
        "R2 less gravity",
        "residual [N m]",
        "samples (independent)",
        "Coulomb a1..a8",
        "viscous v1..v3",
    ];
    text.push_str(&table(&header, &rows));
}

fn inertia(text: &mut String, found: &Identification) {
    let fit = &found.inertia;
    let shown =
        fit.parameters.iter().filter(|parameter| parameter.standard_error.is_finite()).count();
    let _ = writeln!(
        text,
        "\n3. inertial parameters: {shown} of {} combinations shown, condition {} (structure: relative singular values {:.0e} | {:.0e})",
        fit.parameters.len(),
        number(fit.condition),
        fit.gap[0],
        fit.gap[1]
    );
    let rows: Vec<Vec<String>> = fit
        .joints
        .iter()
        .zip(names(found))
        .enumerate()
        .map(|(j, (joint, name))| {
            let physical = fit
                .physical
                .as_ref()
                .map_or("-".into(), |physical| number(physical.residuals[j][1]));
            vec![
                name.into(),
                format!("{} ({:.0})", joint.rows, joint.independent),
                number(joint.torque),
                number(joint.residual),
                percent(joint.relative()),
                physical,
                percent(joint.outliers),
            ]
        })
        .collect();
    let header = [
        "joint",
        "samples (independent)",
        "tau rms [N m]",
        "residual",
        "part",
        "residual, physical",
        "outliers",
    ];
    text.push_str(&table(&header, &rows));
    parameters(text, found);
    let Some(physical) = &fit.physical else { return };
    match &physical.plain_impossible {
        Some(why) => {
            let _ = writeln!(text, "plain least squares gives no possible robot: {why}");
        }
        None => text.push_str("the mass matrix of plain least squares is positive definite\n"),
    }
    let _ = writeln!(
        text,
        "links made bodies: the sum of squares grows by {} (standard deviations squared; objective within {} of the least)",
        number(physical.cost),
        number(physical.gap)
    );
}

fn parameters(text: &mut String, found: &Identification) {
    let row = |parameter: &reachtube::identify::BaseParameter| {
        let relative = parameter.standard_error / parameter.least_squares.abs();
        vec![
            number(parameter.value),
            number(parameter.least_squares),
            number(parameter.standard_error),
            if relative < 10.0 { percent(relative) } else { "-".into() },
            number(parameter.described),
            parameter.name.clone(),
        ]
    };
    let rows: Vec<Vec<String>> = found.inertia.parameters.iter().map(row).collect();
    let header =
        ["value", "least squares", "standard error", "part", "described", "combination (SI units)"];
    text.push_str(&table(&header, &rows));
}

fn gains(text: &mut String, found: &Identification) {
    let gains: Vec<String> = found
        .gains
        .iter()
        .map(|gain| format!("{:.3} ± {:.3}", gain.gain, gain.standard_error))
        .collect();
    let _ =
        writeln!(text, "gains by which the joints' torques would agree best: {}", gains.join(", "));
}

fn validation(text: &mut String, found: &Identification) {
    let which = if found.kept_back {
        "recordings kept back"
    } else {
        "the recordings fitted to: none was kept back"
    };
    let _ = writeln!(
        text,
        "\n4. torque predicted on {which}: part not explained where a joint moves (plain least squares; with standstill), R2"
    );
    let row = |log: &LogValidation| {
        let cell = |joint: &reachtube::identify::JointError| {
            format!(
                "{} ({}; {}) {:.4}",
                percent(joint.relative),
                percent(joint.relative_plain),
                percent(joint.relative_all),
                joint.r2
            )
        };
        std::iter::once(log.log.clone()).chain(log.joints.iter().map(cell)).collect()
    };
    let rows: Vec<Vec<String>> = found.validation.iter().map(row).collect();
    let header: Vec<&str> = std::iter::once("log").chain(names(found)).collect();
    text.push_str(&table(&header, &rows));
}

fn windows(text: &mut String, found: &Identification) {
    text.push_str("\n5. motion simulated from the recorded torque: rms position error at the end [rad] (motion; velocity error [rad/s])\n");
    let row = |windows: &WindowErrors| {
        let cell = |j: usize| {
            format!(
                "{} ({}; {})",
                number(windows.q[j]),
                number(windows.motion[j]),
                number(windows.qd[j])
            )
        };
        let head = format!(
            "{} s, {} windows, {} diverged",
            windows.duration, windows.windows, windows.diverged
        );
        std::iter::once(head).chain((0..windows.q.len()).map(cell)).collect()
    };
    let rows: Vec<Vec<String>> = found.windows.iter().map(row).collect();
    let header: Vec<&str> = std::iter::once("window").chain(names(found)).collect();
    text.push_str(&table(&header, &rows));
}
