//! A proved bound of a model's truncation error over an operating box.

use nalgebra::DMatrix;
use rayon::prelude::*;
use reachtube_robot::Robot;
use reachtube_scalar::{Interval, TaylorModel, TaylorPolynomial};

use crate::error::Result;
use crate::model_kind::ModelKind;
use crate::operating_box::OperatingBox;
use crate::polynomial_model::PolynomialModel;
use crate::preconditioned::Preconditioned;
use crate::remainder::Remainder;
use crate::residual::{Equations, Scratch, position_variables};
use crate::sampled_error::sampled_error;

/// Lowest order of the Taylor models: that of the series of M_m⁻¹.
const LOW_ORDER: u32 = 4;
/// Highest order for model 3: the order p + 1 cancels all terms that the model has right.
const HIGH_ORDER: u32 = 8;
/// Number of boxes that are cut at once, so that all cores have work.
const BATCH: usize = 8;
/// A bound at most this many times the sampled error is not refined further.
const TIGHT_RATIO: f64 = 1.3;
const GOAL: f64 = 1.2;
const SLACK: f64 = 0.02;
/// Above this relative error of the inverse of the mass matrix, a part is cut.
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
        if std::env::var("TRACE").is_ok() { eprintln!("sampled {sampled_error:?}"); }
        let order: u32 = std::env::var("ORDER").map_or_else(|_| match self.kind() {
            ModelKind::Three => (self.order() + 2).clamp(LOW_ORDER, HIGH_ORDER),
            _ => LOW_ORDER,
        }, |o| o.parse().unwrap());
        let equations = Equations::new(self, &robot, operating_box, order)?;
        let mut search =
            BranchAndBound { equations, sampled_error: &sampled_error, cells: Vec::new() };
        search.refine(operating_box.sides()[..robot.joint_count()].to_vec(), max_boxes);
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
    /// Sides of the positions, n, rad; velocities and inputs are those of the whole box.
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
    equations: Equations<'a>,
    sampled_error: &'a [f64],
    cells: Vec<Cell>,
}

impl BranchAndBound<'_> {
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
            if std::env::var("TRACE").is_ok() {
                let unproved = self.cells.iter().filter(|c| c.ratio == f64::INFINITY).count();
                let worst = self.cells.iter().map(|c| c.ratio).filter(|r| r.is_finite()).fold(0.0, f64::max);
                eprintln!("{} cells, {unproved} unproved, worst {worst:.3}", self.cells.len());
            }
            if done {
                break;
            }
        }
    }

    /// Bounds the truncation error over each of `parts`, in parallel.
    fn cells_of(&self, parts: Vec<Vec<Interval>>) -> Vec<Cell> {
        parts
            .into_par_iter()
            .map_init(|| self.equations.scratch(), |scratch, sides| self.cell(sides, scratch))
            .collect()
    }

    fn cell(&self, sides: Vec<Interval>, scratch: &mut Scratch) -> Cell {
        let angles = self.equations.angles(&sides);
        let mass = self.equations.mass_matrix(&angles, scratch);
        let t0 = std::time::Instant::now();
        let known = Preconditioned::new(mass.clone(), self.equations.positions())
            .filter(|known| known.spread() < std::env::var("WIDE").map_or(WIDE_SPREAD, |w| w.parse().unwrap()));
        let Some(known) = known else {
            let cut = stiffest(&mass, &sides);
            let bounds = vec![Interval::ENTIRE; self.sampled_error.len()];
            return Cell { bounds, cut, ratio: f64::INFINITY, sides };
        };
        let t1 = t0.elapsed();
        let load = self.equations.load(&angles, scratch);
        let rate = self.equations.acceleration(&angles, scratch);
        let t2 = t0.elapsed();
        let load = known.residual(&load, &rate);
        let t3 = t0.elapsed();
        let goals = self.sampled_error.iter().map(|error| GOAL * error);
        let joined: Vec<TaylorModel> = load
            .iter()
            .zip(goals.clone())
            .map(|(load, goal)| self.equations.joined(load, SLACK * goal))
            .collect();
        let t4 = t0.elapsed();
        let parts: usize = std::env::var("PARTS").map_or(200, |p| p.parse().unwrap());
        let ranges: Vec<Interval> =
            joined.iter().zip(goals).map(|(load, goal)| load.range_to_goal(goal, parts)).collect();
        let t5 = t0.elapsed();
        let bounds = known.solve(&ranges);
        let Some(bounds) = bounds else {
            let bounds = vec![Interval::ENTIRE; self.sampled_error.len()];
            return Cell { bounds, cut: stiffest(&mass, &sides), ratio: f64::INFINITY, sides };
        };
        let ratio = |i: usize| bounds[i].mag() / self.sampled_error[i].max(f64::MIN_POSITIVE);
        let worst = (0..bounds.len()).max_by(|i, j| ratio(*i).total_cmp(&ratio(*j))).unwrap_or(0);
        let cut = most_curved(&joined[worst], &sides);
        if std::env::var("TRACE").is_ok() {
            eprintln!("E {t1:?} rho {:?} load {:?} join {:?} range {:?}: terms {} spread {:.3} ratios {:?} natural {:?} rem {:?} cut {cut}",
            t2-t1, t3-t2, t4-t3, t5-t4, joined[worst].polynomial().term_count(), known.spread(),
            (0..bounds.len()).map(|i| (ratio(i)*100.0).round()/100.0).collect::<Vec<_>>(),
            joined.iter().zip(self.sampled_error).map(|(j, s)| (j.range().mag()/s*100.0).round()/100.0).collect::<Vec<_>>(),
            joined.iter().zip(self.sampled_error).map(|(j, s)| (j.remainder().mag()/s*100.0).round()/100.0).collect::<Vec<_>>());
        }
        Cell { ratio: ratio(worst), bounds, cut, sides }
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

/// Returns the widest side.
fn widest(sides: &[Interval]) -> usize {
    (0..sides.len()).max_by(|i, j| sides[*i].width().total_cmp(&sides[*j].width())).unwrap_or(0)
}

/// Returns the side along which the mass matrix changes most, measured by P M for the inverse P of
/// its middle. Entry (i, j) is scaled by the inertias, because it maps rad/s² of j to those of i.
fn stiffest(mass: &[TaylorModel], sides: &[Interval]) -> usize {
    let n = sides.len();
    let middle = DMatrix::from_fn(n, n, |i, j| mass[i * n + j].polynomial().constant_term());
    let Some(inverse) = middle.clone().try_inverse() else { return widest(sides) };
    let mut change = vec![0.0; n];
    for ij in 0..n * n {
        let (i, j) = (ij / n, ij % n);
        let terms = (0..n).map(|k| mass[k * n + j].polynomial().scaled(&inverse[(i, k)]));
        let product = terms.fold(TaylorPolynomial::from(0.0), |sum, term| sum + term);
        let scale = (middle[(i, i)] / middle[(j, j)]).abs().sqrt();
        add_curvature(&product, scale, 0, &mut change);
    }
    largest(&change).unwrap_or_else(|| widest(sides))
}

/// Returns the side along which the model bends most; a linear part is bounded exactly and needs no
/// cut.
fn most_curved(model: &TaylorModel, sides: &[Interval]) -> usize {
    let mut curvature = vec![0.0; sides.len()];
    add_curvature(model.polynomial(), 1.0, 1, &mut curvature);
    largest(&curvature).unwrap_or_else(|| widest(sides))
}

/// Adds the magnitudes of the terms of a degree above `degree` to the sides that they depend on.
fn add_curvature(polynomial: &TaylorPolynomial, scale: f64, degree: u32, sides: &mut [f64]) {
    let positions = position_variables(sides.len());
    for term in polynomial.terms() {
        if term.exponents.iter().map(|e| u32::from(*e)).sum::<u32>() > degree {
            let factors = term.exponents.iter().zip(&mut sides[positions.clone()]);
            factors.filter(|(e, _)| **e > 0).for_each(|(_, c)| *c += scale * term.coefficient.abs());
        }
    }
}

/// Returns the index of the largest value, where it is above 0.
fn largest(values: &[f64]) -> Option<usize> {
    let index = (0..values.len()).max_by(|i, j| values[*i].total_cmp(&values[*j]))?;
    (values[index] > 0.0).then_some(index)
}
