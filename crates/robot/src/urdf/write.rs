//! Writing of identified values into the URDF that the robot was read from.

use super::companion::Companion;
use super::describe::MovedLink;
use super::document::{UrdfTree, element, parse_document};
use super::edit::{Edits, empty_element};
use super::read::Urdf;
use crate::error::RobotError;
use crate::parameter::{Parameter, ParameterKind};
use crate::robot::Robot;
use roxmltree::Node;

impl Urdf {
    /// Returns the URDF text with the inertia and friction of another robot with the same joints.
    ///
    /// Only values that differ from the robot as read change; all other text stays byte for byte.
    /// The values are `<inertial>` of moving links, about the centre of mass in the link's axes,
    /// and `<dynamics>` of joints. The identified inertia of a link includes the links that are
    /// fixed to it. It is written to the moving link, and the mass and inertia of the fixed links
    /// become 0.
    ///
    /// URDF has no elements for motor inertia, nor for friction beyond a viscous and a Coulomb
    /// coefficient (which are written for no load). [`Urdf::companion`] has these values.
    ///
    /// # Errors
    ///
    /// Returns [`RobotError::Invalid`] if the robot has other joints, or if a changed link has a
    /// first moment without a mass, which no `<inertial>` can express.
    pub fn updated(&self, robot: &Robot) -> Result<String, RobotError> {
        let names = |r: &Robot| r.joints().iter().map(|j| j.name.clone()).collect::<Vec<_>>();
        if names(robot) != names(&self.robot) {
            return Err(self.invalid(
                String::new(),
                format!("the robot to write has other joints: {:?}", names(robot)),
                format!("write a robot with the joints {:?}", names(&self.robot)),
            ));
        }
        let document = parse_document(&self.text, &self.origin)?;
        let tree = UrdfTree::new(&document, &self.origin)?;
        let mut edits = Edits::default();
        for (i, moved) in self.moved.iter().enumerate() {
            self.write_inertia(&tree, moved, i, robot, &mut edits)?;
            self.write_friction(&tree, moved, i, robot, &mut edits);
        }
        Ok(edits.apply(&self.text))
    }

    /// Returns the companion of the updated URDF as TOML text: motors, friction and gravity of a
    /// robot.
    pub fn companion(&self, robot: &Robot) -> String {
        let tip = self.moved.last().map(|m| m.link.clone());
        let base = Some(self.base.clone());
        let companion = Companion::from_description(robot.description(), base, tip, &self.locks);
        toml::to_string(&companion).expect("numbers and names are valid TOML")
    }

    fn invalid(&self, place: String, problem: String, remedy: String) -> RobotError {
        RobotError::Invalid { origin: self.origin.clone(), place, problem, remedy }
    }

    /// Writes the inertia of moving link i if it differs.
    fn write_inertia(
        &self,
        tree: &UrdfTree,
        moved: &MovedLink,
        i: usize,
        robot: &Robot,
        edits: &mut Edits,
    ) -> Result<(), RobotError> {
        let link = robot.description().joints[i].link_inertia();
        let Some(node) = tree.links[moved.link.as_str()] else { return Ok(()) };
        if link == self.robot.description().joints[i].link_inertia() {
            return Ok(());
        }
        if link.mass == 0.0 && link.first_moment.amax() != 0.0 {
            return Err(self.invalid(
                format!("link `{}`: ", moved.link),
                format!(
                    "the link has no mass, but the first moment {:?} kg m",
                    link.first_moment.as_slice()
                ),
                "write physical parameters with a positive mass for this link".into(),
            ));
        }
        write_inertial(node, &robot.description().joints[i].about_own_com(), edits);
        for name in &moved.lumped {
            if let Some(inertial) =
                tree.links[name.as_str()].and_then(|node| element(node, "inertial"))
            {
                edits.set_child(inertial, "mass", &[("value", "0".into())]);
                edits.set_child(inertial, "inertia", &tensor_attributes(&[0.0; 6]));
            }
        }
        Ok(())
    }

    /// Writes the friction of joint i if it differs.
    fn write_friction(
        &self,
        tree: &UrdfTree,
        moved: &MovedLink,
        i: usize,
        robot: &Robot,
        edits: &mut Edits,
    ) {
        let kinds = [ParameterKind::Viscous1, ParameterKind::Coulomb];
        let parameters = kinds.map(|kind| Parameter { joint: i, kind });
        let values = |r: &Robot| r.parameter_values(&parameters);
        let (old, new) = (values(&self.robot), values(robot));
        let Some(joint) = tree.joints.iter().find(|j| j.name == moved.joint) else { return };
        let changed = ["damping", "friction"].into_iter().zip(old.iter().zip(&new));
        let changed: Vec<_> = changed
            .filter(|(_, (old, new))| old != new)
            .map(|(name, (_, new))| (name, new.to_string()))
            .collect();
        if !changed.is_empty() {
            edits.set_child(joint.node, "dynamics", &changed);
        }
    }
}

/// Writes mass \[kg\], centre of mass \[m\] and inertia about it \[kg m²\] into a link.
fn write_inertial(link: Node, (mass, com, inertia): &(f64, [f64; 3], [f64; 6]), edits: &mut Edits) {
    let origin = [("xyz", format_triple(com)), ("rpy", "0 0 0".into())];
    let (mass, inertia) = ([("value", mass.to_string())], tensor_attributes(inertia));
    let parts: [(&str, &[(&str, String)]); 3] =
        [("origin", &origin), ("mass", &mass), ("inertia", &inertia)];
    match link.children().find(|n| n.is_element() && n.tag_name().name() == "inertial") {
        Some(inertial) => {
            parts.iter().for_each(|(tag, values)| edits.set_child(inertial, tag, values))
        }
        None => {
            let inner: String = parts
                .iter()
                .map(|(tag, values)| format!("\n  {}", empty_element(tag, values)))
                .collect();
            edits.add(link, &format!("<inertial>{inner}\n</inertial>"));
        }
    }
}

fn tensor_attributes(inertia: &[f64; 6]) -> [(&'static str, String); 6] {
    let names = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    core::array::from_fn(|k| (names[k], inertia[k].to_string()))
}

/// Formats three numbers in the fewest digits that round-trip.
fn format_triple(x: &[f64; 3]) -> String {
    x.map(|x| x.to_string()).join(" ")
}
