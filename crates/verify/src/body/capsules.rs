use std::path::Path;

use reachtube_robot::{Robot, Urdf, UrdfOptions};

use crate::body::capsule::Capsule;
use crate::body::fit::enclosing_capsule;
use crate::body::read::parse;
use crate::error::{Error, Result};

/// Capsules of the embedded robots, by the robot's name.
const EMBEDDED: [(&str, &str); 1] = [("Schunk LWA 4P", include_str!("../../robots/lwa4p.toml"))];

/// The capsules that contain the links of a robot, at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct Capsules(Vec<Capsule>);

impl Capsules {
    /// Returns the capsules of the embedded robot with the name of `robot`.
    ///
    /// # Errors
    ///
    /// [`Error::NoCapsules`] for any other robot.
    pub fn embedded(robot: &Robot) -> Result<Self> {
        let known = EMBEDDED.iter().find(|(name, _)| *name == robot.name());
        let (name, text) = known.ok_or_else(|| Error::NoCapsules { robot: robot.name().into() })?;
        Self::from_toml(text, name, robot)
    }

    /// Reads the capsules of a TOML or URDF file; without one, takes the embedded ones.
    ///
    /// # Errors
    ///
    /// As [`embedded`](Self::embedded), [`from_toml`](Self::from_toml) and
    /// [`of_urdf`](Self::of_urdf); a file that cannot be read.
    pub fn open(path: Option<&Path>, robot: &Robot) -> Result<Self> {
        let Some(path) = path else { return Self::embedded(robot) };
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf")) {
            let folder = path.parent().unwrap_or(Path::new(""));
            return Self::of_urdf(&Urdf::load(path, &UrdfOptions::default())?, folder);
        }
        let text = reachtube_files::read_text(path, "name a TOML or URDF file with capsules")?;
        Self::from_toml(&text, &path.display().to_string(), robot)
    }

    /// Reads `[[capsule]]` tables with `link`, `from`, `to` and `radius`; `origin` names the text
    /// in errors. A link is named by the joint that moves it, or by that joint's number from 1.
    ///
    /// # Errors
    ///
    /// [`Error::Syntax`] and [`Error::Invalid`], with the line.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    /// use reachtube_verify::Capsules;
    ///
    /// let text = "[[capsule]]\nlink = 2\nfrom = [0, 0, 0]\nto = [-0.35, 0, 0]\nradius = 0.08\n";
    /// let capsules = Capsules::from_toml(text, "arm", &Robot::lwa4p())?;
    /// assert_eq!(capsules.as_slice()[0].joint, 1);
    /// # Ok::<(), reachtube_verify::Error>(())
    /// ```
    pub fn from_toml(text: &str, origin: &str, robot: &Robot) -> Result<Self> {
        Ok(Self(parse(text, origin, robot)?))
    }

    /// Makes a capsule around each box, cylinder, sphere and mesh of a URDF's `<collision>`
    /// elements. Meshes are STL files, with paths relative to `folder`; `package://` is sought
    /// from there upwards.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: each capsule contains its shape, and each vertex of a mesh as it
    /// is loaded in single precision.
    ///
    /// # Errors
    ///
    /// [`Error::Mesh`], [`Error::NoCapsules`] if there is no shape, and the errors of the URDF.
    pub fn of_urdf(urdf: &Urdf, folder: &Path) -> Result<Self> {
        let shapes = urdf.collision_shapes()?;
        let capsules = shapes.iter().map(|shape| enclosing_capsule(shape, folder));
        let capsules = capsules.collect::<Result<Vec<_>>>()?;
        if capsules.is_empty() {
            return Err(Error::NoCapsules { robot: urdf.robot().name().into() });
        }
        Ok(Self(capsules))
    }

    /// Returns the capsules.
    #[must_use]
    pub fn as_slice(&self) -> &[Capsule] {
        &self.0
    }
}
