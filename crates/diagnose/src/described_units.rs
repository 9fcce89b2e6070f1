//! Units of a description that recorded torques contradict.

use reachtube_recordings::Torque;
use reachtube_robot::{Robot, RobotDescription};

use crate::change::Change;
use crate::contradiction::Contradiction;
use crate::moments::{Moments, gravity, inertia, recorded};
use crate::signals::Signals;

/// Number of samples that are compared for each of many faults.
pub(crate) const FEWER_SAMPLES: usize = 1500;

/// A hypothesis is named if the product over the joints of the parts that it leaves of what is
/// unexplained otherwise, in recordings that are left out, is below this.
pub(crate) const CLEAR: f64 = 0.1;

/// Torques whose median size differs from what the description needs by more than this factor are
/// named. Published descriptions are off by a factor of 3 at times.
pub(crate) const FACTOR: f64 = 5.0;

/// A description explains a torque if it leaves less than this part of what friction leaves.
pub(crate) const EXPLAINS: f64 = 0.5;

/// What numbers of a description may be in another unit.
#[derive(Clone, Copy)]
struct DescribedUnit {
    words: &'static str,
    unit: &'static str,
    /// Factors of the distances between joints, the centres of mass and the moments of inertia.
    factors: [f64; 3],
}

/// The units that are tried. Masses in another unit look like torques in another unit.
const UNITS: [DescribedUnit; 6] = [
    DescribedUnit::new("distances between joints", "mm", [1e-3, 1.0, 1.0]),
    DescribedUnit::new("distances between joints and the centres of mass", "mm", [1e-3, 1e-3, 1.0]),
    DescribedUnit::new("lengths and moments of inertia", "mm and kg mm²", [1e-3, 1e-3, 1e-6]),
    DescribedUnit::new("distances between joints and the centres of mass", "cm", [1e-2, 1e-2, 1.0]),
    DescribedUnit::new("moments of inertia", "kg mm²", [1.0, 1.0, 1e-6]),
    DescribedUnit::new("moments of inertia", "kg cm²", [1.0, 1.0, 1e-4]),
];

impl DescribedUnit {
    const fn new(words: &'static str, unit: &'static str, factors: [f64; 3]) -> Self {
        Self { words, unit, factors }
    }

    /// Returns the robot that a description means.
    fn meant(&self, description: &RobotDescription) -> Option<Robot> {
        let mut meant = description.clone();
        let [distance, centre, inertia] = self.factors;
        for joint in &mut meant.joints {
            if let Some(placement) = &mut joint.placement {
                placement.translation.iter_mut().for_each(|length| *length *= distance);
            }
            if let Some(dh) = &mut joint.dh {
                [&mut dh.a, &mut dh.d].into_iter().for_each(|length| *length *= distance);
            }
            joint.com.iter_mut().flatten().for_each(|length| *length *= centre);
            joint.first_moment.iter_mut().flatten().for_each(|moment| *moment *= centre);
            let moments = joint.gravity_moments.iter_mut();
            moments.flat_map(|own| &mut own.first_moment).for_each(|moment| *moment *= centre);
            joint.inertia.iter_mut().for_each(|moment| *moment *= inertia);
        }
        Robot::from_description(&meant).ok()
    }
}

/// How many joints a description explains, and the logarithm of the product over the joints of the
/// parts of their torques' squares that it leaves.
struct ExplainedJoints {
    joints: usize,
    left: f64,
}

impl ExplainedJoints {
    fn new(robot: &Robot, recordings: &[Signals], kind: Torque) -> Self {
        let stated = Change::none(kind, robot.joint_count());
        let moments = Moments::new(robot, recordings, &stated, FEWER_SAMPLES);
        let described = inertia() + gravity(robot.gravity_acceleration());
        let (mut joints, mut left) = (0, 0.0);
        for joint in (0..moments.joints()).filter(|joint| moments.variance(*joint) > 0.0) {
            let scaled = moments.explained(joint, &recorded(), &[described]);
            let part = scaled.missed / moments.explained(joint, &recorded(), &[]).missed;
            let is_of_size = (1.0 / FACTOR..=FACTOR).contains(&scaled.values[0]);
            joints += usize::from(part < EXPLAINS && is_of_size);
            left += part.max(f64::MIN_POSITIVE).ln();
        }
        Self { joints, left }
    }
}

/// Returns the unit in which numbers of a description are meant, if its torques are explained much
/// better under it, and the number of joints whose torque follows it then.
pub(crate) fn unit_meant(
    robot: &Robot,
    recordings: &[Signals],
    kind: Torque,
) -> Option<(Contradiction, usize)> {
    let stated = ExplainedJoints::new(robot, recordings, kind);
    let tried = UNITS.iter().filter_map(|unit| {
        let meant = unit.meant(robot.description())?;
        Some((unit, ExplainedJoints::new(&meant, recordings, kind)))
    });
    let (unit, best) = tried.min_by(|(_, a), (_, b)| a.left.total_cmp(&b.left))?;
    let n = robot.joint_count();
    let is_clear =
        best.joints > stated.joints && 2 * best.joints >= n && best.left - stated.left < CLEAR.ln();
    is_clear.then(|| {
        let DescribedUnit { words, unit, factors } = unit;
        let text = format!(
            "the {words} of the description are probably in {unit}: read so, the description \
             explains the torque of {} of {n} joints, in place of {}; correct them in the robot's \
             file",
            best.joints, stated.joints
        );
        let factor = factors.iter().copied().fold(1.0, f64::min);
        (
            Contradiction { number: Some(("factor", factor)), ..Contradiction::new(text) },
            best.joints,
        )
    })
}
