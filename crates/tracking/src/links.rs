//! Links of an arm, in metres: how far each strays from where the nominal positions have it.

use rayon::prelude::*;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::mul_up;

use crate::model::{LinkTracking, TrackingModel};
use crate::motion::MotionRows;
use crate::recording::TrackedRun;

/// The links of an arm, for which models say how far they stray.
pub struct TrackedLinks<'a> {
    /// The joints that move them.
    pub joints: Vec<String>,
    /// Their ways.
    pub ways: &'a Ways<'a>,
}

/// Bounds how far each link moves, m, from some positions of the joints if these shift.
pub type Ways<'a> = dyn Fn(&[Interval], &[Interval]) -> Vec<f64> + Sync + 'a;

impl TrackedLinks<'_> {
    /// Returns how far each link strays, from recordings with their commands of the model's delay
    /// before, and as they are. Motions that are kept are for the factor alone; without
    /// any, each is left out in turn.
    ///
    /// # Guarantee
    ///
    /// Outer for each sample, directed rounding, as far as `ways` is.
    pub(crate) fn strays(
        &self,
        model: &TrackingModel,
        (followed, recordings): (&[TrackedRun], &[TrackedRun]),
        (motions, is_kept): (&[MotionRows], &[bool]),
    ) -> Vec<LinkTracking> {
        // For each motion and link the distance from the nominal place, and from the commanded one.
        let of_motion = |motion: &MotionRows| {
            let of = [followed, recordings].map(|all| &all[motion.recording]);
            let mut largest = vec![[0.0f64; 2]; self.joints.len()];
            for k in motion.rows.clone() {
                for (at, ways) in self.at_sample(model, of, k).iter().enumerate() {
                    let pairs = largest.iter_mut().zip(ways);
                    pairs.for_each(|(largest, way)| largest[at] = largest[at].max(*way));
                }
            }
            largest
        };
        let found: Vec<Vec<[f64; 2]>> = motions.par_iter().map(of_motion).collect();
        let link = |(link, joint): (usize, &String)| {
            let mut fitted = [0.0f64; 2];
            let mut kept = 0.0f64;
            for (motion, is_kept) in found.iter().zip(is_kept) {
                let [way, _] = motion[link];
                match is_kept {
                    true => kept = kept.max(way),
                    // The largest, and the largest of the others.
                    false if way > fitted[0] => fitted = [way, fitted[0]],
                    false => fitted[1] = fitted[1].max(way),
                }
            }
            let factor = match is_kept.contains(&true) {
                true => kept / fitted[0],
                false => fitted[0] / fitted[1],
            };
            // A link that never strays, or a single motion, has no factor.
            let factor = if factor.is_finite() { factor.max(1.0) } else { 1.0 };
            let largest_error = found.iter().map(|motion| motion[link][1]).fold(0.0, f64::max);
            let radius = mul_up(fitted[0], factor).max(kept);
            LinkTracking { joint: joint.clone(), radius, factor, largest_error }
        };
        self.joints.iter().enumerate().map(link).collect()
    }

    /// Bounds how far each link is at a sample from its nominal place, and from its commanded one.
    fn at_sample(
        &self,
        model: &TrackingModel,
        [late, of]: [&TrackedRun; 2],
        k: usize,
    ) -> [Vec<f64>; 2] {
        let n = of.joint_count();
        let command = |of: &TrackedRun, joint: usize| Interval::point(of.command[k * n + joint]);
        let nominal =
            |joint: usize| model.joints[joint].nominal(command(late, joint), late.rates(k, joint));
        let commanded = (0..n).map(|joint| command(of, joint)).collect();
        [(0..n).map(nominal).collect::<Vec<_>>(), commanded].map(|from| {
            let actual = &of.actual[k * n..(k + 1) * n];
            let shift: Vec<Interval> =
                actual.iter().zip(&from).map(|(y, from)| Interval::point(*y) - *from).collect();
            (self.ways)(&from, &shift)
        })
    }
}
