//! The point (x*, u*) about which f is linearised, with the factors of its angles.

use reachtube_scalar::Interval;

use crate::polynomial::expansion::angles::{Angles, FACTOR_ROUNDINGS};
use crate::polynomial::expansion::sine_bounds::{sine_slope, versine_middle};

/// Smallest bound of a variable, so that bounds rarely have to grow.
const LEAST_BOUND: f64 = 1e-3;

/// The expansion point and everything that recentring a polynomial there needs.
#[derive(Debug)]
pub(crate) struct RecentringPoint {
    /// (x*, u*), N + m entries.
    pub coordinates: Vec<f64>,
    /// Approximate distance of (x, u) from the point, N + m entries.
    pub radius: Vec<f64>,
    /// (x*, u*) and the factors of the angles.
    pub factors: Vec<f64>,
    /// Enclosures of the factors of the angles.
    enclosed: Vec<Interval>,
    /// Bounds of the magnitudes of the factors, on which the errors of recentring depend.
    pub bounds: Vec<f64>,
    /// Slope of the line that stands for the sine of each angle.
    pub sine_slopes: Vec<f64>,
    /// Middle of κ = 1 - cos d of each angle.
    pub versine_middles: Vec<f64>,
}

impl RecentringPoint {
    /// Creates the point 0 with N + m `variables`.
    pub(crate) fn new(angles: &Angles, variables: usize) -> Self {
        Self {
            coordinates: vec![0.0; variables],
            radius: vec![0.0; variables],
            factors: vec![0.0; angles.factors().len()],
            enclosed: angles.factors(),
            bounds: angles.magnitudes(),
            sine_slopes: vec![0.0; angles.states.len()],
            versine_middles: vec![0.0; angles.states.len()],
        }
    }

    /// Computes the factors for the present coordinates and radius; returns whether a bound had to
    /// grow.
    ///
    /// The factors of an angle so large that its sine is unknown become NaN.
    pub(crate) fn update_factors(&mut self, angles: &Angles) -> bool {
        let variables = self.coordinates.len();
        self.factors[..variables].copy_from_slice(&self.coordinates);
        for (i, &state) in angles.states.iter().enumerate() {
            self.sine_slopes[i] = sine_slope(self.radius[state]);
            self.versine_middles[i] = versine_middle(self.radius[state]);
            let (q, middle) = (self.coordinates[state], self.versine_middles[i]);
            angles.expand_at(i, q, middle, &mut self.enclosed);
        }
        for (i, factor) in self.enclosed.iter().enumerate().skip(variables) {
            let is_known = factor.rad() <= FACTOR_ROUNDINGS * f64::EPSILON * self.bounds[i];
            self.factors[i] = if is_known { factor.mid() } else { f64::NAN };
        }
        self.grow_bounds()
    }

    fn grow_bounds(&mut self) -> bool {
        let mut has_grown = false;
        for (bound, z) in self.bounds.iter_mut().zip(&self.coordinates) {
            if z.abs() > *bound {
                *bound = (2.0 * z.abs()).max(LEAST_BOUND);
                has_grown = true;
            }
        }
        has_grown
    }
}
