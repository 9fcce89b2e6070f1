//! Sums of doubles without rounding.

/// Number of 64-bit limbs: 2098 bits hold the largest double as a multiple of the smallest one, and
/// the 78 bits above them hold the sign and the carries of more summands than can be counted.
const LIMBS: usize = 34;

/// The exponent of the lowest bit: the smallest double above 0 is 2^-1074.
const LOWEST: i32 = -1074;

/// Bits of the significand of a double.
const PRECISION: usize = 53;

/// A sum of doubles that is exact: a number of fixed point with 2176 bits. It takes summands one by
/// one, and two sums merge into the sum of all. The order makes no difference, not even in the
/// last bit.
///
/// Infinite summands and NaN are counted apart, so that they follow the rules of IEEE 754 whatever
/// the order.
///
/// # Examples
///
/// ```
/// use reachtube_scalar::ExactSum;
///
/// let mut sum: ExactSum = [1e300, 1.0, -1e300].into_iter().collect();
/// assert_eq!(sum.value(), 1.0);
/// sum.merge(&[0.5].into_iter().collect());
/// assert_eq!((sum.count(), sum.value(), sum.mean()), (4, 1.5, 0.375));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExactSum {
    /// The finite summands' sum by 2^-1074, in two's complement, the lowest limb first.
    limbs: [u64; LIMBS],
    count: u64,
    /// Whether there was an infinite summand above and below, and whether there was a NaN.
    special: [bool; 3],
}

impl Default for ExactSum {
    fn default() -> Self {
        Self { limbs: [0; LIMBS], count: 0, special: [false; 3] }
    }
}

impl ExactSum {
    /// Adds a number.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        if !value.is_finite() {
            let kind = if value.is_nan() { 2 } else { usize::from(value < 0.0) };
            self.special[kind] = true;
            return;
        }
        let exponent = (value.to_bits() >> 52 & 0x7ff) as usize;
        let fraction = value.to_bits() & ((1 << 52) - 1);
        // A number that is not normal has the exponent of the smallest normal one.
        let (significand, shift) =
            if exponent == 0 { (fraction, 0) } else { (fraction | 1 << 52, exponent - 1) };
        let wide = u128::from(significand) << (shift % 64);
        let mut added = [0; LIMBS];
        (added[shift / 64], added[shift / 64 + 1]) = (wide as u64, (wide >> 64) as u64);
        if value < 0.0 {
            negate(&mut added);
        }
        add(&mut self.limbs, &added);
    }

    /// Merges the sum of other numbers.
    pub fn merge(&mut self, other: &Self) {
        self.count += other.count;
        add(&mut self.limbs, &other.limbs);
        self.special.iter_mut().zip(other.special).for_each(|(own, other)| *own |= other);
    }

    /// Returns the number of summands.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Returns the sum, rounded to nearest, ties to even; infinite if it is beyond the largest
    /// double.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.divided_by(1)
    }

    /// Returns the sum by the number of summands, rounded to nearest, ties to even; NaN without a
    /// summand.
    #[must_use]
    pub fn mean(&self) -> f64 {
        if self.count == 0 { f64::NAN } else { self.divided_by(self.count) }
    }

    /// Returns the words that [`from_words`](Self::from_words) takes: the summands' number, what
    /// is infinite or NaN, and the limbs of the sum up to where they only repeat the sign. Sums
    /// that are equal have equal words.
    #[must_use]
    pub fn to_words(&self) -> Vec<u64> {
        let [above, below, nan] = self.special.map(u64::from);
        let sign = if self.is_negative() { u64::MAX } else { 0 };
        let length = self.limbs.iter().rposition(|limb| *limb != sign).map_or(0, |last| last + 1);
        let flags = above | below << 1 | nan << 2 | u64::from(self.is_negative()) << 3;
        [self.count, flags].into_iter().chain(self.limbs[..length].iter().copied()).collect()
    }

    /// Returns the sum of these words; `None` if no sum has them.
    #[must_use]
    pub fn from_words(words: &[u64]) -> Option<Self> {
        let (&[count, flags], limbs) = words.split_at_checked(2)? else { return None };
        if limbs.len() > LIMBS || flags > 15 {
            return None;
        }
        let is_negative = flags & 8 != 0;
        let mut sum = Self {
            limbs: [if is_negative { u64::MAX } else { 0 }; LIMBS],
            count,
            special: [1, 2, 4].map(|flag| flags & flag != 0),
        };
        sum.limbs[..limbs.len()].copy_from_slice(limbs);
        (sum.to_words() == words).then_some(sum)
    }

    fn is_negative(&self) -> bool {
        self.limbs[LIMBS - 1] >> 63 == 1
    }

    /// The sum by `divisor`, rounded to nearest.
    fn divided_by(&self, divisor: u64) -> f64 {
        match self.special {
            [false, false, false] => {}
            [true, false, false] => return f64::INFINITY,
            [false, true, false] => return f64::NEG_INFINITY,
            _ => return f64::NAN,
        }
        let mut magnitude = self.limbs;
        if self.is_negative() {
            negate(&mut magnitude);
        }
        let mut remainder = 0;
        for limb in magnitude.iter_mut().rev() {
            let dividend = u128::from(remainder) << 64 | u128::from(*limb);
            *limb = (dividend / u128::from(divisor)) as u64;
            remainder = (dividend % u128::from(divisor)) as u64;
        }
        let size = rounded(&magnitude, remainder, divisor);
        if self.is_negative() { -size } else { size }
    }
}

impl Extend<f64> for ExactSum {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, values: I) {
        values.into_iter().for_each(|value| self.add(value));
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut sum = Self::default();
        sum.extend(values);
        sum
    }
}

/// Returns (q + remainder / divisor) 2^-1074, rounded to nearest, for q of these limbs.
fn rounded(limbs: &[u64; LIMBS], remainder: u64, divisor: u64) -> f64 {
    let length = match limbs.iter().rposition(|limb| *limb != 0) {
        Some(top) => 64 * top + 64 - limbs[top].leading_zeros() as usize,
        None => 0,
    };
    let dropped = length.saturating_sub(PRECISION);
    let bit = |at: usize| limbs[at / 64] >> (at % 64) & 1 == 1;
    let mut significand = (dropped..length).rev().fold(0, |s, at| s << 1 | u64::from(bit(at)));
    let (is_half_or_more, is_more) = match dropped {
        0 => {
            let rest = divisor - remainder;
            (remainder >= rest, remainder > rest)
        }
        _ => {
            let below = remainder > 0 || (0..dropped - 1).any(bit);
            (bit(dropped - 1), bit(dropped - 1) && below)
        }
    };
    if is_more || is_half_or_more && significand % 2 == 1 {
        significand += 1;
    }
    // Both factors are exact, and so is their product unless it is beyond the largest double.
    let (low, high) = (dropped as i32 + LOWEST, 900);
    let power = |exponent: i32| f64::from_bits(((exponent + 1023) as u64) << 52);
    let scaled = significand as f64;
    match low {
        i32::MIN..-1022 => scaled * power(-1022) * power(low + 1022),
        -1022..=900 => scaled * power(low),
        _ => scaled * power(high) * power(low - high),
    }
}

fn add(limbs: &mut [u64; LIMBS], other: &[u64; LIMBS]) {
    let mut carry = false;
    for (limb, other) in limbs.iter_mut().zip(other) {
        let (sum, first) = limb.overflowing_add(*other);
        let (sum, second) = sum.overflowing_add(u64::from(carry));
        (*limb, carry) = (sum, first || second);
    }
}

fn negate(limbs: &mut [u64; LIMBS]) {
    let mut carry = true;
    for limb in limbs {
        (*limb, carry) = (!*limb).overflowing_add(u64::from(carry));
    }
}
