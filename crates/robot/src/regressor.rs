//! The regressor of chosen parameters.

use crate::inertia::INERTIAL;
use crate::inertial_regressor::RegressorWorkspace;
use crate::parameter::Parameter;
use crate::robot::Robot;
use nalgebra::DMatrix;

/// The regressor Y of chosen parameters θ over `f64`: motor torque = Y θ.
///
/// It covers friction and torque offsets if their parameters are chosen.
///
/// # Examples
///
/// ```
/// use reachtube_robot::{Parameter, ParameterKind, Regressor, Robot};
///
/// let robot = Robot::lwa4p();
/// let kinds = [ParameterKind::MotorInertia, ParameterKind::Viscous1];
/// let mut regressor = Regressor::new(&robot, &Parameter::of_joints(6, &kinds));
/// let mut y = vec![0.0; 6 * 12];
/// regressor.fill(&[0.1; 6], &[0.2; 6], &[0.3; 6], &mut y);
/// assert_eq!(y[..3], [0.3, 0.2, 0.0]);
/// ```
#[derive(Clone, Debug)]
pub struct Regressor<'a> {
    robot: &'a Robot,
    parameters: Vec<Parameter>,
    ws: RegressorWorkspace<f64>,
    sin: Vec<f64>,
    cos: Vec<f64>,
    /// Regressor of all inertial parameters, n x 10 n, row by row.
    inertial: Vec<f64>,
}

impl<'a> Regressor<'a> {
    /// Makes a regressor with one column per parameter, in the given order.
    ///
    /// # Panics
    ///
    /// Panics if a parameter belongs to a joint that the robot does not have.
    pub fn new(robot: &'a Robot, parameters: &[Parameter]) -> Self {
        let n = robot.joint_count();
        assert!(parameters.iter().all(|p| p.joint < n), "`{}` has {n} joints", robot.name());
        Self {
            robot,
            parameters: parameters.to_vec(),
            ws: RegressorWorkspace::new(robot),
            sin: vec![0.0; n],
            cos: vec![0.0; n],
            inertial: vec![0.0; INERTIAL * n * n],
        }
    }

    pub(crate) fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Writes Y \[n x parameters, row by row\] at q \[rad\], q̇ \[rad/s\], q̈ \[rad/s²\], without
    /// allocation.
    ///
    /// # Panics
    ///
    /// Panics if a slice is too short.
    pub fn fill(&mut self, q: &[f64], qd: &[f64], qdd: &[f64], y: &mut [f64]) {
        let n = self.robot.joint_count();
        for (i, (joint, q)) in self.robot.joints().iter().zip(&q[..n]).enumerate() {
            (self.sin[i], self.cos[i]) = joint.kind.sin_cos(q);
        }
        if self.parameters.iter().any(|p| p.kind.is_inertial()) {
            let Self { robot, ws, sin, cos, inertial, .. } = self;
            robot.inertial_regressor(sin, cos, qd, qdd, ws, inertial);
        }
        let width = self.parameters.len();
        for (i, row) in y[..n * width].chunks_exact_mut(width).enumerate() {
            for (y, parameter) in row.iter_mut().zip(&self.parameters) {
                *y = match parameter {
                    p if p.kind.is_inertial() => {
                        self.inertial[INERTIAL * (i * n + p.joint) + p.kind as usize]
                    }
                    p if p.joint == i => p.kind.drive_entry(qd[i], qdd[i]),
                    _ => 0.0,
                };
            }
        }
    }

    /// Returns the regressors of many states \[(q, q̇, q̈)\], one below the other:
    /// (n · states) x parameters.
    pub fn stacked(&mut self, states: &[[Vec<f64>; 3]]) -> DMatrix<f64> {
        let (n, width) = (self.robot.joint_count(), self.parameters.len());
        let mut rows = vec![0.0; n * width * states.len()];
        for ([q, qd, qdd], y) in states.iter().zip(rows.chunks_exact_mut((n * width).max(1))) {
            self.fill(q, qd, qdd, y);
        }
        DMatrix::from_row_slice(n * states.len(), width, &rows)
    }
}
