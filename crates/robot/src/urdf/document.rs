//! Elements of a URDF, and errors with their location.

use crate::error::RobotError;
use crate::placement::Placement;
use nalgebra::Rotation3;
use roxmltree::{Document, Node};
use std::collections::{BTreeMap, HashMap};

/// The links and joints of a URDF.
pub(super) struct UrdfTree<'a> {
    pub document: &'a Document<'a>,
    pub origin: &'a str,
    /// Links by name; `None` for a `world` link without an element.
    pub links: BTreeMap<&'a str, Option<Node<'a, 'a>>>,
    pub joints: Vec<TreeJoint<'a>>,
    /// Index of each joint by name.
    pub by_name: HashMap<&'a str, usize>,
    /// Index of the joint that carries each link.
    pub carrier: HashMap<&'a str, usize>,
}

/// A joint of a URDF.
#[derive(Clone, Copy)]
pub(super) struct TreeJoint<'a> {
    pub node: Node<'a, 'a>,
    pub name: &'a str,
    pub kind: &'a str,
    pub parent: &'a str,
    pub child: &'a str,
    /// Position at which the joint is locked \[rad; m\].
    pub locked: Option<f64>,
}

impl TreeJoint<'_> {
    /// Returns whether the joint does not move: it is fixed or locked.
    pub(super) fn is_fixed(&self) -> bool {
        self.kind == "fixed" || self.locked.is_some()
    }
}

pub(super) fn parse_document<'a>(text: &'a str, origin: &str) -> Result<Document<'a>, RobotError> {
    Document::parse(text).map_err(|e| RobotError::Syntax {
        origin: origin.into(),
        message: format!("the text is not well-formed XML: {e}"),
    })
}

pub(super) fn elements<'a>(node: Node<'a, 'a>, tag: &str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(move |n| n.is_element() && n.tag_name().name() == tag)
}

pub(super) fn element<'a>(node: Node<'a, 'a>, tag: &str) -> Option<Node<'a, 'a>> {
    elements(node, tag).next()
}

impl<'a> UrdfTree<'a> {
    /// Collects the links and joints of a document.
    pub(super) fn new(document: &'a Document<'a>, origin: &'a str) -> Result<Self, RobotError> {
        let mut tree = Self {
            document,
            origin,
            links: BTreeMap::new(),
            joints: Vec::new(),
            by_name: HashMap::new(),
            carrier: HashMap::new(),
        };
        let root = document.root_element();
        if root.tag_name().name() != "robot" {
            let problem = format!("the root element is <{}>", root.tag_name().name());
            return Err(tree.error(root, problem, "give a URDF, whose root element is <robot>"));
        }
        let is_xacro =
            |n: &Node| n.tag_name().namespace().is_some_and(|space| space.contains("xacro"));
        if let Some(node) = root.descendants().find(|n| n.is_element() && is_xacro(n)) {
            return Err(tree.error(
                node,
                "this is a xacro file".into(),
                "expand it with the program xacro first",
            ));
        }
        tree.add_links(root)?;
        tree.add_joints(root)?;
        Ok(tree)
    }

    fn add_links(&mut self, root: Node<'a, 'a>) -> Result<(), RobotError> {
        for node in elements(root, "link") {
            let name = self.attribute(node, "name")?;
            if self.links.insert(name, Some(node)).is_some() {
                return Err(self.error(
                    node,
                    "the name occurs twice".into(),
                    "give each link its own name",
                ));
            }
        }
        Ok(())
    }

    fn add_joints(&mut self, root: Node<'a, 'a>) -> Result<(), RobotError> {
        for node in elements(root, "joint") {
            let link = |tag| self.attribute(self.child(node, tag)?, "link");
            let (name, kind) = (self.attribute(node, "name")?, self.attribute(node, "type")?);
            let (parent, child) = (link("parent")?, link("child")?);
            let joint = TreeJoint { node, name, kind, parent, child, locked: None };
            if joint.parent == "world" {
                self.links.entry("world").or_insert(None);
            }
            if self.by_name.insert(name, self.joints.len()).is_some() {
                return Err(self.error(
                    node,
                    "the name occurs twice".into(),
                    "give each joint its own name",
                ));
            }
            if let Some(missing) =
                [joint.parent, joint.child].iter().find(|l| !self.links.contains_key(**l))
            {
                return Err(self.error(
                    node,
                    format!("there is no link `{missing}`"),
                    "add the link, or correct the name",
                ));
            }
            if let Some(other) = self.carrier.insert(joint.child, self.joints.len()) {
                let other = self.joints[other].name;
                return Err(self.error(
                    node,
                    format!("link `{}` is already the child of joint `{other}`", joint.child),
                    "make each link the child of one joint",
                ));
            }
            self.joints.push(joint);
        }
        Ok(())
    }

    /// Makes an error at an element, with file and line, the joint or link that it belongs to, and
    /// its tag.
    pub(super) fn error(&self, node: Node, problem: String, remedy: &str) -> RobotError {
        let line = self.document.text_pos_at(node.range().start).row;
        let owner = node
            .ancestors()
            .find(|n| matches!(n.tag_name().name(), "joint" | "link" | "transmission"));
        let owner = owner.filter(|n| n.attribute("name").is_some());
        let tag = format!("<{}>", node.tag_name().name());
        let place = match owner {
            Some(o) if o == node => {
                format!("{} `{}`: ", o.tag_name().name(), o.attribute("name").unwrap_or(""))
            }
            Some(o) => {
                format!("{} `{}`, {tag}: ", o.tag_name().name(), o.attribute("name").unwrap_or(""))
            }
            None => format!("{tag}: "),
        };
        RobotError::Invalid {
            origin: format!("{}:{line}", self.origin),
            place,
            problem,
            remedy: remedy.into(),
        }
    }

    pub(super) fn child(&self, node: Node<'a, 'a>, tag: &str) -> Result<Node<'a, 'a>, RobotError> {
        element(node, tag).ok_or_else(|| self.error(node, format!("<{tag}> is missing"), "add it"))
    }

    pub(super) fn attribute(&self, node: Node<'a, 'a>, name: &str) -> Result<&'a str, RobotError> {
        node.attribute(name)
            .ok_or_else(|| self.error(node, format!("the attribute `{name}` is missing"), "add it"))
    }

    /// Returns the number in an attribute, or `None` if the attribute is absent.
    pub(super) fn number(&self, node: Node<'a, 'a>, name: &str) -> Result<Option<f64>, RobotError> {
        node.attribute(name).map(|text| self.to_number(node, name, text)).transpose()
    }

    /// Converts text to a finite number.
    pub(super) fn to_number(
        &self,
        node: Node<'a, 'a>,
        name: &str,
        text: &str,
    ) -> Result<f64, RobotError> {
        let finite = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        finite.ok_or_else(|| {
            self.error(
                node,
                format!("{name} = \"{text}\" is not a finite number"),
                "write one finite number in SI units",
            )
        })
    }

    /// Returns the three numbers in an attribute, or `None` if the attribute is absent.
    pub(super) fn triple(
        &self,
        node: Node<'a, 'a>,
        name: &str,
    ) -> Result<Option<[f64; 3]>, RobotError> {
        let Some(text) = node.attribute(name) else { return Ok(None) };
        let numbers: Vec<_> = text
            .split_whitespace()
            .map(|t| self.to_number(node, name, t))
            .collect::<Result<_, _>>()?;
        let triple = numbers.try_into().map(Some);
        triple.map_err(|_| {
            self.error(
                node,
                format!("{name} = \"{text}\" is not three numbers"),
                "write three numbers",
            )
        })
    }

    /// Returns xyz \[m\] and rpy \[rad\] of the `<origin>` in an element; zeros if it is absent.
    pub(super) fn origin_of(&self, node: Node<'a, 'a>) -> Result<([f64; 3], [f64; 3]), RobotError> {
        let Some(origin) = element(node, "origin") else { return Ok(Default::default()) };
        let get = |name| Ok(self.triple(origin, name)?.unwrap_or_default());
        Ok((get("xyz")?, get("rpy")?))
    }

    pub(super) fn placement_of(&self, node: Node<'a, 'a>) -> Result<Placement, RobotError> {
        let (translation, [roll, pitch, yaw]) = self.origin_of(node)?;
        let rotation = Rotation3::from_euler_angles(roll, pitch, yaw).into_inner();
        Ok(Placement { rotation, translation: translation.into() })
    }
}
