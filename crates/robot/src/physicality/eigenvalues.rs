//! Bounds of the mass matrix's eigenvalues over the position limits, by branch and bound.

use super::cover::PositionBox;
use super::outcome::Physicality;
use crate::robot::Robot;
use crate::workspace::Workspace;
use nalgebra::DMatrix;
use reachtube_scalar::Interval;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The search ends when the bound is this near, as a part of it, to a value that M has.
const NEAR: f64 = 1e-3;

/// The eigenvalue that is bounded.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Least,
    Largest,
}

impl Side {
    /// Returns a number that is larger the better a bound is; its own inverse.
    fn score(self, bound: f64) -> f64 {
        match self {
            Self::Least => bound,
            Self::Largest => -bound,
        }
    }
}

/// A box of positions and the score of its bound. The box with the worst score is the greatest.
struct Part {
    score: f64,
    positions: PositionBox,
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        other.score.total_cmp(&self.score)
    }
}

impl Robot {
    /// Returns a lower bound of the least and an upper bound of the largest eigenvalue of M_m(q)
    /// over all positions within the limits \[kg m²; kg\].
    ///
    /// A branch and bound with interval arithmetic bisects the box of positions that decides, until
    /// the bound is within 0.1 % of a value that M has or `most_boxes` boxes were made. More boxes
    /// give tighter bounds. If the links are bodies ([`Robot::check_physical`]), the lower bound is
    /// at least the smallest armature. Otherwise it may be negative for an arm of six joints, where
    /// [`Robot::prove_positive_definite`] is much faster.
    ///
    /// # Guarantee
    ///
    /// Outer: the bounds hold for the robot's constants as loaded, under outward rounding, with
    /// joint rotations taken as exact, whatever the number of boxes is.
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_robot::Robot;
    ///
    /// let text = include_str!("../../examples/double_pendulum.toml");
    /// let pendulum = Robot::from_toml(text, "double pendulum").unwrap();
    /// let [least, largest] = pendulum.mass_matrix_bounds(1000);
    /// let eigenvalues = pendulum.mass_matrix(&[0.3, 0.7]).symmetric_eigenvalues();
    /// assert!(0.0 < least && least <= eigenvalues.min() && eigenvalues.max() <= largest);
    /// ```
    #[must_use]
    pub fn mass_matrix_bounds(&self, most_boxes: usize) -> [f64; 2] {
        let bound = |side| side_bound(self, side, most_boxes);
        let armatures = self.joints.iter().map(|joint| joint.armature);
        let floor = match self.check_physical() {
            Ok(Physicality::Links { .. }) => armatures.fold(f64::INFINITY, f64::min),
            _ => f64::NEG_INFINITY,
        };
        [bound(Side::Least).max(floor), bound(Side::Largest)]
    }
}

/// Bounds one eigenvalue by best-first search.
fn side_bound(robot: &Robot, side: Side, most_boxes: usize) -> f64 {
    let mut spectrum = Spectrum::new(robot, side);
    let whole = robot.position_limits_box();
    let mut open = BinaryHeap::from([Part { score: spectrum.score(&whole), positions: whole }]);
    while let Some(worst) = open.peek() {
        let wanted = spectrum.attained - NEAR * spectrum.attained.abs();
        if worst.score >= wanted || open.len() >= most_boxes {
            break;
        }
        let Some(joint) = spectrum.best_split(&worst.positions) else { break };
        let worst = open.pop().map(|part| part.positions.halves(joint));
        for positions in worst.into_iter().flatten() {
            open.push(Part { score: spectrum.score(&positions), positions });
        }
    }
    side.score(open.peek().map_or(f64::NEG_INFINITY, |worst| worst.score))
}

/// Bounds an eigenvalue of M over boxes of positions.
struct Spectrum<'a> {
    robot: &'a Robot,
    side: Side,
    ws: Workspace<Interval>,
    centre_ws: Workspace<f64>,
    /// M over the box.
    m: Vec<Interval>,
    /// Worst score of the values that M has at centres of boxes, to rounding.
    attained: f64,
}

impl<'a> Spectrum<'a> {
    fn new(robot: &'a Robot, side: Side) -> Self {
        let n = robot.joint_count();
        Self {
            robot,
            side,
            ws: Workspace::new(robot),
            centre_ws: Workspace::new(robot),
            m: vec![Interval::ZERO; n * n],
            attained: f64::INFINITY,
        }
    }

    /// Returns the score of a bound over the box.
    ///
    /// Let M(mid) ≈ Q Λ Qᵀ. Q as it is and W = Λ^(-1/2) Qᵀ each give a bound for any rounding error
    /// of theirs; the better one counts.
    fn score(&mut self, positions: &PositionBox) -> f64 {
        let n = positions.q.len();
        self.robot.crba(&positions.sin, &positions.cos, &mut self.ws, &mut self.m);
        let middle: Vec<_> = positions.q.iter().map(|q| q.mid()).collect();
        let (sin, cos) = self.robot.sin_cos(&middle);
        let mut centre = DMatrix::zeros(n, n);
        self.robot.crba(&sin, &cos, &mut self.centre_ws, centre.as_mut_slice());
        let eigen = centre.symmetric_eigen();
        let value = match self.side {
            Side::Least => eigen.eigenvalues.min(),
            Side::Largest => eigen.eigenvalues.max(),
        };
        self.attained = self.attained.min(self.side.score(value));
        let turned = eigen.eigenvectors.transpose();
        let mut best = self.bound(&turned);
        if eigen.eigenvalues.min() > 0.0 {
            let mut scaled = turned;
            for (mut row, value) in scaled.row_iter_mut().zip(&eigen.eigenvalues) {
                row /= value.sqrt();
            }
            best = best.max(self.bound(&scaled));
        }
        best
    }

    /// Returns the score of the bound that an invertible W gives.
    ///
    /// With X = W M Wᵀ and x = Wᵀ y, xᵀ M x = yᵀ X y and |x|² = yᵀ W Wᵀ y. Gershgorin's circles
    /// bound both forms, and the least ratio of the two bounds M.
    fn bound(&self, w: &DMatrix<f64>) -> f64 {
        let n = w.nrows();
        let entry = |i: usize, j: usize| Interval::point(w[(i, j)]);
        let sum = |terms: &dyn Fn(usize) -> Interval| {
            (0..n).map(terms).fold(Interval::ZERO, |sum, term| sum + term)
        };
        let half: Vec<Interval> =
            (0..n * n).map(|k| sum(&|l| entry(k / n, l) * self.m[l * n + k % n])).collect();
        let form = |i: usize, j: usize| sum(&|l| half[i * n + l] * entry(j, l));
        let size = |i: usize, j: usize| sum(&|l| entry(i, l) * entry(j, l));
        let [form, size] = [circles(n, &form), circles(n, &size)];
        if size.lo() <= 0.0 {
            return f64::NEG_INFINITY;
        }
        let ratio = form / size;
        match self.side {
            Side::Least => ratio.lo(),
            Side::Largest => -ratio.hi(),
        }
    }

    /// Returns the joint whose position should be bisected: the one with the best score if its
    /// position is fixed at the middle.
    fn best_split(&mut self, positions: &PositionBox) -> Option<usize> {
        let wide = positions.wide_joints();
        let scored = wide.map(|joint| (joint, self.score(&positions.with_middle(joint))));
        scored.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(joint, _)| joint)
    }
}

/// Returns the hull of Gershgorin's circles of a symmetric matrix.
fn circles(n: usize, entry: &dyn Fn(usize, usize) -> Interval) -> Interval {
    let circle = |i: usize| {
        let others = (0..n).filter(|j| *j != i).map(|j| Interval::centred(0.0, entry(i, j).mag()));
        others.fold(entry(i, i), |circle, other| circle + other)
    };
    (0..n).map(circle).reduce(Interval::hull).unwrap_or(Interval::ZERO)
}
