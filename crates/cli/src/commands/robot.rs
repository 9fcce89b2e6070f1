//! `reachtube robot`: how a robot's description is understood.

use clap::{Args, Subcommand};
use nalgebra::DMatrix;
use reachtube::abstraction::ExpansionPoint;
use reachtube_robot::{Joint, JointDescription, Physicality, Robot};
use serde_json::json;

use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;
use crate::table::table;
use reachtube::number::{fixed, six_digits};

/// Show how reachtube understands a robot's description
#[derive(Debug, Subcommand)]
pub enum RobotCommand {
    Show(ShowArguments),
}

const SHOW_HELP: &str = "\
Examples:
  reachtube robot show arm.toml
  reachtube robot show lwa4p --at 0,0.5,0,0,0,0";

/// Print a robot's geometry, inertia, friction and mass matrix
///
/// The command fails for a robot that cannot exist: one whose mass matrix is not positive definite.
#[derive(Debug, Args)]
#[command(after_help = SHOW_HELP)]
pub struct ShowArguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    pub robot: String,
    /// Positions q_a of the mass matrix M(q_a), one per joint in rad, separated by commas
    /// [default: 0]
    #[arg(long, value_name = "Q,..", value_delimiter = ',', allow_hyphen_values = true)]
    pub at: Vec<f64>,
}

/// Runs `robot show`.
pub fn show(args: &ShowArguments, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    let joints = robot.joint_count();
    if !args.at.is_empty() && args.at.len() != joints {
        return Err(Error::PositionCount { given: args.at.len(), joints });
    }
    let at = ExpansionPoint::from_values(&args.at, joints)?;
    let physicality = robot.check_physical()?;
    let mass = robot.mass_matrix(&at.q);
    let physical = physicality_sentence(&physicality, &robot);
    let rows: Vec<Vec<f64>> = mass.row_iter().map(|row| row.iter().copied().collect()).collect();
    let values = json!({
        "description": robot.description(),
        "physical": physical,
        "q": at.q,
        "mass_matrix": rows,
        "gravity_torque": robot.gravity_torque(&at.q).as_slice(),
    });
    output::show(json, &values, || {
        format!("{}{}\n{physical}\n", description(&robot), dynamics(&robot, &at.q, &mass))
    })?;
    Ok(Outcome::Done)
}

/// Returns the tables of joints and links.
fn description(robot: &Robot) -> String {
    let [gx, gy, gz] = robot.gravity_acceleration();
    let joint_header = [
        "joint",
        "limits [rad]",
        "speed [rad/s]",
        "gear ratio",
        "motor inertia [kg m^2]",
        "viscous v1, v2, v3",
    ];
    let joints: Vec<_> = robot.joints().iter().map(joint_row).collect();
    let link_header = [
        "joint",
        "geometry [m, rad]",
        "mass [kg]",
        "mass x centre [kg m]",
        "inertia xx xy xz yy yz zz [kg m^2]",
        "Coulomb a1..a8",
    ];
    let links: Vec<_> = robot.description().joints.iter().map(link_row).collect();
    format!(
        "{}: {} revolute joints, gravity [{gx}, {gy}, {gz}] m/s^2\n\n{}\nlinks and Coulomb \
         friction\n{}",
        robot.name(),
        robot.joint_count(),
        table(&joint_header, &joints),
        table(&link_header, &links)
    )
}

/// Returns the mass matrix and the gravity torque at `q` (n, rad).
fn dynamics(robot: &Robot, q: &[f64], mass: &DMatrix<f64>) -> String {
    let line = |values: &mut dyn Iterator<Item = &f64>| {
        let cells: Vec<String> = values.map(|value| format!("{:>9}", fixed(*value, 5))).collect();
        format!("  {}\n", cells.join(" "))
    };
    let rows: String = mass.row_iter().map(|row| line(&mut row.iter())).collect();
    format!(
        "\nM(q_a) with motors [kg m^2], q_a = {q:?} rad:\n{rows}g(q_a) [N m]:\n{}",
        line(&mut robot.gravity_torque(q).iter())
    )
}

fn joint_row(joint: &Joint) -> Vec<String> {
    let viscous = &joint.friction.viscous;
    let maybe = |value: Option<f64>| value.map_or_else(|| "-".into(), |value| format!("{value}"));
    vec![
        joint.name.clone(),
        format!("[{:.3}, {:.3}]", joint.position_limits[0], joint.position_limits[1]),
        maybe(joint.velocity_limit),
        maybe(joint.gear_ratio),
        format!("{:.5}", joint.armature),
        [viscous.v1, viscous.v2, viscous.v3].map(six_digits).join(", "),
    ]
}

/// Returns a table row about a link and the Coulomb friction of its joint.
fn link_row(joint: &JointDescription) -> Vec<String> {
    let moment = match (joint.first_moment, joint.com) {
        (Some(moment), _) => moment,
        (None, com) => com.unwrap_or_default().map(|c| joint.mass * c),
    };
    let coulomb = &joint.friction.coulomb;
    let coulomb = if coulomb.iter().all(|a| *a == 0.0) { "0".into() } else { list(coulomb) };
    vec![
        joint.name.clone(),
        geometry(joint),
        six_digits(joint.mass),
        list(&moment),
        list(&joint.inertia),
        coulomb,
    ]
}

/// Describes the frame of a joint by its DH parameters, or by its placement and axis.
fn geometry(joint: &JointDescription) -> String {
    if let Some(dh) = joint.dh {
        return format!("a {} alpha {:.4} theta {:.4} d {}", dh.a, dh.alpha, dh.theta, dh.d);
    }
    let placement = joint.placement.unwrap_or_default();
    let rotation = match placement.rotation {
        Some(_) => "rotated,".into(),
        None => format!("rpy {}", list(&placement.rpy.unwrap_or_default())),
    };
    let axis = list(&joint.axis.unwrap_or([0.0, 0.0, 1.0]));
    format!("at {} {rotation} axis {axis}", list(&placement.translation))
}

fn list(values: &[f64]) -> String {
    values.iter().map(|value| six_digits(*value)).collect::<Vec<_>>().join(" ")
}

/// Reports why the robot counts as physical; `--json` prints the same sentence.
fn physicality_sentence(physicality: &Physicality, robot: &Robot) -> String {
    match physicality {
        Physicality::Links { least_pivot } => format!(
            "physical: the mass matrix is positive definite everywhere, proved link by link; \
             no joint has less than {least_pivot:.3e} kg m^2"
        ),
        Physicality::Searched { positions, joint, pivot, q } => format!(
            "no sign of an unphysical robot: the mass matrix is positive definite at {positions} \
             positions searched (no proof); least {pivot:.4} kg m^2 about {} at q = {q:.3?}",
            robot.joints()[*joint].name
        ),
    }
}
