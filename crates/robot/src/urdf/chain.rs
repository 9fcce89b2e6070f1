//! The chain of joints in a URDF's tree that forms the robot.

use super::document::{Tree, TreeJoint, element};
use crate::error::RobotError;

/// The joints from base to tip.
pub(super) struct Chain<'a> {
    pub base: &'a str,
    /// Indices of the joints in the tree, fixed joints included.
    pub joints: Vec<usize>,
}

impl<'a> Tree<'a> {
    /// Returns the chain between two links. An end that is not given must be unambiguous.
    pub fn chain(&self, base: Option<&str>, tip: Option<&str>) -> Result<Chain<'a>, RobotError> {
        self.check_cycles()?;
        let tip = match tip {
            Some(name) => self.link(name, "tip")?,
            None => {
                let base = base.map(|name| self.link(name, "base")).transpose()?;
                self.only_tip(self.ends(base))?
            }
        };
        let mut joints: Vec<_> = self.above(tip).collect();
        joints.reverse();
        let parent = |k: &usize| self.joints[*k].parent;
        let root = joints.first().map_or(tip, parent);
        let base = base.map_or(Ok(root), |name| self.link(name, "base"))?;
        if base != root {
            let start = joints.iter().position(|k| parent(k) == base);
            let start = start.ok_or_else(|| {
                self.robot_error(
                    format!("base `{base}` does not carry tip `{tip}`"),
                    "name a base between the root and the tip",
                )
            })?;
            joints.drain(..start);
        }
        if joints.iter().all(|k| self.joints[*k].is_fixed()) {
            let problem = format!("there is no moving joint between base `{base}` and tip `{tip}`");
            return Err(
                self.robot_error(problem, "name the two ends of a chain with revolute joints")
            );
        }
        joints.iter().try_for_each(|k| self.check_joint(&self.joints[*k]))?;
        Ok(Chain { base, joints })
    }

    /// Returns the joints from a link towards the root.
    pub fn above(&self, link: &'a str) -> impl Iterator<Item = usize> {
        let carrier = |link: &str| self.carrier.get(link).copied();
        core::iter::successors(carrier(link), move |k| carrier(self.joints[*k].parent))
    }

    /// Returns the joints whose parent is a link.
    pub fn below(&self, link: &str) -> impl Iterator<Item = usize> {
        (0..self.joints.len()).filter(move |k| self.joints[*k].parent == link)
    }

    /// Returns the link with a name, which is an end of the chain.
    fn link(&self, name: &str, end: &str) -> Result<&'a str, RobotError> {
        let found = self.links.get_key_value(name).map(|(name, _)| *name);
        found.ok_or_else(|| {
            let names: Vec<_> = self.links.keys().map(|l| format!("`{l}`")).collect();
            self.robot_error(
                format!("there is no link `{name}` for the {end}"),
                &format!("name one of {}", names.join(", ")),
            )
        })
    }

    /// Returns the links that are moved by a joint and carry no other moving joint, below the base
    /// if one is given.
    fn ends(&self, base: Option<&str>) -> Vec<&'a str> {
        let moving = || (0..self.joints.len()).filter(|k| !self.joints[*k].is_fixed());
        let is_carried_by = |k: usize, link: &str| {
            self.above(self.joints[k].child).any(|j| self.joints[j].parent == link)
        };
        let last = |k: &usize| {
            let link = self.joints[*k].child;
            !moving().any(|j| j != *k && is_carried_by(j, link))
        };
        moving()
            .filter(last)
            .filter(|k| base.is_none_or(|b| is_carried_by(*k, b)))
            .map(|k| self.joints[k].child)
            .collect()
    }

    /// Returns the only candidate for the tip.
    fn only_tip(&self, mut candidates: Vec<&'a str>) -> Result<&'a str, RobotError> {
        if let [one] = candidates[..] {
            return Ok(one);
        }
        candidates.sort_unstable();
        let names: Vec<_> = candidates.iter().map(|l| format!("`{l}`")).collect();
        Err(match names.len() {
            0 => self.robot_error(
                "the robot has no moving link".into(),
                "give a robot with revolute joints",
            ),
            _ => self.robot_error(
                format!("the tip is ambiguous: {} carry no other moving link", names.join(", ")),
                "choose one as the tip, in the program or as `tip = \"...\"` in a TOML file beside \
                 the URDF",
            ),
        })
    }

    /// Makes an error for the robot as a whole.
    fn robot_error(&self, problem: String, remedy: &str) -> RobotError {
        self.error(self.document.root_element(), problem, remedy)
    }

    /// Checks that no link carries itself.
    fn check_cycles(&self) -> Result<(), RobotError> {
        let cyclic = |j: &&TreeJoint| self.above(j.child).nth(self.joints.len()).is_some();
        self.joints.iter().find(cyclic).map_or(Ok(()), |joint| {
            let problem = format!("link `{}` carries itself", joint.child);
            Err(self.error(
                joint.node,
                problem,
                "change the parents and children of the joints so that they form a tree",
            ))
        })
    }

    /// Checks that the chain can contain a joint.
    fn check_joint(&self, joint: &TreeJoint<'a>) -> Result<(), RobotError> {
        let remedy = "only revolute, continuous and fixed joints are supported; make the joint \
                      fixed, or choose base and tip so that it is not between them";
        if !matches!(joint.kind, "revolute" | "continuous" | "fixed") {
            return Err(self.error(joint.node, format!("the joint is {}", joint.kind), remedy));
        }
        element(joint.node, "mimic").map_or(Ok(()), |mimic| {
            let leader = mimic.attribute("joint").unwrap_or("another");
            Err(self.error(mimic, format!("the joint mimics `{leader}`"), remedy))
        })
    }
}
