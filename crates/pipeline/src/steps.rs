//! The steps of a job that are finished, in a file, so that a job that was killed continues there.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use reachtube_files::{Journal, hex};
use reachtube_identify::prepare::RawLog;
use reachtube_recordings::Torque;
use reachtube_robot::Robot;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use sha2::{Digest, Sha256};

use crate::choices::Choices;
use crate::error::Result;

/// The finished steps of a job, and the file that keeps them, if there is one.
pub(crate) struct Steps<'a> {
    /// The file, and whether there is one.
    journal: (Journal<'a>, bool),
    found: RefCell<BTreeMap<String, Value>>,
}

impl<'a> Steps<'a> {
    /// Opens the journal of a job. What the file has of another job, or what is no journal, does
    /// not count: it is replaced by the first step.
    pub(crate) fn open(path: Option<&'a Path>, job: String) -> Self {
        let journal = Journal::new(path, job);
        let found = RefCell::new(journal.load().ok().flatten().unwrap_or_default());
        Self { journal: (journal, path.is_some()), found }
    }

    /// Returns what the step `name` found before, or does it and keeps what it finds. The job and
    /// the name decide the answer. Numbers that are not finite cannot be kept.
    ///
    /// # Errors
    ///
    /// An error of the step, which is not kept, and a file that cannot be written.
    pub(crate) fn step<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        run: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let known = self.found.borrow().get(name).cloned();
        if let Some(found) = known.and_then(|value| serde_json::from_value(value).ok()) {
            return Ok(found);
        }
        let found = run()?;
        let value = serde_json::to_value(&found).expect("the keys of a step are strings");
        self.found.borrow_mut().insert(name.into(), value);
        if let (journal, true) = &self.journal {
            journal.save(&*self.found.borrow())?;
        }
        Ok(found)
    }
}

/// Returns the digest of a job: the robot, the choices that are given, and the digest of the
/// recordings.
pub(crate) fn digest(robot: &Robot, torque: Torque, given: &Choices, data: &str) -> String {
    let job = (robot.description(), torque, given, data);
    let job = serde_json::to_string(&job).expect("the keys of choices are strings");
    hex(&Sha256::digest(job))
}

/// Returns the digest of recordings and of the motions that some of them show.
pub(crate) fn data_digest(raw: &[Arc<RawLog>], motions: &[String]) -> String {
    let mut sha256 = Sha256::new();
    sha256.update(motions.join("\n"));
    for log in raw {
        sha256.update(log.name.as_bytes());
        sha256.update(log.file.as_os_str().as_encoded_bytes());
        sha256.update(log.order.unwrap_or_default().to_le_bytes());
        for column in [&log.run.times, &log.run.states, &log.run.torques, &log.run.temperatures] {
            sha256.update(column.len().to_le_bytes());
            column.iter().for_each(|value| sha256.update(value.to_le_bytes()));
        }
    }
    hex(&sha256.finalize())
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use reachtube_conform::{Progress, Silent};
    use reachtube_recordings::RunSource;

    use super::*;
    use crate::build::{Built, build};
    use crate::error::Error;
    use crate::pendulum::pendulum;

    /// Stops a job once its journal has this many steps.
    struct StopsAt<'a> {
        journal: &'a Path,
        steps: usize,
    }

    impl Progress for StopsAt<'_> {
        fn is_cancelled(&self) -> bool {
            steps(self.journal).len() >= self.steps
        }
    }

    fn steps(journal: &Path) -> BTreeMap<String, Value> {
        let text = std::fs::read_to_string(journal).unwrap_or_default();
        let file = serde_json::from_str::<Value>(&text).unwrap_or_default();
        serde_json::from_value(file["progress"].clone()).unwrap_or_default()
    }

    /// Writes three logs of a pendulum, which has twice the mass of its description, and returns
    /// the description.
    fn logs(folder: &Path) -> Robot {
        for (name, seed) in [("a", 0.1), ("b", 0.4), ("c", 0.7)] {
            let mut text = String::from("t,q1,qd1,tau1\n");
            for k in 0..2000 {
                let t = 0.005 * f64::from(k);
                let waves = [(0.6, 1.1 + seed, 0.0), (0.3, 2.3, seed), (0.1, 4.1 - seed, 1.0)];
                let sum = |part: &dyn Fn(f64, f64, f64) -> f64| -> f64 {
                    waves.iter().map(|(a, w, p)| part(*a, *w, w * t + p)).sum()
                };
                let (q, qd) = (sum(&|a, _, at| a * at.sin()), sum(&|a, w, at| a * w * at.cos()));
                let qdd = sum(&|a, w, at| -a * w * w * at.sin());
                let tau = 0.5 * qdd + 0.8 * qd + qd.signum() + 2.0 * 9.81 * 0.4 * q.sin();
                writeln!(text, "{t:.3},{q:.9},{qd:.9},{tau:.9}").unwrap();
            }
            std::fs::write(folder.join(format!("{name}.csv")), text).unwrap();
        }
        pendulum()
    }

    #[test]
    fn a_job_that_is_stopped_after_any_step_continues_to_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let robot = logs(folder.path());
        let given = Choices { data: vec![folder.path().into()], ..Choices::default() };
        let run = |journal: Option<&Path>, progress: &dyn Progress| -> Result<Built> {
            build(&robot, Torque::Motor, &given, journal, &mut |_| (), progress)
        };
        let whole = run(None, &Silent).unwrap().files();
        let path = folder.path().join("progress.json");
        let mut stops = 0;
        loop {
            let built = run(Some(&path), &StopsAt { journal: &path, steps: stops + 1 });
            match built {
                Ok(built) => {
                    assert_eq!(built.files(), whole);
                    break;
                }
                // Each attempt gets one step further.
                Err(_) => assert!(steps(&path).len() > stops, "{:?}", steps(&path).keys()),
            }
            stops = steps(&path).len();
        }
        assert!(stops > 8, "{stops} stops");
    }

    /// Keeps the reports of a job.
    #[derive(Default)]
    struct Told(std::sync::Mutex<Vec<String>>);

    impl Progress for Told {
        fn finished(&self, what: &str) {
            self.0.lock().unwrap().push(what.into());
        }
    }

    #[test]
    fn a_fit_is_tried_over_no_horizon_that_is_narrow_without_it() {
        let folder = tempfile::tempdir().unwrap();
        let robot = logs(folder.path());
        let built = |horizon: Option<f64>| {
            let fit = Some(vec![reachtube_conform::Group::Viscous]);
            let data = vec![folder.path().into()];
            let given = Choices { data, fit, horizon, ..Choices::default() };
            let told = Told::default();
            let built = build(&robot, Torque::Motor, &given, None, &mut |_| (), &told).unwrap();
            (built, told.0.into_inner().unwrap())
        };
        let fits = |told: &[String]| {
            told.iter().filter(|what| what.starts_with("the weight of the pull")).count()
        };
        // One fit over all windows of the horizon that is given.
        let (own, told) = built(Some(0.3));
        assert_eq!(fits(&told), 1, "{told:?}");
        let tried = |built: &Built| -> Vec<(f64, bool)> {
            built.horizons.iter().map(|tried| (tried.horizon, tried.with_fit)).collect()
        };
        assert_eq!(tried(&own), [(0.2, false), (0.3, true)]);
        // Without a horizon, a fit for each longer one and one for the answer.
        let (own, told) = built(None);
        let (tried, chosen) = (tried(&own), own.choices.horizon.unwrap());
        let longer = tried.iter().filter(|(horizon, with_fit)| *with_fit && *horizon != chosen);
        assert_eq!(fits(&told), 1 + longer.count(), "{tried:?} {told:?}");
        assert!(tried.iter().all(|(horizon, with_fit)| *with_fit == (*horizon >= chosen)));
    }

    #[test]
    fn warm_up_is_not_fitted_to_recordings_in_no_order() {
        let folder = tempfile::tempdir().unwrap();
        let robot = logs(folder.path());
        let fit = Some(vec![reachtube_conform::Group::WarmUp]);
        let given = Choices { data: vec![folder.path().into()], fit, ..Choices::default() };
        let build = || build(&robot, Torque::Motor, &given, None, &mut |_| (), &Silent);
        let refused = build().err().unwrap().to_string();
        assert!(refused.contains("a.csv; give an index runs.csv"), "{refused}");
        let index = "file,suite,order\na.csv,a,4\nb.csv,b,2\nc.csv,c,9\n";
        std::fs::write(folder.path().join("runs.csv"), index).unwrap();
        let held_out = build().unwrap().shown_held_out;
        assert!(held_out.runs().iter().all(|run| run.order == 9 && run.file.contains('c')));
        assert!(!held_out.runs().is_empty());
    }

    #[test]
    fn steps_are_done_once_and_belong_to_their_job() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("progress.json");
        let third = 1.0 / 3.0;
        let first = Steps::open(Some(&path), "a".into());
        assert_eq!(first.step("one", || Ok(vec![Some(third), None])).unwrap()[0], Some(third));
        assert!(first.step::<f64>("two", || Err(Error::NothingLeft)).is_err());
        let again = Steps::open(Some(&path), "a".into());
        let known: Vec<Option<f64>> = again.step("one", || panic!("it is known")).unwrap();
        assert_eq!(known, [Some(third), None]);
        assert_eq!(again.step("two", || Ok(2.0)).unwrap(), 2.0);
        let other = Steps::open(Some(&path), "b".into());
        assert_eq!(other.step("two", || Ok(3.0)).unwrap(), 3.0);
        // Half a file counts as none.
        std::fs::write(&path, "{\"format\": \"reach").unwrap();
        let damaged = Steps::open(Some(&path), "b".into());
        assert_eq!(damaged.step("two", || Ok(4.0)).unwrap(), 4.0);
        // Without a file nothing outlives the job.
        let none = Steps::open(None, "a".into());
        assert_eq!(none.step("one", || Ok(1)).unwrap(), 1);
        assert_eq!(none.step("one", || Ok(2)).unwrap(), 1);
        assert_eq!(Steps::open(None, "a".into()).step("one", || Ok(3)).unwrap(), 3);
    }
}
