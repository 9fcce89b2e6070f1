//! Numbers of the interactive figures as text: typed arrays in base64, little endian.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// Largest difference of two neighbours, in steps. It leaves room for the rounding of both.
const MOST_STEPS: f64 = 32_000.0;
/// Smallest step, so that a constant line has one.
const LEAST_STEP: f64 = 1e-12;

/// A line of samples: the multiples of `step` above `base`, each stored as its 16-bit difference to
/// the one before.
#[derive(Debug, Clone, Serialize)]
pub(super) struct Packed {
    base: f64,
    step: f64,
    deltas: String,
}

impl Packed {
    /// Packs finite values.
    ///
    /// # Guarantee
    ///
    /// Unpacked values differ from `values` by at most half of [`Self::step`], up to the rounding
    /// of one product and one sum. The differences are of rounded values, so errors do not add up.
    pub(super) fn new(values: &[f64]) -> Self {
        let base = values.first().copied().unwrap_or(0.0);
        let largest =
            values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0_f64, f64::max);
        let step = (largest / MOST_STEPS).max(LEAST_STEP);
        let steps = values.iter().map(|value| ((value - base) / step).round() as i64);
        let mut before = 0;
        let deltas = steps.flat_map(|at| {
            let delta = at - std::mem::replace(&mut before, at);
            (delta as i16).to_le_bytes()
        });
        let deltas = STANDARD.encode(deltas.collect::<Vec<u8>>());
        Self { base, step, deltas }
    }

    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// Returns the values as the page's script reads them.
    pub(super) fn unpacked(&self) -> Vec<f64> {
        let bytes = STANDARD.decode(&self.deltas).unwrap_or_default();
        let deltas = bytes.chunks_exact(2).map(|two| i16::from_le_bytes([two[0], two[1]]));
        let add = |at: &mut i64, delta: i16| {
            *at += i64::from(delta);
            Some(self.base + self.step * *at as f64)
        };
        deltas.scan(0, add).collect()
    }
}

pub(super) fn times(times: &[f64]) -> String {
    STANDARD.encode(times.iter().flat_map(|time| time.to_le_bytes()).collect::<Vec<u8>>())
}

pub(super) fn lower(values: impl Iterator<Item = f64>) -> String {
    singles(values.map(down))
}

pub(super) fn upper(values: impl Iterator<Item = f64>) -> String {
    singles(values.map(|value| -down(-value)))
}

fn singles(values: impl Iterator<Item = f32>) -> String {
    STANDARD.encode(values.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())
}

/// Returns the largest single-precision number that is not above `value`.
fn down(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) > value { nearest.next_down() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn unpacked_values_are_within_half_a_step(
            values in prop::collection::vec(-1e3..1e3_f64, 1..200),
            scale in -9..3_i32,
        ) {
            let values: Vec<f64> = values.iter().map(|x| x * 10f64.powi(scale)).collect();
            let packed = Packed::new(&values);
            let read = packed.unpacked();
            prop_assert_eq!(read.len(), values.len());
            for (read, value) in read.iter().zip(&values) {
                let slack = 1e-15 * (value.abs() + packed.base.abs());
                prop_assert!((read - value).abs() <= 0.5 * packed.step() * 1.000_001 + slack);
            }
        }

        #[test]
        fn bounds_are_rounded_outward(value in -1e6..1e6_f64) {
            let (low, high) = (f64::from(down(value)), -f64::from(down(-value)));
            prop_assert!(low <= value && value <= high);
            prop_assert!(high - low <= 1.3e-7 * value.abs() + 1e-44);
        }
    }

    #[test]
    fn a_constant_line_and_an_empty_one_are_lines() {
        assert_eq!(Packed::new(&[0.25; 4]).unpacked(), [0.25; 4]);
        assert!(Packed::new(&[]).unpacked().is_empty());
    }
}
