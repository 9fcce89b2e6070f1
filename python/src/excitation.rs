//! Exciting motions.

use std::sync::Arc;

use pyo3::prelude::*;
use reachtube::robot::{Criterion, ExcitationSettings, Parameter, ParameterKind};

use crate::arrays::{Output, array};
use crate::robot::NativeRobot;
use crate::watched::watched;

/// The inertia of links and motors, and friction.
const EXCITED: [ParameterKind; 4] = [
    ParameterKind::MotorInertia,
    ParameterKind::Coulomb,
    ParameterKind::Offset,
    ParameterKind::Viscous1,
];

/// A motion: t (K), q, qd and qdd (K x n each), and the condition numbers of the base regressor of
/// the motion and of a random one.
type Motion<'py> = (Output<'py>, Vec<Output<'py>>, f64, f64);

/// Designs an exciting motion within the joint limits.
#[pyfunction]
#[pyo3(signature = (
    robot, period, harmonics, condition, margin, speed, acceleration, torque_noise, starts, trials,
    seed, rate
))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn excite<'py>(
    py: Python<'py>,
    robot: PyRef<'py, NativeRobot>,
    period: f64,
    harmonics: usize,
    condition: bool,
    margin: f64,
    speed: f64,
    acceleration: Vec<f64>,
    torque_noise: Vec<f64>,
    starts: usize,
    trials: usize,
    seed: u64,
    rate: f64,
) -> PyResult<Motion<'py>> {
    let robot = Arc::clone(&robot.robot);
    let n = robot.joint_count();
    let criterion = if condition { Criterion::Condition } else { Criterion::LogDeterminant };
    let settings = ExcitationSettings {
        period,
        harmonics,
        criterion,
        margin,
        speed,
        acceleration,
        torque_noise,
        starts,
        trials,
        seed,
        ..ExcitationSettings::default()
    };
    let found = watched(py, None, move |_| {
        let parameters =
            [ParameterKind::INERTIAL.as_slice(), &EXCITED].map(|k| Parameter::of_joints(n, k));
        Ok(robot.excitation(&parameters.concat(), &settings)?)
    })?;
    let samples: Vec<_> = found.trajectory.samples(rate).collect();
    let shape = [samples.len(), n];
    let times = samples.iter().map(|sample| sample.t).collect();
    let all = |of: fn(&reachtube::robot::MotionSample) -> &Vec<f64>| {
        array(py, samples.iter().flat_map(|sample| of(sample).clone()).collect(), &shape)
    };
    let motion = vec![all(|s| &s.q), all(|s| &s.qd), all(|s| &s.qdd)];
    let (found, random) = (found.quality.condition, found.initial_quality.condition);
    Ok((array(py, times, &shape[..1]), motion, found, random))
}
