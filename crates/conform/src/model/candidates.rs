//! Models that were compared with the same recordings.

use std::collections::BTreeSet;
use std::path::Path;

use reachtube_reach::Hyperrectangle;
use serde::Deserialize;

use crate::model::file::{FORMAT, Model};
use crate::model::records::{DataRecord, LogRecord};
use crate::next_motion::calibration::Calibration;
use crate::sets::UncertaintySets;

/// What a model file says about the recordings that were held out, with its sets.
#[derive(Deserialize)]
struct Candidate {
    format: String,
    calibration: Option<Calibration>,
    data: DataRecord,
    initial_set: Hyperrectangle,
    input_set: Hyperrectangle,
    noise_set: Option<Hyperrectangle>,
    #[serde(default)]
    logs: Vec<LogRecord>,
    #[serde(default)]
    replaced: usize,
}

impl Model {
    /// Returns the model of the file `own` with bounds that count the models with other sets which
    /// that file had before, and the other models in its folder, if some of the same recordings
    /// calibrated them or were held out from them.
    ///
    /// The bound of a calibration holds for one model that was fixed beforehand. The best of
    /// several models that were compared on the motions that calibrate them may be the luckiest.
    /// Models in other folders are not known. Files that cannot be read are no models.
    #[must_use]
    pub fn among_others(self, own: &Path) -> Self {
        let held_out = HeldOutLogs::of(self.calibration.as_ref(), &self.data, &self.logs);
        let replaced = match Candidate::read(own) {
            Some(before) if before.sets() == self.sets() => before.replaced,
            Some(before) if held_out.may_share(&before.held_out()) => before.replaced + 1,
            _ => 0,
        };
        if self.calibration.is_none() {
            return Self { replaced, ..self }.sealed();
        }
        let folder = own.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let paths = files.map(|file| file.path());
        let is_other = |path: &Path| {
            path.extension().is_some_and(|extension| extension == "json")
                && path.file_name() != own.file_name()
        };
        let mut others: Vec<(UncertaintySets, usize)> = Vec::new();
        for other in paths.filter(|path| is_other(path)).filter_map(|path| Candidate::read(&path)) {
            let sets = other.sets();
            let is_new = sets != self.sets() && !others.iter().any(|(known, _)| *known == sets);
            if is_new && held_out.may_share(&other.held_out()) {
                others.push((sets, 1 + other.replaced));
            }
        }
        let candidates = 1 + replaced + others.iter().map(|(_, count)| count).sum::<usize>();
        Self { replaced, ..self }.of_candidates(candidates)
    }

    fn of_candidates(self, candidates: usize) -> Self {
        let is_bound = self.trust.average_probability.is_some();
        let calibration =
            self.calibration.map(|calibration| Calibration { candidates, ..calibration });
        let trust = match is_bound {
            true => self.trust.of_candidates(candidates),
            false => self.trust,
        };
        Self { calibration, trust, ..self }.sealed()
    }
}

impl Candidate {
    /// Reads a model for which motions were held out; `None` if the file is none.
    fn read(path: &Path) -> Option<Self> {
        // A device has no end.
        if !path.is_file() {
            return None;
        }
        let text = std::fs::read_to_string(path).ok()?;
        // A quick look before the whole file is parsed.
        if !text.contains("\"calibration\"") && !text.contains("\"held_out\"") {
            return None;
        }
        serde_json::from_str::<Self>(&text).ok().filter(|candidate| candidate.format == FORMAT)
    }

    fn sets(&self) -> UncertaintySets {
        let Self { initial_set, input_set, noise_set, .. } = self;
        UncertaintySets {
            initial_set: initial_set.clone(),
            input_set: input_set.clone(),
            noise_set: noise_set.clone(),
        }
    }

    fn held_out(&self) -> HeldOutLogs<'_> {
        HeldOutLogs::of(self.calibration.as_ref(), &self.data, &self.logs)
    }
}

/// The recordings that were held out from the sets of a model.
struct HeldOutLogs<'a> {
    /// The SHA-256 of the recordings that calibrated it, and of their logs; `None` for a model
    /// without a calibration.
    calibrating: Option<BTreeSet<&'a str>>,
    /// The logs that were held out from every choice.
    logs: Vec<&'a LogRecord>,
}

impl<'a> HeldOutLogs<'a> {
    fn of(
        calibration: Option<&'a Calibration>,
        data: &'a DataRecord,
        logs: &'a [LogRecord],
    ) -> Self {
        let calibrating = calibration.map(|calibration| {
            let motions: BTreeSet<&str> = calibration.held_out().collect();
            let suites = data.suites.iter().filter(|suite| motions.contains(suite.motion()));
            let runs = suites.flat_map(|suite| &suite.runs);
            let digests = runs.flat_map(|run| [Some(&run.sha256), run.origin.as_ref()]).flatten();
            digests.map(String::as_str).collect()
        });
        Self { calibrating, logs: logs.iter().filter(|log| log.held_out).collect() }
    }

    /// Returns whether both have a recording in common; where recordings that calibrated a model
    /// are not listed, they may be the same.
    fn may_share(&self, other: &Self) -> bool {
        let calibrated = match (&self.calibrating, &other.calibrating) {
            (Some(a), Some(b)) => a.is_empty() || b.is_empty() || !a.is_disjoint(b),
            _ => false,
        };
        let shares = |log: &&LogRecord| other.logs.iter().any(|other| log.shares_samples(other));
        calibrated || self.logs.iter().any(shares)
    }
}
