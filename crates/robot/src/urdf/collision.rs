//! The collision shapes of a URDF's moving links.

use super::document::{UrdfTree, element, elements, parse_document};
use super::read::Urdf;
use crate::error::RobotError;
use crate::placement::Placement;
use roxmltree::Node;

/// A shape of a moving link, or of a link that is fixed to it, for collision tests.
#[derive(Clone, Debug, PartialEq)]
pub struct CollisionShape {
    /// Index of the joint that moves the shape, from 0.
    pub joint: usize,
    /// The link that the shape belongs to.
    pub link: String,
    /// The shape's frame in the frame of the link that the joint moves.
    pub placement: Placement,
    /// The shape.
    pub shape: Shape,
}

/// A shape about the origin of its frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box.
    Box {
        /// Whole side lengths along x, y and z \[m\].
        size: [f64; 3],
    },
    /// A cylinder about z.
    Cylinder {
        /// Radius \[m\].
        radius: f64,
        /// Length \[m\].
        length: f64,
    },
    /// A sphere.
    Sphere {
        /// Radius \[m\].
        radius: f64,
    },
    /// A mesh; its file is not opened here.
    Mesh {
        /// The file, as the URDF writes it.
        file: String,
        /// Factors of the file's coordinates x, y and z; 1 if the URDF has none.
        scale: [f64; 3],
    },
}

impl Urdf {
    /// Returns the `<collision>` shapes of the links that the joints move, and of links that are
    /// fixed to them, from base to tip.
    ///
    /// # Errors
    ///
    /// Returns a [`RobotError`] with file, line, link and remedy for a shape without its numbers.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::{Shape, Urdf, UrdfOptions};
    ///
    /// let text = r#"<robot name="pendulum"><link name="base"/>
    ///   <link name="arm"><inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
    ///     <collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    ///   <joint name="hinge" type="continuous">
    ///     <parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint></robot>"#;
    /// let urdf = Urdf::parse(text, "pendulum.urdf", &UrdfOptions::default())?;
    /// assert_eq!(urdf.collision_shapes()?[0].shape, Shape::Sphere { radius: 0.1 });
    /// # Ok::<(), reachtube_robot::RobotError>(())
    /// ```
    pub fn collision_shapes(&self) -> Result<Vec<CollisionShape>, RobotError> {
        let document = parse_document(&self.text, &self.origin)?;
        let mut tree = UrdfTree::new(&document, &self.origin)?;
        tree.lock(&self.locks)?;
        let mut shapes = Vec::new();
        for (joint, moved) in self.moved.iter().enumerate() {
            for link in core::iter::once(&moved.link).chain(&moved.lumped) {
                let Some((name, Some(node))) = tree.links.get_key_value(link.as_str()) else {
                    continue;
                };
                let in_moved = tree.placement_in(name, &moved.link)?;
                for collision in elements(*node, "collision") {
                    let placement = in_moved.then(&tree.placement_of(collision)?);
                    let shape = tree.shape(collision)?;
                    shapes.push(CollisionShape { joint, link: link.clone(), placement, shape });
                }
            }
        }
        Ok(shapes)
    }
}

impl<'a> UrdfTree<'a> {
    /// Returns the placement of a link in a link that it is fixed to.
    fn placement_in(&self, link: &'a str, carrier: &str) -> Result<Placement, RobotError> {
        let between = self.above(link).take_while(|k| self.joints[*k].child != carrier);
        let joints: Vec<_> = between.collect();
        joints.into_iter().rev().try_fold(Placement::identity(), |placement, k| {
            Ok(placement.then(&self.placement_when_held(&self.joints[k])?))
        })
    }

    /// Returns the shape of a `<collision>`.
    fn shape(&self, collision: Node<'a, 'a>) -> Result<Shape, RobotError> {
        let geometry = self.child(collision, "geometry")?;
        if let Some(mesh) = element(geometry, "mesh") {
            let file = self.attribute(mesh, "filename")?.into();
            return Ok(Shape::Mesh { file, scale: self.scale(mesh)? });
        }
        if let Some(sphere) = element(geometry, "sphere") {
            return Ok(Shape::Sphere { radius: self.size(sphere, "radius")? });
        }
        if let Some(node) = element(geometry, "cylinder") {
            let (radius, length) = (self.size(node, "radius")?, self.size(node, "length")?);
            return Ok(Shape::Cylinder { radius, length });
        }
        let sides = self.child(geometry, "box")?;
        let size = self.triple(sides, "size")?.filter(|size| size.iter().all(|x| *x > 0.0));
        let problem = || "size is not three lengths above 0".into();
        let size =
            size.ok_or_else(|| self.error(sides, problem(), "write three lengths above 0, in m"))?;
        Ok(Shape::Box { size })
    }

    fn scale(&self, mesh: Node<'a, 'a>) -> Result<[f64; 3], RobotError> {
        let scale = self.triple(mesh, "scale")?.unwrap_or([1.0; 3]);
        if scale.iter().all(|factor| *factor != 0.0) {
            return Ok(scale);
        }
        let remedy = "write three factors, as in scale=\"0.001 0.001 0.001\"";
        Err(self.error(mesh, "scale has a factor of 0".into(), remedy))
    }

    /// Returns a length above 0.
    fn size(&self, node: Node<'a, 'a>, name: &str) -> Result<f64, RobotError> {
        let text = self.attribute(node, name)?;
        let length = self.to_number(node, name, text)?;
        if length > 0.0 {
            return Ok(length);
        }
        let problem = format!("{name} = \"{text}\" is not above 0");
        Err(self.error(node, problem, "write a length above 0, in m"))
    }
}
