//! An allowance of the sets for motions that were not recorded.
//!
//! The smallest sets enclose what was recorded and nothing more. Each motion is left out in turn,
//! and the sets of the others say how far it leaves them. If that is more than what is accepted of
//! motions that are held out, radii that cover all of it are added to the sets, before the held-out
//! motions are looked at.

use reachtube_conform::Answer;

use crate::error::Result;
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
}

impl Widened {
    /// Finds the sets for windows of `horizon` \[s\], at most `most` of them, and adds an
    /// allowance: the one that is given, or what each motion that is left out in turn asks for.
    ///
    /// # Errors
    ///
    /// As [`Trial::run`].
    pub(crate) fn new(
        trial: &Trial,
        recordings: &Prepared,
        horizon: f64,
        most: usize,
    ) -> Result<Self> {
        let answer = trial.run(recordings.cut(horizon, most)?)?;
        let (allowance, reason) = match trial.allowance.clone() {
            Some(allowance) => (allowance, "given".into()),
            // What is held out of repeated recordings is of the same motions.
            None if recordings.from_start => {
                (Vec::new(), "for the motions that were recorded".into())
            }
            None => asked(&answer, trial.largest_outside),
        };
        Self::with(answer, allowance, reason)
    }

    fn with(answer: Answer, allowance: Vec<f64>, reason: String) -> Result<Self> {
        let answer =
            if allowance.is_empty() { answer } else { answer.widened(allowance.clone())? };
        Ok(Self { answer, allowance, reason })
    }

    /// Returns the allowance in words.
    pub(crate) fn words(&self) -> String {
        let joints = &self.answer.model.robot.joints;
        let of_input = self.allowance.iter().skip(2 * joints.len()).copied().enumerate();
        match of_input.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((joint, most)) => {
                format!("U wider by up to {most:.2} N m ({})", joints[joint].name)
            }
            None => "none".into(),
        }
    }
}

/// Returns the allowance that the motions ask for which were left out in turn, rounded up to three
/// digits, and why; empty if no more than the part `most` of their rows leaves the sets of the
/// others.
fn asked(answer: &Answer, most: f64) -> (Vec<f64>, String) {
    let all = &answer.found.left_out;
    if all.len() < 2 {
        return (Vec::new(), "there is a single motion or part".into());
    }
    let rows: usize = all.iter().map(|left| left.rows).sum();
    let outside: usize = all.iter().filter_map(|left| left.outside).sum();
    let part = outside as f64 / rows.max(1) as f64;
    let leave = format!(
        "of {} motions or parts left out in turn, {:.1} % of the rows leave the sets of the others",
        all.len(),
        100.0 * part
    );
    match &answer.found.allowance_needed {
        _ if part <= most => {
            (Vec::new(), format!("{leave}; at most {} % is accepted", 100.0 * most))
        }
        None => (Vec::new(), format!("{leave}, and no allowance encloses them")),
        Some(allowance) => {
            let allowance = allowance.iter().map(|radius| rounded_up(*radius)).collect();
            (allowance, format!("{leave}; with the allowance none do"))
        }
    }
}

/// Rounds up to three digits.
fn rounded_up(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let exponent = value.log10().floor() as i32 - 2;
    let digits = (value / 10f64.powi(exponent)).ceil();
    // The shortest number with these digits.
    format!("{digits}e{exponent}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use reachtube_conform::settings::{Equations, NominalStart};
    use reachtube_conform::{Job, Noise, Settings, Silent};
    use reachtube_recordings::{MemoryRuns, Run, Torque};
    use reachtube_robot::Robot;

    use super::*;

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
                let run = Run::new(1, times.clone(), states, torques).unwrap();
                let suite = format!("{name} {window}");
                runs.push(&suite, Some(&suite), Some(name), run);
            }
        }
        runs
    }

    fn answer(robot: &Robot, motions: &[(&str, f64)]) -> Answer {
        let settings = Settings {
            noise: Noise::Fitted,
            sensor_noise: Some(vec![1e-6; 2]),
            nominal: NominalStart::Own,
            equations: Equations::Robot,
            ..Settings::new(Torque::Compensated, 1)
        };
        let job = Job::new(robot.clone(), windows(robot, motions), Torque::Compensated);
        job.settings(settings).run(&Silent).unwrap()
    }

    #[test]
    fn with_the_allowance_the_sets_of_the_others_enclose_each_motion() {
        let robot = "schema_version = 1\nname = \"pendulum\"\n[[joint]]\nname = \"hinge\"\n\
                     placement = { translation = [0.0, 0.0, 1.0] }\naxis = [0.0, 1.0, 0.0]\n\
                     mass = 1.0\ncom = [0.0, 0.0, -0.3]\n\
                     inertia = [0.02, 0.0, 0.0, 0.02, 0.0, 0.01]\n";
        let robot = Robot::from_toml(robot, "pendulum").unwrap();
        let all = [("a", 0.1), ("b", 0.2), ("c", 0.3)];
        let (allowance, reason) = asked(&answer(&robot, &all), 0.0);
        assert_eq!(allowance[..2], [0.0; 2], "the noise limits X0");
        assert!(allowance[2] > 0.01, "{allowance:?}, {reason}");
        let mut outside = 0;
        for left_out in 0..all.len() {
            let others: Vec<_> = (0..3).filter(|at| *at != left_out).map(|at| all[at]).collect();
            let own = || windows(&robot, &all[left_out..=left_out]);
            let smallest = answer(&robot, &others);
            outside += usize::from(!smallest.model.check(own()).run(&Silent).unwrap().holds());
            let wider = smallest.widened(allowance.clone()).unwrap();
            assert!(wider.holds());
            let check = wider.model.check(own()).run(&Silent).unwrap();
            assert!(check.holds(), "{}: {:?}", all[left_out].0, check.verdict.violations);
        }
        assert!(outside > 0, "without the allowance some motion leaves the sets");
        assert!(asked(&answer(&robot, &all), 1.0).0.is_empty(), "all rows may leave the sets");
        let wrong = answer(&robot, &all).widened(vec![0.0; 2]).unwrap_err().to_string();
        assert!(wrong.contains("allowance"), "{wrong}");
    }

    #[test]
    fn allowances_are_rounded_up_to_three_digits() {
        assert_eq!([0.0, 1.2301e-3, 1.25, 98.71].map(rounded_up), [0.0, 1.24e-3, 1.25, 98.8]);
    }
}
