//! Proved distances between the links and the obstacles over a motion.

use rayon::prelude::*;
use reachtube_conform::SuiteReach;
use reachtube_scalar::Interval;
use schemars::JsonSchema;
use serde::Serialize;

use crate::body::body::{Body, Workspace};
use crate::kinematics::linearised_point::LinearisedPoint;
use crate::kinematics::vector::Vector;
use crate::scene::scenario::Scene;
use crate::scene::separation::separation;
use crate::verdict::part_of_step::PartOfStep;

/// The smallest proved distance between a link and an obstacle over a motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Clearance {
    /// Name of the link: of the joint that moves it.
    pub link: String,
    /// Name of the obstacle.
    pub obstacle: String,
    /// A lower bound of their distance \[m\], over all motions of the model; negative if no
    /// distance above 0 is proved.
    #[schemars(with = "Option<f64>")]
    pub distance: f64,
    /// Start of the step in which it is the smallest, s.
    pub time: f64,
    /// Index of the joint that moves the link.
    #[serde(skip)]
    pub(crate) joint: usize,
    /// Index of the obstacle.
    #[serde(skip)]
    pub(crate) index: usize,
    /// The step in which it is the smallest.
    #[serde(skip)]
    pub(crate) step: usize,
}

/// A capsule and an obstacle, by their indices.
type Pair = (usize, usize);

/// The pairs of a capsule and an obstacle that concerns it, whose distances are sought.
pub(super) struct Search<'a> {
    body: &'a Body,
    scene: &'a Scene,
    pub(super) pairs: Vec<Pair>,
}

#[derive(Default)]
pub(super) struct Memory {
    pub(super) workspace: Workspace,
    pub(super) positions: Vec<Interval>,
}

/// Returns the smallest proved distance of each link from each obstacle that concerns it.
///
/// # Guarantee
///
/// Lower bounds, directed rounding, at every time of each step. A step whose bound is not above the
/// clearance of the scene is divided into up to `refine` parts.
pub(crate) fn clearances(
    body: &Body,
    scene: &Scene,
    reach: &SuiteReach,
    refine: u32,
) -> Vec<Clearance> {
    let search = Search::new(body, scene);
    let of_step = |memory: &mut Memory, step: usize| -> Vec<(f64, usize)> {
        let mut found = vec![f64::INFINITY; search.pairs.len()];
        search.lower(memory, reach, (PartOfStep::whole(step), refine), &mut found);
        found.into_iter().map(|distance| (distance, step)).collect()
    };
    let steps = (0..reach.tube.len()).into_par_iter().map_init(Memory::default, of_step);
    let smallest = steps.reduce_with(|left, right| {
        left.into_iter().zip(right).map(|(a, b)| if b.0 < a.0 { b } else { a }).collect()
    });
    search.by_link(reach, &smallest.unwrap_or_default())
}

impl<'a> Search<'a> {
    pub(super) fn new(body: &'a Body, scene: &'a Scene) -> Self {
        let of_capsule = |(capsule, shape): (usize, &crate::Capsule)| {
            let concerned = scene.obstacles.iter().enumerate();
            let concerned = concerned.filter(|(_, obstacle)| obstacle.concerns(shape.joint));
            concerned.map(|(obstacle, _)| (capsule, obstacle)).collect::<Vec<_>>()
        };
        let pairs = body.capsules().iter().enumerate().flat_map(of_capsule).collect();
        Self { body, scene, pairs }
    }

    /// Lowers the distances `found` (one per pair) to the distances over a part of a step, which
    /// may be divided into a number of parts.
    fn lower(
        &self,
        memory: &mut Memory,
        reach: &SuiteReach,
        (part, parts): (PartOfStep, u32),
        found: &mut [f64],
    ) {
        part.positions(reach, &mut memory.positions);
        let here = self.distances(memory, part.end(reach));
        let is_close = here.iter().any(|distance| *distance <= self.scene.clearance);
        if is_close && parts > 1 {
            for half in part.halves() {
                self.lower(memory, reach, (half, parts / 2), found);
            }
        } else {
            found.iter_mut().zip(here).for_each(|(found, here)| *found = found.min(here));
        }
    }

    /// Returns the distance of each pair while the joints lie in the box of positions.
    pub(super) fn distances(&self, memory: &mut Memory, time: f64) -> Vec<f64> {
        let Memory { workspace, positions } = memory;
        workspace.pose(self.body, positions);
        let mut distances = Vec::with_capacity(self.pairs.len());
        let mut pairs = self.pairs.iter().peekable();
        for (index, (capsule, ends)) in self.body.ends().enumerate() {
            if pairs.peek().is_none_or(|pair| pair.0 != index) {
                continue;
            }
            workspace.linearise(self.body, capsule, ends);
            let Workspace { points, radii, .. } = &*workspace;
            let lowest = |n: &Vector| {
                points.iter().map(|end| end.lowest(n, radii)).fold(f64::INFINITY, f64::min)
            };
            let shape = (points.each_ref().map(LinearisedPoint::centre), capsule.radius);
            while let Some((_, obstacle)) = pairs.next_if(|pair| pair.0 == index) {
                let obstacle = &self.scene.obstacles[*obstacle];
                distances.push(separation(lowest, shape, obstacle, time));
            }
        }
        distances
    }

    pub(super) fn by_link(&self, reach: &SuiteReach, smallest: &[(f64, usize)]) -> Vec<Clearance> {
        let mut all: Vec<Clearance> = Vec::new();
        for (&(capsule, index), &(distance, step)) in self.pairs.iter().zip(smallest) {
            let joint = self.body.capsules()[capsule].joint;
            let clearance = Clearance {
                link: self.body.joint_name(joint).into(),
                obstacle: self.scene.obstacles[index].name.clone(),
                distance,
                time: reach.times[step],
                joint,
                index,
                step,
            };
            match all.iter_mut().find(|known| (known.joint, known.index) == (joint, index)) {
                Some(known) if known.distance <= distance => {}
                Some(known) => *known = clearance,
                None => all.push(clearance),
            }
        }
        all
    }
}
