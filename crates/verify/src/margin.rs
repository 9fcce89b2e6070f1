//! Distance of a link from its place on the nominal motion.

use rayon::prelude::*;
use reachtube_conform::SuiteReach;
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, mul_up, sub_up};
use serde::Serialize;

use crate::body::body::{Body, Workspace};
use crate::body::capsule::Capsule;

/// The proved margin of a link: grown by it, the link's capsules on the nominal motion contain the
/// link's capsules on every motion of the model at the same time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Margin {
    /// Index of the joint that moves the link, from 0.
    pub joint: usize,
    /// The margin \[m\], rounded up.
    pub distance: f64,
    /// Start of the step in which it is the largest, s.
    pub time: f64,
}

impl Body {
    /// Returns the margin of each link that has a capsule, over all steps of reachable sets, in the
    /// order of the joints. Between two samples the nominal motion is straight in the joints'
    /// positions. Sensor noise is not part of it, as it moves no link.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding, for every time of each step. The deviation from the straight
    /// motion stays within h/4 times the width of the tube in the velocity of the line between its
    /// values at the two samples.
    ///
    /// # Panics
    ///
    /// Panics when the reachable sets are of another number of joints.
    #[must_use]
    pub fn margins(&self, reach: &SuiteReach) -> Vec<Margin> {
        assert_eq!(reach.dimension, 2 * self.joint_count(), "the sets are of another robot");
        let of_step = |workspace: &mut Workspace, k: usize| -> Vec<Margin> {
            let margin = |(joint, distance)| Margin { joint, distance, time: reach.times[k] };
            self.distances(workspace, reach, k).into_iter().map(margin).collect()
        };
        let of_steps = (0..reach.tube.len()).into_par_iter().map_init(Workspace::default, of_step);
        let of_capsules = of_steps.reduce_with(larger).unwrap_or_default();
        let mut margins: Vec<Margin> = Vec::new();
        for margin in of_capsules {
            match margins.iter_mut().find(|known| known.joint == margin.joint) {
                Some(known) if known.distance >= margin.distance => {}
                Some(known) => *known = margin,
                None => margins.push(margin),
            }
        }
        margins.sort_by_key(|margin| margin.joint);
        margins
    }

    /// Bounds the distance of each capsule from the nominal one over step k, with the joint that
    /// moves it.
    fn distances(
        &self,
        workspace: &mut Workspace,
        reach: &SuiteReach,
        k: usize,
    ) -> Vec<(usize, f64)> {
        let n = self.joint_count();
        let shift: Vec<Interval> = (0..n).map(|i| deviation(reach, k, i)).collect();
        let nominal = |i: usize| {
            let [here, next] = [k, k + 1].map(|k| reach.nominal[k * 2 * n + i]);
            Interval::point(here).hull(Interval::point(next))
        };
        let nominal: Vec<Interval> = (0..n).map(nominal).collect();
        let ways = self.ways(workspace, &nominal, &shift);
        self.capsules().iter().map(|capsule| capsule.joint).zip(ways).collect()
    }

    /// Bounds how far each capsule moves while the joints shift by a vector in `shift`, from any
    /// positions in `start`: no point of the segment moves further than its ends.
    ///
    /// # Guarantee
    ///
    /// Upper bounds, directed rounding.
    pub(crate) fn ways(
        &self,
        workspace: &mut Workspace,
        start: &[Interval],
        shift: &[Interval],
    ) -> Vec<f64> {
        let sizes: Vec<f64> = shift.iter().map(|e| e.mag()).collect();
        let moved: Vec<f64> = start.iter().map(|side| side.rad()).collect();
        let Workspace { posture, points: [point, _], q, radii } = workspace;
        q.clear();
        q.extend(start.iter().map(|side| side.mid()));
        radii.clear();
        radii.extend(moved.iter().zip(&sizes).map(|(a, b)| add_up(*a, *b)));
        self.chain.pose(q, posture);
        let mut of_end = |joint: usize, end| {
            point.at(&self.chain, posture, (joint, end), radii);
            point.distance(&moved, shift, &sizes)
        };
        let ways = self.ends().map(|(capsule, [from, to])| {
            of_end(capsule.joint, from).max(of_end(capsule.joint, to))
        });
        ways.collect()
    }
}

impl Body {
    /// Returns the joints whose links have capsules, in their order.
    #[must_use]
    pub fn links(&self) -> Vec<String> {
        self.moved().map(|joint| self.joint_name(joint).into()).collect()
    }

    fn moved(&self) -> impl Iterator<Item = usize> {
        let has_capsule = |joint: &usize| self.capsules().iter().any(|of| of.joint == *joint);
        (0..self.joint_count()).filter(has_capsule)
    }

    /// Bounds how far the axes of the capsules of each of the [`links`](Self::links) move, m, while
    /// the joints shift by a vector in `shift`, from any positions in `from` (rad; m).
    ///
    /// # Guarantee
    ///
    /// Upper bounds, directed rounding.
    #[must_use]
    pub fn ways_of_links(&self, from: &[Interval], shift: &[Interval]) -> Vec<f64> {
        let ways = self.ways(&mut Workspace::default(), from, shift);
        let of_link = |joint: usize| {
            let own = self.capsules().iter().zip(&ways).filter(|(of, _)| of.joint == joint);
            own.map(|(_, way)| *way).fold(0.0, f64::max)
        };
        self.moved().map(of_link).collect()
    }

    /// Bounds how far any point of each capsule moves while the joints shift by up to `shift` (rad;
    /// m), from any positions in `ranges`, m, capsule by capsule.
    ///
    /// # Guarantee
    ///
    /// Upper bounds, directed rounding: a point within the radius of the segment is turned by each
    /// revolute joint before it.
    #[must_use]
    pub fn largest_ways(&self, ranges: &[Interval], shift: &[f64]) -> Vec<f64> {
        let by: Vec<Interval> = shift.iter().map(|e| Interval::centred(0.0, *e)).collect();
        let ways = self.ways(&mut Workspace::default(), ranges, &by);
        let with_radius = |(way, capsule): (f64, &Capsule)| {
            let turning = (0..=capsule.joint).filter(|joint| self.chain.turns(*joint));
            let turned = turning.fold(0.0, |sum, joint| add_up(sum, shift[joint]));
            add_up(way, mul_up(capsule.radius, turned))
        };
        ways.into_iter().zip(self.capsules()).map(with_radius).collect()
    }
}

/// Returns the larger margin of each capsule; of equal ones the earlier.
fn larger(left: Vec<Margin>, right: Vec<Margin>) -> Vec<Margin> {
    let larger = |(a, b): (Margin, Margin)| {
        let is_later = b.distance > a.distance || b.distance == a.distance && b.time < a.time;
        if is_later { b } else { a }
    };
    left.into_iter().zip(right).map(larger).collect()
}

/// Encloses the deviation of position i from the straight nominal motion at every time of step k.
fn deviation(reach: &SuiteReach, k: usize, i: usize) -> Interval {
    let (n, states) = (reach.dimension / 2, reach.dimension);
    let at = |k: usize| {
        let index = k * states + i;
        let (lower, upper) = (reach.lower[index], reach.upper[index]);
        Interval::point(lower).hull(Interval::point(upper)) - reach.nominal[index]
    };
    let duration = sub_up(reach.times[k + 1].next_up(), reach.times[k].next_down());
    let bulge = mul_up(0.25, mul_up(duration, reach.tube.bounds(k)[n + i].width()));
    at(k).hull(at(k + 1)) + Interval::centred(0.0, bulge)
}
