//! Conformance of models that are not linear.

mod case;
mod extremal;
mod outer;
mod search;
mod sensitivity;

pub use case::Case;

use crate::abstraction::PolynomialModel;
use crate::conform::{Recordings, Settings};
use crate::data::DataSet;
use crate::error::Result;
use reachtube_robot::Robot;

#[doc(hidden)]
pub fn experiment(robot: &Robot, data: &DataSet, names: &[String], settings: &Settings) -> Result<()> {
    let recordings = Recordings::read(data, names, robot, settings, &|_, _| {})?;
    let a = settings.abstraction;
    let model = PolynomialModel::new(robot, a.model, a.order, &settings.expansion_point)?;
    let system = model.polynomial_system()?;
    let cases = Case::all(data, robot, settings, &recordings)?;
    let n = robot.joint_count();
    let search = search::Search { model: &model, system: &system, cases: &cases, settings, weights: vec![1.0; 2 * n] };
    let t = std::time::Instant::now();
    let found = search.run(search::Progress::start(n), &mut |_, words| {
        eprintln!("{:?} {words}", t.elapsed());
        Ok(())
    })?;
    eprintln!("{:?} {:?} {:?}", found.progress.sets, found.round.runs_away, t.elapsed());
    for (case, flowpipe) in cases.iter().zip(&found.flowpipes) {
        eprintln!("{} {:?}", case.name, outer::lost(flowpipe));
    }
    eprintln!("{:?}", outer::sums(&cases, &found.flowpipes, &found.progress.sets, &search.weights));
    Ok(())
}
