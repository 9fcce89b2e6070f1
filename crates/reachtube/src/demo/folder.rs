//! The folder of a recorded demo: runs, a README, and the index last, so that what was not finished
//! cannot be opened.

use std::fmt::Write as _;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::SAMPLE_TIME;
use super::hidden;
use super::plan::{RunPlan, SuitePlan};
use crate::error::{Error, Result};
use reachtube_files::write::atomically;

/// First line of the README, by which the folder of a demo is known.
const TITLE: &str = "# Recordings of a virtual robot";

const INDEX_HEADER: &str = "file,kind,suite,motion,use,repeat,rows,duration_s,temperature,sha256\n";

/// Refuses a folder with an index that no demo has written.
pub(super) fn refuse_foreign(folder: &Path) -> Result<()> {
    let index = folder.join("runs.csv");
    let ours = || {
        std::fs::read_to_string(folder.join("README.md")).is_ok_and(|text| text.starts_with(TITLE))
    };
    if !index.exists() || ours() {
        return Ok(());
    }
    Err(Error::Setting(format!(
        "{} belongs to recordings that are not a demo's, and it would be overwritten; give an empty folder",
        index.display()
    )))
}

/// Writes run `repeat` (from 1) of a suite, and returns its line of the index.
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
        "{file},test_suite,{name},{motion},{use_for},{repeat},{rows},{duration:.3},{temperature:.2},{hash}\n"
    ))
}

/// Writes README and index of a folder whose runs are there.
pub(super) fn write_index(folder: &Path, robot: &str, seed: u64, lines: &[String]) -> Result<()> {
    let readme = readme(robot, seed);
    atomically(&folder.join("README.md"), |out| out.write_all(readme.as_bytes()))?;
    atomically(&folder.join("runs.csv"), |out| {
        out.write_all(INDEX_HEADER.as_bytes())?;
        lines.iter().try_for_each(|line| out.write_all(line.as_bytes()))
    })?;
    Ok(())
}

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

fn readme(robot: &str, seed: u64) -> String {
    let per_cent = |share: f64| 100.0 * share;
    format!(
        "{TITLE}

These recordings are synthetic: a simulation of {robot} made with `reachtube demo`, seed {seed}. Do not take them for measurements of a robot.

Each run is driven open loop by an input that was computed along a point-to-point motion from the nominal model; the controller adds gravity and
Coulomb friction of the nominal model. All runs of a suite have the same input. Suites of one motion start at different points of it.
Run 1 of each suite is cold; the joints warm up from run to run.

Columns: `t` s, `q` rad, `qd` rad/s, `tau` N m. `tau` is the input u (gravity and Coulomb friction taken off): read it with `--torque compensated`.
`runs.csv` marks the suites kept for `reachtube check` in its column `use`; `temperature` is the mean over the joints when the run begins, °C.

What the nominal model does not know:

- friction falls with temperature: Coulomb {coulomb:.1} %/K, viscous {viscous:.1} %/K, nominal at {reference} °C; a joint warms by {warming} K per rad it moves, from {cold} °C
- joints stick: the compensation of Coulomb friction comes a little later than the friction
- torque ripple of {ripple:.0} % of the motor torque, one period a motor turn
- links {links:.0} % and motors {motors:.0} % heavier than nominal
- starts scattered by ±{scatter_q} rad and ±{scatter_qd} rad/s
- positions from encoders of {step:.2e} rad; velocities are their differences after a low-pass of {filter} s
",
        coulomb = per_cent(hidden::COULOMB_PER_KELVIN),
        viscous = per_cent(hidden::VISCOUS_PER_KELVIN),
        reference = hidden::IDENTIFIED_AT,
        warming = hidden::WARMING,
        cold = hidden::COLD,
        ripple = per_cent(hidden::RIPPLE_SHARE),
        links = per_cent(hidden::LINK_SHARE - 1.0),
        motors = per_cent(hidden::ARMATURE_SHARE - 1.0),
        scatter_q = hidden::SCATTER_Q,
        scatter_qd = hidden::SCATTER_QD,
        step = hidden::ENCODER_STEP,
        filter = hidden::VELOCITY_FILTER,
    )
}
