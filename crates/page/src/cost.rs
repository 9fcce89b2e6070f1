//! What the cost of the sets comes from: joints, runs and motions.

use reachtube_arm::ArmModel;
use reachtube_conform::Model;
use reachtube_conform::next_motion::LeftOut;
use reachtube_conform::settings::Weights;

use crate::chart::{Chart, Series};
use crate::suite_figure::{Band, RunTrace, SuiteFigure};
use crate::svg::{BLUE, GREY};
use reachtube_finding::Table;
use reachtube_scalar::number::{at_least, four_decimals};

/// Number of runs and of motions that are listed.
const MOST_ROWS: usize = 20;

/// Returns the unit of the costs of a model, in brackets. They add positions and velocities, and
/// are integrals over time except in files of older versions.
pub(super) fn cost_unit(model: &Model) -> String {
    let unit = sum_unit(model);
    match model.cost_of_samples {
        Some(_) => format!("[s times {}]", unit.trim_matches(['[', ']'])),
        None => unit,
    }
}

pub(super) fn sum_unit(model: &Model) -> String {
    let kinds = model.arm().robot.kinds();
    let is_shared = kinds.iter().all(|kind| *kind == kinds[0]);
    match &model.settings.weights {
        Weights::Unit if is_shared && !kinds.is_empty() => {
            format!("[({} + {})]", kinds[0].position_unit(), kinds[0].velocity_unit())
        }
        Weights::Unit => "[SI units, added]".into(),
        Weights::Given(_) => "[weighted SI units, added]".into(),
    }
}

pub(super) fn cost_tables(model: &Model, figures: &[SuiteFigure]) -> Vec<Table> {
    let tables = [by_joint(model, figures), by_run(figures), by_motion(model)];
    tables.into_iter().filter(|table| !table.rows.is_empty()).collect()
}

/// Returns charts of the part of the set that each run uses, over its order and its temperature:
/// the runs at 1 decide the sets. There is none where nothing differs.
pub(super) fn cost_charts(figures: &[SuiteFigure]) -> Vec<Chart> {
    let runs = || figures.iter().flat_map(|figure| &figure.gauges);
    let over_order = runs().map(|run| (run.order as f64 + 1.0, run.gauge));
    let over_temperature = runs().filter_map(|run| Some((run.temperature?, run.gauge)));
    let chart = |title: &str, x: &str, points: Vec<(f64, f64)>| {
        let title = format!("Part of the set that each run uses, {title}");
        let series = vec![Series::line(edge(&points), GREY), Series::dots(points, BLUE)];
        Chart::new(title, x, "part of the radius", series)
    };
    let charts = [
        chart("by order", "run of its suite", over_order.collect()),
        chart("by temperature", "temperature [°C]", over_temperature.collect()),
    ];
    let differs = |chart: &Chart| {
        let points = &chart.series[1].points;
        points.iter().any(|point| point.0 != points[0].0)
    };
    charts.into_iter().filter(differs).collect()
}

fn edge(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let ends = points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| {
        [low.min(point.0), high.max(point.0)]
    });
    if points.is_empty() { Vec::new() } else { ends.map(|end| (end, 1.0)).to_vec() }
}

/// Returns the share of each state in the weighted widths of the bands over the drawn suites.
fn by_joint(model: &Model, figures: &[SuiteFigure]) -> Table {
    let n = model.inputs();
    let shares: Vec<f64> =
        (0..2 * n).map(|state| weight(model, state) * widths(model, figures, state)).collect();
    let all: f64 = shares.iter().sum();
    let percent = |share: f64| format!("{:.1} %", 100.0 * share / all);
    let row = |joint: usize| {
        let (q, qd) = (shares[joint], shares[n + joint]);
        vec![model.signals.parts[joint].name.clone(), percent(q), percent(qd), percent(q + qd)]
    };
    let rows = if all > 0.0 { (0..n).map(row).collect() } else { Vec::new() };
    Table::new(["Joint", "Position", "Velocity", "Both"], rows)
        .titled("Share of the cost per joint: weighted width of the set over the drawn suites")
}

fn weight(model: &Model, state: usize) -> f64 {
    match &model.settings.weights {
        Weights::Unit => 1.0,
        Weights::Given(weights) => weights[state],
    }
}

fn widths(model: &Model, figures: &[SuiteFigure], state: usize) -> f64 {
    let noise = model.noise_set.as_ref().map_or(0.0, |noise| {
        let [low, high] = <[f64; 2]>::from(noise.bounds(state));
        high - low
    });
    let width = |Band { lower, upper, .. }: &Band| -> f64 {
        lower[state].iter().zip(&upper[state]).map(|(low, high)| high - low + noise).sum()
    };
    figures.iter().map(|figure| width(&figure.band)).sum()
}

fn by_run(figures: &[SuiteFigure]) -> Table {
    let runs = figures.iter().flat_map(|figure| figure.runs.iter().map(move |run| (figure, run)));
    let mut runs: Vec<_> = runs.filter(|(_, run)| run.touches > 0).collect();
    runs.sort_by_key(|(_, run)| std::cmp::Reverse(run.touches));
    let degrees =
        |t: Option<f64>| t.map_or_else(|| "-".into(), |degrees| format!("{degrees:.1} °C"));
    let row = |(figure, run): &(&SuiteFigure, &RunTrace)| {
        vec![
            run.name.clone(),
            figure.suite.clone(),
            run.touches.to_string(),
            (run.order + 1).to_string(),
            degrees(run.temperature),
        ]
    };
    let rows = runs.iter().take(MOST_ROWS).map(row).collect();
    let mut table = Table::new(["Run", "Suite", "Rows", "Order", "Temperature"], rows)
        .titled("Runs that decide the most rows");
    if runs.iter().all(|(_, run)| run.temperature.is_none()) {
        table.header.truncate(4);
        table.rows.iter_mut().for_each(|row| row.truncate(4));
    }
    table
}

/// Returns by how much a value differs from a reference, in percent with its sign.
pub(super) fn change(value: f64, reference: f64) -> String {
    // The sum with 0 turns a negative zero into a positive one.
    let tenths = (1e3 * (value / reference - 1.0)).round() + 0.0;
    format!("{:+.1} %", tenths / 10.0)
}

/// Returns the cost of the smallest sets for all motions that the sets were found on, beside which
/// the costs without a motion stand; `None` if the model does not have it. Sets that were
/// calibrated or widened are not the smallest.
fn smallest_cost(model: &Model) -> Option<f64> {
    // Sets of a model that is not linear are linearised ones.
    let linearised = model.search.as_ref().and_then(|search| search.linearised_cost);
    let is_wider =
        model.calibration.is_some() || !model.allowance.is_empty() || !model.stiction.is_empty();
    let of_fit =
        model.fit.as_ref().map(|fit| if fit.taken { fit.cost } else { fit.identified_cost });
    linearised.or(if is_wider { of_fit } else { model.cost })
}

fn by_motion(model: &Model) -> Table {
    let is_linearised =
        model.search.as_ref().is_some_and(|search| search.linearised_cost.is_some());
    let mut table = without_each(&model.left_out, smallest_cost(model), &cost_unit(model));
    table.title = format!(
        "{} found without a motion, and the factor by which they must grow to hold it",
        if is_linearised { "Linearised sets" } else { "Sets" }
    );
    table
}

/// Returns the table of the sets without each motion; without a column of changes if `smallest`,
/// the cost of the smallest sets for all motions, is not known.
fn without_each(left_out: &[LeftOut], smallest: Option<f64>, unit: &str) -> Table {
    let mut motions: Vec<_> = left_out.iter().filter_map(|left| Some((left, left.cost?))).collect();
    motions.sort_by(|a, b| a.1.total_cmp(&b.1));
    // Only linear models have the factors of X0 and of U in turn.
    let in_turn = motions.iter().any(|(left, _)| left.initial_gauge.is_some());
    let factor = |of: Option<f64>| of.map_or_else(|| "none found".into(), at_least);
    let row = |(left, without): &(&LeftOut, f64)| {
        let mut row = vec![left.motion.clone(), four_decimals(*without)];
        row.extend(smallest.map(|smallest| change(*without, smallest)));
        row.push(factor(left.gauge));
        if in_turn {
            row.extend([left.initial_gauge, left.input_gauge, left.wider].map(factor));
        }
        row
    };
    let mut header = vec!["Without".into(), format!("Cost {unit}")];
    header.extend(smallest.map(|_| "Change".into()));
    header.push("Factor".into());
    if in_turn {
        header.extend(["X0 at start", "Then U", "Sets wider"].map(String::from));
    }
    let rows = motions.iter().take(MOST_ROWS).map(row).collect();
    Table { header, rows, ..Table::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use crate::suite_figure::RunGauge;

    #[test]
    fn every_run_is_a_dot_over_its_order_and_its_temperature() {
        let run = |order: usize, temperature: Option<f64>| RunGauge {
            order,
            temperature,
            gauge: 0.1 * order as f64,
        };
        let figure = SuiteFigure {
            gauges: vec![run(0, Some(20.0)), run(1, Some(25.0)), run(2, None)],
            ..sample::suite("S", 1)
        };
        let charts = cost_charts(&[figure.clone(), figure]);
        let dots: Vec<usize> = charts.iter().map(|chart| chart.series[1].points.len()).collect();
        assert_eq!(dots, [6, 4]);
        assert_eq!(charts[0].series[1].points[2], (3.0, 0.2));
        assert_eq!(charts[1].series[0].points, [(20.0, 1.0), (25.0, 1.0)]);
        let alone = SuiteFigure { gauges: vec![run(4, None)], ..sample::suite("S", 1) };
        assert!(cost_charts(&[alone]).is_empty());
    }

    #[test]
    fn costs_without_a_motion_are_compared_with_the_smallest_sets_or_not_at_all() {
        let left = |motion: &str, cost: f64| LeftOut {
            motion: motion.into(),
            cost: Some(cost),
            gauge: Some(1.5),
            ..LeftOut::default()
        };
        let left_out = [left("M1", 8.0), left("M2", 4.0)];
        let known = without_each(&left_out, Some(8.0), "[s]");
        assert_eq!(known.header, ["Without", "Cost [s]", "Change", "Factor"]);
        assert_eq!(known.rows[0], ["M2", "4.000", "-50.0 %", "1.500"]);
        assert_eq!(known.rows[1][2], "+0.0 %");
        let unknown = without_each(&left_out, None, "[s]");
        assert_eq!(unknown.header, ["Without", "Cost [s]", "Factor"]);
        assert_eq!(unknown.rows[1], ["M1", "8.000", "1.500"]);
    }

    #[test]
    fn a_change_that_rounds_to_zero_is_not_negative() {
        let changes = [0.99999, 1.0, 1.00001, 0.9994, 1.25].map(|value| change(value, 1.0));
        assert_eq!(changes, ["+0.0 %", "+0.0 %", "+0.0 %", "-0.1 %", "+25.0 %"]);
    }
}
