//! Powers of the sides of a box.

use reachtube_scalar::Interval;

use super::angles::{sine_defect, versed};

/// The powers of the sides of a box, even ones not negative; for an angle its φ_l, and sin d less
/// its line.
#[derive(Debug, Clone)]
pub(super) struct PowerTable {
    starts: Vec<usize>,
    powers: Vec<Interval>,
    defects: Vec<Interval>,
    waists: Vec<Option<f64>>,
}

impl PowerTable {
    /// For exponents up to `highest`, one a variable, and at least 1.
    pub fn new(highest: &[u32]) -> Self {
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

    /// Of variable i over `side`.
    pub fn set(&mut self, i: usize, side: Interval) {
        let own = &mut self.powers[self.starts[i]..self.starts[i + 1]];
        own.iter_mut().zip(1..).for_each(|(power, exponent)| *power = side.powi(exponent));
        self.waists[i] = is_centered(side).then_some(0.5);
    }

    /// Of angle variable i over `side`, whose sine has a line of that slope, and whose κ that
    /// middle.
    pub fn set_angle(&mut self, i: usize, side: Interval, [slope, middle]: [f64; 2]) {
        let (sine, versine) = versed(side);
        self.waists[i] =
            Some(1.0 / (2.0 - versine.hi())).filter(|_| is_centered(side) && side.mag() < 1.5);
        let versine = versine - middle;
        let own = &mut self.powers[self.starts[i]..self.starts[i + 1]];
        for (phi, l) in own.iter_mut().zip(1..) {
            *phi = versine.powi(l / 2) * if l % 2 == 0 { Interval::ONE } else { sine };
        }
        self.defects[i] = sine_defect(side, slope);
    }

    pub fn defect(&self, i: usize) -> Interval {
        self.defects[i]
    }

    /// Variable i to that exponent, or φ of that number.
    pub fn get(&self, i: usize, exponent: u32) -> Interval {
        self.at(self.place(i, exponent))
    }

    /// That at a place.
    pub fn at(&self, place: usize) -> Interval {
        self.powers[place]
    }

    /// Whether that is a variable itself, or φ₁.
    pub fn is_first(&self, place: usize) -> bool {
        self.starts.binary_search(&place).is_ok()
    }

    /// For a variable itself, or σ: where its square is, or κ; and half the width at the bottom of
    /// the trapezoid about both, relative to that at the top. None where the side is not about
    /// zero, or no trapezoid.
    pub fn trapezoid(&self, place: usize) -> Option<(usize, f64)> {
        let i = self.starts.binary_search(&place).ok()?;
        let has_square = *self.starts.get(i + 1)? > place + 1;
        self.waists[i].filter(|_| has_square).map(|waist| (place + 1, waist))
    }

    /// Where it is among all.
    pub fn place(&self, i: usize, exponent: u32) -> usize {
        self.starts[i] + exponent as usize - 1
    }

    /// All of them, one list a variable.
    pub fn lists(&self) -> impl Iterator<Item = (usize, &[Interval])> {
        self.starts.windows(2).map(|ends| (ends[0], &self.powers[ends[0]..ends[1]]))
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.powers.len()
    }
}

/// Whether a side is about zero, nearly.
fn is_centered(side: Interval) -> bool {
    side.hi().min(-side.lo()) >= 0.9 * side.mag()
}
