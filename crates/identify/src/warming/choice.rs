use crate::held_out::gains;
use crate::warming::law_fit::{LawFit, Shape};
use crate::warming::rows::{FrictionRow, FrictionRows};
use rayon::prelude::*;
use reachtube_robot::friction::{Warming, WarmingBy};
use serde::Serialize;

/// Time constants of a thermal state that are tried \[runs\].
const TIME_CONSTANTS: [f64; 5] = [2.0, 4.0, 8.0, 16.0, 32.0];

/// Least spread of the temperatures that shows a law \[K\].
const MIN_SPREAD: f64 = 2.0;

/// Least number of different runs that shows a law.
const MIN_RUNS: usize = 3;

/// Laws by which friction falls while the joints warm up, as chosen by held-out recordings.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WarmingFit {
    /// What was held out in turn: "recordings", or "stretches" of few recordings.
    pub held_out_parts: &'static str,
    /// The laws that were compared.
    pub candidates: Vec<WarmingCandidate>,
    /// The chosen law of each joint; empty where nothing could be compared.
    pub joints: Vec<JointWarming>,
    /// Reason why a law could not be tried, one sentence each.
    pub reasons: Vec<String>,
}

/// A quantity on which friction may depend, compared over all joints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WarmingCandidate {
    /// The quantity.
    pub by: WarmingBy,
    /// Time constant of a thermal state \[runs\].
    pub time_constant: Option<f64>,
    /// Torque residual over held-out parts relative to the residual without a law, as root mean
    /// square over the joints. A joint that a law does not help counts as 1.
    pub held_out: f64,
}

/// The law of one joint.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointWarming {
    /// Name of the joint.
    pub joint: String,
    /// The law; `None` where no law predicts held-out parts better.
    pub law: Option<Warming>,
    /// Standard errors of the rates of Coulomb and viscous friction.
    pub standard_errors: [f64; 2],
    /// Root mean square of the torque residual over held-out parts \[N m\], without and with the
    /// law.
    pub held_out: [f64; 2],
    #[serde(skip)]
    pub(crate) shape: Option<Shape>,
}

impl WarmingFit {
    /// Returns the laws of the joints, n entries, or no entries if no joint has a law.
    pub(crate) fn laws(&self) -> Vec<Option<Warming>> {
        let laws: Vec<_> = self.joints.iter().map(|joint| joint.law).collect();
        if laws.iter().any(Option::is_some) { laws } else { vec![] }
    }

    /// Compares laws by holding out one part in turn; `rows` gives the rows for a quantity, or the
    /// reason why there are none.
    pub(crate) fn choose(
        names: &[&str],
        quantities: &[WarmingBy],
        rows: &dyn Fn(WarmingBy) -> Result<FrictionRows, String>,
    ) -> Self {
        let mut out = Self {
            held_out_parts: "recordings",
            candidates: vec![],
            joints: vec![],
            reasons: vec![],
        };
        let mut best = f64::INFINITY;
        for by in quantities {
            let rows = match rows(*by).and_then(|rows| varied(rows, *by)) {
                Ok(rows) => rows,
                Err(reason) => {
                    if !out.reasons.contains(&reason) {
                        out.reasons.push(reason);
                    }
                    continue;
                }
            };
            out.held_out_parts = if rows.by_recording { "recordings" } else { "stretches" };
            let thermal = *by == WarmingBy::Thermal;
            let constants: &[f64] = if thermal { &TIME_CONSTANTS } else { &[1.0] };
            for constant in constants {
                let time_constant = thermal.then_some(*constant);
                let law = Warming { by: *by, time_constant, ..Warming::default() };
                let law = Warming { reference: reference(&rows, *by), ..law };
                let joints: Vec<JointWarming> = names
                    .par_iter()
                    .zip(&rows.joints)
                    .map(|(name, parts)| JointWarming::choose(name, law, parts))
                    .collect();
                let held_out = relative(&joints);
                out.candidates.push(WarmingCandidate { by: *by, time_constant, held_out });
                if held_out < best {
                    (best, out.joints) = (held_out, joints);
                }
            }
        }
        out
    }

    /// Fits the chosen laws again to rows in which the rest of the robot was fitted with them.
    /// Returns whether a rate changed by more than a tenth of its standard error.
    pub(crate) fn refit(&mut self, rows: &FrictionRows) -> bool {
        let mut changed = false;
        for (joint, parts) in self.joints.iter_mut().zip(&rows.joints) {
            let (Some(law), Some(shape)) = (joint.law, joint.shape) else { continue };
            let Some(fit) = LawFit::new(shape, law, &parts.concat()) else { continue };
            let moves = |new: f64, old: f64, error: f64| (new - old).abs() > 0.1 * error;
            let [coulomb, viscous] = fit.standard_errors;
            changed |= moves(fit.law.coulomb, law.coulomb, coulomb)
                || moves(fit.law.viscous, law.viscous, viscous);
            (joint.law, joint.standard_errors) = (Some(fit.law), fit.standard_errors);
        }
        changed
    }
}

impl JointWarming {
    /// Chooses the shape of a law that predicts held-out parts best.
    fn choose(name: &str, law: Warming, parts: &[Vec<FrictionRow>]) -> Self {
        let count = parts.iter().map(Vec::len).sum::<usize>().max(1) as f64;
        let size = |squares: &[f64]| (squares.iter().sum::<f64>() / count).sqrt();
        let without = held_out(Shape::Constant, law, parts);
        let residual = without.as_deref().map_or(0.0, size);
        let mut best = Self {
            joint: name.into(),
            law: None,
            standard_errors: [0.0; 2],
            held_out: [residual; 2],
            shape: None,
        };
        let Some(without) = without else { return best };
        for shape in Shape::CHANGING {
            let Some(with) = held_out(shape, law, parts) else { continue };
            if gains(&without, &with)
                && size(&with) < best.held_out[1]
                && let Some(fit) = LawFit::new(shape, law, &parts.concat())
            {
                best.held_out[1] = size(&with);
                (best.law, best.shape) = (Some(fit.law), Some(shape));
                best.standard_errors = fit.standard_errors;
            }
        }
        best
    }
}

/// Returns the sum of squared residuals of each part under a law fitted to the others.
fn held_out(shape: Shape, law: Warming, parts: &[Vec<FrictionRow>]) -> Option<Vec<f64>> {
    let of_part = |at: usize| {
        let others = parts.iter().enumerate().filter(|(other, _)| *other != at);
        let others: Vec<FrictionRow> = others.flat_map(|(_, rows)| rows.iter().copied()).collect();
        let fit = LawFit::new(shape, law, &others)?;
        Some(parts[at].iter().map(|row| fit.residual(row).powi(2)).sum())
    };
    (0..parts.len()).map(of_part).collect()
}

/// Returns the residual of joints with a law relative to that without, as root mean square.
fn relative(joints: &[JointWarming]) -> f64 {
    let ratio = |joint: &JointWarming| match joint.held_out {
        [without, with] if without > 0.0 => (with / without).powi(2),
        _ => 1.0,
    };
    (joints.iter().map(ratio).sum::<f64>() / joints.len().max(1) as f64).sqrt()
}

/// Returns all values of the quantity.
fn values(rows: &FrictionRows) -> impl Iterator<Item = f64> {
    rows.joints.iter().flatten().flatten().map(|row| row.value)
}

/// Returns the rows if the quantity varies enough to show a law.
fn varied(rows: FrictionRows, by: WarmingBy) -> Result<FrictionRows, String> {
    if by != WarmingBy::Temperature {
        let runs: std::collections::BTreeSet<u64> = values(&rows).map(|run| run as u64).collect();
        return if runs.len() >= MIN_RUNS {
            Ok(rows)
        } else {
            let found = runs.len();
            Err(format!(
                "friction by the number of runs was not tried: the recordings are {found} \
                 different runs since the start, but {MIN_RUNS} are needed; give more recordings \
                 with `order`"
            ))
        };
    }
    let (low, high) = values(&rows)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)));
    if high - low >= MIN_SPREAD {
        return Ok(rows);
    }
    Err(format!(
        "friction by temperature was not tried: the temperatures lie between {low:.1} and \
         {high:.1} °C, but {MIN_SPREAD} K are needed to show a law; record colder or warmer"
    ))
}

/// Returns the reference of a law: the mean temperature to 0.1 °C, or the geometric mean run.
fn reference(rows: &FrictionRows, by: WarmingBy) -> f64 {
    let count = values(rows).count().max(1) as f64;
    match by {
        WarmingBy::Temperature => (10.0 * values(rows).sum::<f64>() / count).round() / 10.0,
        _ => (values(rows).map(f64::ln).sum::<f64>() / count).exp().round().max(1.0),
    }
}
