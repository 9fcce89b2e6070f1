//! The page of an identified robot: the robot, its accuracy, then the fits, the residuals, and
//! every parameter.

use super::chart::{Chart, chart_svg, chart_svg_of_height};
use super::error::Error;
use super::html::warning_list;
use super::identified_arm::arm_svgs;
use super::identified_charts::{RESIDUAL_HEIGHT, load_chart, torque_charts, viscous_chart};
use super::identified_parameters::parameter_svg;
use super::skeleton::{document, named_rows, section, wide_table};
use super::tables;
use super::terms::Explained;
use super::text::Text;
use maud::{Markup, PreEscaped, html};
use reachtube_identify::{
    BaseParameter, FrictionFit, Gain, Identification, InertiaFit, JointError, JointFit,
    LogValidation, WindowErrors,
};
use reachtube_robot::units::ColumnUnit;
use reachtube_robot::{FrictionDescription, JointKind, Robot};
use reachtube_scalar::number::significant;
use std::io::Write;

/// Largest number of logs whose torque is drawn.
const MOST_LOGS: usize = 4;

/// Largest number of recordings in a table.
const MOST_ROWS: usize = 20;

/// Writes the page of an identification as one HTML file that needs no other file.
///
/// # Errors
///
/// Fails for numbers that cannot be drawn, and where `out` fails.
pub fn write_identified_html(found: &Identification, out: &mut impl Write) -> Result<(), Error> {
    let kinds = &found.description.kinds()[..];
    let joints: Vec<&str> =
        found.description.joints.iter().map(|joint| joint.name.as_str()).collect();
    let body = html! {
        @if !found.warnings.is_empty() { (section("Warnings", &warning_list(&found.warnings))) }
        @if let Ok(robot) = Robot::from_description(&found.description) {
            (section("The robot", &arm(&robot)?))
        }
        (section("Predicted torque", &prediction(found, &joints)?))
        (section("Simulated motion", &windows(&found.windows, &joints, kinds)))
        @if !found.friction.is_empty() {
            (section("Friction", &friction(found)?))
        }
        (section("Inertial parameters", &inertia(found, &joints, kinds)?))
        @if !found.changes.is_empty() {
            (section("Recordings", &html! {
                ul.yes { @for change in &found.changes { li { (Explained(change)) } } }
            }))
        }
    };
    let title = format!("{}: identified", found.description.name);
    let subtitle = "Gravity, friction and inertia identified from recordings";
    out.write_all(document(&title, subtitle, &body, &Markup::default()).as_bytes())?;
    Ok(())
}

/// Returns the drawing of the robot.
fn arm(robot: &Robot) -> Result<Markup, Error> {
    let svgs = arm_svgs(robot)?;
    Ok(html! {
        p { "At q = 0. Grey: links. Blue: joint axes." }
        div.charts { (PreEscaped(svgs)) }
    })
}

/// Returns a table with a head; the first cell of a row names it.
fn table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> Markup {
    let head = html! {
        @for name in head { th scope="col" { (Text(name)) } }
    };
    wide_table("long", caption, &head, &named_rows(rows))
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

/// Returns charts in stacks of one chart over another, the lower one with a height \[px\] if it has
/// one of its own.
fn stacks(stacks: &[[Chart; 2]], height: Option<f64>) -> Result<Markup, Error> {
    let stack = |[above, below]: &[Chart; 2]| {
        let below = match height {
            Some(height) => chart_svg_of_height(below, height)?,
            None => chart_svg(below)?,
        };
        Ok(chart_svg(above)? + &below)
    };
    let svgs: Vec<String> = stacks.iter().map(stack).collect::<Result<_, Error>>()?;
    Ok(html! {
        div.charts { @for svg in &svgs { div.stack { (PreEscaped(svg)) } } }
    })
}

fn prediction(found: &Identification, joints: &[&str]) -> Result<Markup, Error> {
    let which = if found.held_out {
        "These recordings were held out from the fits."
    } else {
        "No recording was held out: the fits used these recordings too."
    };
    let kinds = found.description.kinds();
    let mut logs = Vec::new();
    for trace in found.traces.iter().take(MOST_LOGS) {
        let of_joint =
            |(joint, name): (usize, &&str)| torque_charts(trace, joint, name, kinds[joint]);
        let of_log: Vec<[Chart; 2]> = joints.iter().enumerate().map(of_joint).collect();
        logs.push((&trace.log, stacks(&of_log, Some(RESIDUAL_HEIGHT))?));
    }
    Ok(html! {
        p { (which) }
        @if let Some(all) = found.validation.last() { (all_recordings(all, joints, &kinds)) }
        @if found.validation.len() > 1 { (each_recording(&found.validation, joints)) }
        p {
            "Grey: recorded. Blue: predicted from the motion. Red: recorded minus predicted. \
             Friction at standstill has no unique value, so nothing is predicted there."
        }
        @for (log, charts) in logs {
            h3 { (Text(log)) }
            (charts)
        }
    })
}

fn part(part: Option<f64>) -> String {
    part.map_or("-".into(), percent)
}

/// Returns the errors over all recordings, one row per joint.
fn all_recordings(all: &LogValidation, joints: &[&str], kinds: &[JointKind]) -> Markup {
    let force = ColumnUnit::new(kinds, JointKind::force_unit);
    let [torque, residual] = ["Torque, rms", "Error, rms"].map(|name| force.head(name));
    let head = ["Joint", &torque, &residual, "Error / torque", "With standstill", "R²"];
    let row = |(i, error): (usize, &JointError)| {
        vec![
            joints[i].to_string(),
            force.cell(i, significant(error.torque, 3)),
            force.cell(i, significant(error.residual, 3)),
            part(error.relative),
            part(error.relative_all),
            error.r2.map_or("-".into(), |r2| format!("{r2:.4}")),
        ]
    };
    let rows: Vec<Vec<String>> = all.joints.iter().enumerate().map(row).collect();
    table("Error of the predicted torque over all recordings, where a joint moves", &head, &rows)
}

/// Returns the relative errors of the recordings, the worst first if there are many.
fn each_recording(validation: &[LogValidation], joints: &[&str]) -> Markup {
    let mut logs: Vec<&LogValidation> = validation[..validation.len() - 1].iter().collect();
    let worst = |log: &LogValidation| {
        log.joints.iter().filter_map(|joint| joint.relative).fold(0.0, f64::max)
    };
    let all = logs.len();
    if all > MOST_ROWS {
        logs.sort_by(|a, b| worst(b).total_cmp(&worst(a)));
        logs.truncate(MOST_ROWS);
    }
    let caption = match all - logs.len() {
        0 => "Error / torque in each recording".to_string(),
        _ => format!("Error / torque in the worst {MOST_ROWS} of {all} recordings"),
    };
    let row = |log: &&LogValidation| {
        let cells = log.joints.iter().map(|joint| part(joint.relative));
        std::iter::once(log.log.clone()).chain(cells).collect()
    };
    let rows: Vec<Vec<String>> = logs.iter().map(row).collect();
    table(&caption, &[&["Recording"], joints].concat(), &rows)
}

fn windows(windows: &[WindowErrors], joints: &[&str], kinds: &[JointKind]) -> Markup {
    let caption = "Root mean squares over windows driven by the recorded torque";
    let [position, motion] = ["Position error at the end", "Motion of the joint"]
        .map(|name| ColumnUnit::new(kinds, JointKind::position_unit).head(name));
    let velocity = ColumnUnit::new(kinds, JointKind::velocity_unit).head("Velocity error");
    let head = ["Window", "Joint", &position, &motion, &velocity];
    let row = |window: &WindowErrors, joint: usize| {
        let name =
            format!("{} s ({}, {} diverged)", window.duration, window.windows, window.diverged);
        vec![
            if joint == 0 { name } else { String::new() },
            joints[joint].to_string(),
            significant(window.q[joint], 3),
            significant(window.motion[joint], 3),
            significant(window.qd[joint], 3),
        ]
    };
    let of_window = |window| (0..joints.len()).map(move |joint| row(window, joint));
    let rows: Vec<Vec<String>> = windows.iter().flat_map(of_window).collect();
    table(caption, &head, &rows)
}

fn friction(found: &Identification) -> Result<Markup, Error> {
    let caption = "Coefficients of Coulomb friction, eqs. (6) to (9), and of viscous friction, \
                   eq. (5), with standard errors";
    let kinds: Vec<_> = found.friction.iter().map(|fit| kind_of(found, fit)).collect();
    let fits = || found.friction.iter().zip(&kinds);
    let force = ColumnUnit::new(&kinds, JointKind::force_unit);
    let residual = force.head("Residual");
    let names: Vec<&str> = found.friction.iter().map(|fit| fit.joint.joint.as_str()).collect();
    let head = [&["Coefficient"], &names[..]].concat();
    let mut rows: Vec<Vec<String>> = (0..11).map(|k| friction_row(found, k)).collect();
    let of_each = |name: &str, cell: &dyn Fn(usize, &FrictionFit) -> String| {
        let cells = found.friction.iter().enumerate().map(|(i, fit)| cell(i, fit));
        std::iter::once(name.to_string()).chain(cells).collect::<Vec<_>>()
    };
    rows.push(of_each("R²", &|_, fit| format!("{:.5}", fit.joint.r2)));
    rows.push(of_each(&residual, &|i, fit| force.cell(i, significant(fit.joint.residual, 3))));
    let all: Vec<[Chart; 2]> =
        fits().map(|(fit, kind)| [load_chart(fit, *kind), viscous_chart(fit, *kind)]).collect();
    Ok(html! {
        (table(caption, &head, &rows))
        p {
            "Blue: recorded torque minus gravity, the joint's inertia and the other part of \
             friction. Orange: fitted friction."
        }
        (stacks(&all, None)?)
    })
}

fn kind_of(found: &Identification, fit: &FrictionFit) -> JointKind {
    let own = found.description.joints.iter().find(|joint| joint.name == fit.joint.joint);
    own.map_or_else(JointKind::default, |joint| joint.kind)
}

/// Returns coefficient `k` of a1 to a8 and v1 to v3, with its standard error for each joint.
fn friction_row(found: &Identification, k: usize) -> Vec<String> {
    let of = |friction: &FrictionDescription| {
        if k < 8 { friction.coulomb[k] } else { friction.viscous[k - 8] }
    };
    let cell = |fit: &FrictionFit| {
        let [value, error] = [&fit.joint.coefficients, &fit.joint.standard_errors].map(of);
        let value = significant(value, 3);
        if error > 0.0 { format!("{value} ± {}", significant(error, 1)) } else { value }
    };
    let name = if k < 8 { format!("a{}", k + 1) } else { format!("v{}", k - 7) };
    std::iter::once(name).chain(found.friction.iter().map(cell)).collect()
}

/// Returns the charts of the combinations, one chart per unit.
fn error_bars(fit: &InertiaFit) -> Result<Markup, Error> {
    let unit = |parameter: &&BaseParameter| match parameter.name.as_bytes() {
        [b'm', b'x' | b'y' | b'z', ..] => Some("kg m"),
        [b'm', ..] => Some("kg"),
        [b'I' | b'J', ..] => Some("kg m²"),
        _ => None,
    };
    let mut svgs = String::new();
    for name in ["kg", "kg m", "kg m²"] {
        let own = fit.parameters.iter().filter(|parameter| unit(parameter) == Some(name));
        let own: Vec<&BaseParameter> = own.collect();
        if !own.is_empty() {
            svgs += &parameter_svg(&own, name)?;
        }
    }
    Ok(html! { div.charts { (PreEscaped(svgs)) } })
}

fn inertia(found: &Identification, joints: &[&str], kinds: &[JointKind]) -> Result<Markup, Error> {
    let (fit, gains) = (&found.inertia, &found.gains);
    let force = ColumnUnit::new(kinds, JointKind::force_unit);
    let [torque, residual] = ["Torque, rms", "Residual, rms"].map(|name| force.head(name));
    let residual_head = [
        "Joint",
        "Samples (independent)",
        &torque,
        &residual,
        "Residual / torque",
        "Samples beyond three deviations",
    ];
    let row = |i: usize| residual_row(joints[i], &fit.joints[i], &|x| force.cell(i, x));
    let residuals: Vec<Vec<String>> = (0..fit.joints.len()).map(row).collect();
    let parameter_head =
        ["Combination (SI units)", "Value", "Least squares", "Standard error", "Description"];
    let parameters: Vec<Vec<String>> = fit.parameters.iter().map(parameter_row).collect();
    Ok(html! {
        (tables::facts(&inertia_facts(fit, gains)))
        (table("Fit of the torque on the exciting motions", &residual_head, &residuals))
        p {
            "Dots with two standard errors on either side: how far least squares is from the \
             description. Red: the description lies beyond."
        }
        (error_bars(fit)?)
        (table("Identifiable combinations of parameters", &parameter_head, &parameters))
    })
}

fn residual_row(name: &str, joint: &JointFit, force: &dyn Fn(String) -> String) -> Vec<String> {
    vec![
        name.to_string(),
        format!("{} ({:.0})", joint.rows, joint.independent),
        force(significant(joint.torque, 4)),
        force(significant(joint.residual, 3)),
        percent(joint.relative()),
        percent(joint.outliers),
    ]
}

fn parameter_row(parameter: &BaseParameter) -> Vec<String> {
    let error = if parameter.standard_error.is_finite() {
        significant(parameter.standard_error, 2)
    } else {
        "not identifiable".into()
    };
    vec![
        parameter.name.clone(),
        significant(parameter.value, 4),
        significant(parameter.least_squares, 4),
        error,
        significant(parameter.described, 4),
    ]
}

/// Returns the facts about the fit as a whole, as names and values.
fn inertia_facts(fit: &InertiaFit, gains: &[Gain]) -> Vec<(String, String)> {
    let condition = significant(fit.condition, 4);
    let mut facts = vec![("Condition number of the base regressor".to_string(), condition)];
    if let Some(physical) = &fit.physical {
        let plain = physical.plain_impossible.clone();
        let plain = plain.unwrap_or_else(|| "its mass matrix is positive definite".into());
        facts.push(("Plain least squares".into(), plain));
        let cost = format!("{} standard deviations squared", significant(physical.cost, 3));
        facts.push(("Increase of the sum of squares for physically consistent links".into(), cost));
    }
    let gain = |g: &Gain| format!("{} {:.3} ± {:.3}", g.joint, g.gain, g.standard_error);
    let gains: Vec<String> = gains.iter().map(gain).collect();
    facts.push(("Torque gains with the best agreement of the joints".into(), gains.join(", ")));
    facts
}
