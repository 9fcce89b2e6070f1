use crate::data::case::Case;
use crate::data::problem::Problem;
use crate::error::Result;
use crate::nominal::simulate::nominal;
use crate::tube::deviation::Nominal;

/// How well the nominal motions alone reproduce the recordings, and how far these move.
#[derive(Debug, Clone)]
pub(crate) struct NominalFit {
    /// The part of each state's variance that the nominal motions explain, 2n: 1 minus the
    /// square of what they miss by the square of the motion about its mean. Below 0 where they are
    /// further away than the mean. `None` if the state hardly moves.
    pub explained: Vec<Option<f64>>,
    /// The recorded bounds of each state, 2n, rad and rad/s.
    pub recorded: Vec<[f64; 2]>,
    /// How far the first states lie from their nominal start at most, 2n, rad and rad/s.
    pub farthest_starts: Vec<f64>,
    /// The largest |u| of each part, n, N m.
    pub largest_input: Vec<f64>,
}

/// Sums over the samples of one case or several.
#[derive(Debug, Clone)]
struct Sums {
    /// Σ of the squared distance from the case's mean, 2n.
    motion: Vec<f64>,
    /// Σ of the squared distance from the nominal motion, 2n.
    missed: Vec<f64>,
    largest_input: Vec<f64>,
}

impl NominalFit {
    /// Compares the nominal motion of each case with the middle between its highest and its
    /// lowest recording.
    pub(crate) fn new(problem: &Problem) -> Result<Self> {
        let n = problem.inputs();
        let mut all = Sums::zero(n);
        for suite in 0..problem.recordings().suites.len() {
            let parts = problem.cases_of(suite, |case| Sums::new(problem, &case))?;
            parts.iter().for_each(|part| all.add(part));
        }
        let recorded: Vec<[f64; 2]> = (0..2 * n).map(|i| problem.recorded_bounds(i)).collect();
        let explained = |i: usize| {
            let [low, high] = recorded[i];
            let moves = high - low > 2.0 * problem.sensor_noise().radius[i] && all.motion[i] > 0.0;
            moves.then(|| 1.0 - all.missed[i] / all.motion[i])
        };
        let explained = (0..2 * n).map(explained).collect();
        let farthest_starts = problem.farthest_starts();
        Ok(Self { explained, recorded, farthest_starts, largest_input: all.largest_input })
    }
}

impl Sums {
    fn zero(parts: usize) -> Self {
        Self {
            motion: vec![0.0; 2 * parts],
            missed: vec![0.0; 2 * parts],
            largest_input: vec![0.0; parts],
        }
    }

    fn new(problem: &Problem, case: &Case) -> Result<Self> {
        let (n, measured) = (case.parts(), &case.measured);
        let solution = nominal_states(problem, case)?;
        let middle = |k: usize, i: usize| 0.5 * (measured.upper(k, i) + measured.lower(k, i));
        let mut sums = Self::zero(n);
        for i in 0..2 * n {
            let mean =
                (0..measured.len()).map(|k| middle(k, i)).sum::<f64>() / measured.len() as f64;
            for k in 0..measured.len() {
                sums.motion[i] += (middle(k, i) - mean).powi(2);
                sums.missed[i] += (middle(k, i) - solution[k * 2 * n + i]).powi(2);
            }
        }
        for inputs in case.inputs.chunks_exact(n) {
            let pairs = sums.largest_input.iter_mut().zip(inputs);
            pairs.for_each(|(largest, u)| *largest = largest.max(u.abs()));
        }
        Ok(sums)
    }

    fn add(&mut self, other: &Self) {
        let add = |sum: &mut Vec<f64>, part: &Vec<f64>| {
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        };
        add(&mut self.motion, &other.motion);
        add(&mut self.missed, &other.missed);
        let pairs = self.largest_input.iter_mut().zip(&other.largest_input);
        pairs.for_each(|(largest, u)| *largest = largest.max(*u));
    }
}

/// The nominal motion of a case, samples x 2n, to rounding.
fn nominal_states(problem: &Problem, case: &Case) -> Result<Vec<f64>> {
    if problem.dynamics().linear_system().is_none() {
        return nominal(problem.nonlinear(), case);
    }
    if case.run.is_some() {
        let Nominal { trajectory, .. } = Nominal::new(problem.grids()?, case);
        let states = (0..trajectory.len()).map(|k| trajectory.state(k));
        return Ok(states.flat_map(|x| x.iter().map(|x| x.mid())).collect());
    }
    // It lies between the recordings and the deviations, which are known.
    let own = problem.deviations()?.iter().find(|deviation| deviation.suite == case.suite);
    let deviations = &own.expect("each suite has deviations").envelope;
    let (measured, states) = (&case.measured, case.measured.dimension());
    let places = (0..measured.len()).flat_map(|k| (0..states).map(move |i| (k, i)));
    Ok(places.map(|(k, i)| measured.upper(k, i) - deviations.upper(k, i)).collect())
}
