//! What the check of all rows came to.

use serde::{Deserialize, Serialize};

use super::program::TIGHT;
use super::verify::Row;
use super::{Settings, States};

/// What was proved about the recordings, and how.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Proof {
    /// Whether every row was proved to hold.
    pub verified: bool,
    /// The claim in words.
    pub claim: String,
    /// Which reachable set the rows were held against.
    pub enclosure: Enclosure,
    /// Rows checked: suite x sample x state x side.
    pub rows: usize,
    /// Rows that were proved.
    pub proved: usize,
    /// Recordings behind the rows.
    pub runs: usize,
    /// The largest excess of a row that has a reachable set, rad or rad/s: not above 0 when all
    /// rows hold.
    pub largest_excess: f64,
    /// Where a reachable set could not be followed to the end; the rows from there on are not
    /// proved.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lost: Vec<Lost>,
}

/// What is known of the reachable set that recordings are held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Enclosure {
    /// Its hull, taken from inside: what is in it is reachable in that state.
    #[default]
    Inner,
    /// A computed set around it: what a formal analysis uses, and for a model that is not linear
    /// all that can be computed.
    Outer,
}

/// A reachable set that was lost: the model may run away under its uncertainty, or the enclosure
/// grew too wide.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lost {
    /// The suite, and the run where it has an input of its own.
    pub case: String,
    /// The last sample time that has a reachable set, s.
    pub time: f64,
    /// The column of a recording that grew fastest there: q3, qd1, ...
    pub state: String,
}

/// A row in which a run touches the reachable set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TightRow {
    /// Index of the suite in the recordings.
    pub suite: usize,
    /// The row.
    pub row: Row,
}

/// Rows counted.
#[derive(Debug, Clone)]
pub(super) struct Checked {
    pub rows: usize,
    pub failed: usize,
    pub largest_excess: f64,
    /// The closest first, once they are sorted.
    pub tight: Vec<TightRow>,
}

impl Checked {
    pub fn new() -> Self {
        Self { rows: 0, failed: 0, largest_excess: f64::NEG_INFINITY, tight: Vec::new() }
    }

    pub fn take(&mut self, row: &Row) {
        self.rows += 1;
        // A NaN would be no proof.
        let proved = row.excess <= 0.0;
        self.failed += usize::from(!proved);
        if row.excess.is_finite() {
            self.largest_excess = self.largest_excess.max(row.excess);
        }
    }

    /// Takes a row, and keeps it where it touches.
    pub fn take_tight(&mut self, suite: usize, row: Row) {
        self.take(&row);
        if row.excess >= -TIGHT * row.radius {
            self.tight.push(TightRow { suite, row });
        }
    }

    pub fn sort(&mut self) {
        self.tight.sort_by(|a, b| b.row.excess.total_cmp(&a.row.excess));
    }

    pub fn proof(
        &self,
        settings: &Settings,
        runs: usize,
        enclosure: Enclosure,
        lost: Vec<Lost>,
    ) -> Proof {
        let states = match settings.states {
            States::All => "position and velocity",
            States::Positions => "position",
        };
        let (set, how) = match enclosure {
            Enclosure::Inner => ("reachable set", "checked with directed rounding"),
            Enclosure::Outer => (
                "computed reachable set",
                "an outer enclosure with directed rounding, for every measurable disturbance in U",
            ),
        };
        Proof {
            verified: self.failed == 0 && self.rows > 0,
            claim: format!(
                "for each of the {runs} recordings, at each of its samples, the recorded {states} of every joint lies in the interval hull of the model's {set}; {how}, at samples"
            ),
            enclosure,
            rows: self.rows,
            proved: self.rows - self.failed,
            runs,
            largest_excess: if self.largest_excess.is_finite() { self.largest_excess } else { 0.0 },
            lost,
        }
    }
}
