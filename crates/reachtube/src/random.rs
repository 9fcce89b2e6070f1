//! Numbers that look random and depend on a seed alone.

/// SplitMix64 (Steele, Lea & Flood, OOPSLA 2014): a counter through a mixing function. Not for
/// secrets.
pub(crate) struct SplitMix64(u64);

impl SplitMix64 {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in [low, high): the 53 upper bits, which an f64 holds exactly.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.next() >> 63 == 0 { 1.0 } else { -1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of seed 1234567 as Rosetta Code gives them (Pseudo-random
    /// numbers/Splitmix64).
    #[test]
    fn it_is_splitmix64() {
        let mut random = SplitMix64::new(1_234_567);
        let published =
            [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!(published, [random.next(), random.next(), random.next()]);
    }

    #[test]
    fn uniform_fills_its_range_and_stays_in_it() {
        let mut random = SplitMix64::new(5);
        let drawn: Vec<f64> = (0..10_000).map(|_| random.uniform(-2.0, 3.0)).collect();
        assert!(drawn.iter().all(|x| (-2.0..3.0).contains(x)));
        assert!((drawn.iter().sum::<f64>() / 1e4 - 0.5).abs() < 0.05);
        assert!(drawn.iter().any(|x| *x < -1.99) && drawn.iter().any(|x| *x > 2.99));
    }
}
