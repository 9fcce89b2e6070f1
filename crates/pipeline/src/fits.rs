//! Whether fitting the nominal model pays on motions that it was not fitted to.

use std::collections::BTreeMap;

use reachtube_conform::{FitSettings, Group, Silent};
use reachtube_identify::prepare::PreparedLog;
use reachtube_recordings::MemoryRuns;

use crate::compared::growth;
use crate::error::Result;
use crate::trial::Trial;
use crate::windows::cut_some;

/// What is tried.
const GROUPS: [&[Group]; 2] =
    [&[Group::Inertia], &[Group::Inertia, Group::Viscous, Group::Coulomb]];

/// Weight of the pull toward the identified values.
const PULL: f64 = 0.02;

/// Windows of a trial.
const MOST_WINDOWS: usize = 60;

/// A fit is taken if the sets that unseen motions need shrink to this part at least.
const BETTER: f64 = 0.9;

/// A fit, and what it does to the sets that unseen motions need.
#[derive(Debug)]
pub(crate) struct FitChoice {
    /// The fit that pays; none if none does.
    pub fit: Option<FitSettings>,
    /// Why.
    pub reason: String,
}

/// Tries fits. Each is made on half of the motions and judged on the other half, both ways round:
/// by the widest set beside the motion, after it was scaled to hold the motions that were not seen.
///
/// # Errors
///
/// As [`cut_some`].
pub(crate) fn choose(
    trial: &Trial,
    logs: &[PreparedLog],
    motions: &BTreeMap<String, String>,
    horizon: f64,
) -> Result<FitChoice> {
    let (_, count) = cut_some(logs, motions, horizon, MOST_WINDOWS, |_, _| false)?;
    if count < 4 {
        let reason = format!("{count} motions are too few to judge a fit on motions not seen");
        return Ok(FitChoice { fit: None, reason });
    }
    let needed = |fit: Option<FitSettings>| -> Result<f64> {
        let trial = Trial { fit, ..trial.clone() };
        let mut worst = 0.0f64;
        for seen in [0, 1] {
            let half = |is_seen: bool| {
                let wanted = |motion: usize, _: &str| (motion % 2 == seen) == is_seen;
                cut_some(logs, motions, horizon, MOST_WINDOWS, wanted)
            };
            worst = worst.max(needed_width(&trial, half(true)?.0, half(false)?.0));
        }
        Ok(worst)
    };
    let without = needed(None)?;
    let mut best = (None, without);
    let mut words = Vec::new();
    for groups in GROUPS {
        let fit = FitSettings { groups: groups.to_vec(), pull: Some(PULL) };
        let width = needed(Some(fit.clone()))?;
        let names: Vec<&str> = groups.iter().map(|group| group.name()).collect();
        words.push(format!("{} with {}", percent(width), names.join(", ")));
        if width < BETTER * best.1 {
            best = (Some(fit), width);
        }
    }
    let reason = format!(
        "over {horizon} s, unseen halves of the motions need sets of {} of the motion without a \
         fit, {}",
        percent(without),
        words.join(", ")
    );
    Ok(FitChoice { fit: best.0, reason })
}

fn percent(part: f64) -> String {
    if part.is_finite() { format!("{:.0} %", 100.0 * part) } else { "no bounded size".into() }
}

/// Returns the widest set beside the motion that holds the motions `unseen` too, of the sets for
/// the motions `seen`; infinite where there is none.
fn needed_width(trial: &Trial, seen: MemoryRuns, unseen: MemoryRuns) -> f64 {
    let Ok(answer) = trial.run(seen, false) else { return f64::INFINITY };
    let Ok(check) = answer.model.check(unseen).run(&Silent) else { return f64::INFINITY };
    let widths = answer.found.usefulness.joints.iter();
    let growth = growth(&check, widths.len());
    widths.zip(growth).map(|(width, growth)| width.ratio() * growth).fold(0.0, f64::max)
}
