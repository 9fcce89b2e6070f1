/// Huber's limit for independent errors: the influence of a residual stops growing at this many
/// standard deviations.
///
/// The value has 95 % of the efficiency of least squares for normal errors (Huber 1964).
pub(crate) const HUBER_DEVIATIONS: f64 = 1.345;

/// Standard deviation of normal errors whose median magnitude is 1.
const DEVIATION_PER_MEDIAN: f64 = 1.4826;

/// Returns a robust standard deviation: 1.4826 times the median magnitude of the residuals.
#[must_use]
pub(crate) fn robust_standard_deviation(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return 0.0;
    }
    DEVIATION_PER_MEDIAN * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Returns the root mean square of values, and 0 for no values.
pub(crate) fn root_mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// Returns the factor that multiplies a row in a robust fit: the square root of Huber's weight.
///
/// The factor is 1 for residuals of up to `limit`. Beyond, the squared factor times the residual
/// stays constant, so that an outlier's influence is bounded.
#[must_use]
pub(crate) fn huber_row_factor(residual: f64, limit: f64) -> f64 {
    let size = residual.abs();
    if size <= limit { 1.0 } else { (limit / size).sqrt() }
}

/// Returns the integrated autocorrelation time of residuals, in samples and at least 1.
///
/// This number of consecutive samples carries as much information as one independent sample. The
/// value is 1 + 2 Σ ρ_k over the autocorrelations ρ_k. The sum stops at the first pair of
/// consecutive lags whose sum is not positive (initial positive sequence, Geyer 1992).
///
/// Each entry of `series` is a stretch of consecutive residuals.
pub(crate) fn autocorrelation_time(series: &[&[f64]]) -> f64 {
    let longest = series.iter().map(|s| s.len()).max().unwrap_or(0);
    let correlation = |lag: usize| -> f64 {
        series
            .iter()
            .map(|s| s.iter().zip(s.iter().skip(lag)).map(|(a, b)| a * b).sum::<f64>())
            .sum()
    };
    let variance = correlation(0);
    if variance <= 0.0 {
        return 1.0;
    }
    let mut sum = 1.0;
    for lag in (1..longest.saturating_sub(1) / 2).step_by(2) {
        let pair = (correlation(lag) + correlation(lag + 1)) / variance;
        if pair <= 0.0 {
            break;
        }
        sum += 2.0 * pair;
    }
    sum.max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;
    use rand_xoshiro::SplitMix64;
    use rand_xoshiro::rand_core::SeedableRng;

    #[test]
    fn outliers_hardly_change_the_deviation() {
        let mut residuals: Vec<f64> =
            (0..1000).map(|k| ((k as f64 + 0.5) / 1000.0 - 0.5) * 2.0).collect();
        let before = robust_standard_deviation(&residuals);
        residuals[..50].fill(1e6);
        assert!((robust_standard_deviation(&residuals) / before - 1.0).abs() < 0.12);
        assert_eq!(huber_row_factor(1.0, 1.0), 1.0);
        assert!(
            (huber_row_factor(100.0, 1.3).powi(2) * 100.0 - 1.3).abs() < 1e-12,
            "the influence of an outlier must stay the same"
        );
    }

    #[test]
    fn autocorrelation_time_of_white_and_ar1_noise() {
        let mut random = SplitMix64::seed_from_u64(1);
        let white: Vec<f64> = (0..20_000).map(|_| random.random::<f64>() - 0.5).collect();
        assert!(autocorrelation_time(&[&white]) < 1.1);
        // AR(1) with ρ = 0.9: (1 + ρ) / (1 - ρ) = 19.
        let mut last = 0.0;
        let correlated: Vec<f64> = white
            .iter()
            .map(|w| {
                last = 0.9 * last + w;
                last
            })
            .collect();
        assert!((autocorrelation_time(&[&correlated]) - 19.0).abs() < 3.0);
    }

    #[test]
    fn repeated_numbers_count_once() {
        // 800 scattered numbers, each repeated ten times.
        let number = |i: u64| ((7 * i * i * i + 13 * i * i) % 1009) as f64 / 1009.0 - 0.5;
        let slow: Vec<f64> = (0..8000).map(|k| number(k / 10)).collect();
        assert!((autocorrelation_time(&[&slow]) - 10.0).abs() < 1.5);
    }
}
