/// Returns the derivative of evenly spaced samples by finite differences.
///
/// Central differences of fourth order are used inside, of second order next to the ends, and
/// one-sided differences at the ends.
#[must_use]
pub(crate) fn derivative(values: &[f64], step: f64) -> Vec<f64> {
    let n = values.len();
    let slope = |k: usize| match k {
        _ if n < 2 => 0.0,
        0 => (values[1] - values[0]) / step,
        k if k == n - 1 => (values[k] - values[k - 1]) / step,
        k if k == 1 || k == n - 2 => (values[k + 1] - values[k - 1]) / (2.0 * step),
        k => {
            (8.0 * (values[k + 1] - values[k - 1]) - (values[k + 2] - values[k - 2]))
                / (12.0 * step)
        }
    };
    (0..n).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartics_have_exact_slopes_inside() {
        let values: Vec<f64> = (0..9).map(|k| (k as f64 * 0.1).powi(4)).collect();
        let slopes = derivative(&values, 0.1);
        (2..7).for_each(|k| assert!((slopes[k] - 4.0 * (k as f64 * 0.1).powi(3)).abs() < 1e-12));
    }
}
