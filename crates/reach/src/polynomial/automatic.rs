//! A flowpipe whose method, order, step and pieces are found by trial.

use crate::error::ReachError;
use crate::grid::TimeGrid;
use crate::polynomial::arguments::check;
use crate::polynomial::flowpipe::{Flowpipe, side};
use crate::polynomial::settings::{FlowpipeMethod, FlowpipeSettings};
use crate::polynomial::simulated::Simulated;
use crate::polynomial::system::PolynomialSystem;
use crate::polynomial::uncertain_input::UncertainInput;
use crate::sets::hyperrectangle::Hyperrectangle;

/// Order of the Taylor models that are tried first.
const LOW_ORDER: u32 = 4;

/// Highest order of Taylor models.
const HIGH_ORDER: u32 = 12;

/// Largest number of coefficients of a Taylor model of the highest order that is tried.
const MOST_COEFFICIENTS: f64 = 500.0;

/// Mean width relative to simulated solutions up to which no tighter flowpipe is tried.
const TIGHT: f64 = 1.25;

/// Change of the velocity over a step, relative to the velocity, up to which a step stays whole,
/// and the change over each part of a longer step.
const BEND: [f64; 2] = [0.2, 0.05];

/// Largest number of parts of a step that are tried first.
const MOST_PARTS: usize = 64;

/// Largest number of pieces of the initial set.
const MOST_PIECES: usize = 32;

/// Part of the horizon that a cheap method reaches in pieces before a higher order is tried.
const FAR: f64 = 0.6;

/// A flowpipe and the choice that gave it.
#[derive(Debug, Clone, PartialEq)]
pub struct AutomaticFlowpipe {
    /// The flowpipe on the grid that was requested.
    pub flowpipe: Flowpipe,
    /// The settings that were chosen.
    pub settings: FlowpipeSettings,
    /// Number of equal parts of each step of the grid over which the sets were propagated.
    pub parts: usize,
}

impl Flowpipe {
    /// Computes the flowpipe as [`new`](Self::new) does, with settings that are found by trial.
    ///
    /// Simulated solutions show how many parts of each step are needed. Linearisation comes first,
    /// then Taylor models of order 4 and of a higher order. Without uncertain input, a flowpipe
    /// much wider than the simulated solutions does not end the trials, and the tightest one is
    /// returned. Where none reaches the last sample, shorter parts are tried if a step is long, and
    /// at last more and more pieces of the initial set, along the state whose halves carry the
    /// flowpipe furthest. If they stop early too, the flowpipe that came furthest is returned.
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
        let simulated = simulated(system, grid, start, initial_set, input);
        let mut search = Search { system, grid, start, initial_set, input, simulated, best: None };
        search.try_methods()?;
        if !search.is_reached() {
            search.try_pieces()?;
        }
        Ok(search.best.expect("there is an attempt").0)
    }
}

/// The trials of one flowpipe.
struct Search<'a> {
    system: &'a PolynomialSystem,
    grid: &'a TimeGrid,
    start: &'a [f64],
    initial_set: &'a Hyperrectangle,
    input: &'a UncertainInput<'a>,
    simulated: Option<Simulated>,
    /// The best flowpipe so far, and its width relative to simulated solutions.
    best: Option<(AutomaticFlowpipe, f64)>,
}

impl Search<'_> {
    /// Tries all methods, on shorter and shorter parts of steps if these are long, until a flowpipe
    /// reaches the last sample.
    fn try_methods(&mut self) -> Result<(), ReachError> {
        let parts = match &self.simulated {
            Some(simulated) if simulated.bend <= BEND[0] => vec![1],
            Some(simulated) => {
                let needed = (simulated.bend / BEND[1]).min(MOST_PARTS as f64) as usize;
                let needed = needed.next_power_of_two();
                vec![needed, 4 * needed]
            }
            None => vec![1, 4, 16],
        };
        for parts in parts {
            for method in methods(self.system) {
                let is_tight = |(_, ratio): &(_, f64)| *ratio <= TIGHT;
                if !self.best.as_ref().is_some_and(is_tight) {
                    let settings = FlowpipeSettings { method, ..FlowpipeSettings::default() };
                    self.attempt(&settings, parts)?;
                }
            }
            if self.is_reached() {
                break;
            }
        }
        Ok(())
    }

    /// Tries pieces along the state whose halves carry the flowpipe of a cheap method furthest,
    /// twice as many each time, and a higher order once the cheap method comes far.
    fn try_pieces(&mut self) -> Result<(), ReachError> {
        let (methods, parts) = (methods(self.system), self.choice().parts);
        let cheap = methods[methods.len().min(2) - 1];
        let last = *methods.last().expect("there is a method");
        // The state that is divided.
        let mut along = None;
        for state in 0..self.system.states() {
            if self.initial_set.radius[state] > 0.0 {
                let length = self.attempt(&self.in_pieces(cheap, state, 2), parts)?;
                along = along.max(Some((length, state)));
            }
        }
        let Some((mut length, along)) = along else { return Ok(()) };
        // The number of its pieces.
        let mut pieces = 2;
        while !self.is_reached() && pieces <= MOST_PIECES {
            let is_far = length as f64 > FAR * self.grid.len() as f64;
            if last != cheap && (is_far || 2 * pieces > MOST_PIECES) {
                self.attempt(&self.in_pieces(last, along, pieces), parts)?;
            }
            pieces *= 2;
            if !self.is_reached() && pieces <= MOST_PIECES {
                length = self.attempt(&self.in_pieces(cheap, along, pieces), parts)?;
            }
        }
        Ok(())
    }

    /// Returns the settings of a method with pieces along one state.
    fn in_pieces(&self, method: FlowpipeMethod, state: usize, count: usize) -> FlowpipeSettings {
        let mut pieces = vec![1; self.system.states()];
        pieces[state] = count;
        FlowpipeSettings { method, pieces, ..FlowpipeSettings::default() }
    }

    /// Computes a flowpipe and keeps it if it comes further than the best so far, or as far and
    /// tighter. Returns the number of its samples.
    fn attempt(&mut self, settings: &FlowpipeSettings, parts: usize) -> Result<usize, ReachError> {
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
        let (length, ratio) = (flowpipe.len(), self.ratio(&flowpipe));
        let is_better = |(best, least): &(AutomaticFlowpipe, f64)| {
            length > best.flowpipe.len() || ratio < *least
        };
        if self.best.as_ref().is_none_or(is_better) {
            let found = AutomaticFlowpipe { flowpipe, settings: settings.clone(), parts };
            self.best = Some((found, ratio));
        }
        Ok(length)
    }

    /// Returns the width of a flowpipe relative to simulated solutions: infinite if it stops early,
    /// 1 if the solutions do not show how tight it is or no other method could be tighter.
    fn ratio(&self, flowpipe: &Flowpipe) -> f64 {
        let is_certain = self.input.set.radius.iter().all(|radius| *radius == 0.0);
        match &self.simulated {
            _ if !flowpipe.is_reached() => f64::INFINITY,
            Some(simulated) if is_certain && self.system.angles.states.is_empty() => {
                simulated.ratio(flowpipe)
            }
            _ => 1.0,
        }
    }

    fn is_reached(&self) -> bool {
        self.best.as_ref().is_some_and(|(best, _)| best.flowpipe.is_reached())
    }

    /// Returns the best flowpipe so far.
    fn choice(&self) -> &AutomaticFlowpipe {
        &self.best.as_ref().expect("there is an attempt").0
    }
}

/// Simulates solutions under the middle of the input.
fn simulated(
    system: &PolynomialSystem,
    grid: &TimeGrid,
    start: &[f64],
    initial_set: &Hyperrectangle,
    input: &UncertainInput<'_>,
) -> Option<Simulated> {
    let sides: Vec<_> = (0..system.states()).map(|i| side(start, initial_set, i)).collect();
    let steps = grid.len().saturating_sub(1) * system.inputs();
    let rows = input.measured[..steps].iter().zip(input.set.centre.iter().cycle());
    let inputs: Vec<f64> = rows.map(|(measured, centre)| measured + centre).collect();
    Simulated::new(system, grid, &sides, &inputs)
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
