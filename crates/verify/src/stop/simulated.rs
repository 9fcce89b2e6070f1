//! Simulated stops, in floating point. Each step solves for the impulses of brakes and dry friction
//! (Moreau), and shares no code with the enclosure.

use nalgebra::DVector;
use reachtube_robot::Robot;

use crate::stop::deceleration::CYCLE;

/// Rounds of the projection of the impulses.
const ROUNDS: usize = 100;

/// The change of an impulse at which the projection ends, N m s.
const CHANGE: f64 = 1e-14;

/// A joint stands below this speed, rad/s or m/s.
const STANDSTILL: f64 = 1e-7;

/// The most cycles that are simulated: 4 s.
const MOST_CYCLES: usize = 2000;

/// One stop: a state, and what acts after it.
#[derive(Debug, Clone, PartialEq)]
pub struct StopCase {
    /// Positions at the start, n \[rad; m\].
    pub q: Vec<f64>,
    /// Velocities at the start, n \[rad/s; m/s\].
    pub qd: Vec<f64>,
    /// The torque of each brake \[N m; N\].
    pub brake: Vec<f64>,
    /// The time from which the brakes hold, after the drives are off, s.
    pub delay: f64,
    /// Torque added to each joint at all times \[N m; N\].
    pub error: Vec<f64>,
    /// The torques of the drives before they are off, each held for 2 ms: row-major, cycles x n;
    /// empty for category 0.
    pub drive: Vec<f64>,
}

/// A simulated stop.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedStop {
    /// The way of each joint from the start \[rad; m\].
    pub way: Vec<f64>,
    /// The time from which on each joint stands, s.
    pub time: Vec<f64>,
    /// Times 2 ms apart, s, from 0 until standstill.
    pub times: Vec<f64>,
    /// Positions and velocities at these times, row-major, times x 2n.
    pub states: Vec<f64>,
}

impl StopCase {
    /// Simulates the stop by the robot's equations with `steps` steps in 2 ms, until standstill or
    /// for 4 s. At standstill it is of first order: positions are off by about a step times the
    /// speed before. `None` if a mass matrix is not invertible, or the arm diverges.
    ///
    /// # Panics
    ///
    /// Panics if the case is of another number of joints.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    /// use reachtube_verify::StopCase;
    ///
    /// let case = StopCase {
    ///     q: vec![0.0; 6],
    ///     qd: vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    ///     brake: vec![45.0; 6],
    ///     delay: 0.02,
    ///     error: vec![0.0; 6],
    ///     drive: Vec::new(),
    /// };
    /// let stop = case.simulate(&Robot::lwa4p(), 20).unwrap();
    /// assert!(0.005 < stop.way[0] && stop.way[0] < 0.05 && stop.time[0] < 0.1);
    /// ```
    #[must_use]
    pub fn simulate(&self, robot: &Robot, steps: usize) -> Option<SimulatedStop> {
        let n = robot.joint_count();
        let mut arm = Arm::new(robot, self, CYCLE / steps as f64);
        let mut stopped = SimulatedStop {
            way: vec![0.0; n],
            time: vec![0.0; n],
            times: vec![0.0],
            states: [&self.q[..], &self.qd].concat(),
        };
        let cycles = self.drive.len() / n;
        for cycle in 0..MOST_CYCLES {
            let start = CYCLE * cycle as f64;
            for step in 0..steps {
                let time = start + arm.step * step as f64;
                let is_held = cycle >= cycles && time >= self.delay + CYCLE * cycles as f64;
                if step.is_multiple_of(steps.div_ceil(4)) {
                    arm.refresh()?;
                }
                let drive = self.drive.get(cycle * n..(cycle + 1) * n);
                let way = arm.advance(is_held, drive);
                for (j, way) in way.iter().enumerate() {
                    stopped.way[j] += way;
                    if arm.v[j].abs() > STANDSTILL {
                        stopped.time[j] = time + arm.step;
                    }
                }
            }
            stopped.times.push(CYCLE * (cycle + 1) as f64);
            stopped.states.extend(arm.q.iter().chain(&arm.v));
            let is_over = CYCLE * cycle as f64 >= self.delay + CYCLE * cycles as f64;
            if is_over && arm.v.amax() < STANDSTILL {
                break;
            }
        }
        stopped.states.iter().all(|x| x.is_finite()).then_some(stopped)
    }
}

/// The arm while it is simulated.
struct Arm<'a> {
    robot: &'a Robot,
    case: &'a StopCase,
    step: f64,
    q: Vec<f64>,
    v: DVector<f64>,
    /// The impulses of brakes and dry friction in the step before.
    impulse: Vec<f64>,
    inverse: nalgebra::DMatrix<f64>,
    load: DVector<f64>,
}

impl<'a> Arm<'a> {
    fn new(robot: &'a Robot, case: &'a StopCase, step: f64) -> Self {
        let n = robot.joint_count();
        Self {
            robot,
            case,
            step,
            q: case.q.clone(),
            v: DVector::from_column_slice(&case.qd),
            impulse: vec![0.0; n],
            inverse: nalgebra::DMatrix::zeros(n, n),
            load: DVector::zeros(n),
        }
    }

    fn refresh(&mut self) -> Option<()> {
        self.inverse = self.robot.mass_matrix(&self.q).try_inverse()?;
        self.load = self.robot.gravity_torque(&self.q);
        Some(())
    }

    /// Goes on by a step, and returns the way of each joint.
    fn advance(&mut self, is_held: bool, drive: Option<&[f64]>) -> Vec<f64> {
        let Self { robot, case, step, .. } = *self;
        let n = robot.joint_count();
        let mut bias = robot.inverse_dynamics(&self.q, self.v.as_slice(), &vec![0.0; n]);
        bias += robot.viscous_torque(self.v.as_slice());
        for j in 0..n {
            bias[j] -= case.error[j] + drive.map_or(0.0, |torque| torque[j]);
        }
        let mut next = &self.v - step * (&self.inverse * bias);
        let limit = |j: usize, sign: f64| {
            let brake = if is_held { case.brake[j] } else { 0.0 };
            let dry = robot.joints()[j].friction.dry_torque(self.load[j], sign * 1e-300);
            step * (sign * brake + dry)
        };
        // Friction that was identified may have the wrong sign; the brakes then act alone.
        let limits: Vec<_> =
            (0..n).map(|j| (limit(j, -1.0).min(0.0), limit(j, 1.0).max(0.0))).collect();
        (0..n).for_each(|j| next.axpy(-self.impulse[j], &self.inverse.column(j), 1.0));
        for _ in 0..ROUNDS {
            let mut largest = 0.0f64;
            for j in 0..n {
                let wanted: f64 = self.impulse[j] + next[j] / self.inverse[(j, j)];
                let change = wanted.clamp(limits[j].0, limits[j].1) - self.impulse[j];
                self.impulse[j] += change;
                next.axpy(-change, &self.inverse.column(j), 1.0);
                largest = largest.max(change.abs());
            }
            if largest < CHANGE {
                break;
            }
        }
        let way: Vec<f64> = (0..n).map(|j| step * 0.5 * (self.v[j] + next[j])).collect();
        self.q.iter_mut().zip(&way).for_each(|(q, way)| *q += way);
        self.v = next;
        way
    }
}
