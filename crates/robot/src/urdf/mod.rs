//! Robots as URDF: a serial chain of revolute joints read from it, and what was identified written
//! back.

mod chain;
mod companion;
mod describe;
mod document;
mod edit;
mod motor;
mod write;

use crate::{Robot, RobotError};
use companion::Companion;
use describe::MovedLink;
use document::Tree;
use std::path::Path;

/// The ends of the chain that is taken from a URDF.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct UrdfEnds {
    /// Link that stands still; the root when left out.
    pub base: Option<String>,
    /// Link at the end of the chain; when left out, the only link that moves without moving
    /// another.
    pub tip: Option<String>,
}

/// A URDF and the robot read from it; keeps the text, so that identified values can be written into
/// it.
///
/// Revolute and continuous joints make the chain. What is fixed to a moving link is lumped into it,
/// what stands still is left out. Gravity is 9.81 m/s² along -z of the root. `<dynamics>` gives
/// viscous and Coulomb friction; `mechanicalReduction` (or `gear_ratio`) and `rotor_inertia` of a
/// `<transmission>`, and a TOML file beside it, give the motors. Angles are taken as they are
/// written: 1.57079632679 is not pi/2.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Urdf, UrdfEnds};
///
/// let text = r#"<robot name="pendulum">
///   <link name="base"/>
///   <link name="arm"><inertial>
///     <origin xyz="0 0 -0.5"/><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.02" ixy="0" ixz="0" iyz="0"/>
///   </inertial></link>
///   <joint name="hinge" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
/// </robot>"#;
/// let urdf = Urdf::parse(text, "pendulum.urdf", &UrdfEnds::default()).unwrap();
/// assert!((urdf.robot().mass_matrix(&[0.3])[(0, 0)] - 0.6).abs() < 1e-15);
/// assert_eq!(urdf.updated(urdf.robot()).unwrap(), text);
/// ```
#[derive(Clone, Debug)]
pub struct Urdf {
    text: String,
    origin: String,
    base: String,
    moved: Vec<MovedLink>,
    robot: Robot,
}

impl Urdf {
    /// Reads a URDF file, and beside it the TOML file of the same base name where there is one that
    /// is no robot by itself (has no `schema_version`); its values come before those of the URDF,
    /// `ends` before its own.
    ///
    /// # Errors
    ///
    /// [`RobotError`] with file, line, element, joint or link, and remedy: for XML that is not
    /// well-formed, links or numbers that lack, and for prismatic, planar, floating and mimicking
    /// joints or branches in the chain.
    pub fn load(path: impl AsRef<Path>, ends: &UrdfEnds) -> Result<Self, RobotError> {
        let path = path.as_ref();
        let read = |path: &Path| {
            std::fs::read_to_string(path)
                .map_err(|source| RobotError::Read { path: path.into(), source })
        };
        let text = read(path)?;
        let beside = path.with_extension("toml");
        let companion = if beside.exists() {
            Companion::parse(&read(&beside)?, &beside.display().to_string())?
        } else {
            Companion::default()
        };
        Self::read(text, &path.display().to_string(), ends, companion)
    }

    /// Reads URDF text; `origin` names it in errors.
    ///
    /// # Errors
    ///
    /// As [`Urdf::load`].
    pub fn parse(text: &str, origin: &str, ends: &UrdfEnds) -> Result<Self, RobotError> {
        Self::read(text.into(), origin, ends, Companion::default())
    }

    /// Reads URDF text with the TOML text that stands beside it.
    ///
    /// # Errors
    ///
    /// As [`Urdf::load`].
    pub fn parse_with(
        text: &str,
        origin: &str,
        companion: &str,
        ends: &UrdfEnds,
    ) -> Result<Self, RobotError> {
        let companion = Companion::parse(companion, &format!("{origin} (companion)"))?;
        Self::read(text.into(), origin, ends, companion)
    }

    fn read(
        text: String,
        origin: &str,
        ends: &UrdfEnds,
        companion: Companion,
    ) -> Result<Self, RobotError> {
        let document = document::parse(&text, origin)?;
        let tree = Tree::new(&document, origin)?;
        let chain = tree.chain(
            ends.base.as_deref().or(companion.base.as_deref()),
            ends.tip.as_deref().or(companion.tip.as_deref()),
        )?;
        let (mut description, moved) = tree.describe(&chain)?;
        companion.apply(&mut description)?;
        let robot = Robot::checked(&description, |finding| tree.locate(&moved, finding))?;
        let base = chain.base.to_string();
        Ok(Self { origin: origin.into(), base, moved, robot, text })
    }

    /// The robot as read.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The robot as read, without the URDF.
    pub fn into_robot(self) -> Robot {
        self.robot
    }

    /// The links that the joints move, base to tip.
    pub fn moved_links(&self) -> impl Iterator<Item = &str> {
        self.moved.iter().map(|m| m.link.as_str())
    }
}
