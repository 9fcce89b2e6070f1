use rayon::prelude::*;
use reachtube_scalar::{Interval, TaylorSpace};

use crate::error::ReachError;
use crate::grid::TimeGrid;
use crate::polynomial::arguments::check;
use crate::polynomial::linearise::propagator::ZonotopePropagator;
use crate::polynomial::propagator::{SetPropagator, StepFailure};
use crate::polynomial::settings::{FlowpipeMethod, FlowpipeSettings};
use crate::polynomial::system::PolynomialSystem;
use crate::polynomial::taylor::propagator::TaylorPropagator;
use crate::polynomial::uncertain_input::UncertainInput;
use crate::sets::hyperrectangle::Hyperrectangle;
use crate::sets::zonotope::Zonotope;

/// Takes the zonotope at a sample, given by its index.
pub type Visit<'a> = &'a (dyn Fn(usize, Zonotope) + Sync);

/// The outcome of a flowpipe. A flowpipe that stops early is a result, not an error.
#[must_use]
#[derive(Debug, Clone, PartialEq)]
pub enum FlowpipeOutcome {
    /// The flowpipe reached the last sample.
    Reached,
    /// The flowpipe stopped early: no enclosure of the linearisation error could be verified.
    Failed {
        /// Last sample time (s) up to which the sets are valid.
        time: f64,
        /// State whose tube grew the most over the failed step.
        state: usize,
        /// Widths of the last tube, N entries; infinite if it has no bound.
        widths: Vec<f64>,
    },
}

/// The reachable set of a polynomial system under an uncertain input: an interval hull at each
/// sample and over each step.
///
/// [`FlowpipeMethod`] describes the methods.
///
/// # Examples
///
/// ```
/// use reachtube_reach::{
///     Flowpipe, FlowpipeSettings, Hyperrectangle, PolynomialSystem, TimeGrid, UncertainInput,
/// };
/// use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};
///
/// // A mass with cubic friction, v̇ = u - v - v³, pushed by 2 ± 0.1 N from rest.
/// let space = TaylorSpace::new(2, 3).unwrap();
/// let [v, u] = [0, 1].map(|i| TaylorPolynomial::<Interval>::variable(&space, i));
/// let system = PolynomialSystem::new(1, 1, &[u - v.clone() - &(&v * &v) * &v])?;
/// let force = Hyperrectangle { centre: vec![0.0], radius: vec![0.1] };
/// let input = UncertainInput { measured: &[2.0; 1000], set: &force };
/// let rest = Hyperrectangle::zero(1);
/// let (grid, settings) = (TimeGrid::uniform(0.01, 1001), FlowpipeSettings::default());
/// let flowpipe = Flowpipe::new(&system, &grid, &[0.0], &rest, &input, &settings)?;
/// // The speed settles where v + v³ is 2 ± 0.1.
/// assert!(flowpipe.is_reached());
/// let end = flowpipe.sample(1000)[0];
/// assert!(end.contains(0.975) && end.contains(1.0245) && end.width() < 0.06);
/// # Ok::<(), reachtube_reach::ReachError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Flowpipe {
    dimension: usize,
    samples: Vec<Interval>,
    steps: Vec<Interval>,
    outcome: FlowpipeOutcome,
}

impl Flowpipe {
    /// Computes the flowpipe from x(0) ∈ `start` + X0 (N) over `grid`.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: the boxes contain every solution from an initial state in the set,
    /// under an input with values in u_m + U, at the samples and at all times of the steps, up to
    /// the time of the outcome. Products with generators are floating-point products; a generator
    /// of its own covers the rounding of each step, bounded by γ_n |Φ| times the radius of the hull
    /// (Rump).
    ///
    /// # Errors
    ///
    /// Returns
    ///
    /// - [`ReachError::Shape`] when sizes do not fit; the rows of the input must fit the grid;
    /// - [`ReachError::NotFinite`] and [`ReachError::Negative`] for invalid numbers;
    /// - [`ReachError::Order`] for an order of Taylor models that does not fit the number of
    ///   states;
    /// - [`ReachError::Trigonometric`] for Taylor models of a system with sines and cosines.
    pub fn new(
        system: &PolynomialSystem,
        grid: &TimeGrid,
        start: &[f64],
        initial_set: &Hyperrectangle,
        input: &UncertainInput<'_>,
        settings: &FlowpipeSettings,
    ) -> Result<Self, ReachError> {
        Self::visiting(system, grid, start, initial_set, input, settings, None)
    }

    /// Computes the flowpipe as [`new`](Self::new) does, and hands the zonotope at each sample k to
    /// `visit`, once for each piece of the initial set. They are not kept: the sets of a long
    /// motion take gigabytes.
    ///
    /// # Guarantee
    ///
    /// As [`new`](Self::new); the zonotopes of all pieces together contain the solutions too.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn visiting(
        system: &PolynomialSystem,
        grid: &TimeGrid,
        start: &[f64],
        initial_set: &Hyperrectangle,
        input: &UncertainInput<'_>,
        settings: &FlowpipeSettings,
        visit: Option<Visit<'_>>,
    ) -> Result<Self, ReachError> {
        check(system, grid, start, initial_set, input, settings)?;
        // Propagate each piece of the initial set in parallel and take the hull of all flowpipes.
        let sides: Vec<Interval> =
            (0..system.states()).map(|i| side(start, initial_set, i)).collect();
        let of_piece = |piece: Vec<Interval>| {
            let mut propagator = propagator(system, &piece, settings)?;
            Ok(Self::propagate(propagator.as_mut(), system, grid, input, visit))
        };
        let pieces = pieces(&sides, &settings.pieces).into_par_iter().map(of_piece);
        let whole = pieces.reduce_with(|left, right| Ok(left?.hull(right?)));
        whole.expect("there is at least one piece")
    }

    /// Computes the flowpipe of one piece.
    fn propagate(
        propagator: &mut dyn SetPropagator,
        system: &PolynomialSystem,
        grid: &TimeGrid,
        input: &UncertainInput<'_>,
        visit: Option<Visit<'_>>,
    ) -> Self {
        // Initial set.
        let mut flowpipe = Self::empty(system.states(), grid.len());
        flowpipe.record_sample(propagator, visit);
        let mut u = vec![Interval::ZERO; system.inputs()];
        for k in 1..grid.len() {
            // One step under all inputs of the step; stop if no enclosure is verified.
            input.over_step(k - 1, &mut u);
            let advanced = propagator.advance(grid.interval(k - 1), &u);
            if let Err(StepFailure { state, widths }) = advanced {
                flowpipe.outcome =
                    FlowpipeOutcome::Failed { time: grid.times()[k - 1], state, widths };
                break;
            }
            // Tube over the step, then the set at its end.
            propagator.tube(&mut flowpipe.steps);
            flowpipe.record_sample(propagator, visit);
        }
        flowpipe
    }

    /// Returns the hull of both flowpipes, up to the time of the shorter one.
    fn hull(mut self, other: Self) -> Self {
        if other.len() < self.len() {
            return other.hull(self);
        }
        self.samples
            .iter_mut()
            .zip(&other.samples)
            .for_each(|(own, other)| *own = own.hull(*other));
        self.steps.iter_mut().zip(&other.steps).for_each(|(own, other)| *own = own.hull(*other));
        self
    }

    /// Returns the flowpipe on `grid` of one on the same grid with `parts` parts of each step.
    pub(crate) fn on_whole_steps(self, grid: &TimeGrid, parts: usize) -> Self {
        let n = self.dimension;
        let samples = self.len().div_ceil(parts);
        let mut whole = Self::empty(n, samples);
        for k in 0..samples {
            whole.samples.extend_from_slice(self.sample(k * parts));
            if k + 1 < samples {
                let side = |i: usize| {
                    let of_parts = (1..parts).map(|part| self.step(k * parts + part)[i]);
                    of_parts.fold(self.step(k * parts)[i], |hull, part| hull.hull(part))
                };
                whole.steps.extend((0..n).map(side));
            }
        }
        whole.outcome = match self.outcome {
            FlowpipeOutcome::Failed { state, widths, .. } => {
                FlowpipeOutcome::Failed { time: grid.times()[samples - 1], state, widths }
            }
            reached => reached,
        };
        whole
    }

    fn empty(n: usize, samples: usize) -> Self {
        Self {
            dimension: n,
            samples: Vec::with_capacity(n * samples),
            steps: Vec::with_capacity(n * samples),
            outcome: FlowpipeOutcome::Reached,
        }
    }

    fn record_sample(&mut self, propagator: &dyn SetPropagator, visit: Option<Visit<'_>>) {
        if let Some(visit) = visit {
            visit(self.len(), propagator.zonotope());
        }
        propagator.hull(&mut self.samples);
    }

    /// Returns the number of samples up to which the sets are valid.
    pub fn len(&self) -> usize {
        self.samples.len() / self.dimension.max(1)
    }

    /// Returns the hull at sample k, N intervals.
    pub fn sample(&self, k: usize) -> &[Interval] {
        &self.samples[k * self.dimension..(k + 1) * self.dimension]
    }

    /// Returns the hull of all states over the step from sample k to k + 1, N intervals.
    pub fn step(&self, k: usize) -> &[Interval] {
        &self.steps[k * self.dimension..(k + 1) * self.dimension]
    }

    /// Returns the outcome.
    pub fn outcome(&self) -> &FlowpipeOutcome {
        &self.outcome
    }

    /// Returns whether the flowpipe reached the last sample.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.outcome == FlowpipeOutcome::Reached
    }
}

/// Creates the propagator that the settings choose, for a box with the given sides.
fn propagator<'a>(
    system: &'a PolynomialSystem,
    sides: &[Interval],
    settings: &FlowpipeSettings,
) -> Result<Box<dyn SetPropagator + 'a>, ReachError> {
    let most = settings.order.map_or(usize::MAX, |order| order.saturating_mul(sides.len()));
    Ok(match settings.method {
        FlowpipeMethod::Linearisation => {
            let vertex_variables = settings.vertex_variables;
            Box::new(ZonotopePropagator::new(system, sides, vertex_variables, most))
        }
        FlowpipeMethod::TaylorModels { .. } if !system.angles.states.is_empty() => {
            return Err(ReachError::Trigonometric);
        }
        FlowpipeMethod::TaylorModels { order } => {
            let space = TaylorSpace::new(sides.len(), order.max(1))?;
            Box::new(TaylorPropagator::new(system, &space, sides, most))
        }
    })
}

pub(crate) fn side(start: &[f64], initial_set: &Hyperrectangle, i: usize) -> Interval {
    Interval::point(start[i]) + Interval::centred(initial_set.centre[i], initial_set.radius[i])
}

/// Divides a box into `parts` pieces along each side.
///
/// Neighbours share an end, so that the pieces cover the box.
fn pieces(sides: &[Interval], parts: &[usize]) -> Vec<Vec<Interval>> {
    let mut pieces = vec![Vec::with_capacity(sides.len())];
    for (i, side) in sides.iter().enumerate() {
        let parts = parts.get(i).copied().unwrap_or(1);
        let end = |part: usize| match part {
            0 => side.lo(),
            part if part == parts => side.hi(),
            part => (side.lo() + (side.hi() - side.lo()) * (part as f64 / parts as f64))
                .clamp(side.lo(), side.hi()),
        };
        let own = |part: usize| Interval::new(end(part), end(part + 1)).unwrap_or(*side);
        let longer = |piece: &Vec<Interval>| {
            let piece = piece.clone();
            (0..parts)
                .map(move |part| [piece.clone(), vec![own(part)]].concat())
                .collect::<Vec<_>>()
        };
        pieces = pieces.iter().flat_map(longer).collect();
    }
    pieces
}
