use reachtube_robot::{Parameter, ParameterKind, Robot};

use crate::export::text::harmless;

/// Notes on what a file with one viscous coefficient omits.
pub(crate) const LEFT_OUT: &str = "Friction is one viscous coefficient and one Coulomb magnitude \
at no load; the dependence on the load and the Stribeck effect are left out.";

/// Number of velocities at which a line is compared with the friction that it stands for.
const COMPARED: usize = 1000;

/// Friction of a joint as simulators express it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SimulatedFriction {
    /// Viscous coefficients v1, v2 and v3, in the units of the robot's description.
    pub viscous: [f64; 3],
    /// Coulomb magnitude at no load \[N m; N\].
    pub loss: f64,
    /// Lowest and highest velocity \[rad/s; m/s\] that count.
    velocities: Option<[f64; 2]>,
}

impl SimulatedFriction {
    /// Takes the friction of joint `j`. What counts are the recorded velocities, or the velocities
    /// up to the limit if none are known.
    pub(crate) fn new(robot: &Robot, j: usize) -> Self {
        let kinds = [
            ParameterKind::Viscous1,
            ParameterKind::Viscous2,
            ParameterKind::Viscous3,
            ParameterKind::Coulomb,
        ];
        let parameters = kinds.map(|kind| Parameter { joint: j, kind });
        let values = robot.parameter_values(&parameters);
        let recorded = robot.description().joints[j].friction.fitted_velocities;
        let limit = || robot.joints()[j].velocity_limit.map(|limit| [-limit, limit]);
        Self {
            viscous: [values[0], values[1], values[2]],
            loss: values[3].max(0.0),
            velocities: recorded.or_else(limit).filter(|[low, high]| low < high),
        }
    }

    /// Returns whether one viscous coefficient is not enough.
    pub(crate) fn is_curved(&self) -> bool {
        self.viscous[1..] != [0.0, 0.0]
    }

    /// Returns the coefficient of the best line: least squares over all velocities that count, and
    /// v1 if none are known.
    pub(crate) fn line(&self) -> f64 {
        let [v1, v2, v3] = self.viscous;
        let Some([low, high]) = self.velocities else { return v1.max(0.0) };
        let moment =
            |power: i32| (high.powi(power + 1) - low.powi(power + 1)) / f64::from(power + 1);
        (v1 + (v2 * moment(3) + v3 * moment(4)) / moment(2)).max(0.0)
    }

    /// Returns what the line is, in words, for a joint that needs more than one.
    fn about(&self, joint: &str) -> String {
        let Some([low, high]) = self.velocities else {
            return format!("{joint}: damping is v1 alone, as no velocities are known.");
        };
        let [v1, v2, v3] = self.viscous;
        let error = |k: usize| {
            let v = low + (high - low) * k as f64 / COMPARED as f64;
            (((v3 * v + v2) * v + v1 - self.line()) * v).abs()
        };
        let worst = (0..=COMPARED).map(error).fold(0.0, f64::max);
        format!(
            "{joint}: damping is the best line over the velocities {low:.3} to {high:.3}; it is \
             off by at most {worst:.2} N m there."
        )
    }
}

/// Returns a paragraph for each joint whose friction is not a line.
pub(crate) fn about_lines(robot: &Robot) -> Vec<String> {
    let joints = robot.joints().iter().enumerate();
    let curved = joints.filter_map(|(j, joint)| {
        let friction = SimulatedFriction::new(robot, j);
        friction.is_curved().then(|| friction.about(&harmless(&joint.name)))
    });
    curved.collect()
}

/// Returns a name as an XML attribute, without quotes and control characters.
pub(crate) fn attribute(name: &str) -> String {
    harmless(name).replace('&', "&amp;").replace('<', "&lt;")
}
