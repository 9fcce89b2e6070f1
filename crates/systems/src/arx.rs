//! Systems whose factors are found: outputs by outputs and inputs of earlier samples.

use nalgebra::DMatrix;

use crate::description::{
    MatrixEntry, NamedSignal, NominalStartRule, SetDescription, SetDescriptions, ShapedSet,
    SimpleSet, SystemDescription, SystemKind,
};
use crate::error::{Error, Result};
use crate::identify::FreeNumbers;
use crate::make::MadeSystem;
use crate::model::RunsLeftOut;
use crate::run::SystemRun;
use crate::system::OutputSystem;

/// The highest order that is tried.
const MOST_ORDER: usize = 4;

/// The longest delay that is tried, in steps.
const MOST_DELAY: usize = 4;

/// Number of samples of all recordings by which an order is chosen: the first ones of each.
const SAMPLES_TO_CHOOSE: usize = 20_000;

/// Widths no larger than this many times the least ones are nearly as good.
const NEARLY: f64 = 1.1;

/// An order: how many outputs and inputs of earlier samples count, and after how many steps an
/// input acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Order {
    order: usize,
    delay: usize,
}

impl Order {
    /// Returns the number of inputs before the sample that count as states.
    fn past_inputs(self) -> usize {
        (self.delay + self.order).saturating_sub(2)
    }
}

/// Finds factors and sets of the order that needs the narrowest sets for recordings that are left
/// out; the lowest one that is nearly as good.
pub(crate) fn conform(system: &OutputSystem, runs: &[SystemRun]) -> Result<MadeSystem> {
    let has_inputs = !system.description.inputs.is_empty();
    let longest = if has_inputs { MOST_DELAY } else { 1 };
    let orders =
        (1..=MOST_ORDER).flat_map(|order| (1..=longest).map(move |delay| Order { order, delay }));
    let needed = 2 * (MOST_ORDER + longest);
    if let Some(short) = runs.iter().find(|run| run.len() < needed) {
        return Err(Error::Short { run: short.name.clone(), samples: short.len(), needed });
    }
    runs.iter().try_for_each(|run| system.step_of(run).map(|_| ()))?;
    // Every second recording judges an order by the others.
    let has_halves = runs.len() > 1;
    let most = (SAMPLES_TO_CHOOSE / runs.len()).max(2 * needed);
    let short: Vec<SystemRun> = runs.iter().map(|run| run.before(most)).collect();
    let of_half = |order: Order, runs: &[SystemRun]| {
        let half: Vec<SystemRun> = runs.iter().step_by(2).cloned().collect();
        let found = identified(system, if has_halves { &half } else { runs }, order)?;
        found.half_left_out(&found.with_past(runs).ok()?).ok()
    };
    let judged: Vec<(f64, Order)> =
        orders.filter_map(|order| Some((of_half(order, &short)?.1, order))).collect();
    let best = judged.iter().map(|(needed, ..)| *needed).fold(f64::INFINITY, f64::min);
    let simplest = judged.into_iter().find(|(needed, ..)| *needed <= NEARLY * best);
    let made = simplest.and_then(|(_, order)| {
        let left_out = if has_halves { of_half(order, runs)?.0 } else { RunsLeftOut::default() };
        let found = identified(system, runs, order)?;
        Some(found.with_past(runs).and_then(|runs| found.made(&runs, Some(left_out))))
    });
    made.transpose()?.ok_or_else(|| Error::System {
        file: None,
        problem: "no order fits the recordings: record longer motions of outputs and inputs".into(),
    })
}

/// Returns the system of the factors that explain outputs best over whole motions, from the
/// factors on that explain them best one step ahead; `None` where these are not determined.
fn identified(system: &OutputSystem, runs: &[SystemRun], order: Order) -> Option<OutputSystem> {
    let [m, p] = [system.description.inputs.len(), system.outputs()];
    let width = order.order * (p + m);
    let mut normal = DMatrix::<f64>::zeros(width, width);
    let mut right = DMatrix::<f64>::zeros(width, p);
    let mut row = vec![0.0; width];
    for run in runs {
        for k in order.delay + order.order - 1..run.len() {
            for lag in 0..order.order {
                let output = &run.outputs[(k - 1 - lag) * p..][..p];
                row[lag * p..][..p].copy_from_slice(output);
                let at = k - order.delay - lag;
                row[order.order * p + lag * m..][..m].copy_from_slice(&run.inputs[at * m..][..m]);
            }
            let target = &run.outputs[k * p..][..p];
            for (i, value) in row.iter().enumerate() {
                row.iter().enumerate().for_each(|(j, other)| normal[(i, j)] += value * other);
                target.iter().enumerate().for_each(|(j, other)| right[(i, j)] += value * other);
            }
        }
    }
    // Outputs and inputs of other sizes count alike.
    let size: Vec<f64> = (0..width).map(|j| f64::sqrt(normal[(j, j)])).collect();
    if size.contains(&0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(width, width, |i, j| normal[(i, j)] / size[i] / size[j]);
    let target = DMatrix::from_fn(width, p, |i, j| right[(i, j)] / size[i]);
    let found = scaled.svd(true, true).solve(&target, 1e-13).ok()?;
    let start: Vec<f64> = (0..p)
        .flat_map(|i| (0..width).map(move |j| (i, j)))
        .map(|(i, j)| found[(j, i)] / size[j])
        .collect();
    let of = |numbers: &[f64]| {
        let made = described(system, order, &|output, j| numbers[output * width + j]);
        let made = OutputSystem::new(made).ok()?;
        let past = made.with_past(runs).ok()?;
        Some((made, past))
    };
    let bounds = vec![[f64::NEG_INFINITY, f64::INFINITY]; start.len()];
    let free = FreeNumbers { bounds, system: &of, weights: system.weights(runs) };
    Some(of(&free.least_squares(&start))?.0)
}

/// Returns a system with the states y(k), y(k-1), .., u(k-1), u(k-2), ..
fn described(
    system: &OutputSystem,
    order: Order,
    factor: &dyn Fn(usize, usize) -> f64,
) -> SystemDescription {
    let [m, p] = [system.description.inputs.len(), system.outputs()];
    let (outputs, past) = (order.order, order.past_inputs());
    let n = outputs * p + past * m;
    let zero = MatrixEntry::Number(0.0);
    let (mut a, mut b) = (vec![vec![zero.clone(); n]; n], vec![vec![zero; m]; n]);
    for i in 0..p {
        for lag in 0..outputs {
            (0..p).for_each(|j| a[i][lag * p + j] = MatrixEntry::Number(factor(i, lag * p + j)));
            // The input u(k + 1 - delay - lag) is the state of delay + lag - 1 samples before.
            let before = order.delay + lag - 1;
            for j in 0..m {
                let value = MatrixEntry::Number(factor(i, outputs * p + lag * m + j));
                match before {
                    0 => b[i][j] = value,
                    _ => a[i][outputs * p + (before - 1) * m + j] = value,
                }
            }
        }
    }
    let one = MatrixEntry::Number(1.0);
    (p..outputs * p).for_each(|i| a[i][i - p] = one.clone());
    (0..m.min(past * m)).for_each(|j| b[outputs * p + j][j] = one.clone());
    (outputs * p + m..n).for_each(|i| a[i][i - m] = one.clone());
    let names = |signals: &[NamedSignal], from: usize, count: usize| -> Vec<NamedSignal> {
        let name = move |signal: &NamedSignal, lag: usize| {
            NamedSignal::Name(format!("{} {lag} before", signal.name()))
        };
        (from..from + count).flat_map(|lag| signals.iter().map(move |of| name(of, lag))).collect()
    };
    let description = &system.description;
    let states = [names(&description.outputs, 0, outputs), names(&description.inputs, 1, past)];
    let unit = |i: usize, width: usize| -> Vec<MatrixEntry> {
        (0..width).map(|j| MatrixEntry::Number(f64::from(u8::from(i == j)))).collect()
    };
    // Outputs of the past were seen with noise; inputs are known.
    let seen = (0..outputs * p).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect());
    let of_past = ShapedSet { generators: seen.collect(), ..ShapedSet::default() };
    let box_to_find = SetDescription::Simple(SimpleSet::Box);
    SystemDescription {
        kind: SystemKind::Discrete,
        states: states.concat(),
        a: Some(a),
        b: (m > 0).then_some(b),
        e: Some((0..n).map(|i| unit(i, p)).collect()),
        c: Some((0..p).map(|i| unit(i, n)).collect()),
        start: Some(NominalStartRule::Past { outputs, inputs: past }),
        sets: SetDescriptions {
            start: Some(SetDescription::Shaped(of_past)),
            noise: Some(description.sets.noise.clone().unwrap_or(box_to_find)),
            ..description.sets.clone()
        },
        ..description.clone()
    }
}

impl OutputSystem {
    /// Returns recordings from the first sample on whose past is known, which is their start. They
    /// are returned as they are for systems that start otherwise.
    pub(crate) fn with_past(&self, runs: &[SystemRun]) -> Result<Vec<SystemRun>> {
        let Some(NominalStartRule::Past { outputs, inputs }) = self.description.start else {
            return Ok(runs.to_vec());
        };
        let first = (outputs - 1).max(inputs);
        if let Some(short) = runs.iter().find(|run| run.len() < first + 2) {
            let (samples, needed) = (short.len(), first + 2);
            return Err(Error::Short { run: short.name.clone(), samples, needed });
        }
        let [m, p] = [self.description.inputs.len(), self.outputs()];
        let of = |run: &SystemRun| {
            let past = (0..outputs).flat_map(|lag| &run.outputs[(first - lag) * p..][..p]);
            let acted = (1..=inputs).flat_map(|lag| &run.inputs[(first - lag) * m..][..m]);
            let states = Some(past.chain(acted).copied().collect());
            SystemRun { states, ..run.after(first) }
        };
        Ok(runs.iter().map(of).collect())
    }
}
