//! A folder of simulated recordings, and the robots that they are made with.

use crate::virtual_robot::{Random, Recorder, excitation, rest, slow};
use reachtube_identify::{Identification, IdentifySettings, identify};
use reachtube_robot::{Robot, RobotDescription};
use std::path::{Path, PathBuf};

/// Returns the LWA 4P with the same parameters for inertia and gravity.
pub(crate) fn lwa4p() -> Robot {
    let mut description = Robot::lwa4p().description().clone();
    description.joints.iter_mut().for_each(|joint| joint.gravity_moments = None);
    Robot::from_description(&description).unwrap()
}

/// Returns the geometry of a robot, without masses, motors and friction.
pub(crate) fn geometry(robot: &Robot) -> Robot {
    let mut description: RobotDescription = robot.description().clone();
    for joint in &mut description.joints {
        (joint.mass, joint.com, joint.first_moment) = (0.0, None, None);
        (joint.inertia, joint.armature, joint.rotor_inertia) = ([0.0; 6], None, None);
        joint.friction = Default::default();
    }
    Robot::from_description(&description).unwrap()
}

/// A folder for recordings.
pub(crate) struct Lab {
    folder: tempfile::TempDir,
}

impl Lab {
    /// Returns an empty folder.
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// Records three exciting motions and a validation motion.
    pub(crate) fn excite(&self, robot: &Robot, noise: f64, gains: &[f64]) {
        let mut recorder = Recorder { robot, noise, gains: gains.to_vec(), random: Random::new(5) };
        for seed in 1..=3 {
            let path = self.folder.path().join(format!("dynamic_{seed}.csv"));
            recorder.record(&path, 12.0, excitation(robot.joint_count(), seed));
        }
        let path = self.folder.path().join("held_out.csv");
        recorder.record(&path, 8.0, excitation(robot.joint_count(), 9));
    }

    /// Returns settings for the recordings of [`Lab::excite`].
    pub(crate) fn settings(&self) -> IdentifySettings {
        let entry = |name: &str| PathBuf::from(name).into();
        let mut settings = IdentifySettings {
            excitation: (1..=3).map(|k| entry(&format!("dynamic_{k}.csv"))).collect(),
            validate: vec![entry("held_out.csv")],
            ..IdentifySettings::default()
        };
        settings.prepare.cut_off = Some(8.0);
        settings
    }

    /// Records poses at rest and slow motions of each joint, and adds them to the settings.
    pub(crate) fn record_slowly(&self, robot: &Robot, settings: &mut IdentifySettings) {
        let mut recorder =
            Recorder { robot, noise: 0.1, gains: vec![1.0; 6], random: Random::new(3) };
        let mut random = Random::new(11);
        for k in 0..20 {
            let name = PathBuf::from(format!("rest_{k}.csv"));
            let q = (0..6).map(|_| 2.0 * random.uniform() - 1.0).collect();
            recorder.record(&self.path().join(&name), 3.0, rest(q));
            settings.rest.push(name.into());
        }
        for joint in 0..6 {
            for (k, pose) in [0.0, 0.8, -0.6].into_iter().enumerate() {
                let name = PathBuf::from(format!("slow_{joint}_{k}.csv"));
                recorder.record(&self.path().join(&name), 12.0, slow(6, joint, pose));
                settings.one_joint.push(name.into());
            }
        }
    }

    /// Returns the folder.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Identifies a robot.
    pub(crate) fn identify(&self, robot: &Robot, settings: &IdentifySettings) -> Identification {
        identify(robot, settings, self.path(), &|_, _| {}).unwrap()
    }
}

/// Returns a robot with constant and linear friction, which the fit of the inertial parameters
/// contains.
pub(crate) fn simple_friction(robot: &Robot) -> Robot {
    let mut description = robot.description().clone();
    for (j, joint) in description.joints.iter_mut().enumerate() {
        let f = 2.0 + 0.3 * j as f64;
        joint.friction.coulomb = [f, 0.0, -f, 0.0, -f, 0.0, f, 0.0];
        joint.friction.viscous = [3.0, 0.0, 0.0];
    }
    Robot::from_description(&description).unwrap()
}
