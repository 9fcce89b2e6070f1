//! How far the cost of some sets may be above the least.

/// Relative gap above which sets are not called the smallest.
pub(crate) const LARGEST_GAP: f64 = 1e-6;

/// Relative gap above which sets for the points themselves, and not only their hull, are not called
/// the smallest: cutting planes end below it.
pub(crate) const LARGEST_GAP_OF_POINTS: f64 = 1e-4;

/// Returns how far `cost` may be above the least cost, relative to the `lower_bound` of the
/// program. Costs that differ by less than `negligible` are equal: sets of rounding only have no
/// meaningful bound. A cost below the bound is no better than one above it: either the bound is
/// wrong by as much, or the sets break a limit of the program.
pub(crate) fn optimality_gap(cost: f64, lower_bound: f64, negligible: f64) -> f64 {
    let apart = (cost - lower_bound).abs();
    if apart <= negligible { 0.0 } else { apart / lower_bound.max(negligible) }
}

#[cfg(test)]
mod tests {
    use super::optimality_gap;

    #[test]
    fn the_gap_counts_from_the_bound_and_has_no_upper_limit() {
        assert_eq!(optimality_gap(30.0, 1.0, 1e-9), 29.0);
        assert_eq!(optimality_gap(2.0, 2.0 + 1e-12, 1e-9), 0.0);
        assert_eq!(optimality_gap(1.5, 2.0, 1e-9), 0.25);
        assert!(optimality_gap(1e-12, -1e-13, 1e-9) < 1.0);
    }
}
