//! Identified values written into the URDF they came from.

use super::companion::Companion;
use super::document::{self, Tree, element};
use super::edit::{Edits, empty_element};
use super::{MovedLink, Urdf};
use crate::{Robot, RobotError};
use roxmltree::Node;

impl Urdf {
    /// The URDF text with the inertia and friction of another robot with the same joints.
    ///
    /// Only what differs from the robot as read is written, all other text stays byte for byte:
    /// `<inertial>` of moving links, about the centre of mass in the link's axes, and `<dynamics>`
    /// of joints. What is identified of a link is identified with all that is fixed to it: the
    /// whole goes into the moving link, and the mass and inertia of links that were lumped become
    /// 0. URDF has no place for motor inertia, nor for friction beyond a viscous and a Coulomb
    /// coefficient (those at no load are written); [`Urdf::companion`] has them.
    ///
    /// # Errors
    ///
    /// [`RobotError::Invalid`] when the robot has other joints, or a changed link has a first
    /// moment without a mass, which no `<inertial>` can say.
    pub fn updated(&self, robot: &Robot) -> Result<String, RobotError> {
        let names = |r: &Robot| r.joints().iter().map(|j| j.name.clone()).collect::<Vec<_>>();
        if names(robot) != names(&self.robot) {
            return Err(self.invalid(
                String::new(),
                format!("the robot to write has the joints {:?}", names(robot)),
                format!("write one with the joints {:?}", names(&self.robot)),
            ));
        }
        let document = document::parse(&self.text, &self.origin)?;
        let tree = Tree::new(&document, &self.origin)?;
        let mut edits = Edits::default();
        for (i, moved) in self.moved.iter().enumerate() {
            self.write_inertia(&tree, moved, i, robot, &mut edits)?;
            self.write_friction(&tree, moved, i, robot, &mut edits);
        }
        Ok(edits.apply(&self.text))
    }

    /// The TOML text to stand beside the updated URDF: motors, friction and gravity of a robot.
    pub fn companion(&self, robot: &Robot) -> String {
        let tip = self.moved.last().map(|m| m.link.clone());
        let companion = Companion::of(robot.description(), Some(self.base.clone()), tip);
        toml::to_string(&companion).expect("numbers and names are TOML")
    }

    fn invalid(&self, place: String, problem: String, remedy: String) -> RobotError {
        RobotError::Invalid { origin: self.origin.clone(), place, problem, remedy }
    }

    fn write_inertia(
        &self,
        tree: &Tree,
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
                format!("no mass, but the first moment {:?} kg m", link.first_moment.as_slice()),
                "write physical parameters, with a mass for each link".into(),
            ));
        }
        write_inertial(node, &robot.description().joints[i].about_own_com(), edits);
        for name in &moved.lumped {
            if let Some(inertial) =
                tree.links[name.as_str()].and_then(|node| element(node, "inertial"))
            {
                edits.set_child(inertial, "mass", &[("value", "0".into())]);
                edits.set_child(inertial, "inertia", &tensor(&[0.0; 6]));
            }
        }
        Ok(())
    }

    fn write_friction(
        &self,
        tree: &Tree,
        moved: &MovedLink,
        i: usize,
        robot: &Robot,
        edits: &mut Edits,
    ) {
        use crate::ColumnKind::{Coulomb, Viscous1};
        let values = |r: &Robot| {
            r.column_values(&[Viscous1, Coulomb].map(|kind| crate::Column { joint: i, kind }))
        };
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

/// Writes mass, centre of mass and inertia about it, as [`crate::JointDescription`] has them.
fn write_inertial(link: Node, (mass, com, inertia): &(f64, [f64; 3], [f64; 6]), edits: &mut Edits) {
    let origin = [("xyz", words(com)), ("rpy", "0 0 0".into())];
    let (mass, inertia) = ([("value", mass.to_string())], tensor(inertia));
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

fn tensor(inertia: &[f64; 6]) -> [(&'static str, String); 6] {
    let names = ["ixx", "ixy", "ixz", "iyy", "iyz", "izz"];
    core::array::from_fn(|k| (names[k], inertia[k].to_string()))
}

/// Three numbers in the fewest digits that give them back.
fn words(x: &[f64; 3]) -> String {
    x.map(|x| x.to_string()).join(" ")
}
