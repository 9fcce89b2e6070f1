//! The folder of a recorded demo: runs, a README, and the index last, so that a folder that is not
//! finished cannot be opened.

use std::fmt::Write as _;
use std::path::Path;

use reachtube_files::write::atomically;
use sha2::{Digest, Sha256};

use super::error::DemoError;
use super::options::DemoOptions;
use super::plan::{RunPlan, SuitePlan};
use super::unmodelled;
use crate::error::Result;
use crate::motion::SAMPLE_TIME;

/// First line of the README, which marks the folder of a demo.
const TITLE: &str = "# Recordings of a virtual robot";

const INDEX_HEADER: &str = "file,kind,suite,motion,use,repeat,rows,duration_s,temperature,sha256\n";

/// Refuses a folder that holds files but no README of a demo.
pub(super) fn refuse_foreign(folder: &Path) -> Result<(), DemoError> {
    let is_empty = std::fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none());
    let ours = || {
        std::fs::read_to_string(folder.join("README.md")).is_ok_and(|text| text.starts_with(TITLE))
    };
    if is_empty || ours() {
        Ok(())
    } else {
        Err(DemoError::ForeignFolder { folder: folder.into() })
    }
}

/// Writes run `repeat` (from 1) of a suite, and returns its line of the index. `states` has the
/// shape row-major K x 2n, \[rad\] and \[rad/s\].
pub(super) fn write_run(
    folder: &Path,
    suite: &SuitePlan,
    repeat: usize,
    run: &RunPlan,
    states: &[f64],
) -> Result<String> {
    let n = run.q.len();
    let text = run_text(n, states, &suite.inputs);
    let file = format!("{0}/{0}_{repeat:02}.csv", suite.name);
    atomically(&folder.join(&file), |out| out.write_all(text.as_bytes()))?;
    let rows = suite.inputs.len() / n;
    let duration = (rows - 1) as f64 * SAMPLE_TIME;
    let temperature = run.temperatures.iter().sum::<f64>() / n as f64;
    let use_for = if suite.held_out { "check" } else { "training" };
    let (name, motion, hash) = (&suite.name, &suite.motion, sha256(&text));
    Ok(format!(
        "{file},test_suite,{name},{motion},{use_for},{repeat},{rows},{duration:.3},\
         {temperature:.2},{hash}\n"
    ))
}

/// Writes README and index of a folder whose runs are complete.
pub(super) fn write_index(
    folder: &Path,
    robot: &str,
    options: &DemoOptions,
    lines: &[String],
) -> Result<()> {
    let readme = readme(robot, options);
    atomically(&folder.join("README.md"), |out| out.write_all(readme.as_bytes()))?;
    atomically(&folder.join("runs.csv"), |out| {
        out.write_all(INDEX_HEADER.as_bytes())?;
        lines.iter().try_for_each(|line| out.write_all(line.as_bytes()))
    })?;
    Ok(())
}

/// Returns a run as CSV: time, then n positions, velocities and inputs per sample.
fn run_text(n: usize, states: &[f64], inputs: &[f64]) -> String {
    let mut text = String::from("t");
    for column in ["q", "qd", "tau"] {
        (1..=n).for_each(|joint| text += &format!(",{column}{joint}"));
    }
    text.push('\n');
    for (k, (state, input)) in states.chunks_exact(2 * n).zip(inputs.chunks_exact(n)).enumerate() {
        let _ = write!(text, "{:.3}", k as f64 * SAMPLE_TIME);
        for x in state.iter().chain(input) {
            let _ = write!(text, ",{x}");
        }
        text.push('\n');
    }
    text
}

fn sha256(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn readme(robot: &str, options: &DemoOptions) -> String {
    let seed = options.seed;
    let stribeck = match options.stribeck {
        true => format!(
            "- Dry friction rises by {:.0} % toward standstill, over {} rad/s.\n",
            100.0 * unmodelled::STRIBECK_RATIO,
            unmodelled::STRIBECK_SPEED
        ),
        false => String::new(),
    };
    let percent = |ratio: f64| 100.0 * ratio;
    format!(
        "{TITLE}

These recordings are synthetic: `reachtube demo` simulated {robot} with seed {seed}.
Do not take them for measurements of a robot.

Each run is driven open loop by an input that was computed along a point-to-point motion from the
nominal model. The controller adds gravity and Coulomb friction of the nominal model. All runs of a
suite have the same input. Suites of one motion start at different points of it. Run 1 of each suite
is cold; the joints warm up from run to run.

Columns: `t` s, `q` rad, `qd` rad/s, `tau` N m. `tau` is the input u, without gravity and Coulomb
friction: read it with `--torque compensated`. In `runs.csv` the column `use` marks the suites for
`reachtube check`, and `temperature` is the mean over the joints when the run begins, in °C.

The nominal model does not contain these effects:

- Friction falls with temperature: Coulomb {coulomb:.1} %/K, viscous {viscous:.1} %/K, nominal at
  {reference} °C. A joint warms by {warming} K per rad of motion, from {cold} °C.
- Joints stick: the compensation of Coulomb friction rises more slowly with speed than the friction.
{stribeck}- The motor torque has a ripple of {ripple:.0} %, with a period of one motor turn.
- Links are {links:.0} % and motors {motors:.0} % heavier than nominal.
- Starts are scattered by ±{scatter_q} rad and ±{scatter_qd} rad/s.
- Positions come from encoders with steps of {step:.2e} rad. Velocities are their differences after
  a low-pass filter with a time constant of {filter} s.
",
        coulomb = percent(unmodelled::COULOMB_PER_KELVIN),
        viscous = percent(unmodelled::VISCOUS_PER_KELVIN),
        reference = unmodelled::NOMINAL_TEMPERATURE,
        warming = unmodelled::WARMING,
        cold = unmodelled::COLD_TEMPERATURE,
        ripple = percent(unmodelled::RIPPLE_RATIO),
        links = percent(unmodelled::LINK_RATIO - 1.0),
        motors = percent(unmodelled::MOTOR_RATIO - 1.0),
        scatter_q = unmodelled::POSITION_SCATTER,
        scatter_qd = unmodelled::VELOCITY_SCATTER,
        step = unmodelled::ENCODER_STEP,
        filter = unmodelled::VELOCITY_FILTER_TIME,
    )
}
