//! Reachable sets of an identified model over recorded suites.

use std::io::{self, Write};

use reachtube_reach::{Flowpipe, Hyperrectangle, LinearSystem, ReachSets, Tube, TubeRadii};
use reachtube_robot::Robot;
use reachtube_scalar::rounding::{add_down, add_up};

use crate::error::Result;
use crate::{
    Case, Dynamics, Effort, Grids, Lost, Recordings, RunNominal, Settings, UncertaintySets,
    flowpipes, lost, nominal, nominals,
};
use reachtube_recordings::{DataSet, state_name};

/// The reachable set over one suite, or over one run where the runs of a suite differ in input.
#[derive(Debug, Clone)]
pub struct SuiteReach {
    /// The suite.
    pub suite: String,
    /// The run, where it has its own nominal solution.
    pub run: Option<String>,
    /// Sample times, s, K.
    pub times: Vec<f64>,
    /// The nominal solution, K x 2n.
    pub nominal: Vec<f64>,
    /// Lower bounds at samples, K x 2n.
    pub lower: Vec<f64>,
    /// Upper bounds at samples, K x 2n.
    pub upper: Vec<f64>,
    /// Bounds over each step between samples, (K - 1) x 2n.
    pub tube: Tube,
    /// Number of states 2n.
    pub dimension: usize,
    /// Where the set could not be followed further, if so: times end there.
    pub lost: Option<Lost>,
}

/// The reachable sets over the suites of `recordings`.
///
/// # Guarantee
///
/// Outer, directed rounding: `lower` and `upper` enclose the reachable set of the state at each
/// sample, `tube` at every time of each step. The noise set is not part of it.
///
/// # Errors
///
/// Defects of a run that has changed since it was read; a model that runs away without any
/// uncertainty.
pub fn reach(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    dynamics: &Dynamics,
    sets: &UncertaintySets,
    recordings: &Recordings,
) -> Result<Vec<SuiteReach>> {
    match dynamics {
        Dynamics::Linear(system) => linear(data, robot, settings, system, sets, recordings),
        Dynamics::Polynomial(model) => {
            let cases = Case::all(data, robot, settings, recordings)?;
            let flowpipes = flowpipes(&model.polynomial_system()?, &cases, sets, Effort::Whole)?;
            let of_case = |(case, flowpipe): (&Case, Flowpipe)| {
                let nominal = nominal(model, case)?;
                let suite = recordings.suites[case.suite].entry.name.clone();
                Ok(SuiteReach::of_flowpipe(data, suite, case, nominal, &flowpipe))
            };
            cases.iter().zip(flowpipes).map(of_case).collect()
        }
    }
}

fn linear(
    data: &DataSet,
    robot: &Robot,
    settings: &Settings,
    system: &LinearSystem,
    sets: &UncertaintySets,
    recordings: &Recordings,
) -> Result<Vec<SuiteReach>> {
    let grids = Grids::new(recordings, system, settings.disturbance)?;
    let shared: Vec<(ReachSets, TubeRadii)> = grids
        .as_slice()
        .iter()
        .map(|grid| {
            let (x, u): (&Hyperrectangle, &Hyperrectangle) = (&sets.initial_set, &sets.input_set);
            (grid.reach(sets), TubeRadii::new(&grid.propagation, settings.disturbance, x, u))
        })
        .collect();
    let mut all = Vec::new();
    for suite in &recordings.suites {
        for nominal in nominals(data, robot, settings, &grids, suite)? {
            let (reach, radii) = &shared[nominal.grid];
            let propagation = &grids.as_slice()[nominal.grid].propagation;
            let tube = Tube::new(
                propagation,
                &nominal.trajectory,
                &nominal.inputs,
                reach,
                &sets.input_set,
                radii,
            );
            let run = nominal.run.map(|index| data.runs()[index].file.clone());
            let times = propagation.grid().times()[..nominal.trajectory.len()].to_vec();
            all.push(SuiteReach::new(suite.entry.name.clone(), run, times, &nominal, reach, tube));
        }
    }
    Ok(all)
}

impl SuiteReach {
    fn new(
        suite: String,
        run: Option<String>,
        times: Vec<f64>,
        nominal: &RunNominal,
        reach: &ReachSets,
        tube: Tube,
    ) -> Self {
        let dimension = nominal.trajectory.state(0).len();
        let (nominals, lower, upper) = (Vec::new(), Vec::new(), Vec::new());
        let mut result = Self {
            suite,
            run,
            times,
            nominal: nominals,
            lower,
            upper,
            tube,
            dimension,
            lost: None,
        };
        for k in 0..result.times.len() {
            for (i, x) in nominal.trajectory.state(k).iter().enumerate() {
                result.nominal.push(x.mid());
                result.lower.push(add_down(x.lo(), reach.lower_outer(k, i)));
                result.upper.push(add_up(x.hi(), reach.upper_outer(k, i)));
            }
        }
        result
    }

    /// Up to where the flowpipe goes.
    fn of_flowpipe(
        data: &DataSet,
        suite: String,
        case: &Case,
        mut nominal: Vec<f64>,
        flowpipe: &Flowpipe,
    ) -> Self {
        let (dimension, samples) = (2 * case.joints(), flowpipe.len());
        nominal.truncate(samples * dimension);
        let hulls = || (0..samples).flat_map(|k| flowpipe.sample(k));
        let steps =
            (0..samples.saturating_sub(1)).flat_map(|k| flowpipe.step(k)).copied().collect();
        Self {
            suite,
            run: case.run.map(|index| data.runs()[index].file.clone()),
            times: case.grid.times()[..samples].to_vec(),
            nominal,
            lower: hulls().map(|hull| hull.lo()).collect(),
            upper: hulls().map(|hull| hull.hi()).collect(),
            tube: Tube::from_boxes(dimension, steps),
            dimension,
            lost: lost(case, flowpipe),
        }
    }

    /// A name for files: the suite, and the run where it has its own nominal solution.
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

    /// Writes the sets at samples as CSV: `t,q1_lower,q1_nominal,q1_upper,...`, a row a sample.
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_samples(&self, out: &mut dyn Write) -> io::Result<()> {
        let names = |kind: &str, i: usize| format!("{}_{kind}", state_name(i, self.dimension / 2));
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

    /// Writes the tube as CSV: `t_from,t_to,q1_lower,q1_upper,...`, a row a step.
    ///
    /// # Errors
    ///
    /// Those of `out`.
    pub fn write_tube(&self, out: &mut dyn Write) -> io::Result<()> {
        write!(out, "t_from,t_to")?;
        for i in 0..self.dimension {
            let name = state_name(i, self.dimension / 2);
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
