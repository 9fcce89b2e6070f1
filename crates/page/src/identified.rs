//! The page of an identified robot: the robot, its accuracy, then the fits, the residuals, and
//! every parameter.

use super::chart::Chart;
use super::error::Error;
use super::html::warning_list;
use super::identified_arm::arm_svgs;
use super::identified_charts::{friction_charts, torque_charts};
use super::identified_parameters::parameter_svg;
use super::plot::{CHART, chart_svg, chart_svg_of_size};
use super::skeleton::{document, fact_table, section, table};
use super::terms::Explained;
use super::text::Text;
use maud::{Markup, PreEscaped, html};
use reachtube_finding::Table;
use reachtube_identify::{BaseParameter, FrictionFit, Identification, InertiaFit};
use reachtube_robot::{JointKind, Robot};
/// Largest number of logs whose torque is drawn.
const MOST_LOGS: usize = 4;

/// Height of the chart of a residual \[px\].
const RESIDUAL: f64 = 130.0;

/// Returns the page of an identification as one HTML file that needs no other file.
///
/// # Errors
///
/// Fails for numbers that cannot be drawn.
pub fn identified_html(found: &Identification) -> Result<String, Error> {
    let joints: Vec<&str> =
        found.description.joints.iter().map(|joint| joint.name.as_str()).collect();
    let report = found.report();
    let tables = |title: &str| {
        let own = report.sections.iter().find(|section| section.title == title);
        html! { @if let Some(own) = own { (fact_table(&own.facts)) (laid_out(&own.tables)) } }
    };
    let parts = [
        ("Predicted torque", prediction(found, &joints)?),
        ("Simulated motion", Markup::default()),
        ("Gravity", Markup::default()),
        ("Friction", friction(found)?),
        ("Inertial parameters", error_bars(&found.inertia)?),
    ];
    let body = html! {
        @if !found.warnings.is_empty() { (section("Warnings", &warning_list(&found.warnings))) }
        @if let Ok(robot) = Robot::from_description(&found.description) {
            (section("The robot", &arm(&robot)))
        }
        @for (title, charts) in &parts {
            (section(title, &html! { (tables(title)) (charts) }))
        }
        @if !found.changes.is_empty() {
            (section("Recordings", &html! {
                ul.yes { @for change in &found.changes { li { (Explained(change)) } } }
            }))
        }
    };
    let title = format!("{}: identified", found.description.name);
    let subtitle = "Gravity, friction and inertia identified from recordings";
    Ok(document(&title, subtitle, &body, &Markup::default()))
}

fn arm(robot: &Robot) -> Markup {
    html! {
        p { "At q = 0. Grey: links. Blue: joint axes." }
        div.charts { (PreEscaped(arm_svgs(robot))) }
    }
}

fn laid_out(tables: &[Table]) -> Markup {
    html! { @for one in tables { (table("long", one)) } }
}

/// Returns charts in stacks of one chart over another with a height \[px\].
fn stacks(stacks: &[[Chart; 2]], height: f64) -> Result<Markup, Error> {
    let stack = |[above, below]: &[Chart; 2]| {
        Ok(chart_svg(above)? + &chart_svg_of_size(below, [CHART[0], height])?)
    };
    let svgs: Vec<String> = stacks.iter().map(stack).collect::<Result<_, Error>>()?;
    Ok(html! {
        div.charts { @for svg in &svgs { div.stack { (PreEscaped(svg)) } } }
    })
}

fn prediction(found: &Identification, joints: &[&str]) -> Result<Markup, Error> {
    let kinds = found.description.kinds();
    let mut logs = Vec::new();
    for trace in found.traces.iter().take(MOST_LOGS) {
        let of_joint =
            |(joint, name): (usize, &&str)| torque_charts(trace, joint, name, kinds[joint]);
        let of_log: Vec<[Chart; 2]> = joints.iter().enumerate().map(of_joint).collect();
        logs.push((&trace.log, stacks(&of_log, RESIDUAL)?));
    }
    Ok(html! {
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

fn friction(found: &Identification) -> Result<Markup, Error> {
    let kind = |fit: &FrictionFit| {
        let own = found.description.joints.iter().find(|joint| joint.name == fit.joint.joint);
        own.map_or_else(JointKind::default, |joint| joint.kind)
    };
    let charts = |fit: &FrictionFit| friction_charts(fit, kind(fit));
    let all: Vec<[Chart; 2]> = found.friction.iter().map(charts).collect();
    let charts = stacks(&all, CHART[1])?;
    Ok(html! {
        @if !all.is_empty() {
            p {
                "Blue: recorded torque minus gravity, the joint's inertia and the other part of \
                 friction. Orange: fitted friction."
            }
            (charts)
        }
    })
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
    Ok(html! {
        p {
            "Dots with two standard errors on either side: how far least squares is from the \
             description. Red: the description lies beyond."
        }
        div.charts { (PreEscaped(svgs)) }
    })
}
