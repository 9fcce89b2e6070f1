//! Choices that would make a model narrower, found by trying them.

use reachtube_arm::Equations;
use reachtube_conform::{FitSettings, Group};
use reachtube_finding::Finding;
use reachtube_identify::prepare::RawLog;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;

use crate::choices::Choices;
use crate::error::Result;
use crate::horizon::{HorizonWidths, MOST_WINDOWS, longest, try_horizon};
use crate::mean_position::mean_position;
use crate::robot::{Evidence, Nominal};
use crate::trial::Trial;
use crate::windows::Prepared;
use crate::without_model::WithoutModel;
use crate::would_help::{nothing_helps, would_help};

/// Windows on which a fit is tried: it takes a thousand times as long as the sets alone.
const FIT_WINDOWS: usize = 12;

/// Group that a trial fits. The weight of its pull is fixed, because its choice would take most of
/// the time.
const FITTED: Group = Group::Inertia;
const PULL: f64 = 0.01;

/// A choice helps if it makes the widest set narrower by this factor.
pub(crate) const HELPS: f64 = 0.8;

/// Number of choices that are named.
const MOST: usize = 2;

/// A model that is too wide, and how it was made.
pub(crate) struct TooWide<'a> {
    /// The choices that were given. All others were made, by trying alternatives.
    pub given: &'a Choices,
    /// The trial and the recordings behind it.
    pub own: (&'a Trial<'a>, &'a Prepared<'a>),
    /// The horizons that were tried.
    pub tried: &'a [HorizonWidths],
    /// All choices.
    pub choices: &'a Choices,
    /// The sets without a model, if they are better.
    pub better: Option<&'a WithoutModel>,
}

/// A choice that was tried, and the widest set with and without it.
struct Tried {
    setting: &'static str,
    value: String,
    windows: usize,
    before: f64,
    after: f64,
    joint: usize,
}

/// Choices that were tried.
#[derive(Default)]
struct Trials(Vec<Tried>);

impl Trials {
    /// Adds a choice with the widest set that it gives on some windows, where that is `before`
    /// without it.
    fn add(
        &mut self,
        setting: &'static str,
        value: impl Into<String>,
        windows: usize,
        [before, after]: [&Option<HorizonWidths>; 2],
    ) {
        let Some((joint, after)) = after.as_ref().map(HorizonWidths::worst) else { return };
        let before = before.as_ref().map_or(f64::INFINITY, |widths| widths.worst().1);
        self.0.push(Tried { setting, value: value.into(), windows, before, after, joint });
    }
}

impl TooWide<'_> {
    /// Tries choices that were not applied, and returns what the best of them would give.
    ///
    /// # Errors
    ///
    /// A job that was cancelled. A choice that cannot be tried is left out.
    pub(crate) fn remedies(&self, evidence: &Evidence, described: &Robot) -> Result<Vec<Finding>> {
        if let Some(without) = self.better {
            return Ok(vec![without.remedy(self.own.0)]);
        }
        let mut tried = Trials::default();
        let (own, some) = (self.own.1, MOST_WINDOWS);
        let before = self.widths(self.own.0, own, some)?;
        let largest = self.choices.largest_ratio.unwrap_or_default();
        let best = longest(self.tried, largest).horizon;
        if self.given.horizon.is_some_and(|given| given != best) {
            // The sets of `horizons` are without the allowance.
            let after = self.widths_over(best, self.own.0, own, some)?;
            tried.add("horizon", best.to_string(), some, [&before, &after]);
        }
        if let Some(equations) = self.given.equations.map(other) {
            let after = self.widths(&Trial { equations, ..self.own.0.clone() }, own, some)?;
            tried.add("equations", name(equations), some, [&before, &after]);
        }
        let raw: Vec<&RawLog> = evidence.motions.iter().map(|motion| &*motion.log).collect();
        let expansion = mean_position(&raw);
        if self.given.expansion.as_ref().is_some_and(|given| *given != expansion) {
            let value: Vec<String> = expansion.iter().map(ToString::to_string).collect();
            let after = self.widths(&Trial { expansion, ..self.own.0.clone() }, own, some)?;
            tried.add("expansion", value.join(","), some, [&before, &after]);
        }
        if self.given.identify == Some(false) && evidence.torque != Torque::Compensated {
            // Logs that identify no robot are no error here.
            if let Ok(Nominal { robot, logs, .. }) = evidence.identified(described) {
                let recordings = Prepared { logs: &logs, ..*own };
                let after =
                    self.widths(&Trial { robot, ..self.own.0.clone() }, &recordings, some)?;
                tried.add("identify", "true", some, [&before, &after]);
            }
        }
        if self.own.0.fit.is_none() {
            let fit = Some(FitSettings { groups: vec![FITTED], pull: Some(PULL) });
            let before = self.widths(self.own.0, own, FIT_WINDOWS)?;
            let after = self.widths(&Trial { fit, ..self.own.0.clone() }, own, FIT_WINDOWS)?;
            tried.add("fit", FITTED.name(), FIT_WINDOWS, [&before, &after]);
        }
        Ok(self.findings(tried.0))
    }

    /// Returns how wide the sets are at the horizon of the model; `None` if none were found.
    fn widths(
        &self,
        trial: &Trial,
        recordings: &Prepared,
        most: usize,
    ) -> Result<Option<HorizonWidths>> {
        self.widths_over(self.choices.horizon.unwrap_or_default(), trial, recordings, most)
    }

    /// Returns how wide the sets are at a horizon; `None` if none were found.
    fn widths_over(
        &self,
        horizon: f64,
        trial: &Trial,
        recordings: &Prepared,
        most: usize,
    ) -> Result<Option<HorizonWidths>> {
        let widths = try_horizon(trial, recordings, horizon, most)?;
        Ok(widths.filter(|widths| widths.reason.is_none()))
    }

    /// Returns what the best choices would give, or that none helps.
    fn findings(&self, mut tried: Vec<Tried>) -> Vec<Finding> {
        let count = tried.len();
        if tried.iter().all(|tried| tried.after >= HELPS * tried.before) && count > 0 {
            let all = tried.iter().map(|tried| (tried.setting, &*tried.value));
            return vec![nothing_helps(&all.collect::<Vec<_>>())];
        }
        tried.retain(|tried| tried.after < HELPS * tried.before);
        tried.sort_by(|a, b| a.after.total_cmp(&b.after));
        let joints = self.own.0.robot.joints();
        let finding = |tried: &Tried| {
            let joint = &joints[tried.joint].name;
            let ratios = [tried.before, tried.after];
            would_help(tried.setting, &tried.value, joint, ratios, tried.windows)
        };
        tried.iter().take(MOST).map(finding).collect()
    }
}

fn name(equations: Equations) -> String {
    format!("{equations:?}").to_lowercase()
}

fn other(equations: Equations) -> Equations {
    match equations {
        Equations::Model => Equations::Robot,
        _ => Equations::Model,
    }
}
