//! Powers of the sides of a box.

use reachtube_scalar::Interval;

use super::angles::{sine_defect, versed};

/// The powers of the sides of a box, even ones not negative; for an angle its φ_l, and sin d less its line.
#[derive(Debug, Clone)]
pub(super) struct PowerTable {
    starts: Vec<usize>,
    powers: Vec<Interval>,
    defects: Vec<Interval>,
}

impl PowerTable {
    /// For exponents up to `highest`, one a variable, and at least 1.
    pub fn new(highest: &[u32]) -> Self {
        let mut starts = vec![0];
        for highest in highest {
            starts.push(starts[starts.len() - 1] + (*highest).max(1) as usize);
        }
        let powers = vec![Interval::ZERO; starts[highest.len()]];
        Self { starts, powers, defects: vec![Interval::ZERO; highest.len()] }
    }

    /// Of variable i over `side`.
    pub fn set(&mut self, i: usize, side: Interval) {
        let own = &mut self.powers[self.starts[i]..self.starts[i + 1]];
        own.iter_mut().zip(1..).for_each(|(power, exponent)| *power = side.powi(exponent));
    }

    /// Of angle variable i over `side`, whose sine has a line of that slope, and whose κ that middle.
    pub fn set_angle(&mut self, i: usize, side: Interval, [slope, middle]: [f64; 2]) {
        let (sine, versine) = versed(side);
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
