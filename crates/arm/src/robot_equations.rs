//! The input under which a linear model accelerates as the robot itself does.

use nalgebra::{DMatrix, DVector};
use reachtube_conform::Result;
use reachtube_ode::VectorField;
use reachtube_reach::LinearSystem;
use reachtube_robot::{DrivenBy, Robot, RobotField};

use crate::setup::not_linear;

/// The robot's equations of motion (10) beside a linear model of it.
#[derive(Debug)]
pub(super) struct RobotEquations {
    robot: RobotField<'static, f64>,
    /// The last n rows of A, for q̈, n x 2n.
    of_state: DMatrix<f64>,
    /// The last n entries of d.
    drift: DVector<f64>,
    /// The inverse of the last n rows of B.
    of_acceleration: DMatrix<f64>,
    /// ẋ of the robot, 2n.
    rate: Vec<f64>,
    /// Its q̈, less the model's without input, n.
    missing: DVector<f64>,
    /// n.
    input: DVector<f64>,
}

impl RobotEquations {
    /// Lays the equations of `robot` beside the equations of `model`.
    ///
    /// # Errors
    ///
    /// Where an input of the model moves no joint.
    pub(super) fn new(robot: &Robot, model: &LinearSystem) -> Result<Self> {
        let n = robot.joint_count();
        let of_input = model.b().rows(n, n).into_owned();
        Ok(Self {
            robot: RobotField::new(robot, DrivenBy::Input).into_owned(),
            of_state: model.a().rows(n, n).into_owned(),
            drift: model.drift().rows(n, n).into_owned(),
            of_acceleration: of_input.try_inverse().ok_or_else(not_linear)?,
            rate: vec![0.0; 2 * n],
            missing: DVector::zeros(n),
            input: DVector::zeros(n),
        })
    }

    /// Replaces the robot's input `u` (n, N m) at the state `x` (2n) by the model's: the q̈ of the
    /// model then equals the robot's.
    pub(super) fn replace(&mut self, x: &[f64], u: &mut [f64]) {
        self.robot.rate(0.0, x, u, &mut self.rate);
        let (n, drift) = (u.len(), &self.drift);
        for (j, row) in self.of_state.row_iter().enumerate() {
            let own: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
            self.missing[j] = self.rate[n + j] - own - drift[j];
        }
        self.of_acceleration.mul_to(&self.missing, &mut self.input);
        u.copy_from_slice(self.input.as_slice());
    }
}
