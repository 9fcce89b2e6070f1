//! The numbers of a suite for the page's script, which draws the interactive figures.

use super::decimate::Point;
use super::packed::{self, Packed};
use super::panel::relative;
use super::suite_figure::{Band, Nominal, RunTrace, SuiteFigure, TightSpot, View};
use reachtube_conform::data::Side;
use serde::Serialize;

/// Number of columns of a band where not all runs are drawn; a panel has about twice the pixels.
const COLUMNS: usize = 80;

/// The numbers of a suite.
#[derive(Serialize)]
struct SuiteData<'a> {
    suite: &'a str,
    joints: &'a [String],
    /// Units of the states.
    units: Vec<&'static str>,
    views: Vec<String>,
    /// Times of the bands and of the nominal motion.
    times: String,
    /// Empty if bands and runs are deviations already.
    nominal: Option<Vec<Packed>>,
    /// The bands as deviations from the unpacked nominal motion, the outer one first.
    bands: Vec<BandData<'a>>,
    /// Whether each bound holds from its time to the next one; else at its time.
    columns: bool,
    /// The sample times of the runs, where they are not `times`.
    run_times: Option<String>,
    runs: Vec<RunData<'a>>,
    tight: Vec<SpotData>,
    /// Largest rounding of a position and of a velocity.
    rounding: [f64; 2],
}

#[derive(Serialize)]
struct BandData<'a> {
    label: &'a str,
    lower: Vec<String>,
    upper: Vec<String>,
}

#[derive(Serialize)]
struct RunData<'a> {
    name: &'a str,
    order: usize,
    temperature: Option<f64>,
    gauge: Option<f64>,
    touches: usize,
    /// Empty if they are the first sample times of the suite.
    times: Option<String>,
    states: Vec<Packed>,
}

#[derive(Serialize)]
struct SpotData {
    run: usize,
    time: f64,
    state: usize,
    upper: bool,
    margin: f64,
}

/// Returns the numbers of a suite as JSON that can stand in a script element.
///
/// Times are exact to a nanosecond and samples rounded to 16-bit differences. Bands are single
/// precision and rounded outward. Where not all runs are drawn, bands are the lowest and highest
/// bound of each of 80 columns of time, and only deviations are given.
pub(super) fn suite_json(figure: &SuiteFigure) -> String {
    let data = if figure.undrawn > 0 { condensed(figure) } else { whole(figure) };
    let json = serde_json::to_string(&data).expect("the keys are strings and the numbers finite");
    in_script(&json)
}

/// Escapes what would end a script element; in JSON it occurs in strings only.
pub(super) fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// Returns every sample.
fn whole<'a>(figure: &'a SuiteFigure) -> SuiteData<'a> {
    let states = 2 * figure.joints.len();
    let nominal: Option<Vec<Packed>> = match &figure.nominal {
        Nominal::Shared(rows) => Some(rows.iter().map(|row| Packed::new(row)).collect()),
        _ => None,
    };
    // Bands are relative to the nominal motion as the script will have it.
    let origin = match &nominal {
        Some(rows) => rows.iter().map(Packed::unpacked).collect(),
        None => vec![vec![0.0; figure.times.len()]; states],
    };
    let edges = |band: &Band| {
        let edge = |rows: &[Vec<f64>], outward: fn(f64) -> f64| -> Vec<Vec<f64>> {
            let deviation = |(x, origin): (&f64, &f64)| outward(x - origin);
            let row = |(row, origin): (&Vec<f64>, &Vec<f64>)| {
                row.iter().zip(origin).map(deviation).collect()
            };
            rows.iter().zip(&origin).map(row).collect()
        };
        [edge(&band.lower, f64::next_down), edge(&band.upper, f64::next_up)]
    };
    let of_run = |run: &'a RunTrace| {
        let own = (!run.has_times(&figure.times)).then_some(&run.times[..]);
        run_data(run, own, &run.states)
    };
    let runs = figure.runs.iter().map(of_run).collect();
    data(figure, packed::times(&figure.times), nominal, &edges, runs)
}

/// Returns the deviations of the runs, and of the bands one lower and one upper bound per column.
fn condensed(figure: &SuiteFigure) -> SuiteData<'_> {
    let nominal = match &figure.nominal {
        Nominal::Shared(rows) => Some(rows),
        _ => None,
    };
    let count = figure.times.len();
    let starts: Vec<usize> = (0..=COLUMNS).map(|column| column * (count - 1) / COLUMNS).collect();
    let edges = |band: &Band| {
        let edge = |rows: &[Vec<f64>], outward: fn(f64) -> f64, further: fn(f64, f64) -> f64| {
            let row = |(state, row): (usize, &Vec<f64>)| -> Vec<f64> {
                let at = |k: usize| outward(row[k] - nominal.map_or(0.0, |rows| rows[state][k]));
                let column = |ends: &[usize]| (ends[0]..=ends[1]).map(at).reduce(further);
                let columns = starts.windows(2).filter_map(column);
                columns.chain([at(count - 1)]).collect()
            };
            rows.iter().enumerate().map(row).collect::<Vec<_>>()
        };
        [edge(&band.lower, f64::next_down, f64::min), edge(&band.upper, f64::next_up, f64::max)]
    };
    let of_run = |run: &RunTrace| {
        let line = |(state, row): (usize, &Vec<f64>)| {
            let nominal = nominal.map(|rows| rows[state].as_slice());
            relative(&run.times, row, &figure.times, nominal)
        };
        let lines: Vec<Vec<Point>> = run.states.iter().enumerate().map(line).collect();
        let times = lines.first().map_or_else(Vec::new, |line| line.iter().map(|p| p.0).collect());
        let states = lines.iter().map(|line| line.iter().map(|point| point.1).collect()).collect();
        (times, states)
    };
    let runs = figure.runs.iter().map(|run| {
        let (times, states): (Vec<f64>, Vec<Vec<f64>>) = of_run(run);
        run_data(run, (!run.has_times(&figure.times)).then_some(&times), &states)
    });
    let runs = runs.collect();
    let times: Vec<f64> = starts.iter().map(|&k| figure.times[k]).collect();
    let mut data = data(figure, packed::times(&times), None, &edges, runs);
    data.views = vec![view_name(View::Deviation)];
    data.columns = true;
    data.run_times = (!figure.runs.is_empty()).then(|| packed::times(&figure.times));
    data
}

fn data<'a>(
    figure: &'a SuiteFigure,
    times: String,
    nominal: Option<Vec<Packed>>,
    edges: &dyn Fn(&Band) -> [Vec<Vec<f64>>; 2],
    runs: Vec<RunData<'a>>,
) -> SuiteData<'a> {
    let n = figure.joints.len();
    let band = |band: &'a Band| {
        let [lower, upper] = edges(band);
        BandData {
            label: if band.label.is_empty() { "reachable set" } else { &band.label },
            lower: lower.iter().map(|row| packed::lower(row.iter().copied())).collect(),
            upper: upper.iter().map(|row| packed::upper(row.iter().copied())).collect(),
        }
    };
    let all = || runs.iter().map(|run| &run.states).chain(nominal.as_ref());
    let rounding = |states: std::ops::Range<usize>| {
        let steps = all().flat_map(|rows| &rows[states.clone()]).map(Packed::step);
        0.5 * steps.fold(0.0, f64::max)
    };
    SuiteData {
        suite: &figure.suite,
        joints: &figure.joints,
        units: (0..2 * n).map(|state| figure.state_unit(state)).collect(),
        views: figure.views().iter().map(|view| view_name(*view)).collect(),
        times,
        rounding: [rounding(0..n), rounding(n..2 * n)],
        bands: [Some(&figure.band), figure.inner.as_ref()]
            .into_iter()
            .flatten()
            .map(band)
            .collect(),
        nominal,
        columns: false,
        run_times: None,
        runs,
        tight: figure.tight.iter().map(spot).collect(),
    }
}

fn run_data<'a>(run: &'a RunTrace, times: Option<&[f64]>, states: &[Vec<f64>]) -> RunData<'a> {
    RunData {
        name: &run.name,
        order: run.order,
        temperature: run.temperature,
        gauge: run.gauge,
        touches: run.touches,
        times: times.map(packed::times),
        states: states.iter().map(|row| Packed::new(row)).collect(),
    }
}

fn spot(spot: &TightSpot) -> SpotData {
    let TightSpot { run, time_s, state, side, margin } = *spot;
    SpotData { run, time: time_s, state, upper: side == Side::Upper, margin }
}

/// Returns the name by which the page's buttons choose a view.
pub(super) fn view_name(view: View) -> String {
    format!("{view:?}").to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;
    use serde_json::Value;

    fn singles(text: &Value) -> Vec<f64> {
        let bytes = STANDARD.decode(text.as_str().unwrap()).unwrap();
        let single = |four: &[u8]| f32::from_le_bytes(four.try_into().unwrap()).into();
        bytes.chunks_exact(4).map(single).collect()
    }

    #[test]
    fn the_band_of_the_script_encloses_that_of_the_figure() {
        let figure = sample::suite("S", 2);
        let data: Value = serde_json::from_str(&suite_json(&figure)).unwrap();
        let nominal = whole(&figure).nominal.unwrap();
        for state in 0..4 {
            let (low, high) = (&data["bands"][0]["lower"], &data["bands"][0]["upper"]);
            let (low, high) = (singles(&low[state]), singles(&high[state]));
            for (k, nominal) in nominal[state].unpacked().iter().enumerate() {
                // The sums are exact enough to tell bounds from those rounded inward.
                assert!(low[k] <= figure.band.lower[state][k] - nominal + 1e-16);
                assert!(high[k] >= figure.band.upper[state][k] - nominal - 1e-16);
                assert!(high[k] - figure.band.upper[state][k] + nominal < 1e-7);
            }
        }
    }

    #[test]
    fn a_column_encloses_the_deviations_over_its_time() {
        let mut figure = sample::suite("S", 1);
        figure.undrawn = 5;
        figure.band.upper[0][101] = 9.0;
        let data: Value = serde_json::from_str(&suite_json(&figure)).unwrap();
        let Nominal::Shared(nominal) = &figure.nominal else { panic!("the sample has one") };
        let high = singles(&data["bands"][0]["upper"][0]);
        assert_eq!(high.len(), COLUMNS + 1);
        let peak = 101 * COLUMNS / (figure.times.len() - 1);
        assert!(high[peak] >= 9.0 - nominal[0][101] && high[peak] < 9.0 - nominal[0][101] + 1e-6);
        assert!(high[peak + 2] < 1.0);
        assert_eq!(data["views"], serde_json::json!(["deviation"]));
        assert_eq!(data["runs"].as_array().unwrap().len(), 3);
    }

    #[test]
    fn names_cannot_end_the_script_element() {
        let json = suite_json(&sample::suite("</script><b>", 1));
        assert!(!json.contains('<') && json.contains("\\u003c/script"));
        let data: Value = serde_json::from_str(&json).unwrap();
        assert_eq!(data["suite"], "</script><b>");
    }
}
