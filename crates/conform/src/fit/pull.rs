//! The weight of the pull toward the identified values, chosen by leaving one motion out.

use std::time::{Duration, Instant};

use rayon::prelude::*;

use crate::data::setup::Parameters;
use crate::error::{Error, Result};
use crate::fit::evaluation::FitTask;
use crate::fit::group::Group;
use crate::fit::record::{PullCost, UnseenMotion};
use crate::fit::search::{SearchEffort, Wanted};
use crate::fit::unseen::Unseen;
use crate::next_motion::allowance::Missing;
use crate::next_motion::left_out::LeftOutMotions;
use crate::next_motion::without_motion::LeftOut;
use crate::program::layout::Limits;

/// The weights that are tried, in parts of the identified model's cost per unit, the strongest
/// first.
const PULLS: [f64; 6] = [0.3, 0.1, 0.03, 0.01, 0.003, 0.001];

/// The pull that was chosen.
pub(crate) struct PullChoice {
    pub pull: f64,
    /// How the model that was fitted without each motion carries over to it.
    pub left_out: Vec<UnseenMotion>,
    /// The rows of each motion that lie beyond the sets that were found without it; `None` if a
    /// nominal motion diverges.
    pub missing: Option<Vec<Missing>>,
    /// How the identified model carries over to each motion.
    pub identified: Vec<UnseenMotion>,
    /// The mean costs for each weight that was tried.
    pub tried: Vec<PullCost>,
    /// The groups without which fits carry over better, in the order in which they were dropped.
    pub dropped: Vec<Group>,
}

impl PullChoice {
    pub(crate) fn groups(&self, parameters: &dyn Parameters) -> Vec<Group> {
        let all = parameters.groups().into_iter();
        all.filter(|group| !self.dropped.contains(group)).collect()
    }

    /// Returns whether fits carry over to motions that they have not seen at least as well as the
    /// identified model.
    pub(crate) fn carries_over(&self) -> bool {
        let means = [&self.identified, &self.left_out].map(|of| PullCost::new(self.pull, of));
        !means[0].is_less(&means[1])
    }
}

impl From<&PullChoice> for LeftOutMotions {
    fn from(choice: &PullChoice) -> Self {
        let each = choice.left_out.iter().map(LeftOut::from).collect();
        Self { each, missing: choice.missing.clone() }
    }
}

/// The fits without each motion for one weight and some groups.
#[derive(Default)]
struct Folded {
    mean: PullCost,
    left_out: Vec<UnseenMotion>,
    missing: Vec<Option<Missing>>,
    /// The numbers that were found without each motion.
    numbers: Vec<Vec<f64>>,
}

impl Folded {
    /// Fits without each motion with weight `pull`, from the numbers `from`; the groups `held` stay
    /// at the values that a fit starts from.
    fn new(folds: &[Fold], from: &[Vec<f64>], pull: f64, held: &[Group]) -> Result<Self> {
        let fits = folds.par_iter().zip(from).map(|(fold, from)| fold.fit(pull, from, held));
        let fits: Vec<_> = fits.collect::<Result<_>>()?;
        let mut folded = Self::default();
        for ((unseen, missing), numbers) in fits {
            folded.left_out.push(unseen);
            folded.missing.push(missing);
            folded.numbers.push(numbers);
        }
        folded.mean = PullCost::new(pull, &folded.left_out);
        Ok(folded)
    }

    /// Drops one group after the other, as long as the fits without it carry over better. Returns
    /// the groups that were dropped.
    fn drop_groups(&mut self, folds: &[Fold], fit: &FitTask) -> Result<Vec<Group>> {
        let (groups, progress) = (fit.parameters.groups(), fit.progress);
        let mut dropped = Vec::new();
        while dropped.len() + 1 < groups.len() {
            let left = groups.iter().filter(|group| !dropped.contains(*group));
            let left: Vec<Group> = left.copied().collect();
            let without = |group: &Group| {
                let held = [&dropped[..], &[*group]].concat();
                let of = |(fold, own): (&Fold, &Vec<f64>)| fold.own.without(*group, own);
                let from: Vec<Vec<f64>> = folds.iter().zip(&self.numbers).map(of).collect();
                Ok((*group, Self::new(folds, &from, self.mean.pull, &held)?))
            };
            let tried: Vec<(Group, Self)> = left.par_iter().map(without).collect::<Result<_>>()?;
            let best = tried
                .into_iter()
                .reduce(|best, next| if next.1.mean.is_less(&best.1.mean) { next } else { best });
            let best = best.filter(|(_, best)| best.mean.is_less(&self.mean));
            let words = best.as_ref().map_or("no group", |(group, _)| group.name());
            let fits = left.len() * folds.len();
            progress.finished(&format!("{fits} fits, each without one group: {words} is dropped"));
            match best {
                Some((group, best)) => {
                    dropped.push(group);
                    *self = best;
                }
                None => break,
            }
        }
        Ok(dropped)
    }
}

/// A motion that is left out, while one weight after the other is tried.
struct Fold<'a> {
    own: FitTask<'a>,
    unseen: Unseen<'a>,
    /// The cost of the sets of the other motions for the model that a fit starts from.
    start_cost: f64,
}

/// Chooses among the weights, and drops groups of parameters; or tries the weight `given` only,
/// with all groups.
///
/// For each motion the model is fitted, and its sets are found, without it. The weight is chosen
/// whose sets cost least in the mean once they have grown until they enclose the motion. Weaker
/// weights than the first one that is worse are not tried. A group without which this mean is less
/// is dropped. `limits` has what limits the sets of the other motions, for each motion.
pub(crate) fn choose(fit: &FitTask, limits: &[Limits], given: Option<f64>) -> Result<PullChoice> {
    let pulls = given.map_or_else(|| PULLS.to_vec(), |pull| vec![pull]);
    let started =
        limits.par_iter().enumerate().map(|(motion, limits)| Fold::new(fit, motion, limits));
    let folds: Vec<Fold> = started.collect::<Result<_>>()?;
    let identified = fit.parameters.none();
    let identified = folds.par_iter().map(|Fold { unseen: Unseen { whole, motion }, .. }| {
        let whole = FitTask { parameters: &*identified, ..whole.clone() };
        Ok(Unseen { whole, motion: *motion }.compare(&[])?.0)
    });
    let identified = identified.collect::<Result<_>>()?;
    let (mut tried, mut best) = (Vec::<PullCost>::new(), None::<Folded>);
    let mut numbers = vec![fit.parameters.start(); folds.len()];
    let began = Instant::now();
    for pull in pulls {
        let folded = Folded::new(&folds, &numbers, pull, &[])?;
        if given.is_none() {
            let words = folded.mean.in_words(folds.len());
            let left = tried.is_empty().then(|| time_left(fit.parameters, began.elapsed()));
            fit.progress.finished(&(words + &left.unwrap_or_default()));
        }
        tried.push(folded.mean.clone());
        if best.as_ref().is_some_and(|best| !folded.mean.is_less(&best.mean)) {
            break;
        }
        numbers.clone_from(&folded.numbers);
        best = Some(folded);
    }
    let mut best = best.unwrap_or_default();
    let dropped = match given {
        Some(_) => Vec::new(),
        None => best.drop_groups(&folds, fit)?,
    };
    let Folded { mean: PullCost { pull, .. }, left_out, missing, .. } = best;
    if given.is_none() {
        fit.progress.finished(&format!("the weight of the pull is {pull}"));
    }
    let missing = missing.into_iter().collect();
    Ok(PullChoice { pull, left_out, missing, identified, tried, dropped })
}

/// Returns in words how long a fit may still take after its first round of fits without each
/// motion: a round for each other weight and each group that may be dropped, and about two for the
/// answer.
fn time_left(parameters: &dyn Parameters, round: Duration) -> String {
    let groups = parameters.groups().len();
    let rounds = PULLS.len() - 1 + (groups * (groups + 1) / 2 - 1) + 2;
    let seconds = (rounds as f64 * round.as_secs_f64()).ceil();
    format!("; this fit takes about {seconds} s more")
}

impl<'a> Fold<'a> {
    fn new(fit: &FitTask<'a>, motion: usize, limits: &Limits) -> Result<Self> {
        let own = FitTask { limits: limits.clone(), ..fit.clone() };
        let unseen = Unseen { whole: FitTask { stride: 1, ..own.clone() }, motion };
        let (start, tracks) = (own.parameters.start(), own.tracks(Some(motion)));
        let start_cost = own.smallest(&own.model(&start, &tracks)?, &tracks)?.cost;
        Ok(Self { own, unseen, start_cost })
    }

    /// Fits with a weight from the numbers `from`, and compares the motion with the others' sets.
    /// Returns the numbers too.
    fn fit(&self, pull: f64, from: &[f64], held: &[Group]) -> Result<FoldFit> {
        let wanted = Wanted {
            left_out: Some(self.unseen.motion),
            pull: pull * self.start_cost,
            free: self.own.parameters.except(held),
            effort: SearchEffort::QUICK,
        };
        // Without a group a nominal motion may diverge until the others are fitted again.
        let start = self.own.parameters.start();
        let found = match self.own.search(&wanted, from) {
            Err(Error::RunsAway { .. }) => self.own.search(&wanted, &start),
            found => found,
        };
        let numbers = match found {
            Err(Error::RunsAway { .. }) => {
                let name = self.own.data.motions[self.unseen.motion].clone();
                return Ok(((UnseenMotion::runs_away(name), None), start));
            }
            found => found?.numbers,
        };
        Ok((self.unseen.compare(&numbers)?, numbers))
    }
}

/// How a fit carries over to its motion, with the rows that are missing, and its numbers.
type FoldFit = ((UnseenMotion, Option<Missing>), Vec<f64>);
