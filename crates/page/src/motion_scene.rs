//! The one description of a verified motion in space, which its picture and the page's script draw.

use reachtube_verify::{Body, Obstacle, Scene, Solid, SweptCapsule, Verification};
use serde::Serialize;

/// Number of steps of the motion, and of a stop, that are drawn at most.
const STEPS: usize = 120;
const STOP_STEPS: usize = 40;

/// The ends and the radius of a capsule \[m\].
pub(super) type Ball = [f64; 7];

/// A motion, its worst stop, and the obstacles.
#[derive(Serialize)]
pub(super) struct MotionScene<'a> {
    pub(super) frames: Vec<Frame>,
    /// The steps of the worst stop.
    pub(super) stop: Vec<Frame>,
    pub(super) obstacles: Vec<ObstacleShape<'a>>,
    /// The capsules of the link in the closest pair.
    pub(super) link: Vec<usize>,
    /// The obstacle in the closest pair.
    pub(super) obstacle: Option<&'a str>,
    /// The frame that is shown first, counted through the motion and the stop.
    pub(super) first: usize,
}

/// The arm at a time. Capsules without a bound are not drawn.
#[derive(Serialize)]
pub(super) struct Frame {
    /// Time \[s\].
    pub(super) time: f64,
    /// Capsules that contain the links over the step.
    pub(super) swept: Vec<Ball>,
    /// The nominal motion, of a stop at its start.
    pub(super) nominal: Vec<Ball>,
    /// The closest motion that was found.
    pub(super) closest: Vec<Ball>,
}

#[derive(Serialize)]
pub(super) struct ObstacleShape<'a> {
    name: &'a str,
    pub(super) solid: &'a Solid,
    pub(super) speed: f64,
}

impl<'a> MotionScene<'a> {
    pub(super) fn new(motion: &'a Verification, body: &Body, scene: &'a Scene) -> Self {
        let (reach, found) = (&motion.reach, motion.closest.as_ref());
        let n = body.joint_count();
        let nominal = |step: usize| {
            let q = reach.nominal.get(step * reach.dimension..step * reach.dimension + n);
            q.map_or_else(Vec::new, |q| balls(&body.placed(q)))
        };
        let found_at = |time: f64| {
            found.map_or_else(Vec::new, |found| balls(&body.placed(&found.at(time)[..n])))
        };
        let of_pair = motion.clearances.first().map(|pair| pair.time);
        let shown = found.map(|found| found.time).or(of_pair).unwrap_or(0.0);
        let from_stop = found.and_then(|found| found.stop.as_ref()).map(|stop| stop.from);
        let worst = motion.stops.as_ref().and_then(|stops| stops.worst.as_ref());
        let is_stopped = worst.is_some_and(|(from, _)| from_stop == Some(*from));
        let occupancy = body.occupancy(&reach.tube);
        let moving = steps(&reach.times[..occupancy.len()], STEPS, (!is_stopped).then_some(shown));
        let frame = |(k, time): &(usize, f64)| Frame {
            time: *time,
            swept: balls(&occupancy[*k]),
            nominal: nominal(*k),
            closest: found_at(*time),
        };
        let frames: Vec<Frame> = moving.iter().map(frame).collect();
        let stop = worst.map_or_else(Vec::new, |(from, stop)| {
            let occupancy = body.occupancy(&stop.tube);
            let start = nominal(reach.times.iter().position(|time| time >= from).unwrap_or(0));
            let times: Vec<f64> = stop.times[..occupancy.len()].iter().map(|t| from + t).collect();
            let frame = |(k, time): &(usize, f64)| Frame {
                time: *time,
                swept: balls(&occupancy[*k]),
                nominal: start.clone(),
                closest: if is_stopped { found_at(*time) } else { Vec::new() },
            };
            steps(&times, STOP_STEPS, is_stopped.then_some(shown)).iter().map(frame).collect()
        });
        let before = |frames: &[Frame]| frames.iter().rposition(|frame| frame.time <= shown);
        let first = match is_stopped {
            true => frames.len() + before(&stop).unwrap_or(0),
            false => before(&frames).unwrap_or(0),
        };
        let pair = closest_pair(motion);
        let is_link = |k: &usize| {
            pair.is_some_and(|(link, _)| body.joint_name(body.capsules()[*k].joint) == link)
        };
        let shape = |Obstacle { name, solid, speed, .. }: &'a Obstacle| ObstacleShape {
            name,
            solid,
            speed: *speed,
        };
        Self {
            frames,
            stop,
            obstacles: scene.obstacles.iter().map(shape).collect(),
            link: (0..body.capsules().len()).filter(is_link).collect(),
            obstacle: pair.map(|(_, obstacle)| obstacle),
            first,
        }
    }

    pub(super) fn shown(&self) -> Option<&Frame> {
        self.frames.iter().chain(&self.stop).nth(self.first)
    }
}

pub(super) fn closest_pair(motion: &Verification) -> Option<(&str, &str)> {
    let stop = motion.stops.as_ref().and_then(|stops| stops.clearances.first());
    let moving = motion.clearances.first();
    match (&motion.closest, stop, moving) {
        (Some(found), ..) => Some((&found.link, &found.obstacle)),
        (None, Some(stop), Some(moving)) if stop.distance > moving.distance => {
            Some((&moving.link, &moving.obstacle))
        }
        (None, Some(stop), _) => Some((&stop.link, &stop.obstacle)),
        (None, None, moving) => moving.map(|pair| (&*pair.link, &*pair.obstacle)),
    }
}

/// Returns at most `most` of the steps that begin at some times, each with its time; the step in
/// which a time lies that is to be shown has that time.
fn steps(times: &[f64], most: usize, shown: Option<f64>) -> Vec<(usize, f64)> {
    let stride = times.len().div_ceil(most).max(1);
    let within = shown.and_then(|shown| Some((times.iter().rposition(|t| *t <= shown)?, shown)));
    let is_drawn = |k: &usize| k.is_multiple_of(stride) || within.is_some_and(|(at, _)| at == *k);
    let time = |k: usize| within.filter(|(at, _)| *at == k).map_or(times[k], |(_, shown)| shown);
    (0..times.len()).filter(is_drawn).map(|k| (k, time(k))).collect()
}

/// Returns capsules to 0.1 mm; none if one has no bound.
fn balls(capsules: &[SweptCapsule]) -> Vec<Ball> {
    let rounded = |capsule: &SweptCapsule| {
        let ([a, b, c], [d, e, f]) = (capsule.from, capsule.to);
        [a, b, c, d, e, f, capsule.radius].map(|x| (x * 1e4).round() / 1e4)
    };
    let all: Vec<Ball> = capsules.iter().map(rounded).collect();
    if all.iter().flatten().all(|x| x.is_finite()) { all } else { Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::steps;

    #[test]
    fn the_time_that_is_shown_is_among_few_steps() {
        let times: Vec<f64> = (0..100).map(f64::from).collect();
        assert_eq!(steps(&times, 3, Some(40.25)), [(0, 0.0), (34, 34.0), (40, 40.25), (68, 68.0)]);
        assert_eq!(steps(&times[..3], 5, None), [(0, 0.0), (1, 1.0), (2, 2.0)]);
    }
}
