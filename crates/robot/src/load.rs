//! Loading of robots by name or path.

use crate::error::RobotError;
use crate::lock::Lock;
use crate::robot::Robot;
use crate::text_file::read_text;
use crate::urdf::read::{Urdf, UrdfOptions};
use std::path::Path;

const EMBEDDED: [(&str, &str); 1] = [("lwa4p", include_str!("../robots/lwa4p.toml"))];

impl Robot {
    /// Loads an embedded robot by name (`lwa4p`), or a robot from a TOML or URDF file by path.
    ///
    /// Files that end in `.urdf` are read as by [`Urdf::load`] with default options.
    ///
    /// # Errors
    ///
    /// Returns a [`RobotError`] with file, line, joint, value and remedy.
    pub fn load(name_or_path: &str) -> Result<Self, RobotError> {
        Self::load_locked(name_or_path, &[])
    }

    /// Loads a robot as [`Robot::load`] does, with joints held at positions.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Robot::load`], of [`RobotDescription::with_locks`] for TOML, and of
    /// [`Urdf::load`] for URDF.
    ///
    /// [`RobotDescription::with_locks`]: crate::RobotDescription::with_locks
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let planar = Robot::load_locked("lwa4p", &["joint1=0.5".parse()?, "joint6=0".parse()?])?;
    /// assert_eq!((planar.joint_count(), planar.joints()[0].name.as_str()), (4, "joint2"));
    /// # Ok::<(), reachtube_robot::RobotError>(())
    /// ```
    pub fn load_locked(name_or_path: &str, locks: &[Lock]) -> Result<Self, RobotError> {
        let path = Path::new(name_or_path);
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf")) {
            let options = UrdfOptions { locks: locks.to_vec(), ..Default::default() };
            return Ok(Urdf::load(path, &options)?.into_robot());
        }
        let robot = Self::load_description(name_or_path)?;
        if locks.is_empty() {
            return Ok(robot);
        }
        Self::from_description(&robot.description().with_locks(locks)?)
    }

    /// Loads a robot for an identification, as [`Robot::load_locked`] does, but for links of a URDF
    /// whose masses and inertias no body has. Returns the robot and a warning that names such
    /// links; with any, the parameters of the robot count as base parameters.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Robot::load_locked`].
    pub fn load_to_identify(
        name_or_path: &str,
        locks: &[Lock],
    ) -> Result<(Self, Option<String>), RobotError> {
        let path = Path::new(name_or_path);
        if !path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf")) {
            return Ok((Self::load_locked(name_or_path, locks)?, None));
        }
        let options =
            UrdfOptions { locks: locks.to_vec(), any_inertia: true, ..Default::default() };
        let robot = Urdf::load(path, &options)?.into_robot();
        let impossible = robot.description().impossible_links();
        let warning = (!impossible.is_empty()).then(|| {
            format!(
                "no body has the mass and inertia of the links that {} move: only the geometry of \
                 {name_or_path} is used",
                impossible.join(", ")
            )
        });
        Ok((robot, warning))
    }

    /// Loads an embedded robot or a TOML file.
    fn load_description(name_or_path: &str) -> Result<Self, RobotError> {
        if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == name_or_path) {
            return Self::from_toml(text, name);
        }
        let path = Path::new(name_or_path);
        let text = read_text(path)?;
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xacro")) {
            // `arm.xacro` and `arm.urdf.xacro` are both usual.
            let urdf = path.with_extension("").with_extension("urdf");
            return Err(RobotError::Xacro { path: path.into(), urdf });
        }
        Self::from_toml(&text, name_or_path)
    }

    /// Returns the Schunk LWA 4P as identified by Liu & Althoff (IROS 2018), Table III.
    ///
    /// The table has 23 identifiable combinations of parameters; the links are one of many choices
    /// with these combinations. Gravity has parameters of its own.
    pub fn lwa4p() -> Self {
        Self::load("lwa4p").expect("the embedded description is valid")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_xacro_file_is_named_with_the_command_that_makes_a_urdf() {
        let folder = std::env::temp_dir().join(format!("reachtube-xacro-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for name in ["arm.xacro", "arm.urdf.xacro", "arm.XACRO"] {
            let path = folder.join(name);
            std::fs::write(&path, "<robot name=\"arm\"/>").unwrap();
            let text = Robot::load(path.to_str().unwrap()).unwrap_err().to_string();
            let urdf = folder.join("arm.urdf");
            let command = format!("xacro {} > {}", path.display(), urdf.display());
            assert!(text.contains("is a xacro file") && text.ends_with(&command), "{text}");
        }
        std::fs::remove_dir_all(&folder).unwrap();
        let missing = Robot::load("none.xacro").unwrap_err();
        assert!(matches!(missing, RobotError::Read { .. }));
    }

    #[test]
    fn a_urdf_with_a_link_that_is_no_body_has_a_geometry() {
        let text = r#"<robot name="arm"><link name="base"/>
            <link name="link"><inertial><mass value="1"/>
              <inertia ixx="1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
            <joint name="hinge" type="continuous">
              <parent link="base"/><child link="link"/><axis xyz="0 1 0"/></joint></robot>"#;
        let folder = std::env::temp_dir().join(format!("reachtube-bodies-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("arm.urdf");
        std::fs::write(&path, text).unwrap();
        let name = path.to_str().unwrap();
        assert!(matches!(Robot::load(name), Err(RobotError::Invalid { .. })), "no body");
        let (robot, warning) = Robot::load_to_identify(name, &[]).unwrap();
        assert_eq!(robot.joint_count(), 1);
        assert!(warning.is_some_and(|warning| warning.contains("that hinge move")));
        std::fs::write(&path, text.replace("ixx=\"1\"", "ixx=\"0.1\"")).unwrap();
        assert_eq!(Robot::load_to_identify(name, &[]).unwrap().1, None);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
