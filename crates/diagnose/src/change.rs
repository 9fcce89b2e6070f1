use reachtube_recordings::Torque;

/// How each recorded number is read.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// The recorded torques.
    pub torque: Torque,
    /// Factor of the positions and velocities of each joint, n.
    pub motion_factors: Vec<f64>,
    /// What the recorded position of each joint exceeds the true one by, n, rad or m.
    pub offsets: Vec<f64>,
    /// The joint whose columns hold the position and velocity of each joint, n.
    pub motion_columns: Vec<usize>,
    /// Factor of each torque, n.
    pub torque_factors: Vec<f64>,
    /// The joint whose column holds the torque of each joint, n.
    pub torque_columns: Vec<usize>,
    /// Time by which the torque of each joint is later than the motion, n, s.
    pub lags: Vec<f64>,
    /// Whether dry friction holds joints near standstill, and is spread as the torques are by a
    /// filter; of motor torques.
    pub softened: bool,
    /// The position whose mass matrix stands for all, as model 1 has it, without Coriolis terms; n,
    /// or `None` for the robot itself.
    pub inertia_at: Option<Vec<f64>>,
}

impl Change {
    /// Returns the reading of recordings as they are, with torques of this kind.
    #[must_use]
    pub fn none(torque: Torque, joints: usize) -> Self {
        Self {
            torque,
            motion_factors: vec![1.0; joints],
            offsets: vec![0.0; joints],
            motion_columns: (0..joints).collect(),
            torque_factors: vec![1.0; joints],
            torque_columns: (0..joints).collect(),
            lags: vec![0.0; joints],
            softened: false,
            inertia_at: None,
        }
    }

    /// Returns the positions that the recorded ones mean.
    pub(crate) fn q(&self, recorded: &[f64]) -> Vec<f64> {
        self.rates(recorded).iter().zip(&self.offsets).map(|(q, offset)| q - offset).collect()
    }

    /// Returns the velocities or accelerations that the recorded ones mean.
    pub(crate) fn rates(&self, recorded: &[f64]) -> Vec<f64> {
        let columns = self.motion_columns.iter().zip(&self.motion_factors);
        columns.map(|(column, factor)| factor * recorded[*column]).collect()
    }

    /// Returns whether another change reads the motion as this one does.
    pub(crate) fn has_motion_of(&self, other: &Self) -> bool {
        self.inertia_at == other.inertia_at
            && self.motion_columns == other.motion_columns
            && self.motion_factors == other.motion_factors
            && self.offsets == other.offsets
    }
}
