//! A linear model over recordings: the reachable sets of its deviation, on each grid.

use std::sync::OnceLock;

use nalgebra::DVectorView;
use rayon::prelude::*;
use reachtube_reach::{GeneratorRows, SampleGenerators};
use reachtube_scalar::Interval;

use crate::data::problem::Problem;
use crate::error::Result;
use crate::program::cut::Cut;
use crate::program::paper::PaperSums;
use crate::program::program::Program;
use crate::sets::UncertaintySets;
use crate::tube::direction::Direction;
use crate::tube::grids::Grid;
use crate::tube::judged::{At, Judged};
use crate::tube::place::Place;
use crate::tube::plant::{Costs, Plant, Round, Slice, Watch};
use crate::tube::state::SearchState;
use crate::tube::strand::Strand;
use crate::tube::tube::{Enclosure, Tube};

/// Number of disturbances, held over equally many steps, that suffice for most points.
const HELD: usize = 24;

/// Equal parts of a sample over which a disturbance is held that may be any measurable function.
pub(crate) const PARTS: usize = 2;

/// A linear model over recordings. Its strands are [places](Place); slices are of grids, which are
/// the places unless U is scaled, and then no points are asked.
pub(crate) struct Linear<'a> {
    problem: &'a Problem,
    pub grids: &'a [Grid],
    /// The generators of slices on each grid.
    generators: Vec<SampleGenerators<'a>>,
    /// The program of the rows, once it is needed.
    program: OnceLock<Program<'a>>,
}

impl<'a> Linear<'a> {
    /// Takes the model of a problem, with slices where its notion asks points.
    pub(crate) fn new(problem: &'a Problem) -> Result<Self> {
        Self::with(problem, problem.settings().notion.asks_points())
    }

    /// Takes the model of a problem, with slices whatever its notion is.
    pub(crate) fn with_slices(problem: &'a Problem) -> Result<Self> {
        Self::with(problem, true)
    }

    fn with(problem: &'a Problem, has_slices: bool) -> Result<Self> {
        let (grids, disturbance) = (problem.grids()?.as_slice(), problem.settings().disturbance);
        let of = |grid: &'a Grid| SampleGenerators::new(&grid.propagation, disturbance, PARTS);
        let used = if has_slices { grids } else { &[] };
        let generators = used.iter().map(of).collect::<Result<_, _>>()?;
        Ok(Self { problem, grids, generators, program: OnceLock::new() })
    }

    pub(crate) fn program(&self) -> Result<&Program<'a>> {
        if let Some(program) = self.program.get() {
            return Ok(program);
        }
        let program = Program::of_problem(self.problem)?;
        Ok(self.program.get_or_init(|| program))
    }

    pub(crate) fn tube_without_points(problem: &Problem, sets: UncertaintySets) -> Result<Tube> {
        let (grids, places) = (problem.grids()?.as_slice(), problem.places()?);
        let strand = |Place { grid, scale, cases }: &Place| Strand {
            cases: *cases,
            ..Strand::on_grid(&grids[*grid], &sets.along(scale))
        };
        let strands = places.iter().map(strand).collect();
        Ok(Tube::of(sets, Enclosure::Inner, strands))
    }

    pub(crate) fn slice<'b>(&'b self, sets: &'b UncertaintySets, at: At) -> LinearSlice<'b> {
        let strand = at.0 as usize;
        LinearSlice { grid: &self.grids[strand], generators: &self.generators[strand], sets, at }
    }

    /// Returns the row of the program that a direction gives at a sample, for the largest lᵀ d of
    /// its points.
    fn cut(&self, at: At, l: &[f64], bound: f64) -> Cut {
        let (grid, sample) = (at.0 as usize, at.1 as usize);
        let propagation = &self.grids[grid].propagation;
        let (e, gamma) = (propagation.exponential(sample), propagation.integral(sample));
        let along = |column: DVectorView<'_, Interval>| {
            column.iter().zip(l).map(|(x, l)| x.mid() * l).sum::<f64>()
        };
        let centre = e.column_iter().chain(gamma.column_iter()).map(along).collect();
        let (initial, input) = self.generators[grid].gains(sample, l);
        Cut {
            centre,
            radius: [initial, input].concat(),
            noise: l.iter().map(|l| l.abs()).collect(),
            bound,
        }
    }
}

impl Plant for Linear<'_> {
    fn is_exact(&self) -> bool {
        true
    }

    fn round<'b>(
        &'b self,
        state: &mut SearchState,
        before: Option<Round<'b>>,
    ) -> Result<Round<'b>> {
        let mut round = match before {
            Some(before) => before,
            None => {
                let program = self.program()?.clone();
                Round { rows: program.first_rows(), program, runs_away: None }
            }
        };
        let cuts = &mut round.program.cuts;
        for Direction { at, direction, along, .. } in &state.directions[cuts.len()..] {
            cuts.push(self.cut(*at, direction, along.value));
        }
        Ok(round)
    }

    fn tube(&self, sets: &UncertaintySets, watch: Option<&Watch>) -> Result<(Tube, Judged)> {
        let tube = Self::tube_without_points(self.problem, sets.clone())?;
        let Some(watch) = watch else { return Ok((tube, Judged::default())) };
        let samples = self.grids.iter().enumerate().flat_map(|(grid, of)| {
            (1..of.times.len()).map(move |sample| (grid as u32, sample as u32))
        });
        let samples: Vec<At> = samples.collect();
        let judged = samples.into_par_iter().map(|at| watch(&self.slice(sets, at)));
        Ok((tube, judged.reduce(Judged::default, Judged::merge)))
    }

    fn centre(&self, tube: &Tube, at: At) -> Vec<f64> {
        self.slice(&tube.sets, at).centre().0
    }

    fn costs(&self, tube: &Tube) -> Result<Costs> {
        let program = self.program()?;
        let PaperSums { of_samples, signed, volume } = program.paper_sums(&tube.sets);
        Ok(Costs { cost: program.cost(&tube.sets), of_samples, paper: Some(signed), volume })
    }
}

/// The reachable set of the deviation at one sample.
pub(crate) struct LinearSlice<'a> {
    grid: &'a Grid,
    generators: &'a SampleGenerators<'a>,
    sets: &'a UncertaintySets,
    at: At,
}

impl LinearSlice<'_> {
    fn sample(&self) -> usize {
        self.at.1 as usize
    }

    /// Returns the radii of the set's interval hull with the noise set, 2n, in floating point.
    pub(crate) fn hull(&self) -> Vec<f64> {
        let (sample, grid) = (self.sample(), self.grid);
        let (e, gain) = (grid.propagation.exponential(sample), &grid.input_gains[sample]);
        let radius = |i: usize| {
            let start = e.row(i).into_iter().zip(&self.sets.initial_set.radius);
            let input = gain.row(i).into_iter().zip(&self.sets.input_set.radius);
            let sum: f64 = start.chain(input).map(|(x, r)| x.mid().abs() * r).sum();
            sum + self.sets.noise_radius(i)
        };
        (0..self.sets.initial_set.dimension()).map(radius).collect()
    }
}

impl Slice for LinearSlice<'_> {
    fn at(&self) -> At {
        self.at
    }

    fn centre(&self) -> (Vec<f64>, Vec<f64>) {
        let (sample, propagation) = (self.sample(), &self.grid.propagation);
        let (e, gamma) = (propagation.exponential(sample), propagation.integral(sample));
        let UncertaintySets { initial_set, input_set, .. } = self.sets;
        let entry = |i: usize| {
            let start = e.row(i).into_iter().zip(&initial_set.centre);
            let input = gamma.row(i).into_iter().zip(&input_set.centre);
            let sum = start.chain(input).fold(Interval::ZERO, |sum, (x, c)| sum + *x * *c);
            (sum.mid(), sum.rad())
        };
        (0..initial_set.dimension()).map(entry).unzip()
    }

    fn generators(&self, states: &[usize], held: usize) -> GeneratorRows {
        let UncertaintySets { initial_set, input_set, .. } = self.sets;
        let noise: Vec<f64> =
            (0..initial_set.dimension()).map(|i| self.sets.noise_radius(i)).collect();
        let radii = [&initial_set.radius[..], &input_set.radius, &noise];
        self.generators.at(self.sample(), radii, states, held)
    }

    fn coarse(&self) -> Vec<usize> {
        vec![self.sample().div_ceil(HELD)]
    }

    fn support(&self, l: &[f64]) -> f64 {
        let UncertaintySets { initial_set, input_set, .. } = self.sets;
        let (initial, input) = self.generators.gains(self.sample(), l);
        let gains = initial.iter().chain(&input);
        let radii = initial_set.radius.iter().chain(&input_set.radius);
        let (centre, _) = self.centre();
        dot(l, &centre) + gains.zip(radii).map(|(gain, r)| gain * r).sum::<f64>()
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
