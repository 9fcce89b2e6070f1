//! Dry friction of joints over boxes of states.

use reachtube_conform::data::DryFriction;
use reachtube_robot::friction::{Friction, Viscous};
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::Interval;

/// The dry friction of all joints.
pub(super) struct JointFriction<'a> {
    robot: &'a Robot,
    dry: Vec<Friction>,
    ws: Workspace<Interval>,
    load: Vec<Interval>,
}

impl<'a> JointFriction<'a> {
    pub(super) fn new(robot: &'a Robot) -> Self {
        let dry = |friction: Friction| Friction { viscous: Viscous::default(), ..friction };
        Self {
            robot,
            dry: robot.joints().iter().map(|joint| dry(joint.friction)).collect(),
            ws: Workspace::new(robot),
            load: vec![Interval::ZERO; robot.joint_count()],
        }
    }
}

impl DryFriction for JointFriction<'_> {
    fn spread(&mut self, states: &[Interval], visit: &mut dyn FnMut(usize, f64, bool)) {
        let (q, qd) = states.split_at(self.load.len());
        let (sin, cos) = self.robot.sin_cos(q);
        self.robot.gravity(&sin, &cos, &mut self.ws, &mut self.load);
        for (j, velocity) in qd.iter().enumerate() {
            let range = self.dry[j].range_near_zero(self.load[j], *velocity);
            let torque = range.width().min(f64::MAX);
            if torque != 0.0 {
                visit(j, torque, velocity.contains_zero());
            }
        }
    }
}
