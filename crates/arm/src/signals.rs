use reachtube_conform::data::{Part, Signal, Signals};
use reachtube_recordings::State;
use reachtube_robot::{JointKind, Robot};

use crate::settings::Equations;

/// Returns what the numbers of a model of a robot are: positions, then velocities, and torques.
pub(crate) fn signals(robot: &Robot, equations: Equations) -> Signals {
    let joints = &robot.description().joints;
    let n = joints.len();
    let signal = |name: String, unit: &str| Signal { name, unit: unit.into() };
    let state = |(j, unit): (usize, fn(JointKind) -> &'static str)| {
        signal(State::from_index(j, n).to_string(), unit(joints[j % n].kind))
    };
    let units = |unit: fn(JointKind) -> &'static str| std::iter::repeat_n(unit, n);
    let units = units(JointKind::position_unit).chain(units(JointKind::velocity_unit));
    let input = |j: usize| match equations.is_kinematic() {
        true => signal(format!("qdd{}", j + 1), joints[j].kind.acceleration_unit()),
        false => signal(format!("tau{}", j + 1), joints[j].kind.force_unit()),
    };
    let part =
        |j: usize| Part { name: joints[j].name.clone(), states: vec![j, n + j], inputs: vec![j] };
    Signals {
        states: units.enumerate().map(state).collect(),
        inputs: (0..n).map(input).collect(),
        parts: (0..n).map(part).collect(),
        noun: "joint".into(),
        nominal: nominal(equations).map(Into::into),
    }
}

/// Returns which equations nominal motions satisfy that are not the model's.
fn nominal(equations: Equations) -> Option<&'static str> {
    Some(match equations {
        Equations::Model => return None,
        Equations::Robot => "the robot's own equations",
        Equations::Velocity => "a velocity that stays",
        Equations::Decaying => "an acceleration that dies out",
        Equations::Held => "an acceleration that stays",
    })
}
