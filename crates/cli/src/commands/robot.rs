//! `reachtube robot`: how a robot's description is understood.

use clap::{Args, Subcommand};
use nalgebra::DMatrix;
use reachtube_robot::{
    Joint, JointDescription, JointKind, LockedJoint, Physicality, Robot, RobotDescription,
};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::{Error, Result};
use crate::expansion::expansion_point;
use crate::lock_arguments::LockArguments;
use crate::outcome::Outcome;
use crate::output;
use reachtube::finding::{Table, Units};
use reachtube::number::{fixed, plural, six_digits};

const HELP: &str = "\
Example:
  reachtube robot show arm.toml";

/// Show how reachtube understands a robot's description
#[derive(Debug, Subcommand)]
#[command(after_help = HELP)]
pub(crate) enum RobotCommand {
    Show(ShowArguments),
}

const SHOW_HELP: &str = "\
Examples:
  reachtube robot show arm.toml
  reachtube robot show lwa4p --expansion 0,0.5,0,0,0,0
  reachtube robot show panda.urdf --lock panda_finger_joint1=0.02";

/// Print a robot's geometry, inertia, friction and mass matrix
///
/// The command fails for a robot that cannot exist: one whose mass matrix is not positive definite.
#[derive(Debug, Args)]
#[command(after_help = SHOW_HELP)]
pub(crate) struct ShowArguments {
    /// Robot: the embedded lwa4p, or a TOML or URDF file
    pub robot: String,
    #[command(flatten)]
    pub lock: LockArguments,
    /// Positions q_a of the mass matrix M(q_a), one per joint [default: 0]
    #[arg(long, value_name = "Q,..", value_delimiter = ',', allow_hyphen_values = true)]
    pub expansion: Vec<f64>,
}

/// The result of `robot show`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct RobotOutput<'a> {
    /// The robot, as in a model file.
    description: &'a RobotDescription,
    /// Whether its links can exist, in words.
    physical: &'a str,
    /// The positions of mass matrix and torque, n, rad or m.
    q: &'a [f64],
    /// The mass matrix, by rows.
    mass_matrix: Vec<Vec<f64>>,
    /// The torque that gravity asks for, n, N m or N.
    gravity_torque: Vec<f64>,
}

/// Runs `robot show`.
pub(crate) fn show(args: &ShowArguments, json: bool) -> Result<Outcome> {
    let robot = args.lock.load(&args.robot)?;
    let joints = robot.joint_count();
    if !args.expansion.is_empty() && args.expansion.len() != joints {
        let unit = JointKind::column(&robot.kinds(), JointKind::position_unit).list();
        let given = args.expansion.len();
        return Err(Error::setting(format!(
            "--expansion lists {given}; give {joints} positions in {unit}, one per joint"
        )));
    }
    let at = expansion_point(&args.expansion, &robot)?;
    let physicality = robot.check_physical()?;
    output::warnings(&robot.joints().iter().filter_map(driving_friction).collect::<Vec<_>>());
    let mass = robot.mass_matrix(&at.q);
    let physical = physicality_sentence(&physicality, &robot);
    let rows: Vec<Vec<f64>> = mass.row_iter().map(|row| row.iter().copied().collect()).collect();
    let values = RobotOutput {
        description: robot.description(),
        physical: &physical,
        q: &at.q,
        mass_matrix: rows,
        gravity_torque: robot.gravity_torque(&at.q).as_slice().to_vec(),
    };
    output::show(json, &values, || {
        format!("{}{}\n{physical}\n", description(&robot), dynamics(&robot, &at.q, &mass))
    })?;
    Ok(Outcome::Done)
}

/// Returns the warning that friction drives a joint, if it does.
fn driving_friction(joint: &Joint) -> Option<String> {
    let velocity = joint.friction_drives_at()?;
    Some(format!(
        "joint `{}`: friction drives it without load at {} {}; correct the signs of `coulomb` and \
         `viscous`, or lower `velocity_limit`",
        joint.name,
        six_digits(velocity),
        joint.kind.velocity_unit()
    ))
}

/// Returns the tables of joints and links.
fn description(robot: &Robot) -> String {
    let [gx, gy, gz] = robot.gravity_acceleration();
    let units = [JointKind::position_unit, JointKind::velocity_unit, JointKind::inertia_unit];
    let units = units.map(|unit| JointKind::column(&robot.kinds(), unit));
    let [limits, speed, inertia] = &units;
    let joint_header = [
        "joint",
        &limits.head("limits"),
        &speed.head("speed"),
        "gear ratio",
        &inertia.head("motor inertia"),
        "viscous v1, v2, v3",
    ];
    let row = |(i, joint): (usize, &Joint)| joint_row(joint, &units.each_ref().map(|u| (u, i)));
    let joints: Vec<_> = robot.joints().iter().enumerate().map(row).collect();
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
        "{}: {}, gravity [{gx}, {gy}, {gz}] m/s^2\n{}\n{}\nlinks and Coulomb friction\n{}",
        robot.name(),
        joint_counts(robot),
        locked(robot),
        Table::new(joint_header, joints),
        Table::new(link_header, links)
    )
}

fn joint_counts(robot: &Robot) -> String {
    let kinds = robot.kinds();
    let count = |kind: JointKind| {
        let count = kinds.iter().filter(|own| **own == kind).count();
        (count > 0).then(|| format!("{count} {kind} {}", plural(count, "joint")))
    };
    let counts = [JointKind::Revolute, JointKind::Prismatic].into_iter().filter_map(count);
    counts.collect::<Vec<_>>().join(" and ")
}

fn locked(robot: &Robot) -> String {
    let held = |joint: &LockedJoint| {
        format!("{} = {} {}", joint.name, six_digits(joint.position), joint.kind.position_unit())
    };
    let held: Vec<_> = robot.description().locked.iter().map(held).collect();
    if held.is_empty() { String::new() } else { format!("locked: {}\n", held.join(", ")) }
}

/// Returns the mass matrix and the gravity torque at `q` (n, rad or m).
fn dynamics(robot: &Robot, q: &[f64], mass: &DMatrix<f64>) -> String {
    let line = |values: &mut dyn Iterator<Item = &f64>| {
        let cells: Vec<String> = values.map(|value| format!("{:>9}", fixed(*value, 5))).collect();
        format!("  {}\n", cells.join(" "))
    };
    let kinds = robot.kinds();
    let rows: String = mass.row_iter().map(|row| line(&mut row.iter())).collect();
    format!(
        "\nM(q_a) with motors [{}], q_a = {q:?} {}:\n{rows}g(q_a) [{}]:\n{}",
        JointKind::column(&kinds, JointKind::inertia_unit).shared().unwrap_or("kg m^2, kg m, kg"),
        JointKind::column(&kinds, JointKind::position_unit).list(),
        JointKind::column(&kinds, JointKind::force_unit).list().trim_matches(['(', ')']),
        line(&mut robot.gravity_torque(q).iter())
    )
}

/// Returns a table row about a joint. `units` has the units of limits, speed and motor inertia.
fn joint_row(joint: &Joint, units: &[(&Units, usize); 3]) -> Vec<String> {
    let with_unit = |k: usize, text: String| units[k].0.cell(units[k].1, text);
    let viscous = &joint.friction.viscous;
    vec![
        joint.name.clone(),
        with_unit(0, format!("[{:.3}, {:.3}]", joint.position_limits[0], joint.position_limits[1])),
        joint.velocity_limit.map_or_else(|| "-".into(), |speed| with_unit(1, format!("{speed}"))),
        joint.gear_ratio.map_or_else(|| "-".into(), |ratio| format!("{ratio}")),
        with_unit(2, format!("{:.5}", joint.armature)),
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
        match joint.kind {
            JointKind::Revolute => geometry(joint),
            JointKind::Prismatic => format!("prismatic, {}", geometry(joint)),
        },
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
             no joint has less than {least_pivot:.3e} {}",
            JointKind::column(&robot.kinds(), JointKind::inertia_unit).any()
        ),
        Physicality::Searched { positions, joint, pivot, q } => format!(
            "no sign of an unphysical robot: the mass matrix is positive definite at {positions} \
             positions searched (no proof); least {pivot:.4} {} about {} at q = {q:.3?}",
            robot.joints()[*joint].kind.inertia_unit(),
            robot.joints()[*joint].name
        ),
    }
}
