//! A problem reads each recording once, whatever is computed from it.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::common::{Disturbed, Random, grid, setup, two_joints};
use reachtube_conform::settings::NominalStart;
use reachtube_conform::{Check, Keep, Model, Problem, Silent, conform, reach};
use reachtube_recordings::{Defect, MemoryRuns, ReadOptions, Run, RunEntry, RunSource};
use reachtube_robot::Robot;

/// Runs in memory that count how often each is read.
#[derive(Debug)]
struct Counting {
    runs: MemoryRuns,
    reads: Arc<Vec<AtomicUsize>>,
}

impl RunSource for Counting {
    fn index_name(&self) -> PathBuf {
        self.runs.index_name()
    }

    fn runs(&self) -> &[RunEntry] {
        self.runs.runs()
    }

    fn run_name(&self, index: usize) -> PathBuf {
        self.runs.run_name(index)
    }

    fn read(&self, index: usize, options: &ReadOptions) -> Result<Run, Vec<Defect>> {
        self.reads[index].fetch_add(1, Ordering::Relaxed);
        self.runs.read(index, options)
    }
}

/// Two suites of 7 and 5 runs; in the second, each run has an input of its own where `differ`.
fn recorded(robot: &Robot, differ: bool) -> MemoryRuns {
    let mut runs = MemoryRuns::default();
    for (suite, count, samples) in [("A", 7, 60), ("B", 5, 40)] {
        let times = grid(0.01, samples);
        let arm = Disturbed { robot, times: &times, start: 0.01, input: 0.5 };
        let mut random = Random(5);
        for run in 0..count {
            let mut recorded = arm.record(&mut random);
            if differ && suite == "B" {
                recorded.torques[3] += f64::from(run);
            }
            let run_in_memory =
                Run::new(2, recorded.times, recorded.states, recorded.torques).unwrap();
            runs.push(&format!("{suite}{run}"), Some(suite), None, run_in_memory);
        }
    }
    runs
}

#[test]
fn each_recording_is_read_once() {
    let robot = two_joints();
    for differ in [false, true] {
        for nominal in [NominalStart::Mean, NominalStart::Own] {
            let reads: Arc<Vec<AtomicUsize>> = Arc::new((0..12).map(|_| 0.into()).collect());
            let source = Counting { runs: recorded(&robot, differ), reads: Arc::clone(&reads) };
            let setup = setup(&robot, |_, settings| settings.nominal = nominal);
            let problem = Problem::read(setup, Box::new(source), &[], Keep::All, &Silent).unwrap();
            // Everything that a conformance with a page needs.
            let found = conform(&problem, &Silent, None).unwrap();
            let model = Model::new(&problem, &found);
            let check = Check::new(&model, &problem, found.verdict.clone());
            let sets = reach(&problem, &found.tube).unwrap();
            let traces = (0..12).map(|index| problem.run(index).unwrap().len());
            assert!(check.verdict.conformant && !sets.is_empty() && traces.sum::<usize>() > 0);
            let counts: Vec<usize> =
                reads.iter().map(|count| count.load(Ordering::Relaxed)).collect();
            assert_eq!(counts, [1; 12], "{differ} {nominal:?}");
        }
    }
}

/// Runs that share their input are folded and not kept; runs that do not are kept.
#[test]
fn sets_alone_need_no_second_reading() {
    let robot = two_joints();
    for differ in [false, true] {
        let reads: Arc<Vec<AtomicUsize>> = Arc::new((0..12).map(|_| 0.into()).collect());
        let source = Counting { runs: recorded(&robot, differ), reads: Arc::clone(&reads) };
        let setup = setup(&robot, |_, _| ());
        let problem = Problem::read(setup, Box::new(source), &[], Keep::Needed, &Silent).unwrap();
        conform(&problem, &Silent, None).unwrap();
        let counts: Vec<usize> = reads.iter().map(|count| count.load(Ordering::Relaxed)).collect();
        assert_eq!(counts, [1; 12], "{differ}");
        // A run that was folded is read again when its samples are needed.
        problem.run(0).unwrap();
        assert_eq!(reads[0].load(Ordering::Relaxed), 2);
    }
}
