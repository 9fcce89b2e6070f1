//! Point-to-point motions and the input that is recorded along them.

use reachtube_robot::Robot;

/// Peak of the derivative of the quintic from 0 to 1 in unit time.
pub(crate) const QUINTIC_PEAK: f64 = 1.875;

/// Time between samples, over which an input is held \[s\]: 250 Hz, as for the paper's robot.
pub(crate) const SAMPLE_TIME: f64 = 0.004;

/// A point-to-point motion of all n joints at once, at rest at both ends.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Motion {
    /// Positions at the start \[rad\], n.
    pub start: Vec<f64>,
    /// Positions at the end minus positions at the start \[rad\], n.
    pub travel: Vec<f64>,
    /// Duration \[s\].
    pub duration: f64,
}

/// A state and its rate of change, n each.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Planned {
    /// Positions \[rad\].
    pub q: Vec<f64>,
    /// Velocities \[rad/s\].
    pub qd: Vec<f64>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<f64>,
}

impl Motion {
    /// Returns a motion of one joint by `travel` \[rad\], with the others at rest.
    pub(crate) fn along(start: Vec<f64>, joint: usize, travel: f64, duration: f64) -> Self {
        let travel = (0..start.len()).map(|i| if i == joint { travel } else { 0.0 }).collect();
        Self { start, travel, duration }
    }

    pub(crate) fn cycles(&self) -> usize {
        (self.duration / SAMPLE_TIME).round() as usize
    }

    /// Returns the plan at time `t` \[s\]: q = start + s(t / T) travel with
    /// s(x) = 10 x³ - 15 x⁴ + 6 x⁵; at rest outside \[0, T\].
    pub(crate) fn at(&self, t: f64) -> Planned {
        let x = (t / self.duration).clamp(0.0, 1.0);
        let rest = 1.0 - x;
        let s = x * x * x * (10.0 + x * (6.0 * x - 15.0));
        let rate = 30.0 * (x * rest).powi(2) / self.duration;
        let bend = 60.0 * x * rest * (1.0 - 2.0 * x) / self.duration.powi(2);
        Planned {
            q: self
                .start
                .iter()
                .zip(&self.travel)
                .map(|(start, travel)| start + s * travel)
                .collect(),
            qd: self.travel.iter().map(|travel| rate * travel).collect(),
            qdd: self.travel.iter().map(|travel| bend * travel).collect(),
        }
    }

    /// Returns the input (11) that moves the nominal robot along the plan at time `t` \[s\]:
    /// u = M_m q̈ + c + τ_v \[N m\], n.
    pub(crate) fn input(&self, robot: &Robot, t: f64) -> Vec<f64> {
        let Planned { q, qd, qdd } = self.at(t);
        let link = robot.inverse_dynamics(&q, &qd, &qdd);
        robot.input_from_link_torque(&q, &qd, link.as_slice()).data.into()
    }

    /// Returns the input to hold over sample `k` \[N m\], n: the input in the middle of the sample,
    /// which follows the plan better than the one at its start.
    pub(crate) fn held_input(&self, robot: &Robot, k: usize) -> Vec<f64> {
        self.input(robot, (k as f64 + 0.5) * SAMPLE_TIME)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::random::{SeedableRng, SplitMix64};

    proptest! {
        #[test]
        fn velocity_and_acceleration_are_derivatives(seed: u64, t in 0.01..2.99f64) {
            let motion = Motion::random(&Robot::lwa4p(), 3.0, &mut SplitMix64::seed_from_u64(seed));
            let (before, plan, after) = (motion.at(t - 1e-4), motion.at(t), motion.at(t + 1e-4));
            for i in 0..6 {
                prop_assert!(((after.q[i] - before.q[i]) / 2e-4 - plan.qd[i]).abs() < 1e-6);
                prop_assert!(((after.qd[i] - before.qd[i]) / 2e-4 - plan.qdd[i]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_motion_goes_from_rest_to_rest() {
        let motion = Motion::random(&Robot::lwa4p(), 3.0, &mut SplitMix64::seed_from_u64(1));
        assert_eq!(motion.at(0.0).q, motion.start);
        for (end, (start, travel)) in
            motion.at(3.0).q.iter().zip(motion.start.iter().zip(&motion.travel))
        {
            assert!((end - start - travel).abs() < 1e-12);
        }
        for t in [0.0, 3.0, 4.0] {
            assert!(motion.at(t).qd.iter().chain(&motion.at(t).qdd).all(|x| *x == 0.0));
        }
    }

    #[test]
    fn the_input_moves_the_nominal_robot_as_planned() {
        let robot = Robot::lwa4p();
        let motion = Motion::random(&robot, 3.0, &mut SplitMix64::seed_from_u64(2));
        let plan = motion.at(1.0);
        let net = robot.gravity_torque(&plan.q) - robot.viscous_torque(&plan.qd)
            + nalgebra::DVector::from_vec(motion.input(&robot, 1.0));
        let qdd = robot.forward_acceleration(&plan.q, &plan.qd, net.as_slice());
        assert!((qdd - nalgebra::DVector::from_vec(plan.qdd)).amax() < 1e-12);
    }
}
