use crate::bodies::RisingFriction;
use crate::error::{Error, Result};
use crate::fit::{Fit, JointFit};
use crate::friction::falling::{FallingFriction, ViscousColumns, nearest};
use crate::inertia::base::{BaseParameter, base_parameters};
use crate::inertia::columns::{FrictionColumns, fitted_columns};
use crate::inertia::diagonal::JointInertia;
use crate::inertia::physical::{PhysicalFit, nearest_bodies, residual_sizes, why_impossible};
use crate::inertia::reference::reference_factor;
use crate::prepare::log::PreparedLog;
use crate::samples::{KnownTorque, Samples, Sampling};
use crate::settings::ModelSettings;
use crate::stiction::KnownFriction;
use nalgebra::DVector;
use reachtube_robot::{BaseParameters, Parameter, ParameterSet, Robot};

/// A part of a combination that is rounding.
const NEGLIGIBLE_PART: f64 = 1e-9;

/// The fit of the inertial parameters to exciting motions.
#[derive(Debug, Clone)]
pub struct InertiaFit {
    /// The columns of the regression.
    pub columns: Vec<Parameter>,
    /// The robust or plain least-squares fit.
    pub fit: Fit,
    /// The values that are used, one per column: from the nearest physically consistent links, or
    /// from least squares.
    pub values: DVector<f64>,
    /// Effect of the physical constraint; `None` if it was not requested.
    pub physical: Option<PhysicalFit>,
    /// Viscous friction of least squares that falls with speed and was not used.
    pub falling: Vec<FallingFriction>,
    /// Reason why no physical robot has the values of least squares, if these are used.
    pub impossible: Option<String>,
    /// Quality of the fit, one entry per joint.
    pub joints: Vec<JointFit>,
    /// Standard errors of least squares, one per column; `None` if a column is not a combination of
    /// its own, or the recordings do not determine it.
    pub standard_errors: Vec<Option<f64>>,
    /// The identifiable combinations of parameters.
    pub parameters: Vec<BaseParameter>,
    /// Number of combinations that the recordings determine.
    pub determined: usize,
    /// Condition number of the recorded motions: the largest over the smallest excitation of a
    /// combination, each relative to a motion through all positions with the recorded speeds.
    ///
    /// It does not depend on the frames of the links, and is infinite if the recordings do not
    /// determine a combination.
    pub condition: f64,
    /// The inertia that each joint feels, with its standard error.
    pub diagonal: Vec<JointInertia>,
    /// Relative singular values on either side of the rank of the structural regressor.
    ///
    /// A wide gap between them confirms the number of combinations.
    pub gap: [f64; 2],
}

/// Fits the inertial parameters to exciting motions and poses at rest.
///
/// The friction of `known` is subtracted, with the gravity torque of `known` as its load. The
/// joints may keep a part of the friction `kept` at rest.
///
/// # Errors
///
/// [`Error::NoMotion`], [`Error::NoPhysicalLinks`] or [`Error::Undetermined`].
pub(crate) fn fit_inertia(
    robot: &Robot,
    known: &Robot,
    [excitation, rests]: [&[PreparedLog]; 2],
    kept: Option<KnownFriction>,
    sampling: &Sampling,
    model: &ModelSettings,
    friction: FrictionColumns,
) -> Result<InertiaFit> {
    let columns = fitted_columns(known, model, friction);
    // Regression on motions and poses.
    let known_torque = KnownTorque::Friction(known);
    let moving = Samples::in_motion(robot, &columns, excitation, sampling, &known_torque);
    if !moving.used.contains(&true) {
        return Err(Error::NoMotion);
    }
    let quiet = [model.rest_speed, sampling.margin];
    let (still, _) = Samples::at_rest(robot, &columns, rests, quiet, kept);
    let groups: Vec<&Samples> =
        [&moving, &still].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of_groups(&groups, !model.robust);
    // Physically consistent links.
    let has_bodies = robot.description().parameters == ParameterSet::Physical;
    // Behind the gears, wrists have almost no inertia, and least squares often a negative one.
    let has_bodies = model.physical.unwrap_or(has_bodies || !model.motor_inertia);
    let limits = sampling.velocity_limits(robot);
    let viscous = ViscousColumns::of_robot(known, &columns, &limits, &fit.whitened);
    let physical = has_bodies
        .then(|| nearest_bodies([robot, known], &viscous, &fit, &moving, model))
        .transpose()?;
    let (values, physical, falling, impossible) = match physical {
        Some((values, physical, falling)) => (values, Some(physical), falling, None),
        None => {
            let (values, falling) = plain_values(&fit, &moving, &viscous)?;
            let impossible = why_impossible(robot, &columns, &values)?;
            (values, None, falling, impossible)
        }
    };
    let solved = (&fit.whitened, &fit.solution.x);
    // Identifiable combinations.
    let base = BaseParameters::of_robot(robot, &columns);
    let reference = reference_factor(robot, &columns, excitation, &fit.joints[0]);
    let factors = [&fit.whitened, &reference];
    let base_fit = base_parameters(robot, &base, factors, &values, has_bodies)?;
    Ok(InertiaFit {
        joints: fit.joints[0].clone(),
        gap: base.gap(),
        diagonal: JointInertia::of_joints(robot, &columns, excitation, solved),
        columns,
        fit,
        values,
        physical,
        falling,
        impossible,
        standard_errors: single_errors(&base, &base_fit.parameters),
        parameters: base_fit.parameters,
        determined: base_fit.determined,
        condition: base_fit.condition,
    })
}

/// Returns the values of least squares with viscous friction that rises, and the friction that did
/// not.
fn plain_values(
    fit: &Fit,
    moving: &Samples,
    viscous: &ViscousColumns,
) -> Result<(DVector<f64>, Vec<FallingFriction>)> {
    let mut values = fit.solution.x.clone();
    let solve = |rising: &[RisingFriction]| Ok(nearest(&fit.whitened, 1.0, rising));
    let falling = viscous.rise::<Error>(&mut values, solve, |x| residual_sizes(moving, x))?;
    Ok((values, falling))
}

/// Returns the standard error of each column that is a base parameter alone.
fn single_errors(base: &BaseParameters, parameters: &[BaseParameter]) -> Vec<Option<f64>> {
    let mut errors = vec![None; base.parameters().len()];
    for (row, (&column, parameter)) in base.independent().iter().zip(parameters).enumerate() {
        let combination = base.combinations().row(row);
        let others = combination.iter().enumerate().filter(|(at, _)| *at != column);
        if others.map(|(_, part)| part.abs()).fold(0.0, f64::max) < NEGLIGIBLE_PART {
            errors[column] = Some(parameter.standard_error).filter(|error| error.is_finite());
        }
    }
    errors
}

impl InertiaFit {
    /// Returns warnings about links that contradict the data, and about values that no physical
    /// robot has.
    pub(crate) fn body_warnings(&self, robot: &Robot) -> Vec<String> {
        let impossible = self.impossible.iter().map(|why| {
            format!(
                "least squares gives a robot that cannot exist: {why}; set model.physical = true \
                 for the nearest physical links, without which motion cannot be simulated"
            )
        });
        let physical =
            self.physical.iter().flat_map(|physical| physical.growth_warnings(robot, &self.joints));
        let open = self.diagonal.iter().filter_map(|inertia| inertia.warning(robot));
        impossible.chain(physical).chain(open).collect()
    }

    /// Returns a warning that names the combinations that only the prior determines, if there are
    /// any.
    #[must_use]
    pub(crate) fn undetermined_warning(&self) -> Option<String> {
        let names: Vec<&str> = self
            .parameters
            .iter()
            .filter(|p| p.standard_error.is_infinite())
            .map(|p| p.name.as_str())
            .collect();
        (!names.is_empty()).then(|| {
            format!(
                "the recordings do not determine {} of {} combinations of parameters; the prior \
                 decides about them, which affects: {}",
                self.parameters.len() - self.determined,
                self.parameters.len(),
                names.join("; ")
            )
        })
    }
}
