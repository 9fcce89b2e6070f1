use serde::Serialize;

/// A capsule of a link: all points within `radius` of the segment from `from` to `to`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Capsule {
    /// Index of the joint that moves the link, from 0.
    pub joint: usize,
    /// One end of the segment, in the link's frame of the robot's description \[m\].
    pub from: [f64; 3],
    /// The other end \[m\].
    pub to: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
}
