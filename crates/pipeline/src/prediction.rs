//! Prediction bound for the next of several motions.

/// Quantiles of Student's distribution at 0.95, by its degrees of freedom from 1.
const STUDENT: [f64; 30] = [
    6.314, 2.920, 2.353, 2.132, 2.015, 1.943, 1.895, 1.860, 1.833, 1.812, 1.796, 1.782, 1.771,
    1.761, 1.753, 1.746, 1.740, 1.734, 1.729, 1.725, 1.721, 1.717, 1.714, 1.711, 1.708, 1.706,
    1.703, 1.701, 1.699, 1.697,
];

/// Returns the upper prediction bound of 95 % for one more value, as if all came from one normal
/// distribution, and at least the largest value: m + t s √(1 + 1/n), with the quantile t of
/// Student's distribution with n - 1 degrees of freedom. It guides a choice and proves nothing.
/// One value has no spread and is its own bound.
pub(crate) fn upper_bound(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let largest = values.iter().copied().fold(0.0, f64::max);
    if values.len() < 2 {
        return largest;
    }
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let deviation = (squares / (count - 1.0)).sqrt();
    let t = STUDENT[(values.len() - 2).min(STUDENT.len() - 1)];
    largest.max(mean + t * deviation * (1.0 + 1.0 / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_is_the_one_of_textbooks_and_covers_all_values() {
        // Mean 2, deviation 1, t of 2 degrees of freedom 2.920: 2 + 2.920 sqrt(4/3).
        assert!((upper_bound(&[1.0, 2.0, 3.0]) - 5.3717).abs() < 1e-3);
        assert_eq!(upper_bound(&[0.7; 5]), 0.7);
        assert_eq!((upper_bound(&[]), upper_bound(&[0.3])), (0.0, 0.3));
        let many: Vec<f64> = (0..60).map(|k| if k == 7 { 9.0 } else { 0.0 }).collect();
        assert_eq!(upper_bound(&many), 9.0);
    }
}
