//! Assembly of the figures of the suites.

use reachtube_arm::ArmModel;
use reachtube_conform::data::Suite;
use reachtube_conform::settings::States;
use reachtube_conform::tube::Witness;
use reachtube_conform::{Problem, SuiteReach};

use crate::error::Error;
use crate::error::Result;
use crate::figures::MOST_STATIC;
use crate::sources::{Sources, joint_name};
use crate::suite_figure::{
    Band, Nominal, RunGauge, RunTrace, SAME_TIME, SuiteFigure, TightSpot, interpolate,
};

/// Number of runs up to which all of them are drawn.
const MOST_RUNS: usize = 200;
/// Number of runs that are drawn of each suite where there are more.
const MOST_DECIDING: usize = 4;
/// Number of runs that are drawn of all suites then, so that the page stays small.
const MOST_DECIDING_OF_ALL: usize = 100;
/// Radius below which a set has no width \[rad or rad/s\].
const LEAST_RADIUS: f64 = 1e-9;

/// Makes the figures of all suites. Up to 200 runs, all are drawn; of more, the range of all and
/// the runs that decide. Many suites are in the order in which their runs come furthest.
///
/// # Errors
///
/// As [`Problem::run`](reachtube_conform::Problem::run);
/// [`Error::NoReachableSet`] for a suite without one.
pub fn suite_figures(sources: &Sources) -> Result<Vec<SuiteFigure>> {
    let recordings = sources.problem.recordings();
    let drawn = recordings.suites.iter().filter(|suite| suite.envelope.len() > 1);
    let are_many = recordings.run_count() > MOST_RUNS;
    let figures = drawn.map(|suite| figure(sources, suite, are_many));
    let mut figures = figures.collect::<Result<Vec<_>>>()?;
    if are_many {
        keep_deciding(&mut figures, MOST_DECIDING_OF_ALL);
    }
    put_furthest_first(&mut figures);
    Ok(figures)
}

fn put_furthest_first(figures: &mut [SuiteFigure]) {
    if figures.len() > MOST_STATIC {
        figures.sort_by(|a, b| rank(b).partial_cmp(&rank(a)).expect("no rank is NaN"));
    }
}

/// Returns by what suites are ordered: how far out the runs come, as the page prints it, then how
/// many of their rows lie outside, then how much they decide.
fn rank(figure: &SuiteFigure) -> (f64, usize, usize) {
    let touches = figure.runs.iter().map(|run| run.touches).sum();
    // Many suites touch the set, to rounding. Outside a set without width there is no percentage.
    let without_width = if figure.outside > 0 { f64::INFINITY } else { 0.0 };
    let furthest = figure.furthest.map_or(without_width, |part| (1e3 * part).round());
    (furthest, figure.outside, touches)
}

fn figure(sources: &Sources, suite: &Suite, are_many: bool) -> Result<SuiteFigure> {
    let Sources { model, problem, check, reach, .. } = *sources;
    let (joints, name) = (model.inputs(), &suite.entry.name);
    let own: Vec<&SuiteReach> = reach.iter().filter(|reach| reach.suite == *name).collect();
    let longest = own.iter().max_by_key(|reach| reach.times.len()).copied();
    let longest = longest.ok_or_else(|| Error::NoReachableSet { suite: name.clone() })?;
    let shared = longest.run.is_none();
    let band = band(&own, longest, joints, check.verdict.enclosure.set_name());
    let mut spots = spots(sources, suite);
    let chosen = if are_many { deciding(&spots) } else { (0..suite.runs.len()).collect() };
    spots.retain(|spot| chosen.contains(&spot.run));
    let sets = model.sets();
    let positions_only = model.settings.states == States::Positions;
    let compared = if positions_only { joints } else { 2 * joints };
    let noise: Vec<f64> = (0..compared).map(|i| sets.noise_radius(i)).collect();
    // Each run as a line, relative to its own nominal motion where it has one.
    let (mut runs, mut range, mut gauges) = (Vec::new(), None, Vec::new());
    for (order, summary) in suite.runs.iter().enumerate() {
        let file = &problem.entry(summary.index).file;
        let of_run = own.iter().find(|reach| reach.run.as_ref() == Some(file));
        let mut run = trace(problem, summary.index, order, of_run.copied())?;
        let at_samples = at_samples(&run, &longest.times);
        run.gauge = gauge(&at_samples, &band, &noise);
        let decides = |spot: &&TightSpot| spot.run == order && spot.margin >= 0.0;
        run.touches = spots.iter().filter(decides).count();
        gauges.extend(run.gauge.map(|gauge| {
            let RunTrace { order, temperature, .. } = run;
            RunGauge { order, temperature, gauge }
        }));
        if are_many {
            include(&mut range, at_samples);
        }
        if chosen.contains(&order) {
            runs.push(run);
        }
    }
    for spot in &mut spots {
        spot.run = runs.iter().position(|run| run.order == spot.run).unwrap_or(0);
    }
    let nominal = columns(&longest.nominal, 2 * joints);
    let label = format!("all {} recordings", suite.runs.len());
    // Where the set is longer than all runs, there is no range for all of its times.
    let range = range.filter(|[lower, _]| lower[0].len() == longest.times.len());
    Ok(SuiteFigure {
        suite: name.clone(),
        joints: (0..joints).map(|joint| joint_name(model, joint)).collect(),
        kinds: model.arm().robot.kinds(),
        times: longest.times.clone(),
        band,
        positions_only,
        inner: range.map(|[lower, upper]| Band { label, lower, upper }),
        nominal: if shared { Nominal::Shared(nominal) } else { Nominal::PerRun },
        outside: outside(sources, name),
        undrawn: suite.runs.len() - runs.len(),
        runs,
        tight: spots,
        furthest: gauges.iter().map(|run| run.gauge).reduce(f64::max),
        gauges,
    })
}

fn outside(sources: &Sources, name: &str) -> usize {
    let verdicts = sources.check.verdict.suites.iter().filter(|verdict| verdict.suite == name);
    verdicts.map(|verdict| verdict.violations.count).sum()
}

/// Returns the samples of a suite that decide the sets, if the model was made from these
/// recordings, and the worst one outside.
fn spots(sources: &Sources, suite: &Suite) -> Vec<TightSpot> {
    let Sources { model, problem, check, .. } = *sources;
    let (joints, name) = (model.inputs(), &suite.entry.name);
    let place =
        |file: &String| suite.runs.iter().position(|run| problem.entry(run.index).file == *file);
    let is_own = sources.are_own();
    let tight = model.tight.iter().filter(|witness| is_own && witness.suite == *name);
    let verdicts = check.verdict.suites.iter().filter(|verdict| verdict.suite == *name);
    let worst = verdicts.filter_map(|verdict| verdict.violations.worst.as_ref());
    tight
        .chain(worst)
        .filter_map(|witness| Some(spot(witness, place(&witness.run)?, joints)))
        .collect()
}

/// Keeps the runs that lie outside or decide the most rows, at most `most` of all suites, and their
/// spots.
fn keep_deciding(figures: &mut [SuiteFigure], most: usize) {
    let worth = |figure: &SuiteFigure, run: usize| {
        let outside = figure.tight.iter().any(|spot| spot.run == run && spot.margin < 0.0);
        (outside, figure.runs[run].touches)
    };
    let place = |(at, figure): (usize, &SuiteFigure)| {
        (0..figure.runs.len()).map(|run| (worth(figure, run), at, run)).collect::<Vec<_>>()
    };
    let mut all: Vec<_> = figures.iter().enumerate().flat_map(place).collect();
    all.sort_by_key(|(worth, ..)| std::cmp::Reverse(*worth));
    // From the last run of a suite to its first, so that the places of the others stay.
    let mut dropped: Vec<_> = all.drain(most.min(all.len())..).collect();
    dropped.sort_by_key(|(_, at, run)| std::cmp::Reverse((*at, *run)));
    for (_, at, run) in dropped {
        let figure = &mut figures[at];
        figure.runs.remove(run);
        figure.undrawn += 1;
        figure.tight.retain(|spot| spot.run != run);
        figure.tight.iter_mut().for_each(|spot| spot.run -= usize::from(spot.run > run));
    }
}

/// Returns the runs of the most spots, in their order.
fn deciding(spots: &[TightSpot]) -> Vec<usize> {
    let mut runs: Vec<usize> = spots.iter().map(|spot| spot.run).collect();
    runs.sort_unstable();
    runs.dedup();
    let worth = |run: &usize| {
        let own = || spots.iter().filter(|spot| spot.run == *run);
        (own().all(|spot| spot.margin >= 0.0), std::cmp::Reverse(own().count()))
    };
    runs.sort_by_key(worth);
    runs.truncate(MOST_DECIDING);
    runs.sort_unstable();
    runs
}

/// Returns the states of a run at the sample times of its suite, as far as it goes.
fn at_samples(run: &RunTrace, times: &[f64]) -> Vec<Vec<f64>> {
    if run.has_times(times) {
        return run.states.clone();
    }
    let end = run.times.last().map_or(f64::NEG_INFINITY, |end| end + SAME_TIME);
    let known = &times[..times.partition_point(|time| *time <= end)];
    let row = |row: &Vec<f64>| {
        let line: Vec<_> = run.times.iter().copied().zip(row.iter().copied()).collect();
        known.iter().map(|time| interpolate(&line, *time)).collect()
    };
    run.states.iter().map(row).collect()
}

/// Returns the part of the radius of the band with the noise set V that a run reaches at most, to
/// rounding. `noise` has the radius of V in each state that is compared.
fn gauge(states: &[Vec<f64>], band: &Band, noise: &[f64]) -> Option<f64> {
    let rows = states.iter().zip(&band.lower).zip(&band.upper).zip(noise);
    let parts = rows.flat_map(|(((row, low), high), noise)| {
        row.iter().zip(low).zip(high).filter_map(move |((x, low), high)| {
            let radius = 0.5 * (high - low) + noise;
            (radius > LEAST_RADIUS).then(|| (x - 0.5 * (high + low)).abs() / radius)
        })
    });
    parts.reduce(f64::max)
}

/// Widens the range of runs, `[lower, upper]`, by the states of one more at the same samples.
fn include(range: &mut Option<[Vec<Vec<f64>>; 2]>, states: Vec<Vec<f64>>) {
    let Some([lower, upper]) = range else {
        *range = Some([states.clone(), states]);
        return;
    };
    for ((row, low), high) in states.iter().zip(lower).zip(upper) {
        for (k, x) in row.iter().enumerate() {
            if k == low.len() {
                low.push(*x);
                high.push(*x);
            }
            (low[k], high[k]) = (low[k].min(*x), high[k].max(*x));
        }
    }
}

/// Returns the band of a suite. Runs with nominal motions of their own share the hull of their
/// deviations.
fn band(own: &[&SuiteReach], longest: &SuiteReach, joints: usize, set: &str) -> Band {
    let shared = longest.run.is_none();
    let edge = |of: fn(&SuiteReach) -> &[f64], further: fn(f64, f64) -> f64| {
        let deviation = |reach: &&SuiteReach, at: usize| {
            of(reach).get(at).map(|x| if shared { *x } else { x - reach.nominal[at] })
        };
        let hull = |at: usize| own.iter().filter_map(|reach| deviation(reach, at)).reduce(further);
        let values: Vec<f64> = (0..longest.nominal.len()).filter_map(hull).collect();
        columns(&values, 2 * joints)
    };
    Band {
        label: set.into(),
        lower: edge(|reach| &reach.lower, f64::min),
        upper: edge(|reach| &reach.upper, f64::max),
    }
}

fn spot(witness: &Witness, run: usize, joints: usize) -> TightSpot {
    let Witness { time, state, side, excess, .. } = *witness;
    TightSpot { run, time_s: time, state: state.index(joints), side, margin: -excess }
}

/// Returns a run as a line, relative to its own nominal motion where it has one.
fn trace(
    problem: &Problem,
    index: usize,
    order: usize,
    own: Option<&SuiteReach>,
) -> Result<RunTrace> {
    let run = problem.run(index)?;
    let mut states = run.states.clone();
    if let Some(own) = own {
        states.iter_mut().zip(&own.nominal).for_each(|(x, nominal)| *x -= nominal);
    }
    let entry = problem.entry(index);
    Ok(RunTrace {
        name: entry.file.clone(),
        order,
        temperature: entry.temperature,
        temperatures: means(&run.temperatures, run.joints),
        times: run.times.clone(),
        states: columns(&states, run.dimension()),
        gauge: None,
        touches: 0,
    })
}

fn means(values: &[f64], count: usize) -> Vec<f64> {
    let rows = values.len() / count;
    if rows == 0 {
        return Vec::new();
    }
    let mean = |i: usize| values.iter().skip(i).step_by(count).sum::<f64>() / rows as f64;
    (0..count).map(mean).collect()
}

/// Turns row-major samples x states into one list per state.
fn columns(values: &[f64], states: usize) -> Vec<Vec<f64>> {
    (0..states).map(|i| values.iter().skip(i).step_by(states).copied().collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn the_runs_that_decide_most_are_kept_with_their_spots() {
        let mut figures = [sample::suite("A", 1), sample::suite("B", 1)];
        figures[1].tight[1].margin = -0.1;
        keep_deciding(&mut figures, 3);
        let names = |figure: &SuiteFigure| -> Vec<String> {
            figure.runs.iter().map(|run| run.name.clone()).collect()
        };
        // Run 1 of B lies outside; the runs 3 decide three rows each.
        assert_eq!(names(&figures[0]), ["run 3"]);
        assert_eq!(names(&figures[1]), ["run 1", "run 3"]);
        assert_eq!(figures.each_ref().map(|figure| figure.undrawn), [2, 1]);
        let spots = |figure: &SuiteFigure| figure.tight.iter().map(|s| s.run).collect::<Vec<_>>();
        assert_eq!([spots(&figures[0]), spots(&figures[1])], [vec![0], vec![1, 0]]);
    }

    #[test]
    fn many_suites_are_in_the_order_of_their_furthest_runs_and_few_as_they_are() {
        let first_of = |count: usize| {
            let mut figures: Vec<SuiteFigure> =
                (0..count).map(|k| sample::suite(&k.to_string(), 1)).collect();
            figures.iter_mut().for_each(|figure| figure.furthest = Some(0.2));
            figures[5].furthest = Some(0.9);
            // The margins of different units do not count before the percentage.
            figures[7].tight[0].margin = -5.0;
            put_furthest_first(&mut figures);
            figures[0].suite.clone()
        };
        assert_eq!([first_of(MOST_STATIC), first_of(MOST_STATIC + 1)], ["0", "5"]);
    }

    #[test]
    fn the_gauge_is_the_largest_part_of_the_radius_and_ranges_widen() {
        let figure = sample::suite("S", 1);
        let run = &figure.runs[2];
        let states = at_samples(run, &figure.times);
        let part = gauge(&states, &figure.band, &[0.0; 2]).unwrap();
        assert!((part - 0.04 * 2.0 / (0.01 + 0.05 * 2.0)).abs() < 1e-9, "{part}");
        let mut faster = states.clone();
        faster[1].iter_mut().for_each(|velocity| *velocity += 1.0);
        let of_positions = gauge(&faster, &figure.band, &[0.0; 1]).unwrap();
        assert!((of_positions - part).abs() < 1e-9, "{of_positions}");
        let mut range = None;
        figure.runs.iter().for_each(|run| include(&mut range, at_samples(run, &figure.times)));
        let [low, high] = range.unwrap();
        assert_eq!((low[0][150], high[0][150]), {
            let of = |run: usize| figure.runs[run].states[0][150];
            (of(0).min(of(2)), of(0).max(of(2)))
        });
    }

    #[test]
    fn a_run_on_other_times_is_interpolated_to_those_of_its_suite() {
        let run = RunTrace {
            times: vec![0.0, 0.5, 1.0],
            states: vec![vec![0.0, 1.0, 0.0]],
            ..RunTrace::default()
        };
        assert_eq!(at_samples(&run, &[0.0, 0.25, 1.0, 1.25]), [vec![0.0, 0.5, 0.0]]);
    }
}
