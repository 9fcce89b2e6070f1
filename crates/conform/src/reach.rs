//! Reachable sets of a model over recorded suites.

use std::io::{self, Write};

use reachtube_reach::{Flowpipe, ReachSets, StepBounds, StepRadii, Trajectory};
use reachtube_recordings::State;
use reachtube_scalar::rounding::{add_down, add_up};

use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::nominal::simulate::nominal;
use crate::sets::UncertaintySets;
use crate::tube::deviation::Nominal;
use crate::tube::grids::Grid;
use crate::tube::place::Place;
use crate::tube::strand::{Lost, Strand};
use crate::tube::tube::{Enclosure, Tube};

/// The reachable set over one suite, or over one run that has its own nominal motion.
#[derive(Debug, Clone)]
pub struct SuiteReach {
    /// The suite.
    pub suite: String,
    /// The run, where it has its own nominal motion.
    pub run: Option<String>,
    /// Sample times, s, K.
    pub times: Vec<f64>,
    /// The nominal motion, K x 2n.
    pub nominal: Vec<f64>,
    /// Lower bounds at samples, K x 2n.
    pub lower: Vec<f64>,
    /// Upper bounds at samples, K x 2n.
    pub upper: Vec<f64>,
    /// Bounds over each step between samples, (K - 1) x 2n.
    pub tube: StepBounds,
    /// Number of states 2n.
    pub dimension: usize,
    /// The early end of the set, if any: times end there.
    pub lost: Option<Lost>,
}

/// Computes the reachable sets over the recorded suites under the sets of `tube`, at samples and
/// between them.
///
/// # Guarantee
///
/// Outer, directed rounding: `lower` and `upper` enclose the reachable set of the state at each
/// sample, `tube` at every time of each step. The noise set is not part of it.
///
/// # Errors
///
/// As [`Problem::run`]; a model that diverges without any uncertainty.
pub fn reach(problem: &Problem, tube: &Tube) -> Result<Vec<SuiteReach>> {
    match tube.enclosure {
        Enclosure::Inner => linear(problem, tube),
        Enclosure::Outer => {
            let of_case = |(case, strand): (&Case, &Strand)| {
                let flowpipe = strand.flowpipe()?;
                let nominal = nominal(problem.nonlinear(), case);
                let lost = strand.lost.clone();
                let of = |nominal| SuiteReach::of_flowpipe(problem, case, nominal, flowpipe, lost);
                Some(nominal.map(of))
            };
            problem.cases()?.iter().zip(&tube.strands).filter_map(of_case).collect()
        }
    }
}

fn linear(problem: &Problem, tube: &Tube) -> Result<Vec<SuiteReach>> {
    let (grids, disturbance) = (problem.grids()?, problem.settings().disturbance);
    let places = problem.places()?;
    let along = |place: &Place| {
        let sets = tube.sets.along(&place.scale).into_owned();
        let propagation = &grids.as_slice()[place.grid].propagation;
        let UncertaintySets { initial_set, input_set, .. } = &sets;
        let radii = StepRadii::new(propagation, disturbance, initial_set, input_set);
        (radii, sets.input_set)
    };
    let along: Vec<_> = places.iter().map(along).collect();
    let reach: Vec<&ReachSets> = tube.strands.iter().filter_map(Strand::deviation).collect();
    let of_case = |case: Case| {
        let nominal = Nominal::new(grids, &case);
        let Grid { times, propagation, .. } = &grids.as_slice()[nominal.grid];
        let strand = problem.strand_of(&case, &nominal)?;
        let (reach, (radii, input_set)) = (reach[strand], &along[strand]);
        let Nominal { trajectory, .. } = nominal;
        let tube = StepBounds::new(propagation, &trajectory, &case.inputs, reach, input_set, radii);
        let times = times.times()[..trajectory.len()].to_vec();
        Ok(SuiteReach::new(problem, &case, times, &trajectory, reach, tube))
    };
    let suites = 0..problem.recordings().suites.len();
    let parts = suites.map(|suite| problem.cases_of(suite, of_case)).collect::<Result<Vec<_>>>()?;
    Ok(parts.into_iter().flatten().collect())
}

impl SuiteReach {
    fn new(
        problem: &Problem,
        case: &Case,
        times: Vec<f64>,
        trajectory: &Trajectory,
        reach: &ReachSets,
        tube: StepBounds,
    ) -> Self {
        let dimension = case.states();
        let (mut nominal, mut lower, mut upper) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..times.len() {
            for (i, x) in trajectory.state(k).iter().enumerate() {
                nominal.push(x.mid());
                lower.push(add_down(x.lo(), reach.lower_outer(k, i)));
                upper.push(add_up(x.hi(), reach.upper_outer(k, i)));
            }
        }
        let (suite, run) = names(problem, case);
        Self { suite, run, times, nominal, lower, upper, tube, dimension, lost: None }
    }

    /// Takes the reachable set as far as the flowpipe goes.
    fn of_flowpipe(
        problem: &Problem,
        case: &Case,
        mut nominal: Vec<f64>,
        flowpipe: &Flowpipe,
        lost: Option<Lost>,
    ) -> Self {
        let (dimension, samples) = (case.states(), flowpipe.len());
        nominal.truncate(samples * dimension);
        let hulls = || (0..samples).flat_map(|k| flowpipe.sample(k));
        let steps = (0..samples.saturating_sub(1)).flat_map(|k| flowpipe.step(k)).copied();
        let (suite, run) = names(problem, case);
        Self {
            suite,
            run,
            times: case.grid.times()[..samples].to_vec(),
            nominal,
            lower: hulls().map(|hull| hull.lo()).collect(),
            upper: hulls().map(|hull| hull.hi()).collect(),
            tube: StepBounds::from_boxes(dimension, steps.collect()),
            dimension,
            lost,
        }
    }

    /// Returns a name for files: the suite, and the run where it has its own nominal motion.
    #[must_use]
    pub fn name(&self) -> String {
        match &self.run {
            None => self.suite.clone(),
            Some(run) => {
                let stem = std::path::Path::new(run)
                    .file_stem()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned();
                format!("{}_{stem}", self.suite)
            }
        }
    }

    /// Writes the sets at samples as CSV: `t,q1_lower,q1_nominal,q1_upper,...`, one row
    /// per sample.
    ///
    /// # Errors
    ///
    /// Returns the errors of `out`.
    pub fn write_samples(&self, out: &mut dyn Write) -> io::Result<()> {
        let names =
            |kind: &str, i: usize| format!("{}_{kind}", State::from_index(i, self.dimension / 2));
        write!(out, "t")?;
        for i in 0..self.dimension {
            write!(out, ",{},{},{}", names("lower", i), names("nominal", i), names("upper", i))?;
        }
        writeln!(out)?;
        for (k, t) in self.times.iter().enumerate() {
            write!(out, "{t}")?;
            for at in k * self.dimension..(k + 1) * self.dimension {
                write!(out, ",{},{},{}", self.lower[at], self.nominal[at], self.upper[at])?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    /// Writes the tube as CSV: `t_from,t_to,q1_lower,q1_upper,...`, one row per step.
    ///
    /// # Errors
    ///
    /// Returns the errors of `out`.
    pub fn write_tube(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "t_from,t_to")?;
        for i in 0..self.dimension {
            let name = State::from_index(i, self.dimension / 2);
            write!(out, ",{name}_lower,{name}_upper")?;
        }
        writeln!(out)?;
        for k in 0..self.tube.len() {
            write!(out, "{},{}", self.times[k], self.times[k + 1])?;
            for bounds in self.tube.bounds(k) {
                write!(out, ",{},{}", bounds.lo(), bounds.hi())?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}

/// Returns the suite of a case, and its run where it has its own nominal motion.
fn names(problem: &Problem, case: &Case) -> (String, Option<String>) {
    let suite = problem.recordings().suites[case.suite].entry.name.clone();
    (suite, case.run.map(|index| problem.entry(index).file.clone()))
}
