use reachtube_scalar::rounding::{add_up, mul_up};

use crate::sets::zonotope::Zonotope;
use crate::upward::{relative_error, round_up_sum};

/// The generators of a zonotope about 0, laid out state by state, with bounds of the errors of
/// their entries.
///
/// The exact zonotope is { Σ_j β_j g_j : |β_j| <= 1 }, where the exact entries of the generators
/// g_j differ from the stored ones by no more than [`set_error`](Self::set_error) allows.
///
/// # Examples
///
/// ```
/// use reachtube_reach::{GeneratorRows, Membership, Place};
///
/// // A diamond in the plane: |x| + |y| <= 2.
/// let mut rows = GeneratorRows::new(2, 2);
/// rows.row_mut(0).copy_from_slice(&[1.0, 1.0]);
/// rows.row_mut(1).copy_from_slice(&[1.0, -1.0]);
/// let diamond = Membership::new(&rows);
/// let mut work = diamond.workspace();
/// assert!(matches!(diamond.locate(&[0.9, 0.9], 1e-9, &mut work), Place::Inside));
/// // (1.5, 1.5) is in the diamond's interval hull, but not in the diamond.
/// let (ratio, direction) = diamond.gauge(&[1.5, 1.5], 1e-9, &mut work).expect("outside");
/// assert!((direction[0] - direction[1]).abs() < 1e-6 && (ratio - 1.5).abs() < 0.03);
/// ```
#[derive(Debug, Clone)]
pub struct GeneratorRows {
    count: usize,
    entries: Vec<f64>,
    errors: Vec<f64>,
}

impl GeneratorRows {
    /// Makes `count` generators of zeros with `dimension` entries each.
    #[must_use]
    pub fn new(dimension: usize, count: usize) -> Self {
        Self { count, entries: vec![0.0; dimension * count], errors: vec![0.0; dimension] }
    }

    /// Takes the entries `states` of the generators of a zonotope, and adds to it a box with the
    /// radii `noise`, one for each of these entries. Exact.
    #[must_use]
    pub fn of_zonotope(zonotope: &Zonotope, states: &[usize], noise: &[f64]) -> Self {
        let given = zonotope.generators().len();
        let sides: Vec<usize> = (0..noise.len()).filter(|i| noise[*i] > 0.0).collect();
        let mut rows = Self::new(states.len(), given + sides.len());
        for (j, generator) in zonotope.generators().enumerate() {
            for (i, &state) in states.iter().enumerate() {
                rows.entries[i * rows.count + j] = generator[state];
            }
        }
        for (j, &i) in sides.iter().enumerate() {
            rows.entries[i * rows.count + given + j] = noise[i];
        }
        rows
    }

    /// Returns the number of entries of a generator.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.errors.len()
    }

    /// Returns the number of generators.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns entry `i` of all generators.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.entries[i * self.count..(i + 1) * self.count]
    }

    /// Returns entry `i` of all generators, to be written.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.entries[i * self.count..(i + 1) * self.count]
    }

    /// Returns a zonotope of fewer generators in this one: of the generators whose indices are the
    /// same modulo `stride`, `held` after each other have one factor in common. It is not much
    /// smaller where those are alike, as images of one vector at times close together are.
    ///
    /// # Guarantee
    ///
    /// Inner: bounds of the errors cover the rounding of the sums.
    #[must_use]
    pub fn merged(&self, stride: usize, held: usize) -> Self {
        let (stride, held) = (stride.max(1), held.max(1));
        let place = |j: usize| j / (stride * held) * stride + j % stride;
        let places = (0..self.count).map(place).max().map_or(0, |last| last + 1);
        let mut rows = Self::new(self.dimension(), places);
        for i in 0..self.dimension() {
            let mut size = 0.0;
            for (j, x) in self.row(i).iter().enumerate() {
                rows.entries[i * rows.count + place(j)] += x;
                size += x.abs();
            }
            let rounding = mul_up(relative_error(held), round_up_sum(size, self.count));
            rows.errors[i] = add_up(self.errors[i], rounding);
        }
        rows
    }

    /// Returns the zonotope of the stored generators about `centre`, for figures.
    #[must_use]
    pub fn zonotope(&self, centre: Vec<f64>) -> Zonotope {
        let generators = (0..self.count)
            .flat_map(|j| (0..self.errors.len()).map(move |i| self.entries[i * self.count + j]));
        Zonotope::new(centre, generators.collect())
    }

    /// Returns how far Σ_j β_j g_j with |β_j| <= 1 may be off in entry `i`, because the entries are
    /// not exact.
    #[must_use]
    pub fn error(&self, i: usize) -> f64 {
        self.errors[i]
    }

    /// Sets a bound of the sum of the errors of entry `i` over all generators.
    pub fn set_error(&mut self, i: usize, error: f64) {
        self.errors[i] = error;
    }
}
