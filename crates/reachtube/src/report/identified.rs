//! The page of an identified robot: how good it is first, then the fits, the residuals, and every
//! parameter.

use super::chart::{Chart, Series, chart_svg};
use super::html::{section, titled_list, top};
use super::number::short;
use super::text::escape;
use super::{ReportError, tables};
use reachtube_identify::friction::FrictionFit;
use reachtube_identify::{Identification, JointFit, TorqueTrace};
use reachtube_robot::friction::{Coulomb, Viscous};
use std::io::Write;

/// Logs whose torque is drawn.
const MOST_LOGS: usize = 4;

const RECORDED: [u8; 3] = [120, 128, 138];
const PREDICTED: [u8; 3] = [18, 70, 200];
const FITTED: [u8; 3] = [255, 170, 60];
const LEFT_OVER: [u8; 3] = [222, 30, 30];

/// Writes the page of an identification as one HTML file that needs nothing else.
///
/// # Errors
///
/// Numbers that cannot be drawn, and failures of `out`.
pub fn write_identified_html(
    found: &Identification,
    out: &mut impl Write,
) -> Result<(), ReportError> {
    let subtitle = "Gravity, friction and inertia from its recordings";
    out.write_all(top(&format!("{}: identified", found.description.name), subtitle).as_bytes())?;
    out.write_all(prediction(found)?.as_bytes())?;
    out.write_all(section("Simulated motion", &windows(found)).as_bytes())?;
    if !found.friction.is_empty() {
        out.write_all(section("Friction", &friction(found)?).as_bytes())?;
    }
    out.write_all(section("Inertial parameters", &inertia(found)).as_bytes())?;
    let words = titled_list("How recordings were changed", "yes", &found.changes)
        + &titled_list("What looks wrong, or could not be done", "no", &found.warnings);
    out.write_all(
        section("Recordings", &format!("<div class=\"pair\">\n{words}</div>\n")).as_bytes(),
    )?;
    out.write_all(b"</main>\n</body>\n</html>\n")?;
    Ok(())
}

/// A table with a head; the first cell of a row names it.
fn table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let heads: String =
        head.iter().map(|name| format!("<th scope=\"col\">{}</th>", escape(name))).collect();
    let row = |cells: &Vec<String>| {
        let rest: String =
            cells[1..].iter().map(|cell| format!("<td>{}</td>", escape(cell))).collect();
        format!("<tr><th scope=\"row\">{}</th>{rest}</tr>\n", escape(&cells[0]))
    };
    format!(
        "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table class=\"sets\">\n<caption>{0}</caption>\n\
         <thead><tr>{heads}</tr></thead>\n<tbody>\n{1}</tbody></table></div>\n",
        escape(caption),
        rows.iter().map(row).collect::<String>()
    )
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}

fn names(found: &Identification) -> Vec<String> {
    found.description.joints.iter().map(|joint| joint.name.clone()).collect()
}

fn figures(charts: &[Chart]) -> Result<String, ReportError> {
    let svgs: String = charts.iter().map(chart_svg).collect::<Result<_, _>>()?;
    Ok(format!("<div class=\"charts\">\n{svgs}</div>\n"))
}

fn prediction(found: &Identification) -> Result<String, ReportError> {
    let which = if found.kept_back {
        "kept back from the fits"
    } else {
        "that it was fitted to: none was kept back"
    };
    let rows: Vec<Vec<String>> = found
        .validation
        .iter()
        .map(|log| {
            let cell = |e: &reachtube_identify::JointError| {
                format!(
                    "{} ({}), R² {:.4}, {} N m",
                    percent(e.relative),
                    percent(e.relative_all),
                    e.r2,
                    short(e.residual, 3)
                )
            };
            std::iter::once(log.log.clone()).chain(log.joints.iter().map(cell)).collect()
        })
        .collect();
    let joints = names(found);
    let head: Vec<&str> =
        std::iter::once("Recording").chain(joints.iter().map(String::as_str)).collect();
    let caption = "Part of the torque that is not predicted where a joint moves (standstill included), and its root mean square";
    let mut body = format!("<p>On recordings {which}.</p>\n{}", table(caption, &head, &rows));
    body += "<p>Grey: recorded. Blue: predicted from the motion. Red: what is left. Where a joint stands still its friction has no value, and nothing is predicted.</p>\n";
    for trace in found.traces.iter().take(MOST_LOGS) {
        let charts: Vec<Chart> =
            (0..joints.len()).map(|joint| torque_chart(trace, joint, &joints[joint])).collect();
        body += &format!("<h3>{}</h3>\n{}", escape(&trace.log), figures(&charts)?);
    }
    Ok(section("Predicted torque", &body))
}

/// Recorded torque throughout, predicted and left only where the joint moves: at rest friction has
/// no value.
fn torque_chart(trace: &TorqueTrace, joint: usize, name: &str) -> Chart {
    let (recorded, predicted, moves) =
        (&trace.recorded[joint], &trace.predicted[joint], &trace.moves[joint]);
    let mut series = vec![Series {
        points: trace.times.iter().copied().zip(recorded.iter().copied()).collect(),
        dots: false,
        colour: RECORDED,
    }];
    let samples: Vec<usize> = (0..moves.len()).collect();
    for stretch in
        samples.chunk_by(|a, b| moves[*a] == moves[*b]).filter(|stretch| moves[stretch[0]])
    {
        let line = |value: &dyn Fn(usize) -> f64, colour| Series {
            points: stretch.iter().map(|k| (trace.times[*k], value(*k))).collect(),
            dots: false,
            colour,
        };
        series.push(line(&|k| predicted[k], PREDICTED));
        series.push(line(&|k| recorded[k] - predicted[k], LEFT_OVER));
    }
    Chart { title: name.into(), x: "time [s]".into(), y: "torque [N m]".into(), series }
}

fn windows(found: &Identification) -> String {
    let rows: Vec<Vec<String>> = found
        .windows
        .iter()
        .map(|w| {
            let cell = |j: usize| {
                format!(
                    "{} rad of {}, {} rad/s",
                    short(w.q[j], 3),
                    short(w.motion[j], 3),
                    short(w.qd[j], 3)
                )
            };
            let head = format!("{} s ({} windows, {} diverged)", w.duration, w.windows, w.diverged);
            std::iter::once(head).chain((0..w.q.len()).map(cell)).collect()
        })
        .collect();
    let joints = names(found);
    let head: Vec<&str> =
        std::iter::once("Window").chain(joints.iter().map(String::as_str)).collect();
    table(
        "Root mean square errors of position, of how far the joint moves, and of velocity at the end of windows driven by the recorded torque",
        &head,
        &rows,
    )
}

fn friction(found: &Identification) -> Result<String, ReportError> {
    let list = |values: &[f64], errors: &[f64]| {
        values
            .iter()
            .zip(errors)
            .map(|(v, e)| format!("{} ± {}", short(*v, 3), short(*e, 1)))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let rows: Vec<Vec<String>> = found
        .friction
        .iter()
        .map(|fit| {
            let (joint, c, e) = (&fit.joint, fit.joint.coefficients, fit.joint.standard_errors);
            vec![
                joint.joint.clone(),
                format!("{:.5}", joint.r2),
                short(joint.residual, 3),
                list(&c.coulomb, &e.coulomb),
                list(&c.viscous, &e.viscous),
            ]
        })
        .collect();
    let head = ["Joint", "R²", "Residual [N m]", "a1 to a8", "v1, v2, v3"];
    let charts: Vec<Chart> =
        found.friction.iter().flat_map(|fit| [load_chart(fit), viscous_chart(fit)]).collect();
    Ok(table(
        "Coulomb friction (6) to (9) and viscous friction (5), with standard errors",
        &head,
        &rows,
    ) + "<p>Blue: recorded torque less gravity, the joint's inertia and the other part of friction. Orange: the fit.</p>\n"
        + &figures(&charts)?)
}

/// Fig. 5, up: torque less viscous friction and inertia over the load.
fn load_chart(fit: &FrictionFit) -> Chart {
    let coulomb = Coulomb::from_coefficients(fit.joint.coefficients.coulomb);
    let of = |residual: f64| {
        move |k: usize| {
            let s = &fit.samples[k];
            (s.load, coulomb.torque(s.load, s.qd) + residual * fit.residuals[k])
        }
    };
    chart_of(fit, "Coulomb", "load torque [N m]", of(1.0), of(0.0))
}

/// Fig. 5, down: torque less Coulomb friction and inertia over the velocity.
fn viscous_chart(fit: &FrictionFit) -> Chart {
    let [v1, v2, v3] = fit.joint.coefficients.viscous;
    let viscous = Viscous { v1, v2, v3 };
    let of = |residual: f64| {
        move |k: usize| {
            let s = &fit.samples[k];
            (s.qd, viscous.torque(&s.qd) + residual * fit.residuals[k])
        }
    };
    chart_of(fit, "viscous", "velocity [rad/s]", of(1.0), of(0.0))
}

fn chart_of(
    fit: &FrictionFit,
    what: &str,
    x: &str,
    measured: impl Fn(usize) -> (f64, f64),
    fitted: impl Fn(usize) -> (f64, f64),
) -> Chart {
    let all = || 0..fit.samples.len();
    Chart {
        title: format!("{}, {what}", fit.joint.joint),
        x: x.into(),
        y: "friction [N m]".into(),
        series: vec![
            Series { points: all().map(fitted).collect(), dots: true, colour: FITTED },
            Series { points: all().map(measured).collect(), dots: true, colour: PREDICTED },
        ],
    }
}

fn inertia(found: &Identification) -> String {
    let fit = &found.inertia;
    let joints = names(found);
    let residual = |(name, joint): (&String, &JointFit)| {
        vec![
            name.clone(),
            format!("{} ({:.0})", joint.rows, joint.independent),
            short(joint.torque, 4),
            short(joint.residual, 3),
            percent(joint.relative()),
            percent(joint.outliers),
        ]
    };
    let residuals: Vec<Vec<String>> = joints.iter().zip(&fit.joints).map(residual).collect();
    let head = [
        "Joint",
        "Samples (independent)",
        "Torque [N m]",
        "Residual [N m]",
        "Part",
        "Beyond three deviations",
    ];
    let parameter = |p: &reachtube_identify::BaseParameter| {
        let error = if p.standard_error.is_finite() {
            short(p.standard_error, 2)
        } else {
            "not shown".into()
        };
        vec![
            p.name.clone(),
            short(p.value, 4),
            short(p.least_squares, 4),
            error,
            short(p.described, 4),
        ]
    };
    let parameters: Vec<Vec<String>> = fit.parameters.iter().map(parameter).collect();
    let columns =
        ["Combination (SI units)", "Value", "Least squares", "Standard error", "Described"];
    let mut facts = vec![("Condition of the base regressor".to_string(), short(fit.condition, 4))];
    if let Some(physical) = &fit.physical {
        let plain = physical
            .plain_impossible
            .clone()
            .unwrap_or_else(|| "its mass matrix is positive definite".into());
        facts.push(("Plain least squares".into(), plain));
        let cost = format!("{} standard deviations squared", short(physical.cost, 3));
        facts.push(("What links that can exist cost".into(), cost));
    }
    facts.push(("Gains by which the torques would agree best".into(), gains(found)));
    tables::facts(&facts)
        + &table("Torque of the exciting motions", &head, &residuals)
        + &table("The combinations that torque shows", &columns, &parameters)
}

fn gains(found: &Identification) -> String {
    let gain = |g: &reachtube_identify::Gain| {
        format!("{} {:.3} ± {:.3}", g.joint, g.gain, g.standard_error)
    };
    found.gains.iter().map(gain).collect::<Vec<_>>().join(", ")
}
