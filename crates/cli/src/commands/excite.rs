//! `reachtube excite`: an exciting motion within the joint limits.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;
use reachtube::write;
use reachtube_robot::{Criterion, Excitation, ExcitationSettings, Parameter, ParameterKind, Robot};
use serde_json::json;

use crate::error::Result;
use crate::lock_arguments::LockArguments;
use crate::option_values::{hertz, seconds};
use crate::outcome::Outcome;
use crate::output;
use reachtube::number::four_decimals;

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
pub struct Arguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    #[arg(long)]
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Period of the motion, above 0 s
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "10")]
    pub period: f64,
    /// Number of harmonics of each joint
    #[arg(long, default_value_t = 5, value_name = "COUNT")]
    pub harmonics: usize,
    /// Largest acceleration in rad/s^2: one number for all joints, or one per joint [default: no
    /// limit]
    #[arg(long, value_delimiter = ',', value_name = "A,..")]
    pub acceleration: Vec<f64>,
    /// Largest speed of joints without a speed limit, rad/s
    #[arg(long, default_value_t = 1.0, value_name = "SPEED")]
    pub speed: f64,
    /// Minimise the condition number of the base regressor, instead of maximising the determinant
    /// of its information matrix
    #[arg(long)]
    pub condition: bool,
    /// Sample rate of the CSV file, above 0 Hz
    #[arg(long, value_name = "HZ", value_parser = hertz, default_value = "100")]
    pub rate: f64,
    /// Seed of the search; the same seed gives the same motion
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// CSV file for one period of the motion: columns t, q, qd, qdd in s and rad, or m for
    /// prismatic joints
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

pub fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    write::try_at(&args.out)?;
    let n = robot.joint_count();
    let found = robot.excitation(&parameters(n), &settings(args))?;
    let text = csv(&found, n, args.rate);
    write::atomically(&args.out, |out| out.write_all(text.as_bytes()))?;
    output::wrote(&args.out);
    let values = json!({
        "condition": found.quality.condition,
        "condition_before": found.initial_quality.condition,
        "period": args.period,
    });
    output::show(json, &values, || summary(&found, &robot))?;
    Ok(Outcome::Done)
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
        let [low, high] = found.trajectory.position_range(j);
        let speed = found.trajectory.speed_bound(j);
        let (unit, speed_unit) = (joint.kind.position_unit(), joint.kind.velocity_unit());
        let _ = writeln!(
            text,
            "  {}: {low:.3} to {high:.3} {unit}, at most {speed:.3} {speed_unit}",
            joint.name
        );
    }
    text.push_str(
        "The motion keeps within the joint limits only. Check that the arm hits neither itself \
         nor its\nsurroundings before you run it.\n",
    );
    text
}

/// Returns one period as CSV with the columns t, q1..qn, qd1..qdn, qdd1..qddn.
fn csv(found: &Excitation, joints: usize, rate: f64) -> String {
    let names = |prefix: &str| (1..=joints).map(|i| format!(",{prefix}{i}")).collect::<String>();
    let mut text = format!("t{}{}{}\n", names("q"), names("qd"), names("qdd"));
    for sample in found.trajectory.samples(rate) {
        let _ = write!(text, "{:.6}", sample.t);
        for value in sample.q.iter().chain(&sample.qd).chain(&sample.qdd) {
            let _ = write!(text, ",{value:.7}");
        }
        text.push('\n');
    }
    text
}
