//! The calibration bound for models that were not fixed before a look at the held-out motions.

use reachtube_arm::{ArmModel, ArmSettings, OfArm};
use std::ops::Range;

use reachtube_conform::{
    Conformance, FitSettings, Group, Model, Problem, Settings, Setup, Silent, conform, fit,
};
use reachtube_recordings::{MemoryRuns, Torque};
use reachtube_robot::Robot;

use super::virtual_motions::{motion_names, problem, truth};
use crate::error::Result;
use crate::random::{SplitMix64, uniform};

/// Motions that are held out and calibrate the sets.
pub(super) const HELD_OUT: usize = 4;

/// Motions that the sets are found on.
const OTHERS: usize = 4;

/// Number of models of which the best is chosen.
const CANDIDATES: usize = 10;

/// Largest factor, and reciprocal of the smallest, of the candidates' viscous friction.
const SPREAD: f64 = 1.5;

/// Weight of the pull of the fits: small, as if the robot was identified by least squares.
const PULL: f64 = 0.01;

/// How a model was chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Choice {
    /// Before any motion was looked at.
    Beforehand,
    /// Its robot was fitted to all motions.
    FittedToAll,
    /// Its robot was fitted to the held-out motions.
    FittedToHeldOut,
    /// It is the best of ten by the cost of its calibrated sets.
    BestOfTen,
}

impl Choice {
    /// All choices.
    pub(super) const ALL: [Self; 4] =
        [Self::Beforehand, Self::FittedToAll, Self::FittedToHeldOut, Self::BestOfTen];

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Beforehand => "model fixed beforehand",
            Self::FittedToAll => "robot fitted to all motions",
            Self::FittedToHeldOut => "robot fitted to the held-out motions",
            Self::BestOfTen => "best of ten models by calibrated cost",
        }
    }

    /// Calibrates a model that is chosen so from the motions of a campaign. Returns the bound on
    /// average that is stated of it, 1 for none, and the part of the next motions that leave its
    /// sets.
    pub(super) fn campaign(
        self,
        motions: &MemoryRuns,
        next: &Problem,
        random: &mut SplitMix64,
    ) -> Result<(f64, f64)> {
        let calibrated = |robot: Robot| {
            let setup = setup(robot, HELD_OUT)?;
            let read = problem(motions.clone(), 0..HELD_OUT + OTHERS, HELD_OUT)?.with_setup(setup);
            let found = conform(&read, &Silent, None)?;
            Ok::<_, crate::Error>((read, found))
        };
        let (read, found, candidates) = match self {
            Self::Beforehand => with_one(calibrated(Robot::lwa4p())?),
            Self::FittedToAll => with_one(calibrated(fitted(motions, 0..HELD_OUT + OTHERS)?)?),
            Self::FittedToHeldOut => with_one(calibrated(fitted(motions, 0..HELD_OUT)?)?),
            Self::BestOfTen => {
                let robots: Vec<Robot> =
                    (0..CANDIDATES).map(|_| candidate(random)).collect::<Result<_>>()?;
                let all = robots.into_iter().map(calibrated).collect::<Result<Vec<_>>>()?;
                let best = all.into_iter().min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
                let (read, found) = best.expect("there are ten");
                (read, found, CANDIDATES)
            }
        };
        let stated = match found.trust.average_probability {
            Some(_) => found.trust.of_candidates(candidates).average_probability.unwrap_or(1.0),
            None => 1.0,
        };
        let next = next.with_setup(setup(read.robot().clone(), 0)?);
        Ok((stated, truth(&next, &found.tube)?))
    }
}

fn with_one((read, found): (Problem, Conformance)) -> (Problem, Conformance, usize) {
    (read, found, 1)
}

fn setup(robot: Robot, held_out: usize) -> Result<Setup> {
    let calibrate = motion_names(0..held_out);
    let settings = Settings { calibrate, ..Settings::default() };
    Ok(reachtube_arm::setup(robot, ArmSettings::new(Torque::Compensated, 6), settings)?)
}

fn fitted(motions: &MemoryRuns, used: Range<usize>) -> Result<Robot> {
    let read = problem(motions.clone(), used, 0)?;
    let settings = FitSettings { groups: vec![Group::Viscous], pull: Some(PULL) };
    let fitted = fit(&read, &settings, &Silent)?;
    let found = conform(&fitted.problem, &Silent, None)?;
    let model = Model::new(&fitted.problem, &found).with_fit(fitted.record);
    Ok(Robot::from_description(&model.robot())?)
}

fn candidate(random: &mut SplitMix64) -> Result<Robot> {
    let mut description = Robot::lwa4p().description().clone();
    for joint in &mut description.joints {
        joint.friction.viscous[0] *= uniform(random, -SPREAD.ln(), SPREAD.ln()).exp();
    }
    Ok(Robot::from_description(&description)?)
}
