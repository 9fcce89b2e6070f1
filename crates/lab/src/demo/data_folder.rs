//! The folder of a recorded demo: runs, a README, and the index last, so that a folder that is not
//! finished cannot be opened.

use std::path::Path;

use reachtube_files::write::atomically;
use sha2::{Digest, Sha256};

use super::error::DemoError;
use super::options::DemoOptions;
use super::plan::SuitePlan;
use crate::error::Result;
use crate::motion::SAMPLE_TIME;
use crate::virtual_robot::{Recording, VirtualRobot};

/// First line of the README, which marks the folder of a demo.
const TITLE: &str = "# Recordings of a virtual robot";

const INDEX_HEADER: &str =
    "file,kind,suite,motion,use,repeat,rows,duration_s,temperature,sha256,simulated\n";

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

/// Writes the runs of a suite, and returns their lines of the index.
pub(super) fn write_suite(
    folder: &Path,
    suite: &SuitePlan,
    runs: &[Recording],
) -> Result<Vec<String>> {
    let (name, motion) = (&suite.runs.name, &suite.motion_name);
    let use_for = if suite.held_out { "check" } else { "training" };
    let write = |(repeat, run): (usize, &Recording)| {
        let (text, rows) = (run.to_csv(SAMPLE_TIME, 1), run.len());
        let file = format!("{name}/{name}_{repeat:02}.csv");
        atomically(&folder.join(&file), |out| out.write_all(text.as_bytes()))?;
        let duration = (rows - 1) as f64 * SAMPLE_TIME;
        let (temperature, hash) = (run.first_temperature(), sha256(&text));
        Ok(format!(
            "{file},test_suite,{name},{motion},{use_for},{repeat},{rows},{duration:.3},\
             {temperature:.2},{hash},true\n"
        ))
    };
    (1..).zip(runs).map(write).collect()
}

/// Writes README and index of a folder whose runs are complete.
pub(super) fn write_index(
    folder: &Path,
    robot: &VirtualRobot,
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

fn sha256(text: &str) -> String {
    Sha256::digest(text).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn readme(robot: &VirtualRobot, options: &DemoOptions) -> String {
    let (name, seed, parameters) = (robot.nominal().name(), options.seed, robot.parameters());
    let percent = |ratio: f64| 100.0 * ratio;
    format!(
        "{TITLE}

These recordings are synthetic: `reachtube demo` simulated {name} with seed {seed}.
Do not take them for measurements of a robot.

The input of each suite was recorded while computed-torque control with the nominal model drove the
arm along a point-to-point motion. Each run follows the motion closed loop to the suite's starting
point and goes on open loop from there: the controller applies the recorded input, and adds the
nominal model's gravity at the measured position and Coulomb friction at the planned velocity. All
runs of a suite have the same input. Run 1 of each suite is cold; the joints warm up from run to
run.

Columns: `t` s, `q` rad, `qd` rad/s, `tau` N m, `temp` °C. `tau` is the input u, without gravity and
Coulomb friction: read it with `--torque compensated`. In `runs.csv` the column `use` marks the
suites for `reachtube check`, `temperature` is the mean over the joints when the run begins, and
`simulated` marks the recordings, so that pages about them say so.

The nominal model does not contain these effects:

- Friction falls with temperature: Coulomb {coulomb:.1} %/K, viscous {viscous:.1} %/K, nominal at
  {reference} °C. Friction work warms the joints from {cold} °C.
- Joints stick, and dry friction is {breakaway:.0} % higher at standstill (Stribeck effect).
- The motor torque has a ripple of {ripple:.0} %, with a period of one motor turn.
- Links are {links:.0} % and motors {motors:.0} % heavier than nominal, and the last link carries
  {payload} kg.
- Starts are scattered by ±{scatter_q} rad and ±{scatter_qd} rad/s.
- Positions come from encoders with steps of {step:.2e} rad. Velocities are their differences after
  a low-pass filter with a time constant of {filter} s.
- A torque acts {delay} cycles of 4 ms after the measurement that it answers.
",
        coulomb = percent(parameters.coulomb_rate),
        viscous = percent(parameters.viscous_rate),
        reference = parameters.nominal_temperature,
        cold = parameters.ambient_temperature,
        breakaway = percent(parameters.breakaway_ratio),
        ripple = percent(parameters.ripple_ratio),
        links = percent(parameters.link_ratio - 1.0),
        motors = percent(parameters.motor_ratio - 1.0),
        payload = parameters.payload_mass,
        scatter_q = parameters.position_scatter,
        scatter_qd = parameters.velocity_scatter,
        step = parameters.encoder_step,
        filter = parameters.velocity_filter_time,
        delay = parameters.delay_cycles,
    )
}
