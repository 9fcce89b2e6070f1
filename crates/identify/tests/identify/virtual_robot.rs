//! Recordings of a robot that is known: torque of an exact model plus white noise.

use rand_like::Random;
use reachtube_robot::Robot;
use std::fmt::Write;
use std::path::Path;

/// Time between samples \[s\].
pub const STEP: f64 = 0.004;

/// A generator of normal numbers that is the same everywhere.
pub mod rand_like {
    /// A linear congruential generator.
    pub struct Random(pub u64);

    impl Random {
        /// Uniform in 0..1.
        pub fn uniform(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }

        /// Standard normal (Box and Muller).
        pub fn normal(&mut self) -> f64 {
            let (u, v) = (1.0 - self.uniform(), self.uniform());
            (-2.0 * u.ln()).sqrt() * (2.0 * std::f64::consts::PI * v).cos()
        }
    }
}

/// One sample of a motion: q, q̇, q̈.
type State = [Vec<f64>; 3];

/// A sum of sines a joint: all joints move, each with three frequencies of its own.
pub fn excitation(joints: usize, seed: u64) -> impl Fn(f64) -> State {
    let mut random = Random(seed);
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

/// One joint on a slow wide sine, the others at rest in a pose.
pub fn slow(joints: usize, moving: usize, pose: f64) -> impl Fn(f64) -> State {
    move |t| {
        let (a, w) = (1.4, 0.55);
        let mut state = [vec![pose; joints], vec![0.0; joints], vec![0.0; joints]];
        state[0][moving] = a * (w * t).sin();
        state[1][moving] = a * w * (w * t).cos();
        state[2][moving] = -a * w * w * (w * t).sin();
        state
    }
}

/// A pose at rest.
pub fn rest(q: Vec<f64>) -> impl Fn(f64) -> State {
    move |_| [q.clone(), vec![0.0; q.len()], vec![0.0; q.len()]]
}

/// How a recording differs from the robot.
pub struct Recorder<'a> {
    /// The robot.
    pub robot: &'a Robot,
    /// Standard deviation of the torque's noise \[N m\].
    pub noise: f64,
    /// What each recorded torque is multiplied with.
    pub gains: Vec<f64>,
    /// Its random numbers.
    pub random: Random,
}

impl Recorder<'_> {
    /// Records a motion as CSV.
    pub fn record(&mut self, path: &Path, duration: f64, motion: impl Fn(f64) -> State) {
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
