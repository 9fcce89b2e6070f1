//! Limits of joints.

/// Returns whether a side lies within limits, up to the rounding of its ends.
pub(crate) fn is_within(side: [f64; 2], limits: [f64; 2]) -> bool {
    let slack = 1e-9 * (limits[1] - limits[0]).abs();
    side[0] >= limits[0] - slack && side[1] <= limits[1] + slack
}
