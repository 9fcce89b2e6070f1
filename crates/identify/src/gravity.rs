//! Gravity from poses at rest and slow motions, and with its torque as the load, friction.

use super::fit::{Fit, JointFit};
use super::friction::{self, FrictionFit, FrictionSample};
use super::inertia::ILL_CONDITIONED;
use super::prepare::Log;
use super::samples::{Known, Samples, Sampling};
use crate::error::Result;
use nalgebra::DVector;
use reachtube_robot::{
    BaseParameters, Column, ColumnKind, FrictionDescription, GravityMoments, Parameters, Robot,
    RobotDescription,
};
use serde::Serialize;

/// Rounds of gravity and friction, each with what the other found; the second changes the load by
/// what friction's slopes take.
const ROUNDS: usize = 3;

/// Poses for each combination that gravity shows, from which on slow motions are not needed for
/// gravity.
const POSES_PER_PARAMETER: usize = 2;

/// Gravity as fitted to poses at rest and to slow motions.
#[derive(Debug, Clone, Serialize)]
pub struct GravityFit {
    /// Poses at rest.
    pub rests: usize,
    /// Samples of slow motions.
    pub slow_samples: usize,
    /// How well the torque at rest was fitted, joint by joint; empty without poses.
    pub at_rest: Vec<JointFit>,
    /// How well the torque in slow motion was fitted, joint by joint; empty without slow motions.
    pub in_motion: Vec<JointFit>,
    /// A robot with these gravity moments: only its gravity torque is meant.
    #[serde(skip)]
    pub robot: Robot,
}

/// Gravity, and friction with gravity for its load.
pub struct GravityAndFriction {
    /// None without poses and slow motions.
    pub gravity: Option<GravityFit>,
    /// The joints whose friction was fitted.
    pub friction: Vec<FrictionFit>,
    /// Joints that could not be fitted, in words.
    pub notes: Vec<String>,
}

/// Fits gravity to rests and slow motions, and friction to slow motions, in turn.
pub fn fit(
    robot: &Robot,
    rests: &[Log],
    slow: &[Log],
    sampling: &Sampling,
    rest_speed: f64,
    robust: bool,
) -> Result<GravityAndFriction> {
    let mut found = GravityAndFriction { gravity: None, friction: Vec::new(), notes: Vec::new() };
    if rests.is_empty() && slow.is_empty() {
        return Ok(found);
    }
    let n = robot.joint_count();
    let mut with_friction = with_friction(robot, &vec![FrictionDescription::default(); n])?;
    for round in 0..ROUNDS {
        let known = if round == 0 { Known::Nothing } else { Known::Friction(&with_friction) };
        let gravity = fit_gravity(robot, rests, slow, sampling, rest_speed, robust, &known)?;
        (found.friction, found.notes) = fit_friction(&gravity.robot, slow, sampling);
        let coefficients = coefficients(&found.friction, robot);
        // The load of the friction that is known in the next round is this gravity.
        with_friction = self::with_friction(&gravity.robot, &coefficients)?;
        found.gravity = Some(gravity);
    }
    Ok(found)
}

/// The fitted friction of each joint; none for the others.
pub fn coefficients(fits: &[FrictionFit], robot: &Robot) -> Vec<FrictionDescription> {
    let of = |name: &String| {
        fits.iter().find(|fit| fit.joint.joint == *name).map(|fit| fit.joint.coefficients)
    };
    robot.joints().iter().map(|joint| of(&joint.name).unwrap_or_default()).collect()
}

/// The same robot with this friction, its gravity that of its links.
pub fn with_friction(robot: &Robot, friction: &[FrictionDescription]) -> Result<Robot> {
    let mut description = robot.description().clone();
    for (joint, friction) in description.joints.iter_mut().zip(friction) {
        joint.friction = *friction;
    }
    Ok(Robot::from_description(&description)?)
}

/// The same robot with other inertial parameters, as combinations that need not be bodies.
pub fn with_parameters(robot: &Robot, columns: &[Column], values: &DVector<f64>) -> Result<Robot> {
    let base = RobotDescription { parameters: Parameters::Base, ..robot.description().clone() };
    Ok(Robot::from_description(&base.with_values(columns, values.as_slice())?)?)
}

fn fit_gravity(
    robot: &Robot,
    rests: &[Log],
    slow: &[Log],
    sampling: &Sampling,
    rest_speed: f64,
    robust: bool,
    known: &Known,
) -> Result<GravityFit> {
    let n = robot.joint_count();
    let inertial = Column::of_joints(n, &ColumnKind::INERTIAL);
    let moving = [
        ColumnKind::MotorInertia,
        ColumnKind::Coulomb,
        ColumnKind::Offset,
        ColumnKind::Viscous1,
        ColumnKind::Viscous3,
    ];
    // Without slow motions nothing shows friction or inertia.
    let columns = if slow.is_empty() {
        inertial.clone()
    } else {
        [inertial.clone(), Column::of_joints(n, &moving)].concat()
    };
    let at_rest = Samples::of_rests(robot, &columns, rests, rest_speed);
    // Slopes of friction that differ between driving and braking look like gravity in motion; poses
    // tell them apart, if there are enough.
    let poses = at_rest.len() / n;
    let enough = poses >= POSES_PER_PARAMETER * BaseParameters::at_rest(robot, &inertial).count();
    let slow = if enough { &[] } else { slow };
    let in_motion = Samples::of(robot, &columns, slow, sampling, known);
    let groups: Vec<&Samples> =
        [&at_rest, &in_motion].into_iter().filter(|samples| !samples.is_empty()).collect();
    let fit = Fit::of(&groups, !robust);
    let values = fit.solution.x.rows(0, inertial.len()).into_owned();
    let mut joints = fit.joints.into_iter();
    let mut of = |samples: &Samples| {
        if samples.is_empty() { Vec::new() } else { joints.next().unwrap_or_default() }
    };
    Ok(GravityFit {
        rests: at_rest.len() / n,
        slow_samples: in_motion.used.iter().filter(|used| **used).count(),
        at_rest: of(&at_rest),
        in_motion: of(&in_motion),
        robot: with_parameters(robot, &inertial, &values)?,
    })
}

/// Friction of each joint, from the samples in which it moves and the others do not.
fn fit_friction(
    robot: &Robot,
    slow: &[Log],
    sampling: &Sampling,
) -> (Vec<FrictionFit>, Vec<String>) {
    let (mut fits, mut notes) = (Vec::new(), Vec::new());
    if slow.is_empty() {
        return (fits, notes);
    }
    for (joint, own) in robot.joints().iter().enumerate() {
        let samples: Vec<FrictionSample> =
            slow.iter().flat_map(|log| alone(robot, log, joint, sampling)).collect();
        match friction::fit(&own.name, &samples) {
            Some(fit) => {
                if fit.joint.condition > ILL_CONDITIONED {
                    notes.push(format!(
                        "friction of {}: the fit is ill-conditioned ({:.0e}), its coefficients mean little one by one; move it through more speeds and loads",
                        own.name, fit.joint.condition
                    ));
                }
                fits.push(fit);
            }
            None => notes.push(format!(
                "friction of {}: {} samples in which it moves alone are too few; it is fitted with the inertial parameters",
                own.name,
                samples.len()
            )),
        }
    }
    (fits, notes)
}

fn alone(robot: &Robot, log: &Log, joint: usize, sampling: &Sampling) -> Vec<FrictionSample> {
    let stride = (1.0 / (sampling.rate * log.step)).floor().max(1.0) as usize;
    let moving = log.moves(&sampling.slow, sampling.margin);
    let rest = |k: usize, j: usize| log.qd(k)[j].abs() < sampling.slow[j];
    let moves = |k: &usize| {
        (0..log.joints).all(|j| if j == joint { moving[k * log.joints + j] } else { rest(*k, j) })
    };
    let sample = |k: usize| {
        let load = robot.gravity_torque(log.q(k))[joint];
        FrictionSample {
            qd: log.qd(k)[joint],
            qdd: log.qdd(k)[joint],
            load,
            torque: log.tau(k)[joint] - load,
        }
    };
    (0..log.len()).step_by(stride).filter(moves).map(sample).collect()
}

/// Gives a description the gravity moments of a fitted robot.
pub fn separate(description: &mut RobotDescription, fitted: &Robot) {
    let parameters = fitted.inertial_parameters();
    for (joint, link) in description.joints.iter_mut().zip(parameters.chunks_exact(10)) {
        joint.gravity_moments =
            Some(GravityMoments { mass: link[0], first_moment: [link[1], link[2], link[3]] });
    }
}
