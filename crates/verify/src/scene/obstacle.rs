use serde::Serialize;

/// A convex body that the robot must not touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Its name, unique in the scene.
    pub name: String,
    /// Its shape at the start of a motion.
    pub solid: Solid,
    /// The speed at which it grows to all sides, m/s; 0 for one that stands still.
    pub speed: f64,
    /// The joints that move the links which must stay clear of it; `None` for all links.
    pub joints: Option<Vec<usize>>,
}

/// A convex shape in the base frame of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Solid {
    /// All points x with normal · x <= offset.
    HalfSpace {
        /// The normal, which points away from the obstacle; of any length above 0.
        normal: [f64; 3],
        /// The offset, m times the length of the normal.
        offset: f64,
    },
    /// A box.
    Box {
        /// Centre \[m\].
        centre: [f64; 3],
        /// The directions of its sides, of length 1.
        axes: [[f64; 3]; 3],
        /// Half the length of each side \[m\].
        half: [f64; 3],
    },
    /// All points within a radius of a segment.
    Capsule {
        /// One end \[m\].
        from: [f64; 3],
        /// The other end \[m\].
        to: [f64; 3],
        /// Radius \[m\].
        radius: f64,
    },
}

impl Obstacle {
    pub(crate) fn concerns(&self, joint: usize) -> bool {
        self.joints.as_ref().is_none_or(|joints| joints.contains(&joint))
    }
}
