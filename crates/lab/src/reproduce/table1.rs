//! Table I: the error of the models in simulation.

use std::f64::consts::FRAC_PI_2;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use rayon::prelude::*;
use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel};
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use super::full_speed_motion::full_speed_motion;
use super::paper::{Paper, Speed};
use super::trajectories::{BLOCK, Trajectories};
use crate::error::{Error, Result};
use crate::motion::Motion;
use crate::random::{SeedableRng, SplitMix64};

/// The simulations of Table I.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Table1Options {
    /// Number of random motions.
    pub motions: usize,
    /// Seed of the motions.
    pub seed: u64,
    /// Orders p of the models.
    pub orders: Vec<u32>,
    /// Highest order of model 3. At order 7 the model has half a million terms for the LWA 4P, and
    /// the paper has no number.
    pub model3_up_to: u32,
    /// Largest distance of a joint from the expansion point q = 0 \[rad\]; motions also stay within
    /// the joints' limits.
    pub range: f64,
}

impl Default for Table1Options {
    /// Returns 50 motions within π/2 rad, where the paper's recorded motions are, and the paper's
    /// orders, with model 3 up to order 5.
    fn default() -> Self {
        Self { motions: 50, seed: 1, orders: vec![1, 3, 5, 7], model3_up_to: 5, range: FRAC_PI_2 }
    }
}

/// A model of one order at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Cell {
    /// The model.
    pub model: ModelKind,
    /// The order p.
    pub order: u32,
    /// The speed of the robot.
    pub speed: Speed,
    /// Number of terms of the model.
    pub terms: usize,
    /// Mean |velocity error| over time and joints of each motion \[rad/s\]; none if the model
    /// diverged.
    pub errors: Vec<Option<f64>>,
    /// Mean of the errors over the motions that did not diverge \[rad/s\].
    pub mean: Option<f64>,
    /// Standard deviation of the errors over the motions that did not diverge \[rad/s\].
    pub spread: Option<f64>,
    /// Number of motions in which the model diverged.
    pub diverged: usize,
    /// The paper's entry, if there is one.
    pub paper: Option<Paper>,
}

/// Table I.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Table1 {
    /// Name of the robot.
    pub robot: String,
    /// The options of the simulations.
    pub options: Table1Options,
    /// Durations of the slow and the fast motions \[s\].
    #[schemars(with = "[Option<f64>; 2]")]
    pub durations: [f64; 2],
    /// The cells: for each order each model, for each model slow and fast.
    pub cells: Vec<Cell>,
}

/// Simulates the LWA 4P and its models about q = 0 under the same inputs, and compares velocities.
///
/// The robot is simulated by Featherstone's articulated bodies. The motions are point to point
/// along quintics, with a random direction of each joint from a random position; slow and fast
/// motions have the same paths. The input is u = M_m q̈ + c + τ_v along the motion, held over 4 ms.
///
/// # Errors
///
/// Fails if there are no motions or no orders, or a joint cannot move within the range, and for
/// orders that [`PolynomialModel::new`] refuses.
///
/// # Examples
///
/// ```
/// use reachtube_lab::reproduce::{Table1Options, table1};
///
/// let options = Table1Options { motions: 2, orders: vec![1], ..Default::default() };
/// let table = table1(&options, &|_done, _total| ())?;
/// assert!(table.cells.iter().all(|cell| cell.diverged == 0 && cell.mean.unwrap() < 0.1));
/// # Ok::<(), reachtube_lab::Error>(())
/// ```
pub fn table1(options: &Table1Options, progress: &(dyn Fn(usize, usize) + Sync)) -> Result<Table1> {
    let robot = &Robot::lwa4p();
    if options.motions == 0 || options.orders.is_empty() {
        return Err(Error::NothingToSimulate);
    }
    // Random motions.
    let mut random = SplitMix64::seed_from_u64(options.seed);
    let motion = |_| full_speed_motion(robot, options.range, &mut random);
    let motions = (0..options.motions).map(motion).collect::<Result<Vec<_>, _>>()?;
    // Simulation of the robot, and of the models under the same inputs.
    let speeds = Speed::ALL.map(|speed| RobotMotions::new(robot, &motions, speed));
    let models = models(robot, options)?;
    let errors = errors(&models, &speeds, progress);
    // One cell per model and speed.
    let cells = errors.chunks(options.motions).enumerate().map(|(cell, errors)| {
        Cell::new(&models[cell / speeds.len()], Speed::ALL[cell % speeds.len()], errors)
    });
    Ok(Table1 {
        robot: robot.name().into(),
        options: options.clone(),
        durations: Speed::ALL.map(|speed| speed.slowness() * motions[0].duration),
        cells: cells.collect(),
    })
}

/// The robot's motions at one speed.
struct RobotMotions {
    trajectories: Trajectories,
    /// Velocities \[rad/s\] block by block, motion by motion, row-major samples x n.
    velocities: Vec<Vec<Vec<f64>>>,
}

impl RobotMotions {
    fn new(robot: &Robot, motions: &[Motion], speed: Speed) -> Self {
        let trajectories = Trajectories::new(robot, motions, speed.slowness());
        let blocks = motions.len().div_ceil(BLOCK);
        let velocities = (0..blocks)
            .into_par_iter()
            .map(|block| trajectories.robot_velocities(robot, block))
            .collect();
        Self { trajectories, velocities }
    }
}

fn errors(
    models: &[PolynomialModel],
    speeds: &[RobotMotions; 2],
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Vec<Option<f64>> {
    let blocks = speeds[0].velocities.len();
    let parts: Vec<_> = (0..models.len() * speeds.len() * blocks).collect();
    let done = AtomicUsize::new(0);
    parts
        .into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|part| {
            let (cell, block) = (part / blocks, part % blocks);
            let RobotMotions { trajectories, velocities } = &speeds[cell % speeds.len()];
            let errors =
                trajectories.errors(&models[cell / speeds.len()], &velocities[block], block);
            progress(done.fetch_add(1, Relaxed) + 1, models.len() * speeds.len() * blocks);
            errors
        })
        .collect()
}

fn models(robot: &Robot, options: &Table1Options) -> Result<Vec<PolynomialModel>> {
    let zero = ExpansionPoint::zero(robot.joint_count());
    let kinds = [ModelKind::One, ModelKind::Two, ModelKind::Three];
    let all = options.orders.iter().flat_map(|order| kinds.map(|kind| (kind, *order)));
    all.filter(|(kind, order)| *kind != ModelKind::Three || *order <= options.model3_up_to)
        .map(|(kind, order)| Ok(PolynomialModel::new(robot, kind, order, &zero)?))
        .collect()
}

impl Cell {
    fn new(model: &PolynomialModel, speed: Speed, errors: &[Option<f64>]) -> Self {
        let kept: Vec<f64> = errors.iter().flatten().copied().collect();
        let count = kept.len() as f64;
        let mean = (!kept.is_empty()).then(|| kept.iter().sum::<f64>() / count);
        let spread = mean.filter(|_| kept.len() > 1).map(|mean| {
            (kept.iter().map(|error| (error - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt()
        });
        Self {
            model: model.kind(),
            order: model.order(),
            speed,
            terms: model.term_count(),
            diverged: errors.len() - kept.len(),
            errors: errors.to_vec(),
            mean,
            spread,
            paper: Paper::entry(model.kind(), model.order(), speed),
        }
    }
}

impl Table1 {
    /// Returns the cell of a model, an order and a speed.
    #[must_use]
    pub fn cell(&self, model: ModelKind, order: u32, speed: Speed) -> Option<&Cell> {
        self.cells.iter().find(|cell| (cell.model, cell.order, cell.speed) == (model, order, speed))
    }
}
