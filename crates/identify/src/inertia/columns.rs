use crate::settings::ModelSettings;
use nalgebra::DVector;
use reachtube_robot::{Column, ColumnKind};

/// Columns of friction that are fitted together with the inertial parameters.
#[derive(Debug, Clone, Copy)]
pub struct FrictionColumns {
    /// Whether friction is fitted at all; for known friction the fit is a correction.
    pub fitted: bool,
    /// Whether viscous friction has a cubic term.
    pub cubic: bool,
}

/// Returns the columns that are fitted to exciting motions.
pub fn fitted_columns(
    joints: usize,
    model: &ModelSettings,
    friction: FrictionColumns,
) -> Vec<Column> {
    let mut columns = Column::of_joints(joints, &ColumnKind::INERTIAL);
    if model.motor_inertia {
        columns.extend(Column::of_joints(joints, &[ColumnKind::MotorInertia]));
    }
    if friction.fitted {
        let kinds =
            [ColumnKind::Coulomb, ColumnKind::Offset, ColumnKind::Viscous1, ColumnKind::Viscous3];
        columns.extend(Column::of_joints(joints, &kinds[..if friction.cubic { 4 } else { 3 }]));
    }
    columns
}

fn is_inertia(column: &Column) -> bool {
    column.kind.is_inertial() || column.kind == ColumnKind::MotorInertia
}

/// Returns the columns of links and motors with their values, without those of friction.
pub fn inertia_part(columns: &[Column], values: &DVector<f64>) -> (Vec<Column>, DVector<f64>) {
    let (columns, values): (Vec<Column>, Vec<f64>) =
        columns.iter().zip(values.iter()).filter(|(column, _)| is_inertia(column)).unzip();
    (columns, DVector::from_vec(values))
}
