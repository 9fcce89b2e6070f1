//! Paddings of links for the planner MoveIt, of a model of an arm under its controller.

use std::fmt::Write;
use std::path::Path;

use reachtube_files::MARK;
use reachtube_robot::{JointKind, Robot, Urdf, UrdfOptions};
use reachtube_scalar::Interval;
use reachtube_tracking::{PlanDeviations, TrackingModel};
use reachtube_verify::{Body, Capsules};
use schemars::JsonSchema;
use serde::Serialize;

use crate::export::{ExportError, ExportFile};
use crate::number::two_digits_up;

/// A revolute joint can be anywhere within a turn to both sides; what a link moves by does not
/// depend on it.
const TURN: f64 = std::f64::consts::TAU;

/// Paddings of the links of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Paddings {
    /// The links with collision shapes, in the order of the joints that move them.
    pub links: Vec<LinkPadding>,
    /// How far the joints can be from a plan.
    pub deviations: PlanDeviations,
    /// The file that MoveIt reads.
    pub file: ExportFile,
}

/// How far a link can be from where a plan has it, in any position of the joints.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LinkPadding {
    /// The link.
    pub link: String,
    /// From where it is planned to be at the same time, m.
    pub at_the_same_time: f64,
    /// From where it was planned to be a little before, which is the same for all joints, m: how
    /// far it is from its path.
    pub along_the_path: f64,
}

impl Paddings {
    /// Returns the paddings of the links of a URDF for plans up to a part of the recorded speeds.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, in any position of the joints: each point of a link's capsule
    /// stays within its padding of the same point in the plan, as [`TrackingModel::deviations`]
    /// bounds the joints.
    ///
    /// # Errors
    ///
    /// A URDF that cannot be read, has no collision shapes, or has other joints than the model.
    pub fn new(model: &TrackingModel, urdf: &Path, part: f64) -> Result<Self, ExportError> {
        let options = UrdfOptions { any_inertia: true, ..Default::default() };
        let loaded = Urdf::load(urdf, &options)?;
        let robot = loaded.robot();
        let joints: Vec<String> = robot.joints().iter().map(|of| of.name.clone()).collect();
        model.refuse_other(urdf, &joints)?;
        let folder = urdf.parent().unwrap_or(Path::new(""));
        let body = Body::new(robot, &Capsules::of_urdf(&loaded, folder)?);
        let deviations = model.deviations(part);
        let ranges = ranges(robot);
        let [same_time, path] = [&deviations.at_the_same_time, &deviations.along_the_path]
            .map(|of| body.largest_ways(&ranges, of));
        let mut links: Vec<LinkPadding> = Vec::new();
        for (shape, ways) in loaded.collision_shapes()?.iter().zip(same_time.iter().zip(&path)) {
            let (at_the_same_time, along_the_path) = (*ways.0, *ways.1);
            match links.iter_mut().find(|known| known.link == shape.link) {
                Some(known) => {
                    known.at_the_same_time = known.at_the_same_time.max(at_the_same_time);
                    known.along_the_path = known.along_the_path.max(along_the_path);
                }
                None => {
                    let link = shape.link.clone();
                    links.push(LinkPadding { link, at_the_same_time, along_the_path });
                }
            }
        }
        let file = ExportFile::new("moveit_padding.yaml", text(model, &links, &deviations));
        Ok(Self { links, deviations, file })
    }
}

/// Returns where each joint can be, as far as it changes how far links move.
fn ranges(robot: &Robot) -> Vec<Interval> {
    let range = |joint: &reachtube_robot::Joint| match joint.kind {
        JointKind::Revolute => Interval::centred(0.0, TURN),
        JointKind::Prismatic => {
            let [low, high] = joint.position_limits;
            Interval::point(low).hull(Interval::point(high))
        }
    };
    robot.joints().iter().map(range).collect()
}

fn text(model: &TrackingModel, links: &[LinkPadding], deviations: &PlanDeviations) -> String {
    let largest = links.iter().map(|of| of.along_the_path).fold(0.0, f64::max);
    let percent = 100.0 * deviations.part;
    let mut text = format!(
        "# {MARK} export.\n# How far links can be from the path of a plan, in m, rounded up: for \
         obstacles that stand still, and\n# plans up to {percent} % of the recorded speeds. For \
         obstacles that move, the number in the comment.\n# MoveIt 1 reads both entries; MoveIt 2 \
         reads the first one, for all links.\n{}robot_description_planning:\n  \
         default_robot_padding: {}\n  default_robot_link_padding:\n",
        model.condition_lines(),
        two_digits_up(largest)
    );
    for LinkPadding { link, at_the_same_time, along_the_path } in links {
        let [path, time] = [along_the_path, at_the_same_time].map(|of| two_digits_up(*of));
        let _ = writeln!(text, "    {link}: {path}  # {time} at the same time");
    }
    text
}
