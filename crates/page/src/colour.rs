//! The colours of the runs, as in Fig. 4: from blue for the first or coldest run to red for the
//! last or hottest.

use super::suite_figure::RunTrace;
use super::svg::Colour;

/// Red, green and blue of the scale's colours, all darker than the bands: blue, indigo, violet,
/// magenta, red.
pub(super) const ANCHORS: [[f64; 3]; 5] = [
    [18.0, 70.0, 200.0],
    [84.0, 72.0, 214.0],
    [146.0, 58.0, 190.0],
    [204.0, 40.0, 120.0],
    [222.0, 30.0, 30.0],
];

pub(super) fn colour(heat: f64) -> Colour {
    let place = heat.clamp(0.0, 1.0) * (ANCHORS.len() - 1) as f64;
    let below = (place as usize).min(ANCHORS.len() - 2);
    let mix = |channel: usize| {
        let (from, to) = (ANCHORS[below][channel], ANCHORS[below + 1][channel]);
        (from + (to - from) * (place - below as f64)).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

/// The places of a suite's runs on the scale of colours.
pub(super) struct Heat {
    /// One value in 0..=1 per run.
    pub(super) values: Vec<f64>,
    /// Labels of the two ends of the scale.
    pub(super) ends: [String; 2],
}

/// Places runs by temperature where every run has one, else by the order of recording.
pub(super) fn heat(runs: &[RunTrace]) -> Heat {
    let temperatures: Option<Vec<f64>> = runs.iter().map(|run| run.temperature).collect();
    match temperatures {
        Some(degrees) if !degrees.is_empty() => {
            let (values, [cold, hot]) = relative(&degrees);
            Heat { values, ends: [format!("cold, {cold:.1} °C"), format!("{hot:.1} °C, hot")] }
        }
        _ => {
            let orders: Vec<f64> = runs.iter().map(|run| run.order as f64).collect();
            Heat { values: relative(&orders).0, ends: ["first run".into(), "last run".into()] }
        }
    }
}

/// Places runs by the temperature of one joint, from 0; `None` if a run has none.
pub(super) fn heat_of_joint(runs: &[RunTrace], joint: usize) -> Option<Vec<f64>> {
    let degrees: Option<Vec<f64>> =
        runs.iter().map(|run| run.temperatures.get(joint).copied()).collect();
    degrees.filter(|degrees| !degrees.is_empty()).map(|degrees| relative(&degrees).0)
}

/// Scales values to 0..=1, and returns their smallest and largest too.
fn relative(values: &[f64]) -> (Vec<f64>, [f64; 2]) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let span = if high > low { high - low } else { 1.0 };
    (values.iter().map(|value| (value - low) / span).collect(), [low, high])
}

#[cfg(test)]
mod tests {
    use super::super::svg::hex;
    use super::*;

    fn run(order: usize, temperature: Option<f64>) -> RunTrace {
        RunTrace { order, temperature, ..RunTrace::default() }
    }

    #[test]
    fn ends_are_blue_and_red() {
        assert_eq!(hex(colour(0.0)), "#1246C8");
        assert_eq!(hex(colour(1.0)), "#DE1E1E");
        assert_eq!(colour(7.0), colour(1.0));
    }

    #[test]
    fn runs_of_a_suite_of_a_hundred_differ() {
        let mut colours: Vec<String> = (0..100).map(|k| hex(colour(f64::from(k) / 99.0))).collect();
        colours.dedup();
        assert_eq!(colours.len(), 100);
    }

    #[test]
    fn each_joint_has_a_range_of_its_own() {
        let warm = |degrees: [f64; 2]| RunTrace { temperatures: degrees.into(), ..run(1, None) };
        let runs = [warm([20.0, 31.0]), warm([25.0, 30.0]), warm([30.0, 30.5])];
        assert_eq!(heat_of_joint(&runs, 0), Some(vec![0.0, 0.5, 1.0]));
        assert_eq!(heat_of_joint(&runs, 1), Some(vec![1.0, 0.0, 0.5]));
        assert_eq!(heat_of_joint(&[runs[0].clone(), run(2, None)], 0), None);
    }

    #[test]
    fn temperature_counts_only_where_every_run_has_one() {
        let all = heat(&[run(1, Some(40.0)), run(2, Some(30.0)), run(3, Some(35.0))]);
        assert_eq!(all.values, [1.0, 0.0, 0.5]);
        assert_eq!(all.ends[0], "cold, 30.0 °C");
        let some = heat(&[run(1, Some(40.0)), run(3, None)]);
        assert_eq!(some.values, [0.0, 1.0]);
        assert_eq!(some.ends[0], "first run");
    }
}
