//! Even sample times from jittered ones, and derivatives on them.

/// The usual time between samples \[s\]: the median.
pub fn usual_step(times: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Values at the times k · `step` from the first time on, by straight lines between samples;
/// `times` increase.
pub fn resampled(times: &[f64], values: impl Fn(usize) -> f64, step: f64) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else { return Vec::new() };
    let count = ((last - first) / step + 1e-9).floor() as usize + 1;
    let mut after = 1;
    let mut at = |k: usize| {
        let time = first + k as f64 * step;
        while after + 1 < times.len() && times[after] < time {
            after += 1;
        }
        let Some(&next) = times.get(after) else { return values(0) };
        let share = ((time - times[after - 1]) / (next - times[after - 1])).clamp(0.0, 1.0);
        values(after - 1) + share * (values(after) - values(after - 1))
    };
    (0..count).map(&mut at).collect()
}

/// The derivative of evenly spaced samples: central differences of fourth order, of second order
/// beside the ends, one-sided at them.
pub fn derivative(values: &[f64], step: f64) -> Vec<f64> {
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
    fn lines_pass_through_unchanged() {
        let times = [0.0, 0.011, 0.02, 0.032, 0.04];
        let even = resampled(&times, |k| 2.0 + 3.0 * times[k], 0.01);
        assert_eq!(even.len(), 5);
        assert!(even.iter().enumerate().all(|(k, v)| (v - 2.0 - 0.03 * k as f64).abs() < 1e-12));
        assert_eq!(usual_step(&[0.0, 0.01, 0.02, 0.05]), Some(0.01));
    }

    #[test]
    fn quartics_have_exact_slopes_inside() {
        let values: Vec<f64> = (0..9).map(|k| (k as f64 * 0.1).powi(4)).collect();
        let slopes = derivative(&values, 0.1);
        (2..7).for_each(|k| assert!((slopes[k] - 4.0 * (k as f64 * 0.1).powi(3)).abs() < 1e-12));
    }
}
