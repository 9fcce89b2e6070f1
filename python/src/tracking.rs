//! Arms under their controllers: how far they stray from their commands.

use pyo3::prelude::*;
use reachtube::export::Paddings;
use reachtube::tracking::{Plan, TrackedRun, TrackingModel, make};
use reachtube_files::SealedFile;

use crate::arrays::{Input, Output, array};
use crate::failure::{Failure, Result};
use crate::watched::watched;

/// A recording: name, times (K), commanded and actual positions (K x n).
type Followed<'py> = (String, Input<'py>, Input<'py>, Input<'py>);

/// Joints, each with its name and its unit: rad, or m.
type Joints = Vec<(String, String)>;

fn numbers(of: &Input<'_>) -> Vec<f64> {
    of.as_array().iter().copied().collect()
}

fn names_and_units(joints: &Joints) -> (Vec<String>, Vec<&'static str>) {
    let unit =
        |(name, unit): &(String, String)| (name.clone(), if unit == "m" { "m" } else { "rad" });
    joints.iter().map(unit).unzip()
}

fn runs(joints: &Joints, followed: &[Followed<'_>]) -> Vec<TrackedRun> {
    let run = |(name, times, command, actual): &Followed<'_>| {
        let (joints, units) = names_and_units(joints);
        let numbers = [times, command, actual].map(numbers);
        TrackedRun::of_numbers(name, (joints, units), numbers)
    };
    followed.iter().map(run).collect()
}

fn parsed(model: &str) -> Result<TrackingModel> {
    Ok(TrackingModel::parse(model, "the model".as_ref())?)
}

/// Makes a model; returns its file, and its findings and summary as JSON.
#[pyfunction]
pub(crate) fn make_tracking(
    py: Python<'_>,
    joints: Joints,
    followed: Vec<Followed<'_>>,
) -> PyResult<(String, String)> {
    let runs = runs(&joints, &followed);
    let made = watched(py, None, move |_| Ok(make(&runs, None)?))?;
    let said = serde_json::json!({
        "findings": made.findings,
        "summary": made.summary().to_string(),
        "useful": made.is_useful(),
    });
    Ok((made.model.to_json(), said.to_string()))
}

/// Reads the text of a model's file; errors name it `origin`. Returns the file, and whether it is
/// useful, as JSON.
#[pyfunction]
pub(crate) fn parse_tracking(
    py: Python<'_>,
    text: &str,
    origin: &str,
) -> PyResult<(String, String)> {
    let model = TrackingModel::parse(text, origin.as_ref());
    let model = model.map_err(|error| Failure::from(error).raised(py))?;
    Ok((model.to_json(), serde_json::json!({ "useful": model.is_useful() }).to_string()))
}

/// Compares recordings with a model; returns JSON.
#[pyfunction]
pub(crate) fn check_tracking(
    py: Python<'_>,
    model: String,
    joints: Joints,
    followed: Vec<Followed<'_>>,
) -> PyResult<String> {
    let runs = runs(&joints, &followed);
    let found = watched(py, None, move |_| Ok(parsed(&model)?.check(&runs)?))?;
    serde_json::to_string(&found).map_err(|error| Failure::json("the answer", &error).raised(py))
}

/// Returns lower and upper bounds of the positions at the samples of a plan.
#[pyfunction]
pub(crate) fn plan_tube<'py>(
    py: Python<'py>,
    model: String,
    times: Input<'py>,
    command: Input<'py>,
) -> PyResult<[Output<'py>; 2]> {
    let [times, command] = [&times, &command].map(numbers);
    let samples = times.len();
    let (tube, n) = watched(py, None, move |_| {
        let model = parsed(&model)?;
        let axes = model.axes();
        let joints = axes.iter().map(|axis| axis.name.clone()).collect();
        let units = axes.iter().map(|axis| axis.units[0]).collect();
        let plan = Plan { file: "the plan".into(), joints, units, times, command };
        Ok((model.tube(&plan)?, model.joints.len()))
    })?;
    Ok([tube.lower, tube.upper].map(|values| array(py, values, &[samples, n])))
}

/// Returns for each joint the tolerance along a trajectory, and at its goal.
#[pyfunction]
pub(crate) fn tolerances(py: Python<'_>, model: &str) -> PyResult<Vec<(String, f64, f64)>> {
    let model = parsed(model).map_err(|failure| failure.raised(py))?;
    let of_joints = model.joints.iter().map(|joint| {
        let [at_rest, along] = joint.largest_deviations([model.delay, model.step]);
        (joint.name.clone(), along, at_rest)
    });
    Ok(of_joints.collect())
}

/// Returns for each link of a URDF how far it can be from the path of a plan, and from its place at
/// the same time, m.
#[pyfunction]
pub(crate) fn paddings(
    py: Python<'_>,
    model: &str,
    urdf: &str,
    part: f64,
) -> PyResult<Vec<(String, f64, f64)>> {
    let found = parsed(model).and_then(|model| Ok(Paddings::new(&model, urdf.as_ref(), part)?));
    let found = found.map_err(|failure| failure.raised(py))?;
    let links = found.links.into_iter();
    Ok(links.map(|of| (of.link, of.along_the_path, of.at_the_same_time)).collect())
}
