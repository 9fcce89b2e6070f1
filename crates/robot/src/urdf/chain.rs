//! The chain of joints in a URDF's tree that forms the robot.

use super::document::{TreeJoint, UrdfTree, element};
use crate::error::RobotError;
use std::collections::{BTreeMap, BTreeSet};

/// The joints from base to tip.
pub(super) struct JointChain<'a> {
    pub base: &'a str,
    /// Indices of the joints in the tree, fixed joints included.
    pub joints: Vec<usize>,
}

impl<'a> UrdfTree<'a> {
    /// Returns the chain between two links. An end that is not given must be unambiguous.
    pub(super) fn chain(
        &self,
        base: Option<&str>,
        tip: Option<&str>,
    ) -> Result<JointChain<'a>, RobotError> {
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
            return Err(self.robot_error(
                problem,
                "name the two ends of a chain with revolute or prismatic joints",
            ));
        }
        joints.iter().try_for_each(|k| self.check_joint(&self.joints[*k]))?;
        Ok(JointChain { base, joints })
    }

    pub(super) fn above(&self, link: &'a str) -> impl Iterator<Item = usize> {
        let carrier = |link: &str| self.carrier.get(link).copied();
        core::iter::successors(carrier(link), move |k| carrier(self.joints[*k].parent))
    }

    pub(super) fn below(&self, link: &str) -> impl Iterator<Item = usize> {
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
                "give a robot with a revolute or prismatic joint that is not locked",
            ),
            _ => self.robot_error(
                format!(
                    "the robot branches, and the tip is ambiguous: {} carry no other moving link",
                    names.join(", ")
                ),
                &format!(
                    "lock the joints of all branches but one, for example {}; or choose the tip as \
                     `tip = \"...\"` in a TOML file beside the URDF",
                    self.lock_options(self.branch_joints(&candidates))
                ),
            ),
        })
    }

    /// Returns independent joints that leave one branch when they are locked, for the candidates of
    /// the tip.
    ///
    /// The branch with the most joints of its own is kept, if it has two or more. Otherwise, as for
    /// the fingers of a gripper, only the joints that carry all branches are kept.
    fn branch_joints(&self, candidates: &[&'a str]) -> BTreeSet<usize> {
        let moving = |tip: &&'a str| -> BTreeSet<usize> {
            self.above(tip).filter(|k| !self.joints[*k].is_fixed()).collect()
        };
        let paths: Vec<_> = candidates.iter().map(moving).collect();
        let independent =
            |path: &BTreeSet<usize>| path.iter().map(|k| self.independent(*k)).collect();
        let leaders: Vec<BTreeSet<usize>> = paths.iter().map(independent).collect();
        let mut uses: BTreeMap<usize, usize> = BTreeMap::new();
        leaders.iter().flatten().for_each(|k| *uses.entry(*k).or_default() += 1);
        let own = |i: usize| leaders[i].iter().filter(|k| uses[k] == 1).count();
        let longest = (0..leaders.len()).rev().max_by_key(|i| own(*i)).filter(|i| own(*i) >= 2);
        let trunk = || paths.iter().skip(1).fold(paths[0].clone(), |all, path| &all & path);
        let kept = longest.map_or_else(trunk, |i| leaders[i].clone());
        leaders.iter().flatten().filter(|k| !kept.contains(k)).copied().collect()
    }

    /// Makes the error for a joint that branches off the chain at a moving link.
    pub(super) fn branch_error(
        &self,
        joint: &TreeJoint<'a>,
        link: &str,
        chain: &JointChain,
    ) -> RobotError {
        let is_branch = |k: &usize| {
            !self.joints[*k].is_fixed()
                && !chain.joints.contains(k)
                && self.above(self.joints[*k].child).any(|j| chain.joints.contains(&j))
        };
        let branches = (0..self.joints.len()).filter(is_branch);
        let all: BTreeSet<_> = branches.map(|k| self.independent(k)).collect();
        let remedy = match joint.leader() {
            Some(leader) if all.iter().any(|k| chain.joints.contains(k)) => format!(
                "it mimics `{leader}` of the chain, but a robot here has independent joints; \
                 lock `{leader}`, or make the joint fixed"
            ),
            _ => format!("lock the joints of the branches: {}", self.lock_options(all)),
        };
        let problem = format!(
            "the chain branches: this {} joint is carried by the moving link `{link}`",
            joint.kind
        );
        self.error(joint.node, problem, &remedy)
    }

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
        if joint.is_fixed() {
            return Ok(());
        }
        if joint.motion().is_none() {
            return Err(self.error(
                joint.node,
                format!("the joint is {}", joint.kind),
                "only revolute, continuous, prismatic and fixed joints are supported; make the \
                 joint fixed, or choose base and tip so that it is not between them",
            ));
        }
        element(joint.node, "mimic").map_or(Ok(()), |mimic| {
            let leader = joint.leader().unwrap_or_default();
            Err(self.error(
                mimic,
                format!("the joint mimics `{leader}`, which moves"),
                &format!(
                    "the joints of a robot here are independent; lock `{leader}` with --lock, or \
                     make this joint fixed"
                ),
            ))
        })
    }
}
