//! Point-to-point motions and the input that is recorded along them.

use reachtube_robot::Robot;

use crate::random::SplitMix64;

/// Peak speed of the fastest joint of a motion, rad/s: from, to.
const PEAK_SPEED: [f64; 2] = [0.5, 1.0];

/// Speed that no joint exceeds, over its limit: the open loop may be faster than planned.
const SPEED_SHARE: f64 = 0.9;

/// The middle part of each joint's position range that motions stay in.
const POSITION_SHARE: f64 = 0.4;

/// The slowest joint's travel over the fastest joint's, at least.
const LEAST_TRAVEL: f64 = 0.1;

/// Peak of the derivative of the quintic from 0 to 1 in unit time.
const QUINTIC_PEAK: f64 = 1.875;

/// A point-to-point motion of all joints at once, at rest at both ends.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Motion {
    /// Positions at the start, rad.
    pub start: Vec<f64>,
    /// From start to end, rad.
    pub travel: Vec<f64>,
    /// s.
    pub duration: f64,
}

/// A state and its rate of change: q rad, q̇ rad/s, q̈ rad/s².
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Planned {
    pub q: Vec<f64>,
    pub qd: Vec<f64>,
    pub qdd: Vec<f64>,
}

impl Motion {
    /// A motion within the robot's position and speed limits.
    pub fn random(robot: &Robot, duration: f64, random: &mut SplitMix64) -> Self {
        let joints = robot.joints();
        let share: Vec<f64> =
            joints.iter().map(|_| random.sign() * random.uniform(LEAST_TRAVEL, 1.0)).collect();
        let fastest = share.iter().fold(0.0, |most: f64, s| most.max(s.abs()));
        let peak = random.uniform(PEAK_SPEED[0], PEAK_SPEED[1]);
        let mut travel: Vec<f64> =
            share.iter().map(|s| s / fastest * peak * duration / QUINTIC_PEAK).collect();
        let slack = joints.iter().zip(&travel).map(|(joint, travel)| {
            let speed = SPEED_SHARE * joint.velocity_limit.unwrap_or(f64::INFINITY);
            (2.0 * half_range(joint.position_limits)).min(speed * duration / QUINTIC_PEAK) / travel.abs()
        });
        let scale = slack.fold(1.0, f64::min);
        travel.iter_mut().for_each(|t| *t *= scale);
        let start = joints.iter().zip(&travel).map(|(joint, travel)| {
            let [low, high] = joint.position_limits;
            let room = half_range(joint.position_limits) - 0.5 * travel.abs();
            0.5 * (low + high) - 0.5 * travel + random.uniform(-room, room)
        });
        Self { start: start.collect(), travel, duration }
    }

    /// The plan at time `t` s: q = start + s(t / T) travel with s = 10 x³ - 15 x⁴ + 6 x⁵; at rest outside [0, T].
    pub fn at(&self, t: f64) -> Planned {
        let x = (t / self.duration).clamp(0.0, 1.0);
        let rest = 1.0 - x;
        let s = x * x * x * (10.0 + x * (6.0 * x - 15.0));
        let rate = 30.0 * (x * rest).powi(2) / self.duration;
        let bend = 60.0 * x * rest * (1.0 - 2.0 * x) / self.duration.powi(2);
        Planned {
            q: self.start.iter().zip(&self.travel).map(|(start, travel)| start + s * travel).collect(),
            qd: self.travel.iter().map(|travel| rate * travel).collect(),
            qdd: self.travel.iter().map(|travel| bend * travel).collect(),
        }
    }

    /// The input (11) that moves the nominal robot along the plan at time `t` s: u = M_m q̈ + c + τ_v, N m.
    pub fn input(&self, robot: &Robot, t: f64) -> Vec<f64> {
        let Planned { q, qd, qdd } = self.at(t);
        let link = robot.inverse_dynamics(&q, &qd, &qdd);
        robot.input_from_link_torque(&q, &qd, link.as_slice()).data.into()
    }
}

fn half_range([low, high]: [f64; 2]) -> f64 {
    0.5 * POSITION_SHARE * (high - low)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn motions_keep_the_limits(seed: u64, duration in 0.5..20.0f64) {
            let robot = Robot::lwa4p();
            let motion = Motion::random(&robot, duration, &mut SplitMix64::new(seed));
            let mut peak = 0.0f64;
            for k in 0..=200 {
                let plan = motion.at(duration * f64::from(k) / 200.0);
                for (i, joint) in robot.joints().iter().enumerate() {
                    let [low, high] = joint.position_limits;
                    prop_assert!(low < plan.q[i] && plan.q[i] < high);
                    prop_assert!(plan.qd[i].abs() <= 0.9 * 1.2);
                    peak = peak.max(plan.qd[i].abs());
                }
            }
            prop_assert!(duration > 4.0 || (0.5..=1.0).contains(&peak), "{peak}");
        }

        #[test]
        fn velocity_and_acceleration_are_derivatives(seed: u64, t in 0.01..2.99f64) {
            let motion = Motion::random(&Robot::lwa4p(), 3.0, &mut SplitMix64::new(seed));
            let (before, plan, after) = (motion.at(t - 1e-4), motion.at(t), motion.at(t + 1e-4));
            for i in 0..6 {
                prop_assert!(((after.q[i] - before.q[i]) / 2e-4 - plan.qd[i]).abs() < 1e-6);
                prop_assert!(((after.qd[i] - before.qd[i]) / 2e-4 - plan.qdd[i]).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_motion_goes_from_rest_to_rest() {
        let motion = Motion::random(&Robot::lwa4p(), 3.0, &mut SplitMix64::new(1));
        assert_eq!(motion.at(0.0).q, motion.start);
        for (end, (start, travel)) in motion.at(3.0).q.iter().zip(motion.start.iter().zip(&motion.travel)) {
            assert!((end - start - travel).abs() < 1e-12);
        }
        for t in [0.0, 3.0, 4.0] {
            assert!(motion.at(t).qd.iter().chain(&motion.at(t).qdd).all(|x| *x == 0.0));
        }
    }

    #[test]
    fn the_input_moves_the_nominal_robot_as_planned() {
        let robot = Robot::lwa4p();
        let motion = Motion::random(&robot, 3.0, &mut SplitMix64::new(2));
        let plan = motion.at(1.0);
        let net = robot.gravity_torque(&plan.q) - robot.viscous_torque(&plan.qd)
            + nalgebra::DVector::from_vec(motion.input(&robot, 1.0));
        let qdd = robot.forward_acceleration(&plan.q, &plan.qd, net.as_slice());
        assert!((qdd - nalgebra::DVector::from_vec(plan.qdd)).amax() < 1e-12);
    }
}
