//! Reachable sets of a user's own polynomial system.

use pyo3::prelude::*;
use reachtube::reach::{
    AutomaticFlowpipe, Flowpipe, FlowpipeMethod, FlowpipeOutcome, FlowpipeSettings, Hyperrectangle,
    PolynomialSystem, TimeGrid, UncertainInput,
};
use reachtube::scalar::{Interval, TaylorPolynomial, TaylorSpace, TaylorTerm};

use crate::arrays::{Input, Output, array, values};
use crate::failure::{Failure, Result};
use crate::watched::watched;

/// The terms of one component: exponents of (x, u, sines, cosines), and the coefficient.
type Terms = Vec<(Vec<u8>, f64)>;

/// Bounds at samples (lower, upper; K x N), over steps (lower, upper; K - 1 x N), where the
/// flowpipe ended early the time and the state, and the choice that gave it.
type Found<'py> = (Vec<Output<'py>>, Vec<Output<'py>>, Option<(f64, usize)>, Choice);

/// The order of Taylor models, the parts of each step, and the pieces along each state.
type Choice = (Option<u32>, usize, Vec<usize>);

fn system(
    states: usize,
    inputs: usize,
    angles: &[usize],
    terms: &[Terms],
) -> Result<PolynomialSystem> {
    let degree = |terms: &Terms| {
        terms.iter().map(|(exponents, _)| exponents.iter().map(|&e| u32::from(e)).sum()).max()
    };
    let order = terms.iter().filter_map(degree).max().unwrap_or(0u32).max(1);
    let variables = states + inputs + 2 * angles.len();
    let space = TaylorSpace::new(variables, order).map_err(Failure::setting)?;
    let component = |terms: &Terms| {
        let terms = terms.iter().map(|(exponents, coefficient)| TaylorTerm {
            exponents: exponents.clone(),
            coefficient: Interval::point(*coefficient),
        });
        TaylorPolynomial::from_terms(&space, terms)
    };
    let components: Vec<_> = terms.iter().map(component).collect();
    PolynomialSystem::trigonometric(states, inputs, angles, &components).map_err(Failure::setting)
}

/// Computes the flowpipe of ẋ = f(x, u) over the sample times. Where it is `automatic`, its
/// settings are found by trial.
#[pyfunction]
#[pyo3(signature = (
    inputs, angles, terms, times, centre, radius, measured, input_centre, input_radius, automatic,
    taylor, vertex_variables, order, pieces
))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn flowpipe<'py>(
    py: Python<'py>,
    inputs: usize,
    angles: Vec<usize>,
    terms: Vec<Terms>,
    times: Vec<f64>,
    centre: Vec<f64>,
    radius: Vec<f64>,
    measured: Input<'py>,
    input_centre: Vec<f64>,
    input_radius: Vec<f64>,
    automatic: bool,
    taylor: Option<u32>,
    vertex_variables: Option<usize>,
    order: Option<usize>,
    pieces: Vec<usize>,
) -> PyResult<Found<'py>> {
    let states = terms.len();
    let measured = values("measured", &measured, &[times.len(), inputs])
        .map_err(|failure| failure.raised(py))?;
    let defaults = FlowpipeSettings::default();
    let settings = FlowpipeSettings {
        method: taylor.map_or(defaults.method, |order| FlowpipeMethod::TaylorModels { order }),
        vertex_variables: vertex_variables.unwrap_or(defaults.vertex_variables),
        order: order.or(defaults.order),
        pieces,
    };
    let found = watched(py, None, move |_| {
        let system = system(states, inputs, &angles, &terms)?;
        let grid = TimeGrid::from_times(&times).map_err(Failure::setting)?;
        let initial = Hyperrectangle { centre: vec![0.0; states], radius };
        let set = Hyperrectangle { centre: input_centre, radius: input_radius };
        let input = UncertainInput { measured: &measured, set: &set };
        let found = if automatic {
            Flowpipe::automatic(&system, &grid, &centre, &initial, &input)
        } else {
            Flowpipe::new(&system, &grid, &centre, &initial, &input, &settings)
                .map(|flowpipe| AutomaticFlowpipe { flowpipe, settings, parts: 1 })
        };
        found.map_err(Failure::setting)
    })?;
    Ok(converted(py, &found, states))
}

/// Converts a flowpipe of a system with the given number of states.
fn converted<'py>(py: Python<'py>, found: &AutomaticFlowpipe, states: usize) -> Found<'py> {
    let AutomaticFlowpipe { flowpipe: found, settings, parts } = found;
    let order = match settings.method {
        FlowpipeMethod::TaylorModels { order } => Some(order),
        _ => None,
    };
    let samples = [found.len(), states];
    let steps = [found.len().saturating_sub(1), states];
    let bounds = |at: &dyn Fn(usize) -> Vec<Interval>, shape: [usize; 2]| {
        let all: Vec<Interval> = (0..shape[0]).flat_map(at).collect();
        [all.iter().map(|i| i.lo()).collect(), all.iter().map(|i| i.hi()).collect()]
            .map(|values| array(py, values, &shape))
            .into()
    };
    let ended = match found.outcome() {
        FlowpipeOutcome::Failed { time, state, .. } => Some((*time, *state)),
        _ => None,
    };
    (
        bounds(&|k| found.sample(k).to_vec(), samples),
        bounds(&|k| found.step(k).to_vec(), steps),
        ended,
        (order, *parts, settings.pieces.clone()),
    )
}
