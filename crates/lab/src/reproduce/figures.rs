//! Figs. 1 to 4 of the paper, drawn again.

use std::path::Path;

use reachtube_identify::{FrictionFit, Identification};
use reachtube_recordings::{DataSet, ReadOptions, Run, RunSource};
use reachtube_robot::JointKind;
use schemars::JsonSchema;
use serde::Serialize;

use super::exemplary::Exemplary;
use crate::campaign::{PlannedSuite, planned_suites};
use crate::error::{Error, Result};
use crate::motion::{Motion, SAMPLE_TIME};
use reachtube_finding::Table;
use reachtube_page::{
    Area, Chart, Series, SuiteFigure, View, charts_svg, friction_charts, suite_svg,
};
use reachtube_scalar::number::significant;

/// Red, of recordings.
const RECORDED: [u8; 3] = [222, 30, 30];
/// Grey, of reachable sets and marks.
const SET: [u8; 3] = [140, 149, 159];
/// Dark grey, of what was planned.
const PLANNED: [u8; 3] = [31, 35, 40];

/// A figure of the paper, drawn again.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PaperFigure {
    /// Its number in the paper.
    pub number: u8,
    /// What ours shows.
    pub caption: String,
    /// What the paper's shows.
    pub paper: String,
    /// Its numbers.
    pub table: Table,
    /// The drawing, a complete SVG document.
    #[serde(skip)]
    pub svg: String,
}

/// Draws Fig. 1: recorded behaviour inside the reachable set, for the joint that spreads most.
pub(super) fn fig1(suite: &Exemplary) -> Result<PaperFigure> {
    let (joint, n) = (suite.widest_joint(), suite.joints());
    let SuiteFigure { runs, suite: name, joints, .. } = &suite.figure;
    let caption = format!(
        "{} of suite {name}: {} recordings of the same open-loop input (red) lie in the reachable \
         set of the model (grey) at every sample.",
        joints[joint],
        runs.len()
    );
    let charts = [
        in_set(suite, joint, "position", "position [rad]"),
        in_set(suite, n + joint, "velocity", "velocity [rad/s]"),
    ];
    Ok(PaperFigure {
        number: 1,
        paper: "The paper shows its arm, and recordings (red) inside the reachable set (grey)."
            .into(),
        table: widths(suite, joint..joint + 1),
        svg: charts_svg(&charts, 2, &caption)?,
        caption,
    })
}

/// Draws Fig. 2: the same input moves the robot, whose runs differ, and the model, whose reachable
/// set encloses them.
pub(super) fn fig2(suite: &Exemplary) -> Result<PaperFigure> {
    let (joint, n) = (suite.widest_joint(), suite.joints());
    let SuiteFigure { times, runs, joints, .. } = &suite.figure;
    let inputs: Vec<f64> = suite.inputs.iter().skip(joint).step_by(n).copied().collect();
    let position = "position [rad]";
    let model = in_set(suite, joint, "model: its reachable set", position);
    let charts = [
        Chart::new(
            "input u of all runs",
            "time [s]",
            "torque [N m]",
            vec![line(times, &inputs, PLANNED)],
        ),
        Chart::new("robot: its recordings", "time [s]", position, model.series.clone()),
        model,
    ];
    let caption = format!(
        "{} of suite {}: open-loop control with compensated gravity and Coulomb friction. One \
         input (left) moves the robot, whose {} runs diverge (middle, red), and the model, whose \
         reachable set (right, grey) encloses them.",
        joints[joint],
        suite.figure.suite,
        runs.len()
    );
    Ok(PaperFigure {
        number: 2,
        paper: "The paper shows the same as a diagram, without numbers.".into(),
        table: widths(suite, joint..joint + 1),
        svg: charts_svg(&charts, 3, &caption)?,
        caption,
    })
}

fn line(times: &[f64], values: &[f64], colour: [u8; 3]) -> Series {
    Series::line(times.iter().copied().zip(values.iter().copied()).collect(), colour)
}

fn in_set(suite: &Exemplary, state: usize, title: &str, y: &str) -> Chart {
    let SuiteFigure { times, band, runs, .. } = &suite.figure;
    let [lower, upper] = [&band.lower, &band.upper]
        .map(|edge| times.iter().copied().zip(edge[state].iter().copied()).collect());
    let runs = runs.iter().map(|run| line(&run.times, &run.states[state], RECORDED));
    let areas = vec![Area { lower, upper }];
    Chart { areas, ..Chart::new(title, "time [s]", y, runs.collect()) }
}

/// Draws Fig. 3: the points of the motion of `suite` at which the controller switches to open loop,
/// and the runs from there.
///
/// # Errors
///
/// [`Error::NotACampaign`]; [`Error::UnknownSuite`]; as [`suite_svg`].
pub(super) fn fig3(campaign: &Path, suite: &str) -> Result<PaperFigure> {
    let planned = planned_suites(campaign)?;
    let of_suite = planned.iter().find(|plan| plan.name == suite);
    let of_suite = of_suite.ok_or_else(|| Error::UnknownSuite { suite: suite.into() })?;
    let motion = &of_suite.motion;
    let same = planned.iter().filter(|plan| plan.motion_name == of_suite.motion_name);
    let data = DataSet::open(campaign)?;
    let starts: Vec<OpenLoop> =
        same.map(|plan| OpenLoop::new(&data, plan)).collect::<Result<_>>()?;
    let joints = motion.start.len();
    let charts: Vec<Chart> =
        (0..joints).map(|joint| planned_chart(motion, &starts, joint)).collect();
    let row = |open: &OpenLoop| {
        let last =
            open.runs.iter().filter_map(|run| run.times.last()).fold(0.0, |a: f64, b| a.max(*b));
        vec![
            open.suite.clone(),
            format!("{:.2}", open.start),
            format!("{last:.2}"),
            open.runs.len().to_string(),
        ]
    };
    let header = ["suite", "open loop from [s]", "for [s]", "runs"];
    let caption = format!(
        "Random point-to-point motion {} (black) of {:.2} s. At {} points (dashed) the controller \
         switches from closed loop to open loop; from there the runs (red) diverge.",
        of_suite.motion_name,
        motion.duration,
        starts.len()
    );
    Ok(PaperFigure {
        number: 3,
        paper: "The paper shows one motion with four points, and neither times nor scales.".into(),
        table: Table::new(header, starts.iter().map(row).collect())
            .titled("Where the open loop begins"),
        svg: charts_svg(&charts, 3, &caption)?,
        caption,
    })
}

/// The runs from one point of a motion.
struct OpenLoop {
    suite: String,
    /// Time of the motion at which the open loop begins \[s\].
    start: f64,
    runs: Vec<Run>,
}

impl OpenLoop {
    fn new(data: &DataSet, plan: &PlannedSuite) -> Result<Self> {
        let suites = data.suites();
        let of_suite = suites.iter().filter(|entry| entry.name == plan.name);
        let indices = of_suite.flat_map(|entry| entry.runs.iter().copied());
        let read = |index: usize| data.read(index, &ReadOptions::default());
        let runs = indices.map(read).collect::<Result<_, _>>();
        let runs = runs.map_err(reachtube_recordings::Error::Defects)?;
        Ok(Self { suite: plan.name.clone(), start: plan.first as f64 * SAMPLE_TIME, runs })
    }
}

/// Returns the plan of a joint over time, and the runs from the points at which the open loop
/// begins.
fn planned_chart(motion: &Motion, starts: &[OpenLoop], joint: usize) -> Chart {
    let run = |run: &Run, start: f64| {
        let point = |k: usize| (start + run.times[k], run.q(k)[joint]);
        Series::line((0..run.len()).map(point).collect(), RECORDED)
    };
    let mut series: Vec<Series> = starts
        .iter()
        .flat_map(|open| open.runs.iter().map(move |of| run(of, open.start)))
        .collect();
    let plan = (0..=motion.cycles()).map(|k| {
        let t = k as f64 * SAMPLE_TIME;
        (t, motion.at(t).q[joint])
    });
    series.push(Series::line(plan.collect(), PLANNED));
    let heights = || series.iter().flat_map(|series| &series.points).map(|point| point.1);
    let ends = [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::MIN, f64::max)];
    series.extend(starts.iter().flat_map(|open| dashed(open.start, ends)));
    Chart::new(format!("joint{}", joint + 1), "time [s]", "position [rad]", series)
}

/// Draws Fig. 4: the reachable sets of both cases with all recordings of a suite.
///
/// # Errors
///
/// As [`suite_svg`].
pub(super) fn fig4(suite: &Exemplary) -> Result<PaperFigure> {
    let by = if suite.figure.runs.iter().all(|run| !run.temperatures.is_empty()) {
        "temperature, each axis over its own range"
    } else {
        "order"
    };
    Ok(PaperFigure {
        number: 4,
        caption: format!(
            "Suite {}: reachable sets of model 1. Light grey: position and velocity conformant. \
             Dark grey: position conformant. The {} recordings are coloured by {by}.",
            suite.figure.suite,
            suite.figure.runs.len()
        ),
        paper: "The paper's figure has the same content for a suite of its own. Hot runs lie on \
                one side of cold ones there."
            .into(),
        table: widths(suite, 0..suite.joints()),
        svg: suite_svg(&suite.figure, View::Motion)?,
    })
}

/// Draws Fig. 5 for every joint: Coulomb friction over the load, and viscous friction over the
/// velocity.
///
/// # Errors
///
/// Fails for numbers that cannot be drawn.
pub(super) fn fig5(found: &Identification) -> Result<PaperFigure> {
    let fits = found.friction.iter().zip(found.description.kinds());
    let fits: Vec<_> = fits.collect();
    // The charts of three joints in a row, viscous friction below Coulomb friction.
    let mut charts = Vec::new();
    for row in fits.chunks(3) {
        let row: Vec<_> = row.iter().map(|(fit, kind)| friction_charts(fit, *kind)).collect();
        charts.extend([0, 1].into_iter().flat_map(|k| row.iter().map(move |two| two[k].clone())));
    }
    let row = |(fit, _): &(&FrictionFit, JointKind)| {
        let squares: f64 = fit.residuals.iter().map(|residual| residual * residual).sum();
        let rms = (squares / fit.residuals.len().max(1) as f64).sqrt();
        vec![fit.joint.joint.clone(), fit.samples.len().to_string(), significant(rms, 3)]
    };
    let header = ["joint", "samples", "residual, root mean square [N m]"];
    let caption = "Fits (orange) of load-dependent Coulomb friction and of viscous friction, for \
                   every joint. Blue: the recorded torque without the other parts."
        .to_string();
    Ok(PaperFigure {
        number: 5,
        paper: "The paper shows joint 2. Its Coulomb friction runs from 4 to 10 N m over loads of \
                both signs, and its viscous friction bends down toward high speeds."
            .into(),
        table: Table::new(header, fits.iter().map(row).collect()).titled("What the fits leave"),
        svg: charts_svg(&charts, 3, &caption)?,
        caption,
    })
}

fn dashed(x: f64, [low, high]: [f64; 2]) -> impl Iterator<Item = Series> {
    const DASHES: usize = 25;
    let height = move |part: f64| low + (high - low) * part / DASHES as f64;
    (0..DASHES).map(move |k| {
        let k = k as f64;
        Series::line(vec![(x, height(k)), (x, height(k + 0.5))], SET)
    })
}

/// Returns how far the runs spread and how wide the reachable sets are, for some joints.
fn widths(suite: &Exemplary, joints: std::ops::Range<usize>) -> Table {
    let n = suite.joints();
    let digits = |value: f64| significant(value, 3);
    let row = |joint: usize| {
        let cells = [joint, n + joint].into_iter().flat_map(|state| {
            let [velocity, position] = suite.widths(state);
            [suite.spread(state), velocity, position].map(digits)
        });
        std::iter::once(suite.figure.joints[joint].clone()).chain(cells).collect()
    };
    let header = [
        "joint",
        "runs q [rad]",
        "set (q, qd) [rad]",
        "set (q) [rad]",
        "runs qd [rad/s]",
        "set (q, qd) [rad/s]",
        "set (q) [rad/s]",
    ];
    Table::new(header, joints.map(row).collect()).titled(format!(
        "Largest spread of the runs of suite {}, and largest width of its reachable sets",
        suite.figure.suite
    ))
}
