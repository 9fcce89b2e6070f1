//! Evaluation of how well a motion identifies parameters.

use super::fourier::GRID;
use super::search_space::SearchSpace;
use super::settings::{Criterion, ExcitationSettings};
use crate::base_parameters::base::BaseParameters;
use crate::regressor::Regressor;
use crate::robot::Robot;
use crate::singular_values::singular_values;
use nalgebra::DMatrix;

/// The quality of a motion for the identification of base parameters, computed from 20 samples per
/// harmonic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// ln det of the information matrix Y_bᵀ W Y_b / samples in SI units, with the inverse
    /// variances of torque as W; -∞ if a base parameter does not affect the torque.
    pub log_determinant: f64,
    /// Condition number of the weighted Y_b with columns of unit length.
    pub condition: f64,
}

/// Evaluates motions, with scratch memory.
pub(super) struct Evaluator<'a> {
    regressor: Regressor<'a>,
    criterion: Criterion,
    /// Inverse standard deviation of each joint's torque.
    weights: Vec<f64>,
    independent: Vec<usize>,
    states: Vec<[Vec<f64>; 3]>,
    /// Regressor of all parameters at one state, row by row.
    row: Vec<f64>,
    /// Weighted base regressor of all states.
    stacked: DMatrix<f64>,
}

impl<'a> Evaluator<'a> {
    pub(super) fn new(
        robot: &'a Robot,
        base: &BaseParameters,
        settings: &ExcitationSettings,
    ) -> Self {
        let (n, points) = (robot.joint_count(), GRID * settings.harmonics);
        let weight = |i: usize| settings.torque_noise.get(i).map_or(1.0, |s| 1.0 / s);
        Self {
            regressor: Regressor::new(robot, base.parameters()),
            criterion: settings.criterion,
            weights: (0..n).map(weight).collect(),
            independent: base.independent().to_vec(),
            states: vec![core::array::from_fn(|_| vec![0.0; n]); points],
            row: vec![0.0; n * base.parameters().len()],
            stacked: DMatrix::zeros(n * points, base.count()),
        }
    }

    /// Returns the criterion, which is to be maximised.
    pub(super) fn value(&mut self, space: &SearchSpace, x: &[f64]) -> f64 {
        self.stack(space, x);
        match self.criterion {
            Criterion::LogDeterminant => self.log_determinant(),
            Criterion::Condition => -self.condition(),
        }
    }

    pub(super) fn quality(&mut self, space: &SearchSpace, x: &[f64]) -> Quality {
        self.stack(space, x);
        Quality { log_determinant: self.log_determinant(), condition: self.condition() }
    }

    /// Computes the weighted base regressor over the motion.
    fn stack(&mut self, space: &SearchSpace, x: &[f64]) {
        debug_assert_eq!(space.points(), self.states.len());
        space.states(&space.trajectory(x), &mut self.states);
        let width = self.regressor.parameters().len();
        for (k, [q, qd, qdd]) in self.states.iter().enumerate() {
            self.regressor.fill(q, qd, qdd, &mut self.row);
            for (i, weight) in self.weights.iter().enumerate() {
                let row = &self.row[i * width..(i + 1) * width];
                for (j, &column) in self.independent.iter().enumerate() {
                    self.stacked[(k * self.weights.len() + i, j)] = weight * row[column];
                }
            }
        }
    }

    /// Returns ln det of the information matrix.
    ///
    /// The columns are scaled to unit length and their lengths are added afterwards, so that
    /// different units do not cost digits.
    fn log_determinant(&self) -> f64 {
        let lengths: Vec<f64> = self.stacked.column_iter().map(|c| c.norm()).collect();
        if lengths.contains(&0.0) {
            return f64::NEG_INFINITY;
        }
        let mut gram = self.stacked.tr_mul(&self.stacked);
        for (j, length) in lengths.iter().enumerate() {
            gram.column_mut(j).unscale_mut(*length);
            gram.row_mut(j).unscale_mut(*length);
        }
        let points = self.states.len() as f64;
        let own: f64 = lengths.iter().map(|l| 2.0 * l.ln() - points.ln()).sum();
        gram.cholesky()
            .map_or(f64::NEG_INFINITY, |l| own + 2.0 * l.l_dirty().diagonal().map(f64::ln).sum())
    }

    /// Returns the condition number with columns of unit length.
    fn condition(&self) -> f64 {
        let mut unit = self.stacked.clone();
        for mut column in unit.column_iter_mut() {
            let length = column.norm();
            if length == 0.0 {
                return f64::INFINITY;
            }
            column.unscale_mut(length);
        }
        let values = singular_values(&unit.qr().r());
        // Infinite too if there is no column.
        values
            .first()
            .zip(values.last())
            .map_or(f64::INFINITY, |(largest, smallest)| largest / smallest)
    }
}
