//! The README of a campaign's folder.

use serde_json::Value;

use super::mark::MARK;
use super::options::CampaignOptions;
use crate::virtual_robot::VirtualRobot;

/// How a suite is recorded.
const HOW: &str = "\
## How a suite is recorded

Computed-torque control with the nominal model drives the arm along the motion, with its joints at
the nominal temperature, and the input u is recorded: the torque without compensated gravity and
Coulomb friction. Each run follows the motion closed loop to the suite's starting point and goes on
open loop from there: it applies the recorded u, and the controller adds the nominal model's gravity
at the measured position and Coulomb friction at the planned velocity. Run 1 of a suite is cold. The
joints warm up by friction work and cool in the pause between two runs.
";

/// Returns the README: what each file is, and what to type.
pub(super) fn readme(robot: &VirtualRobot, options: &CampaignOptions) -> String {
    let CampaignOptions { seed, motions, start_points, runs, longest, poses, friction, .. } =
        options;
    let (name, joints) = (robot.nominal().name(), robot.nominal().joint_count());
    let suites = motions * start_points;
    format!(
        "# A campaign of recordings of a virtual robot

These recordings are synthetic: `reachtube campaign` simulated {name} with seed {seed}.
Do not take them for measurements of a robot.

| files | what the arm does | `--torque` |
|---|---|---|
| `suites/` | {suites} test suites: {motions} random point-to-point motions, {start_points} starting \
points each, {runs} runs of up to {longest} s | `compensated` |
| `poses/` | {poses} static poses, 20 in a recording: the arm rests twice at each position, and each \
joint comes from the other side the second time | `motor` |
| `friction/` | one joint after the other moves back and forth: {friction} poses for each of the \
{joints} joints, with peak speeds of 0.2, 0.5 and 1 rad/s | `motor` |
| `excitation/` | {excitation} exciting motions of all joints, 20 s each | `motor` |
| `validation/` | {validation} more of them | `motor` |

`runs.csv` lists all recordings. `truth.toml` is the robot that moved, with its friction as a law of
temperature; a real robot has no such file. `{MARK}` holds the options.

## What to type

    reachtube inspect --data .
    reachtube identify --robot lwa4p --static poses --friction friction --dynamic excitation \\
        --validate validation --out identified.toml --report identified
    reachtube conform --robot lwa4p --data . --torque compensated --out model.json --report report

`--robot lwa4p` is the nominal model that the arm's controller has. Without `--suites`, `conform`
takes all suites. With `--robot truth.toml`, `identify` prints the true combinations beside those
that it finds, as in the description.

{HOW}
## Columns and numbers

`t` s, `q` rad, `qd` rad/s, `tau` N m, `temp` °C. Samples are 4 ms apart, 20 ms in `poses/`, where
the arm mostly rests. Positions have 6 decimals (the encoders have steps of {step:.1e} rad),
velocities 5, torques 3 (the controller commands whole mN m), temperatures 1. In `runs.csv`,
`temperature` is the mean over the joints when the recording begins, and `simulated` marks all
recordings, so that pages about them say so.

## What the nominal model does not know

| parameter | value |
|---|---|
{parameters}",
        excitation = options.excitation,
        validation = options.validation,
        step = options.robot.encoder_step,
        parameters = table(options),
    )
}

/// Returns a line for each parameter of the virtual robot.
fn table(options: &CampaignOptions) -> String {
    let parameters = serde_json::to_value(&options.robot).expect("parameters are numbers");
    let line = |(name, value): (&String, &Value)| format!("| `{name}` | {value} |\n");
    parameters.as_object().into_iter().flatten().map(line).collect()
}
