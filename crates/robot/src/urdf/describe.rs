//! Conversion of a chain of elements to a description.

use super::chain::JointChain;
use super::document::{TreeJoint, UrdfTree, element};
use crate::description::joint_description::{
    Convention, FrictionDescription, InertiaPoint, JointDescription, PlacementDescription,
};
use crate::description::robot_description::{ParameterSet, RobotDescription, SCHEMA_VERSION};
use crate::description::validity::InvalidValue;
use crate::error::RobotError;
use crate::inertia::LinkInertia;
use crate::placement::Placement;
use nalgebra::{Matrix3, Vector3};

/// A moving link with its joint.
#[derive(Clone, Debug)]
pub(super) struct MovedLink {
    pub link: String,
    pub joint: String,
    /// Links that are fixed to the link and lumped into it.
    pub lumped: Vec<String>,
}

impl<'a> UrdfTree<'a> {
    /// Returns the description of a chain, and its moving links.
    pub(super) fn describe(
        &self,
        chain: &JointChain<'a>,
    ) -> Result<(RobotDescription, Vec<MovedLink>), RobotError> {
        let mut fixed: Option<Placement> = None;
        let (mut joints, mut moved) = (Vec::new(), Vec::new());
        for &k in &chain.joints {
            let joint = &self.joints[k];
            if joint.is_fixed() {
                let placement = self.placement_when_held(joint)?;
                fixed = Some(fixed.map_or_else(|| placement.clone(), |f| f.then(&placement)));
                continue;
            }
            let (bodies, lumped) = self.bodies(joint.child, chain)?;
            moved.push(MovedLink { link: joint.child.into(), joint: joint.name.into(), lumped });
            joints.push(self.joint(joint, fixed.take(), &bodies)?);
        }
        let root = self.document.root_element();
        let description = RobotDescription {
            schema_version: SCHEMA_VERSION,
            name: root.attribute("name").unwrap_or("robot").into(),
            parameters: ParameterSet::Physical,
            convention: Convention::Standard,
            gravity: self.gravity(chain.base)?,
            locked: self.locked(),
            identified_from: Vec::new(),
            joints,
        };
        Ok((description, moved))
    }

    /// Returns Earth's gravity along -z of the root in the base frame, with the joints between root
    /// and base locked or at zero.
    fn gravity(&self, base: &'a str) -> Result<[f64; 3], RobotError> {
        let mut gravity = Vector3::new(0.0, 0.0, -9.81);
        let joints: Vec<_> = self.above(base).collect();
        for k in joints.into_iter().rev() {
            gravity = self.placement_when_held(&self.joints[k])?.rotation.transpose() * gravity;
        }
        Ok(gravity.into())
    }

    /// Returns the bodies that move with a link, each with its placement in the link, and the names
    /// of the links that are fixed to it.
    #[expect(clippy::type_complexity, reason = "one walk over the tree makes both lists")]
    fn bodies(
        &self,
        link: &'a str,
        chain: &JointChain<'a>,
    ) -> Result<(Vec<(Placement, InertialBody)>, Vec<String>), RobotError> {
        let mut open = vec![(link, Placement::identity())];
        let (mut bodies, mut lumped) = (Vec::new(), Vec::new());
        while let Some((name, placement)) = open.pop() {
            if let Some(body) = self.body(name)? {
                bodies.push((placement.clone(), body));
            }
            if name != link {
                lumped.push(name.into());
            }
            for k in self.below(name) {
                let joint = &self.joints[k];
                if joint.is_fixed() {
                    open.push((joint.child, placement.then(&self.placement_when_held(joint)?)));
                } else if !chain.joints.contains(&k) {
                    return Err(self.branch_error(joint, link, chain));
                }
            }
        }
        Ok((bodies, lumped))
    }

    /// Returns the `<inertial>` of a link; a link without one has no mass.
    fn body(&self, link: &str) -> Result<Option<InertialBody>, RobotError> {
        let Some(inertial) = self.links[link].and_then(|node| element(node, "inertial")) else {
            return Ok(None);
        };
        let mass = self.child(inertial, "mass")?;
        let inertia = self.child(inertial, "inertia")?;
        let entry = |name| Ok(self.number(inertia, name)?.unwrap_or(0.0));
        let value = self.attribute(mass, "value")?;
        Ok(Some(InertialBody {
            mass: self.to_number(mass, "value", value)?,
            inertia: [
                entry("ixx")?,
                entry("ixy")?,
                entry("ixz")?,
                entry("iyy")?,
                entry("iyz")?,
                entry("izz")?,
            ],
            rotated: self.origin_of(inertial)?.1 != [0.0; 3],
            frame: self.placement_of(inertial)?,
        }))
    }

    /// Describes a joint; `before` is the placement of the fixed joints before it.
    fn joint(
        &self,
        joint: &TreeJoint<'a>,
        before: Option<Placement>,
        bodies: &[(Placement, InertialBody)],
    ) -> Result<JointDescription, RobotError> {
        let (translation, rpy) = self.origin_of(joint.node)?;
        let placement = match before {
            None => PlacementDescription { rotation: None, rpy: Some(rpy), translation },
            Some(before) => {
                let p = before.then(&self.placement_of(joint.node)?);
                let rows = core::array::from_fn(|i| core::array::from_fn(|j| p.rotation[(i, j)]));
                PlacementDescription {
                    rotation: Some(rows),
                    rpy: None,
                    translation: p.translation.into(),
                }
            }
        };
        let (mass, com, inertia) = lump(bodies);
        let (position_limits, velocity_limit) = self.limits(joint)?;
        let (gear_ratio, rotor_inertia) = self.motor(joint)?;
        Ok(JointDescription {
            name: joint.name.into(),
            kind: joint.motion().unwrap_or_default(),
            placement: Some(placement),
            axis: Some(self.axis_of(joint)?),
            mass,
            com: Some(com),
            inertia,
            about: InertiaPoint::Com,
            gear_ratio,
            rotor_inertia,
            position_limits,
            velocity_limit,
            friction: self.friction(joint)?,
            ..Default::default()
        })
    }

    /// Returns position and velocity limits. Zeros are fields that an exporter left empty, and mean
    /// no limit.
    pub(super) fn limits(
        &self,
        joint: &TreeJoint<'a>,
    ) -> Result<(Option<[f64; 2]>, Option<f64>), RobotError> {
        let Some(limit) = element(joint.node, "limit") else { return Ok((None, None)) };
        let [low, high] = [self.number(limit, "lower")?, self.number(limit, "upper")?]
            .map(Option::unwrap_or_default);
        let position =
            (joint.kind != "continuous" && (low, high) != (0.0, 0.0)).then_some([low, high]);
        Ok((position, self.number(limit, "velocity")?.filter(|v| *v != 0.0)))
    }

    fn friction(&self, joint: &TreeJoint<'a>) -> Result<FrictionDescription, RobotError> {
        let Some(dynamics) = element(joint.node, "dynamics") else { return Ok(Default::default()) };
        let get = |name| Ok(self.number(dynamics, name)?.unwrap_or(0.0));
        let (damping, f) = (get("damping")?, get("friction")?);
        let coulomb = if f == 0.0 { [0.0; 8] } else { [f, 0.0, -f, 0.0, -f, 0.0, f, 0.0] };
        Ok(FrictionDescription { coulomb, viscous: [damping, 0.0, 0.0], ..Default::default() })
    }

    /// Returns origin and place of an invalid value in the URDF.
    pub(super) fn locate(&self, moved: &[MovedLink], value: &InvalidValue) -> (String, String) {
        let root = self.document.root_element();
        let joint = value.joint.and_then(|i| self.joints.iter().find(|j| j.name == moved[i].joint));
        let inner =
            |node, tags: &[&str]| tags.iter().find_map(|tag| element(node, tag)).unwrap_or(node);
        let node = joint.map_or(root, |joint| match value.key {
            "mass" | "com" | "inertia" => {
                self.links[joint.child].map_or(joint.node, |link| inner(link, &["inertial"]))
            }
            "position_limits" | "velocity_limit" => inner(joint.node, &["limit"]),
            "friction" => inner(joint.node, &["dynamics"]),
            "placement" => inner(joint.node, &["origin"]),
            "axis" => inner(joint.node, &["axis"]),
            _ => joint.node,
        });
        let line = self.document.text_pos_at(node.range().start).row;
        let place =
            joint.map_or(String::new(), |j| format!("joint `{}`, link `{}`: ", j.name, j.child));
        (format!("{}:{line}", self.origin), place)
    }
}

/// The body that an `<inertial>` describes.
struct InertialBody {
    mass: f64,
    inertia: [f64; 6],
    /// Whether `frame` rotates the link's axes.
    rotated: bool,
    /// Frame of the inertia in the link.
    frame: Placement,
}

impl InertialBody {
    fn has_inertia(&self) -> bool {
        self.mass != 0.0 || self.inertia != [0.0; 6]
    }

    /// Returns the inertia in the frame of the moving link, where the body's link has `placement`.
    fn in_link(&self, placement: &Placement) -> LinkInertia {
        let [xx, xy, xz, yy, yz, zz] = self.inertia;
        let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        LinkInertia::about_com(self.mass, Vector3::zeros(), &tensor)
            .moved(&placement.then(&self.frame))
    }
}

/// Returns mass, centre of mass, and inertia about it in the link's axes, for all bodies together.
///
/// The numbers of a single body whose frame is not rotated are returned without rounding.
fn lump(bodies: &[(Placement, InertialBody)]) -> (f64, [f64; 3], [f64; 6]) {
    let bodies: Vec<_> = bodies.iter().filter(|(_, body)| body.has_inertia()).collect();
    match bodies[..] {
        [] => (0.0, [0.0; 3], [0.0; 6]),
        [(placement, body)] if !body.rotated && *placement == Placement::identity() => {
            (body.mass, body.frame.translation.into(), body.inertia)
        }
        _ => {
            let none = LinkInertia::about_origin(0.0, Vector3::zeros(), &Matrix3::zeros());
            let parts = bodies.iter().map(|(placement, body)| body.in_link(placement));
            parts.fold(none, |whole, part| whole.plus(&part)).about_own_com()
        }
    }
}
