use reachtube_recordings::Torque;

/// What most likely makes an answer implausible. Parts are of the recorded input.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Cause {
    /// The recordings mean something else than was stated.
    Reading {
        /// What they mean, as a clause.
        clause: String,
        /// The kind of the torques, if that was stated wrongly.
        kind: Option<Torque>,
        /// The part that the recorded motion does not explain under this reading.
        unexplained: f64,
        /// The part that it does not explain as stated.
        as_stated: f64,
    },
    /// A motion that was held out made calibration scale the sets by much.
    HeldOut {
        /// The motion.
        motion: String,
        /// The motions that the sets were found with.
        fitted: Vec<String>,
        /// The factor of the sets.
        factor: f64,
    },
    /// The positions lie far from the point about which deviations have the robot's inertia.
    ExpansionPoint {
        /// The largest distance, rad.
        distance: f64,
        /// The mean of the positions, n, rad.
        mean: Vec<f64>,
    },
    /// The robot explains the recordings, and the constant inertia of model 1 does not.
    ConstantInertia {
        /// The part that the robot does not explain.
        by_robot: f64,
        /// The part that model 1 does not explain.
        by_model: f64,
        /// How far the positions lie from the expansion point, rad.
        distance: f64,
        /// The mean of the positions, n, rad, and the part that model 1 does not explain about it,
        /// where that is much less.
        about_mean: Option<(Vec<f64>, f64)>,
        /// Whether nominal motions can follow the robot's own equations instead.
        can_follow_robot: bool,
    },
    /// The robot explains the recordings, which are long: a prediction widens with time.
    Horizon {
        /// The part that is not explained.
        unexplained: f64,
        /// The end of the longest recording, s.
        longest: f64,
    },
    /// The recorded motion does not explain the input, however the recordings are read.
    Parameters {
        /// The part that is not explained.
        unexplained: f64,
        /// Whether the robot was identified from recordings already.
        is_identified: bool,
        /// Whether the nominal model was fitted for small sets already.
        is_fitted: bool,
        /// The end of the longest recording, s.
        longest: f64,
    },
}
