//! `reachtube robot`: how a robot's description is understood.

use std::fmt::Write;

use clap::{Args, Subcommand};
use nalgebra::DMatrix;
use reachtube::abstraction::ExpansionPoint;
use reachtube_robot::{Joint, JointDescription, Physicality, Robot};
use serde_json::json;

use crate::error::{Error, Result};
use crate::numbers::{digits, fixed};
use crate::outcome::Outcome;
use crate::output;
use crate::table::table;

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

pub fn show(args: &ShowArguments, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    let joints = robot.joint_count();
    if !args.at.is_empty() && args.at.len() != joints {
        return Err(Error::PositionCount { given: args.at.len(), joints });
    }
    let at = ExpansionPoint::from_values(&args.at, joints)?;
    let physicality = robot.check_physical()?;
    let mass = robot.mass_matrix(&at.q);
    if json {
        output::print_json(&json!({
            "description": robot.description(),
            "physical": physicality_words(&physicality, &robot),
            "q": at.q,
            "mass_matrix": mass.row_iter().map(|row| row.iter().copied().collect::<Vec<_>>()).collect::<Vec<_>>(),
            "gravity_torque": robot.gravity_torque(&at.q).as_slice(),
        }))?;
    } else {
        output::print(&describe(&robot, &at.q, &mass, &physicality))?;
    }
    Ok(Outcome::Done)
}

fn describe(robot: &Robot, q: &[f64], mass: &DMatrix<f64>, physicality: &Physicality) -> String {
    let mut text = String::new();
    let [gx, gy, gz] = robot.gravity_acceleration();
    let _ = writeln!(
        text,
        "{}: {} revolute joints, gravity [{gx}, {gy}, {gz}] m/s^2\n",
        robot.name(),
        robot.joint_count()
    );
    let rows: Vec<Vec<String>> = robot.joints().iter().map(joint_row).collect();
    let header = [
        "joint",
        "limits [rad]",
        "speed [rad/s]",
        "gear",
        "motor inertia [kg m^2]",
        "viscous v1, v2, v3",
    ];
    text.push_str(&table(&header, &rows));
    text.push_str("\nlinks, and Coulomb friction\n");
    let rows: Vec<Vec<String>> = robot.description().joints.iter().map(link_row).collect();
    let header = [
        "joint",
        "geometry [m, rad]",
        "mass [kg]",
        "mass x centre [kg m]",
        "inertia xx xy xz yy yz zz [kg m^2]",
        "Coulomb a1..a8",
    ];
    text.push_str(&table(&header, &rows));
    let _ = writeln!(text, "\nM(q_a) with motors [kg m^2], q_a = {q:?} rad:");
    for row in mass.row_iter() {
        let cells: Vec<String> = row.iter().map(|m| format!("{:>9}", fixed(*m, 5))).collect();
        let _ = writeln!(text, "  {}", cells.join(" "));
    }
    let gravity: Vec<String> =
        robot.gravity_torque(q).iter().map(|g| format!("{:>9}", fixed(*g, 5))).collect();
    let _ = writeln!(text, "g(q_a) [N m]:\n  {}", gravity.join(" "));
    let _ = writeln!(text, "\n{}", physicality_words(physicality, robot));
    text
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
        [viscous.v1, viscous.v2, viscous.v3].map(digits).join(", "),
    ]
}

/// What the description says of the link and its friction.
fn link_row(joint: &JointDescription) -> Vec<String> {
    let list =
        |values: &[f64]| values.iter().map(|value| digits(*value)).collect::<Vec<_>>().join(" ");
    let moment = match (joint.first_moment, joint.com) {
        (Some(moment), _) => moment,
        (None, com) => com.unwrap_or_default().map(|c| joint.mass * c),
    };
    let geometry = match (joint.dh, joint.placement) {
        (Some(dh), _) => {
            format!("a {} alpha {:.4} theta {:.4} d {}", dh.a, dh.alpha, dh.theta, dh.d)
        }
        (None, placement) => {
            let placement = placement.unwrap_or_default();
            let axis = list(&joint.axis.unwrap_or([0.0, 0.0, 1.0]));
            match (placement.rotation, placement.rpy) {
                (Some(_), _) => format!("at {} turned, axis {axis}", list(&placement.translation)),
                (None, rpy) => {
                    format!(
                        "at {} rpy {} axis {axis}",
                        list(&placement.translation),
                        list(&rpy.unwrap_or_default())
                    )
                }
            }
        }
    };
    let coulomb = &joint.friction.coulomb;
    let coulomb = if coulomb.iter().all(|a| *a == 0.0) { "0".into() } else { list(coulomb) };
    vec![
        joint.name.clone(),
        geometry,
        digits(joint.mass),
        list(&moment),
        list(&joint.inertia),
        coulomb,
    ]
}

fn physicality_words(physicality: &Physicality, robot: &Robot) -> String {
    match physicality {
        Physicality::Links { least_pivot } => format!(
            "physical: the mass matrix is positive definite everywhere, proved link by link; no joint has less than {least_pivot:.3e} kg m^2"
        ),
        Physicality::Searched { positions, joint, pivot, q } => format!(
            "no sign of an unphysical robot: the mass matrix is positive definite at {positions} positions searched (no proof); \
             least {pivot:.4} kg m^2 about {} at q = {q:.3?}",
            robot.joints()[*joint].name
        ),
    }
}
