//! What recordings need of the sets, sample by sample.

use nalgebra::DMatrix;
use reachtube_conform::data::Envelope;
use reachtube_conform::outputs::{OutputRows, SmallestSets, smallest};
use reachtube_conform::settings::Centre;
use reachtube_reach::OutputGains;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_down, add_up, sub_up};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::form::ScaledSet;
use crate::motion::NominalMotions;
use crate::system::OutputSystem;

/// How often factors are raised for rounding at most.
const RAISES: usize = 20;

/// The sets of a system.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SystemSets {
    /// X0, around the nominal start.
    #[serde(rename = "X0")]
    pub start: ScaledSet,
    /// W, which acts through E and is constant over each step.
    #[serde(rename = "W")]
    pub disturbance: ScaledSet,
    /// V, which is seen through F.
    #[serde(rename = "V")]
    pub noise: ScaledSet,
}

impl SystemSets {
    fn all(&self) -> [&ScaledSet; 3] {
        [&self.start, &self.disturbance, &self.noise]
    }
}

/// The smallest sets of some recordings.
#[derive(Debug, Clone)]
pub(crate) struct FoundSets {
    pub sets: SystemSets,
    /// The integral over time of the widths of the outputs, each times its weight.
    pub cost: f64,
    /// No sets cost less, to the tolerance of the solver.
    pub lower_bound: f64,
    /// Whether the sets were proved to hold the recordings.
    pub is_proved: bool,
}

/// The hull of what a system reaches at one sample of one output, without the nominal motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OutputHull {
    pub centre: Interval,
    pub radius: Interval,
}

impl OutputHull {
    /// Returns how far a deviation lies beyond the hull, above and below; no more than 0 inside.
    ///
    /// # Guarantee
    ///
    /// Upper bounds for the hull taken from inside; directed rounding.
    pub(crate) fn excess(&self, deviation: Interval) -> f64 {
        let upper = add_down(self.centre.lo(), self.radius.lo());
        let lower = sub_up(self.centre.hi(), self.radius.lo());
        let [above, below] = [sub_up(deviation.hi(), upper), sub_up(lower, deviation.lo())];
        // A difference that is not a number proves nothing.
        if above.is_nan() || below.is_nan() { f64::INFINITY } else { above.max(below) }
    }

    /// Returns the part of the radius that a deviation needs, apart from rounding; 0 where that is
    /// nothing.
    pub(crate) fn needed(&self, deviation: Interval) -> f64 {
        let off = (deviation - self.centre).mig();
        if off == 0.0 { 0.0 } else { off / self.radius.lo() }
    }
}

/// What recordings need of the sets of a system.
#[derive(Debug)]
pub(crate) struct SetRows<'a> {
    pub system: &'a OutputSystem,
    pub motions: &'a NominalMotions,
    /// For each time between samples, what outputs have of the generators.
    gains: Vec<OutputGains>,
    /// |F v| of each generator of V, p x their number.
    noise: DMatrix<Interval>,
}

impl<'a> SetRows<'a> {
    pub(crate) fn new(system: &'a OutputSystem, motions: &'a NominalMotions) -> Self {
        let [start, disturbance, noise] = &system.forms;
        // The generators of W act on the last inputs of a solution.
        let of = |of: &crate::motion::StepSolutions| {
            let inputs = of.propagation.system().inputs();
            let mut acting = DMatrix::zeros(inputs, disturbance.generators.ncols());
            let rows = disturbance.generators.nrows();
            acting.rows_mut(inputs - rows, rows).copy_from(&disturbance.generators);
            of.propagation.output_gains(&system.c, &start.generators, &acting)
        };
        let point = |matrix: &DMatrix<f64>| matrix.map(Interval::point);
        let noise = (point(&system.f) * point(&noise.generators)).map(|x| x.abs());
        Self { system, motions, gains: motions.solutions.iter().map(of).collect(), noise }
    }

    /// Returns the hull that sets give output `i` at sample `k`.
    ///
    /// # Guarantee
    ///
    /// Centre and radius of the exact hull are enclosed, directed rounding.
    pub(crate) fn hull(&self, step: usize, k: usize, i: usize, sets: &SystemSets) -> OutputHull {
        let OutputGains { start, constant, changing } = &self.gains[step];
        let [of_start, of_disturbance, of_noise] = sets.all();
        let sum = |gains: &DMatrix<Interval>, numbers: &[f64], is_radius: bool| {
            let numbers = numbers.iter().enumerate().filter(|(_, number)| **number != 0.0);
            numbers.fold(Interval::ZERO, |sum, (j, number)| {
                let gain = gains[(i, j)];
                plus(sum, (if is_radius { gain.abs() } else { gain }) * *number)
            })
        };
        let centre = |at: usize, gains, set: &ScaledSet| match self.system.forms[at].is_box {
            true => sum(gains, &set.centre, false),
            false => Interval::ZERO,
        };
        OutputHull {
            centre: plus(centre(0, &start[k], of_start), centre(1, &constant[k], of_disturbance)),
            radius: plus(
                sum(&start[k], &of_start.scale, true),
                plus(
                    sum(&changing[k], &of_disturbance.scale, true),
                    sum(&self.noise, &of_noise.scale, true),
                ),
            ),
        }
    }

    /// Returns the envelope of the deviations of some recordings, for each time between samples.
    fn envelopes(&self, runs: &[usize]) -> Vec<Envelope> {
        let p = self.system.outputs();
        let mut all = vec![Envelope::new(p); self.gains.len()];
        for run in runs {
            let own = &self.motions.deviations[*run];
            let end = |of: fn(Interval) -> f64| -> Vec<f64> {
                own.outputs.iter().map(|x| of(*x)).collect()
            };
            let [lower, upper] = [end(Interval::lo), end(Interval::hi)];
            all[own.of_step].include_bounds(*run as u32, &lower, &upper);
        }
        all
    }

    /// Returns the number of factors of X0 and of W with V, which the program finds.
    fn unknowns(&self) -> [usize; 2] {
        let [start, disturbance, noise] = &self.system.forms;
        [start.factors, disturbance.factors + noise.factors]
    }

    /// Returns how far an output moves with each centre, and widens with each factor, at sample
    /// `k`, in the order of the program.
    fn coefficients(&self, step: usize, k: usize, i: usize) -> [Vec<f64>; 2] {
        let OutputGains { start, constant, changing } = &self.gains[step];
        let [of_start, of_disturbance, of_noise] = &self.system.forms;
        let (mut centres, mut radii) = (Vec::new(), Vec::new());
        let parts = [
            (of_start, Some(&start[k]), &start[k]),
            (of_disturbance, Some(&constant[k]), &changing[k]),
            (of_noise, None, &self.noise),
        ];
        for (form, moves, widens) in parts {
            let mut own = vec![0.0; form.factors];
            for (gain, factor) in widens.row(i).iter().zip(&form.factor) {
                factor.iter().for_each(|at| own[*at] += gain.abs().lo());
            }
            radii.extend(own);
            match moves.filter(|_| form.is_box) {
                Some(moves) => centres.extend(moves.row(i).iter().map(|gain| gain.mid())),
                None => centres.extend(std::iter::repeat_n(0.0, form.factors)),
            }
        }
        [centres, radii]
    }

    /// Returns the sets with these centres and factors.
    fn sets(&self, centre: [&[f64]; 2], factors: [&[f64]; 2]) -> SystemSets {
        let [start, disturbance, noise] = &self.system.forms;
        let (of_disturbance, of_noise) = factors[1].split_at(disturbance.factors);
        SystemSets {
            start: start.with(centre[0], factors[0]),
            disturbance: disturbance
                .with(&centre[1][..disturbance.factors.min(centre[1].len())], of_disturbance),
            noise: noise.with(&[], of_noise),
        }
    }

    /// Finds the smallest sets for some recordings, and proves that they hold them.
    ///
    /// # Errors
    ///
    /// [`Error::Unreached`], and a program that the solver gives up on.
    pub(crate) fn smallest(&self, runs: &[usize], weights: &[f64]) -> Result<FoundSets> {
        let envelopes = self.envelopes(runs);
        let [start, inputs] = self.unknowns();
        let zeros = |count: usize| vec![0.0; count];
        let nothing = self.sets([&zeros(start), &zeros(inputs)], [&zeros(start), &zeros(inputs)]);
        if start + inputs == 0 {
            let is_proved = self.first_outside(&nothing, &envelopes).is_none();
            return Ok(FoundSets { sets: nothing, cost: 0.0, lower_bound: 0.0, is_proved });
        }
        let rows = self.program_rows(&nothing, &envelopes)?;
        let is_centred = self.system.forms.iter().any(|form| form.is_box);
        let centre = if is_centred { Centre::Free } else { Centre::Zero };
        let SmallestSets { sets, cost, lower_bound } =
            smallest([start, inputs], centre, weights, rows)?;
        let of = [&sets.initial_set, &sets.input_set];
        let centres = of.map(|set| &set.centre[..]);
        let mut factors = of.map(|set| set.radius.clone());
        for _ in 0..RAISES {
            let sets = self.sets(centres, [&factors[0], &factors[1]]);
            if !self.raise(&sets, &envelopes, &mut factors) {
                return Ok(FoundSets { sets, cost, lower_bound, is_proved: true });
            }
        }
        let sets = self.sets(centres, [&factors[0], &factors[1]]);
        Ok(FoundSets { sets, cost, lower_bound, is_proved: false })
    }

    /// Returns the rows of the program: the deviations less what fixed sets reach.
    fn program_rows(&self, fixed: &SystemSets, envelopes: &[Envelope]) -> Result<Vec<OutputRows>> {
        let p = self.system.outputs();
        let mut rows = Vec::new();
        for (step, envelope) in envelopes.iter().enumerate().filter(|(_, of)| !of.is_empty()) {
            let mut coefficients = Vec::new();
            for (k, i) in (0..envelope.len()).flat_map(|k| (0..p).map(move |i| (k, i))) {
                let [centres, radii] = self.coefficients(step, k, i);
                let known = self.hull(step, k, i, fixed);
                let deviation = self.of_envelope(envelope, k, i);
                let off = known.excess(deviation);
                if off > 0.0 && radii.iter().all(|gain| *gain == 0.0) {
                    return Err(self.unreached(step, k, i, envelope, off));
                }
                coefficients.extend(centres.into_iter().chain(radii));
            }
            let radius = |k, i| self.hull(step, k, i, fixed).radius.lo();
            let times = self.motions.solutions[step].propagation.grid().times();
            rows.push(OutputRows {
                times: times[..envelope.len()].into(),
                coefficients,
                envelope: envelope.narrowed(radius),
            });
        }
        Ok(rows)
    }

    fn of_envelope(&self, envelope: &Envelope, k: usize, i: usize) -> Interval {
        Interval::new(envelope.lower(k, i), envelope.upper(k, i)).unwrap_or(Interval::ENTIRE)
    }

    fn unreached(&self, step: usize, k: usize, i: usize, envelope: &Envelope, off: f64) -> Error {
        let run = envelope.furthest_run(k, i);
        Error::Unreached {
            run: self.motions.deviations[run as usize].run.clone(),
            time: self.motions.solutions[step].propagation.grid().times()[k],
            output: self.system.description().outputs[i].name().into(),
            off,
        }
    }

    /// Returns the first sample and output that sets do not hold: the time between samples, the
    /// sample, and the output.
    fn first_outside(
        &self,
        sets: &SystemSets,
        envelopes: &[Envelope],
    ) -> Option<(usize, usize, usize)> {
        let mut rows = envelopes.iter().enumerate().flat_map(|(step, of)| {
            (0..of.len()).flat_map(move |k| (0..self.system.outputs()).map(move |i| (step, k, i)))
        });
        rows.find(|(step, k, i)| {
            let hull = self.hull(*step, *k, *i, sets);
            hull.excess(self.of_envelope(&envelopes[*step], *k, *i)) > 0.0
        })
    }

    /// Raises factors by what samples lie outside of the sets, which is rounding; returns whether
    /// some did.
    fn raise(
        &self,
        sets: &SystemSets,
        envelopes: &[Envelope],
        factors: &mut [Vec<f64>; 2],
    ) -> bool {
        let count = factors[0].len();
        let mut more = vec![0.0f64; count + factors[1].len()];
        let mut are_outside = false;
        for (step, envelope) in envelopes.iter().enumerate() {
            for (k, i) in
                (0..envelope.len()).flat_map(|k| (0..self.system.outputs()).map(move |i| (k, i)))
            {
                let excess = self.hull(step, k, i, sets).excess(self.of_envelope(envelope, k, i));
                if excess <= 0.0 {
                    continue;
                }
                are_outside = true;
                let [_, gains] = self.coefficients(step, k, i);
                // The factor that gives the most of the width there, or could.
                let now = factors.iter().flatten().zip(&gains).map(|(r, gain)| (r * gain, *gain));
                let best = now.enumerate().max_by(|a, b| {
                    let [a, b] = [a.1, b.1];
                    a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
                });
                let Some((at, (_, gain))) = best else { continue };
                more[at] = more[at].max(excess / gain);
            }
        }
        for (factor, more) in factors.iter_mut().flatten().zip(&more) {
            if *more > 0.0 && more.is_finite() {
                *factor = add_up(*factor * (1.0 + 1e-15), *more * (1.0 + 1e-9));
            }
        }
        are_outside
    }

    /// Returns, for each output, the mean difference of the highest and the lowest deviation of a
    /// sample.
    pub(crate) fn spread(&self) -> Vec<f64> {
        let all: Vec<usize> = (0..self.motions.deviations.len()).collect();
        let envelopes = self.envelopes(&all);
        let count: usize = envelopes.iter().map(Envelope::len).sum();
        let of = |i: usize| {
            let samples = envelopes.iter().flat_map(|of| (0..of.len()).map(move |k| (of, k)));
            samples.map(|(of, k)| of.upper(k, i) - of.lower(k, i)).sum::<f64>() / count as f64
        };
        (0..self.system.outputs()).map(of).collect()
    }

    /// Returns the widths of the outputs at each sample under some sets: for each time between
    /// samples, samples x p.
    pub(crate) fn widths(&self, sets: &SystemSets) -> Vec<Vec<f64>> {
        let of = |step: usize| {
            let count = self.motions.solutions[step].propagation.grid().len();
            let rows = (0..count).flat_map(|k| (0..self.system.outputs()).map(move |i| (k, i)));
            rows.map(|(k, i)| 2.0 * self.hull(step, k, i, sets).radius.hi()).collect()
        };
        (0..self.gains.len()).map(of).collect()
    }

    /// Returns, for a recording, the largest part of a set that a sample needs with its sample and
    /// output, and how many samples are not proved to lie in the sets.
    pub(crate) fn beside(&self, run: usize, sets: &SystemSets) -> (f64, [usize; 2], usize) {
        let (own, p) = (&self.motions.deviations[run], self.system.outputs());
        let mut found = (0.0, [0, 0], 0);
        for (at, deviation) in own.outputs.iter().enumerate() {
            let hull = self.hull(own.of_step, at / p, at % p, sets);
            found.2 += usize::from(hull.excess(*deviation) > 0.0);
            let needed = hull.needed(*deviation);
            if needed > found.0 {
                (found.0, found.1) = (needed, [at / p, at % p]);
            }
        }
        found
    }
}

/// Encloses a sum; exact where one is 0.
fn plus(x: Interval, y: Interval) -> Interval {
    match (x == Interval::ZERO, y == Interval::ZERO) {
        (true, _) => y,
        (_, true) => x,
        _ => x + y,
    }
}
