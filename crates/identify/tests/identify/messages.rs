//! Plain messages about recordings that cannot serve their purpose.

use crate::lab::{Lab, geometry, lwa4p, simple_friction};
use crate::virtual_robot::{Random, Recorder, edit, excitation, rest};
use reachtube_identify::prepare::LogEntry;
use reachtube_identify::{Identification, IdentifySettings, identify};
use reachtube_robot::Robot;
use std::path::PathBuf;

/// A folder with recordings of the LWA 4P, and its geometry.
struct Recorded {
    lab: Lab,
    robot: Robot,
    settings: IdentifySettings,
}

impl Recorded {
    fn new() -> Self {
        let truth = simple_friction(&lwa4p());
        let lab = Lab::new();
        lab.excite(&truth, 0.3, &[1.0; 6]);
        let mut settings = lab.settings();
        settings.model.physical = Some(false);
        settings.model.windows = vec![];
        Self { lab, robot: geometry(&truth), settings }
    }

    /// Records a rest and a motion of the LWA 4P.
    fn record(&self, rest_file: &str, motion_file: &str) {
        let truth = simple_friction(&lwa4p());
        let mut recorder =
            Recorder { robot: &truth, noise: 0.1, gains: vec![1.0; 6], random: Random::new(3) };
        recorder.record(&self.lab.path().join(rest_file), 6.0, rest(vec![0.4; 6]));
        recorder.record(&self.lab.path().join(motion_file), 12.0, excitation(6, 8));
    }

    fn edit(&self, file: &str, change: impl Fn(&mut Vec<Vec<f64>>)) {
        edit(&self.lab.path().join(file), change);
    }

    fn found(&self) -> Identification {
        self.lab.identify(&self.robot, &self.settings)
    }

    fn error(&self) -> String {
        identify(&self.robot, &self.settings, self.lab.path(), &|_, _| {}).unwrap_err().to_string()
    }
}

fn entry(path: &str) -> LogEntry {
    PathBuf::from(path).into()
}

fn assert_parts(message: &str, parts: &[&str]) {
    assert!(parts.iter().all(|part| message.contains(part)), "{parts:?}: {message}");
}

#[test]
fn a_recording_of_the_fit_cannot_validate() {
    let mut recorded = Recorded::new();
    recorded.settings.validate = vec![entry("dynamic_2.csv")];
    assert_parts(&recorded.error(), &["dynamic_2.csv", "not held out", "--validate"]);
    // A copy with another name.
    let folder = recorded.lab.path();
    std::fs::copy(folder.join("dynamic_2.csv"), folder.join("copy.csv")).unwrap();
    recorded.settings.validate = vec![entry("copy.csv")];
    assert_parts(&recorded.error(), &["copy.csv", "dynamic_2.csv, which has the same content"]);
    // Two disjoint intervals of one recording.
    let part = |from, until| LogEntry::Stretch {
        path: "dynamic_2.csv".into(),
        from,
        until,
        order: None,
        compensated: false,
    };
    recorded.settings.excitation[1] = part(0.0, Some(8.0));
    recorded.settings.validate = vec![part(8.0, None)];
    assert!(recorded.found().held_out);
    recorded.settings.validate = vec![part(7.0, None)];
    assert_parts(&recorded.error(), &["not held out", "disjoint intervals"]);
}

#[test]
fn poses_validate_nothing() {
    let mut recorded = Recorded::new();
    recorded.record("pose.csv", "motion.csv");
    recorded.settings.validate = vec![entry("pose.csv"), entry("motion.csv")];
    let found = recorded.found();
    let [pose, motion, all] = &found.validation[..] else { panic!("{:?}", found.validation) };
    for joint in &pose.joints {
        assert_eq!((joint.samples, joint.relative, joint.r2), (0, None, None));
    }
    for joint in motion.joints.iter().chain(&all.joints) {
        assert!(joint.r2.unwrap() > 0.99 && joint.relative.unwrap() < 0.1, "{joint:?}");
    }
    let [warning] = &found.warnings[..] else { panic!("{:?}", found.warnings) };
    assert_parts(warning, &["no joint moves", "pose", "--rest"]);
    assert!(!warning.contains("motion,"));
}

#[test]
fn a_velocity_that_contradicts_the_position_is_named() {
    let recorded = Recorded::new();
    recorded.edit("dynamic_2.csv", |rows| rows.iter_mut().for_each(|row| row[6 + 3] *= 1.2));
    let warnings = recorded.found().warnings;
    assert_parts(
        &warnings[0],
        &["dynamic_2", "velocity of joint3", "does not integrate", "rad", "differentiated"],
    );
    assert!(!warnings.iter().any(|w| w.contains("velocity of joint2")), "{warnings:?}");
}

#[test]
fn times_in_milliseconds_are_blamed_on_their_recording() {
    let mut recorded = Recorded::new();
    recorded.record("pose.csv", "motion.csv");
    let milliseconds = |rows: &mut Vec<Vec<f64>>| rows.iter_mut().for_each(|row| row[0] *= 1000.0);
    recorded.edit("motion.csv", milliseconds);
    recorded.settings.excitation.push(entry("motion.csv"));
    assert_parts(&recorded.error(), &["motion.csv", "milliseconds", "give times in s"]);
    // Without a set cut-off too.
    recorded.settings.prepare.cut_off = None;
    assert_parts(&recorded.error(), &["motion.csv", "milliseconds"]);
    // A rest shows no velocity; its own sample rate is blamed.
    recorded.settings.excitation.pop();
    recorded.edit("pose.csv", milliseconds);
    recorded.settings.rest = vec![entry("pose.csv")];
    assert_parts(&recorded.error(), &["pose:", "sample rate of 0.25", "times are in s"]);
}

#[test]
fn gravity_needs_the_recordings_that_its_settings_promise() {
    let mut recorded = Recorded::new();
    recorded.settings.model.separate_gravity = true;
    assert_parts(&recorded.error(), &["separate_gravity", "--rest", "--one-joint"]);
    recorded.settings.model.separate_gravity = false;
    recorded.settings.rest = vec![entry("dynamic_1.csv")];
    assert_parts(&recorded.error(), &["no pose", "model.rest_speed = 0.01 rad/s"]);
}

#[test]
fn a_simulation_that_misses_by_more_than_the_motion_is_named() {
    let mut recorded = Recorded::new();
    recorded.settings.model.windows = vec![0.5];
    assert!(recorded.found().warnings.is_empty());
    // A constant torque that the fit has not seen moves the wrist away.
    recorded.edit("held_out.csv", |rows| rows.iter_mut().for_each(|row| row[18] += 40.0));
    let warnings = recorded.found().warnings;
    let simulated = warnings.iter().find(|w| w.contains("simulated")).expect("a warning");
    assert_parts(simulated, &["over 0.5 s", "joint6 by", "of a motion of", "do not use"]);
}
