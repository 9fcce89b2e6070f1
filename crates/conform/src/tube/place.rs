use std::cmp::Ordering;

use crate::sets::InputScale;

/// Where the reachable sets of a linear model's deviation are computed: on a grid, for nominal
/// motions along which U has the same scale. Each strand of a linear model has one.
#[derive(Debug, Clone)]
pub(crate) struct Place {
    pub grid: usize,
    pub scale: InputScale,
    /// The number of cases at this place.
    pub cases: usize,
}

impl Place {
    /// Returns the distinct places of cases, in an order that does not depend on the order of runs.
    pub(crate) fn distinct<'a>(cases: impl Iterator<Item = (usize, &'a InputScale)>) -> Vec<Self> {
        let mut places: Vec<Self> =
            cases.map(|(grid, scale)| Self { grid, scale: scale.clone(), cases: 1 }).collect();
        places.sort_by(|a, b| a.compare(b.grid, &b.scale));
        places.dedup_by(|next, kept| {
            let same = kept.compare(next.grid, &next.scale).is_eq();
            kept.cases += usize::from(same);
            same
        });
        places
    }

    /// Returns the strand of a grid and a scale: the index of their place, or the grid where U is
    /// not scaled.
    pub(crate) fn find(places: &[Self], grid: usize, scale: &InputScale) -> usize {
        let found = places.binary_search_by(|place| place.compare(grid, scale));
        found.unwrap_or(grid)
    }

    /// Returns how this place is ordered beside a place on a grid with a scale.
    fn compare(&self, grid: usize, InputScale(scale): &InputScale) -> Ordering {
        let factors = self.scale.0.iter().zip(scale).map(|(own, other)| own.total_cmp(other));
        self.grid.cmp(&grid).then_with(|| factors.fold(Ordering::Equal, Ordering::then))
    }
}
