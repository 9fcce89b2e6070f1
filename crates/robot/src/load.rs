//! Loading of robots by name or path.

use crate::error::RobotError;
use crate::robot::Robot;
use crate::text_file::read_text;
use crate::urdf::read::{Urdf, UrdfEnds};
use std::path::Path;

const EMBEDDED: [(&str, &str); 1] = [("lwa4p", include_str!("../robots/lwa4p.toml"))];

impl Robot {
    /// Loads an embedded robot by name (`lwa4p`), or a robot from a TOML or URDF file by path.
    ///
    /// Files that end in `.urdf` are read as by [`Urdf::load`] with default ends.
    ///
    /// # Errors
    ///
    /// Returns a [`RobotError`] with file, line, joint, value and remedy.
    pub fn load(name_or_path: &str) -> Result<Self, RobotError> {
        if let Some((name, text)) = EMBEDDED.iter().find(|(name, _)| *name == name_or_path) {
            return Self::from_toml(text, name);
        }
        let path = Path::new(name_or_path);
        if path.extension().is_some_and(|e| e.eq_ignore_ascii_case("urdf")) {
            return Ok(Urdf::load(path, &UrdfEnds::default())?.into_robot());
        }
        Self::from_toml(&read_text(path)?, name_or_path)
    }

    /// Returns the Schunk LWA 4P as identified by Liu & Althoff (IROS 2018), Table III.
    ///
    /// The table has 23 identifiable combinations of parameters; the links are one of many choices
    /// with these combinations. Gravity has parameters of its own.
    pub fn lwa4p() -> Self {
        Self::load("lwa4p").expect("the embedded description is valid")
    }
}
