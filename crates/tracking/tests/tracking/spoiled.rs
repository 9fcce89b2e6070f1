//! Logs of an arm that does not follow its command, or of clocks that slip, are named.

use reachtube_finding::Severity;
use reachtube_tracking::{Code, MadeModel, TrackedRun, make};

use crate::common::{made, recording, servo, texts, with_log};
use crate::servo::{Plan, log};

/// Returns the number of samples of the last recording that were set aside.
fn set_aside(made: &MadeModel) -> usize {
    let others = &made.model.recordings[..made.model.recordings.len() - 1];
    assert!(others.iter().all(|of| of.set_aside == 0));
    made.model.recordings.last().unwrap().set_aside
}

/// Asserts that a model of some samples is as good as the one of good logs.
#[track_caller]
fn is_like_good_ones(made: &MadeModel) {
    let good = crate::common::made(&servo(6)).model;
    let ratio = made.model.mean_half_width() / good.mean_half_width();
    assert!(made.is_useful() && (0.8..1.25).contains(&ratio), "{ratio}");
}

#[test]
fn copied_commands_are_refused() {
    for (before, words) in [(0, "0 samples"), (1, "1 sample"), (10, "10 samples")] {
        let mut copy = log(6);
        let earlier = |k: usize| copy.command[k.saturating_sub(before)];
        copy.actual = (0..copy.times.len()).map(earlier).collect();
        let refused = make(&with_log("copy", &copy), None).unwrap_err().to_string();
        assert!(refused.contains("logs/copy.csv: "), "{refused}");
        assert!(refused.contains(&format!("of {words} before, exactly")), "{refused}");
        assert!(refused.contains("no measurement"), "{refused}");
    }
    // A measurement of a joint that follows exactly is near a copy, but none.
    let mut noisy = log(6);
    noisy.actual = noisy.command.iter().map(|of| of.map(|position| position + 1e-6)).collect();
    assert!(make(&with_log("noisy", &noisy), None).is_ok());
}

#[test]
fn samples_after_a_stop_are_set_aside() {
    let mut step = log(6);
    let stands = step.actual[400];
    step.actual[400..].fill(stands);
    let made = made(&with_log("step", &step));
    let found = texts(&made, Code::NotFollowing);
    let [text] = found[..] else { panic!("{found:?}") };
    assert!(text.contains("logs/step.csv: ") && text.contains("stands"), "{text}");
    // The sample at 4.00 s is the last one of the motion, and the first one that stands.
    assert!(["at 4.000 s", "at 4.010 s"].iter().any(|at| text.contains(at)), "{text}");
    assert!([200, 199].contains(&set_aside(&made)), "{text}");
    assert!(made.findings[0].severity == Severity::Warning);
    assert!(made.findings[0].place.as_deref() == Some("step"));
    // The first line says what was not looked at.
    assert!(made.verdict().contains(&format!("{} of 3600 samples", 3600 - set_aside(&made))));
    is_like_good_ones(&made);
}

#[test]
fn samples_off_the_command_at_first_are_set_aside() {
    let mut start = log(6);
    for (time, actual) in start.times.iter().zip(&mut start.actual) {
        let off = 0.3 * (-time / 0.12).exp();
        *actual = actual.map(|position| position + off);
    }
    let made = made(&with_log("start", &start));
    let found = texts(&made, Code::NotFollowing);
    let [text] = found[..] else { panic!("{found:?}") };
    assert!(text.contains("logs/start.csv: ") && text.contains(" 0.3 rad off"), "{text}");
    assert!(text.contains("at 0.000 s"), "{text}");
    // An offset of 0.3 rad is 0.01 mrad after 1.24 s.
    let aside = set_aside(&made);
    assert!((90..=250).contains(&aside), "{aside}");
    is_like_good_ones(&made);
}

#[test]
fn clocks_that_slip_are_a_failure() {
    let (mut slip, plan) = (log(6), Plan::new(6));
    for (time, command) in slip.times.iter().zip(&mut slip.command) {
        let late = time - 5e-3 * time.floor();
        *command = [0, 1].map(|joint| plan.position(joint, late));
    }
    let made = made(&with_log("slip", &slip));
    let found = texts(&made, Code::ClockSlips);
    let [text] = found[..] else { panic!("{found:?}") };
    assert!(text.contains("logs/slip.csv: ") && text.contains(" ms"), "{text}");
    let of_slip = made.findings.iter().find(|of| of.code.name() == "clock-slips").unwrap();
    assert_eq!(of_slip.severity, Severity::Failure);
    // The clock loses 25 ms in 6 s: a lag of their mean leaves up to 12.5 ms either way.
    assert!((5e-3..20e-3).contains(&of_slip.numbers["slip"]), "{of_slip:?}");
    assert!(made.model.verified && !made.is_useful());
}

/// One shift for all of a log is a lag, and no slip.
#[test]
fn a_late_clock_does_not_slip() {
    let (mut late, plan) = (log(6), Plan::new(6));
    for (time, command) in late.times.iter().zip(&mut late.command) {
        *command = [0, 1].map(|joint| plan.position(joint, time - 5e-3));
    }
    let made = made(&with_log("late", &late));
    assert_eq!(texts(&made, Code::ClockSlips), Vec::<&str>::new());
}

#[test]
fn logs_without_a_motion_are_refused() {
    let mut still = log(1);
    still.command.fill([0.1, 0.2]);
    let said = make(&[recording("still", &still)], None).unwrap_err().to_string();
    assert!(said.contains("no commanded position changes"), "{said}");
    let spoiled: [TrackedRun; 0] = [];
    assert_eq!(servo(0), spoiled);
}
