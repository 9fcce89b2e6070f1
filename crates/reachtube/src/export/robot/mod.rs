//! An identified robot as simulators read it.
//!
//! [`mjcf_files`] is for MuJoCo and [`urdf_files`] for everything else. Both have the robot's
//! inverse dynamics. Their friction is one viscous coefficient, the best line over the recorded
//! velocities, and one Coulomb magnitude at no load; MuJoCo has cubic friction exactly. Links that
//! cannot exist, as links from base parameters, are replaced by bodies with the same torques, or
//! refused if none were found.

mod attributes;
mod bodies;
mod mjcf;
mod urdf;

use std::fmt::Write;
use std::path::Path;

use reachtube_robot::{Lock, Robot};

pub(super) use bodies::{Body, bodies};
use mjcf::{Damping, mjcf};
use urdf::{UrdfFiles, updated_urdf, urdf};

use super::text::numbers;
use super::{ExportError, ExportFile};
use crate::export::draws::Draws;

/// Number of states in the table of torques.
const CHECK_STATES: usize = 1000;

/// Returns `robot.xml` for MuJoCo and `check_torques.csv`; where damping is a polynomial, also
/// `robot_linear.xml` with lines, since Drake and Pinocchio read one number per joint.
///
/// # Errors
///
/// [`ExportError::SeparateGravity`] where gravity acts on masses of its own, and
/// [`ExportError::NotPhysical`] where no bodies have its torques: MuJoCo refuses both.
pub fn mjcf_files(robot: &Robot) -> Result<Vec<ExportFile>, ExportError> {
    let mut files = vec![
        ExportFile::new("robot.xml", mjcf(robot, Damping::Polynomial)?),
        ExportFile::new("check_torques.csv", check_torques(robot)),
    ];
    if mjcf::is_curved(robot) {
        files.push(ExportFile::new("robot_linear.xml", mjcf(robot, Damping::Line)?));
    }
    Ok(files)
}

/// Returns `robot.urdf`, `robot.toml` with the parts that URDF lacks, and `check_torques.csv`.
///
/// # Errors
///
/// As [`mjcf_files`].
pub fn urdf_files(robot: &Robot) -> Result<Vec<ExportFile>, ExportError> {
    Ok(of_urdf(robot, urdf(robot)?))
}

/// Returns the files of [`urdf_files`], where `robot.urdf` is the URDF at `path` with the inertia
/// and friction of the robot.
///
/// # Errors
///
/// As [`urdf_files`]; [`ExportError::Robot`] for a URDF that cannot be read or has other joints,
/// and [`ExportError::OtherGeometry`] if its links lie elsewhere.
pub fn updated_urdf_files(
    robot: &Robot,
    path: &Path,
    locks: &[Lock],
) -> Result<Vec<ExportFile>, ExportError> {
    Ok(of_urdf(robot, updated_urdf(robot, path, locks)?))
}

fn of_urdf(robot: &Robot, UrdfFiles { urdf, companion }: UrdfFiles) -> Vec<ExportFile> {
    vec![
        ExportFile::new("robot.urdf", urdf),
        ExportFile::new("robot.toml", companion),
        ExportFile::new("check_torques.csv", check_torques(robot)),
    ]
}

/// Returns a table of random states with the torques of the robot without friction, to check a
/// simulator with: `q1,..,qd1,..,qdd1,..,tau1,..`, n of each.
fn check_torques(robot: &Robot) -> String {
    let n = robot.joint_count();
    let names = ["q", "qd", "qdd", "tau"].iter();
    let names = names.flat_map(|name| (1..=n).map(move |j| format!("{name}{j}")));
    let mut text = names.collect::<Vec<_>>().join(",") + "\n";
    let mut draws = Draws::seeded(3);
    let mut draw = |radius: f64| draws.vector(n, radius);
    for _ in 0..CHECK_STATES {
        let (q, qd, qdd) = (draw(3.0), draw(2.0), draw(5.0));
        let tau = robot.inverse_dynamics(&q, &qd, &qdd);
        let row = [q.as_slice(), &qd, &qdd, tau.as_slice()].concat();
        let _ = writeln!(text, "{}", numbers(row, ","));
    }
    text
}
