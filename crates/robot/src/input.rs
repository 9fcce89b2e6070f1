//! Conversions between motor torque, link-side torque and the input u of the paper's model (10).

use crate::robot::Robot;
use nalgebra::DVector;

impl Robot {
    /// Returns the viscous friction torque tau_v(q̇) of (5) \[N m\], one entry per joint.
    pub fn viscous_torque(&self, qd: &[f64]) -> DVector<f64> {
        let torques = self.joints.iter().zip(qd).map(|(j, qd)| j.friction.viscous.torque(qd));
        DVector::from_iterator(self.joint_count(), torques)
    }

    /// Returns the Coulomb friction torque tau_c(g(q), q̇) of (6) to (9) \[N m\], with the gravity
    /// torque as the load. It contains the Stribeck effect of joints that have one.
    pub fn coulomb_torque(&self, q: &[f64], qd: &[f64]) -> DVector<f64> {
        self.coulomb_torque_under(&self.gravity_torque(q), qd)
    }

    /// Returns the Coulomb friction torque \[N m\] under a load torque \[N m\].
    fn coulomb_torque_under(&self, load: &DVector<f64>, qd: &[f64]) -> DVector<f64> {
        let joints = self.joints.iter().zip(load.iter().zip(qd));
        DVector::from_iterator(
            self.joint_count(),
            joints.map(|(j, (load, qd))| j.friction.dry_torque(*load, *qd)),
        )
    }

    /// Returns the input (11) for a motor torque on the link side:
    /// u = tau_m - tau_c(g(q), q̇) - g(q) \[N m\].
    ///
    /// # Examples
    ///
    /// ```
    /// let robot = reachtube_robot::Robot::lwa4p();
    /// let (q, qd) = ([0.4; 6], [-0.2; 6]);
    /// let u = robot.input_from_motor_torque(&q, &qd, &[3.0; 6]);
    /// let tau_motor = robot.motor_torque_from_input(&q, &qd, u.as_slice());
    /// assert!((tau_motor.add_scalar(-3.0)).amax() < 1e-13);
    /// ```
    pub fn input_from_motor_torque(
        &self,
        q: &[f64],
        qd: &[f64],
        tau_motor: &[f64],
    ) -> DVector<f64> {
        let g = self.gravity_torque(q);
        DVector::from_column_slice(tau_motor) - self.coulomb_torque_under(&g, qd) - g
    }

    /// Returns the input (11) \[N m\] for a motor torque on the link side, where the friction of a
    /// joint near standstill holds it.
    ///
    /// [`Robot::input_from_motor_torque`] lets the friction of a joint at rest step from one sign
    /// to the other with the noise of its velocity.
    ///
    /// # Examples
    ///
    /// ```
    /// let robot = reachtube_robot::Robot::lwa4p();
    /// let tau_motor = robot.gravity_torque(&[0.4; 6]).add_scalar(1.0);
    /// let u = robot.input_from_holding_torque(&[0.4; 6], &[1e-4; 6], tau_motor.as_slice());
    /// assert!(u.amax() < 0.05); // the joints stay where they are
    /// ```
    pub fn input_from_holding_torque(
        &self,
        q: &[f64],
        qd: &[f64],
        tau_motor: &[f64],
    ) -> DVector<f64> {
        let g = self.gravity_torque(q);
        let driving = DVector::from_column_slice(tau_motor) - &g;
        let joints = self.joints.iter().zip(qd).zip(g.iter().zip(&driving));
        let input = joints.map(|((joint, qd), (load, driving))| {
            driving - joint.friction.holding_torque(*load, *qd, *driving)
        });
        DVector::from_iterator(self.joint_count(), input)
    }

    /// Returns the motor torque that gives an input \[N m\], which is the inverse of
    /// [`Robot::input_from_motor_torque`].
    pub fn motor_torque_from_input(&self, q: &[f64], qd: &[f64], u: &[f64]) -> DVector<f64> {
        let g = self.gravity_torque(q);
        DVector::from_column_slice(u) + self.coulomb_torque_under(&g, qd) + g
    }

    /// Returns the input for a link-side torque, from which all friction is already subtracted:
    /// u = tau_l - g(q) + tau_v(q̇) \[N m\].
    ///
    /// With this u, model (10) gives M_m q̈ + c = u - tau_v = tau_l - g.
    pub fn input_from_link_torque(&self, q: &[f64], qd: &[f64], tau_link: &[f64]) -> DVector<f64> {
        DVector::from_column_slice(tau_link) - self.gravity_torque(q) + self.viscous_torque(qd)
    }
}
