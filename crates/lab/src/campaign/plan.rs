//! The plan of a campaign: all that is random is drawn from the seed before anything is simulated,
//! so the order of simulation does not matter.

use std::path::Path;

use reachtube_robot::Robot;

use super::excitation::ExcitingMotion;
use super::job::{Job, SuiteOf, Work};
use super::motion_series::MotionSeries;
use super::options::{CampaignOptions, campaign_options};
use crate::error::Result;
use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SeedableRng, SplitMix64};
use crate::virtual_robot::{Scatter, SuiteRuns, VirtualRobot};

/// Samples of a recording of poses between two that are logged: 50 Hz suffice for an arm that
/// mostly rests.
const POSE_STRIDE: usize = 5;

/// Rests in one recording: two at each position.
const POSES_PER_FILE: usize = 20;

/// Returns all jobs in the order of the index. Each kind of recording has a stream of random
/// numbers of its own, so that more recordings of one kind leave the others as they are.
pub(super) fn jobs(robot: &VirtualRobot, options: &CampaignOptions) -> Vec<Job> {
    let stream = |kind: u64| SplitMix64::seed_from_u64(options.seed ^ (kind << 56));
    let mut jobs = Vec::new();
    let mut random = stream(0);
    for motion in 0..options.motions {
        jobs.extend(suites(robot, options, motion, &mut random));
    }
    let (nominal, mut random) = (robot.nominal(), stream(1));
    for first in (0..options.rest).step_by(POSES_PER_FILE) {
        let count = POSES_PER_FILE.min(options.rest - first);
        let series = MotionSeries::of_poses(nominal, count, &mut random);
        jobs.push(Job::identification(
            "rest",
            first / POSES_PER_FILE,
            Work::Series(series, POSE_STRIDE),
        ));
    }
    let mut random = stream(2);
    for joint in 0..nominal.joint_count() {
        for pose in 0..options.one_joint {
            let motion = MotionSeries::of_joint(nominal, joint, &mut random);
            let index = joint * options.one_joint + pose;
            jobs.push(Job::identification("one-joint", index, Work::Series(motion, 1)));
        }
    }
    for (kind, name, count) in
        [(3, "excitation", options.excitation), (4, "validation", options.validation)]
    {
        let mut random = stream(kind);
        for index in 0..count {
            let motion = ExcitingMotion::random(nominal, &mut random);
            jobs.push(Job::identification(name, index, Work::Excitation(motion, options.stride)));
        }
    }
    jobs
}

fn suites(
    robot: &VirtualRobot,
    options: &CampaignOptions,
    index: usize,
    random: &mut SplitMix64,
) -> Vec<Job> {
    let motion = match options.duration {
        Some(duration) => Motion::random(robot.nominal(), duration, random),
        None => Motion::uniform(robot.nominal(), random),
    };
    let name = format!("M{}", index + 1);
    let held_out = options.motions - options.held_out_motions;
    let of = SuiteOf { motion: name.clone(), is_held_out: index >= held_out };
    let folder = if options.has_suites_only() { "" } else { "suites/" };
    let longest = (options.longest / SAMPLE_TIME).round() as usize;
    (0..options.start_points)
        .map(|start| {
            let first = motion.start_cycle(start, options.start_points);
            let runs = SuiteRuns {
                name: format!("{name}{}", char::from(b'a' + start as u8)),
                first,
                samples: longest.min(motion.cycles() - first) + 1,
                scatter: (0..options.runs).map(|_| Scatter::random(robot, random)).collect(),
            };
            Job::suite(folder, of.clone(), motion.clone(), runs)
        })
        .collect()
}

/// A suite of a campaign before it was recorded.
pub(crate) struct PlannedSuite {
    /// Its name.
    pub name: String,
    /// Name of the motion that it is part of.
    pub motion_name: String,
    /// That motion.
    pub motion: Motion,
    /// Cycle of the motion at which the open loop begins.
    pub first: usize,
}

/// Returns the suites of the campaign of the LWA 4P in `folder`, in the order of the index.
///
/// # Errors
///
/// As [`campaign_options`].
pub(crate) fn planned_suites(folder: &Path) -> Result<Vec<PlannedSuite>> {
    let options = campaign_options(folder)?;
    let robot = VirtualRobot::new(&Robot::lwa4p(), options.robot.clone())?;
    let planned = |job: Job| match job.work {
        Work::Suite(SuiteOf { motion: motion_name, .. }, motion, runs) => {
            let SuiteRuns { name, first, .. } = runs;
            Some(PlannedSuite { name, motion_name, motion, first })
        }
        _ => None,
    };
    Ok(jobs(&robot, &options).into_iter().filter_map(planned).collect())
}
