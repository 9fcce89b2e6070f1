/// A joint, as far as reading its recordings needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The name, by which columns of logs are found.
    pub name: String,
    /// Whether positions are angles, which differ by whole turns; else they are lengths.
    pub is_revolute: bool,
    /// Units of position, velocity and torque.
    pub units: [&'static str; 3],
    /// Lowest and highest position.
    pub position_limits: Option<[f64; 2]>,
    /// Highest speed.
    pub velocity_limit: Option<f64>,
}

impl Axis {
    /// Returns the unit that positions have by mistake.
    pub(crate) fn other_unit(&self) -> &'static str {
        if self.is_revolute { "degrees" } else { "mm" }
    }
}
