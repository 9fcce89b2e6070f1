//! Tolerances of controllers that neither a recorded motion nor one like it breaks.

use std::fmt::Write;

use reachtube_files::MARK;
use reachtube_scalar::number::two_digits_up;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::model::{JointTracking, TrackingModel};

impl JointTracking {
    /// Returns the largest |y - r| that the model allows where a command has come to rest, with any
    /// recorded acceleration, and for any command up to the recorded speed and acceleration, rad.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding.
    #[must_use]
    pub fn largest_deviations(&self) -> [f64; 2] {
        let product = |(factor, largest): (f64, f64)| mul_up(factor.abs(), largest);
        let accelerated = product((self.acceleration, self.largest_acceleration));
        let at_rest = add_up(add_up(self.offset.abs(), self.radius), accelerated);
        let terms = [
            (self.speed, self.largest_speed),
            (self.radius_per_speed, self.largest_speed),
            (self.direction, 1.0),
        ];
        [at_rest, terms.into_iter().map(product).fold(at_rest, add_up)]
    }
}

impl TrackingModel {
    /// Returns the table `constraints` of ROS 2's `joint_trajectory_controller`: for each joint,
    /// the tolerance along a trajectory and at its goal, which is where the command rests.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// use reachtube_files::SealedFile;
    ///
    /// let model = reachtube_tracking::TrackingModel::open("arm/model.json".as_ref())?;
    /// println!("{}", model.ros2_control());
    /// # Ok::<(), reachtube_tracking::Error>(())
    /// ```
    #[must_use]
    pub fn ros2_control(&self) -> String {
        let mut text = format!(
            "# {MARK} export.\n# Tolerances of joint_trajectory_controller, in rad or m: what the \
             model allows for commands that\n# are no faster than the recorded ones, rounded up to \
             two digits.\nconstraints:\n"
        );
        for joint in &self.joints {
            let [at_rest, along] = joint.largest_deviations();
            let _ = writeln!(text, "  {}:", joint.name);
            let speed = two_digits_up(joint.largest_speed);
            let [along, goal] = [along, at_rest].map(two_digits_up);
            let _ = writeln!(text, "    trajectory: {along}  # up to {speed} {}/s", joint.unit);
            let _ = writeln!(text, "    goal: {goal}");
        }
        text
    }
}
