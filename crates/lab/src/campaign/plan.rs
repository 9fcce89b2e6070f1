//! The plan of a campaign: all that is random is drawn from the seed before anything is simulated,
//! so the order of simulation does not matter.

use crate::motion::{Motion, SAMPLE_TIME};
use crate::random::{SeedableRng, SplitMix64};
use crate::virtual_robot::{Scatter, SuiteRuns, VirtualRobot};

use super::excitation::ExcitingMotion;
use super::job::{Job, Work};
use super::joint_motion::JointMotion;
use super::options::CampaignOptions;
use super::pose_series::PoseSeries;

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
    for first in (0..options.poses).step_by(POSES_PER_FILE) {
        let count = POSES_PER_FILE.min(options.poses - first);
        let series = PoseSeries::random(nominal, count, &mut random);
        jobs.push(Job::identification("poses", first / POSES_PER_FILE, Work::Poses(series)));
    }
    let mut random = stream(2);
    for joint in 0..nominal.joint_count() {
        for pose in 0..options.friction {
            let motion = JointMotion::random(nominal, joint, &mut random);
            let index = joint * options.friction + pose;
            jobs.push(Job::identification("friction", index, Work::Friction(motion)));
        }
    }
    for (kind, name, count) in
        [(3, "excitation", options.excitation), (4, "validation", options.validation)]
    {
        let mut random = stream(kind);
        for index in 0..count {
            let motion = ExcitingMotion::random(nominal, &mut random);
            jobs.push(Job::identification(name, index, Work::Excitation(motion)));
        }
    }
    jobs
}

/// Draws a motion and returns its suites.
fn suites(
    robot: &VirtualRobot,
    options: &CampaignOptions,
    index: usize,
    random: &mut SplitMix64,
) -> Vec<Job> {
    let motion = Motion::uniform(robot.nominal(), random);
    let digits = options.motions.to_string().len();
    let name = format!("M{:0digits$}", index + 1);
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
            Job::suite(&name, motion.clone(), runs)
        })
        .collect()
}
