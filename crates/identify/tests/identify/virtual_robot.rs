//! Simulated recordings of a known robot: torque of an exact model plus white noise.

use rand::RngExt;
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::SeedableRng;
use reachtube_robot::Robot;
use std::fmt::Write;
use std::path::Path;

/// Time between samples \[s\].
pub(crate) const STEP: f64 = 0.004;

/// A generator of random numbers that gives the same numbers on every machine.
pub(crate) struct Random(SplitMix64);

impl Random {
    /// Returns a generator with a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64::seed_from_u64(seed))
    }

    /// Returns a uniform number in 0..1.
    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    /// Returns a standard normal number (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let (u, v) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * u.ln()).sqrt() * (2.0 * std::f64::consts::PI * v).cos()
    }
}

/// One sample of a motion: q \[rad\], q̇ \[rad/s\] and q̈ \[rad/s²\], n entries each.
type State = [Vec<f64>; 3];

/// Returns a motion of all joints, each a sum of three sines with frequencies of its own.
pub(crate) fn excitation(joints: usize, seed: u64) -> impl Fn(f64) -> State {
    let mut random = Random::new(seed);
    let waves: Vec<Vec<[f64; 3]>> = (0..joints)
        .map(|_| {
            (1..=3)
                .map(|k| {
                    [
                        0.35 / k as f64 * (0.5 + random.uniform()),
                        (0.2 + 0.5 * random.uniform()) * k as f64 * 1.5,
                        6.0 * random.uniform(),
                    ]
                })
                .collect()
        })
        .collect();
    let centres: Vec<f64> = (0..joints).map(|_| 2.0 * random.uniform() - 1.0).collect();
    move |t| {
        let sum = |part: &dyn Fn(&[f64; 3]) -> f64| {
            waves.iter().map(|joint| joint.iter().map(part).sum::<f64>()).collect::<Vec<_>>()
        };
        let mut q = sum(&|[a, w, p]| a * (w * t + p).sin());
        q.iter_mut().zip(&centres).for_each(|(q, centre)| *q += centre);
        [
            q,
            sum(&|[a, w, p]| a * w * (w * t + p).cos()),
            sum(&|[a, w, p]| -a * w * w * (w * t + p).sin()),
        ]
    }
}

/// Returns a slow sine of one joint, with the other joints at rest at `pose` \[rad\].
pub(crate) fn slow(joints: usize, moving: usize, pose: f64) -> impl Fn(f64) -> State {
    move |t| {
        let (a, w) = (1.4, 0.55);
        let mut state = [vec![pose; joints], vec![0.0; joints], vec![0.0; joints]];
        state[0][moving] = a * (w * t).sin();
        state[1][moving] = a * w * (w * t).cos();
        state[2][moving] = -a * w * w * (w * t).sin();
        state
    }
}

/// Returns a rest in a pose \[rad\].
pub(crate) fn rest(q: Vec<f64>) -> impl Fn(f64) -> State {
    move |_| [q.clone(), vec![0.0; q.len()], vec![0.0; q.len()]]
}

/// A recorder of simulated motions.
pub(crate) struct Recorder<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Standard deviation of the torque noise \[N m\].
    pub noise: f64,
    /// Factors that multiply the recorded torques, one per joint.
    pub gains: Vec<f64>,
    /// Random numbers of the noise.
    pub random: Random,
}

impl Recorder<'_> {
    /// Records a motion of a duration \[s\] as a CSV file.
    pub(crate) fn record(&mut self, path: &Path, duration: f64, motion: impl Fn(f64) -> State) {
        let n = self.robot.joint_count();
        let columns =
            ["q", "qd", "tau"].map(|c| (1..=n).map(|i| format!(",{c}{i}")).collect::<String>());
        let mut text = format!("t{}\n", columns.concat());
        for k in 0..(duration / STEP) as usize {
            let [q, qd, qdd] = motion(k as f64 * STEP);
            let clean = self.robot.inverse_dynamics(&q, &qd, &qdd)
                + self.robot.viscous_torque(&qd)
                + self.robot.coulomb_torque(&q, &qd);
            let _ = write!(text, "{:.4}", k as f64 * STEP);
            q.iter().chain(&qd).for_each(|x| write!(text, ",{x:.9}").unwrap());
            for (tau, gain) in clean.iter().zip(&self.gains) {
                let _ = write!(text, ",{:.6}", gain * (tau + self.noise * self.random.normal()));
            }
            text.push('\n');
        }
        std::fs::write(path, text).unwrap();
    }
}

/// Changes the rows of a recording: t, q, q̇ and τ, 1 + 3 n entries each.
pub(crate) fn edit(path: &Path, change: impl Fn(&mut Vec<Vec<f64>>)) {
    let text = std::fs::read_to_string(path).unwrap();
    let (header, body) = text.split_once('\n').unwrap();
    let row = |line: &str| line.split(',').map(|value| value.parse().unwrap()).collect();
    let mut rows: Vec<Vec<f64>> = body.lines().map(row).collect();
    change(&mut rows);
    let line = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
    let lines: Vec<String> = rows.iter().map(line).collect();
    std::fs::write(path, format!("{header}\n{}\n", lines.join("\n"))).unwrap();
}
