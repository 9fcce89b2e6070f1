//! `reachtube excite`: an exciting motion within the joint limits.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use reachtube::write;
use reachtube_robot::{Criterion, Excitation, ExcitationSettings, Parameter, ParameterKind, Robot};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::lock_arguments::LockArguments;
use crate::option_values::{hertz, seconds};
use crate::outcome::Outcome;
use crate::output;
use reachtube::number::{at_least, four_decimals, outward};

const HELP: &str = "\
Example:
  reachtube excite --robot arm.urdf --period 20 --acceleration 4 --out excitation.csv

The motion keeps within the joint limits only. Check that the arm hits neither itself nor its
surroundings before you run it.";

/// Design a motion that excites a robot's parameters, within its joint limits
///
/// Each joint follows a Fourier series that starts and ends at rest.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Period of the motion, above 0 s
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "10")]
    pub period: f64,
    /// Number of harmonics of each joint
    #[arg(
        long, hide_short_help = true,
        default_value = "5",
        value_name = "COUNT",
        value_parser = RangedU64ValueParser::<usize>::new().range(1..=MOST_HARMONICS)
    )]
    pub harmonics: usize,
    /// Largest acceleration in rad/s^2, for all joints or each [default: no limit]
    #[arg(long, value_delimiter = ',', value_name = "A,..")]
    pub acceleration: Vec<f64>,
    /// Largest speed of joints without a speed limit, rad/s
    #[arg(long, default_value_t = 1.0, value_name = "SPEED")]
    pub speed: f64,
    /// Minimise the condition number, not the determinant of the information matrix
    #[arg(long, hide_short_help = true)]
    pub condition: bool,
    /// Sample rate of the CSV file, above 0 Hz
    #[arg(long, value_name = "HZ", value_parser = hertz, default_value = "100")]
    pub rate: f64,
    /// Largest number of samples of the CSV file
    #[arg(long, hide_short_help = true, value_name = "COUNT", default_value_t = 1_000_000)]
    pub most_samples: u64,
    /// Seed of the search
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// CSV file for one period: columns t, q, qd, qdd in s and rad, or m
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// Largest number of harmonics: the search holds a regressor for 20 samples of each.
const MOST_HARMONICS: u64 = 1000;

/// Usual length of one number in the CSV file with its comma, bytes.
const BYTES_PER_VALUE: f64 = 11.0;

/// The result of `excite`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ExciteOutput {
    /// Condition number of the base regressor along the motion.
    #[schemars(with = "Option<f64>")]
    condition: f64,
    /// Condition number before the search.
    #[schemars(with = "Option<f64>")]
    condition_before: f64,
    /// Period of the motion, s.
    period: f64,
}

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    output::claim(&args.out)?;
    let n = robot.joint_count();
    check_size(args, n)?;
    let found = robot.excitation(&parameters(n), &settings(args))?;
    write::atomically(&args.out, |out| write_csv(out, &found, n, args.rate))?;
    output::wrote(&args.out);
    let values = ExciteOutput {
        condition: found.quality.condition,
        condition_before: found.initial_quality.condition,
        period: args.period,
    };
    output::show(json, &values, || summary(&found, &robot))?;
    Ok(Outcome::Done)
}

/// Refuses a file that is larger than was meant, before the search.
fn check_size(args: &Arguments, joints: usize) -> Result<()> {
    let samples = (args.period * args.rate).ceil() + 1.0;
    if samples <= args.most_samples as f64 {
        return Ok(());
    }
    let Arguments { period, rate, most_samples, .. } = args;
    let megabytes = samples * (1 + 3 * joints) as f64 * BYTES_PER_VALUE / 1e6;
    Err(Error::setting(format!(
        "--period {period} s at --rate {rate} Hz gives {samples:.0} samples, about {megabytes:.0} \
         MB of CSV, but at most {most_samples} are allowed; shorten the period, lower the rate, or \
         allow more with --most-samples"
    )))
}

fn settings(args: &Arguments) -> ExcitationSettings {
    ExcitationSettings {
        period: args.period,
        harmonics: args.harmonics,
        criterion: if args.condition { Criterion::Condition } else { Criterion::LogDeterminant },
        acceleration: args.acceleration.clone(),
        speed: args.speed,
        seed: args.seed,
        ..ExcitationSettings::default()
    }
}

/// Returns the parameters to excite: inertia of links and motors, and friction.
fn parameters(joints: usize) -> Vec<Parameter> {
    let motor_and_friction = [
        ParameterKind::MotorInertia,
        ParameterKind::Coulomb,
        ParameterKind::Offset,
        ParameterKind::Viscous1,
    ];
    [
        Parameter::of_joints(joints, &ParameterKind::INERTIAL),
        Parameter::of_joints(joints, &motor_and_friction),
    ]
    .concat()
}

fn summary(found: &Excitation, robot: &Robot) -> String {
    let mut text = format!(
        "condition number of the base regressor {} (random motion: {}); log determinant of its \
         information matrix {} (random motion: {})\n",
        four_decimals(found.quality.condition),
        four_decimals(found.initial_quality.condition),
        four_decimals(found.quality.log_determinant),
        four_decimals(found.initial_quality.log_determinant)
    );
    for (j, joint) in robot.joints().iter().enumerate() {
        let [low, high] = outward(found.trajectory.position_range(j), 3);
        let speed = at_least(found.trajectory.speed_bound(j));
        let (unit, speed_unit) = (joint.kind.position_unit(), joint.kind.velocity_unit());
        let _ = writeln!(
            text,
            "  {}: {low} to {high} {unit}, at most {speed} {speed_unit}",
            joint.name
        );
    }
    text.push_str(
        "The motion keeps within the joint limits only. Check that the arm hits neither itself \
         nor its\nsurroundings before you run it.\n",
    );
    text
}

/// Writes one period as CSV with the columns t, q1..qn, qd1..qdn, qdd1..qddn.
fn write_csv(
    out: &mut dyn std::io::Write,
    found: &Excitation,
    joints: usize,
    rate: f64,
) -> std::io::Result<()> {
    let names = |prefix: &str| (1..=joints).map(|i| format!(",{prefix}{i}")).collect::<String>();
    writeln!(out, "t{}{}{}", names("q"), names("qd"), names("qdd"))?;
    for sample in found.trajectory.samples(rate) {
        write!(out, "{:.6}", sample.t)?;
        for value in sample.q.iter().chain(&sample.qd).chain(&sample.qdd) {
            write!(out, ",{value:.7}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}
