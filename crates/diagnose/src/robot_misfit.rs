use nalgebra::DVector;
use reachtube_recordings::{Run, Torque};
use reachtube_robot::Robot;

use crate::agreement::Agreement;
use crate::axes::input;
use crate::change::Change;

/// Number of samples of each run that are looked at, at most.
const SAMPLES: usize = 300;

/// Runs of fewer samples are no evidence.
const FEWEST: usize = 8;

/// Half the time over which accelerations and torques are averaged, s.
const HALF_WINDOW: f64 = 0.02;

/// Half the time over which a filter is taken to spread the steps of dry friction, s, and the
/// number of samples that stand for it.
const SPREAD: f64 = 0.06;
const SPREAD_SAMPLES: usize = 9;

/// How far the input of a known robot is from the recorded one in some runs.
pub struct RobotMisfit<'a> {
    pub(crate) robot: &'a Robot,
    runs: Vec<Run>,
    /// What the motions need as most hypotheses read them.
    needed: Needed,
}

/// The torques that the recorded motions need.
struct Needed {
    change: Change,
    /// The inputs, and the viscous friction and the torques of the motors' inertia in them, at the
    /// samples that are looked at, for each run.
    runs: Vec<Vec<[Vec<f64>; 3]>>,
}

/// How the inputs of a run agree with the ones that the robot needs, for each joint.
pub(crate) type Misses = Vec<Agreement>;

impl<'a> RobotMisfit<'a> {
    /// Takes runs of a robot; short ones are no evidence.
    #[must_use]
    pub fn new(robot: &'a Robot, mut runs: Vec<Run>) -> Self {
        runs.retain(|run| run.len() >= FEWEST);
        let needed = Needed::new(robot, &runs, Change::none(Torque::Motor, robot.joint_count()));
        Self { robot, runs, needed }
    }

    /// Returns the duration of the longest run, s.
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.runs.iter().map(Run::duration).fold(0.0, f64::max)
    }

    /// Returns the mean of the recorded positions, n, and their largest distance from `origin` in
    /// any joint.
    #[must_use]
    pub fn positions(&self, origin: &[f64]) -> (Vec<f64>, f64) {
        let all = || self.runs.iter().flat_map(|run| (0..run.len()).map(|k| run.q(k)));
        let mut mean = vec![0.0; origin.len()];
        let count = all().count().max(1) as f64;
        all().for_each(|q| mean.iter_mut().zip(q).for_each(|(mean, q)| *mean += q / count));
        let distances = all().flat_map(|q| q.iter().zip(origin).map(|(q, at)| (q - at).abs()));
        (mean, distances.fold(0.0, f64::max))
    }

    /// Returns the part of the input that the motion does not explain: the mean over the joints of
    /// Σ (u - u_m)² by Σ (u² + u_m²), where u is the recorded input and u_m the one that the robot
    /// needs for the recorded motion. It is 0 for equal inputs, about 1 for unrelated ones and 2
    /// for opposite ones. `None` if the runs are too short for it, or too short for the lag.
    #[must_use]
    pub fn unexplained(&self, change: &Change) -> Option<f64> {
        part(&self.misses(change))
    }

    /// Compares the inputs of each run with the ones that the robot needs.
    pub(crate) fn misses(&self, change: &Change) -> Vec<Misses> {
        let is_shared = change.has_motion_of(&self.needed.change);
        let own = (!is_shared).then(|| Needed::new(self.robot, &self.runs, change.clone()));
        let needed = own.as_ref().unwrap_or(&self.needed);
        let of_run = |(run, needed): (&Run, &Vec<[Vec<f64>; 3]>)| {
            let mut sums = vec![Agreement::default(); self.robot.joint_count()];
            let samples = Samples::new(run);
            let lags = change.lags.iter().map(|lag| (lag / samples.step).round() as usize);
            let lags: Vec<usize> = lags.collect();
            let longest = lags.iter().copied().max().unwrap_or(0);
            // A lag that leaves little of a run would be judged by other samples than no lag.
            if longest > run.len() / 4 {
                return sums;
            }
            let is_inside = |k: &usize| k + samples.half + longest < run.len();
            let in_time = samples.places(run).take_while(is_inside);
            for (k, [needed, viscous, motors]) in in_time.zip(needed) {
                let recorded = self.recorded(run, change, k, samples.half, &lags);
                for (joint, sum) in sums.iter_mut().enumerate() {
                    // Friction that is added to both sides distinguishes neither. Behind the gear,
                    // the motors' inertia takes part in neither.
                    let (a, b) = match change.torque {
                        Torque::Link => {
                            let of_links = needed[joint] - viscous[joint] - motors[joint];
                            (of_links, recorded[joint] - viscous[joint])
                        }
                        Torque::Motor | Torque::Compensated => (needed[joint], recorded[joint]),
                    };
                    sum.add(a, b);
                }
            }
            sums
        };
        self.runs.iter().zip(&needed.runs).map(of_run).collect()
    }

    /// Returns the recorded input around sample `k`, n.
    fn recorded(
        &self,
        run: &Run,
        change: &Change,
        k: usize,
        half: usize,
        lags: &[usize],
    ) -> Vec<f64> {
        let mean = |joint: usize| {
            let window = k + lags[joint] - half..k + lags[joint] + half;
            let sum: f64 = window.map(|at| run.torque(at)[change.torque_columns[joint]]).sum();
            change.torque_factors[joint] * sum / (2 * half) as f64
        };
        let torques: Vec<f64> = (0..run.joints).map(mean).collect();
        if change.softened {
            return self.softened_input(run, k, half, &torques);
        }
        let (q, qd) = (change.q(run.q(k)), change.rates(run.qd(k)));
        input(change.torque, self.robot, &q, &qd, &torques)
    }

    /// Returns the motor torques `torques`, the means around sample `k`, less gravity and softened
    /// dry friction.
    fn softened_input(&self, run: &Run, k: usize, half: usize, torques: &[f64]) -> Vec<f64> {
        let step = (run.times[k + half] - run.times[k - half]) / (2 * half) as f64;
        let reach = ((SPREAD / step).round() as usize).min(k).min(run.len() - 1 - k);
        let stride = (2 * reach).div_ceil(SPREAD_SAMPLES).max(1);
        let mut input = torques.to_vec();
        let around: Vec<usize> = (k - reach..=k + reach).step_by(stride).collect();
        for at in &around {
            let tau = run.torque(*at);
            let free = self.robot.input_from_holding_torque(run.q(*at), run.qd(*at), tau);
            let parts = input.iter_mut().zip(tau.iter().zip(&free));
            parts.for_each(|(input, (tau, free))| *input -= (tau - free) / around.len() as f64);
        }
        input
    }
}

/// Returns the part of the input that is not explained in some runs, as
/// [`RobotMisfit::unexplained`].
pub(crate) fn part<'a>(runs: impl IntoIterator<Item = &'a Misses>) -> Option<f64> {
    let mut sums: Misses = Vec::new();
    for run in runs {
        sums.resize(run.len(), Agreement::default());
        sums.iter_mut().zip(run).for_each(|(sum, own)| *sum = sum.with(own));
    }
    let parts: Vec<f64> = sums.iter().filter_map(Agreement::unexplained).collect();
    (!parts.is_empty()).then(|| parts.iter().sum::<f64>() / parts.len() as f64)
}

/// The samples of a run that are looked at.
struct Samples {
    /// Time between samples, s.
    step: f64,
    /// Half the number of samples over which accelerations and torques are averaged.
    half: usize,
    /// Distance of two samples that are looked at.
    stride: usize,
}

impl Samples {
    fn new(run: &Run) -> Self {
        let step = run.times.last().unwrap_or(&0.0) / run.len() as f64;
        let half = ((HALF_WINDOW / step).round() as usize).clamp(1, run.len() / 8 + 1);
        let stride = (run.len().saturating_sub(2 * half) / SAMPLES).max(1);
        Self { step, half, stride }
    }

    fn places(&self, run: &Run) -> impl Iterator<Item = usize> + use<> {
        (self.half..run.len().saturating_sub(self.half)).step_by(self.stride)
    }
}

impl Needed {
    /// Finds what the motions of `runs` need as `change` reads them. The mass matrix at its
    /// `inertia_at`, without Coriolis terms, replaces the robot's where given.
    fn new(robot: &Robot, runs: &[Run], change: Change) -> Self {
        let inertia = change.inertia_at.as_ref().map(|q| robot.mass_matrix(q));
        let of_run = |run: &Run| {
            let samples = Samples::new(run);
            let at = |k: usize| {
                let (q, qd) = (change.q(run.q(k)), change.rates(run.qd(k)));
                let (before, after) = (k - samples.half, k + samples.half);
                let duration = run.times[after] - run.times[before];
                let changes = run.qd(after).iter().zip(run.qd(before));
                let changes: Vec<f64> = changes.map(|(after, before)| after - before).collect();
                let qdd = change.rates(&changes).into_iter().map(|change| change / duration);
                let qdd: Vec<f64> = qdd.collect();
                let motors = robot.joints().iter().zip(&qdd);
                let motors = motors.map(|(joint, qdd)| joint.armature * qdd).collect();
                let moving = match &inertia {
                    Some(inertia) => inertia * DVector::from_vec(qdd),
                    None => robot.motion_torque(&q, &qd, &qdd),
                };
                let viscous = robot.viscous_torque(&qd);
                [(moving + &viscous).data.into(), viscous.data.into(), motors]
            };
            samples.places(run).map(at).collect()
        };
        let runs = runs.iter().map(of_run).collect();
        Self { change, runs }
    }
}
