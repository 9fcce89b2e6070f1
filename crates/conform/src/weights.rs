use crate::data::envelope::Envelope;
use crate::data::settings::Weights;

/// Returns the weight of each state in the cost, s, for these deviations.
pub(crate) fn state_weights(
    weights: &Weights,
    deviations: &[&Envelope],
    states: usize,
) -> Vec<f64> {
    match weights {
        Weights::Unit => vec![1.0; states],
        Weights::Given(weights) => weights.clone(),
        Weights::Spread => (0..states).map(|i| 1.0 / largest_deviation(deviations, i)).collect(),
    }
}

/// The largest |d| of state `i`; 1 where there is none.
fn largest_deviation(deviations: &[&Envelope], i: usize) -> f64 {
    let of = |envelope: &&Envelope| {
        (0..envelope.len())
            .map(|k| envelope.upper(k, i).max(-envelope.lower(k, i)))
            .fold(0.0, f64::max)
    };
    let largest = deviations.iter().map(of).fold(0.0, f64::max);
    if largest > 0.0 { largest } else { 1.0 }
}
