//! Gear ratio and rotor inertia from common extensions of URDF, which itself has no elements for
//! them.

use super::document::{TreeJoint, UrdfTree, elements};
use crate::error::RobotError;
use roxmltree::Node;

impl<'a> UrdfTree<'a> {
    /// Returns gear ratio and rotor inertia \[kg m²\] of a joint.
    ///
    /// They are elements of the joint, or of a `<transmission>` that names the joint, or of its
    /// `<actuator>`: `mechanicalReduction` (ROS) or `gear_ratio`, and `rotor_inertia` (Drake), as
    /// text or as attribute `value`. A rotor inertia without a ratio is on the link side.
    pub(super) fn motor(
        &self,
        joint: &TreeJoint<'a>,
    ) -> Result<(Option<f64>, Option<f64>), RobotError> {
        let names = |t: &Node<'a, 'a>| {
            elements(*t, "joint").any(|j| j.attribute("name") == Some(joint.name))
        };
        let transmission = elements(self.document.root_element(), "transmission").find(names);
        let inner: Vec<_> = [Some(joint.node), transmission]
            .into_iter()
            .flatten()
            .flat_map(|n| n.descendants())
            .collect();
        let value = |tags: &[&str]| {
            let node = inner.iter().find(|n| n.is_element() && tags.contains(&n.tag_name().name()));
            node.map(|n| self.value(*n)).transpose()
        };
        let rotor = value(&["rotor_inertia", "rotorInertia"])?;
        let ratio =
            value(&["mechanicalReduction", "mechanical_reduction", "gear_ratio", "gearRatio"])?;
        Ok((ratio.or(rotor.map(|_| 1.0)), rotor))
    }

    fn value(&self, node: Node<'a, 'a>) -> Result<f64, RobotError> {
        let text = node.attribute("value").or(node.text()).unwrap_or("");
        self.to_number(node, node.tag_name().name(), text)
    }
}
