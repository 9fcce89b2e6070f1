/// The right-hand side of ẋ = f(t, x, u) over scalars S, with a state x (n) and an input u (m) that
/// is held over a step.
///
/// Integrators take a field by `&mut`, so that it can keep scratch memory. Each thread needs its
/// own field. Closures are fields.
///
/// # Examples
///
/// ```
/// use reachtube_ode::{RungeKutta4, VectorField};
///
/// // A mass in kg under a force: x = (position in m, velocity in m/s), u = (force in N).
/// struct Mass(f64);
/// impl VectorField<f64> for Mass {
///     fn rate(&mut self, _: f64, x: &[f64], u: &[f64], dx: &mut [f64]) {
///         (dx[0], dx[1]) = (x[1], u[0] / self.0);
///     }
/// }
/// let mut x = [0.0, 0.0];
/// RungeKutta4::new(2).integrate(&mut Mass(2.0), [0.0, 3.0], 1, &mut x, &[4.0]);
/// assert_eq!(x, [9.0, 6.0]);
///
/// // A closure around the field can compute the input from time and state.
/// let mut pushed = Mass(2.0);
/// let mut spring = |t: f64, x: &[f64], _: &[f64], dx: &mut [f64]| {
///     pushed.rate(t, x, &[-8.0 * x[0]], dx);
/// };
/// let mut x = [1.0, 0.0];
/// RungeKutta4::new(2).integrate(&mut spring, [0.0, 1.0], 100, &mut x, &[]);
/// assert!((x[0] - 2.0_f64.cos()).abs() < 1e-7);
/// ```
pub trait VectorField<S> {
    /// Writes ẋ (n, in units of x per s) at time t \[s\], state x (n) and input u (m) into `dx`.
    fn rate(&mut self, t: f64, x: &[S], u: &[S], dx: &mut [S]);
}

impl<S, F: FnMut(f64, &[S], &[S], &mut [S])> VectorField<S> for F {
    fn rate(&mut self, t: f64, x: &[S], u: &[S], dx: &mut [S]) {
        self(t, x, u, dx);
    }
}
