/// Where the influence of a residual stops growing, in robust standard deviations: 95 % of the
/// efficiency of least squares for normal errors (Huber 1964).
const HUBER: f64 = 1.345;

/// The standard deviation of normal errors whose median magnitude is 1.
const NORMAL: f64 = 1.4826;

/// A robust standard deviation: 1.4826 times the median magnitude of the residuals.
pub fn robust_deviation(residuals: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    let middle = sizes.len() / 2;
    if sizes.is_empty() {
        return 0.0;
    }
    NORMAL * *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Root mean square.
pub fn root_mean_square(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// The weight of a row whose residual is so many standard deviations: 1 up to 1.345, then falling
/// so that its pull stays the same.
pub fn huber_weight(residual: f64, deviation: f64) -> f64 {
    let size = residual.abs();
    if size <= HUBER * deviation { 1.0 } else { (HUBER * deviation / size).sqrt() }
}

/// How many samples of a series carry as much as one independent sample: 1 + 2 Σ ρ_k over the
/// autocorrelations ρ_k of its residuals, until two neighbours sum to nothing (Geyer 1992). At
/// least 1.
///
/// `series` are stretches of consecutive residuals.
///
/// # Examples
///
/// ```
/// use reachtube_identify::regression::samples_per_independent_one;
///
/// // Each of 800 numbers without order, ten times.
/// let number = |i: u64| ((7 * i * i * i + 13 * i * i) % 1009) as f64 / 1009.0 - 0.5;
/// let slow: Vec<f64> = (0..8000).map(|k| number(k / 10)).collect();
/// assert!((samples_per_independent_one(&[&slow]) - 10.0).abs() < 1.5);
/// ```
pub fn samples_per_independent_one(series: &[&[f64]]) -> f64 {
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

    #[test]
    fn outliers_do_not_move_the_deviation() {
        let mut residuals: Vec<f64> =
            (0..1000).map(|k| ((k as f64 + 0.5) / 1000.0 - 0.5) * 2.0).collect();
        let before = robust_deviation(&residuals);
        residuals[..50].fill(1e6);
        assert!((robust_deviation(&residuals) / before - 1.0).abs() < 0.12);
        assert_eq!(huber_weight(1.0, 1.0), 1.0);
        assert!(
            (huber_weight(100.0, 1.0).powi(2) * 100.0 - HUBER).abs() < 1e-12,
            "the pull stays the same"
        );
    }

    #[test]
    fn independent_samples_count_each() {
        let mut state = 1u64;
        let mut noise = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let white: Vec<f64> = (0..20_000).map(|_| noise()).collect();
        assert!(samples_per_independent_one(&[&white]) < 1.1);
        // AR(1) with ρ = 0.9: (1 + ρ) / (1 - ρ) = 19.
        let mut last = 0.0;
        let slow: Vec<f64> = white
            .iter()
            .map(|w| {
                last = 0.9 * last + w;
                last
            })
            .collect();
        assert!((samples_per_independent_one(&[&slow]) - 19.0).abs() < 3.0);
    }
}
