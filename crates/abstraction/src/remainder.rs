//! What a model leaves out: a proved bound of its error over an operating box.

use std::sync::Arc;

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::rounding::{add_up, div_up, mul_up, sub_down};
use reachtube_scalar::{Elementary, Interval, TaylorBox, TaylorModel, TaylorSpace};
use serde::{Deserialize, Serialize};

use super::operating_box::OperatingBox;
use super::{ModelKind, ModelWorkspace, PolynomialModel};
use crate::error::Result;

/// Order of the Taylor models for models that are wrong in the first order of q.
const LOW_ORDER: u32 = 3;
/// Highest order for model 3, where one above the model's lets cancel what the model has right.
const HIGH_ORDER: u32 = 6;
/// Boxes that are cut at once, so that both cores have work.
const BATCH: usize = 32;
/// A bound this near to an error that was seen is not refined further.
const NEAR: f64 = 1.05;
/// From this relative spread of the mass matrix on, positions are cut before anything else.
const WIDE: f64 = 0.3;

/// A bound of f(x, u) - f_p(x, u), the acceleration that a model leaves out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Remainder {
    /// Where it holds.
    pub operating_box: OperatingBox,
    /// For each joint the acceleration left out lies in \[low, high\], rad/s²; none where no bound
    /// was found.
    pub bounds: Vec<Option<[f64; 2]>>,
    /// The largest magnitude found by search, rad/s²: no bound can be less.
    pub seen: Vec<f64>,
    /// Boxes that the operating box was cut into.
    pub boxes: usize,
}

impl Remainder {
    /// Whether its sizes are those of n joints and its box is not empty.
    pub(super) fn is_of(&self, n: usize) -> bool {
        self.operating_box.is_of(n) && self.bounds.len() == n && self.seen.len() == n
    }
}

impl PolynomialModel {
    /// Bounds what the model leaves out of the forward dynamics (10) over an operating box, by
    /// branch and bound with at most `most_boxes` boxes.
    ///
    /// With the residual ρ = u - c - τ_v - M_m f_p, what is left out is r = M_m⁻¹ ρ. Over a box ρ
    /// is a Taylor model in (q, q̇, u), made by the same recursions as the dynamics itself, and r =
    /// P ρ + (1 - P M_m) r with P the inverse of M_m's midpoint is bounded without inverting a set.
    /// Boxes with the largest bound are cut in two.
    ///
    /// # Guarantee
    ///
    /// Outer: f - f_p lies in the bounds at every point of the box, with the robot's constants and
    /// the model's coefficients as the double-precision numbers they are, under directed rounding.
    /// `seen` is inner, up to rounding.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`](crate::Error::Setting) for a box of the wrong size or outside the joints'
    /// limits.
    pub fn bound_remainder(
        &self,
        operating_box: &OperatingBox,
        most_boxes: usize,
    ) -> Result<Remainder> {
        let robot = Robot::from_description(self.robot())?;
        operating_box.check(&robot)?;
        let seen = super::seen_error::seen_error(self, &robot, operating_box);
        let mut search = Search::new(self, &robot, &seen)?;
        search.refine(operating_box.sides(), most_boxes);
        let bound = |i: usize| {
            let hull = search.cells.iter().map(|cell| cell.bounds[i]).reduce(Interval::hull)?;
            (hull.lo().is_finite() && hull.hi().is_finite()).then(|| [hull.lo(), hull.hi()])
        };
        Ok(Remainder {
            operating_box: operating_box.clone(),
            bounds: (0..robot.joint_count()).map(bound).collect(),
            boxes: search.cells.len(),
            seen,
        })
    }

    /// Boxes for [`bound_remainder`](Self::bound_remainder) that take some seconds: the more terms
    /// the model has, the fewer.
    pub fn usual_boxes(&self) -> usize {
        (300_000 / self.term_count().max(1)).clamp(16, 2000)
    }

    /// Keeps a bound with the model, and so in its file.
    pub fn set_remainder(&mut self, remainder: Remainder) {
        self.remainder = Some(remainder);
    }
}

/// A part of the operating box.
struct Cell {
    /// (q, q̇, u).
    sides: Vec<Interval>,
    /// What is left out, joint by joint.
    bounds: Vec<Interval>,
    /// The side to cut next.
    cut: usize,
    /// The largest bound against what was seen.
    excess: f64,
}

/// Branch and bound.
struct Search<'a> {
    model: &'a PolynomialModel,
    robot: &'a Robot,
    seen: &'a [f64],
    space: Arc<TaylorSpace>,
    cells: Vec<Cell>,
}

/// Scratch memory of one thread.
struct Scratch {
    robot: Workspace<TaylorModel>,
    model: ModelWorkspace<TaylorModel>,
}

impl<'a> Search<'a> {
    fn new(model: &'a PolynomialModel, robot: &'a Robot, seen: &'a [f64]) -> Result<Self> {
        let order = match model.kind() {
            ModelKind::Three => (model.order() + 1).clamp(LOW_ORDER, HIGH_ORDER),
            _ => LOW_ORDER,
        };
        let space = TaylorSpace::new(3 * robot.joint_count(), order)?;
        Ok(Self { model, robot, seen, space, cells: Vec::new() })
    }

    fn refine(&mut self, whole: Vec<Interval>, most: usize) {
        self.cells = self.cells_of(vec![whole]);
        while self.cells.len() < most {
            self.cells.sort_by(|a, b| a.excess.total_cmp(&b.excess));
            let batch = BATCH.min(most - self.cells.len()).min(self.cells.len());
            let worst = self.cells.split_off(self.cells.len() - batch);
            let (near, open): (Vec<Cell>, Vec<Cell>) =
                worst.into_iter().partition(|cell| cell.excess <= NEAR || cell.is_point());
            let done = open.is_empty();
            self.cells.extend(near);
            self.cells.extend(self.cells_of(open.iter().flat_map(Cell::halves).collect()));
            if done {
                break;
            }
        }
    }

    fn cells_of(&self, parts: Vec<Vec<Interval>>) -> Vec<Cell> {
        let scratch =
            || Scratch { robot: Workspace::new(self.robot), model: self.model.workspace() };
        parts
            .into_par_iter()
            .map_init(scratch, |scratch, sides| self.cell(sides, scratch))
            .collect()
    }

    fn cell(&self, sides: Vec<Interval>, scratch: &mut Scratch) -> Cell {
        let (mass, residual) = self.residual(&sides, scratch);
        let spread = Spread::of(&mass);
        let Some((bounds, load)) = spread.as_ref().and_then(|spread| spread.solve(&residual))
        else {
            let cut = widest_position(&sides, self.robot.joint_count());
            return Cell {
                bounds: vec![Interval::ENTIRE; self.seen.len()],
                cut,
                excess: f64::INFINITY,
                sides,
            };
        };
        let ratio = |i: usize| bounds[i].mag() / self.seen[i].max(f64::MIN_POSITIVE);
        let worst = (0..bounds.len()).max_by(|i, j| ratio(*i).total_cmp(&ratio(*j))).unwrap_or(0);
        let cut = if spread.is_some_and(|spread| spread.norm() > WIDE) {
            widest_position(&sides, self.robot.joint_count())
        } else {
            most_curved(&load[worst], &sides)
        };
        Cell { excess: ratio(worst), bounds, cut, sides }
    }

    /// M_m and ρ over a box.
    fn residual(
        &self,
        sides: &[Interval],
        scratch: &mut Scratch,
    ) -> (Vec<TaylorModel>, Vec<TaylorModel>) {
        let n = self.robot.joint_count();
        let variables = TaylorBox::new(&self.space, sides).variables();
        let (q, rest) = variables.split_at(n);
        let (qd, u) = rest.split_at(n);
        let (sin, cos): (Vec<_>, Vec<_>) = q.iter().map(Elementary::sin_cos).unzip();
        let mut state = [q, qd].concat();
        if self.model.layout().trigonometric {
            state.extend(sin.iter().chain(&cos).cloned());
        }
        let zeros = |count| vec![TaylorModel::from(0.0); count];
        let (mut rate, mut mass, mut coriolis) = (zeros(state.len()), zeros(n * n), zeros(n));
        self.model.rate_into(&state, u, &mut scratch.model, &mut rate);
        self.robot.crba(&sin, &cos, &mut scratch.robot, &mut mass);
        self.robot.coriolis(&sin, &cos, qd, &mut scratch.robot, &mut coriolis);
        let residual = |i: usize| {
            let friction = self.robot.joints()[i].friction.viscous.torque(&qd[i]);
            let inertial = (0..n).map(|j| &mass[i * n + j] * &rate[n + j]);
            inertial.fold(&(&u[i] - &coriolis[i]) - &friction, |sum, term| &sum - &term)
        };
        let residual = (0..n).map(residual).collect();
        (mass, residual)
    }
}

impl Cell {
    fn is_point(&self) -> bool {
        let side = self.sides[self.cut];
        side.mid() <= side.lo() || side.mid() >= side.hi()
    }

    fn halves(&self) -> [Vec<Interval>; 2] {
        let side = self.sides[self.cut];
        let part = |low: f64, high: f64| {
            let mut sides = self.sides.clone();
            sides[self.cut] = Interval::point(low).hull(Interval::point(high));
            sides
        };
        [part(side.lo(), side.mid()), part(side.mid(), side.hi())]
    }
}

fn widest_position(sides: &[Interval], n: usize) -> usize {
    (0..n).max_by(|i, j| sides[*i].width().total_cmp(&sides[*j].width())).unwrap_or(0)
}

/// The side along which the model bends most; what is linear is bounded exactly.
fn most_curved(model: &TaylorModel, sides: &[Interval]) -> usize {
    let mut curvature = vec![0.0; sides.len()];
    for term in model.polynomial().terms() {
        if term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() > 1 {
            let factors = term.exponents.iter().zip(&mut curvature).filter(|(e, _)| **e > 0);
            factors.for_each(|(_, c)| *c += term.coefficient.abs());
        }
    }
    let bent = (0..sides.len()).max_by(|i, j| curvature[*i].total_cmp(&curvature[*j])).unwrap_or(0);
    if curvature[bent] > 0.0 { bent } else { widest_position(sides, sides.len()) }
}

/// How far a mass matrix over a box is from one matrix: with P the inverse of its midpoint, 1 - P
/// M.
struct Spread {
    /// P.
    inverse: DMatrix<f64>,
    /// 1 - P M, row by row.
    deviation: Vec<Interval>,
    /// w > 0 with |1 - P M| w < w, which proves that M is invertible everywhere in the box.
    weights: Vec<f64>,
}

impl Spread {
    fn of(mass: &[TaylorModel]) -> Option<Self> {
        let n = mass.len().isqrt();
        let ranges: Vec<Interval> = mass.iter().map(TaylorModel::range).collect();
        let inverse = DMatrix::from_fn(n, n, |i, j| ranges[i * n + j].mid()).try_inverse()?;
        let entry = |i: usize, j: usize| {
            let product: Interval = (0..n).map(|k| ranges[k * n + j] * inverse[(i, k)]).sum();
            Interval::point(f64::from(i == j)) - product
        };
        let deviation: Vec<Interval> = (0..n * n).map(|ij| entry(ij / n, ij % n)).collect();
        let magnitude = DMatrix::from_fn(n, n, |i, j| deviation[i * n + j].mag());
        let weights = (DMatrix::identity(n, n) - magnitude).try_inverse()?.column_sum();
        let spread = Self { inverse, deviation, weights: weights.iter().copied().collect() };
        let shrunk = spread.magnitude_times(&spread.weights);
        let shrinks = shrunk.iter().zip(&spread.weights).all(|(s, w)| *w > 0.0 && s < w);
        shrinks.then_some(spread)
    }

    fn norm(&self) -> f64 {
        let n = self.weights.len();
        self.deviation.chunks(n).map(|row| row.iter().map(|d| d.mag()).sum()).fold(0.0, f64::max)
    }

    /// |1 - P M| v, rounded up, for v ≥ 0.
    fn magnitude_times(&self, v: &[f64]) -> Vec<f64> {
        let row = |row: &[Interval]| {
            row.iter().zip(v).fold(0.0, |sum, (d, v)| add_up(sum, mul_up(d.mag(), *v)))
        };
        self.deviation.chunks(v.len()).map(row).collect()
    }

    /// Bounds of r = P ρ + (1 - P M) r, and P ρ; none where they are infinite.
    ///
    /// Any α with |P ρ| ≤ α (w - |1 - P M| w) gives |r| ≤ α w; then |r| ≤ |P ρ| + |1 - P M| |r|
    /// makes it smaller.
    fn solve(&self, residual: &[TaylorModel]) -> Option<(Vec<Interval>, Vec<TaylorModel>)> {
        let n = residual.len();
        let load = |i: usize| {
            let terms = (0..n).map(|j| &TaylorModel::from(self.inverse[(i, j)]) * &residual[j]);
            terms.fold(TaylorModel::from(0.0), |sum, term| &sum + &term)
        };
        let load: Vec<TaylorModel> = (0..n).map(load).collect();
        let ranges: Vec<Interval> = load.iter().map(TaylorModel::range).collect();
        let shrunk = self.magnitude_times(&self.weights);
        let needed = |i: usize| div_up(ranges[i].mag(), sub_down(self.weights[i], shrunk[i]));
        let scale = (0..n).map(needed).fold(0.0, f64::max);
        let mut radius: Vec<f64> = self.weights.iter().map(|w| mul_up(scale, *w)).collect();
        for _ in 0..4 {
            let rest = self.magnitude_times(&radius);
            radius =
                rest.iter().zip(&ranges).map(|(rest, load)| add_up(load.mag(), *rest)).collect();
        }
        let rest = self.magnitude_times(&radius);
        let bounds: Vec<Interval> =
            ranges.iter().zip(&rest).map(|(load, r)| *load + Interval::centred(0.0, *r)).collect();
        let finite = bounds.iter().all(|b| b.mag().is_finite());
        finite.then_some((bounds, load))
    }
}
