//! Enclosed stops: drives off and brakes on at once (category 0), or after a controlled
//! deceleration (category 1).

use reachtube_reach::{Hyperrectangle, StepBounds};
use reachtube_robot::Robot;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_down, add_up};
use serde::Serialize;

use crate::stop::accelerations::{Accelerations, Terms, holding_torque};
use crate::stop::brakes::Brakes;
use crate::stop::deceleration::Deceleration;
use crate::stop::velocity_bounds::{lower_after, lower_way, upper_after, upper_way};

/// Length of a step, s.
const STEP: f64 = 0.002;

/// The time after the drives are off from which a robot that still moves counts as one that does
/// not stop, s.
const LONGEST: f64 = 5.0;

/// Number of times that the enclosure of a step is widened before the stop counts as lost.
const ATTEMPTS: usize = 12;

/// The stop of one joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointStop {
    /// The earliest and the latest time from which on the joint stands, s.
    pub time: [f64; 2],
    /// The least and the greatest way from the start to standstill, rad or m, with its sign.
    pub way: [f64; 2],
}

/// An enclosed stop.
#[derive(Debug, Clone)]
pub struct Stop {
    /// Whether it is proved that all joints come to a standstill and stay there.
    pub stands: bool,
    /// The joints, from base to tip. If `stands` is false, times may be infinite, and ways go as
    /// far as the stop was followed.
    pub joints: Vec<JointStop>,
    /// The ends of the steps, s, from 0.
    pub times: Vec<f64>,
    /// Positions and velocities over each step.
    pub tube: StepBounds,
}

/// Encloses the stop of category 0 from every state in a box of positions (rad; m) and velocities,
/// 2n sides: the drives are off from the start, the brakes hold after their delay, gravity and
/// friction act.
///
/// The motion solves M_m(q) q̈ ∈ -c(q, q̇) - g(q) - friction(q̇) - brake · Sgn(q̇), where Sgn(0) is
/// \[-1, 1\]. Each velocity is bounded from above and below by lines whose slopes are bounds of the
/// accelerations along them (Müller), so that friction narrows the bounds as it does velocities.
/// At 0 both bounds end unless the load may exceed the brake. A joint that stands stays so while
/// the torque that holds it is at most the least brake torque: as dry friction makes solutions
/// unique, the one in which it stays is the only one.
///
/// # Guarantee
///
/// Outer, directed rounding, for the robot's constants as loaded: every solution under any brake
/// torques and delays within the bounds.
///
/// # Panics
///
/// Panics when the state or the brakes are of another number of joints.
///
/// # Examples
///
/// ```
/// use reachtube_robot::Robot;
/// use reachtube_scalar::Interval;
/// use reachtube_verify::{Brakes, stop_0};
///
/// let brakes = Brakes::new(vec![[40.0, 50.0]; 6], [0.0, 0.02]);
/// let mut state = [Interval::ZERO; 12];
/// state[6] = Interval::point(1.0);
/// let stop = stop_0(&Robot::lwa4p(), &brakes, &state);
/// let [least, greatest] = stop.joints[0].way;
/// assert!(stop.stands && 0.005 < least && greatest < 0.05);
/// ```
#[must_use]
pub fn stop_0(robot: &Robot, brakes: &Brakes, state: &[Interval]) -> Stop {
    Run::new(robot, brakes, None, state).follow()
}

/// Encloses the stop of category 1 from every state in a box, as [`stop_0`]: the robot moves under
/// the torques of a deceleration, of which each may be off by any vector of `input_set`, which may
/// change at any time. Then the drives are off, and the brakes hold after their delay.
///
/// The set of a conformant model bounds the error of the torque in its equations, and is taken as
/// the error of the torque in the robot's.
///
/// # Guarantee
///
/// Outer, directed rounding, for the robot's constants as loaded: every solution under any error
/// in `input_set`, and any brake torques and delays within the bounds.
///
/// # Panics
///
/// Panics when an argument is of another number of joints.
///
/// # Examples
///
/// ```
/// use reachtube_reach::Hyperrectangle;
/// use reachtube_robot::Robot;
/// use reachtube_scalar::Interval;
/// use reachtube_verify::{Brakes, Deceleration, Path, stop_1};
///
/// let robot = Robot::lwa4p();
/// let brakes = Brakes::new(vec![[40.0, 50.0]; 6], [0.0, 0.02]);
/// let (q, qd) = ([0.0; 6], [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
/// let path = Path::straight(&q, &qd, 1.0);
/// let slow = Deceleration::along(&robot, &path, 0.0, &[4.0; 6]).unwrap();
/// let errors = Hyperrectangle { centre: vec![0.0; 6], radius: vec![0.1; 6] };
/// let state: Vec<Interval> = q.iter().chain(&qd).map(|x| Interval::point(*x)).collect();
/// let stop = stop_1(&robot, &brakes, &slow, &errors, &state);
/// // 0.25 s from 1 rad/s: the way is 0.125 rad.
/// let [least, greatest] = stop.joints[0].way;
/// assert!(stop.stands && 0.11 < least && least < 0.125 && 0.125 < greatest && greatest < 0.14);
/// ```
#[must_use]
pub fn stop_1(
    robot: &Robot,
    brakes: &Brakes,
    deceleration: &Deceleration,
    input_set: &Hyperrectangle,
    state: &[Interval],
) -> Stop {
    let side = |(centre, radius): (&f64, &f64)| Interval::centred(*centre, *radius);
    let error: Vec<Interval> = input_set.centre.iter().zip(&input_set.radius).map(side).collect();
    let n = robot.joint_count();
    assert!(error.len() == n && deceleration.torques().len().is_multiple_of(n), "of another robot");
    // The delay of the brakes counts from the end of the deceleration.
    let after = deceleration.duration();
    let [earliest, latest] = brakes.delay;
    let delay = [add_down(after, earliest), add_up(after, latest)];
    let brakes = Brakes { delay, ..brakes.clone() };
    Run::new(robot, &brakes, Some(Drive { deceleration, error, cycle: 0 }), state).follow()
}

/// The drives while they decelerate the robot.
struct Drive<'a> {
    deceleration: &'a Deceleration,
    /// The error of the torque.
    error: Vec<Interval>,
    /// The cycle that is followed next.
    cycle: usize,
}

/// A stop as it is followed.
struct Run<'a> {
    robot: &'a Robot,
    brakes: &'a Brakes,
    /// `None` once the drives are off.
    drive: Option<Drive<'a>>,
    /// Time from which the drives are off, s.
    off: f64,
    terms: Terms<'a>,
    time: f64,
    q: Vec<Interval>,
    /// Lower and upper bounds of the velocities.
    v: Vec<[f64; 2]>,
    /// Whether a joint stands.
    stands: Vec<bool>,
    joints: Vec<JointStop>,
    times: Vec<f64>,
    boxes: Vec<Interval>,
    /// The accelerations of the step before.
    known: Vec<Interval>,
}

/// Bounds of the states over a step.
struct Step {
    duration: f64,
    moving: Vec<usize>,
    accelerations: Accelerations,
}

impl<'a> Run<'a> {
    fn new(
        robot: &'a Robot,
        brakes: &'a Brakes,
        drive: Option<Drive<'a>>,
        state: &[Interval],
    ) -> Self {
        let n = robot.joint_count();
        assert_eq!(state.len(), 2 * n, "a state has a position and a velocity for each joint");
        assert_eq!(brakes.torque.len(), n, "the brakes are of another robot");
        let off = drive.as_ref().map_or(0.0, |drive| drive.deceleration.duration());
        let (q, qd) = state.split_at(n);
        Self {
            robot,
            brakes,
            drive: drive.filter(|_| off > 0.0),
            off,
            terms: Terms::new(robot),
            time: 0.0,
            q: q.to_vec(),
            v: qd.iter().map(|side| [side.lo(), side.hi()]).collect(),
            stands: vec![false; n],
            joints: vec![JointStop { time: [0.0, f64::INFINITY], way: [0.0; 2] }; n],
            times: vec![0.0],
            boxes: Vec::new(),
            known: vec![Interval::ZERO; n],
        }
    }

    /// Follows the stop to its end: a joint that stands before the brakes are sure to hold may move
    /// again.
    fn follow(mut self) -> Stop {
        let held = self.brakes.delay[1];
        let longest = self.off.max(held) + LONGEST;
        while !(self.all_stand() && self.time >= held) && self.time < longest {
            if !self.advance() {
                return self.finish(false);
            }
        }
        let stands = self.all_stand() && self.time >= held && self.holds_for_good();
        self.finish(stands)
    }

    fn all_stand(&self) -> bool {
        self.stands.iter().all(|stands| *stands)
    }

    /// Goes on by a step; false if no enclosure of it was found.
    fn advance(&mut self) -> bool {
        let end = self.end_of_step();
        let Some(step) = self.enclose(end) else { return false };
        let n = self.q.len();
        let mut after = self.v.clone();
        for (index, &joint) in step.moving.iter().enumerate() {
            let range = step.accelerations.all[index];
            let rate = |velocity: Interval| {
                step.accelerations.of(index, self.torque(joint, velocity, [self.time, end]))
            };
            let [low, high] = self.v[joint];
            let high = upper_after(high, step.duration, range, |velocity| rate(velocity).hi());
            let low = lower_after(low, step.duration, range, |velocity| rate(velocity).lo());
            after[joint] = [low.min(high), high];
        }
        let mut over = vec![Interval::ZERO; 2 * n];
        for joint in 0..n {
            let ([low, high], [low_after, high_after]) = (self.v[joint], after[joint]);
            over[n + joint] = hull(low.min(low_after), high.max(high_after));
            let way = [
                lower_way(low, low_after, step.duration),
                upper_way(high, high_after, step.duration),
            ];
            let within = Interval::ZERO.hull(Interval::point(step.duration)) * over[n + joint];
            over[joint] = self.q[joint] + within;
            self.q[joint] += hull(way[0], way[1]);
            let known = &mut self.joints[joint].way;
            *known = [add_down(known[0], way[0]), add_up(known[1], way[1])];
        }
        self.boxes.extend(over);
        self.v = after;
        self.time = end;
        self.times.push(end);
        if let Some(drive) = &mut self.drive {
            drive.cycle += 1;
            self.drive.take_if(|_| end >= self.off);
        }
        self.note_standstill();
        true
    }

    fn end_of_step(&self) -> f64 {
        if let Some(drive) = &self.drive {
            return drive.deceleration.end_of(drive.cycle + 1);
        }
        let next = |event: f64| (event > self.time).then_some(event);
        let events = self.brakes.delay.into_iter().filter_map(next);
        events.fold(self.time + STEP, f64::min)
    }

    /// Encloses the accelerations until `end`: the velocities of a box that contains them all lead
    /// to accelerations that keep them in it.
    fn enclose(&mut self, end: f64) -> Option<Step> {
        let n = self.q.len();
        let duration = (Interval::point(end) - self.time).hi();
        let span = Interval::ZERO.hull(Interval::point(duration));
        let mut guess = self.known.clone();
        for attempt in 0..ATTEMPTS {
            let now = |joint: usize| hull(self.v[joint][0], self.v[joint][1]);
            let v: Vec<Interval> = (0..n).map(|joint| now(joint) + span * guess[joint]).collect();
            let q: Vec<Interval> = (0..n).map(|joint| self.q[joint] + span * v[joint]).collect();
            self.terms.over(&q, &v);
            let torque: Vec<Interval> =
                (0..n).map(|joint| self.torque(joint, v[joint], [self.time, end])).collect();
            let moving: Vec<usize> = (0..n).filter(|joint| !self.stands[*joint]).collect();
            let accelerations = Accelerations::new(&self.terms.mass, &moving, &torque)?;
            if let Some(slipping) = self.slipping(&moving, &accelerations.all) {
                // A joint that may not be held moves from here on.
                self.stands[slipping] = false;
                self.joints[slipping].time[1] = f64::INFINITY;
                continue;
            }
            let all = &accelerations.all;
            let fits = |(index, joint): (usize, &usize)| guess[*joint].encloses(&all[index]);
            let found = moving.iter().enumerate().all(fits);
            for (index, &joint) in moving.iter().enumerate() {
                // What the step before left in the guess is dropped once, and kept later on.
                let wider =
                    if found || attempt == 0 { all[index] } else { all[index].hull(guess[joint]) };
                guess[joint] = wider + Interval::centred(0.0, 0.1 * wider.mag() + 1e-9);
            }
            if found {
                self.known = guess;
                return Some(Step { duration, moving, accelerations });
            }
        }
        None
    }

    fn slipping(&self, moving: &[usize], accelerations: &[Interval]) -> Option<usize> {
        let standing = (0..self.q.len()).filter(|joint| self.stands[*joint]);
        standing.into_iter().find(|joint| {
            let load = holding_torque(&self.terms, *joint, (moving, accelerations));
            let load = add_up(load, self.brakes.error[*joint]);
            load.is_nan() || load > self.brakes.over(*joint, [self.time, f64::INFINITY])[0]
        })
    }

    /// Encloses the torque on a moving joint at velocities in an interval: -c - g - friction -
    /// brake.
    fn torque(&self, joint: usize, velocity: Interval, span: [f64; 2]) -> Interval {
        let [least, greatest] = self.brakes.over(joint, span);
        let brake = if velocity.lo() > 0.0 {
            hull(least, greatest)
        } else if velocity.hi() < 0.0 {
            hull(-greatest, -least)
        } else {
            hull(-greatest, greatest)
        };
        let friction = &self.robot.joints()[joint].friction;
        let friction = friction.range_near_zero(self.terms.gravity[joint], velocity);
        let error = Interval::centred(0.0, self.brakes.error[joint]);
        let driven = self.drive.as_ref().map_or(Interval::ZERO, |drive| {
            drive.error[joint] + drive.deceleration.torque(drive.cycle, joint)
        });
        driven - self.terms.bias[joint] - friction - brake + error
    }

    /// Notes which joints stand from now on, and since when at the earliest.
    fn note_standstill(&mut self) {
        for joint in 0..self.q.len() {
            let [low, high] = self.v[joint];
            let JointStop { time, .. } = &mut self.joints[joint];
            let is_off = self.drive.is_none();
            if is_off && !self.stands[joint] && low == 0.0 && high == 0.0 {
                self.stands[joint] = true;
                self.known[joint] = Interval::ZERO;
                time[1] = self.time;
            }
            // A joint that surely moves at the end of a step stands later at the earliest.
            if low > 0.0 || high < 0.0 {
                time[0] = self.time;
            }
        }
    }

    /// Returns whether the brakes, which all act, hold the arm where it stands.
    fn holds_for_good(&mut self) -> bool {
        self.terms.over(&self.q, &vec![Interval::ZERO; self.q.len()]);
        self.slipping(&[], &[]).is_none()
    }

    fn finish(self, stands: bool) -> Stop {
        let tube = StepBounds::from_boxes(2 * self.q.len(), self.boxes);
        Stop { stands, joints: self.joints, times: self.times, tube }
    }
}

fn hull(low: f64, high: f64) -> Interval {
    Interval::point(low).hull(Interval::point(high))
}
