//! One window: a nominal motion from a measured state on, and the set around it.

use reachtube_reach::{IntervalVector, Solution};
use reachtube_recordings::{Sample, State};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, sub_down, sub_up};

use crate::data::side::Side;
use crate::monitor::leave::Leave;
use crate::monitor::nominal::LiveNominal;
use crate::sets::UncertaintySets;
use crate::tube::grids::Grid;
use crate::tube::rows::excesses;
use crate::tube::strand::Strand;

/// Data common to all windows.
#[derive(Debug)]
pub(crate) struct Sets {
    pub grid: Grid,
    /// The reachable sets of the deviation over a window.
    pub strand: Strand,
    pub sets: UncertaintySets,
    /// Number of states that are rows.
    pub rows: usize,
}

/// A window, open or to be opened.
#[derive(Debug, Clone)]
pub(crate) struct Window {
    /// The sample that it is at; `None` if it is not open.
    pub sample: Option<usize>,
    /// Time of its first sample, s.
    begin: f64,
    /// Whether a value was outside.
    pub is_left: bool,
    /// The nominal motion, enclosed.
    nominal: Solution,
    /// The nominal motion along which the input is corrected, 2n, and its next state.
    corrected: [Vec<f64>; 2],
    /// Whether that motion diverged.
    runs_away: bool,
    input: Vec<f64>,
    /// The part of the set that was used at most after the first sample, and the signed part at
    /// the newest sample, 2n.
    pub used: Vec<f64>,
    pub signed: Vec<f64>,
}

impl Window {
    pub(crate) fn new(parts: usize) -> Self {
        let zeros = || vec![0.0; 2 * parts];
        Self {
            sample: None,
            begin: 0.0,
            is_left: false,
            nominal: Solution::new(&IntervalVector::from_element(2 * parts, Interval::ZERO)),
            corrected: [zeros(), zeros()],
            runs_away: false,
            input: vec![0.0; parts],
            used: zeros(),
            signed: zeros(),
        }
    }

    pub(crate) fn open(&mut self, sample: &Sample) {
        (self.sample, self.begin, self.is_left) = (Some(0), sample.time, false);
        self.nominal.restart(sample.state());
        self.corrected[0].copy_from_slice(sample.state());
        self.runs_away = false;
        self.used.fill(0.0);
    }

    pub(crate) fn advance(&mut self, sets: &Sets, live: Option<&mut LiveNominal>, input: &[f64]) {
        let Some(sample) = &mut self.sample else { return };
        self.input.copy_from_slice(input);
        if let Some(live) = live.filter(|_| !self.runs_away) {
            let [x, next] = &mut self.corrected;
            self.runs_away = !live.advance(x, &mut self.input, next);
            std::mem::swap(x, next);
        }
        if !self.runs_away {
            self.nominal.advance(&sets.grid.propagation, *sample, &self.input);
        }
        *sample += 1;
    }

    /// Compares a sample with the set, and hands what lies outside to `outside`; returns the number
    /// of rows that do not hold.
    pub(crate) fn judge(
        &mut self,
        sets: &Sets,
        measured: &Sample,
        mut outside: impl FnMut(Leave),
    ) -> u64 {
        let Some(sample) = self.sample else { return 0 };
        let mut count = 0;
        for (i, &value) in measured.state()[..sets.rows].iter().enumerate() {
            let Some(bounds) = sets.strand.hull.bounds(sample, i) else { continue };
            let (x, noise) = (self.nominal.state(i), sets.sets.noise_radius(i));
            let deviation = [sub_up(value, x.lo()), sub_down(value, x.hi())];
            let mut excess = excesses(bounds, noise, deviation);
            let radius = bounds.radius + noise;
            if self.runs_away {
                excess = [f64::INFINITY; 2];
            }
            let offset = value - x.mid() - 0.5 * (bounds.lower + bounds.upper);
            self.signed[i] = if offset == 0.0 { 0.0 } else { offset / radius };
            // Every window begins with no deviation, wherever that lies in the set.
            if sample > 0 {
                self.used[i] = self.used[i].max(self.signed[i].abs());
            }
            let [above, below] = excess;
            if above <= 0.0 && below <= 0.0 {
                continue;
            }
            count += 1;
            let (side, excess) =
                if below > above { (Side::Lower, below) } else { (Side::Upper, above) };
            let state = State::from_index(i, self.input.len());
            outside(Leave {
                time: measured.time,
                window: self.begin,
                part: state.part + 1,
                state,
                side,
                value,
                excess,
                radius,
                proved: !self.runs_away && self.is_outside(sets, (sample, i), value, side),
                first: !std::mem::replace(&mut self.is_left, true),
            });
        }
        count
    }

    /// Returns whether a value is proved to lie outside the set.
    ///
    /// # Guarantee
    ///
    /// Compared with an outer bound of the set with V, directed rounding.
    fn is_outside(&self, sets: &Sets, (k, i): (usize, usize), value: f64, side: Side) -> bool {
        let Some(reach) = sets.strand.deviation() else { return false };
        let (x, noise) = (self.nominal.state(i), sets.sets.noise_radius(i));
        let beyond = |deviation: f64, bound: f64| sub_down(deviation, add_up(bound, noise)) > 0.0;
        match side {
            Side::Upper => beyond(sub_down(value, x.hi()), reach.upper_outer(k, i)),
            Side::Lower => beyond(sub_down(x.lo(), value), -reach.lower_outer(k, i)),
        }
    }
}

impl Sets {
    pub(crate) fn new(grid: Grid, sets: UncertaintySets, rows: usize) -> Self {
        let strand = Strand::on_grid(&grid, &sets);
        Self { grid, strand, sets, rows }
    }

    pub(crate) fn last(&self) -> usize {
        self.grid.times.len() - 1
    }
}
