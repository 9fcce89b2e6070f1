//! Search for a position where the mass matrix is not positive definite.

use super::outcome::Physicality;
use crate::error::RobotError;
use crate::ltdl;
use crate::robot::Robot;
use crate::workspace::Workspace;

/// Number of positions that the search samples before the descents.
const SAMPLES: usize = 20_000;
/// Number of sweeps over the joints in each descent. The step shrinks from 0.5 rad (or m) by a
/// factor 0.7 per sweep to about 1e-4 rad.
const SWEEPS: usize = 24;

impl Robot {
    /// Searches for the smallest pivot of each joint by sampling and descent.
    pub(super) fn search_pivots(&self) -> Result<Physicality, RobotError> {
        let n = self.joint_count();
        let mut probe = Probe::new(self);
        // Sampling: the best position for each joint's pivot.
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
        // Descent from each of these positions.
        for (joint, (pivot, q)) in best.iter_mut().enumerate() {
            self.descend(&mut probe, joint, pivot, q)?;
        }
        let joint = (0..n).min_by(|a, b| best[*a].0.total_cmp(&best[*b].0)).unwrap_or(0);
        let (pivot, q) = best.swap_remove(joint);
        Ok(Physicality::Searched { positions: probe.count, joint, pivot, q })
    }

    /// Returns point k of an evenly spread sequence in the position limits (Roberts' sequence, from
    /// the generalised golden ratio).
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

    /// Lowers one joint's pivot by coordinate descent from `q`.
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
                let centre = q[i];
                let [low, high] = self.joints[i].position_limits;
                let mut best = centre;
                for next in [centre - step, centre + step] {
                    q[i] = next.clamp(low, high);
                    let found = probe.pivots(q)?[joint];
                    if found < *pivot {
                        (*pivot, best) = (found, q[i]);
                    }
                }
                q[i] = best;
            }
            step *= 0.7;
        }
        Ok(())
    }
}

/// Evaluates pivots and counts the positions.
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

    /// Returns the pivots at q; the error is a witness if a pivot is not positive.
    fn pivots(&mut self, q: &[f64]) -> Result<Vec<f64>, RobotError> {
        let n = q.len();
        let (sin, cos) = self.robot.sin_cos(q);
        self.robot.crba(&sin, &cos, &mut self.ws, &mut self.m);
        ltdl::factor(&mut self.m, n);
        self.count += 1;
        self.pivots.iter_mut().enumerate().for_each(|(i, p)| *p = self.m[i * n + i]);
        // The factorisation starts at the tip. Pivots nearer the base than a pivot that is not
        // positive have no meaning.
        match (0..n).rev().find(|i| self.pivots[*i] <= 0.0) {
            None => Ok(self.pivots.clone()),
            Some(joint) => Err(RobotError::NotPhysical {
                robot: self.robot.name().into(),
                joint: self.robot.joints[joint].name.clone(),
                kind: self.robot.joints[joint].kind,
                pivot: self.pivots[joint],
                q: q.into(),
                kinds: self.robot.kinds().into(),
            }),
        }
    }
}
