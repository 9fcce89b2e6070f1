/// Returns the median time between samples \[s\], or `None` for fewer than two samples.
#[must_use]
pub fn median_step(times: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Returns values at evenly spaced times by linear interpolation.
///
/// `times` must increase, and `values` gives the value at each of their indices. The new times are
/// `times[0] + k * step` up to the last of `times`.
pub(crate) fn resampled(times: &[f64], values: impl Fn(usize) -> f64, step: f64) -> Vec<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_pass_through_unchanged() {
        let times = [0.0, 0.011, 0.02, 0.032, 0.04];
        let even = resampled(&times, |k| 2.0 + 3.0 * times[k], 0.01);
        assert_eq!(even.len(), 5);
        assert!(even.iter().enumerate().all(|(k, v)| (v - 2.0 - 0.03 * k as f64).abs() < 1e-12));
        assert_eq!(median_step(&[0.0, 0.01, 0.02, 0.05]), Some(0.01));
    }
}
