//! From text or values to a robot.

use super::check::Finding;
use super::{Convention, InertiaPoint, JointDescription, PlacementDescription, RobotDescription};
use crate::chain::JointGeometry;
use crate::friction::{Coulomb, Friction, Viscous};
use crate::inertia::LinkInertia;
use crate::placement::Placement;
use crate::robot::Joint;
use crate::{Robot, RobotError};
use core::f64::consts::PI;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::path::Path;

const EMBEDDED: [(&str, &str); 1] = [("lwa4p", include_str!("../../robots/lwa4p.toml"))];

impl Robot {
    /// An embedded robot by name (`lwa4p`), or one from a TOML or URDF file by path; what ends in
    /// `.urdf` is read as [`Urdf::load`](crate::Urdf::load) does without named ends.
    ///
    /// # Errors
    ///
    /// [`RobotError`] with file, line, joint, value and remedy.
    pub fn load(name_or_path: &str) -> Result<Self, RobotError> {
        if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == name_or_path) {
            return Self::from_toml(text, name);
        }
        let path = Path::new(name_or_path);
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf")) {
            return Ok(crate::Urdf::load(path, &Default::default())?.into_robot());
        }
        let text = std::fs::read_to_string(path)
            .map_err(|source| RobotError::Read { path: name_or_path.into(), source })?;
        Self::from_toml(&text, name_or_path)
    }

    /// A robot from TOML text; `origin` names the text in errors.
    ///
    /// # Errors
    ///
    /// [`RobotError`] with line, joint, value and remedy.
    pub fn from_toml(text: &str, origin: &str) -> Result<Self, RobotError> {
        let description: RobotDescription = toml::from_str(text)
            .map_err(|e| RobotError::Syntax { origin: origin.into(), message: e.to_string() })?;
        Self::checked(&description, |f| {
            (format!("{origin}:{}", line_of(text, f.joint, f.key)), joint_words(&description, f))
        })
    }

    /// A robot from its description.
    ///
    /// # Errors
    ///
    /// [`RobotError`] with joint, value and remedy.
    pub fn from_description(description: &RobotDescription) -> Result<Self, RobotError> {
        Self::checked(description, |f| (description.name.clone(), joint_words(description, f)))
    }

    /// A robot from its description; `locate` says origin and place of a value that makes no robot.
    pub(crate) fn checked(
        description: &RobotDescription,
        locate: impl Fn(&Finding) -> (String, String),
    ) -> Result<Self, RobotError> {
        description.check().map_err(|f| {
            let (origin, place) = locate(&f);
            RobotError::Invalid { origin, place, problem: f.problem, remedy: f.remedy.into() }
        })?;
        Ok(description.clone().build())
    }

    /// The Schunk LWA 4P as identified by Liu & Althoff (IROS 2018), Table III.
    ///
    /// Its links are one choice that gives the table's 23 identifiable combinations; gravity has
    /// its own parameters.
    pub fn lwa4p() -> Self {
        Self::load("lwa4p").expect("the embedded description is tested")
    }
}

fn joint_words(description: &RobotDescription, f: &Finding) -> String {
    f.joint.map_or(String::new(), |i| format!("joint `{}`: ", description.joints[i].name))
}

/// Line (from 1) of a key in the table of the given joint, or the table's first line where the key
/// is absent.
fn line_of(text: &str, joint: Option<usize>, key: &str) -> usize {
    let lines = || text.lines().map(str::trim).enumerate();
    let mut headers = lines().filter(|(_, l)| l.starts_with("[[joint]]")).map(|(i, _)| i);
    let start = joint.map_or(0, |k| headers.nth(k).unwrap_or(0));
    let named =
        |l: &str| l.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with(['=', '.']));
    let own = lines().skip(start).take_while(|(i, l)| *i == start || !l.starts_with("[[joint]]"));
    own.into_iter().find(|(_, l)| named(l)).map_or(start, |(i, _)| i) + 1
}

impl RobotDescription {
    /// The description as TOML text, which [`Robot::from_toml`] reads to the same robot.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let text = Robot::lwa4p().description().to_toml();
    /// assert_eq!(Robot::from_toml(&text, "copy").unwrap(), Robot::lwa4p());
    /// ```
    pub fn to_toml(&self) -> String {
        toml::to_string(self).expect("numbers, words and tables are TOML")
    }

    /// The robot of a checked description.
    fn build(self) -> Robot {
        let geometry: Vec<_> = self.joints.iter().map(|j| j.geometry(self.convention)).collect();
        let inertias: Vec<_> = self.joints.iter().map(JointDescription::link_inertia).collect();
        let heavy: Vec<_> = self.joints.iter().map(JointDescription::gravity_inertia).collect();
        let joints = self.joints.iter().map(JointDescription::joint).collect();
        Robot::assemble(self, joints, &geometry, &inertias, &heavy)
    }
}

impl PlacementDescription {
    fn placement(&self) -> Placement {
        let [roll, pitch, yaw] = self.rpy.unwrap_or_default();
        let rotation = match self.rotation {
            Some(rows) => Matrix3::from_row_slice(rows.as_flattened()),
            None => Rotation3::from_euler_angles(roll, pitch, yaw).into_inner(),
        };
        Placement { rotation, translation: self.translation.into() }
    }
}

impl JointDescription {
    fn geometry(&self, convention: Convention) -> JointGeometry {
        match (self.dh, convention) {
            (Some(p), Convention::Standard) => {
                JointGeometry::standard_dh(p.a, p.alpha, p.theta, p.d)
            }
            (Some(p), Convention::Modified) => {
                JointGeometry::modified_dh(p.a, p.alpha, p.theta, p.d)
            }
            (None, _) => {
                let axis = Vector3::from(self.axis.unwrap_or([0.0, 0.0, 1.0]));
                JointGeometry::explicit(
                    self.placement.unwrap_or_default().placement(),
                    axis.normalize(),
                )
            }
        }
    }

    fn tensor(&self) -> Matrix3<f64> {
        let [xx, xy, xz, yy, yz, zz] = self.inertia;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// The ten inertial parameters about the origin of the link's own frame.
    pub(crate) fn link_inertia(&self) -> LinkInertia {
        let com = Vector3::from(self.com.unwrap_or_default());
        match self.about {
            InertiaPoint::Com => LinkInertia::about_com(self.mass, com, &self.tensor()),
            InertiaPoint::Origin => {
                let h = self.first_moment.map_or(self.mass * com, Vector3::from);
                LinkInertia::about_origin(self.mass, h, &self.tensor())
            }
        }
    }

    /// Mass, centre of mass, and ixx, ixy, ixz, iyy, iyz, izz about it; the numbers as given where
    /// those are they.
    pub(crate) fn about_own_com(&self) -> (f64, [f64; 3], [f64; 6]) {
        match self.about {
            InertiaPoint::Com => (self.mass, self.com.unwrap_or_default(), self.inertia),
            InertiaPoint::Origin => self.link_inertia().about_own_com(),
        }
    }

    fn gravity_inertia(&self) -> LinkInertia {
        self.gravity_moments.map_or_else(
            || self.link_inertia(),
            |g| LinkInertia::about_origin(g.mass, g.first_moment.into(), &Matrix3::zeros()),
        )
    }

    fn joint(&self) -> Joint {
        let [v1, v2, v3] = self.friction.viscous;
        let geared = self.gear_ratio.unwrap_or(1.0).powi(2) * self.rotor_inertia.unwrap_or(0.0);
        Joint {
            name: self.name.clone(),
            position_limits: self.position_limits.unwrap_or([-PI, PI]),
            velocity_limit: self.velocity_limit,
            gear_ratio: self.gear_ratio,
            armature: self.armature.unwrap_or(geared),
            friction: Friction {
                coulomb: Coulomb::from_coefficients(self.friction.coulomb),
                viscous: Viscous { v1, v2, v3 },
            },
        }
    }
}
