//! Table I: the error of the models in simulation.

use std::f64::consts::FRAC_PI_2;
use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use rayon::prelude::*;
use reachtube_robot::Robot;
use serde::Serialize;

use super::trajectories::{BLOCK, Trajectories, random_motion};
use crate::error::{Error, Result};
use crate::random::{SeedableRng, SplitMix64};
use reachtube_abstraction::{ExpansionPoint, ModelKind, PolynomialModel};

/// What is simulated.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table1Options {
    /// Random motions.
    pub motions: usize,
    /// Decides the motions.
    pub seed: u64,
    /// Orders p of the models.
    pub orders: Vec<u32>,
    /// The highest order of model 3 that is simulated. At order 7 it has half a million terms for
    /// the LWA 4P, and the paper has no number.
    pub model3_up_to: u32,
    /// Motions stay this close to the expansion point q = 0, rad, and within the joints' limits.
    pub range: f64,
}

impl Default for Table1Options {
    /// 50 motions within π/2, where the paper's recorded motions are; the paper's orders, model 3
    /// up to order 5.
    fn default() -> Self {
        Self { motions: 50, seed: 1, orders: vec![1, 3, 5, 7], model3_up_to: 5, range: FRAC_PI_2 }
    }
}

/// How fast the robot moves along its paths.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Speed {
    /// With a peak of a third of each joint's speed limit: 0.4 rad/s.
    Slow,
    /// With a peak of each joint's speed limit: 1.2 rad/s.
    Fast,
}

impl Speed {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Slow, Self::Fast];

    /// The duration over that at full speed.
    fn slowness(self) -> f64 {
        match self {
            Self::Slow => 3.0,
            Self::Fast => 1.0,
        }
    }

    /// slow or fast.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slow => "slow",
            Self::Fast => "fast",
        }
    }
}

/// What the paper has.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Paper {
    /// Mean velocity error, rad/s.
    Error(f64),
    /// ∞.
    Diverged,
}

impl Paper {
    /// Table I of the paper, where it has a number.
    fn of(model: ModelKind, order: u32, speed: Speed) -> Option<Self> {
        let [slow, fast] = match (model, order) {
            (_, 1) => [0.0040, 0.0408],
            (ModelKind::One, 3) => [0.0034, 0.0243],
            (ModelKind::Two, 3) => [0.0042, 0.0294],
            (ModelKind::Two, 5) => [0.0026, 0.0161],
            (ModelKind::Two, 7) => [0.0025, 0.0162],
            (ModelKind::Three, 3) => [f64::INFINITY; 2],
            (ModelKind::Three, 5) => [0.0031, f64::INFINITY],
            _ => return None,
        };
        let error = if speed == Speed::Slow { slow } else { fast };
        Some(if error.is_finite() { Self::Error(error) } else { Self::Diverged })
    }
}

/// A model of one order at one speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Cell {
    /// Which model.
    pub model: ModelKind,
    /// The order p.
    pub order: u32,
    /// How fast the robot moves.
    pub speed: Speed,
    /// Terms of the model.
    pub terms: usize,
    /// Mean |velocity error| over time and joints of each motion, rad/s; none where the model
    /// diverged.
    pub errors: Vec<Option<f64>>,
    /// Mean over the motions that did not diverge, rad/s.
    pub mean: Option<f64>,
    /// Standard deviation over them, rad/s.
    pub spread: Option<f64>,
    /// Motions that diverged.
    pub diverged: usize,
    /// The paper's number, where there is one and the robot is the paper's.
    pub paper: Option<Paper>,
}

/// Table I.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table1 {
    /// Name of the robot.
    pub robot: String,
    /// What was simulated.
    pub options: Table1Options,
    /// Duration of the motions, slow and fast, s.
    pub durations: [f64; 2],
    /// Order by order, of each order model by model, of each model slow and fast.
    pub cells: Vec<Cell>,
}

/// Simulates `robot` by Featherstone's articulated bodies and its models about q = 0 under the same
/// inputs, and compares velocities.
///
/// The motions are point to point along quintics, with a random direction of each joint from a
/// random place; slow and fast motions have the same paths. The input is u = M_m q̈ + c + τ_v along
/// the motion, held over 4 ms.
///
/// # Errors
///
/// [`Error::Setting`] for no motions or orders and what [`PolynomialModel::new`] refuses.
///
/// # Examples
///
/// ```
/// use reachtube::reproduce::{Table1Options, table1};
/// use reachtube_robot::Robot;
///
/// let options = Table1Options { motions: 2, orders: vec![1], ..Default::default() };
/// let table = table1(&Robot::lwa4p(), &options, &|_done, _total| ())?;
/// assert!(table.cells.iter().all(|cell| cell.diverged == 0 && cell.mean.unwrap() < 0.1));
/// # Ok::<(), reachtube::Error>(())
/// ```
pub fn table1(
    robot: &Robot,
    options: &Table1Options,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Table1> {
    if options.motions == 0 || options.orders.is_empty() {
        return Err(Error::Setting("Table I of no motions or no orders; give 1 at least".into()));
    }
    let mut random = SplitMix64::seed_from_u64(options.seed);
    let motion = |_| random_motion(robot, options.range, &mut random);
    let motions = (0..options.motions).map(motion).collect::<Result<Vec<_>>>()?;
    let blocks = options.motions.div_ceil(BLOCK);
    let speeds = Speed::ALL.map(|speed| {
        let trajectories = Trajectories::new(robot, &motions, speed.slowness());
        let velocities: Vec<_> =
            (0..blocks).into_par_iter().map(|block| trajectories.of_robot(robot, block)).collect();
        (trajectories, velocities)
    });
    let models = models(robot, options)?;
    let parts: Vec<_> = (0..models.len() * speeds.len() * blocks).collect();
    let done = AtomicUsize::new(0);
    let errors: Vec<_> = parts
        .into_par_iter()
        .with_max_len(1)
        .flat_map_iter(|part| {
            let (cell, block) = (part / blocks, part % blocks);
            let (trajectories, velocities) = &speeds[cell % speeds.len()];
            let errors =
                trajectories.errors(&models[cell / speeds.len()], &velocities[block], block);
            progress(done.fetch_add(1, Relaxed) + 1, models.len() * speeds.len() * blocks);
            errors
        })
        .collect();
    let is_papers = *robot == Robot::lwa4p();
    let cells = errors.chunks(options.motions).enumerate().map(|(cell, errors)| {
        Cell::new(&models[cell / speeds.len()], Speed::ALL[cell % speeds.len()], errors, is_papers)
    });
    Ok(Table1 {
        robot: robot.name().into(),
        options: options.clone(),
        durations: Speed::ALL.map(|speed| speed.slowness() * motions[0].duration),
        cells: cells.collect(),
    })
}

/// All that are simulated, about q = 0.
fn models(robot: &Robot, options: &Table1Options) -> Result<Vec<PolynomialModel>> {
    let zero = ExpansionPoint::zero(robot.joint_count());
    let kinds = [ModelKind::One, ModelKind::Two, ModelKind::Three];
    let all = options.orders.iter().flat_map(|order| kinds.map(|kind| (kind, *order)));
    all.filter(|(kind, order)| *kind != ModelKind::Three || *order <= options.model3_up_to)
        .map(|(kind, order)| Ok(PolynomialModel::new(robot, kind, order, &zero)?))
        .collect()
}

impl Cell {
    fn new(model: &PolynomialModel, speed: Speed, errors: &[Option<f64>], is_papers: bool) -> Self {
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
            paper: Paper::of(model.kind(), model.order(), speed).filter(|_| is_papers),
        }
    }
}

impl Table1 {
    /// The cell of a model, an order and a speed.
    pub fn cell(&self, model: ModelKind, order: u32, speed: Speed) -> Option<&Cell> {
        self.cells.iter().find(|cell| (cell.model, cell.order, cell.speed) == (model, order, speed))
    }

    /// Writes the error of each motion \[rad/s\] as CSV, `inf` where the model diverged: order,
    /// model, speed, motion, velocity_error.
    ///
    /// # Errors
    ///
    /// What the writer fails with.
    pub fn write_csv(&self, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(out, "order,model,speed,motion,velocity_error")?;
        for cell in &self.cells {
            for (motion, error) in cell.errors.iter().enumerate() {
                let (model, error) = (u32::from(cell.model), error.unwrap_or(f64::INFINITY));
                writeln!(
                    out,
                    "{},{model},{},{},{error}",
                    cell.order,
                    cell.speed.name(),
                    motion + 1
                )?;
            }
        }
        Ok(())
    }
}
