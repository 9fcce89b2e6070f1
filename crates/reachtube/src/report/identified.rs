//! The page of an identified robot: its accuracy first, then the fits, the residuals, and every
//! parameter.

use super::chart::{Chart, chart_svg};
use super::error::ReportError;
use super::identified_charts::{load_chart, torque_chart, viscous_chart};
use super::skeleton::{document, pair_of_lists, section, wide_table};
use super::tables;
use super::text::Text;
use crate::number::significant;
use crate::units::ColumnUnit;
use maud::{Markup, PreEscaped, html};
use reachtube_identify::friction::FrictionFit;
use reachtube_identify::{
    BaseParameter, Gain, Identification, InertiaFit, JointError, JointFit, LogValidation,
    WindowErrors,
};
use reachtube_robot::JointKind;
use std::io::Write;

/// Largest number of logs whose torque is drawn.
const MOST_LOGS: usize = 4;

/// Writes the page of an identification as one HTML file that needs no other file.
///
/// # Errors
///
/// Fails for numbers that cannot be drawn, and where `out` fails.
pub fn write_identified_html(
    found: &Identification,
    out: &mut impl Write,
) -> Result<(), ReportError> {
    let kinds = &found.description.kinds()[..];
    let joints: Vec<&str> =
        found.description.joints.iter().map(|joint| joint.name.as_str()).collect();
    let body = html! {
        (section("Predicted torque", &prediction(found, &joints)?))
        (section("Simulated motion", &windows(&found.windows, &joints, kinds)))
        @if !found.friction.is_empty() {
            (section("Friction", &friction(found)?))
        }
        (section("Inertial parameters", &inertia(found, &joints, kinds)))
        (section("Recordings", &pair_of_lists([
            ("Preprocessing", "yes", &found.changes),
            ("Warnings", "no", &found.warnings),
        ])))
    };
    let title = format!("{}: identified", found.description.name);
    let subtitle = "Gravity, friction and inertia identified from recordings";
    out.write_all(document(&title, subtitle, &body, &Markup::default()).as_bytes())?;
    Ok(())
}

/// Returns a table with a head; the first cell of a row names it.
fn table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> Markup {
    let head = html! {
        @for name in head { th scope="col" { (Text(name)) } }
    };
    let rows = html! {
        @for cells in rows {
            tr {
                th scope="row" { (Text(&cells[0])) }
                @for cell in &cells[1..] { td { (Text(cell)) } }
            }
        }
    };
    wide_table("long", caption, &head, &rows)
}

/// Returns a table with one column per joint, after a first column under `corner`.
fn table_by_joint(caption: &str, corner: &str, joints: &[&str], rows: &[Vec<String>]) -> Markup {
    table(caption, &[&[corner], joints].concat(), rows)
}

fn charts(charts: &[Chart]) -> Result<Markup, ReportError> {
    let svgs: String = charts.iter().map(chart_svg).collect::<Result<_, _>>()?;
    Ok(html! { div.charts { (PreEscaped(svgs)) } })
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn prediction(found: &Identification, joints: &[&str]) -> Result<Markup, ReportError> {
    let which = if found.kept_back {
        "These recordings were kept back from the fits."
    } else {
        "No recording was kept back: the fits used these recordings too."
    };
    let caption = "Error of the predicted torque relative to the recorded torque where a joint \
                   moves (at standstill too), R², and root mean square error";
    let kinds = found.description.kinds();
    let row = |log: &LogValidation| validation_row(log, &kinds);
    let rows: Vec<Vec<String>> = found.validation.iter().map(row).collect();
    let mut logs = Vec::new();
    for trace in found.traces.iter().take(MOST_LOGS) {
        let of_joint =
            |(joint, name): (usize, &&str)| torque_chart(trace, joint, name, kinds[joint]);
        let of_log: Vec<Chart> = joints.iter().enumerate().map(of_joint).collect();
        logs.push((&trace.log, charts(&of_log)?));
    }
    Ok(html! {
        p { (which) }
        (table_by_joint(caption, "Recording", joints, &rows))
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

fn validation_row(log: &LogValidation, kinds: &[JointKind]) -> Vec<String> {
    let part = |part: Option<f64>| part.map_or("-".into(), percent);
    let cell = |(error, kind): (&JointError, &JointKind)| {
        let Some(relative) = error.relative else {
            return format!("at rest ({})", part(error.relative_all));
        };
        format!(
            "{} ({}), R²\u{a0}{}, {} {}",
            percent(relative),
            part(error.relative_all),
            error.r2.map_or("-".into(), |r2| format!("{r2:.4}")),
            significant(error.residual, 3),
            kind.force_unit()
        )
    };
    std::iter::once(log.log.clone()).chain(log.joints.iter().zip(kinds).map(cell)).collect()
}

fn windows(windows: &[WindowErrors], joints: &[&str], kinds: &[JointKind]) -> Markup {
    let caption = "Root mean squares over windows driven by the recorded torque: position error \
                   at the end, motion of the joint, and velocity error at the end";
    let rows: Vec<Vec<String>> = windows.iter().map(|row| window_row(row, kinds)).collect();
    table_by_joint(caption, "Window", joints, &rows)
}

fn window_row(row: &WindowErrors, kinds: &[JointKind]) -> Vec<String> {
    let cell = |joint: usize| {
        format!(
            "{} {} of {}, {} {}",
            significant(row.q[joint], 3),
            kinds[joint].position_unit(),
            significant(row.motion[joint], 3),
            significant(row.qd[joint], 3),
            kinds[joint].velocity_unit()
        )
    };
    let name = format!("{} s ({} windows, {} diverged)", row.duration, row.windows, row.diverged);
    std::iter::once(name).chain((0..row.q.len()).map(cell)).collect()
}

fn friction(found: &Identification) -> Result<Markup, ReportError> {
    let caption = "Coefficients of Coulomb friction, eqs. (6) to (9), and of viscous friction, \
                   eq. (5), with standard errors";
    let kinds: Vec<_> = found.friction.iter().map(|fit| kind_of(found, fit)).collect();
    let fits = || found.friction.iter().zip(&kinds);
    let force = ColumnUnit::new(&kinds, JointKind::force_unit);
    let residual = force.head("Residual");
    let head = ["Joint", "R²", &residual, "a1 to a8", "v1, v2, v3"];
    let row = |(i, fit): (usize, &FrictionFit)| friction_row(fit, i, &force);
    let rows: Vec<Vec<String>> = found.friction.iter().enumerate().map(row).collect();
    let all: Vec<Chart> = fits()
        .flat_map(|(fit, kind)| [load_chart(fit, *kind), viscous_chart(fit, *kind)])
        .collect();
    Ok(html! {
        (table(caption, &head, &rows))
        p {
            "Blue: recorded torque minus gravity, the joint's inertia and the other part of \
             friction. Orange: fitted friction."
        }
        (charts(&all)?)
    })
}

/// Returns the kind of the joint of a friction fit.
fn kind_of(found: &Identification, fit: &FrictionFit) -> JointKind {
    let own = found.description.joints.iter().find(|joint| joint.name == fit.joint.joint);
    own.map_or_else(JointKind::default, |joint| joint.kind)
}

fn friction_row(fit: &FrictionFit, i: usize, force: &ColumnUnit) -> Vec<String> {
    let list = |values: &[f64], errors: &[f64]| {
        let pairs = values.iter().zip(errors);
        let words = pairs.map(|(v, e)| format!("{} ± {}", significant(*v, 3), significant(*e, 1)));
        words.collect::<Vec<_>>().join(", ")
    };
    let (joint, c, e) = (&fit.joint, fit.joint.coefficients, fit.joint.standard_errors);
    vec![
        joint.joint.clone(),
        format!("{:.5}", joint.r2),
        force.cell(i, significant(joint.residual, 3)),
        list(&c.coulomb, &e.coulomb),
        list(&c.viscous, &e.viscous),
    ]
}

fn inertia(found: &Identification, joints: &[&str], kinds: &[JointKind]) -> Markup {
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
    html! {
        (tables::facts(&inertia_facts(fit, gains)))
        (table("Fit of the torque on the exciting motions", &residual_head, &residuals))
        (table("Identifiable combinations of parameters", &parameter_head, &parameters))
    }
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

/// Returns what is known of the fit as a whole, as names and values.
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
