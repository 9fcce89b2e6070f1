use std::ops::Range;

/// Returns the intervals of samples in which no joint moves faster than `speed` \[rad/s\].
///
/// `qd` holds velocities \[rad/s\], row-major samples x `joints`. Intervals of fewer than
/// `shortest` samples are omitted.
#[must_use]
pub(crate) fn rest_intervals(
    qd: &[f64],
    joints: usize,
    speed: f64,
    shortest: usize,
) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut start = 0;
    let mut close = |range: Range<usize>| {
        if range.len() >= shortest.max(1) {
            found.push(range);
        }
    };
    for (k, row) in qd.chunks_exact(joints).enumerate() {
        if row.iter().any(|v| v.abs() > speed) {
            close(start..k);
            start = k + 1;
        }
    }
    close(start..qd.len() / joints);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_rests_are_left_out() {
        let qd = [0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.0];
        assert_eq!(rest_intervals(&qd, 1, 0.1, 2), [0..2, 4..7]);
    }
}
