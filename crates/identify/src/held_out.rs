//! Choice between laws by held-out recordings.

/// Returns whether a law predicts held-out parts better, given the sums of squared residuals of
/// each part without and with it: by more than two standard errors of the mean gain.
///
/// The rule favours the simpler law, since the best of several laws looks better than it is.
pub(crate) fn gains(without: &[f64], with: &[f64]) -> bool {
    let gains: Vec<f64> = without.iter().zip(with).map(|(a, b)| a - b).collect();
    let count = gains.len() as f64;
    let mean = gains.iter().sum::<f64>() / count;
    let variance = gains.iter().map(|gain| (gain - mean).powi(2)).sum::<f64>() / (count - 1.0);
    count >= 3.0 && mean > 0.0 && mean > 2.0 * (variance / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::gains;

    #[test]
    fn a_gain_counts_only_beyond_two_standard_errors() {
        assert!(gains(&[1.0, 1.1, 0.9, 1.0], &[0.8, 0.9, 0.8, 0.7]));
        // One part alone gains, and the others lose a little.
        assert!(!gains(&[1.0, 1.0, 1.0, 4.0], &[1.1, 1.1, 1.1, 2.0]));
        assert!(!gains(&[1.0, 1.0, 1.0], &[1.0, 1.0, 1.0]));
        assert!(!gains(&[1.0, 1.0], &[0.1, 0.1]));
    }
}
