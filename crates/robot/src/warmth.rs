//! Robots at a temperature, or at a run since their start.

use crate::friction::warming::WarmingBy;
use crate::robot::Robot;

impl Robot {
    /// Returns the quantities that the friction of the joints depends on, without repeats: what a
    /// user of the robot has to know. The list is empty for friction that does not change.
    #[must_use]
    pub fn warms_by(&self) -> Vec<WarmingBy> {
        let mut all = Vec::new();
        for law in self.joints.iter().filter_map(|joint| joint.friction.warming) {
            if !all.contains(&law.by) {
                all.push(law.by);
            }
        }
        all
    }

    /// Returns the robot with its joints at these temperatures \[°C\], n.
    ///
    /// The friction of joints whose law depends on temperature takes its value, and loses the law.
    /// Other joints do not change.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    /// use reachtube_robot::friction::Warming;
    ///
    /// let mut description = Robot::lwa4p().description().clone();
    /// let law = Warming { reference: 30.0, viscous: 0.01, ..Warming::default() };
    /// description.joints[0].friction.warming = Some(law);
    /// let robot = Robot::from_description(&description)?;
    /// let (warm, qd) = (robot.at_temperature(&[40.0; 6]), [0.5; 6]);
    /// let ratio = warm.viscous_torque(&qd)[0] / robot.viscous_torque(&qd)[0];
    /// assert!((ratio - f64::exp(-0.1)).abs() < 1e-12);
    /// # Ok::<(), reachtube_robot::RobotError>(())
    /// ```
    ///
    /// # Panics
    ///
    /// Panics if there is not one temperature per joint.
    #[must_use]
    pub fn at_temperature(&self, temperatures: &[f64]) -> Self {
        assert_eq!(temperatures.len(), self.joint_count(), "one temperature per joint is needed");
        self.with_warmth(|joint, by| (by == WarmingBy::Temperature).then(|| temperatures[joint]))
    }

    /// Returns the robot at a run since its start, from 1.
    ///
    /// The friction of joints whose law depends on runs takes its value, and loses the law. Other
    /// joints do not change.
    ///
    /// # Panics
    ///
    /// Panics if `run` is not at least 1.
    #[must_use]
    pub fn at_run(&self, run: f64) -> Self {
        assert!(run >= 1.0, "runs count from 1");
        self.with_warmth(|_, by| (by != WarmingBy::Temperature).then_some(run))
    }

    /// Returns the robot whose laws are evaluated where `value` knows the quantity of a joint.
    fn with_warmth(&self, value: impl Fn(usize, WarmingBy) -> Option<f64>) -> Self {
        let mut robot = self.clone();
        let descriptions = robot.description.joints.iter_mut().zip(&mut robot.joints);
        for (i, (description, joint)) in descriptions.enumerate() {
            let Some(law) = description.friction.warming else { continue };
            if let Some(value) = value(i, law.by) {
                description.friction = description.friction.scaled(law.factors(value));
                joint.friction = description.friction.friction();
            }
        }
        robot
    }
}
