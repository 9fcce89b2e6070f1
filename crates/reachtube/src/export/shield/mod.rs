//! The files of the safety shield SaRA: how far its links may be from where it believes them.
//!
//! The shield grows each link's capsule by one `secure_radius` for the errors of its model of the
//! robot. [`Shield::new`] proves that number from reachable sets.

mod file;
pub(super) mod frames;
mod limits;
mod link_file;
mod yaml;

use reachtube_conform::SuiteReach;
use reachtube_files::{MARK, TOOL};
use reachtube_robot::Robot;
use reachtube_verify::{Body, Capsules, Margin};
use schemars::JsonSchema;
use serde::Serialize;

use super::text::{comment, harmless, number};
use super::{ExportError, ExportFile};
pub use file::ShieldFile;
use file::marked;
use frames::Frames;
pub use limits::Covered;
use link_file::LinkFile;
use yaml::Yaml;

/// Part of the margin that covers rotations of the shield's file which are rounded to six digits.
const RELATIVE: f64 = 1e-5;

/// Resolution of the secure radius \[m\]: far above what rounding moves a point of a link.
const RESOLUTION: f64 = 1e-6;

/// The margin of a link, and the suite or run in which it is the largest.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LinkMargin {
    /// The joint that moves the link.
    #[serde(rename = "link")]
    pub joint: String,
    /// The suite or run.
    #[serde(rename = "motion")]
    pub case: String,
    /// The margin, m, rounded up.
    #[serde(rename = "margin")]
    pub distance: f64,
    /// Start of the step in which it is the largest, s.
    pub time: f64,
}

/// The contents of the shield's two files.
#[derive(Debug, Clone)]
pub struct Shield {
    /// The secure radius \[m\]: at least the largest margin.
    pub secure_radius: f64,
    /// The largest margin of each link that has a capsule.
    pub margins: Vec<LinkMargin>,
    /// The largest radius of a capsule \[m\].
    pub largest_capsule: f64,
    /// The velocities and accelerations that the motions reach.
    pub covered: Covered,
    /// The files.
    pub files: Vec<ExportFile>,
}

/// The links as the shield knows them.
enum Links<'a> {
    /// As this robot and these capsules have them: the file is written whole.
    Own(&'a Robot, &'a Capsules),
    /// As the shield's own file has them.
    File(&'a ShieldFile, Box<LinkFile>),
}

impl Shield {
    /// Proves the secure radius over reachable sets and writes the shield's files.
    ///
    /// A file of `updates` with `enclosures` gets another `secure_radius`, which is proved for the
    /// frames and capsules of that file; without one, the robot's file is written whole with
    /// `capsules`. A file with `a_max_allowed` gets limits that the motions reach.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: grown by the secure radius, the capsules of each link on the
    /// nominal motion contain the link's capsules on every motion of the model, at every time of
    /// `reached`. It does not bound how far a controller lets the arm leave its plan.
    ///
    /// # Errors
    ///
    /// [`ExportError::Refused`] for a robot or a file that the shield cannot have, and for links
    /// without masses where the robot's file is written whole; [`ExportError::EndsEarly`] for a
    /// reachable set that ends before the motion.
    ///
    /// # Panics
    ///
    /// Panics when the reachable sets are of another robot.
    pub fn new(
        robot: &Robot,
        capsules: Option<&Capsules>,
        reached: &[SuiteReach],
        updates: &[ShieldFile],
    ) -> Result<Self, ExportError> {
        let links = Links::new(robot, capsules, updates)?;
        let body = links.body();
        let margins = largest_margins(&body, reached)?;
        let largest = margins.iter().map(|margin| margin.distance).fold(0.0, f64::max);
        let secure_radius = rounded_up(largest);
        let covered = Covered::new(robot, reached);
        let about = about(robot, secure_radius, &margins, reached);
        let mut files = vec![links.file(secure_radius, &about)?];
        for update in updates.iter().filter(|file| !is_of_links(file)) {
            files.push(covered.file(robot, update)?);
        }
        let radii = body.capsules().iter().map(|capsule| capsule.radius);
        let largest_capsule = radii.fold(0.0, f64::max);
        Ok(Self { secure_radius, margins, largest_capsule, covered, files })
    }
}

impl<'a> Links<'a> {
    fn new(
        robot: &'a Robot,
        capsules: Option<&'a Capsules>,
        updates: &'a [ShieldFile],
    ) -> Result<Self, ExportError> {
        match (updates.iter().find(|file| is_of_links(file)), capsules) {
            (Some(file), _) => Ok(Self::File(file, Box::new(LinkFile::read(file, robot)?))),
            (None, Some(capsules)) => Ok(Self::Own(robot, capsules)),
            (None, None) => Err(ExportError::Refused {
                place: robot.name().into(),
                problem: "no capsules are known for its links".into(),
                remedy: "name a file with capsules, or the shield's own robot file".into(),
            }),
        }
    }

    fn body(&self) -> Body {
        match self {
            Self::Own(robot, capsules) => Body::new(robot, capsules),
            Self::File(_, file) => file.body(),
        }
    }

    fn file(&self, secure_radius: f64, about: &str) -> Result<ExportFile, ExportError> {
        match self {
            Self::Own(robot, capsules) => {
                let text = Frames::new(robot, capsules)?.text(robot, secure_radius)?;
                Ok(ExportFile::new("robot_parameters.yaml", format!("{about}\n{text}")))
            }
            Self::File(file, _) => {
                let text = Yaml::new(file).with_value("secure_radius", &number(secure_radius))?;
                Ok(ExportFile::new(&file.name, marked(about, &text)))
            }
        }
    }
}

/// Returns whether a file describes links, and not limits of motions.
fn is_of_links(file: &ShieldFile) -> bool {
    file.text.lines().any(|line| line.starts_with("enclosures:"))
}

fn largest_margins(body: &Body, reached: &[SuiteReach]) -> Result<Vec<LinkMargin>, ExportError> {
    let mut largest: Vec<(usize, LinkMargin)> = Vec::new();
    for reach in reached {
        if let (Some(_), time) = (&reach.lost, reach.times.last().copied().unwrap_or(0.0)) {
            return Err(ExportError::EndsEarly { case: reach.name(), time });
        }
        if reach.times.len() < 2 {
            return Err(ExportError::NoTime { case: reach.name() });
        }
        for Margin { joint, distance, time } in body.margins(reach) {
            let name = body.joint_name(joint).to_owned();
            let margin = LinkMargin { joint: name, case: reach.name(), distance, time };
            match largest.iter_mut().find(|(known, _)| *known == joint) {
                Some((_, known)) if known.distance >= distance => {}
                Some((_, known)) => *known = margin,
                None => largest.push((joint, margin)),
            }
        }
    }
    Ok(largest.into_iter().map(|(_, margin)| margin).collect())
}

/// Returns the secure radius of a margin: rounded up, with room for the rounding of the file.
fn rounded_up(margin: f64) -> f64 {
    (margin * (1.0 + RELATIVE) / RESOLUTION).ceil().mul_add(RESOLUTION, RESOLUTION)
}

fn about(robot: &Robot, radius: f64, margins: &[LinkMargin], reached: &[SuiteReach]) -> String {
    let ends = reached.iter().filter_map(|reach| reach.times.last()).copied();
    let names: Vec<String> = reached.iter().map(|reach| harmless(&reach.name())).collect();
    let of_link = |margin: &LinkMargin| {
        format!("{} {:.6}", harmless(&margin.joint), margin.distance.next_up() + 5e-7)
    };
    let lines = [
        format!("{MARK} ({TOOL}): secure_radius of {}.", harmless(robot.name())),
        format!(
            "Proved: grown by {} m, the capsules on the nominal motion contain the capsules on \
             every motion of the model, for up to {:.4} s of {}. How far the controller lets the \
             arm leave its plan is not part of it.",
            number(radius),
            ends.fold(0.0, f64::max),
            names.join(", ")
        ),
        format!("By link, m: {}.", margins.iter().map(of_link).collect::<Vec<_>>().join(", ")),
    ];
    comment("#", &lines)
}
