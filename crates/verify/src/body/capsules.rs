use std::path::Path;

use reachtube_robot::{Lock, LockedJoint, Robot, Urdf, UrdfOptions};

use crate::body::capsule::Capsule;
use crate::body::fit::enclosing_capsule;
use crate::body::read::parse;
use crate::error::{Error, Result};

/// Capsules of the embedded robots, by the robot's name.
const EMBEDDED: [(&str, &str); 1] = [("Schunk LWA 4P", include_str!("../../robots/lwa4p.toml"))];

/// Two placements of a link are the same up to this difference, m and entries of rotations.
const SAME_PLACE: f64 = 1e-6;

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

    /// Reads the capsules of a TOML or URDF file; without one, takes the embedded ones. Joints that
    /// are locked in `robot` are locked in the URDF too.
    ///
    /// # Errors
    ///
    /// As [`embedded`](Self::embedded), [`from_toml`](Self::from_toml) and
    /// [`of_urdf`](Self::of_urdf); [`Error::OtherRobot`]; a file that cannot be read.
    pub fn open(path: Option<&Path>, robot: &Robot) -> Result<Self> {
        let Some(path) = path else { return Self::embedded(robot) };
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf")) {
            let folder = path.parent().unwrap_or(Path::new(""));
            let locked = robot.description().locked.iter();
            let lock =
                |held: &LockedJoint| Lock { joint: held.name.clone(), position: held.position };
            // Shapes need no inertia.
            let options = UrdfOptions {
                locks: locked.map(lock).collect(),
                any_inertia: true,
                ..Default::default()
            };
            let urdf = Urdf::load(path, &options)?;
            check_same(robot, urdf.robot(), path)?;
            return Self::of_urdf(&urdf, folder);
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

fn check_same(robot: &Robot, other: &Robot, path: &Path) -> Result<()> {
    let names = |robot: &Robot| -> Vec<String> {
        robot.joints().iter().map(|joint| format!("`{}`", joint.name)).collect()
    };
    let (own, others) = (names(robot), names(other));
    let differs = |problem: String| {
        let (urdf, robot) = (path.display().to_string(), robot.name().into());
        Err(Error::OtherRobot { urdf, robot, problem })
    };
    if own != others {
        return differs(format!("its joints are {}, not {}", others.join(", "), own.join(", ")));
    }
    for position in [0.0, 0.5] {
        let q = vec![position; own.len()];
        let places = robot.link_placements(&q).into_iter().zip(other.link_placements(&q));
        let apart = places.map(|(own, other)| {
            let turned = (own.rotation - other.rotation).amax();
            turned.max((own.translation - other.translation).amax())
        });
        if let Some(joint) = apart.into_iter().position(|apart| apart > SAME_PLACE) {
            return differs(format!(
                "the link of {} lies elsewhere at the same positions",
                own[joint]
            ));
        }
    }
    Ok(())
}
