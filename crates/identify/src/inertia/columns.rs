use crate::settings::ModelSettings;
use nalgebra::DVector;
use reachtube_robot::{Parameter, ParameterKind, Robot};

/// Columns of friction that are fitted together with the inertial parameters.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FrictionColumns {
    /// Whether friction is fitted at all; for known friction the fit is a correction.
    pub fitted: bool,
    /// Whether viscous friction has a cubic term.
    pub cubic: bool,
}

/// Returns the columns that are fitted to exciting motions.
///
/// The correction of a known quadratic friction needs a column of its own. Friction that saturates
/// has no cubic term.
pub(crate) fn fitted_columns(
    known: &Robot,
    model: &ModelSettings,
    friction: FrictionColumns,
) -> Vec<Parameter> {
    let joints = known.joint_count();
    let mut columns = Parameter::of_joints(joints, &ParameterKind::INERTIAL);
    if model.motor_inertia {
        columns.extend(Parameter::of_joints(joints, &[ParameterKind::MotorInertia]));
    }
    if friction.fitted {
        let kinds = [
            ParameterKind::Coulomb,
            ParameterKind::Offset,
            ParameterKind::Viscous1,
            ParameterKind::Viscous3,
        ];
        columns.extend(Parameter::of_joints(joints, &kinds[..if friction.cubic { 4 } else { 3 }]));
        let known = known.description().joints.iter();
        let saturates: Vec<bool> = known.clone().map(|joint| joint.friction.saturates()).collect();
        columns.retain(|c| c.kind != ParameterKind::Viscous3 || !saturates[c.joint]);
        let known = known.enumerate();
        let quadratic = known.filter(|(_, known)| known.friction.viscous[1] != 0.0);
        columns
            .extend(quadratic.map(|(joint, _)| Parameter { joint, kind: ParameterKind::Viscous2 }));
    }
    columns
}

fn is_inertia(column: &Parameter) -> bool {
    column.kind.is_inertial() || column.kind == ParameterKind::MotorInertia
}

/// Returns the columns of links and motors with their values, without the columns of friction.
pub(crate) fn inertia_part(
    columns: &[Parameter],
    values: &DVector<f64>,
) -> (Vec<Parameter>, DVector<f64>) {
    let (columns, values): (Vec<Parameter>, Vec<f64>) =
        columns.iter().zip(values.iter()).filter(|(column, _)| is_inertia(column)).unzip();
    (columns, DVector::from_vec(values))
}
