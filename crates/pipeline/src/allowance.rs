//! An allowance of the sets for motions that were not recorded.
//!
//! The smallest sets enclose what was recorded and nothing more. Each motion is left out in turn,
//! and the sets of the others say how far it leaves them. If that is half again what is accepted of
//! motions that are held out, or more, radii are added to the sets, before the held-out motions are
//! looked at: the least factor of X0 and the input's error that covers all motions that were left
//! out, and that one more motion needs with a probability of 5 % at most, if motions need factors
//! of one normal distribution. From what is accepted to half again that, a part of these radii is
//! added that grows from none to all, so that a sample more or less cannot make the sets jump.

use reachtube_conform::Answer;
use reachtube_conform::next_motion::LeftOut;
use reachtube_finding::Finding;

use crate::carried_over::{Unseen, unseen};
use crate::checked_choices::LARGEST_RADIUS;
use crate::error::Result;
use crate::findings::not_enclosed;
use crate::foretold::Foretold;
use crate::prediction::upper_bound;
use crate::rounding::rounded_up;
use crate::trial::Trial;
use crate::windows::Prepared;

/// Sets with an allowance.
pub(crate) struct Widened {
    /// The wider sets.
    pub answer: Answer,
    /// What was added to the radii of X0 and U, 3n; empty if nothing was.
    pub allowance: Vec<f64>,
    /// Why.
    pub reason: String,
    /// A motion that was left out and that no allowance encloses.
    pub finding: Option<Finding>,
    /// The sets before, as wide as motions need them that were left out.
    pub foretold: Foretold,
}

/// An allowance, why, and what speaks against it.
type Asked = (Vec<f64>, String, Option<Finding>);

impl Widened {
    /// Finds the sets for all windows of `horizon` \[s\], and adds an allowance: the one that is
    /// given, or what motions ask for that are left out in turn of all that was made of them.
    ///
    /// # Errors
    ///
    /// As [`Trial::run`] and [`Trial::carried_over`].
    pub(crate) fn new(trial: &Trial, recordings: &Prepared, horizon: f64) -> Result<Self> {
        let answer = trial.run_over(horizon, recordings.cut(horizon, usize::MAX)?)?;
        let left_out = match recordings.from_start {
            true => unseen(&answer),
            false => trial.carried_over(&answer, recordings, horizon)?,
        };
        let found = Self::with(trial, recordings, answer, &left_out)?;
        let left_out = left_out.into_iter().map(|unseen| unseen.left_out).collect();
        Ok(Self { answer: found.answer.with_left_out(left_out), ..found })
    }

    /// Does what [`new`](Self::new) does for `most` windows at most, where motions are left out of
    /// the sets only.
    ///
    /// # Errors
    ///
    /// As [`Trial::run`].
    pub(crate) fn of_some(
        trial: &Trial,
        recordings: &Prepared,
        horizon: f64,
        most: usize,
    ) -> Result<Self> {
        let answer = trial.run_over(horizon, recordings.cut(horizon, most)?)?;
        let left_out = unseen(&answer);
        Self::with(trial, recordings, answer, &left_out)
    }

    fn with(
        trial: &Trial,
        recordings: &Prepared,
        answer: Answer,
        left_out: &[Unseen],
    ) -> Result<Self> {
        let (allowance, reason, finding) = match trial.allowance.clone() {
            Some(allowance) => (allowance, "given".into(), None),
            // What is held out of repeated recordings is of the same motions.
            None if recordings.from_start => {
                (Vec::new(), "for the motions that were recorded".into(), None)
            }
            None => asked(&answer, left_out, [trial.largest_outside, trial.largest_growth]),
        };
        let foretold = Foretold::new(&answer, left_out);
        let answer =
            if allowance.is_empty() { answer } else { answer.widened(allowance.clone())? };
        Ok(Self { answer, allowance, reason, finding, foretold })
    }

    /// Returns these sets with the reason for the allowance of sets `before`, which faster motions
    /// left; with it, the part `outside` of their rows does.
    pub(crate) fn because(self, before: &Self, outside: f64) -> Self {
        let reason = format!(
            "{}; with it, {:.1} % of the rows of the faster half of the motions leave the sets of \
             the slower half, as is accepted",
            before.reason,
            100.0 * outside
        );
        Self { reason, finding: before.finding.clone(), ..self }
    }

    pub(crate) fn words(&self) -> String {
        let joints = &self.answer.model.signals.parts;
        let of_input = self.allowance.iter().skip(2 * joints.len()).copied().enumerate();
        match of_input.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((joint, most)) => {
                let has_starts = self.allowance[0] > 0.0;
                let what = if has_starts { "X0 and U wider, U by" } else { "U wider by" };
                format!("{what} up to {most:.2} N m ({})", joints[joint].name)
            }
            None => "none".into(),
        }
    }
}

/// Returns the allowance that motions ask for which were left out in turn, rounded up to three
/// digits; empty if no more than a part of their rows leaves the sets of the others, and none needs
/// more than a factor: the two limits `most`. Where a limit is hardly exceeded, it is small.
fn asked(answer: &Answer, all: &[Unseen], most: [f64; 2]) -> Asked {
    if all.len() < 2 {
        return (Vec::new(), "there is a single motion or part".into(), None);
    }
    let left_out = || all.iter().map(|unseen| &unseen.left_out);
    let rows: usize = left_out().map(|left| left.rows).sum();
    let outside: usize = left_out().filter_map(|left| left.outside).sum();
    let part = outside as f64 / rows.max(1) as f64;
    let growth = left_out().map(LeftOut::growth).fold(1.0, f64::max);
    let leave = format!("{:.1} % of the rows leave the sets of the others", 100.0 * part);
    let grow = match growth.is_finite() {
        true => format!("one needs sets {growth:.1} times as wide"),
        false => "no factor of these sets encloses one".into(),
    };
    let leave = format!("of {} motions or parts left out in turn, {leave}, and {grow}", all.len());
    let share = share([[part, 0.0, most[0]], [growth, 1.0, most[1]]]);
    if share == 0.0 {
        let accepted = format!("at most {} % and {} are accepted", 100.0 * most[0], most[1]);
        return (Vec::new(), format!("{leave}; {accepted}"), None);
    }
    let factors: Option<Vec<f64>> = all.iter().map(|unseen| unseen.factor).collect();
    let Some((factors, needed)) = factors.zip(answer.found.allowance_needed.as_ref()) else {
        let without = all.iter().find(|unseen| unseen.factor.is_none());
        let finding = without.map(|unseen| not_enclosed(&unseen.left_out));
        return (Vec::new(), format!("{leave}; no allowance encloses them"), finding);
    };
    let factor = upper_bound(&factors);
    let radius = |radius: &f64| rounded_up(share * factor * radius, 3);
    let allowance: Vec<f64> = needed.shape.iter().map(radius).collect();
    if !allowance.iter().all(|radius| *radius <= LARGEST_RADIUS) {
        return (
            Vec::new(),
            format!("{leave}; no allowance of a sensible size encloses them"),
            None,
        );
    }
    let largest = factors.iter().copied().fold(0.0, f64::max);
    let starts = if needed.shape[0] > 0.0 { "X0 and " } else { "" };
    let mut reason = format!(
        "{leave}; they need up to {largest:.2} times {starts}the error of the input, and \
         {factor:.2} times is the bound at 95 % for one more"
    );
    if share < 1.0 {
        reason += &format!(
            "; {:.0} % of that is added, as the limits are exceeded by less than half",
            100.0 * share
        );
    }
    (allowance, reason, None)
}

/// Returns the share of an allowance that is added: none while no value exceeds its limit, and all
/// once one exceeds its limit by half or more, counted from the least value. The entries are
/// \[value, least value, limit\].
fn share(values: [[f64; 3]; 2]) -> f64 {
    let beyond = |[value, least, limit]: [f64; 3]| match value > limit {
        true => (2.0 * (value - limit) / (limit - least)).min(1.0),
        false => 0.0,
    };
    values.map(beyond).into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use reachtube_arm::{ArmModel, ArmSettings, Equations, setup};
    use reachtube_conform::settings::NominalStart;
    use reachtube_conform::{Check, CheckJob, Job, Model, Noise, Settings, Silent};
    use reachtube_finding::Severity;
    use reachtube_recordings::{MemoryRuns, Run, Torque};
    use reachtube_robot::Robot;

    use super::*;
    use crate::pendulum::pendulum;

    /// Returns windows of some motions of a pendulum, whose torques are off by a part of `errors`.
    fn windows(robot: &Robot, motions: &[(&str, f64)]) -> MemoryRuns {
        let mut runs = MemoryRuns::default();
        for (name, error) in motions {
            for window in 0..3 {
                let start = 0.7 * f64::from(window);
                let times: Vec<f64> = (0..41).map(|k| 0.005 * f64::from(k)).collect();
                let at = |t: &f64| 2.0 * (start + t) + error;
                let states = times.iter().flat_map(|t| [at(t).sin(), 2.0 * at(t).cos()]).collect();
                let torque = |t: &f64| {
                    let [q, qd] = [at(t).sin(), 2.0 * at(t).cos()];
                    robot.inverse_dynamics(&[q], &[qd], &[-4.0 * q])[0]
                        - robot.gravity_torque(&[q])[0]
                        + error * (9.0 * at(t)).sin()
                };
                let torques = times.iter().map(torque).collect();
                // What the samples before tell of the start is off by a little.
                let told = [at(&0.0).sin() + 0.1 * error, 2.0 * at(&0.0).cos() - 0.1 * error, 0.0];
                let run = Run::new(1, times.clone(), states, torques).unwrap();
                let run = Run { before: told.to_vec(), ..run };
                let suite = format!("{name} {window}");
                runs.push(&suite, Some(&suite), Some(name), run);
            }
        }
        runs
    }

    fn answer(robot: &Robot, nominal: NominalStart, motions: &[(&str, f64)]) -> Answer {
        let settings = Settings {
            noise: Noise::Fitted,
            sensor_noise: Some(vec![1e-6; 2]),
            nominal,
            ..Settings::default()
        };
        let arm =
            ArmSettings { equations: Equations::Robot, ..ArmSettings::new(Torque::Compensated, 1) };
        let setup = setup(robot.clone(), arm, settings).unwrap();
        Job::new(setup, windows(robot, motions)).run(&Silent).unwrap()
    }

    fn check(model: &Model, runs: MemoryRuns) -> Check {
        let job = CheckJob::new(model.clone(), model.setup().unwrap(), runs);
        job.run(&Silent).unwrap()
    }

    #[test]
    fn an_allowance_grows_from_none_to_all_beyond_what_is_accepted() {
        let of = |part: f64, growth: f64| share([[part, 0.0, 0.01], [growth, 1.0, 2.0]]);
        assert_eq!(
            [of(0.0, 1.0), of(0.01, 2.0), of(0.016, 1.0), of(0.9, 1.0)],
            [0.0, 0.0, 1.0, 1.0]
        );
        assert!((of(0.0125, 2.0) - 0.5).abs() < 1e-12 && (of(0.0125, 2.4) - 0.8).abs() < 1e-12);
        assert_eq!(of(0.0, f64::INFINITY), 1.0);
        // A limit at the least value leaves no room for less than all.
        let strict =
            |part: f64, growth: f64| share([[part, 0.0, 0.0], [growth, 1.0, f64::INFINITY]]);
        assert_eq!([strict(0.0, 9.0), strict(1e-9, 1.0)], [0.0, 1.0]);
    }

    #[test]
    fn a_motion_that_no_allowance_encloses_is_named() {
        let answer = answer(&pendulum(), NominalStart::Own, &[("a", 0.1), ("b", 0.2), ("c", 0.3)]);
        let mut left_out = unseen(&answer);
        left_out[1].factor = None;
        let (allowance, reason, finding) = asked(&answer, &left_out, [0.0, f64::INFINITY]);
        assert!(allowance.is_empty() && reason.ends_with("no allowance encloses them"), "{reason}");
        let finding = finding.unwrap();
        assert_eq!((finding.code.name(), finding.place.as_deref()), ("left-out", Some("b")));
        assert_eq!(finding.severity, Severity::Warning);
        assert!(finding.text.contains("enclose b, which was left out"), "{finding}");
        // As the sets of a constant motion, which any other motion leaves by far.
        left_out[1].factor = Some(1e300);
        let (allowance, reason, _) = asked(&answer, &left_out, [0.0, f64::INFINITY]);
        assert!(allowance.is_empty() && reason.contains("no allowance of a sensible size"));
        // What is accepted anyway needs none.
        assert_eq!(asked(&answer, &left_out, [1.0, f64::INFINITY]).2, None);
    }

    #[test]
    fn with_the_allowance_the_sets_of_the_others_enclose_each_motion() {
        let robot = pendulum();
        let all = [("a", 0.1), ("b", 0.2), ("c", 0.3)];
        for nominal in [NominalStart::Own, NominalStart::Past] {
            let asked = |most: f64| {
                let answer = answer(&robot, nominal, &all);
                asked(&answer, &unseen(&answer), [most, f64::INFINITY])
            };
            let (allowance, reason, finding) = asked(0.0);
            assert_eq!(finding, None);
            let is_limited = nominal == NominalStart::Own;
            assert!(allowance[..2].iter().all(|radius| (*radius == 0.0) == is_limited));
            assert_eq!(reason.contains("X0 and the error"), !is_limited, "{reason}");
            assert!(allowance[2] > 0.01, "{allowance:?}, {reason}");
            let mut outside = 0;
            for left_out in 0..all.len() {
                let others: Vec<_> =
                    (0..3).filter(|at| *at != left_out).map(|at| all[at]).collect();
                let own = || windows(&robot, &all[left_out..=left_out]);
                let smallest = answer(&robot, nominal, &others);
                outside += usize::from(!check(&smallest.model, own()).holds());
                let wider = smallest.widened(allowance.clone()).unwrap();
                assert!(wider.holds());
                let check = check(&wider.model, own());
                assert!(check.holds(), "{}: {:?}", all[left_out].0, check.verdict.violations);
            }
            assert!(outside > 0, "without the allowance some motion leaves the sets");
            assert!(asked(1.0).0.is_empty(), "all rows may leave the sets");
        }
        let own = answer(&robot, NominalStart::Own, &all);
        let wrong = own.widened(vec![0.0; 2]).unwrap_err().to_string();
        assert!(wrong.contains("allowance"), "{wrong}");
    }
}
