//! Reading of a URDF.

use super::companion::Companion;
use super::describe::MovedLink;
use super::document::{UrdfTree, parse_document};
use crate::description::robot_description::ParameterSet;
use crate::error::RobotError;
use crate::lock::Lock;
use crate::robot::Robot;
use crate::text_file::read_text;
use std::path::Path;

/// Options for reading a URDF: the ends of the chain, and the joints that do not move.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UrdfOptions {
    /// Link that does not move; the default is the root.
    pub base: Option<String>,
    /// Link at the end of the chain; the default is the only link that moves and carries no other
    /// moving link.
    pub tip: Option<String>,
    /// Joints that are held at a position. The links that they carry are lumped like links behind
    /// fixed joints. A joint that mimics one of them is held as well.
    pub locks: Vec<Lock>,
    /// Whether links may have masses and inertias that no body has, as some published files do.
    /// Only the geometry of such a robot is of use, for an identification; its parameters count as
    /// base parameters.
    pub any_inertia: bool,
}

/// A URDF and the robot read from it. It keeps the text, so that identified values can be written
/// back.
///
/// - **Chain**: revolute, continuous and prismatic joints. Links that are fixed to a moving link,
///   or held by a locked joint, are lumped into it; links that do not move are ignored.
/// - **Gravity**: 9.81 m/s² along -z of the root.
/// - **Friction**: `<dynamics>` gives viscous and Coulomb friction.
/// - **Motors**: `mechanicalReduction` (or `gear_ratio`) and `rotor_inertia` of a `<transmission>`,
///   or the companion, a TOML file beside the URDF.
/// - **Angles** are used as written: 1.57079632679 is not rounded to pi/2.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Urdf, UrdfOptions};
///
/// let text = r#"<robot name="pendulum">
///   <link name="base"/>
///   <link name="arm"><inertial>
///     <origin xyz="0 0 -0.5"/><mass value="2"/>
///     <inertia ixx="0.1" iyy="0.1" izz="0.02" ixy="0" ixz="0" iyz="0"/>
///   </inertial></link>
///   <joint name="hinge" type="continuous">
///     <parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
///   </joint>
/// </robot>"#;
/// let urdf = Urdf::parse(text, "pendulum.urdf", &UrdfOptions::default()).unwrap();
/// assert!((urdf.robot().mass_matrix(&[0.3])[(0, 0)] - 0.6).abs() < 1e-15);
/// assert_eq!(urdf.updated(urdf.robot()).unwrap(), text);
/// ```
#[derive(Clone, Debug)]
pub struct Urdf {
    pub(super) text: String,
    /// Name of the text in errors.
    pub(super) origin: String,
    /// Base link of the chain.
    pub(super) base: String,
    pub(super) moved: Vec<MovedLink>,
    pub(super) locks: Vec<Lock>,
    pub(super) robot: Robot,
}

impl Urdf {
    /// Reads a URDF file and its companion, the TOML file of the same base name beside it.
    ///
    /// The companion is optional. A TOML file with a `schema_version` is a robot of its own and no
    /// companion. Values of the companion override the URDF's values, and `options` override the
    /// companion's.
    ///
    /// # Errors
    ///
    /// Returns a [`RobotError`] with file, line, element, joint or link, and remedy. The causes are
    /// XML that is not well-formed, missing links or numbers, branches whose joints are not locked,
    /// and planar joints, floating joints and joints that mimic moving ones in the chain.
    pub fn load(path: impl AsRef<Path>, options: &UrdfOptions) -> Result<Self, RobotError> {
        let path = path.as_ref();
        let text = read_text(path)?;
        let companion = path.with_extension("toml");
        let companion = if companion.exists() {
            Companion::parse(&read_text(&companion)?, &companion.display().to_string())?
        } else {
            Companion::default()
        };
        Self::read(text, &path.display().to_string(), options, companion)
    }

    /// Reads URDF text; `origin` names it in errors.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Urdf::load`].
    pub fn parse(text: &str, origin: &str, options: &UrdfOptions) -> Result<Self, RobotError> {
        Self::read(text.into(), origin, options, Companion::default())
    }

    /// Reads URDF text with the TOML text of its companion.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Urdf::load`].
    pub fn parse_with(
        text: &str,
        origin: &str,
        companion: &str,
        options: &UrdfOptions,
    ) -> Result<Self, RobotError> {
        let companion = Companion::parse(companion, &format!("{origin} (companion)"))?;
        Self::read(text.into(), origin, options, companion)
    }

    fn read(
        text: String,
        origin: &str,
        options: &UrdfOptions,
        companion: Companion,
    ) -> Result<Self, RobotError> {
        let document = parse_document(&text, origin)?;
        let mut tree = UrdfTree::new(&document, origin)?;
        let locks = companion.locks(&options.locks);
        tree.lock(&locks)?;
        let chain = tree.chain(
            options.base.as_deref().or(companion.base.as_deref()),
            options.tip.as_deref().or(companion.tip.as_deref()),
        )?;
        let (mut description, moved) = tree.describe(&chain)?;
        companion.apply(&mut description)?;
        if options.any_inertia && !description.impossible_links().is_empty() {
            description.parameters = ParameterSet::Base;
        }
        let robot = Robot::checked(&description, |value| tree.locate(&moved, value))?;
        let base = chain.base.to_string();
        Ok(Self { origin: origin.into(), base, moved, locks, robot, text })
    }

    /// Returns the robot as read.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Returns the robot as read and drops the URDF.
    pub fn into_robot(self) -> Robot {
        self.robot
    }
}
