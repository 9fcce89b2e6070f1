use crate::error::{Error, Result};
use crate::fit::{Fit, JointFit};
use crate::inertia::base::{BaseParameter, base_parameters};
use crate::inertia::columns::{FrictionColumns, fitted_columns};
use crate::inertia::physical::{PhysicalFit, nearest_bodies};
use crate::prepare::log::Log;
use crate::samples::{KnownTorque, Samples, Sampling};
use crate::settings::ModelSettings;
use nalgebra::DVector;
use reachtube_robot::{BaseParameters, Parameter, Robot};

/// The fit of the inertial parameters to exciting motions.
#[derive(Debug, Clone)]
pub struct InertiaFit {
    /// The columns of the regression.
    pub columns: Vec<Parameter>,
    /// The robust or plain least-squares fit.
    pub fit: Fit,
    /// The values that are used, one per column: those of the nearest physically consistent links,
    /// or those of least squares.
    pub values: DVector<f64>,
    /// Effect of the physical constraint; `None` if it was not requested.
    pub physical: Option<PhysicalFit>,
    /// Quality of the fit, one entry per joint.
    pub joints: Vec<JointFit>,
    /// The identifiable combinations of parameters.
    pub parameters: Vec<BaseParameter>,
    /// Condition number of the base regressor, columns scaled to unit length.
    ///
    /// It is infinite if the recordings do not determine a combination.
    pub condition: f64,
    /// Relative singular values on either side of the rank of the structural regressor.
    ///
    /// A wide gap between them confirms the number of combinations.
    pub gap: [f64; 2],
}

/// Fits the inertial parameters to exciting motions and poses at rest.
///
/// The friction of `known` is subtracted, with the gravity torque of `known` as its load.
///
/// # Errors
///
/// [`Error::NoMotion`], [`Error::NoPhysicalLinks`] or [`Error::Undetermined`].
pub fn fit_inertia(
    robot: &Robot,
    known: &Robot,
    [dynamic, rests]: [&[Log]; 2],
    sampling: &Sampling,
    model: &ModelSettings,
    friction: FrictionColumns,
) -> Result<InertiaFit> {
    let columns = fitted_columns(robot.joint_count(), model, friction);
    // Regression on motions and poses.
    let known_torque = KnownTorque::Friction(known);
    let moving = Samples::in_motion(robot, &columns, dynamic, sampling, &known_torque);
    if !moving.used.contains(&true) {
        return Err(Error::NoMotion);
    }
    let still = Samples::at_rest(robot, &columns, rests, model.rest_speed);
    let groups: Vec<&Samples> =
        [&moving, &still].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of_groups(&groups, !model.robust);
    // Physically consistent links.
    let physical = model
        .physical
        .then(|| nearest_bodies([robot, known], &columns, &fit, &moving, model))
        .transpose()?;
    let (values, physical) = match physical {
        Some((values, physical)) => (values, Some(physical)),
        None => (fit.solution.x.clone(), None),
    };
    // Identifiable combinations.
    let base = BaseParameters::of_robot(robot, &columns);
    let (parameters, condition) = base_parameters(robot, &base, &fit, &values, model.physical)?;
    Ok(InertiaFit {
        joints: fit.joints[0].clone(),
        gap: base.gap(),
        columns,
        fit,
        values,
        physical,
        parameters,
        condition,
    })
}

impl InertiaFit {
    /// Returns a warning that names the combinations that only the prior determines, if there are
    /// any.
    #[must_use]
    pub fn undetermined_warning(&self) -> Option<String> {
        let names: Vec<&str> = self
            .parameters
            .iter()
            .filter(|p| p.standard_error.is_infinite())
            .map(|p| p.name.as_str())
            .collect();
        (!names.is_empty()).then(|| {
            format!(
                "the recordings do not determine {} of {} combinations of parameters; the prior \
                 decides about them: {}",
                names.len(),
                self.parameters.len(),
                names.join("; ")
            )
        })
    }
}
