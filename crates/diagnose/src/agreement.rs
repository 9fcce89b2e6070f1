/// A part of the variance below this is rounding: the signal is constant.
const CONSTANT: f64 = 1e-12;

/// How the recorded torques of a joint agree with the ones that a robot needs: sums over samples.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Agreement {
    count: f64,
    /// Sums of the needed and of the recorded torques.
    sums: [f64; 2],
    /// Sums of their squares.
    squares: [f64; 2],
    product: f64,
    /// Sum of the squares of their differences.
    missed: f64,
}

impl Agreement {
    /// Adds a sample.
    pub fn add(&mut self, needed: f64, recorded: f64) {
        let missed = (needed - recorded) * (needed - recorded);
        *self = self.with(&Self {
            count: 1.0,
            sums: [needed, recorded],
            squares: [needed * needed, recorded * recorded],
            product: needed * recorded,
            missed,
        });
    }

    pub(crate) fn with(&self, other: &Self) -> Self {
        let plus = |a: [f64; 2], b: [f64; 2]| [a[0] + b[0], a[1] + b[1]];
        Self {
            count: self.count + other.count,
            sums: plus(self.sums, other.sums),
            squares: plus(self.squares, other.squares),
            product: self.product + other.product,
            missed: self.missed + other.missed,
        }
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

    /// Returns the correlation, from -1 to 1 and 0 if a signal is constant, and the factor of the
    /// needed torques that come nearest to the recorded ones, both about their means.
    #[must_use]
    pub fn follows(&self) -> [f64; 2] {
        let [x, y] = [0, 1].map(|i| {
            let variance = self.squares[i] - self.sums[i] * self.sums[i] / self.count;
            if variance > CONSTANT * self.squares[i] { variance } else { 0.0 }
        });
        let both = self.product - self.sums[0] * self.sums[1] / self.count;
        let by = |size: f64| if size > 0.0 { both / size } else { 0.0 };
        [by((x * y).sqrt()), by(x)]
    }
}

/// Returns the median of some values, the upper of two; `None` if there are none.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
