use std::path::Path;
use std::sync::Arc;

use reachtube_arm::Equations;
use reachtube_conform::model::LogRecord;
use reachtube_conform::{Answer, FitSettings, Group, Model, Progress};
use reachtube_finding::{Finding, Severity};
use reachtube_identify::prepare::{LogEntry, PrepareSettings, PreparedLog, RawLog, check_window};
use reachtube_recordings::{MemoryRuns, Preparation, Torque};
use reachtube_robot::Robot;

use crate::allowance::Widened;
use crate::choices::{Choice, Choices, LARGEST_GROWTH, LARGEST_OUTSIDE, LARGEST_RATIO};
use crate::chooser::Chooser;
use crate::compared::{Compared, HeldOut};
use crate::error::{Error, Result};
use crate::findings::{ignored_motors, impossible_links, measures_the_filter, unless_accepted};
use crate::first_choices::first_choices;
use crate::held_out::Split;
use crate::horizon::{
    HorizonWidths, Longest, candidates, longer_horizons, longest, longest_of_all, ratios,
    try_horizons, try_longer,
};
use crate::input_doubling::choose_input_doubling;
use crate::remedies::TooWide;
use crate::robot::{Evidence, Nominal, are_differentiated, prepare_for};
use crate::rounding::percent;
use crate::sorted::{Sorted, WARMTH, unknown_warmth};
use crate::steps::{Steps, digest};
use crate::stretches::{Use, check_used, entries, left_out};
use crate::trial::Trial;
use crate::windows::Prepared;
use crate::without_model::WithoutModel;

/// A model made of logs, the choices behind it, and what motions that were held out say of it.
#[derive(Debug)]
pub struct Built {
    /// The model with its recordings, the windows.
    pub answer: Answer,
    /// The robot: as described, or identified.
    pub robot: Robot,
    /// All choices, from which the same model is made again.
    pub choices: Choices,
    /// The choices that were made, in their order, with their reasons.
    pub made: Vec<Choice>,
    /// What a user should know about the reading of the logs.
    pub notes: Vec<String>,
    /// What contradicts other recordings or the robot's description, and whether the sets carry
    /// over to what was held out. A failure makes the model unacceptable.
    pub findings: Vec<Finding>,
    /// How wide the sets are at each horizon that was tried.
    pub horizons: Vec<HorizonWidths>,
    /// What the motions that were held out say.
    pub held_out: HeldOut,
    /// The sets without a model, beside which the model's are judged; `None` for a model that knows
    /// neither the robot nor its torque.
    pub without_model: Option<WithoutModel>,
    /// What choices that were not applied would give, if the model is too wide to be of use.
    pub remedies: Vec<Finding>,
    /// Some windows for a page: windows that decide the sets, and others evenly spread.
    pub shown: MemoryRuns,
    /// Some windows of motions that were held out: windows that leave the sets, and others.
    pub shown_held_out: MemoryRuns,
}

/// Makes a model of the recordings that `given` names, and compares it with motions that are held
/// out. `say` takes each choice when it is made; `progress` may cancel the job. Steps that are
/// finished are kept in the file `journal`, if one is given, from which the same job continues; who
/// gives it removes it in the end.
///
/// # Errors
///
/// Recordings that cannot be read, show no motion of several joints, or are shorter than every
/// horizon; a robot that cannot be identified although its description is no body; a model that
/// runs away over the shortest horizon; a fit of warm-up to recordings that do not say how warm the
/// robot was.
pub fn build(
    robot: &Robot,
    torque: Torque,
    given: &Choices,
    journal: Option<&Path>,
    say: &mut dyn FnMut(&Choice),
    progress: &dyn Progress,
) -> Result<Built> {
    given.check(robot.joint_count(), torque)?;
    let mut chooser = Chooser { choices: given.clone(), made: Vec::new(), say, progress };
    let settings = PrepareSettings { torque: Some(torque), ..given.prepare_settings() };
    settings.gain_of_each_joint(robot.joint_count())?;
    let sorted = Sorted::read(&mut chooser, given, robot, &settings)?;
    let journal = Steps::open(journal, digest(robot, torque, given, &sorted.digest));
    let moving: Vec<Arc<RawLog>> =
        sorted.motions.iter().map(|recording| Arc::clone(&recording.log)).collect();
    let split = Split::new(sorted.motions, given.held_out.as_deref())?;
    refuse_unknown_warmth(given, &split)?;
    chooser.choose_held_out(&split);
    let from_start = torque == Torque::Compensated;
    let parts = split.in_stretches(Use { cut_off: f64::INFINITY, from_start });
    let raw: Vec<&RawLog> = parts.kept.iter().map(|recording| &*recording.log).collect();
    given.horizon.map_or(Ok(()), |horizon| check_window(horizon, raw.iter().copied()))?;
    let choices = first_choices(&mut chooser, &journal, robot, torque, &raw, &settings);
    let (first, cut_off) = choices?;
    let what = Use { cut_off: if from_start { f64::INFINITY } else { cut_off }, from_start };
    check_used(moving.iter().map(|log| &**log), what)?;
    let (left_out, split) =
        (left_out(sorted.all.iter().map(|log| &**log), what), split.in_stretches(what));

    // The robot.
    let evidence = Evidence {
        rest: entries(&sorted.rest, what),
        one_joint: entries(&sorted.one_joint, what),
        motions: &split.kept,
        torque,
        settings: &settings,
        cut_off,
        trial: &first,
    };
    let chosen = evidence.choose(robot, given.identify)?;
    chooser.choose("identify", chosen.is_identified.to_string(), &chosen.reason);
    chooser.choices.identify = Some(chosen.is_identified);
    let job = Decided { robot, given, split: &split, evidence: &evidence };
    let findings = left_out.into_iter().chain(sorted.findings).collect();
    job.finish(chooser, chosen, (sorted.notes, findings), sorted.simulated)
}

/// Refuses a fit of warm-up to recordings that do not say how warm the robot was.
fn refuse_unknown_warmth(given: &Choices, split: &Split) -> Result<()> {
    let is_fitted = given.fit.as_ref().is_some_and(|groups| groups.contains(&Group::WarmUp));
    let recordings = split.kept.iter().chain(&split.held_out);
    let logs: Vec<&RawLog> = recordings.map(|recording| &*recording.log).collect();
    let by_temperature = logs.iter().all(|log| !log.run.temperatures.is_empty());
    let unknown = unknown_warmth(&logs, by_temperature);
    unknown.filter(|_| is_fitted).map_or(Ok(()), |file| {
        let value = format!("warm-up, for {}", file.display());
        Err(Error::Choice { key: "fit", value, needed: WARMTH })
    })
}

impl Built {
    /// Returns the answer with a bound for new motions that counts the models which the file `path`
    /// had before, if some of the same motions were held out from them.
    #[must_use]
    pub fn among_others(mut self, path: &Path) -> Self {
        self.answer.model = self.answer.model.among_others(path);
        self
    }
}

/// A job whose motions are split and whose robot is chosen.
struct Decided<'a> {
    /// The robot as described.
    robot: &'a Robot,
    given: &'a Choices,
    split: &'a Split,
    evidence: &'a Evidence<'a>,
}

impl Decided<'_> {
    /// Returns the model with its preparation, the logs that it is made of, and the held-out logs.
    fn recorded(&self, model: Model, preparation: Preparation) -> Model {
        let one_joint = self.evidence.one_joint.iter().filter_map(|entry| match entry {
            LogEntry::Recording(log) => Some((log, false)),
            _ => None,
        });
        let kept = self.split.kept.iter().map(|recording| (&recording.log, false));
        let held_out = self.split.held_out.iter().map(|recording| (&recording.log, true));
        let all = one_joint.chain(kept).chain(held_out);
        let logs = all.map(|(log, held_out)| LogRecord::of(&log.run, held_out)).collect();
        model.with_preparation(preparation).with_logs(logs)
    }

    /// Chooses the horizon, finds the sets, and compares them with what was held out. `read` are
    /// the notes and findings of the reading.
    fn finish(
        &self,
        mut chooser: Chooser,
        chosen: Nominal,
        read: (Vec<String>, Vec<Finding>),
        simulated: bool,
    ) -> Result<Built> {
        let Self { given, split, .. } = *self;
        let Evidence { torque, settings, cut_off, trial, .. } = *self.evidence;
        let Nominal { robot, logs, findings, is_identified, .. } = chosen;
        let mut findings = unless_accepted(findings, given);
        let (used, unlikely) = impossible_links(self.robot, is_identified);
        findings.extend(unlikely);
        let has_folds = is_identified && torque != Torque::Compensated;
        let folds = if has_folds { self.evidence.folds(self.robot)? } else { Vec::new() };
        let mut trial = Trial { robot: robot.clone(), folds: &folds, ..trial.clone() };
        let (origins, from_start) = (split.origins(), torque == Torque::Compensated);
        let shortest = if from_start { 0.0 } else { 0.5 / cut_off };
        let (logs, origins) = (&*logs, &origins);
        let recordings = Prepared { logs, origins, from_start, divides: true, simulated, shortest };
        let found = sets(&mut chooser, &mut trial, &recordings);
        let (found, horizons) = found.map_err(|error| error.because(&findings))?;
        let horizon = chooser.choices.horizon.unwrap_or_default();
        let (without_model, found) =
            WithoutModel::beside(found, &trial, &recordings, (horizon, &chooser.choices))?;
        chooser.choose_allowance(&found);
        let Widened { mut answer, finding, .. } = found;
        findings.extend(finding.into_iter().chain(measures_the_filter(horizon, shortest)));
        let choices = &chooser.choices;
        answer.model = self.recorded(answer.model, preparation(choices, torque, logs));
        let better = without_model.as_ref().filter(|without| !without.is_model_better());
        let wide = TooWide { given, choices, own: (&trial, &recordings), tried: &horizons, better };
        // What contradicts the robot is to be mended first: no choice can.
        let is_contradicted = findings.iter().any(|found| found.severity == Severity::Failure);
        let remedies = match is_contradicted || (choices.accept(&answer.model) && better.is_none())
        {
            true => Vec::new(),
            false => wide.remedies(self.evidence, self.robot)?,
        };
        let raw: Vec<_> = split.held_out.iter().map(|other| RawLog::clone(&other.log)).collect();
        let held_back = prepare_for(&raw, &robot, torque, settings, cut_off)?;
        let held_back = Prepared { logs: &held_back, divides: false, ..recordings };
        let Compared { held_out, shown, shown_held_out } =
            Compared::new(&answer, &recordings, &held_back, horizon, split.are_motions_whole())?;
        findings.extend(read.1.into_iter().chain(held_out.finding(choices)));
        Ok(Built {
            answer,
            notes: read.0.into_iter().chain(used).chain(ignored_motors(&robot, torque)).collect(),
            robot,
            choices: chooser.choices,
            made: chooser.made,
            findings,
            horizons,
            held_out,
            without_model,
            remedies,
            shown,
            shown_held_out,
        })
    }
}

/// Chooses the fit and the horizon, and finds the sets.
fn sets(
    chooser: &mut Chooser,
    trial: &mut Trial,
    recordings: &Prepared,
) -> Result<(Widened, Vec<HorizonWidths>)> {
    let largest = chooser.choices.largest_ratio.unwrap_or(LARGEST_RATIO);
    chooser.choices.largest_ratio = Some(largest);
    chooser.choices.largest_growth.get_or_insert(LARGEST_GROWTH);
    chooser.choices.largest_outside.get_or_insert(LARGEST_OUTSIDE);
    let horizons = choose_equations(chooser, trial, recordings, largest)?;
    let mut horizons = choose_input_doubling(chooser, trial, recordings, horizons, largest)?;
    let given = chooser.choices.horizon;
    let unfitted = given.unwrap_or_else(|| longest(&horizons, largest).horizon);
    choose_fit(chooser, trial, horizons.last().map_or(unfitted, |tried| tried.horizon));
    let mut longer = Vec::new();
    if trial.fit.is_some() {
        horizons.retain(|widths| widths.horizon <= unfitted);
        match given {
            Some(_) => {}
            // Their trials would take all recordings, as the answer does.
            None if recordings.from_start => longer = longer_horizons(recordings, unfitted),
            None => horizons.extend(try_longer(trial, recordings, unfitted, largest)?),
        }
    }
    let (Longest { found, horizon, wide }, reason) = match given {
        Some(horizon) => {
            let found = Widened::new(trial, recordings, horizon)?;
            (Longest { found, horizon, wide: Vec::new() }, "given".to_string())
        }
        None => {
            let longer = longer.into_iter().rev();
            let candidates: Vec<f64> = longer.chain(candidates(&horizons, largest)).collect();
            let longest = longest_of_all(trial, recordings, &candidates, largest)?;
            let reason = reason_of_horizon(&longest, &horizons, largest);
            (longest, reason)
        }
    };
    let with_fit = trial.fit.is_some();
    let own = HorizonWidths::of_all(horizon, ratios(&found.answer), with_fit);
    let all: Vec<HorizonWidths> = std::iter::once(own).chain(wide).collect();
    horizons.retain(|tried| {
        let is_known = all.iter().any(|known| known.horizon == tried.horizon);
        !is_known && (tried.with_fit == with_fit || tried.horizon < horizon)
    });
    horizons.extend(all);
    horizons.sort_by(|a, b| a.horizon.total_cmp(&b.horizon));
    chooser.choose("horizon", format!("{horizon} s"), reason);
    chooser.choices.horizon = Some(horizon);
    Ok((found, horizons))
}

/// Chooses what is fitted. Since a fit takes long, horizons up to `tried` \[s\] were tried without
/// it.
fn choose_fit(chooser: &mut Chooser, trial: &mut Trial, tried: f64) {
    let groups = chooser.choices.fit.clone().unwrap_or_default();
    let reason = match groups.is_empty() {
        true => "a fit makes sets smaller, but takes minutes".into(),
        false => format!("given; horizons up to {tried} s were tried without it"),
    };
    let names: Vec<&str> = groups.iter().map(|group| group.name()).collect();
    let value = if names.is_empty() { "nothing".into() } else { names.join(", ") };
    chooser.choose("fit", value, reason);
    let pull = chooser.choices.pull;
    trial.fit = (!groups.is_empty()).then(|| FitSettings { groups: groups.clone(), pull });
    chooser.choices.fit = Some(groups);
}

/// Chooses whose equations nominal motions satisfy: the equations with which sets stay narrow for
/// longer, or are narrower. Returns how the sets grow with them.
fn choose_equations(
    chooser: &mut Chooser,
    trial: &mut Trial,
    recordings: &Prepared,
    largest: f64,
) -> Result<Vec<HorizonWidths>> {
    let given = chooser.choices.equations;
    let grown = |equations: Equations| {
        let trial = Trial { equations, ..trial.of_horizons(chooser.choices.horizon) };
        let horizons = try_horizons(&trial, recordings)?;
        let widths = longest(&horizons, largest).clone();
        Ok::<_, Error>((horizons, widths))
    };
    let (horizons, equations, reason) = match given {
        Some(equations) => (grown(equations)?.0, equations, "given".to_string()),
        None => {
            let (of_robot, own) = grown(Equations::Robot)?;
            let (of_model, other) = grown(Equations::Model)?;
            let is_narrow = |widths: &HorizonWidths| widths.worst_smallest().1 <= largest;
            let is_better = match (is_narrow(&own), is_narrow(&other)) {
                (true, true) => other.horizon > own.horizon,
                (false, false) => other.worst_smallest().1 < own.worst_smallest().1,
                (own, _) => !own,
            };
            let words = |widths: &HorizonWidths| {
                format!("{} at {} s", percent(widths.worst_smallest().1), widths.horizon)
            };
            let reason = format!(
                "the widest set is {} of the motion with the robot's equations, {} with the linear \
                 model's",
                words(&own),
                words(&other)
            );
            match is_better {
                true => (of_model, Equations::Model, reason),
                false => (of_robot, Equations::Robot, reason),
            }
        }
    };
    chooser.choose("equations", format!("{equations:?}").to_lowercase(), reason);
    chooser.choices.equations = Some(equations);
    trial.equations = equations;
    Ok(horizons)
}

/// Returns what was done to logs, to do it to others.
fn preparation(choices: &Choices, torque: Torque, logs: &[PreparedLog]) -> Preparation {
    let window = choices.horizon.filter(|_| torque != Torque::Compensated);
    Preparation {
        torque,
        gains: choices.gains.clone(),
        cut_off: choices.cut_off,
        window,
        differentiated: are_differentiated(logs),
        columns: choices.columns.clone(),
        log: choices.log.clone(),
    }
}

/// Returns why a horizon was chosen after some were `tried`.
fn reason_of_horizon(chosen: &Longest, tried: &[HorizonWidths], largest: f64) -> String {
    let (answer, horizon) = (&chosen.found.answer, chosen.horizon);
    let longer = tried.iter().find(|tried| tried.horizon > horizon);
    let longer = longer.map(|longer| ("some of the", longer));
    let longer = chosen.wide.last().map(|longer| ("all", longer)).or(longer);
    let name = |joint: usize| &answer.model.signals.parts[joint].name;
    let (joint, ratio) = answer.found.usefulness.worst().unwrap_or((0, f64::INFINITY));
    let mut words = format!("the widest set is {} of the motion ({})", percent(ratio), name(joint));
    if ratio > largest {
        words += &format!(", more than {}, and no other horizon is better", percent(largest));
    } else if let Some((windows, HorizonWidths { horizon, reason: Some(reason), .. })) = longer {
        words += &format!("; at {horizon} s {windows} windows give no sets: {reason}");
    } else if let Some((windows, longer)) = longer {
        let (joint, ratio) = longer.worst_smallest();
        words += &format!(
            "; at {} s {windows} windows give {} ({})",
            longer.horizon,
            percent(ratio),
            name(joint)
        );
    }
    words
}
