/// How the recorded torques of a joint agree with the ones that a robot needs: sums over samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Agreement {
    /// Sums of the squares of the needed and of the recorded torques.
    squares: [f64; 2],
    /// Sum of the squares of their differences.
    missed: f64,
}

impl Agreement {
    /// Adds a sample.
    pub fn add(&mut self, needed: f64, recorded: f64) {
        let missed = (needed - recorded) * (needed - recorded);
        *self = self.with(&Self { squares: [needed * needed, recorded * recorded], missed });
    }

    pub(crate) fn with(&self, other: &Self) -> Self {
        let plus = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self { squares: plus(self.squares, other.squares), missed: self.missed + other.missed }
    }

    /// Returns Σ (u - u_m)² by Σ (u² + u_m²); `None` if all torques are 0.
    pub(crate) fn unexplained(&self) -> Option<f64> {
        let size = self.squares[0] + self.squares[1];
        (size > 0.0).then(|| self.missed / size)
    }

    /// Returns the ratio of the root mean squares, recorded by needed; `None` if none are needed.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        (self.squares[0] > 0.0).then(|| (self.squares[1] / self.squares[0]).sqrt())
    }
}

/// Returns the median of some values, the upper of two; `None` if there are none.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
