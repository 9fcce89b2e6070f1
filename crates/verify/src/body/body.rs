use reachtube_robot::Robot;
use reachtube_scalar::Interval;

use crate::body::capsule::Capsule;
use crate::body::capsules::Capsules;
use crate::kinematics::chain::{Chain, Posture};
use crate::kinematics::linearised_point::{Ball, LinearisedPoint};
use crate::kinematics::vector::Vector;

/// A robot's links as capsules that move with its joints.
///
/// # Examples
///
/// ```
/// use reachtube_reach::StepBounds;
/// use reachtube_robot::Robot;
/// use reachtube_scalar::Interval;
/// use reachtube_verify::{Body, Capsules};
///
/// let robot = Robot::lwa4p();
/// let body = Body::new(&robot, &Capsules::embedded(&robot)?);
/// // One step of a tube: each joint within 0.01 rad of 0, each velocity within 0.1 rad/s.
/// let joint = |radius| Interval::centred(0.0, radius);
/// let step = [vec![joint(0.01); 6], vec![joint(0.1); 6]].concat();
/// let occupancy = body.occupancy(&StepBounds::from_boxes(12, step));
/// // The upper arm's capsule grows by the way of its upper end.
/// let upper_arm = occupancy[0][1];
/// assert!(upper_arm.radius > 0.074021 + 0.35 * 0.01 && upper_arm.radius < 0.08);
/// # Ok::<(), reachtube_verify::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Body {
    pub(crate) chain: Chain,
    names: Vec<String>,
    capsules: Vec<Capsule>,
    /// The ends of each capsule in the frame of its joint.
    ends: Vec<[Vector; 2]>,
}

/// Memory that computations with a body use again.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    pub posture: Posture,
    /// The ends of a capsule.
    pub points: [LinearisedPoint; 2],
    /// One position per joint.
    pub q: Vec<f64>,
    /// One radius per joint.
    pub radii: Vec<f64>,
}

impl Body {
    /// Places capsules on the links of a robot.
    ///
    /// # Panics
    ///
    /// Panics if the capsules are of a robot with more joints.
    #[must_use]
    pub fn new(robot: &Robot, capsules: &Capsules) -> Self {
        let chain = Chain::new(robot);
        let ends = |capsule: &Capsule| {
            assert!(capsule.joint < chain.joint_count(), "the capsules are of another robot");
            [capsule.from, capsule.to].map(|end| chain.in_joint_frame(capsule.joint, end))
        };
        let ends = capsules.as_slice().iter().map(ends).collect();
        let names = robot.joints().iter().map(|joint| joint.name.clone()).collect();
        Self { chain, names, capsules: capsules.as_slice().to_vec(), ends }
    }

    /// Returns the number of joints n.
    #[must_use]
    pub fn joint_count(&self) -> usize {
        self.chain.joint_count()
    }

    /// Returns the capsules.
    #[must_use]
    pub fn capsules(&self) -> &[Capsule] {
        &self.capsules
    }

    /// Returns the name of a joint, which names the link that it moves.
    ///
    /// # Panics
    ///
    /// Panics if there is no joint `index`.
    #[must_use]
    pub fn joint_name(&self, index: usize) -> &str {
        &self.names[index]
    }

    pub(crate) fn ends(&self) -> impl Iterator<Item = (&Capsule, &[Vector; 2])> {
        self.capsules.iter().zip(&self.ends)
    }
}

impl Workspace {
    /// Encloses the joint frames while the joints lie in a box of positions.
    pub(crate) fn pose(&mut self, body: &Body, positions: &[Interval]) {
        self.q.clear();
        self.q.extend(positions.iter().map(|side| side.mid()));
        self.radii.clear();
        self.radii.extend(positions.iter().map(|side| side.rad()));
        body.chain.pose(&self.q, &mut self.posture);
    }

    /// Linearises the ends of a capsule while the joints stay within `self.radii` of the posture.
    pub(crate) fn linearise(&mut self, body: &Body, capsule: &Capsule, ends: &[Vector; 2]) {
        for (point, end) in self.points.iter_mut().zip(ends) {
            point.at(&body.chain, &self.posture, (capsule.joint, end), &self.radii);
        }
    }

    /// Encloses the ends of the capsule that was linearised.
    pub(crate) fn balls(&self) -> [Ball; 2] {
        self.points.each_ref().map(|point| point.ball(&self.radii))
    }
}
