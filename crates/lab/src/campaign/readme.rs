//! The README of a campaign's folder.

use serde_json::Value;

use super::options::{CampaignOptions, MARK};
use crate::virtual_robot::VirtualRobot;

pub(super) fn readme(robot: &VirtualRobot, options: &CampaignOptions) -> String {
    let name = robot.nominal().name();
    format!(
        "# Recordings of a virtual robot

These recordings are synthetic: reachtube simulated {name} with seed {seed}.
Do not take them for measurements of a robot.

| files | what the arm does | `--torque` |
|---|---|---|
{files}
`runs.csv` lists all recordings; `use` marks suites that were held out for `reachtube check`.
`truth.toml` is the robot that moved, with its friction as a law of temperature; a real robot has no
such file. `{MARK}` holds the options.

## What to type

    reachtube inspect --data .
{identify}{make}

`--robot lwa4p` is the nominal model that the arm's controller has.
{suites}
## Columns and numbers

`t` s, `q` rad, `qd` rad/s, `tau` N m, `temp` °C. Samples are 4 ms apart{slower}.
Positions have 6 decimals (the encoders have steps of {step:.1e} rad), velocities 5, torques 3 (the
controller commands whole mN m), temperatures 1. In `runs.csv`, `temperature` is the mean over the
joints when the recording begins, and `simulated` marks all recordings, so that pages about them say
so.

## What the nominal model does not know

| parameter | value |
|---|---|
{parameters}",
        seed = options.seed,
        files = files(options),
        identify = if options.rest == 0 { "" } else { IDENTIFY },
        make = if options.motions == 0 { MODEL } else { CONFORM },
        suites = if options.motions == 0 { "" } else { SUITES },
        slower = match (options.rest, options.stride) {
            (0, 1) => String::new(),
            (0, stride) => format!(", {} ms in exciting motions", 4 * stride),
            _ => ", 20 ms in `rest/`, where the arm mostly rests".into(),
        },
        step = options.robot.encoder_step,
        parameters = parameters(options),
    )
}

const MODEL: &str =
    "    reachtube model --robot lwa4p --data excitation --torque motor --out model";

const CONFORM: &str =
    "    reachtube conform --robot lwa4p --data . --torque compensated --out model.json";

const SUITES: &str = "Without `--suites`, `conform` takes all suites.

## How a suite is recorded

Computed-torque control with the nominal model drives the arm along the motion, with its joints at
the nominal temperature, and the input u is recorded: the torque without compensated gravity and
Coulomb friction. Each run follows the motion closed loop to the suite's starting point and goes on
open loop from there: it applies the recorded u, and the controller adds the nominal model's gravity
at the measured position and Coulomb friction at the planned velocity. Run 1 of a suite is cold. The
joints warm up by friction work and cool in the pause between two runs.
";

const IDENTIFY: &str = "    reachtube identify --robot lwa4p --rest rest --one-joint one-joint \\
        --excitation excitation --validate validation --out identified.toml --report identified
";

fn files(options: &CampaignOptions) -> String {
    let CampaignOptions { motions, start_points, runs, longest, rest, one_joint, .. } = options;
    let folder = if options.has_suites_only() { "M1a/" } else { "suites/M1a/" };
    let suites = format!(
        "| `{folder}`, ... | {suites} test suites: {motions} random point-to-point motions, \
         {start_points} starting points each, {runs} runs of up to {longest} s | `compensated` |\n",
        suites = motions * start_points,
    );
    let mut lines = if *motions == 0 { String::new() } else { suites };
    let motor = [
        (
            "rest",
            *rest,
            "static poses, 20 in a recording: the arm rests twice at each position, and each joint \
             comes from the other side the second time",
        ),
        (
            "one-joint",
            *one_joint,
            "recordings for each joint, which moves back and forth with peak speeds of 0.2, 0.5 \
             and 1 rad/s",
        ),
        ("excitation", options.excitation, "exciting motions of all joints, 20 s each"),
        ("validation", options.validation, "more exciting motions"),
    ];
    for (folder, count, what) in motor.into_iter().filter(|(_, count, _)| *count > 0) {
        lines += &format!("| `{folder}/` | {count} {what} | `motor` |\n");
    }
    lines
}

fn parameters(options: &CampaignOptions) -> String {
    let parameters = serde_json::to_value(&options.robot).expect("parameters are numbers");
    let line = |(name, value): (&String, &Value)| format!("| `{name}` | {value} |\n");
    parameters.as_object().into_iter().flatten().map(line).collect()
}
