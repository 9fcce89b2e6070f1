//! How well a motion shows parameters.

use super::ExcitationSettings;
use super::shape::Shape;
use crate::singular::singular_values;
use crate::{BaseParameters, Regressor, Robot};
use nalgebra::DMatrix;

/// What an exciting motion is chosen for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Criterion {
    /// D-optimal: the smallest ellipsoid of confidence; units of the parameters do not matter.
    #[default]
    LogDeterminant,
    /// The smallest condition number of the base regressor with columns of unit length.
    Condition,
}

/// How well a motion shows base parameters, from 20 samples a harmonic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// ln det of the information matrix Y_bᵀ W Y_b / samples in SI units, W the inverse variances
    /// of torque; -∞ where some combination is not shown.
    pub log_determinant: f64,
    /// Condition number of the weighted Y_b with columns of unit length.
    pub condition: f64,
}

/// Judges motions, with the memory for it.
pub(super) struct Judge<'a> {
    regressor: Regressor<'a>,
    criterion: Criterion,
    weights: Vec<f64>,
    independent: Vec<usize>,
    states: Vec<[Vec<f64>; 3]>,
    row: Vec<f64>,
    stacked: DMatrix<f64>,
}

impl<'a> Judge<'a> {
    pub fn new(robot: &'a Robot, base: &BaseParameters, settings: &ExcitationSettings) -> Self {
        let (n, points) = (robot.joint_count(), super::fourier::GRID * settings.harmonics);
        let weight = |i: usize| settings.torque_noise.get(i).map_or(1.0, |s| 1.0 / s);
        Self {
            regressor: Regressor::new(robot, base.columns()),
            criterion: settings.criterion,
            weights: (0..n).map(weight).collect(),
            independent: base.independent().to_vec(),
            states: vec![core::array::from_fn(|_| vec![0.0; n]); points],
            row: vec![0.0; n * base.columns().len()],
            stacked: DMatrix::zeros(n * points, base.count()),
        }
    }

    /// The criterion, to be made large.
    pub fn value(&mut self, shape: &Shape, x: &[f64]) -> f64 {
        self.stack(shape, x);
        match self.criterion {
            Criterion::LogDeterminant => self.log_determinant(),
            Criterion::Condition => -self.condition(),
        }
    }

    pub fn quality(&mut self, shape: &Shape, x: &[f64]) -> Quality {
        self.stack(shape, x);
        Quality { log_determinant: self.log_determinant(), condition: self.condition() }
    }

    /// The weighted base regressor over the motion.
    fn stack(&mut self, shape: &Shape, x: &[f64]) {
        debug_assert_eq!(shape.points(), self.states.len());
        shape.states(&shape.trajectory(x), &mut self.states);
        let width = self.regressor.columns().len();
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

    /// By columns of unit length, whose lengths are added afterwards: units then do not cost
    /// digits.
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
        // Also when there is no column at all.
        values.first().zip(values.last()).map_or(f64::INFINITY, |(most, least)| most / least)
    }
}
