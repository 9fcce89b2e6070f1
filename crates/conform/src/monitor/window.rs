//! One window: a nominal motion from a measured state on, and the set around it.

use reachtube_reach::{IntervalVector, Solution};
use reachtube_recordings::{Sample, State};
use reachtube_scalar::Interval;
use reachtube_scalar::rounding::{add_up, sub_down, sub_up};

use crate::data::side::Side;
use crate::data::signals::Part;
use crate::monitor::leave::Leave;
use crate::monitor::nominal::LiveNominal;
use crate::sets::{InputScale, UncertaintySets};
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
    /// The parts of the system, and the rates at which U is twice what it is at rest, if it grows
    /// with the nominal motion. How large it is, a window then knows at its end.
    pub doubling: Option<(Vec<Part>, Vec<f64>)>,
}

/// A sample of a window whose set is known at its end.
#[derive(Debug, Clone)]
struct KeptSample {
    time: f64,
    measured: Vec<f64>,
    nominal: Vec<Interval>,
    runs_away: bool,
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
    /// The samples so far, where they are judged at the end.
    kept: Vec<KeptSample>,
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
            kept: Vec::new(),
        }
    }

    pub(crate) fn open(&mut self, sample: &Sample, start: &[f64]) {
        (self.sample, self.begin, self.is_left) = (Some(0), sample.time, false);
        self.nominal.restart(start);
        self.corrected[0].copy_from_slice(start);
        self.runs_away = false;
        self.used.fill(0.0);
        self.kept.clear();
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

    /// Compares a sample with the set, and hands what lies outside to `outside`; returns how many
    /// rows were compared, and how many of them do not hold. Where U grows with the nominal
    /// motion, all samples are compared at the end of the window.
    pub(crate) fn judge(
        &mut self,
        sets: &Sets,
        measured: &Sample,
        mut outside: impl FnMut(Leave),
    ) -> [u64; 2] {
        let Some(sample) = self.sample else { return [0; 2] };
        let Some((parts, doubling)) = &sets.doubling else {
            let at = (sample, measured.time, self.runs_away);
            let state = |window: &Self, i: usize| window.nominal.state(i);
            let count = self.compare(sets, &sets.strand, at, measured.state(), state, &mut outside);
            return [sets.rows as u64, count];
        };
        self.kept.push(KeptSample {
            time: measured.time,
            measured: measured.state().to_vec(),
            nominal: (0..measured.state().len()).map(|i| self.nominal.state(i)).collect(),
            runs_away: self.runs_away,
        });
        if sample < sets.last() {
            return [0; 2];
        }
        let kept = std::mem::take(&mut self.kept);
        let times = &sets.grid.times.times()[..kept.len()];
        let scale = InputScale::along(times, |k, i| kept[k].nominal[i], parts, doubling);
        let strand = Strand::on_grid(&sets.grid, &sets.sets.along(&scale));
        let mut count = 0;
        for (k, own) in kept.iter().enumerate() {
            let (at, state) = ((k, own.time, own.runs_away), |_: &Self, i: usize| own.nominal[i]);
            count += self.compare(sets, &strand, at, &own.measured, state, &mut outside);
        }
        self.kept = kept;
        [(sets.rows * times.len()) as u64, count]
    }

    /// Compares the values of a sample with a strand; `state` returns the nominal one.
    fn compare(
        &mut self,
        sets: &Sets,
        strand: &Strand,
        (sample, time, runs_away): (usize, f64, bool),
        measured: &[f64],
        state: impl Fn(&Self, usize) -> Interval,
        outside: &mut impl FnMut(Leave),
    ) -> u64 {
        let mut count = 0;
        for (i, &value) in measured[..sets.rows].iter().enumerate() {
            let Some(bounds) = strand.hull.bounds(sample, i) else { continue };
            let (x, noise) = (state(self, i), sets.sets.noise_radius(i));
            let deviation = [sub_up(value, x.lo()), sub_down(value, x.hi())];
            let mut excess = excesses(bounds, noise, deviation);
            let radius = bounds.radius + noise;
            if runs_away {
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
                time,
                window: self.begin,
                part: state.part + 1,
                state,
                side,
                value,
                excess,
                radius,
                proved: !runs_away && is_outside(strand, (sample, i), (x, noise), (value, side)),
                first: !std::mem::replace(&mut self.is_left, true),
            });
        }
        count
    }
}

/// Returns whether a value is proved to lie outside the set around a nominal state, with the radius
/// `noise` of V.
///
/// # Guarantee
///
/// Compared with an outer bound of the set with V, directed rounding.
fn is_outside(
    strand: &Strand,
    (k, i): (usize, usize),
    (x, noise): (Interval, f64),
    (value, side): (f64, Side),
) -> bool {
    let Some(reach) = strand.deviation() else { return false };
    let beyond = |deviation: f64, bound: f64| sub_down(deviation, add_up(bound, noise)) > 0.0;
    match side {
        Side::Upper => beyond(sub_down(value, x.hi()), reach.upper_outer(k, i)),
        Side::Lower => beyond(sub_down(x.lo(), value), -reach.lower_outer(k, i)),
    }
}

impl Sets {
    pub(crate) fn new(
        grid: Grid,
        sets: UncertaintySets,
        rows: usize,
        doubling: Option<(Vec<Part>, Vec<f64>)>,
    ) -> Self {
        let strand = Strand::on_grid(&grid, &sets);
        Self { grid, strand, sets, rows, doubling }
    }

    pub(crate) fn last(&self) -> usize {
        self.grid.times.len() - 1
    }
}
