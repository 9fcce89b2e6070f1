//! One suite under the sets of both halves of Table II, as Figs. 1, 2 and 4 show one.

use std::path::Path;

use reachtube_conform::settings::States;
use reachtube_conform::{
    Check, Conformance, Keep, Model, Problem, Setup, Silent, Tube, Verdict, reach,
};
use reachtube_finding::FrontEnd;
use reachtube_recordings::DataSet;

use super::table2::Found;
use crate::error::{Error, Result};
use reachtube_page::{Sources, SuiteFigure, suite_figures};

/// One suite with its recordings, its input, and the reachable sets of both cases of Table II.
#[derive(Debug, Clone)]
pub(crate) struct Exemplary {
    /// The recordings in the reachable set of the velocity conformant case; the second band is the
    /// set of the position conformant case.
    pub figure: SuiteFigure,
    /// The input of the first recording \[N m\], row-major samples x n.
    pub inputs: Vec<f64>,
    /// Number of suites of which one joint at least follows the order of the runs, and of all.
    pub drifting: [usize; 2],
}

impl Exemplary {
    /// Takes a suite of the recordings for which `found` holds the sets; if none is named, the one
    /// whose runs end furthest apart.
    ///
    /// # Errors
    ///
    /// [`Error::NoSuite`]; as [`Problem::read`] and [`reach`].
    pub(super) fn new(folder: &Path, found: &Found, suite: Option<&str>) -> Result<Self> {
        let name = match suite {
            Some(name) => name.to_string(),
            None => furthest_apart(&found.problem).ok_or(Error::NoSuite)?,
        };
        let of_case = |states: States| {
            let case = found.cases.iter().find(|case| case.states() == states);
            let case = case.expect("both cases were found");
            suite_under(folder, &name, case.setup.clone(), &case.found)
        };
        let (mut figure, inputs) = of_case(States::All)?;
        figure.band.label = VELOCITY.into();
        let mut inner = of_case(States::Positions)?.0.band;
        inner.label = POSITION.into();
        figure.inner = Some(inner);
        figure.tight.clear();
        let all = &found.cases[0].found.trends;
        let mut suites: Vec<&str> = all.iter().map(|trend| trend.suite.as_str()).collect();
        suites.dedup();
        let drifting = [suites.len(), found.problem.recordings().suites.len()];
        Ok(Self { figure, inputs, drifting })
    }

    pub(crate) fn joints(&self) -> usize {
        self.figure.joints.len()
    }

    pub(crate) fn widest_joint(&self) -> usize {
        let wider = |a: &usize, b: &usize| self.spread(*a).total_cmp(&self.spread(*b));
        (0..self.joints()).max_by(wider).unwrap_or(0)
    }

    /// Returns how far the runs lie apart in a state at most, at one sample, rad or rad/s.
    pub(crate) fn spread(&self, state: usize) -> f64 {
        let samples = self.figure.runs.iter().map(|run| run.times.len()).max().unwrap_or(0);
        let at = |k: usize| {
            let values = self.figure.runs.iter().filter_map(|run| run.states[state].get(k));
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(*x), high.max(*x))
            });
            high - low
        };
        (0..samples).map(at).fold(0.0, f64::max)
    }

    /// Returns the largest width of the reachable set in a state, of the velocity conformant case
    /// and of the position conformant one, rad or rad/s.
    pub(crate) fn widths(&self, state: usize) -> [f64; 2] {
        let SuiteFigure { band, inner, .. } = &self.figure;
        [Some(band), inner.as_ref()].map(|band| {
            let edges = band.map(|band| band.lower[state].iter().zip(&band.upper[state]));
            edges.into_iter().flatten().map(|(low, high)| high - low).fold(0.0, f64::max)
        })
    }
}

const VELOCITY: &str = "reachable set, position and velocity conformant";
const POSITION: &str = "reachable set, position conformant";

/// Spread below which a joint counts as one that does not spread \[rad\].
const LEAST_SPREAD: f64 = 0.01;

/// Returns the suite whose runs' positions end furthest apart in all joints, by the product over
/// the joints, among suites with two samples or more.
fn furthest_apart(problem: &Problem) -> Option<String> {
    let suites = problem.recordings().suites.iter().filter(|suite| suite.envelope.len() > 1);
    let spread = |suite: &reachtube_conform::data::Suite| {
        let last = suite.envelope.len() - 1;
        let width = |i: usize| suite.envelope.upper(last, i) - suite.envelope.lower(last, i);
        (0..problem.inputs()).map(|i| (width(i) + LEAST_SPREAD).ln()).sum::<f64>()
    };
    let widest = suites.max_by(|a, b| spread(a).total_cmp(&spread(b)))?;
    Some(widest.entry.name.clone())
}

/// Returns a suite in its reachable set under sets that were found, and the input of its first run.
fn suite_under(
    folder: &Path,
    name: &str,
    setup: Setup,
    found: &Conformance,
) -> Result<(SuiteFigure, Vec<f64>)> {
    let source = Box::new(DataSet::open(folder)?);
    let problem = Problem::read(setup, source, &[name.into()], Keep::All, &Silent)?;
    let tube = Tube::new(&problem, found.sets.clone())?;
    let sets = reach(&problem, &tube)?;
    let model = Model::new(&problem, found);
    let verdict = Verdict::new(&problem, &tube)?;
    let check = Check::new(&model, &problem, verdict);
    let figure = suite_figures(&Sources {
        model: &model,
        problem: &problem,
        reach: &sets,
        check: &check,
        front_end: FrontEnd::CommandLine,
    })?
    .pop();
    let figure = figure.ok_or(Error::NoSuite)?;
    let first = problem.recordings().suites[0].runs[0].index;
    let run = problem.run(first)?;
    let inputs = (0..run.len()).flat_map(|k| run.torque(k).to_vec()).collect();
    Ok((figure, inputs))
}

#[cfg(test)]
mod tests {
    use reachtube_robot::Robot;

    use super::super::table2::Table2Options;
    use super::*;
    use crate::campaign::{CampaignOptions, record};
    use crate::virtual_robot::VirtualRobotParameters;

    /// Returns the suites in which a joint follows the order of the runs, and all suites.
    fn drifting(robot: VirtualRobotParameters) -> [usize; 2] {
        let folder = tempfile::tempdir().unwrap();
        let few =
            CampaignOptions { motions: 1, runs: 12, longest: 0.8, robot, ..Default::default() };
        let options = few.suites_only();
        record(&Robot::lwa4p(), &options, folder.path(), &|_, _| ()).unwrap();
        let found = Found::new(folder.path(), &Table2Options::default(), &Silent).unwrap();
        Exemplary::new(folder.path(), &found, None).unwrap().drifting
    }

    #[test]
    fn final_positions_follow_the_order_of_the_runs_only_if_the_arm_warms_up() {
        let warm = VirtualRobotParameters::default();
        let constant =
            VirtualRobotParameters { coulomb_rate: 0.0, viscous_rate: 0.0, ..warm.clone() };
        let [follow, suites] = drifting(warm);
        assert!(suites == 4 && 2 * follow > suites, "{follow} of {suites}");
        let [follow, suites] = drifting(constant);
        assert!(suites == 4 && 2 * follow < suites, "{follow} of {suites}");
    }
}
