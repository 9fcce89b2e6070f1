//! Proof that the mass matrix is positive definite over the position limits, by branch and bound.

use crate::{Robot, Workspace, ltdl};
use reachtube_scalar::Interval;

/// A joint's interval \[rad\] that is not halved further.
const LEAST_WIDTH: f64 = 1e-6;

/// A box of positions with the sines and cosines in it.
#[derive(Clone)]
struct PositionBox {
    q: Vec<Interval>,
    sin: Vec<Interval>,
    cos: Vec<Interval>,
}

impl PositionBox {
    fn set(&mut self, joint: usize, q: Interval) {
        self.q[joint] = q;
        (self.sin[joint], self.cos[joint]) = q.sin_cos();
    }

    fn halves(&self, joint: usize) -> [Self; 2] {
        let q = self.q[joint];
        [self.part(joint, q.lo(), q.mid()), self.part(joint, q.mid(), q.hi())]
    }

    /// The part with one joint between two values.
    fn part(&self, joint: usize, low: f64, high: f64) -> Self {
        let mut part = self.clone();
        part.set(joint, Interval::new(low, high).unwrap_or(self.q[joint]));
        part
    }
}

impl Robot {
    /// Tries to prove that M_m(q) is positive definite at every position within the limits, where
    /// the links alone do not show it ([`Robot::check_physical`]), as for base parameters.
    ///
    /// Branch and bound: interval arithmetic over boxes of positions, halved where they are too
    /// wide. Gives the number of boxes, or `None` where more than `most_boxes` would be needed,
    /// which says nothing about M. The LWA 4P takes about 45,000 boxes and 2 s.
    ///
    /// # Guarantee
    ///
    /// A number is a proof for the robot's constants as loaded, under outward rounding.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let pendulum = Robot::from_toml(include_str!("../../examples/double_pendulum.toml"), "double pendulum").unwrap();
    /// assert!(pendulum.prove_positive_definite(1000).is_some());
    /// ```
    pub fn prove_positive_definite(&self, most_boxes: usize) -> Option<usize> {
        let mut cover = Cover::new(self);
        let mut open = vec![self.position_limits_box()];
        let mut closed = 0;
        while let Some(positions) = open.pop() {
            if cover.slack(&positions) > 0.0 {
                closed += 1;
                continue;
            }
            if closed + open.len() >= most_boxes {
                return None;
            }
            match cover.best_splits(&positions)[..] {
                [first, second] => {
                    open.extend(positions.halves(first).iter().flat_map(|h| h.halves(second)))
                }
                [only] => open.extend(positions.halves(only)),
                _ => return None,
            }
        }
        Some(closed)
    }

    fn position_limits_box(&self) -> PositionBox {
        let limits = self.joints.iter().map(|j| j.position_limits);
        let q: Vec<_> =
            limits.map(|[low, high]| Interval::point(low).hull(Interval::point(high))).collect();
        let (sin, cos) = q.iter().map(|q| q.sin_cos()).unzip();
        PositionBox { q, sin, cos }
    }
}

/// Positive definiteness of M over boxes of positions.
struct Cover<'a> {
    robot: &'a Robot,
    ws: Workspace<Interval>,
    probe: Workspace<f64>,
    m: Vec<Interval>,
    /// W M.
    half: Vec<Interval>,
    middle: Vec<f64>,
    w: Vec<f64>,
}

impl<'a> Cover<'a> {
    fn new(robot: &'a Robot) -> Self {
        let n = robot.joint_count();
        Self {
            robot,
            ws: Workspace::new(robot),
            probe: Workspace::new(robot),
            m: vec![Interval::ZERO; n * n],
            half: vec![Interval::ZERO; n * n],
            middle: vec![0.0; n * n],
            w: vec![0.0; n * n],
        }
    }

    /// Positive only where every M(q) of the box is positive definite.
    ///
    /// With M(mid) ≈ Lᵀ D L, the matrix W M Wᵀ for W = D^(-1/2) L^(-T) is near 1; M is positive
    /// definite if W M Wᵀ is diagonally dominant (Gershgorin), whatever the error of W.
    fn slack(&mut self, positions: &PositionBox) -> f64 {
        let n = positions.q.len();
        self.robot.crba(&positions.sin, &positions.cos, &mut self.ws, &mut self.m);
        let (sin, cos): (Vec<_>, Vec<_>) = positions.q.iter().map(|q| q.mid().sin_cos()).unzip();
        self.robot.crba(&sin, &cos, &mut self.probe, &mut self.middle);
        ltdl::factor(&mut self.middle, n);
        if !whitening(&self.middle, &mut self.w, n) {
            return f64::NEG_INFINITY;
        }
        for i in 0..n {
            for j in 0..n {
                self.half[i * n + j] =
                    product(&self.w[i * n + i..(i + 1) * n], &self.m[j * n + i..]);
            }
        }
        (0..n).map(|i| self.dominance(i, n).lo()).fold(f64::INFINITY, f64::min)
    }

    /// Diagonal entry less the magnitudes of the others in row i of W M Wᵀ.
    fn dominance(&self, i: usize, n: usize) -> Interval {
        let entry = |j: usize| product(&self.w[j * n + j..(j + 1) * n], &self.half[i * n + j..]);
        let others = (0..n).filter(|j| *j != i);
        others.fold(entry(i), |rest, j| rest - Interval::point(entry(j).mag()))
    }

    /// The two joints whose halving should help most: those with the greatest slack were one of
    /// them known exactly.
    ///
    /// Two at a time spares half the scoring. The first joint never matters to M.
    fn best_splits(&mut self, positions: &PositionBox) -> Vec<usize> {
        let wide = (1..positions.q.len()).filter(|i| positions.q[*i].width() > LEAST_WIDTH);
        let scored = wide.map(|i| {
            let middle = positions.q[i].mid();
            (i, self.slack(&positions.part(i, middle, middle)))
        });
        let mut scored: Vec<_> = scored.collect();
        scored.sort_by(|a, b| b.1.total_cmp(&a.1));
        scored.iter().map(|(i, _)| *i).take(2).collect()
    }
}

/// Sum of products.
fn product(w: &[f64], m: &[Interval]) -> Interval {
    w.iter().zip(m).fold(Interval::ZERO, |sum, (w, m)| sum + Interval::point(*w) * *m)
}

/// W = D^(-1/2) L^(-T) of the factors of [`ltdl`], upper triangular, row by row; false where a
/// pivot is not positive.
fn whitening(factors: &[f64], w: &mut [f64], n: usize) -> bool {
    for i in (0..n).rev() {
        let pivot = factors[i * n + i];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        w[i * n + i] = 1.0;
        for j in i + 1..n {
            let sum: f64 = (i + 1..=j).map(|k| factors[k * n + i] * w[k * n + j]).sum();
            w[i * n + j] = -sum;
        }
    }
    for (i, row) in w.chunks_mut(n).enumerate() {
        let scale = factors[i * n + i].sqrt();
        row.iter_mut().for_each(|x| *x /= scale);
    }
    true
}
