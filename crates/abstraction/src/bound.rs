//! A proved bound of a model's truncation error over an operating box.

use std::sync::Arc;

use rayon::prelude::*;
use reachtube_robot::{Robot, Workspace};
use reachtube_scalar::{Interval, TaylorBox, TaylorModel, TaylorSpace};

use crate::error::Result;
use crate::model_kind::ModelKind;
use crate::operating_box::OperatingBox;
use crate::polynomial_model::{ModelWorkspace, PolynomialModel};
use crate::preconditioned::Preconditioned;
use crate::remainder::Remainder;
use crate::sampled_error::sampled_error;

/// Order of the Taylor models for models 1 and 2, whose error begins at the first order of q.
const LOW_ORDER: u32 = 3;
/// Highest order for model 3: the order p + 1 cancels all terms that the model has right.
const HIGH_ORDER: u32 = 6;
/// Number of boxes that are cut at once, so that all cores have work.
const BATCH: usize = 32;
/// A bound at most this many times the sampled error is not refined further.
const TIGHT_RATIO: f64 = 1.05;
/// Above this relative spread of the mass matrix, positions are cut before other sides.
const WIDE_SPREAD: f64 = 0.3;

impl PolynomialModel {
    /// Bounds the truncation error of the forward dynamics (10) over an operating box, by branch
    /// and bound with at most `max_boxes` boxes (docs/method.md, correction J).
    ///
    /// With the residual ρ = u - c - τ_v - M_m f_p, the truncation error is r = M_m⁻¹ ρ. Over a
    /// box, ρ is a Taylor model in (q, q̇, u), computed by the same recursions as the dynamics
    /// itself. With P the inverse of M_m's midpoint, r = P ρ + (1 - P M_m) r bounds r without the
    /// inverse of a set. Boxes with the largest bound are cut in two.
    ///
    /// # Guarantee
    ///
    /// Outer: f - f_p lies in the bounds at every point of the box, under directed rounding, for
    /// the robot's constants and the model's coefficients as the double-precision numbers they are.
    /// [`Remainder::sampled_error`] is inner, up to rounding.
    ///
    /// # Errors
    ///
    /// [`Error::BoxSize`](crate::Error::BoxSize) for a box of the wrong size, and
    /// [`Error::BeyondLimits`](crate::Error::BeyondLimits) for a box beyond the joints' limits.
    pub fn bound_remainder(
        &self,
        operating_box: &OperatingBox,
        max_boxes: usize,
    ) -> Result<Remainder> {
        let robot = Robot::from_description(self.robot())?;
        operating_box.check(&robot)?;
        let sampled_error = sampled_error(self, &robot, operating_box);
        let mut search = BranchAndBound::new(self, &robot, &sampled_error)?;
        search.refine(operating_box.sides(), max_boxes);
        let bound = |i: usize| {
            let hull = search.cells.iter().map(|cell| cell.bounds[i]).reduce(Interval::hull)?;
            (hull.lo().is_finite() && hull.hi().is_finite()).then(|| [hull.lo(), hull.hi()])
        };
        Ok(Remainder {
            operating_box: operating_box.clone(),
            bounds: (0..robot.joint_count()).map(bound).collect(),
            boxes: search.cells.len(),
            sampled_error,
        })
    }

    /// Returns a number of boxes for which [`bound_remainder`](Self::bound_remainder) takes some
    /// seconds. It falls with the number of the model's terms.
    #[must_use]
    pub fn default_max_boxes(&self) -> usize {
        (300_000 / self.term_count().max(1)).clamp(16, 2000)
    }
}

/// A part of the operating box.
struct Cell {
    /// Sides (q, q̇, u), 3n.
    sides: Vec<Interval>,
    /// Bounds of the truncation error, n, rad/s².
    bounds: Vec<Interval>,
    /// Index of the side to cut next.
    cut: usize,
    /// Largest ratio of a bound to the sampled error.
    ratio: f64,
}

/// A search by branch and bound.
struct BranchAndBound<'a> {
    model: &'a PolynomialModel,
    robot: &'a Robot,
    sampled_error: &'a [f64],
    space: Arc<TaylorSpace>,
    cells: Vec<Cell>,
}

/// Scratch memory of one thread.
struct Scratch {
    robot: Workspace<TaylorModel>,
    model: ModelWorkspace<TaylorModel>,
}

impl<'a> BranchAndBound<'a> {
    fn new(model: &'a PolynomialModel, robot: &'a Robot, sampled_error: &'a [f64]) -> Result<Self> {
        let order = match model.kind() {
            ModelKind::Three => (model.order() + 1).clamp(LOW_ORDER, HIGH_ORDER),
            _ => LOW_ORDER,
        };
        let space = TaylorSpace::new(3 * robot.joint_count(), order)?;
        Ok(Self { model, robot, sampled_error, space, cells: Vec::new() })
    }

    /// Cuts the cells with the largest ratios until there are `max_boxes` or all are tight.
    fn refine(&mut self, whole: Vec<Interval>, max_boxes: usize) {
        self.cells = self.cells_of(vec![whole]);
        while self.cells.len() < max_boxes {
            self.cells.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
            let batch = BATCH.min(max_boxes - self.cells.len()).min(self.cells.len());
            let worst = self.cells.split_off(self.cells.len() - batch);
            let (tight, open): (Vec<Cell>, Vec<Cell>) =
                worst.into_iter().partition(|cell| cell.ratio <= TIGHT_RATIO || cell.is_point());
            let done = open.is_empty();
            self.cells.extend(tight);
            self.cells.extend(self.cells_of(open.iter().flat_map(Cell::halves).collect()));
            if done {
                break;
            }
        }
    }

    /// Bounds the truncation error over each of `parts`, in parallel.
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
        let mass = Preconditioned::new(&mass);
        let Some((bounds, load)) = mass.as_ref().and_then(|mass| mass.solve(&residual)) else {
            let cut = widest_position(&sides, self.robot.joint_count());
            let bounds = vec![Interval::ENTIRE; self.sampled_error.len()];
            return Cell { bounds, cut, ratio: f64::INFINITY, sides };
        };
        let ratio = |i: usize| bounds[i].mag() / self.sampled_error[i].max(f64::MIN_POSITIVE);
        let worst = (0..bounds.len()).max_by(|i, j| ratio(*i).total_cmp(&ratio(*j))).unwrap_or(0);
        let cut = if mass.is_some_and(|mass| mass.spread() > WIDE_SPREAD) {
            widest_position(&sides, self.robot.joint_count())
        } else {
            most_curved(&load[worst], &sides)
        };
        Cell { ratio: ratio(worst), bounds, cut, sides }
    }

    /// Returns M_m (row-major n x n) and ρ (n) over a box as Taylor models in (q, q̇, u).
    fn residual(
        &self,
        sides: &[Interval],
        scratch: &mut Scratch,
    ) -> (Vec<TaylorModel>, Vec<TaylorModel>) {
        let n = self.robot.joint_count();
        let variables = TaylorBox::new(&self.space, sides).variables();
        let (q, rest) = variables.split_at(n);
        let (qd, u) = rest.split_at(n);
        let (sin, cos) = self.robot.sin_cos(q);
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
    /// Returns whether the side to cut has no number between its ends.
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

/// Returns the widest of the first `n` sides.
fn widest_position(sides: &[Interval], n: usize) -> usize {
    (0..n).max_by(|i, j| sides[*i].width().total_cmp(&sides[*j].width())).unwrap_or(0)
}

/// Returns the side along which the model bends most; a linear part is bounded exactly and needs no
/// cut.
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
