//! Logs of a servo with two joints, whose lags, friction and noise are known.

/// Lags of the joints, s.
pub(crate) const LAGS: [f64; 2] = [9e-3, 14e-3];

/// Friction takes this from the position of the first joint, against its speed, rad.
pub(crate) const FRICTION: f64 = 4e-4;

/// Duration of a log, s.
const DURATION: f64 = 6.0;

/// Time between samples, s.
const STEP: f64 = 0.01;

/// The actual positions have an error of up to this, rad.
const NOISE: f64 = 5e-5;

/// The actual positions are as old as stamped up to this, s.
const JITTER: f64 = 1e-3;

/// A command rises and falls for so long, s.
const RISE: f64 = 1.5;

/// Friction is complete well above this speed, rad/s.
const STICKS_BELOW: f64 = 0.02;

/// Samples of the commanded and the actual positions.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Log {
    /// Times, s.
    pub times: Vec<f64>,
    /// Commanded positions, rad.
    pub command: Vec<[f64; 2]>,
    /// Actual positions, rad.
    pub actual: Vec<[f64; 2]>,
}

/// Random numbers by SplitMix64: enough for tests, the same everywhere.
pub(crate) struct Random(pub u64);

impl Random {
    /// Returns a number from `low` to `high`.
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        low + (high - low) * (bits >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A plan of a motion: for each joint, the amplitudes and frequencies of three waves.
pub(crate) struct Plan([[[f64; 2]; 3]; 2]);

impl Plan {
    pub(crate) fn new(number: u64) -> Self {
        let mut random = Random(1000 + number);
        let mut wave = |_| [random.within(0.1, 0.4), random.within(0.5, 2.5)];
        Self([0, 1].map(|_| [0, 1, 2].map(&mut wave)))
    }

    /// Returns the commanded position of a joint, which rests outside the plan's 6 s.
    pub(crate) fn position(&self, joint: usize, time: f64) -> f64 {
        let part = (time.min(DURATION - time) / RISE).clamp(0.0, 1.0);
        let rise = part.powi(3) * (10.0 - 15.0 * part + 6.0 * part * part);
        rise * self.0[joint].iter().map(|[size, rate]| size * (rate * time).sin()).sum::<f64>()
    }

    /// Returns the commanded speed of a joint, from positions 0.1 ms before and after.
    fn speed(&self, joint: usize, time: f64) -> f64 {
        let [before, after] = [-1e-4, 1e-4].map(|shift| self.position(joint, time + shift));
        (after - before) / 2e-4
    }
}

/// Returns the log of a plan.
pub(crate) fn log(number: u64) -> Log {
    let (plan, mut random) = (Plan::new(number), Random(2000 + number));
    let times: Vec<f64> = (0..600).map(|k| STEP * f64::from(k)).collect();
    let command = |time: &f64| [0, 1].map(|joint| plan.position(joint, *time));
    let actual = |time: &f64| {
        let stamped = time + random.within(-JITTER, JITTER);
        let friction = [FRICTION * (plan.speed(0, *time) / STICKS_BELOW).tanh(), 0.0];
        [0, 1].map(|joint| {
            let reached = plan.position(joint, stamped - LAGS[joint]);
            reached - friction[joint] + random.within(-NOISE, NOISE)
        })
    };
    let command = times.iter().map(command).collect();
    let actual = times.iter().map(actual).collect();
    Log { times, command, actual }
}
