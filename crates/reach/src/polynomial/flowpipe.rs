use rayon::prelude::*;
use reachtube_scalar::Interval;

use super::PolynomialSystem;
use super::follower::{Follower, follower};
use super::step::Exhausted;
use crate::{Hyperrectangle, ReachError, TimeGrid, Zonotope};

/// The input u(t) ∈ u_m(t) + U: what was measured, held from sample to sample, and a set that it
/// may be off by at any time.
#[derive(Debug, Clone, Copy)]
pub struct UncertainInput<'a> {
    /// Row-major, one row of m a sample, in effect until the next; the row of the last sample is
    /// not used and may be missing.
    pub measured: &'a [f64],
    /// U, m: any measurable function with values in it.
    pub set: &'a Hyperrectangle,
}

impl UncertainInput<'_> {
    /// All values over step k, m intervals.
    fn over_step(&self, k: usize, out: &mut [Interval]) {
        let m = out.len();
        for (j, out) in out.iter_mut().enumerate() {
            let center = Interval::point(self.measured[k * m + j]) + self.set.center[j];
            *out = center + Interval::centered(0.0, self.set.radius[j]);
        }
    }
}

/// How sets are followed from step to step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum FlowpipeMethod {
    /// Conservative linearisation of zonotopes (Althoff, Stursberg, Buss, CDC 2008), which carries
    /// a large uncertain input best: in each step the system is its linear part about a point near
    /// the middle of the set plus what that leaves out, bounded over the step's own tube, which is
    /// proved by containment. For a polynomial the shift f(z* + d) = Σ c_α dᵅ is exact and finite.
    #[default]
    Linearisation,
    /// Taylor models, which carry a large initial set best: the state is a polynomial in where it
    /// started, of degree `order` (1 at least) in that and in time over each step, plus an offset.
    /// The offset obeys ė = A e + B (u - u*) + d, where A and B enclose the derivatives of f over
    /// the step's tube, which is proved by containment, and d is what the polynomial lacks of the
    /// solution; it is kept as a zonotope.
    TaylorModels {
        /// The degree: 3 to 5 for 7 states, to 12 for 2.
        order: u32,
    },
}

/// How a flowpipe is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct FlowpipeSettings {
    /// How sets are followed.
    pub method: FlowpipeMethod,
    /// Variables and squares, n, at whose 2ⁿ corners
    /// [`Linearisation`](FlowpipeMethod::Linearisation) bounds what it leaves out. The terms of a
    /// polynomial with many are seldom all large together: where sets get lost, more corners may
    /// keep them. 0 is none, and the most that are taken are 20.
    pub corners: usize,
    /// Generators kept, in multiples of the number of states; beyond, the oldest become a box.
    /// `None` keeps all, which is the tightest.
    pub order: Option<usize>,
    /// Parts into which the initial set is divided along each state, N; empty for none. Each is
    /// followed alone, and the hull of all is given.
    pub pieces: Vec<usize>,
    /// Samples at which the zonotopes themselves are kept, one a piece.
    pub zonotopes: Vec<usize>,
}

impl Default for FlowpipeSettings {
    fn default() -> Self {
        let method = FlowpipeMethod::default();
        Self { method, corners: 8, order: None, pieces: Vec::new(), zonotopes: Vec::new() }
    }
}

/// How a flowpipe ended. A set that cannot be followed to the end is an answer, not an error.
#[must_use]
#[derive(Debug, Clone, PartialEq)]
pub enum FlowpipeOutcome {
    /// At the last sample.
    Reached,
    /// Before it: no remainder of the linearisation contained itself.
    Failed {
        /// The last sample time (s) up to which the sets hold.
        time: f64,
        /// The state whose tube grew the most over the step that failed.
        state: usize,
        /// The widths of the last tube tried, N; infinite where it has no bound.
        widths: Vec<f64>,
    },
}

/// The reachable set of a polynomial system under an uncertain input: an interval hull at each
/// sample and over each step.
///
/// [`FlowpipeMethod`] says how it is found.
///
/// # Examples
///
/// ```
/// use reachtube_reach::{Flowpipe, FlowpipeSettings, Hyperrectangle, PolynomialSystem, TimeGrid, UncertainInput};
/// use reachtube_scalar::{Interval, TaylorPolynomial, TaylorSpace};
///
/// // A mass with cubic friction, v̇ = u - v - v³, pushed by 2 ± 0.1 N from rest.
/// let space = TaylorSpace::new(2, 3).unwrap();
/// let [v, u] = [0, 1].map(|i| TaylorPolynomial::<Interval>::variable(&space, i));
/// let system = PolynomialSystem::new(1, 1, &[u - v.clone() - &(&v * &v) * &v])?;
/// let input = UncertainInput { measured: &[2.0; 1000], set: &Hyperrectangle { center: vec![0.0], radius: vec![0.1] } };
/// let rest = Hyperrectangle::zero(1);
/// let grid = TimeGrid::uniform(0.01, 1001);
/// let flowpipe = Flowpipe::new(&system, &grid, &[0.0], &rest, &input, &FlowpipeSettings::default())?;
/// // It settles where v + v³ is 2 ± 0.1.
/// assert!(flowpipe.is_reached());
/// let end = flowpipe.sample(1000)[0];
/// assert!(end.contains(0.975) && end.contains(1.0245) && end.width() < 0.06);
/// # Ok::<(), reachtube_reach::ReachError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Flowpipe {
    dimension: usize,
    samples: Vec<Interval>,
    steps: Vec<Interval>,
    zonotopes: Vec<(usize, Zonotope)>,
    generators: usize,
    outcome: FlowpipeOutcome,
}

impl Flowpipe {
    /// From x(0) ∈ `start` + X0 (N) over `grid`.
    ///
    /// # Guarantee
    ///
    /// Outer, directed rounding: every solution from a start in the set, under an input whose
    /// values are in u_m + U, lies in the boxes, at the samples and at all times of the steps, up
    /// to the time of the outcome; and in the zonotopes but for the rounding of their last
    /// generators' lengths. Generators are multiplied in floating point; the rounding of each step,
    /// bounded by γ_n |Φ| times the radius of the hull (Rump), is a generator of its own.
    ///
    /// # Errors
    ///
    /// [`ReachError::Shape`] where sizes do not fit, with the rows of the input counted against the
    /// grid; [`ReachError::NotFinite`]; [`ReachError::Order`] for Taylor models of an order that
    /// does not fit the number of states; [`ReachError::Trigonometric`] for those of a system with
    /// sines and cosines.
    pub fn new(
        system: &PolynomialSystem,
        grid: &TimeGrid,
        start: &[f64],
        initial_set: &Hyperrectangle,
        input: &UncertainInput<'_>,
        settings: &FlowpipeSettings,
    ) -> Result<Self, ReachError> {
        check(system, grid, start, initial_set, input, settings)?;
        let sides: Vec<Interval> =
            (0..system.states()).map(|i| side(start, initial_set, i)).collect();
        let of_piece = |piece: Vec<Interval>| {
            Ok(Self::of(
                follower(system, &piece, settings)?.as_mut(),
                system,
                grid,
                input,
                settings,
            ))
        };
        let pieces = pieces(&sides, &settings.pieces).into_par_iter().map(of_piece);
        let whole = pieces.reduce_with(|left, right| Ok(left?.hull(right?)));
        whole.expect("a piece at least")
    }

    /// From one box.
    fn of(
        follower: &mut dyn Follower,
        system: &PolynomialSystem,
        grid: &TimeGrid,
        input: &UncertainInput<'_>,
        settings: &FlowpipeSettings,
    ) -> Self {
        let mut flowpipe = Self::start(system.states(), grid.len());
        flowpipe.keep(follower, settings);
        let mut u = vec![Interval::ZERO; system.inputs()];
        for k in 1..grid.len() {
            input.over_step(k - 1, &mut u);
            if let Err(Exhausted { state, widths }) = follower.advance(grid.interval(k - 1), &u) {
                flowpipe.outcome =
                    FlowpipeOutcome::Failed { time: grid.times()[k - 1], state, widths };
                break;
            }
            follower.tube(&mut flowpipe.steps);
            flowpipe.keep(follower, settings);
        }
        flowpipe
    }

    /// The union, up to the time of the shorter one.
    fn hull(mut self, other: Self) -> Self {
        if other.len() < self.len() {
            return other.hull(self);
        }
        self.samples
            .iter_mut()
            .zip(&other.samples)
            .for_each(|(own, other)| *own = own.hull(*other));
        self.steps.iter_mut().zip(&other.steps).for_each(|(own, other)| *own = own.hull(*other));
        self.zonotopes.extend(other.zonotopes);
        self.generators = self.generators.max(other.generators);
        self
    }

    fn start(n: usize, samples: usize) -> Self {
        Self {
            dimension: n,
            samples: Vec::with_capacity(n * samples),
            steps: Vec::with_capacity(n * samples),
            zonotopes: Vec::new(),
            generators: 0,
            outcome: FlowpipeOutcome::Reached,
        }
    }

    fn keep(&mut self, follower: &dyn Follower, settings: &FlowpipeSettings) {
        if settings.zonotopes.contains(&self.len()) {
            self.zonotopes.push((self.len(), follower.zonotope()));
        }
        follower.hull(&mut self.samples);
        self.generators = follower.generators();
    }

    /// Number of samples up to which the sets hold.
    pub fn len(&self) -> usize {
        self.samples.len() / self.dimension.max(1)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// The hull at sample k, N intervals.
    pub fn sample(&self, k: usize) -> &[Interval] {
        &self.samples[k * self.dimension..(k + 1) * self.dimension]
    }

    /// The hull of all states over the step from sample k to k + 1, N intervals.
    pub fn step(&self, k: usize) -> &[Interval] {
        &self.steps[k * self.dimension..(k + 1) * self.dimension]
    }

    /// The zonotopes at sample k, one a piece of the initial set, if they were asked for.
    pub fn zonotopes(&self, k: usize) -> impl Iterator<Item = &Zonotope> {
        self.zonotopes.iter().filter(move |(sample, _)| *sample == k).map(|(_, zonotope)| zonotope)
    }

    /// Generators that were stored at the last sample, of the piece with most.
    pub fn generators(&self) -> usize {
        self.generators
    }

    /// How it ended.
    pub fn outcome(&self) -> &FlowpipeOutcome {
        &self.outcome
    }

    /// Whether the last sample was reached.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.outcome == FlowpipeOutcome::Reached
    }
}

/// Side i of the set of initial states.
fn side(start: &[f64], initial_set: &Hyperrectangle, i: usize) -> Interval {
    Interval::point(start[i]) + Interval::centered(initial_set.center[i], initial_set.radius[i])
}

/// The box divided into so many parts along each side. Neighbours share an end, so that none is
/// left out.
fn pieces(sides: &[Interval], parts: &[usize]) -> Vec<Vec<Interval>> {
    let mut pieces = vec![Vec::with_capacity(sides.len())];
    for (i, side) in sides.iter().enumerate() {
        let parts = parts.get(i).copied().unwrap_or(1);
        let end = |at: usize| match at {
            0 => side.lo(),
            at if at == parts => side.hi(),
            at => (side.lo() + (side.hi() - side.lo()) * (at as f64 / parts as f64))
                .clamp(side.lo(), side.hi()),
        };
        let own = |at: usize| Interval::new(end(at), end(at + 1)).unwrap_or(*side);
        let longer = |piece: &Vec<Interval>| {
            let piece = piece.clone();
            (0..parts).map(move |at| [piece.clone(), vec![own(at)]].concat()).collect::<Vec<_>>()
        };
        pieces = pieces.iter().flat_map(longer).collect();
    }
    pieces
}

fn check(
    system: &PolynomialSystem,
    grid: &TimeGrid,
    start: &[f64],
    initial_set: &Hyperrectangle,
    input: &UncertainInput<'_>,
    settings: &FlowpipeSettings,
) -> Result<(), ReachError> {
    let (n, m) = (system.states(), system.inputs());
    let rows = grid.len().saturating_sub(1);
    check_vector("the start", start, n)?;
    for (set, centre, radius, size) in [
        (initial_set, "the centre of the initial set", "the radius of the initial set", n),
        (input.set, "the centre of the input set", "the radius of the input set", m),
    ] {
        check_vector(centre, &set.center, size)?;
        check_vector(radius, &set.radius, size)?;
        if let Some(row) = set.radius.iter().position(|r| *r < 0.0) {
            return Err(ReachError::Negative { what: radius, row, value: set.radius[row] });
        }
    }
    let found_rows = settings.pieces.len();
    if found_rows != 0 && found_rows != n || settings.pieces.contains(&0) {
        let what = "the list of pieces, each at least 1,";
        return Err(ReachError::Shape { what, rows: n, columns: 1, found_rows, found_columns: 1 });
    }
    let found = input.measured.len();
    if found != rows * m && found != (rows + 1) * m {
        let (found_rows, found_columns) = (found.checked_div(m).unwrap_or(found), m);
        return Err(ReachError::Shape {
            what: "the input",
            rows,
            columns: m,
            found_rows,
            found_columns,
        });
    }
    check_vector("the input", input.measured, found)
}

fn check_vector(what: &'static str, vector: &[f64], rows: usize) -> Result<(), ReachError> {
    if vector.len() != rows {
        let found_rows = vector.len();
        return Err(ReachError::Shape { what, rows, columns: 1, found_rows, found_columns: 1 });
    }
    match vector.iter().position(|x| !x.is_finite()) {
        Some(row) => Err(ReachError::NotFinite { what, row, column: 0, value: vector[row] }),
        None => Ok(()),
    }
}
