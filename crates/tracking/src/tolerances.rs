//! Tolerances of controllers that neither a recorded motion nor one like it breaks.

use std::fmt::Write;

use reachtube_files::MARK;
use reachtube_scalar::Interval;
use reachtube_scalar::number::two_digits_up;
use reachtube_scalar::rounding::{add_up, mul_up};

use crate::model::{JointTracking, TrackingModel};

impl JointTracking {
    /// Returns the largest |y - r| that a model with a delay and a usual step \[s\] allows where a
    /// command has come to rest, with any recorded acceleration, and for any command up to the
    /// recorded speed and acceleration, rad.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding. Between samples a command is faster than at them by what its
    /// acceleration does within half a step.
    #[must_use]
    pub fn largest_deviations(&self, [delay, step]: [f64; 2]) -> [f64; 2] {
        let product = |(factor, largest): (f64, f64)| mul_up(factor.abs(), largest);
        let accelerated = product((self.acceleration, self.largest_acceleration));
        let at_rest = add_up(add_up(self.offset.abs(), self.radius), accelerated);
        let terms = [
            (self.speed, self.largest_speed),
            (delay, self.largest_speed),
            (mul_up(delay, step), self.largest_acceleration),
            (self.radius_per_speed, self.largest_speed),
            (self.direction, 1.0),
        ];
        [at_rest, terms.into_iter().map(product).fold(at_rest, add_up)]
    }
}

/// How far each joint can be from a plan, up to a part of the recorded speeds.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanDeviations {
    /// The part of the recorded speeds.
    pub part: f64,
    /// From the position that is planned for the same time, rad.
    pub at_the_same_time: Vec<f64>,
    /// From the position that was planned for [`late_by`](Self::late_by) before, rad: how far the
    /// arm is from its path.
    pub along_the_path: Vec<f64>,
    /// The time by which the arm as a whole is late, s.
    pub late_by: f64,
}

impl TrackingModel {
    /// Returns how far each joint can be from a plan whose speeds are at most a part of the
    /// recorded ones, and whose accelerations at most the square of it.
    ///
    /// Along the path the time by which the arm is late is one number for all joints: of the lags
    /// of the joints the one with the smallest sum of deviations. With it, a position of the plan
    /// is known to as much as its speed can change within half a step of the recordings.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, for plans with samples as often as the recordings, and speeds and
    /// accelerations that are bounded so at every time.
    #[must_use]
    pub fn deviations(&self, part: f64) -> PlanDeviations {
        let of = |late: f64| -> Vec<f64> {
            let after_delay = Interval::point(late) - self.delay;
            let of_joint = |joint: &JointTracking| {
                let bound = joint.deviation(part, after_delay, self.step);
                if self.delay == 0.0 {
                    return bound.hi();
                }
                // The delayed command is straight between samples.
                let step = Interval::point(self.step);
                let largest = Interval::point(part).sqr() * joint.largest_acceleration;
                (bound + step.sqr() * 0.125 * largest).hi()
            };
            self.joints.iter().map(of_joint).collect()
        };
        let sum = |late: &f64| of(*late).iter().sum::<f64>();
        let lags = self.joints.iter().map(|joint| self.delay - joint.speed);
        let lags = lags.chain([self.delay, 0.0]).filter(|lag| *lag >= 0.0);
        let late_by = lags.min_by(|a, b| sum(a).total_cmp(&sum(b))).unwrap_or(0.0);
        PlanDeviations { part, at_the_same_time: of(0.0), along_the_path: of(late_by), late_by }
    }
}

impl JointTracking {
    /// Bounds |y(t) - r(t - delay - late)| for commands up to a part of the recorded speed. The
    /// speed of the parabola through three samples differs from the command's by what it can change
    /// within half a step.
    fn deviation(&self, part: f64, late: Interval, step: f64) -> Interval {
        let point = Interval::point;
        let speed = point(part) * self.largest_speed;
        let acceleration = point(part).sqr() * self.largest_acceleration;
        let by_speed = (late + self.speed).abs() + point(self.radius_per_speed);
        let by_acceleration =
            point(self.acceleration.abs()) + late.sqr() * 0.5 + late.abs() * point(step) * 0.5;
        let fixed = point(self.offset.abs()) + self.direction.abs() + self.radius;
        fixed + by_speed * speed + by_acceleration * acceleration
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
             two digits.\n{}constraints:\n",
            self.condition_lines()
        );
        for joint in &self.joints {
            let [at_rest, along] = joint.largest_deviations([self.delay, self.step]);
            let _ = writeln!(text, "  {}:", joint.name);
            let speed = two_digits_up(joint.largest_speed);
            let [along, goal] = [along, at_rest].map(two_digits_up);
            let _ = writeln!(text, "    trajectory: {along}  # up to {speed} {}/s", joint.unit);
            let _ = writeln!(text, "    goal: {goal}");
        }
        text
    }

    /// Returns the [`conditions`](Self::conditions) as comments of a file.
    #[must_use]
    pub fn condition_lines(&self) -> String {
        self.conditions().iter().map(|line| format!("# {line}\n")).collect()
    }
}
