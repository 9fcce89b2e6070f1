use reachtube_scalar::Scalar;

use crate::vector_field::VectorField;

/// The classical Runge-Kutta method of order 4 with fixed steps, over any [`Scalar`] (Kutta, Z.
/// Math. Phys. 46, 1901).
///
/// It does not allocate after construction. Each SIMD lane is a run of its own and equals the same
/// run over `f64`, to the last bit. Over `Interval`, the result encloses the result of the method,
/// not the solution.
///
/// # Examples
///
/// ```
/// use reachtube_ode::RungeKutta4;
///
/// let mut decay = |_: f64, x: &[f64], _: &[f64], dx: &mut [f64]| dx[0] = -x[0];
/// let mut x = [1.0];
/// RungeKutta4::new(1).integrate(&mut decay, [0.0, 1.0], 50, &mut x, &[]);
/// assert!((x[0] - (-1.0_f64).exp()).abs() < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct RungeKutta4<S> {
    /// State at a stage (n).
    stage: Vec<S>,
    /// Slope at a stage (n).
    slope: Vec<S>,
    /// Weighted sum of the slopes (n).
    sum: Vec<S>,
}

impl<S: Scalar> RungeKutta4<S> {
    /// Returns an integrator for states with `dimension` entries.
    pub fn new(dimension: usize) -> Self {
        let zeros = || vec![S::zero(); dimension];
        Self { stage: zeros(), slope: zeros(), sum: zeros() }
    }

    /// Integrates x (n) in place over [t0, t1] \[s\] in equal steps, under a held input u (m).
    ///
    /// It does not check the result: a solution that diverges leaves infinities or NaN in x.
    ///
    /// # Panics
    ///
    /// Panics if the length of x differs from the dimension of the integrator.
    pub fn integrate<F: VectorField<S> + ?Sized>(
        &mut self,
        field: &mut F,
        [t0, t1]: [f64; 2],
        steps: usize,
        x: &mut [S],
        u: &[S],
    ) {
        let h = (t1 - t0) / steps as f64;
        for step in 0..steps {
            self.step(field, t0 + step as f64 * h, h, x, u);
        }
    }

    /// Integrates x (n) in place over one step from t to t + h \[s\], under a held input u (m).
    ///
    /// # Panics
    ///
    /// Panics if the length of x differs from the dimension of the integrator.
    pub(crate) fn step<F: VectorField<S> + ?Sized>(
        &mut self,
        field: &mut F,
        t: f64,
        h: f64,
        x: &mut [S],
        u: &[S],
    ) {
        assert_eq!(
            x.len(),
            self.stage.len(),
            "the number of states differs from the dimension of the integrator"
        );
        field.rate(t, x, u, &mut self.slope);
        self.sum.clone_from_slice(&self.slope);
        // Stages 2 to 4: the fraction of the step along the previous slope, and the weight of the
        // stage.
        for (fraction, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            self.stage.clone_from_slice(x);
            add_scaled(&mut self.stage, fraction * h, &self.slope);
            field.rate(t + fraction * h, &self.stage, u, &mut self.slope);
            add_scaled(&mut self.sum, weight, &self.slope);
        }
        add_scaled(x, h / 6.0, &self.sum);
    }
}

/// Adds k y to x.
pub(crate) fn add_scaled<S: Scalar>(x: &mut [S], k: f64, y: &[S]) {
    x.iter_mut().zip(y).for_each(|(x, y)| *x += S::from(k) * y.clone());
}
