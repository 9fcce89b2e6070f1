//! Which joints of a URDF's tree make the robot.

use super::document::{Tree, TreeJoint, element};
use crate::RobotError;

/// The joints from base to tip, fixed ones included, as indices into the tree's.
pub(super) struct Chain<'a> {
    pub base: &'a str,
    pub joints: Vec<usize>,
}

impl<'a> Tree<'a> {
    /// The chain between two links, or the one that the URDF leaves no choice about.
    pub fn chain(&self, base: Option<&str>, tip: Option<&str>) -> Result<Chain<'a>, RobotError> {
        self.refuse_cycles()?;
        let tip = match tip {
            Some(name) => self.link(name, "tip")?,
            None => {
                let below = base.map(|name| self.link(name, "base")).transpose()?;
                self.only(self.ends(below), "tip", "a link that moves without moving another")?
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
                self.whole(
                    format!("tip `{tip}` does not hang on base `{base}`"),
                    "name a base above the tip",
                )
            })?;
            joints.drain(..start);
        }
        if joints.iter().all(|k| self.joints[*k].is_fixed()) {
            let problem = format!("no joint moves between base `{base}` and tip `{tip}`");
            return Err(self.whole(problem, "name the two ends of a chain with revolute joints"));
        }
        joints.iter().try_for_each(|k| self.refuse_kind(&self.joints[*k]))?;
        Ok(Chain { base, joints })
    }

    /// The joints from a link up to the root.
    pub fn above(&self, link: &'a str) -> impl Iterator<Item = usize> {
        let carrier = |link: &str| self.carrier.get(link).copied();
        core::iter::successors(carrier(link), move |k| carrier(self.joints[*k].parent))
    }

    pub fn below(&self, link: &str) -> impl Iterator<Item = usize> {
        (0..self.joints.len()).filter(move |k| self.joints[*k].parent == link)
    }

    fn link(&self, name: &str, end: &str) -> Result<&'a str, RobotError> {
        let found = self.links.get_key_value(name).map(|(name, _)| *name);
        found.ok_or_else(|| {
            let names: Vec<_> = self.links.keys().map(|l| format!("`{l}`")).collect();
            self.whole(
                format!("there is no link `{name}` for the {end}"),
                &format!("name one of {}", names.join(", ")),
            )
        })
    }

    /// Links moved by a joint below which no other joint moves, below a base where one is named.
    fn ends(&self, base: Option<&str>) -> Vec<&'a str> {
        let moving = || (0..self.joints.len()).filter(|k| !self.joints[*k].is_fixed());
        let hangs_on = |k: usize, link: &str| {
            self.above(self.joints[k].child).any(|j| self.joints[j].parent == link)
        };
        let last = |k: &usize| {
            let link = self.joints[*k].child;
            !moving().any(|j| j != *k && hangs_on(j, link))
        };
        moving()
            .filter(last)
            .filter(|k| base.is_none_or(|b| hangs_on(*k, b)))
            .map(|k| self.joints[k].child)
            .collect()
    }

    fn only(
        &self,
        mut candidates: Vec<&'a str>,
        end: &str,
        what: &str,
    ) -> Result<&'a str, RobotError> {
        if let [one] = candidates[..] {
            return Ok(one);
        }
        candidates.sort_unstable();
        let names: Vec<_> = candidates.iter().map(|l| format!("`{l}`")).collect();
        Err(match names.len() {
            0 => self.whole(format!("there is not {what}"), "give a robot with revolute joints"),
            _ => self.whole(
                format!("the {end} is not clear: {} each are {what}", names.join(", ")),
                &format!(
                    "name the {end}, in the program or as `{end} = \"...\"` in a TOML file beside the URDF"
                ),
            ),
        })
    }

    fn whole(&self, problem: String, remedy: &str) -> RobotError {
        self.error(self.document.root_element(), problem, remedy)
    }

    fn refuse_cycles(&self) -> Result<(), RobotError> {
        let cyclic = |j: &&TreeJoint| self.above(j.child).nth(self.joints.len()).is_some();
        self.joints.iter().find(cyclic).map_or(Ok(()), |joint| {
            let problem = format!("link `{}` hangs on itself", joint.child);
            Err(self.error(joint.node, problem, "let the joints form a tree"))
        })
    }

    fn refuse_kind(&self, joint: &TreeJoint<'a>) -> Result<(), RobotError> {
        let remedy = "only revolute, continuous and fixed joints are handled; fix the joint, or choose base and tip \
                      so that it is not between them";
        if !matches!(joint.kind, "revolute" | "continuous" | "fixed") {
            return Err(self.error(joint.node, format!("the joint is {}", joint.kind), remedy));
        }
        element(joint.node, "mimic").map_or(Ok(()), |mimic| {
            let leader = mimic.attribute("joint").unwrap_or("another");
            Err(self.error(mimic, format!("the joint mimics `{leader}`"), remedy))
        })
    }
}
