//! The monitor judges each sample as a check does.

use reachtube_tracking::{JudgedSample, TrackedRun, TrackingModel, TrackingMonitor};

use crate::common::{made, near, recording, servo};
use crate::servo::log;

/// Returns all samples that a monitor judges.
fn judged(model: &TrackingModel, of: &TrackedRun) -> (TrackingMonitor, Vec<JudgedSample>) {
    let mut monitor = TrackingMonitor::new(model.clone());
    let mut all = Vec::new();
    for (k, time) in of.times.iter().enumerate() {
        let rows = [&of.command, &of.actual].map(|of| &of[2 * k..2 * k + 2]);
        monitor.push(1e3 + time, rows, |judged| all.push(judged));
        // A sample is judged with the next one.
        assert_eq!(all.len(), if k < 2 { 0 } else { k });
    }
    monitor.finish(|judged| all.push(judged));
    (monitor, all)
}

#[test]
fn samples_are_judged_as_by_a_check() {
    let delayed: Vec<TrackedRun> = (1..=8).map(crate::delays::late).collect();
    for (model, other) in [
        (made(&servo(6)).model, recording("other", &log(30))),
        (made(&delayed).model, crate::delays::late(30)),
    ] {
        let mut spoiled = other.clone();
        spoiled.actual[300] += 0.1;
        for run in [other, spoiled] {
            let (monitor, all) = judged(&model, &run);
            let check = model.check(std::slice::from_ref(&run)).unwrap();
            assert_eq!(all.len(), run.times.len());
            let needed = all.iter().map(|of| of.needed).fold(0.0, f64::max);
            let of_check = check.motions.iter().map(|of| of.needed).fold(0.0, f64::max);
            near(needed, of_check, 1e-6);
            for (joint, largest) in monitor.largest().iter().enumerate() {
                near(*largest, check.joints[joint].needed, 1e-6);
            }
            let [samples, outside, gaps] = monitor.counts();
            assert_eq!((samples, gaps), (run.times.len(), 0));
            assert!(outside <= check.outside && (outside > 0) == (check.outside > 0));
        }
    }
}

#[test]
fn a_gap_begins_anew_and_is_counted() {
    let model = made(&servo(6)).model;
    let of = recording("other", &log(1));
    let mut monitor = TrackingMonitor::new(model);
    let mut count = 0;
    for k in (0..200).chain(300..600) {
        let rows = [&of.command, &of.actual].map(|of| &of[2 * k..2 * k + 2]);
        monitor.push(of.times[k], rows, |_| count += 1);
    }
    monitor.finish(|_| count += 1);
    // Each sample is judged, before and after the gap.
    assert_eq!((count, monitor.counts()[0], monitor.counts()[2]), (500, 500, 1));
}
