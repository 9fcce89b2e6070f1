use reachtube_robot::Robot;

/// Shortest time between two knots of a path, s. Accelerations are slopes of velocities, and those
/// between closer samples would be noise.
const KNOTS: f64 = 0.02;

/// A motion that a controller follows: a cubic between knots that have a position and a velocity.
///
/// # Examples
///
/// ```
/// use reachtube_verify::Path;
///
/// // One joint that moves at 2 rad/s from 1 rad on.
/// let path = Path::straight(&[1.0], &[2.0], 0.5);
/// let [q, qd, qdd] = path.at(0.25);
/// assert_eq!((q[0], qd[0], qdd[0]), (1.5, 2.0, 0.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    times: Vec<f64>,
    /// Positions and velocities at the knots, row-major, knots x 2n.
    states: Vec<f64>,
}

impl Path {
    /// Returns the path through states (rad, rad/s; row-major, samples x 2n) at increasing times
    /// (s). Samples that lie closer together than 20 ms are passed over, but for the ends.
    ///
    /// # Panics
    ///
    /// Panics if there are fewer than two samples, or not one state for each time.
    pub(crate) fn through(times: &[f64], states: &[f64]) -> Self {
        assert!(times.len() > 1, "a path has two ends");
        let width = states.len() / times.len();
        assert_eq!(states.len(), width * times.len(), "a path has one state for each time");
        let last = times.len() - 1;
        let mut knots = vec![0];
        for k in 1..last {
            let before = times[knots[knots.len() - 1]];
            if times[k] - before >= KNOTS && times[last] - times[k] >= KNOTS {
                knots.push(k);
            }
        }
        knots.push(last);
        let state = |k: &usize| &states[k * width..(k + 1) * width];
        Self {
            times: knots.iter().map(|k| times[*k]).collect(),
            states: knots.iter().flat_map(state).copied().collect(),
        }
    }

    /// Returns the path of joints that keep their velocities for `duration` s.
    ///
    /// # Panics
    ///
    /// Panics if positions and velocities differ in number.
    #[must_use]
    pub fn straight(q: &[f64], qd: &[f64], duration: f64) -> Self {
        assert_eq!(q.len(), qd.len(), "a state has a position and a velocity for each joint");
        let end: Vec<f64> = q.iter().zip(qd).map(|(q, qd)| q + duration * qd).collect();
        Self { times: vec![0.0, duration], states: [q, qd, &end, qd].concat() }
    }

    pub(crate) fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Returns positions, velocities and accelerations, n each, at a time (s); before the start and
    /// after the end the cubic continues.
    #[must_use]
    pub fn at(&self, time: f64) -> [Vec<f64>; 3] {
        let n = self.states.len() / self.times.len() / 2;
        let after = self.times[1..self.times.len() - 1].partition_point(|t| *t <= time);
        let h = self.times[after + 1] - self.times[after];
        let s = (time - self.times[after]) / h;
        let knot = |k: usize, i: usize| self.states[k * 2 * n + i];
        let of = |i: usize| {
            let (p, v, end, w) =
                (knot(after, i), knot(after, n + i), knot(after + 1, i), knot(after + 1, n + i));
            // p + v h s + b s² + a s³ with the position and the velocity of the other knot.
            let rise = end - p - h * v;
            let turn = h * (w - v);
            let (b, a) = (3.0 * rise - turn, turn - 2.0 * rise);
            [
                p + s * (h * v + s * (b + s * a)),
                v + s * (2.0 * b + 3.0 * s * a) / h,
                (2.0 * b + 6.0 * s * a) / (h * h),
            ]
        };
        let all: Vec<[f64; 3]> = (0..n).map(of).collect();
        [0, 1, 2].map(|part| all.iter().map(|values| values[part]).collect())
    }
}

/// Returns the motor torque of a motion by the robot's equations, friction included \[N m; N\].
pub(super) fn feed_forward(robot: &Robot, [q, qd, qdd]: &[Vec<f64>; 3]) -> Vec<f64> {
    let motion = robot.inverse_dynamics(q, qd, qdd);
    let friction = robot.viscous_torque(qd) + robot.coulomb_torque(q, qd);
    (motion + friction).as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_meets_its_knots_and_its_derivatives_are_slopes() {
        let times: Vec<f64> = (0..40).map(|k| 0.004 * f64::from(k)).collect();
        let state = |t: &f64| [(3.0 * t).sin(), t * t, 3.0 * (3.0 * t).cos(), 2.0 * t];
        let states: Vec<f64> = times.iter().flat_map(state).collect();
        let path = Path::through(&times, &states);
        for k in 0..150 {
            let t = 0.001 * f64::from(k);
            let [q, qd, qdd] = path.at(t);
            let exact = state(&t);
            assert!((q[0] - exact[0]).abs() < 1e-6 && (q[1] - exact[1]).abs() < 1e-12);
            assert!((qd[0] - exact[2]).abs() < 1e-4 && (qdd[1] - 2.0).abs() < 1e-9, "{t}");
            assert!((qdd[0] + 9.0 * exact[0]).abs() < 0.02, "{t} {}", qdd[0]);
        }
    }
}
