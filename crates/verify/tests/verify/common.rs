//! Random numbers, robots and distances.

use nalgebra::Vector3;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use reachtube_robot::{Robot, Urdf, UrdfOptions};
use reachtube_verify::Capsule;

pub(crate) struct Random(Xoshiro256PlusPlus);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// Uniform in [-1, 1].
    pub(crate) fn signed(&mut self) -> f64 {
        2.0 * ((self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64) - 1.0
    }

    pub(crate) fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| size * self.signed()).collect()
    }
}

/// A robot with a slide between two hinges, whose axes and frames lie askew.
pub(crate) fn askew() -> Urdf {
    let link = |name: &str, collision: &str| {
        format!(
            "<link name=\"{name}\"><inertial><mass value=\"1\"/>\
             <inertia ixx=\"1\" iyy=\"1\" izz=\"1\"/></inertial>{collision}</link>"
        )
    };
    let joint = |name: &str, kind: &str, [parent, child]: [&str; 2], more: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/>{more}</joint>"
        )
    };
    let shape = |origin: &str, shape: &str| {
        format!("<collision><origin {origin}/><geometry>{shape}</geometry></collision>")
    };
    let text = [
        "<robot name=\"askew\"><link name=\"base\"/>".to_string(),
        link("a", &shape("xyz=\"0.1 0 0.2\" rpy=\"0.3 -0.4 1\"", "<box size=\"0.1 0.4 0.2\"/>")),
        link("b", &shape("xyz=\"0 0.1 0\"", "<sphere radius=\"0.07\"/>")),
        link("c", ""),
        link("d", &shape("rpy=\"1 0 0\"", "<cylinder radius=\"0.05\" length=\"0.3\"/>")),
        joint("hinge", "continuous", ["base", "a"], "<axis xyz=\"0.3 -0.5 1\"/>"),
        joint(
            "slide",
            "prismatic",
            ["a", "b"],
            "<origin xyz=\"0.2 0.1 0.4\" rpy=\"0.2 0.9 -0.3\"/><axis xyz=\"1 1 0.2\"/>\
             <limit lower=\"-4\" upper=\"4\"/>",
        ),
        joint(
            "wrist",
            "continuous",
            ["b", "c"],
            "<origin xyz=\"0 0.3 0.1\" rpy=\"-1 0.1 0.6\"/><axis xyz=\"0 1 0\"/>",
        ),
        joint("flange", "fixed", ["c", "d"], "<origin xyz=\"0.1 0 0.2\" rpy=\"0 0 0.7\"/>"),
        "</robot>".to_string(),
    ];
    Urdf::parse(&text.concat(), "askew.urdf", &UrdfOptions::default()).unwrap()
}

/// The ends of a capsule in the base frame, by the robot's own kinematics in double precision.
pub(crate) fn placed(robot: &Robot, capsule: &Capsule, q: &[f64]) -> [Vector3<f64>; 2] {
    let frame = &robot.link_placements(q)[capsule.joint];
    [capsule.from, capsule.to].map(|end| frame.rotation * Vector3::from(end) + frame.translation)
}

/// The distance of a point from a segment.
pub(crate) fn distance(p: Vector3<f64>, [a, b]: [Vector3<f64>; 2]) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(&along) / along.norm_squared().max(1e-300)).clamp(0.0, 1.0);
    (p - a - t * along).norm()
}
