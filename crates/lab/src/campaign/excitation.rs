//! Exciting motions: random Fourier series that start at rest.

use reachtube_robot::Robot;

use crate::motion::{Motion, Planned, SAMPLE_TIME};
use crate::random::{SplitMix64, uniform};

/// Duration of a motion \[s\]: two periods.
pub(super) const DURATION: f64 = 20.0;

/// Period of the series \[s\].
const PERIOD: f64 = 10.0;

/// Number of harmonics.
const HARMONICS: usize = 5;

/// Time over which the motion grows from rest \[s\].
const RAMP: f64 = 1.0;

/// Largest speed over the joint's limit, while the motion does not grow \[-\].
const SPEED_RATIO: f64 = 0.8;

/// Largest speed of joints without a limit \[rad/s\].
const USUAL_SPEED: f64 = 1.0;

/// One harmonic of one joint: amplitude \[rad\], angular frequency \[rad/s\] and phase \[rad\].
type Harmonic = [f64; 3];

/// An exciting motion: q = centre + w(t) Σ a sin(ω t + φ), where w grows from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ExcitingMotion {
    /// Positions at the start \[rad\], n.
    pub centre: Vec<f64>,
    harmonics: Vec<[Harmonic; HARMONICS]>,
}

impl ExcitingMotion {
    /// Draws centres, amplitudes and phases, and scales each joint to its speed and range.
    pub(super) fn random(robot: &Robot, random: &mut SplitMix64) -> Self {
        let (mut centre, mut harmonics) = (Vec::new(), Vec::new());
        for joint in robot.joints() {
            let mut drawn: [Harmonic; HARMONICS] = std::array::from_fn(|l| {
                let frequency = (l + 1) as f64 * std::f64::consts::TAU / PERIOD;
                let speed = uniform(random, 0.2, 1.0);
                [speed / frequency, frequency, uniform(random, 0.0, std::f64::consts::TAU)]
            });
            let [distance, speed] = extent(&drawn);
            let [low, high] = joint.position_limits;
            let reach = Motion::half_range([low, high]);
            let limit = SPEED_RATIO * joint.velocity_limit.unwrap_or(USUAL_SPEED);
            let scale = (limit / speed).min(reach / distance);
            drawn.iter_mut().for_each(|[amplitude, ..]| *amplitude *= scale);
            harmonics.push(drawn);
            centre.push(0.5 * (low + high) + uniform(random, -0.5, 0.5) * reach);
        }
        Self { centre, harmonics }
    }

    pub(super) fn cycles() -> usize {
        (DURATION / SAMPLE_TIME).round() as usize + 1
    }

    pub(super) fn at(&self, t: f64) -> Planned {
        let [w, rate, bend] = ramp(t);
        let (mut q, mut qd, mut qdd) = (Vec::new(), Vec::new(), Vec::new());
        for (centre, harmonics) in self.centre.iter().zip(&self.harmonics) {
            let [x, v, a] = series(harmonics, t);
            q.push(centre + w * x);
            qd.push(rate * x + w * v);
            qdd.push(bend * x + 2.0 * rate * v + w * a);
        }
        Planned { q, qd, qdd }
    }
}

fn ramp(t: f64) -> [f64; 3] {
    let grow = Motion { start: vec![0.0], travel: vec![1.0], duration: RAMP };
    let Planned { q, qd, qdd } = grow.at(t);
    [q[0], qd[0], qdd[0]]
}

fn series(harmonics: &[Harmonic], t: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    for [amplitude, frequency, phase] in harmonics {
        let (sin, cos) = libm::sincos(frequency * t + phase);
        sums[0] += amplitude * sin;
        sums[1] += amplitude * frequency * cos;
        sums[2] -= amplitude * frequency * frequency * sin;
    }
    sums
}

/// Returns the largest distance \[rad\] and speed \[rad/s\] on a grid over a period.
fn extent(harmonics: &[Harmonic]) -> [f64; 2] {
    let grid = (0..20 * HARMONICS).map(|k| PERIOD * k as f64 / (20 * HARMONICS) as f64);
    let sizes = grid.map(|t| series(harmonics, t));
    sizes.fold([0.0; 2], |[x, v], size| [size[0].abs().max(x), size[1].abs().max(v)])
}
