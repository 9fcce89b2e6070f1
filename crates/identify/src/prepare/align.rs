use crate::prepare::log::PreparedLog;

/// Samples that are compared for one shift, at most about this many.
const MAX_COMPARED: usize = 2000;

/// Returns the delay of a run against a reference \[s\]: the shift at which their velocities agree
/// best.
///
/// Both logs must have the same sample time. Shifts of up to half the shorter log are tried, and a
/// parabola through the best shift and its neighbours refines it between samples. The cost of a
/// shift is the mean squared difference of all joints' velocities over the overlap. Unlike a
/// correlation, it does not favour long overlaps.
///
/// The result is `None` if the logs do not overlap.
#[must_use]
pub(crate) fn delay(reference: &PreparedLog, run: &PreparedLog) -> Option<f64> {
    let most = (reference.len().min(run.len()) / 2) as isize;
    let cost = |shift: isize| difference(reference, run, shift);
    let best = (-most..=most).min_by(|a, b| cost(*a).total_cmp(&cost(*b)))?;
    let (before, here, after) = (cost(best - 1), cost(best), cost(best + 1));
    let bend = before - 2.0 * here + after;
    let part = if bend > 0.0 && bend.is_finite() { 0.5 * (before - after) / bend } else { 0.0 };
    here.is_finite().then_some((best as f64 + part.clamp(-0.5, 0.5)) * reference.step)
}

/// Returns the mean squared difference of velocities, infinite without overlap.
fn difference(reference: &PreparedLog, run: &PreparedLog, shift: isize) -> f64 {
    let first = (-shift).max(0) as usize;
    let last = (reference.len() as isize).min(run.len() as isize - shift).max(0) as usize;
    let stride = (last.saturating_sub(first) / MAX_COMPARED).max(1);
    let (mut sum, mut count) = (0.0, 0);
    for k in (first..last).step_by(stride) {
        let pairs = reference.qd(k).iter().zip(run.qd((k as isize + shift) as usize));
        sum += pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        count += 1;
    }
    if count == 0 { f64::INFINITY } else { sum / count as f64 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bump(centre: f64) -> PreparedLog {
        let qd: Vec<f64> =
            (0..400).map(|k| (-((k as f64 * 0.01 - centre) / 0.2).powi(2)).exp()).collect();
        PreparedLog { qd, ..PreparedLog::zeros("bump", 1, 400, 0.01) }
    }

    #[test]
    fn a_delay_is_found_between_samples() {
        let late = delay(&bump(1.5), &bump(1.8133)).unwrap();
        assert!((late - 0.3133).abs() < 2e-4, "{late}");
        let early = delay(&bump(1.5), &bump(1.2)).unwrap();
        assert!((early + 0.3).abs() < 2e-4, "{early}");
    }
}
