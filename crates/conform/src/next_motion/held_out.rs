//! The bound for the next motion from motions that were held out of every choice.

use reachtube_scalar::number::{counted, two_digits_up};

use crate::next_motion::bounds::clopper_pearson;
use crate::next_motion::trust::CONFIDENCE;

/// Fewer motions bound nothing that is worth a sentence.
const FEWEST: usize = 2;

/// Returns what follows for the next motion, in a few words, from `motions` whole motions that took
/// part in no choice but the one of `models` models, and that the sets enclose once X0 and U are
/// `factor` times as wide. `motions` is `None` if motions are held out in part, `factor` if none
/// suffices.
///
/// The factor of the radii of X0 and U that a motion needs is its gauge. If the motions are
/// exchangeable, the next one has a larger gauge than all n held-out ones with probability at
/// most 1/(n + 1), on average over the draw of all n + 1, for one model; for the one of m that was
/// chosen, with probability at most m/(n + 1). For independent motions, given the held-out ones, it
/// has with the confidence 1 - β a larger gauge with probability at most p, where
/// (1 - p)ⁿ = β/m (docs/method.md, section 9).
#[must_use]
pub fn next_motion_of_held_out(
    motions: Option<usize>,
    factor: Option<f64>,
    models: usize,
) -> String {
    let motions = match motions {
        None => return "no guarantee: no whole motion was held out".into(),
        Some(few) if few < FEWEST => {
            return format!("no guarantee: {} held out is too few", counted(few, "motion"));
        }
        Some(motions) => motions,
    };
    let Some(factor) = factor else {
        return "no guarantee: no factor makes the sets enclose what was held out".into();
    };
    let (of, held_out) = (motions + 1, counted(motions, "motion"));
    if models > motions {
        return format!(
            "no guarantee: {held_out} held out are too few to choose one of the {models} models \
             that the file has had"
        );
    }
    let several = match models {
        1 => format!("{held_out} held out of every choice"),
        _ => format!("{held_out} held out; counts the {models} models that the file has had"),
    };
    let leaves = if models == 1 { "leaves" } else { "leave" };
    let sets = match factor {
        factor if factor <= 1.0 => "the sets".into(),
        factor => format!("X0 and U times {}", two_digits_up(factor)),
    };
    let beta = (1.0 - CONFIDENCE) / models as f64;
    let most = two_digits_up(100.0 * clopper_pearson(motions, 0, beta));
    format!(
        "at most {models} in {of} {leaves} {sets} on average, and at most {most} % at confidence \
         {:.0} % ({several})",
        100.0 * CONFIDENCE
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_counts_the_models_that_were_compared() {
        let bound = |motions, factor, models| next_motion_of_held_out(motions, factor, models);
        // 1 - 0.05^(1/5) = 0.4507.
        assert_eq!(
            bound(Some(5), Some(1.0), 1),
            "at most 1 in 6 leaves the sets on average, and at most 46 % at confidence 95 % (5 \
             motions held out of every choice)"
        );
        // 1 - 0.01^(1/5) = 0.6019.
        let several = bound(Some(5), Some(1.21), 5);
        assert!(
            several.starts_with("at most 5 in 6 leave X0 and U times 1.3 on average, "),
            "{several}"
        );
        assert!(
            several.contains("at most 61 % at confidence 95 % (5 motions held out; counts"),
            "{several}"
        );
        let none = [
            (Some(5), Some(1.0), 6),
            (Some(1), Some(1.0), 1),
            (None, Some(1.0), 1),
            (Some(5), None, 1),
        ];
        for (motions, factor, models) in none {
            let text = bound(motions, factor, models);
            assert!(text.starts_with("no guarantee: "), "{text}");
        }
    }
}
