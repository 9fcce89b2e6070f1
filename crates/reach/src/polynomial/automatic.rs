//! A flowpipe whose method, order, step and pieces are found by trial.

use crate::error::ReachError;
use crate::grid::TimeGrid;
use crate::polynomial::arguments::check;
use crate::polynomial::flowpipe::Flowpipe;
use crate::polynomial::settings::{FlowpipeMethod, FlowpipeSettings};
use crate::polynomial::system::PolynomialSystem;
use crate::polynomial::uncertain_input::UncertainInput;
use crate::sets::hyperrectangle::Hyperrectangle;

/// Numbers of equal parts of each step that are tried.
const PARTS: [usize; 3] = [1, 4, 16];

/// Order of the Taylor models that are tried first.
const LOW_ORDER: u32 = 4;

/// Highest order of Taylor models.
const HIGH_ORDER: u32 = 12;

/// Largest number of coefficients of a Taylor model of the highest order that is tried.
const MOST_COEFFICIENTS: f64 = 1000.0;

/// Largest number of pieces of the initial set.
const MOST_PIECES: usize = 32;

/// A flowpipe and the choice that gave it.
#[derive(Debug, Clone, PartialEq)]
pub struct AutomaticFlowpipe {
    /// The flowpipe on the grid that was asked for.
    pub flowpipe: Flowpipe,
    /// The settings that were chosen.
    pub settings: FlowpipeSettings,
    /// Number of equal parts of each step of the grid over which the sets were propagated.
    pub parts: usize,
}

impl Flowpipe {
    /// Computes the flowpipe as [`new`](Self::new) does, with settings that are found by trial.
    ///
    /// Linearisation of whole steps comes first. Where it stops early, Taylor models of order 4 and
    /// of a higher order are tried, then parts of each step, and at last pieces of the initial set
    /// along the state that carries the flowpipe furthest. The first flowpipe that reaches the last
    /// sample is returned, or else the one that came furthest.
    ///
    /// # Guarantee
    ///
    /// Outer, as [`new`](Self::new).
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    ///
    /// # Examples
    ///
    /// ```
    /// use reachtube_reach::{Flowpipe, Hyperrectangle, PolynomialSystem, TimeGrid, UncertainInput};
    /// use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};
    ///
    /// // ẋ = -x³ in steps of 2 s, which are too long for one step of the method.
    /// let space = TaylorSpace::new(1, 3).unwrap();
    /// let x = TaylorPolynomial::<Interval>::variable(&space, 0);
    /// let system = PolynomialSystem::new(1, 0, &[-(&(&x * &x) * &x)])?;
    /// let initial = Hyperrectangle { centre: vec![1.0], radius: vec![0.1] };
    /// let input = UncertainInput { measured: &[], set: &Hyperrectangle::zero(0) };
    /// let found =
    ///     Flowpipe::automatic(&system, &TimeGrid::uniform(2.0, 6), &[0.0], &initial, &input)?;
    /// assert!(found.flowpipe.is_reached() && found.parts > 1);
    /// // The solution from 1 is 1 / √(1 + 2 t).
    /// assert!(found.flowpipe.sample(5)[0].contains(21f64.sqrt().recip()));
    /// # Ok::<(), reachtube_reach::ReachError>(())
    /// ```
    pub fn automatic(
        system: &PolynomialSystem,
        grid: &TimeGrid,
        start: &[f64],
        initial_set: &Hyperrectangle,
        input: &UncertainInput<'_>,
    ) -> Result<AutomaticFlowpipe, ReachError> {
        check(system, grid, start, initial_set, input, &FlowpipeSettings::default())?;
        let mut search = Search { system, grid, start, initial_set, input, best: None };
        // Methods and parts of a step.
        for parts in PARTS {
            for method in methods(system) {
                let settings = FlowpipeSettings { method, ..FlowpipeSettings::default() };
                search.attempt(&settings, parts)?;
            }
        }
        // Pieces along the state that carries the flowpipe furthest.
        let mut along = None;
        for pieces in (1..).map(|i| 1 << i).take_while(|pieces| *pieces <= MOST_PIECES) {
            let all = 0..system.states();
            for state in
                all.filter(|i| initial_set.radius[*i] > 0.0 && along.is_none_or(|a| a == *i))
            {
                let (mut settings, parts) = search.choice();
                settings.pieces = vec![1; system.states()];
                settings.pieces[state] = pieces;
                search.attempt(&settings, parts)?;
            }
            let found = search.choice().0.pieces;
            along = found.iter().position(|pieces| *pieces > 1).or(along);
        }
        Ok(search.best.expect("there is an attempt"))
    }
}

/// The trials of one flowpipe.
struct Search<'a> {
    system: &'a PolynomialSystem,
    grid: &'a TimeGrid,
    start: &'a [f64],
    initial_set: &'a Hyperrectangle,
    input: &'a UncertainInput<'a>,
    best: Option<AutomaticFlowpipe>,
}

impl Search<'_> {
    /// Computes a flowpipe and keeps it where it comes further than the best so far, unless the
    /// best has reached the last sample.
    fn attempt(&mut self, settings: &FlowpipeSettings, parts: usize) -> Result<(), ReachError> {
        if self.best.as_ref().is_some_and(|best| best.flowpipe.is_reached()) {
            return Ok(());
        }
        let (inputs, measured) = (self.system.inputs(), self.input.measured);
        let rows = measured.chunks_exact(inputs.max(1));
        let measured: Vec<f64> =
            rows.flat_map(|row| row.iter().copied().cycle().take(parts * inputs)).collect();
        let steps = parts * self.grid.len().saturating_sub(1) * inputs;
        let input =
            UncertainInput { measured: &measured[..steps.min(measured.len())], ..*self.input };
        let grid = if parts == 1 { self.grid.clone() } else { self.grid.refined(parts) };
        let flowpipe =
            Flowpipe::new(self.system, &grid, self.start, self.initial_set, &input, settings)?;
        let flowpipe = flowpipe.on_whole_steps(self.grid, parts);
        let is_further = |best: &AutomaticFlowpipe| flowpipe.len() > best.flowpipe.len();
        if self.best.as_ref().is_none_or(is_further) {
            self.best = Some(AutomaticFlowpipe { flowpipe, settings: settings.clone(), parts });
        }
        Ok(())
    }

    /// Returns the settings and the parts of the best flowpipe so far.
    fn choice(&self) -> (FlowpipeSettings, usize) {
        let best = self.best.as_ref().expect("there is an attempt");
        (best.settings.clone(), best.parts)
    }
}

/// Returns the methods to try for a system, the cheapest first.
fn methods(system: &PolynomialSystem) -> Vec<FlowpipeMethod> {
    let mut methods = vec![FlowpipeMethod::Linearisation];
    if system.angles.states.is_empty() {
        // The number of coefficients of order p is C(N + p, p).
        let coefficients = |order: u32| {
            (1..=order).fold(1.0, |c, i| c * (system.states() as f64 + f64::from(i)) / f64::from(i))
        };
        let high = (1..=HIGH_ORDER).take_while(|p| coefficients(*p) <= MOST_COEFFICIENTS).last();
        let orders = [LOW_ORDER, high.unwrap_or(0)].into_iter().filter(|p| Some(*p) <= high);
        methods.extend(orders.map(|order| FlowpipeMethod::TaylorModels { order }));
        methods.dedup();
    }
    methods
}
