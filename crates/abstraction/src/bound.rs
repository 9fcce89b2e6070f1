//! A proved bound of a model's truncation error over an operating box.

use rayon::prelude::*;
use reachtube_robot::Robot;
use reachtube_scalar::{Interval, TaylorModel};

use crate::cut::{halves, most_curved, stiffest};
use crate::equations::{Equations, EquationsWorkspace, SinesCosines};
use crate::error::Result;
use crate::operating_box::OperatingBox;
use crate::polynomial_model::PolynomialModel;
use crate::preconditioned::Preconditioned;
use crate::remainder::Remainder;
use crate::sampled_error::sampled_error;
use crate::taylor_order::{part_cost, taylor_order};

/// Work of the default number of parts, in products of coefficients: some 20 s on two cores.
const DEFAULT_WORK: f64 = 2e9;
/// Number of parts that are cut at once, so that all cores have work.
const BATCH: usize = 8;
/// Number of parts of positions, velocities and inputs together for the bound of a polynomial.
const POLYNOMIAL_PARTS: usize = 64;
/// A bound of a polynomial at most this many times the sampled error is not refined further.
const GOAL: f64 = 1.15;
/// A bound at most this many times the sampled error is not refined further.
const TIGHT_RATIO: f64 = 1.25;
/// The smallest terms of a polynomial, with this sum relative to the sampled error, are not
/// distinguished.
const SMALL_TERMS: f64 = 0.02;
/// Largest relative error of an inverse of the mass matrix with which a part is bounded.
const MAX_SPREAD: f64 = 0.3;
/// Largest number of parts with which a narrower box is looked for.
const NARROW_PARTS: usize = 8;
/// Largest number of halvings of a side for a narrower box.
const MAX_HALVINGS: usize = 100;

impl PolynomialModel {
    /// Bounds the truncation error of the forward dynamics (10) over an operating box, by branch
    /// and bound with at most `max_boxes` parts (docs/method.md, correction J).
    ///
    /// With the residual ρ = u - c - τ_v - M_m f_p, the truncation error is r = M_m⁻¹ ρ. Over a
    /// part, X is a series of M_m⁻¹ in q, and r = X ρ + (1 - X M_m) r bounds r. X ρ is a polynomial
    /// in (q̇, u), whose coefficients are Taylor models in q alone. Parts with the largest bound
    /// are cut in two.
    ///
    /// # Guarantee
    ///
    /// Outer: f - f_p lies in the bounds at every point of the box, under directed rounding, for
    /// the robot's constants and the model's coefficients as the double-precision numbers they are.
    /// [`Remainder::sampled_error`] is inner, up to rounding.
    ///
    /// # Errors
    ///
    /// - [`Error::BoxSize`](crate::Error::BoxSize) for a box of the wrong size.
    /// - [`Error::BeyondLimits`](crate::Error::BeyondLimits) for a box beyond the joints' limits.
    /// - [`Error::Space`](crate::Error::Space) for a robot of 14 joints or more, for which the
    ///   Taylor models do not fit.
    pub fn bound_remainder(
        &self,
        operating_box: &OperatingBox,
        max_boxes: usize,
    ) -> Result<Remainder> {
        let robot = Robot::from_description(self.robot())?;
        operating_box.check(&robot)?;
        let n = robot.joint_count();
        let equations = Equations::new(self, &robot, operating_box, taylor_order(self))?;
        let sampled_error = sampled_error(self, &robot, operating_box);
        let search = BranchAndBound { equations, sampled_error: &sampled_error };
        let cells = search.refined(operating_box.sides()[..n].to_vec(), max_boxes);
        let bound = |i: usize| {
            let bounds = cells.iter().map(|cell| cell.bounds.as_ref().map(|bounds| bounds[i]));
            let hull = bounds.reduce(|a, b| Some(a?.hull(b?)))??;
            Some([hull.lo(), hull.hi()])
        };
        Ok(Remainder {
            operating_box: operating_box.clone(),
            bounds: (0..n).map(bound).collect(),
            boxes: cells.len(),
            sampled_error,
        })
    }

    /// Returns a number of parts for which [`bound_remainder`](Self::bound_remainder) takes at most
    /// some 20 s on two cores. It falls with the number of joints and the order.
    #[must_use]
    pub fn default_max_boxes(&self) -> usize {
        ((DEFAULT_WORK / part_cost(self.joints(), taylor_order(self))) as usize).clamp(4, 1000)
    }

    /// Returns a narrower box, for which [`bound_remainder`](Self::bound_remainder) with
    /// `max_boxes` parts finds bounds: ranges of positions are halved about their middles until the
    /// mass matrix is proved to be invertible. `None` where no such box is found.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`bound_remainder`](Self::bound_remainder).
    pub fn narrower_box(
        &self,
        operating_box: &OperatingBox,
        max_boxes: usize,
    ) -> Result<Option<OperatingBox>> {
        let robot = Robot::from_description(self.robot())?;
        operating_box.check(&robot)?;
        let equations = Equations::new(self, &robot, operating_box, taylor_order(self))?;
        let search = BranchAndBound { equations, sampled_error: &[] };
        let mut narrower = operating_box.clone();
        for _ in 0..MAX_HALVINGS {
            let sides = narrower.sides()[..robot.joint_count()].to_vec();
            match search.invertible_parts(sides, max_boxes.min(NARROW_PARTS)) {
                Ok(()) => return Ok(Some(narrower)),
                Err(joint) => {
                    let [low, high] = narrower.q[joint];
                    let (middle, radius) = (0.5 * (low + high), 0.25 * (high - low));
                    narrower.q[joint] = [middle - radius, middle + radius];
                }
            }
        }
        Ok(None)
    }
}

/// A part of the operating box, with all its velocities and inputs.
struct BoxPart {
    /// Sides of the positions, n, rad.
    sides: Vec<Interval>,
    /// Bounds of the truncation error, n, rad/s²; `None` where there is no proof of a bound.
    bounds: Option<Vec<Interval>>,
    /// The joint whose side is cut next.
    cut: usize,
    /// Largest ratio of a bound to the sampled error.
    ratio: f64,
}

/// A search by branch and bound.
struct BranchAndBound<'a> {
    equations: Equations<'a>,
    sampled_error: &'a [f64],
}

impl BranchAndBound<'_> {
    /// Cuts the cells with the largest ratios until there are `max_boxes` or all are tight.
    fn refined(&self, whole: Vec<Interval>, max_boxes: usize) -> Vec<BoxPart> {
        let mut cells = self.cells_of(vec![whole]);
        while cells.len() < max_boxes {
            cells.sort_by(|a, b| a.ratio.total_cmp(&b.ratio));
            let batch = BATCH.min(max_boxes - cells.len()).min(cells.len());
            let worst = cells.split_off(cells.len() - batch);
            let mut parts = Vec::new();
            for cell in worst {
                match halves(&cell.sides, cell.cut).filter(|_| cell.ratio > TIGHT_RATIO) {
                    Some(halves) => parts.extend(halves),
                    None => cells.push(cell),
                }
            }
            if parts.is_empty() {
                break;
            }
            cells.extend(self.cells_of(parts));
        }
        cells
    }

    /// Bounds the truncation error over each of `parts`, in parallel.
    fn cells_of(&self, parts: Vec<Vec<Interval>>) -> Vec<BoxPart> {
        parts
            .into_par_iter()
            .map_init(|| self.equations.scratch(), |scratch, sides| self.cell(sides, scratch))
            .collect()
    }

    fn cell(&self, sides: Vec<Interval>, scratch: &mut EquationsWorkspace) -> BoxPart {
        let angles = self.equations.angles(&sides);
        match self.preconditioned(&sides, &angles, scratch) {
            Ok(mass) => self.bounded(sides, &angles, &mass, scratch),
            Err(cut) => BoxPart { sides, bounds: None, cut, ratio: f64::INFINITY },
        }
    }

    /// Returns M_m and its inverse over a part, or the joint to cut where the inverse is not known
    /// well enough.
    fn preconditioned(
        &self,
        sides: &[Interval],
        angles: &SinesCosines,
        scratch: &mut EquationsWorkspace,
    ) -> core::result::Result<Preconditioned, usize> {
        let mass = self.equations.mass_matrix(angles, scratch);
        let cut = stiffest(&mass, sides);
        let mass = Preconditioned::new(mass, self.equations.positions());
        mass.filter(|mass| mass.spread() <= MAX_SPREAD).ok_or(cut)
    }

    /// Bounds the truncation error over a part on which M_m is invertible.
    fn bounded(
        &self,
        sides: Vec<Interval>,
        angles: &SinesCosines,
        mass: &Preconditioned,
        scratch: &mut EquationsWorkspace,
    ) -> BoxPart {
        let load = self.equations.load(angles, scratch);
        let acceleration = self.equations.acceleration(angles, scratch);
        let residual = mass.residual(&load, &acceleration);
        let models: Vec<TaylorModel> = residual
            .iter()
            .zip(self.sampled_error)
            .map(|(residual, error)| self.equations.joined(residual, SMALL_TERMS * error))
            .collect();
        let range = |(model, error): (&TaylorModel, &f64)| {
            model.range_to_goal(GOAL * error, POLYNOMIAL_PARTS)
        };
        let ranges: Vec<Interval> = models.iter().zip(self.sampled_error).map(range).collect();
        let bounds = mass.solve(&ranges);
        let ratio = |i: usize| match &bounds {
            Some(bounds) => bounds[i].mag() / self.sampled_error[i].max(f64::MIN_POSITIVE),
            None => f64::INFINITY,
        };
        let worst = (0..sides.len()).max_by(|i, j| ratio(*i).total_cmp(&ratio(*j))).unwrap_or(0);
        let (cut, ratio) = (most_curved(&models[worst], &sides), ratio(worst));
        BoxPart { sides, bounds, cut, ratio }
    }

    /// Cuts a box of positions into parts, on each of which M_m is proved to be invertible, or
    /// returns the joint whose range is too wide for `max_parts` parts.
    fn invertible_parts(
        &self,
        whole: Vec<Interval>,
        max_parts: usize,
    ) -> core::result::Result<(), usize> {
        let mut scratch = self.equations.scratch();
        let (mut open, mut parts, mut first_cut) = (vec![whole], 1, None);
        while let Some(sides) = open.pop() {
            let angles = self.equations.angles(&sides);
            let Err(cut) = self.preconditioned(&sides, &angles, &mut scratch) else { continue };
            let too_wide = *first_cut.get_or_insert(cut);
            parts += 1;
            match halves(&sides, cut).filter(|_| parts <= max_parts) {
                Some(halves) => open.extend(halves),
                None => return Err(too_wide),
            }
        }
        Ok(())
    }
}
