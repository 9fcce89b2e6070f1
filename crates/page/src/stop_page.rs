//! The page of stopping times and distances, which can be filed.

use maud::{Markup, PreEscaped, html};
use reachtube_conform::Model;
use reachtube_finding::{Finding, Table};
use reachtube_robot::{JointKind, Robot};
use reachtube_scalar::number::{at_least, significant};
use reachtube_verify::{AnnexRow, Brakes, StopStudy, annex_table, recorded_table};

use crate::chart::{Chart, Series};
use crate::error::Error;
use crate::html::warning_list;
use crate::plot::chart_svg;
use crate::skeleton::{document, fact_table, section, table, verdict};
use crate::svg::{BLUE, GREY, ORANGE};
use crate::terms::Explained;

/// The file name of the page.
pub const STOP_PAGE_FILE: &str = "stop.html";

/// Grey, blue and orange, for 33, 66 and 100 % of the extension.
const COLOURS: [[u8; 3]; 3] = [GREY, BLUE, ORANGE];

/// The parts of speed and extension in the table.
const SPEEDS: [f64; 3] = [0.33, 0.66, 1.0];

/// The contents of the page.
#[derive(Debug, Clone, Copy)]
pub struct StopPage<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// The model, whose U is the error of the drives' torque.
    pub model: &'a Model,
    /// The brakes.
    pub brakes: &'a Brakes,
    /// The stops.
    pub study: &'a StopStudy,
    /// Why the stops say less of the robot than of the model.
    pub warnings: &'a [Finding],
}

/// Returns the page as one HTML file that needs no other file and no script.
///
/// # Errors
///
/// Fails for numbers that cannot be drawn.
pub fn stop_html(page: &StopPage) -> Result<String, Error> {
    let study = page.study;
    let unit = JointKind::column(&page.robot.kinds(), JointKind::position_unit).any();
    let rows = study.annex_b.as_ref().map_or(&[][..], |table| &table.rows);
    let notes = study.annex_b.as_ref().map_or(&[][..], |table| &table.notes);
    let of = |category: u8| -> Vec<AnnexRow> {
        rows.iter().filter(|row| row.category == category).cloned().collect()
    };
    let class = match (study.outside(), study.is_proved() && page.warnings.is_empty()) {
        (Some(_), _) => "bad",
        (None, true) => "ok",
        (None, false) => "doubtful",
    };
    let warnings: Vec<String> = page.warnings.iter().map(|found| found.text.clone()).collect();
    let sentence = study.findings.first().map_or("", |verdict| &verdict.text);
    let body = html! {
        (verdict(class, sentence))
        @if !warnings.is_empty() { (section("Warnings", &warning_list(&warnings))) }
        (section("Category 0", &html! {
            p { "Drives off and brakes on at once, at full speed, extension and load. One joint \
                 moves when the stop begins; the three with the greatest distance are listed." }
            (table("sets", &annex_table(&of(0), &unit)))
            @for note in notes { p { (Explained(&note.text)) } }
        }))
        @if !of(1).is_empty() {
            (section("Category 1", &html! {
                p { "A controlled deceleration, then drives off and brakes on." }
                (charts(&of(1), &unit)?)
                (table("sets", &by_speed(&of(1), &unit)))
            }))
        }
        @if !study.recorded.is_empty() {
            (section("Recorded stops", &html! {
                p { "Measured, and proved from the first recorded state, for the three joints of \
                     each recording that move the most, and any other that is not within." }
                (table("sets", &recorded_table(&study.recorded, &unit)))
            }))
        }
        (section("Along the motions", &html! {
            p { "The worst stop of category " (study.category) " from the samples of each motion, \
                 from all states between the lowest and the highest recorded ones." }
            (table("sets", &study.motions(&unit)))
        }))
        (section("Basis", &basis(page)))
    };
    let title = format!("{}: stopping times and distances", page.robot.name());
    let subtitle = "Proved upper bounds, and measurements, if any; the layout of the table \
        follows ISO 10218-1, Annex B";
    Ok(document(&title, subtitle, &body, &Markup::default()))
}

/// Returns the rows of category 1; rows that differ only in speed share a line.
fn by_speed(rows: &[AnnexRow], unit: &str) -> Table {
    let head = |what: &str| SPEEDS.map(|part| format!("{what} at {:.0} %", 100.0 * part));
    let names = ["joint", "extension", "load"].map(String::from);
    let header = names.into_iter().chain(head(&format!("[{unit}]"))).chain(head("[s]"));
    let lines =
        rows.chunk_by(|a, b| (&a.joint, a.extension, a.load) == (&b.joint, b.extension, b.load));
    let line = |line: &[AnnexRow]| {
        let bound = |value: f64| if value.is_finite() { at_least(value) } else { "none".into() };
        let first = &line[0];
        let mut cells = vec![first.joint.clone()];
        cells.extend([first.extension, first.load].map(|part| format!("{:.0} %", 100.0 * part)));
        cells.extend(line.iter().map(|row| bound(row.way)));
        cells.extend(line.iter().map(|row| bound(row.time)));
        cells
    };
    Table::new(header, lines.map(line).collect())
        .titled("Proved stopping distances and times at 33, 66 and 100 % of the greatest speed")
}

/// Returns distances and times over speed, at the greatest load.
fn charts(rows: &[AnnexRow], unit: &str) -> Result<Markup, Error> {
    let mut joints: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| row.is_proved()) {
        if !joints.contains(&row.joint.as_str()) {
            joints.push(&row.joint);
        }
    }
    let load = rows.iter().map(|row| row.load).fold(0.0, f64::max);
    let chart = |joint: &str, y: String, value: fn(&AnnexRow) -> f64| {
        let of_extension = |(k, colour): (usize, [u8; 3])| {
            let extension = SPEEDS[k];
            let chosen = rows
                .iter()
                .filter(|row| row.joint == joint && row.load == load && row.extension == extension);
            let proved = chosen.filter(|row| row.is_proved());
            let points = proved.map(|row| (100.0 * row.speed, value(row))).collect();
            Series::line(points, colour)
        };
        let series = COLOURS.into_iter().enumerate().map(of_extension);
        // The axes begin at 0.
        let zero = Series::line(vec![(0.0, 0.0)], COLOURS[0]);
        Chart::new(joint, "speed [%]", y, series.chain([zero]).collect())
    };
    let distances =
        joints.iter().map(|joint| chart(joint, format!("distance [{unit}]"), |row| row.way));
    let times = joints.iter().map(|joint| chart(joint, "time [s]".into(), |row| row.time));
    let all: Vec<Chart> = distances.chain(times).collect();
    let svgs: Vec<String> = all.iter().map(chart_svg).collect::<Result<_, Error>>()?;
    Ok(html! {
        figure {
            div.charts { @for svg in &svgs { div.stack { (PreEscaped(svg)) } } }
            figcaption {
                "At " (format!("{:.0} %", 100.0 * load)) " of the load. Grey: 33 % of the \
                 extension, blue: 66 %, orange: 100 %."
            }
        }
    })
}

fn basis(page: &StopPage) -> Markup {
    let StopPage { robot, model, brakes, .. } = *page;
    let numbers =
        |values: &[f64]| values.iter().map(|x| significant(*x, 4)).collect::<Vec<_>>().join(", ");
    let ranges: Vec<String> = brakes
        .torque
        .iter()
        .map(|[low, high]| format!("{} to {}", significant(*low, 4), significant(*high, 4)))
        .collect();
    let [early, late] = brakes.delay;
    let mut facts: Vec<(&str, String)> = vec![
        ("Robot", robot.name().into()),
        ("Joints", robot.joints().iter().map(|j| j.name.clone()).collect::<Vec<_>>().join(", ")),
        ("Brake torque, N m", ranges.join(", ")),
        ("Brakes hold after", format!("{early} to {late} s")),
        ("Error of the equations, N m", numbers(&brakes.error)),
    ];
    if let Some(deceleration) = &brakes.deceleration {
        let set = &model.input_set;
        facts.push(("Deceleration, rad/s²", numbers(deceleration)));
        facts.push(("Error of the drives, centre, N m", numbers(&set.centre)));
        facts.push(("Error of the drives, radius, N m", numbers(&set.radius)));
    }
    if let Some(load) = brakes.payload {
        let centre = numbers(&load.centre);
        facts.push((
            "Load",
            format!("{} kg at {centre} m in the last link\u{2019}s frame", load.mass),
        ));
    }
    facts.push(("Model, SHA-256", model.sha256.clone()));
    facts.push(("Written by", reachtube_files::TOOL.into()));
    html! {
        p { "Bounds are proved with directed rounding for the robot\u{2019}s equations as loaded, \
             with friction and gravity, for all brake torques, delays and errors within the ranges \
             below. A robot outside these ranges may need longer. Measure them, and compare \
             recorded stops. Postures of greatest extension come from a search." }
        (fact_table(&facts))
    }
}
