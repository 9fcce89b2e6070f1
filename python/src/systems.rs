//! Systems that are no robot, seen through their outputs.

use pyo3::prelude::*;
use reachtube::systems::{OutputSystem, SystemDescription, SystemModel, SystemRun};
use reachtube_files::SealedFile;

use crate::arrays::{Input, Output, array};
use crate::failure::{Failure, Result};
use crate::watched::watched;

/// A recording: name, times (K), inputs (K x m), outputs (K x p), and the states at its start (N),
/// if they are known.
type Recorded<'py> = (String, Input<'py>, Input<'py>, Input<'py>, Option<Vec<f64>>);

/// A tube: nominal outputs, lower and upper bounds, K x p each.
type Tube<'py> = [Output<'py>; 3];

fn runs(recorded: Vec<Recorded<'_>>) -> Vec<SystemRun> {
    let numbers = |of: Input<'_>| of.as_array().iter().copied().collect();
    let run = |(name, times, inputs, outputs, states): Recorded<'_>| {
        SystemRun::of_numbers(name, numbers(times), numbers(inputs), numbers(outputs), states)
    };
    recorded.into_iter().map(run).collect()
}

fn described(description: &str) -> Result<OutputSystem> {
    let description: SystemDescription =
        serde_json::from_str(description).map_err(|error| Failure::json("the system", &error))?;
    Ok(OutputSystem::new(description)?)
}

/// Reads a system file; returns JSON.
#[pyfunction]
pub(crate) fn open_system(py: Python<'_>, path: &str) -> PyResult<String> {
    let system = OutputSystem::open(path.as_ref());
    let system = system.map_err(|error| Failure::from(error).raised(py))?;
    serde_json::to_string(system.description())
        .map_err(|error| Failure::json("the system", &error).raised(py))
}

/// Checks a description, in JSON.
#[pyfunction]
pub(crate) fn check_system(py: Python<'_>, description: &str) -> PyResult<()> {
    described(description).map(|_| ()).map_err(|failure| failure.raised(py))
}

/// Finds the smallest sets of a system; returns the model's file, and its findings and summary as
/// JSON.
#[pyfunction]
pub(crate) fn conform_system(
    py: Python<'_>,
    description: String,
    recorded: Vec<Recorded<'_>>,
) -> PyResult<(String, String)> {
    let runs = runs(recorded);
    let made = watched(py, None, move |_| Ok(described(&description)?.conform(&runs)?))?;
    let said = serde_json::json!({
        "findings": made.findings,
        "summary": made.summary().to_string(),
        "useful": made.is_useful(),
    });
    Ok((made.model.to_json(), said.to_string()))
}

/// Returns a model's file, and whether it is useful, as JSON.
fn sealed(model: &SystemModel) -> (String, String) {
    (model.to_json(), serde_json::json!({ "useful": model.is_useful() }).to_string())
}

/// Makes the model of a system whose sets are all given.
#[pyfunction]
pub(crate) fn given_system(py: Python<'_>, description: &str) -> PyResult<(String, String)> {
    let made = described(description).and_then(|system| Ok(SystemModel::given(&system)?));
    made.map(|model| sealed(&model)).map_err(|failure| failure.raised(py))
}

/// Reads the text of a model's file; errors name it `origin`. Returns the file, and whether it is
/// useful, as JSON.
#[pyfunction]
pub(crate) fn parse_system(py: Python<'_>, text: &str, origin: &str) -> PyResult<(String, String)> {
    let model = SystemModel::parse(text, origin.as_ref());
    model.map(|of| sealed(&of)).map_err(|error| Failure::from(error).raised(py))
}

/// Compares recordings with the model of a system; returns JSON.
#[pyfunction]
pub(crate) fn check_runs(
    py: Python<'_>,
    model: String,
    recorded: Vec<Recorded<'_>>,
) -> PyResult<String> {
    let runs = runs(recorded);
    let found = watched(py, None, move |_| {
        Ok(SystemModel::parse(&model, "the model".as_ref())?.check(&runs)?)
    })?;
    serde_json::to_string(&found).map_err(|error| Failure::json("the answer", &error).raised(py))
}

/// Computes the reachable outputs along recordings.
#[pyfunction]
pub(crate) fn reach_runs<'py>(
    py: Python<'py>,
    model: String,
    recorded: Vec<Recorded<'py>>,
) -> PyResult<Vec<Tube<'py>>> {
    let runs = runs(recorded);
    let (tubes, width) = watched(py, None, move |_| {
        let model = SystemModel::parse(&model, "the model".as_ref())?;
        Ok((model.reach(&runs)?, model.system.outputs.len()))
    })?;
    let converted = |values: Vec<f64>| {
        let shape = [values.len() / width, width];
        array(py, values, &shape)
    };
    let tube = |of: reachtube::systems::OutputTube| {
        let [low, high] = of.bounds;
        [of.nominal, low, high].map(converted)
    };
    Ok(tubes.into_iter().map(tube).collect())
}
