//! A parametrisation of the motions within the limits by unconstrained numbers.

use super::fourier::{FourierTrajectory, GRID, grid_excess};
use super::settings::ExcitationSettings;
use crate::robot::Robot;
use core::f64::consts::TAU;

/// Maps unconstrained vectors to motions within the limits.
///
/// For each joint, a vector has one number for the centre of the motion, then a and b of each
/// harmonic. Only the direction of (a, b) matters: the series is scaled until it reaches a limit.
pub(super) struct SearchSpace {
    period: f64,
    harmonics: usize,
    from_rest: bool,
    limits: Vec<MotionLimits>,
    /// Cosine and sine of 2π k / M at each of the M grid points.
    circle: Vec<[f64; 2]>,
}

/// The limits of one joint.
struct MotionLimits {
    /// Middle and half width of the position range \[rad\].
    position: [f64; 2],
    speed: f64,
    acceleration: f64,
}

impl SearchSpace {
    pub(super) fn new(robot: &Robot, settings: &ExcitationSettings) -> Self {
        let limits = robot.joints().iter().enumerate().map(|(i, joint)| {
            let [low, high] = joint.position_limits;
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low) * settings.margin);
            let acceleration = settings.acceleration.get(i).or(settings.acceleration.first());
            MotionLimits {
                position: [middle, half],
                speed: joint.velocity_limit.map_or(settings.speed, |v| v * settings.margin),
                acceleration: acceleration.copied().unwrap_or(f64::INFINITY),
            }
        });
        let points = GRID * settings.harmonics;
        let angle = |k: usize| TAU * k as f64 / points as f64;
        Self {
            period: settings.period,
            harmonics: settings.harmonics,
            from_rest: settings.from_rest,
            limits: limits.collect(),
            circle: (0..points).map(|k| [angle(k).cos(), angle(k).sin()]).collect(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.limits.len() * (1 + 2 * self.harmonics)
    }

    /// Returns the motion of a vector.
    pub(super) fn trajectory(&self, x: &[f64]) -> FourierTrajectory {
        let (mut centre, mut cosine, mut sine) = (Vec::new(), Vec::new(), Vec::new());
        for (x, limits) in x.chunks_exact(1 + 2 * self.harmonics).zip(&self.limits) {
            let (a, b) = x[1..].split_at(self.harmonics);
            let (mut a, mut b) = (a.to_vec(), b.to_vec());
            if self.from_rest {
                project_to_rest(&mut a, &mut b);
            }
            let grid = self.grid(&a, &b);
            let (scale, middle, half) = self.fit(&grid, limits);
            a.iter_mut().chain(&mut b).for_each(|x| *x *= scale);
            centre.push(limits.position[0] + x[0].tanh() * (limits.position[1] - half) - middle);
            cosine.push(a);
            sine.push(b);
        }
        FourierTrajectory { period: self.period, centre, cosine, sine }
    }

    /// Writes the states (q, q̇, q̈) of a motion at the grid points, one entry per grid point.
    pub(super) fn states(&self, motion: &FourierTrajectory, out: &mut [[Vec<f64>; 3]]) {
        for i in 0..self.limits.len() {
            for (state, values) in out.iter_mut().zip(self.grid(&motion.cosine[i], &motion.sine[i]))
            {
                state.iter_mut().zip(values).for_each(|(s, v)| s[i] = v);
                state[0][i] += motion.centre[i];
            }
        }
    }

    pub(super) fn points(&self) -> usize {
        self.circle.len()
    }

    /// Returns position about 0, velocity and acceleration of a series at the grid points.
    fn grid(&self, a: &[f64], b: &[f64]) -> Vec<[f64; 3]> {
        let point = |k: usize| {
            let mut out = [0.0; 3];
            for (l, (a, b)) in a.iter().zip(b).enumerate() {
                let w = TAU * (l + 1) as f64 / self.period;
                let [c, s] = self.circle[(l + 1) * k % self.circle.len()];
                out[0] += (a * s - b * c) / w;
                out[1] += a * c + b * s;
                out[2] += w * (b * c - a * s);
            }
            out
        };
        (0..self.circle.len()).map(point).collect()
    }

    /// Returns the scale at which a motion reaches a limit, and the middle and half width of its
    /// position range at this scale.
    fn fit(&self, grid: &[[f64; 3]], limits: &MotionLimits) -> (f64, f64, f64) {
        let largest = |k: usize| grid.iter().fold(0.0, |m: f64, x| m.max(x[k].abs()));
        let low = grid.iter().fold(f64::INFINITY, |m, x| m.min(x[0]));
        let high = grid.iter().fold(f64::NEG_INFINITY, |m, x| m.max(x[0]));
        let half = 0.5 * (high - low);
        let bounds = [
            (half, limits.position[1]),
            (largest(1), limits.speed),
            (largest(2), limits.acceleration),
        ];
        let scale = bounds
            .iter()
            .fold(f64::INFINITY, |s, (value, bound)| s.min(bound / (value * grid_excess())));
        let scale = if half > 0.0 { scale } else { 0.0 };
        (scale, 0.5 * scale * (low + high), scale * half * grid_excess())
    }
}

/// Projects a series onto the series with velocity Σ a = 0 and acceleration ω Σ l b = 0 at t = 0.
fn project_to_rest(a: &mut [f64], b: &mut [f64]) {
    let n = a.len() as f64;
    let mean = a.iter().sum::<f64>() / n;
    a.iter_mut().for_each(|a| *a -= mean);
    let (mut inner, mut norm) = (0.0, 0.0);
    for (l, b) in (1..).map(f64::from).zip(&*b) {
        inner += l * b;
        norm += l * l;
    }
    (1..).map(f64::from).zip(b).for_each(|(l, b)| *b -= l * inner / norm);
}
