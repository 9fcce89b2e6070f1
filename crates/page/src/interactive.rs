//! The numbers of a suite for the page's script, which draws the interactive figures.

use super::packed::{self, Packed};
use super::suite_figure::{Band, Nominal, RunTrace, SuiteFigure, TightSpot};
use reachtube_conform::data::Side;
use serde::Serialize;

/// Number of columns of a band where not all runs are drawn; a panel has about twice the pixels.
const COLUMNS: usize = 80;

/// The numbers of a suite.
#[derive(Serialize)]
struct SuiteData<'a> {
    suite: &'a str,
    joints: &'a [String],
    /// Headings of the joints.
    headings: Vec<String>,
    /// Labels of the vertical axes of the states, and units.
    axes: Vec<String>,
    units: Vec<&'static str>,
    views: Vec<&'static str>,
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
    let json = |data: &SuiteData| {
        serde_json::to_string(data).expect("the keys are strings and the numbers finite")
    };
    in_script(&if figure.undrawn == 0 {
        json(&data(figure, &figure.times))
    } else {
        let times = (!figure.runs.is_empty()).then(|| packed::times(&figure.times));
        let columns = columns(figure);
        json(&SuiteData { columns: true, run_times: times, ..data(&columns, &figure.times) })
    })
}

/// Escapes what would end a script element; in JSON it occurs in strings only.
pub(super) fn in_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

/// Returns the numbers of a figure. Runs without times of their own have the first of `shared`.
fn data<'a>(figure: &'a SuiteFigure, shared: &[f64]) -> SuiteData<'a> {
    let n = figure.joints.len();
    let nominal: Option<Vec<Packed>> = match &figure.nominal {
        Nominal::Shared(rows) => Some(rows.iter().map(|row| Packed::new(row)).collect()),
        _ => None,
    };
    // Bands are relative to the nominal motion as the script will have it.
    let origin = match &nominal {
        Some(rows) => rows.iter().map(Packed::unpacked).collect(),
        None => vec![vec![0.0; figure.times.len()]; 2 * n],
    };
    let edge = |rows: &[Vec<f64>], packed: fn(Vec<f64>) -> String| -> Vec<String> {
        let row = |(row, origin): (&Vec<f64>, &Vec<f64>)| {
            packed(row.iter().zip(origin).map(|(x, origin)| x - origin).collect())
        };
        rows.iter().zip(&origin).map(row).collect()
    };
    let band = |band: &'a Band| BandData {
        label: band.label(),
        lower: edge(&band.lower, |row| packed::lower(row.into_iter().map(f64::next_down))),
        upper: edge(&band.upper, |row| packed::upper(row.into_iter().map(f64::next_up))),
    };
    let runs: Vec<RunData> = figure.runs.iter().map(|run| run_data(run, shared)).collect();
    let all = || runs.iter().map(|run| &run.states).chain(nominal.as_ref());
    let rounding = |states: std::ops::Range<usize>| {
        let steps = all().flat_map(|rows| &rows[states.clone()]).map(Packed::step);
        0.5 * steps.fold(0.0, f64::max)
    };
    SuiteData {
        suite: &figure.suite,
        joints: &figure.joints,
        headings: (0..n).map(|joint| figure.heading(joint)).collect(),
        axes: (0..2 * n).map(|state| figure.axis(state)).collect(),
        units: (0..2 * n).map(|state| figure.state_unit(state)).collect(),
        views: figure.views().iter().map(|view| view.name()).collect(),
        times: packed::times(&figure.times),
        rounding: [rounding(0..n), rounding(n..2 * n)],
        bands: figure.bands().map(band).collect(),
        nominal,
        columns: false,
        run_times: None,
        runs,
        tight: figure.tight.iter().map(spot).collect(),
    }
}

/// Returns the deviations, with the bands as their lowest and highest bound in each column of time.
fn columns(figure: &SuiteFigure) -> SuiteFigure {
    let deviations = figure.deviations();
    let last = figure.times.len() - 1;
    let starts: Vec<usize> = (0..=COLUMNS).map(|column| column * last / COLUMNS).collect();
    let edge = |rows: &[Vec<f64>], further: fn(f64, f64) -> f64| -> Vec<Vec<f64>> {
        let row = |row: &Vec<f64>| {
            let column = |ends: &[usize]| row[ends[0]..=ends[1]].iter().copied().reduce(further);
            starts.windows(2).filter_map(column).chain([row[last]]).collect()
        };
        rows.iter().map(row).collect()
    };
    let band = |Band { label, lower, upper }: &Band| Band {
        label: label.clone(),
        lower: edge(lower, f64::min),
        upper: edge(upper, f64::max),
    };
    SuiteFigure {
        times: starts.iter().map(|&k| figure.times[k]).collect(),
        band: band(&deviations.band),
        inner: deviations.inner.as_ref().map(band),
        ..deviations
    }
}

fn run_data<'a>(run: &'a RunTrace, shared: &[f64]) -> RunData<'a> {
    RunData {
        name: &run.name,
        order: run.order,
        temperature: run.temperature,
        gauge: run.gauge,
        touches: run.touches,
        times: (!run.has_times(shared)).then(|| packed::times(&run.times)),
        states: run.states.iter().map(|row| Packed::new(row)).collect(),
    }
}

fn spot(spot: &TightSpot) -> SpotData {
    let TightSpot { run, time_s, state, side, margin } = *spot;
    SpotData { run, time: time_s, state, upper: side == Side::Upper, margin }
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
        let nominal = super::data(&figure, &figure.times).nominal.unwrap();
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
