use crate::prepare::low_pass::TRANSIENT_PERIODS;
use crate::prepare::settings::PrepareSettings;

/// Jitter of sample times below which resampling is not worth a sentence \[s\].
const NEGLIGIBLE_JITTER: f64 = 1e-6;

/// Facts about the preparation of one log.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LogChange {
    /// Median time between the recorded samples \[s\].
    pub median_step: f64,
    /// Largest deviation of a time between samples from the median \[s\].
    pub jitter: f64,
    /// Whether the velocity is the differentiated position.
    pub differentiated: bool,
}

/// Describes the changes to recordings, one sentence each.
pub(crate) fn described(
    samples: usize,
    changes: &[LogChange],
    settings: &PrepareSettings,
    cut_off: f64,
) -> Vec<String> {
    [
        joint_names(settings),
        gains(settings),
        resampling(changes),
        Some(filtering([changes.len(), samples], settings.cut_off.is_some(), cut_off)),
        Some(velocity(changes)),
    ]
    .into_iter()
    .flatten()
    .collect()
}

fn joint_names(settings: &PrepareSettings) -> Option<String> {
    (!settings.joints.is_empty()).then(|| {
        format!("columns were matched with the joints by name: {}", settings.joints.join(", "))
    })
}

fn gains(settings: &PrepareSettings) -> Option<String> {
    settings.gains.iter().any(|gain| *gain != 1.0).then(|| {
        format!("recorded torques were multiplied by {:?}, one gain per joint", settings.gains)
    })
}

fn resampling(changes: &[LogChange]) -> Option<String> {
    let steps = changes.iter().map(|change| change.median_step);
    let (shortest, longest) =
        (steps.clone().fold(f64::INFINITY, f64::min), steps.fold(0.0, f64::max));
    let jitter = changes.iter().map(|change| change.jitter).fold(0.0, f64::max);
    (jitter > NEGLIGIBLE_JITTER).then(|| {
        format!(
            "{} recordings were resampled evenly: the time between samples deviated by up to \
             {:.2} ms from its median of {:.2} to {:.2} ms",
            changes.len(),
            1e3 * jitter,
            1e3 * shortest,
            1e3 * longest
        )
    })
}

fn filtering([logs, samples]: [usize; 2], given: bool, cut_off: f64) -> String {
    let origin = if given {
        "as set"
    } else {
        "chosen as 1.5 times the bandwidth of the velocity (99.9 % of its power beyond the noise), \
         at least 3 Hz"
    };
    format!(
        "q, qd and tau of {logs} recordings ({samples} samples) were filtered forward and backward \
         by a Butterworth low-pass of order 4 with a cut-off of {cut_off:.2} Hz ({origin}); qdd is \
         the derivative of qd; {:.2} s were cut from both ends",
        TRANSIENT_PERIODS / cut_off
    )
}

fn velocity(changes: &[LogChange]) -> String {
    match changes.iter().filter(|change| change.differentiated).count() {
        0 => "qd is the recorded velocity".into(),
        count if count == changes.len() => "qd is the derivative of q".into(),
        some => format!(
            "qd is the derivative of q in {some} recordings; in the others the recorded velocity \
             has less noise"
        ),
    }
}
