//! Proof that the mass matrix is positive definite over the position limits, by branch and bound.

use crate::joint_kind::JointKind;
use crate::ltdl;
use crate::robot::Robot;
use crate::workspace::Workspace;
use reachtube_scalar::Interval;

/// Width \[rad; m\] below which a joint's interval is not bisected further.
const LEAST_WIDTH: f64 = 1e-6;

/// A box of positions with enclosures of their sines and cosines.
#[derive(Clone)]
struct PositionBox {
    kinds: Vec<JointKind>,
    q: Vec<Interval>,
    sin: Vec<Interval>,
    cos: Vec<Interval>,
}

impl PositionBox {
    /// Sets the interval of one joint.
    fn set(&mut self, joint: usize, q: Interval) {
        self.q[joint] = q;
        (self.sin[joint], self.cos[joint]) = self.kinds[joint].sin_cos(&q);
    }

    /// Returns the joints that can be bisected, whose interval is wide enough. M does not depend on
    /// the first joint.
    fn wide_joints(&self) -> impl Iterator<Item = usize> {
        (1..self.q.len()).filter(|i| self.q[*i].width() > LEAST_WIDTH)
    }

    /// Returns the box in which one joint is fixed at its middle.
    fn with_middle(&self, joint: usize) -> Self {
        let middle = self.q[joint].mid();
        self.part(joint, middle, middle)
    }

    /// Returns the two halves along one joint.
    fn halves(&self, joint: usize) -> [Self; 2] {
        let q = self.q[joint];
        [self.part(joint, q.lo(), q.mid()), self.part(joint, q.mid(), q.hi())]
    }

    /// Returns the part in which one joint lies between two values.
    fn part(&self, joint: usize, low: f64, high: f64) -> Self {
        let mut part = self.clone();
        part.set(joint, Interval::new(low, high).unwrap_or(self.q[joint]));
        part
    }
}

impl Robot {
    /// Tries to prove that M_m(q) is positive definite at every position within the limits.
    ///
    /// This is for robots whose links alone are no proof ([`Robot::check_physical`]), such as
    /// robots with base parameters. The proof is a branch and bound with interval arithmetic over
    /// boxes of positions; boxes that are too wide are bisected. Returns the number of boxes, or
    /// `None` if more than `most_boxes` would be needed, which is no statement about M. The LWA 4P
    /// takes about 45,000 boxes and 2 s.
    ///
    /// # Guarantee
    ///
    /// A returned number is a proof for the robot's constants as loaded, under outward rounding.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let text = include_str!("../../examples/double_pendulum.toml");
    /// let pendulum = Robot::from_toml(text, "double pendulum").unwrap();
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

    /// Returns the box of all positions within the limits.
    fn position_limits_box(&self) -> PositionBox {
        let limits = self.joints.iter().map(|j| j.position_limits);
        let q: Vec<_> =
            limits.map(|[low, high]| Interval::point(low).hull(Interval::point(high))).collect();
        let (sin, cos) = self.sin_cos(&q);
        PositionBox { kinds: self.kinds(), q, sin, cos }
    }
}

/// Checks positive definiteness of M over boxes of positions.
struct Cover<'a> {
    robot: &'a Robot,
    ws: Workspace<Interval>,
    centre_ws: Workspace<f64>,
    /// M over the box.
    m: Vec<Interval>,
    /// W M.
    product: Vec<Interval>,
    /// M at the box's centre, then its factors.
    centre: Vec<f64>,
    w: Vec<f64>,
}

impl<'a> Cover<'a> {
    fn new(robot: &'a Robot) -> Self {
        let n = robot.joint_count();
        Self {
            robot,
            ws: Workspace::new(robot),
            centre_ws: Workspace::new(robot),
            m: vec![Interval::ZERO; n * n],
            product: vec![Interval::ZERO; n * n],
            centre: vec![0.0; n * n],
            w: vec![0.0; n * n],
        }
    }

    /// Returns a number that is positive only if M(q) is positive definite everywhere in the box.
    ///
    /// With M(mid) ≈ Lᵀ D L and W = D^(-1/2) L^(-T), the matrix W M Wᵀ is near 1. M is positive
    /// definite if W M Wᵀ is diagonally dominant (Gershgorin), for any rounding error of W.
    fn slack(&mut self, positions: &PositionBox) -> f64 {
        let n = positions.q.len();
        self.robot.crba(&positions.sin, &positions.cos, &mut self.ws, &mut self.m);
        let middle: Vec<_> = positions.q.iter().map(|q| q.mid()).collect();
        let (sin, cos) = self.robot.sin_cos(&middle);
        self.robot.crba(&sin, &cos, &mut self.centre_ws, &mut self.centre);
        ltdl::factor(&mut self.centre, n);
        if !whitening(&self.centre, &mut self.w, n) {
            return f64::NEG_INFINITY;
        }
        for i in 0..n {
            for j in 0..n {
                self.product[i * n + j] =
                    dot(&self.w[i * n + i..(i + 1) * n], &self.m[j * n + i..]);
            }
        }
        (0..n).map(|i| self.dominance(i, n).lo()).fold(f64::INFINITY, f64::min)
    }

    /// Returns the diagonal entry minus the magnitudes of the other entries in row i of W M Wᵀ.
    fn dominance(&self, i: usize, n: usize) -> Interval {
        let entry = |j: usize| dot(&self.w[j * n + j..(j + 1) * n], &self.product[i * n + j..]);
        let others = (0..n).filter(|j| *j != i);
        others.fold(entry(i), |rest, j| rest - Interval::point(entry(j).mag()))
    }

    /// Returns the two joints to bisect: the joints with the largest slack if their position is
    /// fixed at the middle.
    ///
    /// Bisecting two joints at a time halves the number of evaluations.
    fn best_splits(&mut self, positions: &PositionBox) -> Vec<usize> {
        let wide = positions.wide_joints();
        let mut scored: Vec<_> = wide.map(|i| (i, self.slack(&positions.with_middle(i)))).collect();
        scored.sort_by(|a, b| b.1.total_cmp(&a.1));
        scored.iter().map(|(i, _)| *i).take(2).collect()
    }
}

/// Returns an enclosure of Σ w m.
fn dot(w: &[f64], m: &[Interval]) -> Interval {
    w.iter().zip(m).fold(Interval::ZERO, |sum, (w, m)| sum + Interval::point(*w) * *m)
}

/// Computes W = D^(-1/2) L^(-T) from the factors of [`ltdl`], upper triangular, row by row.
///
/// Returns false if a pivot is not positive.
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
