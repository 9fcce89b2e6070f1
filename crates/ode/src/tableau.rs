//! The coefficients of the method of Dormand and Prince.

/// Times of the stages, as fractions of the step.
pub(crate) const NODES: [f64; 7] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];

/// Stage coefficients: row i holds the weights of the earlier slopes in stage i. The last row gives
/// the solution of order 5.
pub(crate) const STAGES: [[f64; 6]; 7] = [
    [0.0; 6],
    [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Error weights: the solution of order 5 minus the solution of order 4.
pub(crate) const ERROR_WEIGHTS: [f64; 7] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// Returns Σ_j weights_j · slopes_j of entry i of the state.
pub(crate) fn weighted_sum(weights: &[f64; 7], slopes: &[Vec<f64>; 7], i: usize) -> f64 {
    weights.iter().zip(slopes).map(|(weight, slope)| weight * slope[i]).sum()
}
