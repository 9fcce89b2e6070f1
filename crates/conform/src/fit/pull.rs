//! The weight of the pull toward the identified values, chosen by leaving one motion out.

use rayon::prelude::*;

use crate::error::Result;
use crate::fit::evaluation::FitTask;
use crate::fit::parameters::Parameters;
use crate::fit::record::{PullCost, UnseenMotion};
use crate::fit::search::SearchEffort;
use crate::fit::unseen::Unseen;
use crate::fit::working_set::Wanted;
use crate::program::layout::Limits;

/// The weights that are tried, in parts of the identified model's cost per unit, the strongest
/// first.
const PULLS: [f64; 6] = [0.3, 0.1, 0.03, 0.01, 0.003, 0.001];

/// The pull that was chosen.
pub(crate) struct PullChoice {
    pub pull: f64,
    /// How the model that was fitted without each motion carries over to it.
    pub left_out: Vec<UnseenMotion>,
    /// How the identified model carries over to each motion.
    pub identified: Vec<UnseenMotion>,
    /// The mean costs for each weight that was tried.
    pub tried: Vec<PullCost>,
}

impl PullChoice {
    /// Returns whether fits carry over to motions that they have not seen at least as well as the
    /// identified model.
    pub(crate) fn carries_over(&self) -> bool {
        let means = [&self.identified, &self.left_out].map(|of| PullCost::new(self.pull, of));
        !means[0].is_less(&means[1])
    }
}

/// A motion that is left out, while one weight after the other is tried.
struct Fold<'a> {
    own: FitTask<'a>,
    unseen: Unseen<'a>,
    /// The cost of the sets of the other motions for the model that a fit starts from.
    start_cost: f64,
    numbers: Vec<f64>,
}

/// Chooses among the weights, or tries `given` only.
///
/// For each motion the model is fitted, and its sets are found, without it. The weight is chosen
/// whose sets cost least in the mean once they have grown until they enclose the motion. Weaker
/// weights than the first one that is worse are not tried. `limits` has what limits the sets of the
/// other motions, for each motion.
///
/// # Errors
///
/// As [`FitTask::search`] and [`Unseen::compare`].
pub(crate) fn choose(fit: &FitTask, limits: &[Limits], given: Option<f64>) -> Result<PullChoice> {
    let pulls = given.map_or_else(|| PULLS.to_vec(), |pull| vec![pull]);
    let started =
        limits.par_iter().enumerate().map(|(motion, limits)| Fold::new(fit, motion, limits));
    let mut folds: Vec<Fold> = started.collect::<Result<_>>()?;
    let identified = Parameters::new(fit.parameters.setup(), &[], &[]);
    let identified = folds.par_iter().map(|Fold { unseen: Unseen { whole, motion }, .. }| {
        let whole = FitTask { parameters: &identified, ..whole.clone() };
        Unseen { whole, motion: *motion }.compare(&[])
    });
    let identified = identified.collect::<Result<_>>()?;
    let (mut tried, mut best) = (Vec::<PullCost>::new(), None);
    for pull in pulls {
        let left_out =
            folds.par_iter_mut().map(|fold| fold.fit(pull)).collect::<Result<Vec<_>>>()?;
        let mean = PullCost::new(pull, &left_out);
        let is_better = best.as_ref().is_none_or(|(least, _)| mean.is_less(least));
        tried.push(mean.clone());
        if is_better {
            best = Some((mean, left_out));
        } else {
            break;
        }
    }
    let (PullCost { pull, .. }, left_out) = best.unwrap_or_default();
    Ok(PullChoice { pull, left_out, identified, tried })
}

impl<'a> Fold<'a> {
    fn new(fit: &FitTask<'a>, motion: usize, limits: &Limits) -> Result<Self> {
        let own = FitTask { limits: limits.clone(), ..fit.clone() };
        let unseen = Unseen { whole: FitTask { stride: 1, ..own.clone() }, motion };
        let (numbers, tracks) = (own.parameters.start(), own.tracks(Some(motion)));
        let start_cost = own.smallest(&own.model(&numbers, &tracks, None)?, &tracks)?.cost;
        Ok(Self { own, unseen, start_cost, numbers })
    }

    /// Fits with a weight from the answer before, and compares the motion with the others' sets.
    fn fit(&mut self, pull: f64) -> Result<UnseenMotion> {
        let wanted = Wanted {
            left_out: Some(self.unseen.motion),
            pull: pull * self.start_cost,
            held: Vec::new(),
            effort: SearchEffort::QUICK,
        };
        self.numbers = self.own.search(&wanted, &self.numbers)?.numbers;
        self.unseen.compare(&self.numbers)
    }
}
