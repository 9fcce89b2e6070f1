//! Whether recorded torques are what the robot's description needs.

use nalgebra::Vector3;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::agreement::median;
use crate::change::Change;
use crate::contradiction::{Contradiction, names};
use crate::described_units::{CLEAR, EXPLAINS, FACTOR, FEWER_SAMPLES, unit_meant};
use crate::hypothesis::Hypothesis;
use crate::likeliest::{Misfit, likeliest_fault};
use crate::moments::{JointTerms, Moments, Terms, gravity, inertia, recorded};
use crate::signals::{Signals, move_alike};

/// Number of samples that are compared once.
const SAMPLES: usize = 4000;

/// Offsets of a position beyond this are no small error of its zero, rad or m.
const OFFSET: f64 = 0.05;

/// Joints whose described gravity torque is at least this part of the largest one show gravity.
const HEAVY: f64 = 0.1;

/// Part of the described gravity below which recorded torques contain none, in parts of the factor
/// of the described inertia that they show, ...
const NO_GRAVITY: f64 = 0.25;

/// ... and where they show none: a unit makes torques small, too.
const NO_GRAVITY_AT_ALL: f64 = 0.02;

/// Factors of gravity between which torques show its direction.
const SIZES: [f64; 2] = [0.5, 2.0];

/// Angles beyond which gravity has another direction, and beyond which it has the opposite one.
const ANGLES: [f64; 2] = [0.35, 2.6];

/// A hypothesis explains no less than another one if it leaves at most this times as much, as the
/// product over the joints.
const SCALED: f64 = 2.0;

/// Standard errors by which a factor must differ from 0.
const SIGNIFICANT: f64 = 4.0;

/// A description with wrong masses leaves more than this part of the squares of a torque; where
/// less is left, factors that differ by more than [`UNEVEN`] from joint to joint are units.
const EXACT: f64 = 0.03;
const UNEVEN: f64 = 1.5;

/// Friction that takes less than this part of the power shows no sign of the torques.
const DISSIPATES: f64 = 1e-3;

/// Part of the squares of a torque that is left where nothing explains it.
const NOISE: f64 = 0.9;

/// How recorded torques compare with the ones that a robot's description needs, which must have
/// masses and contain gravity.
pub struct Described<'a> {
    robot: &'a Robot,
    kind: Torque,
    recordings: Vec<Signals<'a>>,
    moments: Moments,
    joints: Vec<JointMisfit>,
}

/// What explains the torque of a joint. Sums of squares are over recordings that are left out.
struct JointMisfit {
    /// The root mean square of the described gravity torque, N m.
    gravity: f64,
    /// The sum of the squares that friction alone leaves.
    by_friction: f64,
    /// What the description leaves, with friction.
    stated: f64,
    /// What the opposite of the description leaves, with friction.
    opposite: f64,
    /// A factor of the description.
    scaled: JointTerms,
    /// Factors of the described links' inertia and gravity.
    parts: JointTerms,
    /// The part of the squares of the torque that links of any size leave.
    rest: f64,
    /// What links and gravity of any size leave.
    least: f64,
}

impl<'a> Described<'a> {
    /// Compares filtered recordings with a description.
    #[must_use]
    pub fn new(robot: &'a Robot, kind: Torque, recordings: Vec<Signals<'a>>) -> Self {
        let stated = Change::none(kind, robot.joint_count());
        let moments = Moments::new(robot, &recordings, &stated, SAMPLES);
        let weight = gravity(robot.gravity_acceleration());
        let described = inertia() + weight;
        let joints = (0..moments.joints()).map(|joint| {
            let explained = |torque: Terms, free: &[Terms]| moments.explained(joint, &torque, free);
            let any = [inertia(), axis(0), axis(1), axis(2)];
            let least = explained(recorded(), &any).missed;
            JointMisfit {
                gravity: moments.size(joint, &weight),
                by_friction: explained(recorded(), &[]).missed,
                stated: explained(recorded() - described, &[]).missed,
                opposite: explained(recorded() + described, &[]).missed,
                scaled: explained(recorded(), &[described]),
                parts: explained(recorded(), &[inertia(), weight]),
                rest: least / moments.variance(joint),
                least,
            }
        });
        let joints = joints.collect();
        Self { robot, kind, recordings, moments, joints }
    }

    /// Returns what contradicts the description, and the number of joints whose torque follows it.
    #[must_use]
    pub fn contradictions(&self) -> (Vec<Contradiction>, usize) {
        let count = self.moving().filter(|joint| self.is_explained(*joint)).count();
        let found = self.noise().or_else(|| self.without_gravity()).or_else(|| self.mount());
        let scales = self.scales();
        if found.is_none()
            && (2 * count <= self.joints.len() || scales.iter().any(|found| found.is_certain))
            && let Some((unit, count)) = unit_meant(self.robot, &self.recordings, self.kind)
        {
            return (vec![unit], count);
        }
        let mut found = found.map_or(scales, |found| vec![found]);
        if found.is_empty() {
            found.extend(self.fault());
        }
        found.extend(self.alike());
        (found, count)
    }

    /// Returns the joints that move enough to be judged.
    fn moving(&self) -> impl Iterator<Item = usize> {
        (0..self.joints.len()).filter(|joint| self.joints[*joint].rest.is_finite())
    }

    fn is_explained(&self, joint: usize) -> bool {
        let own = &self.joints[joint];
        own.scaled.missed < EXPLAINS * own.by_friction
    }

    /// Returns the joints of which the description needs much torque against gravity, or much
    /// force.
    fn heavy(&self) -> Vec<usize> {
        let kind = |joint: usize| self.robot.joints()[joint].kind;
        let largest = |of: usize| {
            let alike = (0..self.joints.len()).filter(|joint| kind(*joint) == kind(of));
            alike.map(|joint| self.joints[joint].gravity).fold(0.0, f64::max)
        };
        let is_heavy = |joint: &usize| {
            let gravity = self.joints[*joint].gravity;
            gravity > 0.0 && gravity >= HEAVY * largest(*joint)
        };
        self.moving().filter(is_heavy).collect()
    }

    /// Returns joints that move alike, so that nothing shows whose columns are whose.
    fn alike(&self) -> Option<Contradiction> {
        let n = self.joints.len();
        let pairs = (0..n).flat_map(|one| (one + 1..n).map(move |other| [one, other]));
        let mut alike = pairs.filter(|pair| move_alike(&self.recordings, n, *pair));
        let joints = alike.next()?.to_vec();
        let text = format!(
            "{} move alike in all recordings: exchanged columns, and parts of inertia and friction \
             that both share, do not show; record motions that differ",
            names(self.robot, &joints)
        );
        Some(Contradiction { joints, is_certain: false, ..Contradiction::new(text) })
    }

    /// Returns the fault of the columns without which the description explains the torques best.
    fn fault(&self) -> Option<Contradiction> {
        let (fault, clearest) = likeliest_fault(self, true)?;
        let is_certain = match fault {
            Hypothesis::Offset(_, size) => size.abs() > OFFSET,
            // Clocks of robots are off a little.
            Hypothesis::Lag(..) => false,
            _ => true,
        };
        let text = fault.warning(self.robot, clearest);
        Some(Contradiction { is_certain, number: fault.number(), ..Contradiction::new(text) })
    }

    fn noise(&self) -> Option<Contradiction> {
        let least = self.moving().map(|joint| self.joints[joint].rest).reduce(f64::min)?;
        (least > NOISE).then(|| Contradiction::noise(least))
    }

    /// Returns the factor of the described inertia that the torques show, 1 if they show none.
    fn inertia_factor(&self) -> f64 {
        self.shown_inertia().unwrap_or(1.0)
    }

    fn shown_inertia(&self) -> Option<f64> {
        let weight = |joint: &usize| self.joints[*joint].parts.error(0).powi(-2);
        let weighted = |joint: usize| weight(&joint) * self.joints[joint].parts.values[0];
        let weights: f64 = self.moving().map(|joint| weight(&joint)).sum();
        let factor = self.moving().map(weighted).sum::<f64>() / weights;
        (factor * weights.sqrt() > SIGNIFICANT).then_some(factor)
    }

    /// Returns the gravitational acceleration that explains the torques, in the directions that
    /// they show, and the described one in these directions.
    fn shown_gravity(&self) -> [Vector3<f64>; 2] {
        let missed: Vec<f64> = self.joints.iter().map(|joint| joint.least).collect();
        let (axes, factor) = ([0, 1, 2].map(axis), self.inertia_factor());
        let torque = recorded() / factor - inertia();
        let (found, shown) = self.moments.shared(&torque, &axes, &missed);
        [found.into(), shown * Vector3::from(self.robot.gravity_acceleration())]
    }

    fn without_gravity(&self) -> Option<Contradiction> {
        let heavy = self.heavy();
        let heaviest = heavy
            .iter()
            .copied()
            .max_by(|a, b| self.joints[*a].gravity.total_cmp(&self.joints[*b].gravity))?;
        let [found, stated] = self.shown_gravity();
        let most = self.shown_inertia().map_or(NO_GRAVITY_AT_ALL, |factor| NO_GRAVITY * factor);
        let is_free = |joint: &usize| {
            let parts = &self.joints[*joint].parts;
            parts.values[1].abs() + 2.0 * parts.error(1) < most
        };
        let none = |joint: usize| self.moments.explained(joint, &recorded(), &[inertia()]).missed;
        let gain: f64 = heavy.iter().map(|j| (none(*j) / self.joints[*j].stated).ln()).sum();
        let part = self.joints[heaviest].parts.values[1];
        (found.norm() < NO_GRAVITY * stated.norm()
            && heavy.iter().all(is_free)
            && gain < CLEAR.ln())
        .then(|| {
            let joint = &self.robot.joints()[heaviest];
            Contradiction::no_gravity(joint, self.joints[heaviest].gravity, part)
        })
    }

    fn mount(&self) -> Option<Contradiction> {
        let [found, stated] = self.shown_gravity();
        let size = found.norm() / stated.norm();
        let angle = found.angle(&stated);
        if !(SIZES[0]..SIZES[1]).contains(&size) || angle < ANGLES[0] {
            return None;
        }
        // Directions that the torques do not show are as described. Masses of another description
        // change the size, not the direction.
        let all = Vector3::from(self.robot.gravity_acceleration());
        let torque = recorded() - inertia() - gravity((found + all - stated).into());
        let under: Vec<JointTerms> = (0..self.joints.len())
            .map(|joint| self.moments.explained(joint, &torque, &[]))
            .collect();
        let score = |of: &dyn Fn(&JointMisfit) -> f64| -> f64 {
            self.moving().map(|joint| (under[joint].missed / of(&self.joints[joint])).ln()).sum()
        };
        let is_opposite = angle > ANGLES[1];
        // The factor of a description may be -1.
        let gain = match is_opposite {
            true => score(&|own| own.stated),
            false => score(&|own| own.stated.min(own.scaled.missed)),
        };
        let are_opposite = is_opposite && {
            let power = |joint: usize| self.moments.friction_power(joint, &under[joint].values);
            // What is left of recordings without noise is rounding.
            let least = |missed: f64, own: &JointMisfit| missed + EXACT * EXACT * own.stated;
            let better = |joint: usize| {
                let own = &self.joints[joint];
                (least(under[joint].missed, own) / least(own.opposite, own)).ln()
            };
            let better: f64 = self.moving().map(better).sum();
            let dissipates = self.moving().map(power).sum::<f64>() > DISSIPATES;
            if better.abs() > SCALED.ln() { better > 0.0 } else { !dissipates }
        };
        (gain < CLEAR.ln()).then(|| match are_opposite {
            true => Contradiction::all_opposite(self.robot.joint_count()),
            false => {
                let along = (found / size + all - stated).normalize() * all.norm();
                Contradiction::mount(angle, along.into())
            }
        })
    }

    /// Returns the contradictions in size and sign.
    fn scales(&self) -> Vec<Contradiction> {
        let factors: Vec<(usize, f64)> = self
            .moving()
            .filter(|joint| self.is_explained(*joint))
            .map(|joint| (joint, self.joints[joint].scaled.values[0]))
            .collect();
        let Some(factor) = median(factors.iter().map(|(_, factor)| factor.abs())) else {
            return Vec::new();
        };
        let mut found = Vec::new();
        let is_certain = !(1.0 / FACTOR..=FACTOR).contains(&factor);
        if is_certain || self.are_uneven(&factors) {
            let size = Contradiction::size(self.robot, &factors, factor);
            found.push(Contradiction { is_certain, ..size });
        }
        let opposite: Vec<usize> =
            factors.iter().filter(|(_, factor)| *factor < 0.0).map(|(joint, _)| *joint).collect();
        if !opposite.is_empty() {
            found.push(Contradiction::opposite(self.robot, opposite));
        }
        found
    }

    /// Returns whether some joints' torques are exactly what the description needs, up to factors
    /// that no masses of its links have.
    fn are_uneven(&self, factors: &[(usize, f64)]) -> bool {
        let is_exact =
            |joint: usize| self.joints[joint].scaled.missed < EXACT * self.moments.variance(joint);
        let exact = || factors.iter().filter(|(joint, _)| is_exact(*joint));
        let least = exact().map(|(_, factor)| factor.abs()).fold(f64::INFINITY, f64::min);
        let most = exact().map(|(_, factor)| factor.abs()).fold(0.0, f64::max);
        most > UNEVEN * least && (least > UNEVEN || most * UNEVEN < 1.0)
    }
}

impl Misfit for Described<'_> {
    fn robot(&self) -> &Robot {
        self.robot
    }

    fn recordings(&self) -> &[Signals<'_>] {
        &self.recordings
    }

    /// Returns what a factor of the description and friction leave in recordings that are left out.
    fn sizes(&self, change: &Change) -> Option<Vec<f64>> {
        let change = Change { torque: self.kind, ..change.clone() };
        let moments = Moments::new(self.robot, &self.recordings, &change, FEWER_SAMPLES);
        let described = inertia() + gravity(self.robot.gravity_acceleration());
        let size = |joint: usize| {
            let left = moments.explained(joint, &recorded(), &[described]).missed;
            // A joint that hardly moves shows nothing.
            if moments.variance(joint) > 0.0 { left.sqrt() } else { 1.0 }
        };
        Some((0..moments.joints()).map(size).collect())
    }
}

fn axis(axis: usize) -> Terms {
    gravity([0, 1, 2].map(|other| f64::from(u8::from(other == axis))))
}
