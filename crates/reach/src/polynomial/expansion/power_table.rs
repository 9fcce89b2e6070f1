//! Powers of the sides of a box.

use reachtube_scalar::Interval;

use crate::polynomial::expansion::sine_bounds::{sine_and_versine, sine_defect};

/// The powers of the sides of a box, one list per variable.
///
/// Even powers are not negative. The list of an angle holds its φ_l (see
/// [`angles`](crate::polynomial::expansion::angles)); its sine defect, sin d minus a line, is
/// stored beside it.
#[derive(Debug, Clone)]
pub(crate) struct PowerTable {
    /// Index of the first power of each variable.
    starts: Vec<usize>,
    powers: Vec<Interval>,
    defects: Vec<Interval>,
    /// Relative half-width of the trapezoid at its bottom, see [`trapezoid`](Self::trapezoid).
    waists: Vec<Option<f64>>,
}

impl PowerTable {
    /// Allocates exponents from 1 up to `highest`, one entry per variable; each variable has at
    /// least the exponent 1.
    pub(crate) fn new(highest: &[u32]) -> Self {
        let mut starts = vec![0];
        for highest in highest {
            starts.push(starts[starts.len() - 1] + (*highest).max(1) as usize);
        }
        let powers = vec![Interval::ZERO; starts[highest.len()]];
        Self {
            starts,
            powers,
            defects: vec![Interval::ZERO; highest.len()],
            waists: vec![None; highest.len()],
        }
    }

    /// Sets the powers of variable i over `side`.
    pub(crate) fn set(&mut self, i: usize, side: Interval) {
        let own = &mut self.powers[self.starts[i]..self.starts[i + 1]];
        own.iter_mut().zip(1..).for_each(|(power, exponent)| *power = side.powi(exponent));
        self.waists[i] = is_nearly_symmetric(side).then_some(0.5);
    }

    /// Sets the φ_l of angle variable i over `side`, for a line of the given slope and the given
    /// middle of κ.
    pub(crate) fn set_angle(&mut self, i: usize, side: Interval, [slope, middle]: [f64; 2]) {
        let (sine, versine) = sine_and_versine(side);
        self.waists[i] = Some(1.0 / (2.0 - versine.hi()))
            .filter(|_| is_nearly_symmetric(side) && side.mag() < 1.5);
        let versine = versine - middle;
        let own = &mut self.powers[self.starts[i]..self.starts[i + 1]];
        for (phi, l) in own.iter_mut().zip(1..) {
            *phi = versine.powi(l / 2) * if l % 2 == 0 { Interval::ONE } else { sine };
        }
        self.defects[i] = sine_defect(side, slope);
    }

    /// Returns sin d minus its line for angle variable i.
    pub(crate) fn defect(&self, i: usize) -> Interval {
        self.defects[i]
    }

    /// Returns variable i to an exponent, or φ of that index.
    pub(crate) fn get(&self, i: usize, exponent: u32) -> Interval {
        self.at(self.index(i, exponent))
    }

    /// Returns the power stored at an index.
    pub(crate) fn at(&self, index: usize) -> Interval {
        self.powers[index]
    }

    /// Returns whether the power at an index is a variable itself, or φ₁.
    pub(crate) fn is_first(&self, index: usize) -> bool {
        self.starts.binary_search(&index).is_ok()
    }

    /// Returns the trapezoid around a variable and its square, or around σ and κ.
    ///
    /// The result is the index of the square (or of κ - m) and the half-width of the trapezoid at
    /// the bottom relative to the top. It is `None` if the side is not nearly symmetric about zero,
    /// where the trapezoid does not exist, or where `index` does not belong to a first power.
    pub(crate) fn trapezoid(&self, index: usize) -> Option<(usize, f64)> {
        let i = self.starts.binary_search(&index).ok()?;
        let has_square = *self.starts.get(i + 1)? > index + 1;
        self.waists[i].filter(|_| has_square).map(|waist| (index + 1, waist))
    }

    /// Returns the index of variable i to an exponent among all powers.
    pub(crate) fn index(&self, i: usize, exponent: u32) -> usize {
        self.starts[i] + exponent as usize - 1
    }

    /// Iterates over the lists of powers, one per variable, with the index of their first entry.
    pub(crate) fn lists(&self) -> impl Iterator<Item = (usize, &[Interval])> {
        self.starts.windows(2).map(|ends| (ends[0], &self.powers[ends[0]..ends[1]]))
    }

    /// Returns the number of powers of all variables.
    pub(crate) fn len(&self) -> usize {
        self.powers.len()
    }
}

/// Returns whether a side is nearly symmetric about zero.
fn is_nearly_symmetric(side: Interval) -> bool {
    side.hi().min(-side.lo()) >= 0.9 * side.mag()
}
