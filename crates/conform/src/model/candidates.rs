//! Models that were calibrated by the same recordings.

use std::collections::BTreeSet;
use std::path::Path;

use reachtube_reach::Hyperrectangle;
use serde::Deserialize;

use crate::model::file::{FORMAT, Model};
use crate::model::records::DataRecord;
use crate::next_motion::calibration::Calibration;
use crate::sets::UncertaintySets;

/// Calibration and sets of a model file.
#[derive(Deserialize)]
struct Candidate {
    format: String,
    calibration: Option<Calibration>,
    data: DataRecord,
    initial_set: Hyperrectangle,
    input_set: Hyperrectangle,
    noise_set: Option<Hyperrectangle>,
}

impl Model {
    /// Returns the model of the file `own` with bounds that count the other models in its folder
    /// which some of the same recordings calibrated. A model of the same sets is not counted.
    ///
    /// The bound of a calibration holds for one model that was fixed beforehand. The best of
    /// several models that were compared on the motions that calibrate them may be the luckiest.
    /// Models in other folders are not known. Files that cannot be read are no models.
    #[must_use]
    pub fn among_others(self, own: &Path) -> Self {
        let Some(calibration) = &self.calibration else { return self };
        let folder = own.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        let digests = held_out(calibration, &self.data);
        let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let paths = files.map(|file| file.path());
        let is_other = |path: &Path| {
            path.extension().is_some_and(|extension| extension == "json")
                && path.file_name() != own.file_name()
        };
        let mut others: Vec<UncertaintySets> = Vec::new();
        for path in paths.filter(|path| is_other(path)) {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            // A quick look before the whole file is parsed.
            if !text.contains("\"calibration\"") {
                continue;
            }
            let Ok(candidate) = serde_json::from_str::<Candidate>(&text) else { continue };
            let Some(other) = candidate.calibration.filter(|_| candidate.format == FORMAT) else {
                continue;
            };
            let Candidate { initial_set, input_set, noise_set, data, .. } = candidate;
            let sets = UncertaintySets { initial_set, input_set, noise_set };
            let is_new = sets != self.sets() && !others.contains(&sets);
            let own = held_out(&other, &data);
            // Where recordings are not listed, they may be the same.
            let may_share = digests.is_empty() || own.is_empty() || !digests.is_disjoint(&own);
            if is_new && may_share {
                others.push(sets);
            }
        }
        self.of_candidates(1 + others.len())
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

/// Returns the SHA-256 of the recordings that calibrated a model, and of the logs that they were
/// cut from.
fn held_out(calibration: &Calibration, data: &DataRecord) -> BTreeSet<String> {
    let motions: BTreeSet<&str> = calibration.held_out().collect();
    let suites = data.suites.iter().filter(|suite| motions.contains(suite.motion()));
    let runs = suites.flat_map(|suite| &suite.runs);
    runs.flat_map(|run| [Some(&run.sha256), run.origin.as_ref()]).flatten().cloned().collect()
}
