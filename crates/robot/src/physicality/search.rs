//! Search for a position where the mass matrix is not positive definite.

use super::Physicality;
use crate::{Robot, RobotError, Workspace, ltdl};

/// Positions that the search samples before it descends.
const SAMPLES: usize = 20_000;
/// Sweeps over the joints of each descent; the step shrinks from 0.5 rad by 0.7 a sweep to about
/// 1e-4 rad.
const SWEEPS: usize = 24;

impl Robot {
    /// Samples and descends on each joint's pivot.
    pub(super) fn search_pivots(&self) -> Result<Physicality, RobotError> {
        let n = self.joint_count();
        let mut probe = Probe::new(self);
        let mut best = vec![(f64::INFINITY, vec![0.0; n]); n];
        for k in 0..SAMPLES {
            let q = self.spread_position(k);
            let pivots = probe.pivots(&q)?;
            for (best, pivot) in best.iter_mut().zip(pivots) {
                if pivot < best.0 {
                    *best = (pivot, q.clone());
                }
            }
        }
        for (joint, (pivot, q)) in best.iter_mut().enumerate() {
            self.descend(&mut probe, joint, pivot, q)?;
        }
        let joint = (0..n).min_by(|a, b| best[*a].0.total_cmp(&best[*b].0)).unwrap_or(0);
        let (pivot, q) = best.swap_remove(joint);
        Ok(Physicality::Searched { positions: probe.count, joint, pivot, q })
    }

    /// The k-th point of an evenly spread sequence in the position limits: Roberts' generalised
    /// golden ratio.
    fn spread_position(&self, k: usize) -> Vec<f64> {
        let n = self.joint_count() as i32;
        let ratio = (0..60).fold(1.5_f64, |x, _| (1.0 + x).powf(1.0 / f64::from(n + 1)));
        let limits = self.joints.iter().map(|j| j.position_limits);
        limits
            .zip(1..)
            .map(|([low, high], i)| {
                low + (high - low) * ((0.5 + (k as f64) * ratio.powi(-i)) % 1.0)
            })
            .collect()
    }

    fn descend(
        &self,
        probe: &mut Probe,
        joint: usize,
        pivot: &mut f64,
        q: &mut [f64],
    ) -> Result<(), RobotError> {
        let mut step = 0.5;
        for _ in 0..SWEEPS {
            for i in 0..q.len() {
                let here = q[i];
                let [low, high] = self.joints[i].position_limits;
                let mut stay = here;
                for there in [here - step, here + step] {
                    q[i] = there.clamp(low, high);
                    let found = probe.pivots(q)?[joint];
                    if found < *pivot {
                        (*pivot, stay) = (found, q[i]);
                    }
                }
                q[i] = stay;
            }
            step *= 0.7;
        }
        Ok(())
    }
}

/// The pivots at one position after another.
struct Probe<'a> {
    robot: &'a Robot,
    ws: Workspace<f64>,
    m: Vec<f64>,
    pivots: Vec<f64>,
    count: usize,
}

impl<'a> Probe<'a> {
    fn new(robot: &'a Robot) -> Self {
        let n = robot.joint_count();
        Self {
            robot,
            ws: Workspace::new(robot),
            m: vec![0.0; n * n],
            pivots: vec![0.0; n],
            count: 0,
        }
    }

    /// The pivots at q, or the witness where one is not positive.
    fn pivots(&mut self, q: &[f64]) -> Result<Vec<f64>, RobotError> {
        let n = q.len();
        let (sin, cos) = self.robot.sin_cos(q);
        self.robot.crba(&sin, &cos, &mut self.ws, &mut self.m);
        ltdl::factor(&mut self.m, n);
        self.count += 1;
        // Pivots below a non-positive one mean nothing: the factorisation runs from the tip.
        self.pivots.iter_mut().enumerate().for_each(|(i, p)| *p = self.m[i * n + i]);
        match (0..n).rev().find(|i| self.pivots[*i] <= 0.0) {
            None => Ok(self.pivots.clone()),
            Some(joint) => Err(RobotError::NotPhysical {
                robot: self.robot.name().into(),
                joint: self.robot.joints[joint].name.clone(),
                pivot: self.pivots[joint],
                q: q.to_vec(),
            }),
        }
    }
}
