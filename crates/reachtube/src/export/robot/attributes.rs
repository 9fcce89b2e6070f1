use reachtube_robot::{Parameter, ParameterKind, Robot};

use crate::export::text::harmless;

/// Notes on what the files omit.
pub(crate) const LEFT_OUT: &str = "Friction is the viscous coefficient v1 and one Coulomb \
magnitude at no load; v2, v3, the dependence on the load and the Stribeck effect are left out.";

/// Returns the viscous coefficient and the Coulomb magnitude of joint `j`.
pub(crate) fn friction(robot: &Robot, j: usize) -> [f64; 2] {
    let kinds = [ParameterKind::Viscous1, ParameterKind::Coulomb];
    let values = robot.parameter_values(&kinds.map(|kind| Parameter { joint: j, kind }));
    [values[0].max(0.0), values[1].max(0.0)]
}

/// Returns a name as an XML attribute, without quotes and control characters.
pub(crate) fn attribute(name: &str) -> String {
    harmless(name).replace('&', "&amp;").replace('<', "&lt;")
}
