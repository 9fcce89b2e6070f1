use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::linear::column_sums::{absolute_ends, ends, running_sum};
use crate::linear::propagation::Propagation;
use crate::sets::interval_matrix::{IntervalMatrix, point, product};

/// How outputs y = C x depend on sets that are sums of generators: on the start, in the span of the
/// columns of G_x (N x s), and on an input, in the span of the columns of G_u (m x q), that is
/// constant over each step.
#[derive(Debug, Clone)]
pub struct OutputGains {
    /// C Φᵏ G_x at each sample, p x s.
    pub start: Vec<IntervalMatrix>,
    /// C Γ(t_k) G_u at each sample, p x q: the outputs of inputs that never change.
    pub constant: Vec<IntervalMatrix>,
    /// Σ_{j<k} |C Φʲ Γ(h) G_u| at each sample, p x q: the furthest outputs of inputs that change.
    pub changing: Vec<IntervalMatrix>,
}

impl Propagation {
    /// Computes what outputs y = C x (C: p x N) have of a start and of an input.
    ///
    /// # Guarantee
    ///
    /// Outer: the exact matrices lie in the result, directed rounding. The sums are exact for the
    /// hull of y: some input that is constant over each step reaches each face.
    ///
    /// # Panics
    ///
    /// On a grid that is not uniform, and where the shapes do not fit.
    pub fn output_gains(
        &self,
        outputs: &DMatrix<f64>,
        start_generators: &DMatrix<f64>,
        input_generators: &DMatrix<f64>,
    ) -> OutputGains {
        assert!(self.grid().step().is_some(), "the gains of outputs are for a uniform grid");
        let [c, start, input] = [outputs, start_generators, input_generators].map(point);
        let count = self.grid().len();
        let of_start = |k: usize| product(&product(&c, &self.exponential(k)), &start);
        let of_step = |k: usize| product(&product(&c, &self.increment(k)), &input);
        let steps: Vec<IntervalMatrix> = (0..count).into_par_iter().map(of_step).collect();
        let shape = (c.nrows(), input.ncols());
        let summed = |k: usize| ends(steps[k].as_slice());
        OutputGains {
            start: (0..count).into_par_iter().map(of_start).collect(),
            constant: running_sum(shape, count, summed),
            changing: running_sum(shape, count, |k| summed(k).map(absolute_ends)),
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{dmatrix, dvector};
    use reachtube_scalar::Interval;

    use super::*;
    use crate::grid::TimeGrid;
    use crate::linear::input_gains::Disturbance;
    use crate::linear::step::PropagationStep;
    use crate::linear::system::LinearSystem;

    /// A rotation by a quarter turn: what enters as x leaves as y one step later.
    #[test]
    fn a_quarter_turn_is_seen_exactly() {
        let phi = point(&dmatrix![0.0, -1.0; 1.0, 0.0]);
        let step = PropagationStep {
            phi,
            gamma: point(&dmatrix![1.0; 0.0]),
            drift: dvector![0.0, 0.0].map(Interval::point),
        };
        let turning = Propagation::of_step(step, 0.4, 6).unwrap();
        let (start, input) = (dmatrix![1.0, 1.0; 0.0, 1.0], dmatrix![2.0]);
        let gains = turning.output_gains(&dmatrix![0.0, 3.0], &start, &input);
        let entry = |of: &[IntervalMatrix], j: usize| -> Vec<f64> {
            of.iter().map(|matrix| matrix[(0, j)].mid()).collect()
        };
        assert_eq!(entry(&gains.start, 0), [0.0, 3.0, 0.0, -3.0, 0.0, 3.0]);
        assert_eq!(entry(&gains.start, 1), [3.0, 3.0, -3.0, -3.0, 3.0, 3.0]);
        assert_eq!(entry(&gains.constant, 0), [0.0, 0.0, 6.0, 6.0, 0.0, 0.0]);
        assert_eq!(entry(&gains.changing, 0), [0.0, 0.0, 6.0, 6.0, 12.0, 12.0]);
        assert!(gains.changing.iter().all(|matrix| matrix[(0, 0)].width() < 1e-13));
    }

    /// Seen through the identity, the gains are gains of the states.
    #[test]
    fn states_are_outputs_too() {
        let (a, b) = (dmatrix![0.0, 1.0; -9.0, -0.2], dmatrix![0.0, 0.3; 1.0, 0.1]);
        let system = LinearSystem::new(a, b, dvector![0.1, 0.2]).unwrap();
        let propagation = Propagation::new(&system, &TimeGrid::uniform(0.01, 300)).unwrap();
        let identity = DMatrix::identity(2, 2);
        let gains = propagation.output_gains(&identity, &identity, &identity);
        let known = Disturbance::Sample.input_gains(&propagation);
        for (k, known) in known.iter().enumerate() {
            let same = |x: &IntervalMatrix, y: &IntervalMatrix| {
                x.iter()
                    .zip(y)
                    .all(|(x, y)| x.intersection(*y).is_some() && x.hull(*y).width() < 1e-12)
            };
            assert!(same(&gains.start[k], &propagation.exponential(k)), "{k}");
            assert!(same(&gains.constant[k], propagation.integral(k)), "{k}");
            assert!(same(&gains.changing[k], known), "{k}");
        }
    }
}
