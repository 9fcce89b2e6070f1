//! Periodic motions as Fourier series.

use core::f64::consts::{PI, TAU};

/// Number of grid points per harmonic at which a series is evaluated for its bounds.
pub(super) const GRID: usize = 20;

/// A periodic motion: q_i(t) = c_i + Σ_l (a_il sin(l ω t) - b_il cos(l ω t)) / (l ω) for joint i.
///
/// The velocity is Σ_l a_il cos(l ω t) + b_il sin(l ω t) (Swevers et al., IEEE Trans. Robotics and
/// Automation 13(5), 1997).
#[derive(Clone, Debug, PartialEq)]
pub struct FourierTrajectory {
    /// Period 2π/ω \[s\].
    pub period: f64,
    /// Centres c \[rad\], one per joint.
    pub centre: Vec<f64>,
    /// Amplitudes a of the velocity's cosines \[rad/s\], one row per joint, one entry per harmonic.
    pub cosine: Vec<Vec<f64>>,
    /// Amplitudes b of the velocity's sines \[rad/s\], one row per joint, one entry per harmonic.
    pub sine: Vec<Vec<f64>>,
}

/// One sample of a motion, with one entry per joint.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionSample {
    /// Time \[s\].
    pub t: f64,
    /// Positions \[rad\].
    pub q: Vec<f64>,
    /// Velocities \[rad/s\].
    pub qd: Vec<f64>,
    /// Accelerations \[rad/s²\].
    pub qdd: Vec<f64>,
}

impl FourierTrajectory {
    /// Returns position, velocity and acceleration at a time \[s\].
    fn at(&self, t: f64) -> MotionSample {
        let joints = (0..self.centre.len()).map(|i| self.joint_at(i, t));
        let (mut q, mut qd, mut qdd) = (Vec::new(), Vec::new(), Vec::new());
        joints.for_each(|[p, v, a]| {
            q.push(p);
            qd.push(v);
            qdd.push(a);
        });
        MotionSample { t, q, qd, qdd }
    }

    /// Returns position, velocity and acceleration of joint i.
    fn joint_at(&self, i: usize, t: f64) -> [f64; 3] {
        let mut out = [self.centre[i], 0.0, 0.0];
        for (l, (a, b)) in self.cosine[i].iter().zip(&self.sine[i]).enumerate() {
            let w = TAU * (l + 1) as f64 / self.period;
            let (s, c) = (w * t).sin_cos();
            out[0] += (a * s - b * c) / w;
            out[1] += a * c + b * s;
            out[2] += w * (b * c - a * s);
        }
        out
    }

    /// Samples one period, both ends included, with at least the given rate \[1/s\].
    ///
    /// The samples are computed one by one, as they are taken.
    pub fn samples(&self, rate: f64) -> impl ExactSizeIterator<Item = MotionSample> + '_ {
        let steps = (self.period * rate).ceil().max(1.0) as usize;
        let time = move |k: usize| self.period * k as f64 / steps as f64;
        (0..steps.saturating_add(1)).map(move |k| self.at(time(k)))
    }

    /// Returns bounds of a joint's position at all times \[rad\].
    ///
    /// # Guarantee
    ///
    /// Up to rounding, the bounds are outer bounds of the series. They come from M equidistant
    /// samples of a period. A trigonometric polynomial of degree N exceeds its largest sample by a
    /// factor of at most 1/cos(π N / M) (Ehlich & Zeller 1964), which is 1.013 here.
    pub fn position_range(&self, joint: usize) -> [f64; 2] {
        let (low, high) = self.extremes(joint, 0);
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low) * grid_excess());
        [middle - half, middle + half]
    }

    /// Returns a bound of a joint's speed at all times \[rad/s\], with the guarantee of
    /// `FourierTrajectory::position_range`.
    pub fn speed_bound(&self, joint: usize) -> f64 {
        let (low, high) = self.extremes(joint, 1);
        high.max(-low) * grid_excess()
    }

    /// Returns a bound of the magnitude of a joint's acceleration at all times \[rad/s²\], with the
    /// guarantee of `FourierTrajectory::position_range`.
    pub fn acceleration_bound(&self, joint: usize) -> f64 {
        let (low, high) = self.extremes(joint, 2);
        high.max(-low) * grid_excess()
    }

    /// Returns the extremes on the grid of a joint's position or one of its derivatives.
    fn extremes(&self, joint: usize, derivative: usize) -> (f64, f64) {
        let count = GRID * self.cosine[joint].len().max(1);
        let values = (0..count)
            .map(|k| self.joint_at(joint, self.period * k as f64 / count as f64)[derivative]);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    }
}

/// Returns the factor by which a series can exceed its largest value on the grid.
pub(super) fn grid_excess() -> f64 {
    1.0 / (PI / GRID as f64).cos()
}
