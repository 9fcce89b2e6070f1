//! The links as a file of the shield has them.

use std::fmt::Write;

use nalgebra::{Matrix3, Vector3};
use reachtube_robot::{JointGeometry, Placement, Robot};
use reachtube_verify::{Body, Capsules};

use super::file::ShieldFile;
use super::yaml::Yaml;
use crate::export::ExportError;
use crate::export::draws::Draws;
use crate::export::text::numbers;

/// Largest difference between a rotation in the file and a rotation matrix.
const ROUNDED: f64 = 1e-6;

/// Largest difference of the joints' axes of two descriptions of one arm: of the cosine between two
/// axes, and of their distance \[m\].
const SAME_ARM: f64 = 0.01;

/// Two axes are parallel if the sine between them is below this.
const PARALLEL: f64 = 1e-3;

/// Number of random positions at which the axes are compared.
const POSITIONS: usize = 20;

/// The kinematics and capsules of a file.
pub(super) struct LinkFile {
    robot: Robot,
    capsules: Capsules,
}

impl LinkFile {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// [`ExportError::Refused`] for what cannot be read, and for another arm than `robot`.
    pub(super) fn read(file: &ShieldFile, robot: &Robot) -> Result<Self, ExportError> {
        let (yaml, n) = (Yaml::new(file), robot.joint_count());
        let matrices = yaml.numbers("transformation_matrices", 16 * n)?;
        let mut joints = String::from("schema_version = 1\nname = \"shield\"\n");
        for (entries, joint) in matrices.chunks_exact(16).zip(robot.joints()) {
            let placement = placement(entries)
                .ok_or_else(|| refused(file, &joint.name, "its matrix has no rotation"))?;
            let r = &placement.rotation;
            let row = |i: usize| numbers([r[(i, 0)], r[(i, 1)], r[(i, 2)]], ", ");
            let _ = write!(
                joints,
                "[[joint]]\nname = {:?}\nplacement = {{ rotation = [[{}], [{}], [{}]], \
                 translation = [{}] }}\nmass = 1.0\ninertia = [1.0, 0.0, 0.0, 1.0, 0.0, 1.0]\n",
                joint.name,
                row(0),
                row(1),
                row(2),
                numbers(placement.translation.iter().copied(), ", ")
            );
        }
        let own = Robot::from_toml(&joints, &file.name)?;
        if let Some(joint) = first_difference(robot, &own) {
            let problem = "its axis lies elsewhere than the model's, at the same q";
            return Err(refused(file, &robot.joints()[joint].name, problem));
        }
        let mut capsules = String::new();
        for (j, c) in yaml.numbers("enclosures", 7 * n)?.chunks_exact(7).enumerate() {
            let [from, to] = [&c[..3], &c[3..6]].map(|end| numbers(end.iter().copied(), ", "));
            let _ = writeln!(
                capsules,
                "[[capsule]]\nlink = {}\nfrom = [{from}]\nto = [{to}]\nradius = {:?}",
                j + 1,
                c[6]
            );
        }
        let capsules = Capsules::from_toml(&capsules, &file.name, &own)
            .map_err(|error| yaml.error(0, "enclosures", error.to_string()))?;
        Ok(Self { robot: own, capsules })
    }

    pub(super) fn body(&self) -> Body {
        Body::new(&self.robot, &self.capsules)
    }
}

fn refused(file: &ShieldFile, joint: &str, problem: &str) -> ExportError {
    ExportError::Refused {
        place: format!("{}: joint {joint}", file.name),
        problem: problem.into(),
        remedy: "name the file that belongs to this robot".into(),
    }
}

/// Returns the placement of a homogeneous matrix, row by row, whose rotation may be rounded.
fn placement(entries: &[f64]) -> Option<Placement> {
    let entry = |i: usize, j: usize| entries[4 * i + j];
    let given = Matrix3::from_fn(entry);
    let is_whole = given.iter().all(|x| *x == 0.0 || x.abs() == 1.0);
    let svd = given.svd(true, true);
    let nearest = svd.u? * svd.v_t?;
    let error = (nearest - given).amax();
    let is_rotation = error < ROUNDED && nearest.determinant() > 0.0;
    let rotation = if is_whole { given } else { nearest };
    let translation = Vector3::new(entry(0, 3), entry(1, 3), entry(2, 3));
    is_rotation.then_some(Placement { rotation, translation })
}

/// Returns the first joint whose axis lies otherwise to those before it in two robots at the same
/// positions. The base may lie anywhere, and each frame may be turned about its axis or shifted
/// along it.
fn first_difference(robot: &Robot, other: &Robot) -> Option<usize> {
    let n = robot.joint_count();
    let mut draws = Draws::seeded(5);
    let positions: Vec<Vec<f64>> = (0..POSITIONS).map(|_| draws.vector(n, 3.0)).collect();
    let differs = |joint: usize| {
        positions.iter().any(|q| {
            let [ours, theirs] = [robot, other].map(|robot| axes(robot, q));
            (0..joint).any(|i| {
                let [a, b] = [&ours, &theirs].map(|axes| relation(&axes[i], &axes[joint]));
                (a[0] - b[0]).abs() > SAME_ARM || (a[1] - b[1]).abs() > SAME_ARM
            })
        })
    };
    (1..n).find(|joint| differs(*joint))
}

/// A line in space: a point, and a unit vector along it.
type Line = [Vector3<f64>; 2];

/// Returns the joints' axes at `q`, in the base.
fn axes(robot: &Robot, q: &[f64]) -> Vec<Line> {
    let geometry = robot.geometry();
    let links = robot.link_placements(q);
    let line = |(link, joint): (&Placement, &JointGeometry)| {
        // The axis is where it was before the joint moved.
        let back = joint.after.rotation.transpose();
        let origin = link.rotation * (back * -joint.after.translation) + link.translation;
        [origin, link.rotation * (back * joint.axis)]
    };
    links.iter().zip(&geometry).map(line).collect()
}

/// Returns the cosine between two lines, and their distance times the sine; the distance of
/// parallel ones.
fn relation([p, a]: &Line, [r, b]: &Line) -> [f64; 2] {
    let (across, between) = (a.cross(b), r - p);
    let is_parallel = across.norm() < PARALLEL;
    let distance = if is_parallel { between.cross(a).norm() } else { across.dot(&between).abs() };
    [a.dot(b), distance]
}
