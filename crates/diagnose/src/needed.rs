/// Torques of a recording beside the ones that its motion needs of a robot, in rows of n values at
/// the same times. Both are filtered alike.
#[derive(Debug, Clone)]
pub struct NeededTorques<'a> {
    /// Time between samples, s.
    pub step: f64,
    /// Positions, velocities and accelerations, rad and s.
    pub motion: [&'a [f64]; 3],
    /// The recorded torques, N m.
    pub recorded: &'a [f64],
    /// The torques that the motion needs, with friction, N m.
    pub needed: Vec<f64>,
}
