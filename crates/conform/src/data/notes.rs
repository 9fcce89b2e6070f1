//! Notes about recordings for the user.

use reachtube_recordings::copies_note;

use crate::data::origin::Origin;
use crate::data::recordings::Recordings;
use crate::data::settings::NominalStart;
use crate::data::setup::Setup;
use crate::data::suite::Suite;

pub(super) fn recording_notes(
    setup: &Setup,
    origin: &Origin,
    recordings: &Recordings,
) -> Vec<String> {
    let mut notes = data_notes(setup, origin, recordings);
    notes.extend(unknown_temperature(setup, recordings));
    notes
}

fn data_notes(setup: &Setup, origin: &Origin, recordings: &Recordings) -> Vec<String> {
    let of_suites = recordings.suites.iter().flat_map(|suite| suite_notes(suite, setup));
    let runs = recordings.suites.iter().flat_map(Suite::sample);
    let named = runs.map(|run| (origin.entry(run.index).file.as_str(), run.sha256.as_str()));
    of_suites.chain(copies_note(named)).collect()
}

fn suite_notes(suite: &Suite, setup: &Setup) -> Vec<String> {
    let Setup { settings, nominal_starts, .. } = setup;
    let (nominal, count) = (settings.nominal, suite.run_count());
    let mut notes: Vec<String> = suite.totals.run_notes().collect();
    let [shortest, longest] = suite.totals.samples;
    let name = &suite.entry.name;
    if shortest < longest {
        notes.push(format!(
            "suite {name}: its runs have {shortest} to {longest} samples; each run counts up to \
             its own end"
        ));
    }
    if suite.shared.is_none() && count > 1 && nominal == NominalStart::Mean {
        notes.push(format!(
            "suite {name}: its runs differ in input or sample times, so each run has its own \
             nominal motion"
        ));
    }
    let is_known = nominal_starts.is_empty() || nominal_starts.contains_key(name);
    if nominal == NominalStart::Mean && !is_known {
        let start = match count {
            1 => "the first state of its recording".to_owned(),
            _ => format!(
                "the mean of the first states of its {count} recordings; the verdict on one of \
                 them depends on the others"
            ),
        };
        notes.push(format!(
            "suite {name}: the model has no nominal initial state for it, so its nominal motion \
             starts at {start}"
        ));
    }
    notes
}

fn unknown_temperature(setup: &Setup, recordings: &Recordings) -> Option<String> {
    let with: usize = recordings.suites.iter().map(|s| s.totals.with_temperature()).sum();
    let without = recordings.run_count() - with;
    (setup.drive.needs_temperatures() && without > 0).then(|| {
        format!(
            "friction of the robot depends on temperature, and {without} of the {} recordings \
             have no columns temp1 to tempn; they are taken at the reference temperature",
            recordings.run_count()
        )
    })
}
