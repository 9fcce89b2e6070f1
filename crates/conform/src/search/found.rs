use std::collections::HashSet;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::data::side::Side;
use crate::next_motion::left_out::LeftOutMotions;
use crate::tube::plant::Costs;
use crate::tube::rows::{Edge, Row};
use crate::tube::tube::Tube;
use crate::tube::witness::Witness;

/// Sets that were found for a problem, before the verdict.
pub(crate) struct Found {
    /// The sets and their reachable sets.
    pub tube: Tube,
    pub costs: Costs,
    /// No sets cost less, for a linear model.
    pub lower_bound: Option<f64>,
    /// Gap between cost and lower bound, relative to the lower bound, for a linear model.
    pub optimality_gap: Option<f64>,
    /// The search, for a model that is not linear.
    pub search: Option<SearchSummary>,
    /// The sets without each motion.
    pub left_out: LeftOutMotions,
    /// Which rows decide the sets.
    pub deciding: Deciding,
    /// The recorded points that decide the sets in directions other than the states.
    pub touching: Vec<Witness>,
}

impl Found {
    pub(crate) fn new(tube: Tube, costs: Costs, deciding: Deciding) -> Self {
        Self {
            tube,
            costs,
            lower_bound: None,
            optimality_gap: None,
            search: None,
            left_out: LeftOutMotions::default(),
            deciding,
            touching: Vec::new(),
        }
    }
}

/// A point touches the set when it is within this part of its reach.
pub(crate) const TOUCHING: f64 = 1e-4;

/// Which rows decide the sets.
pub(crate) enum Deciding {
    /// Rows that touch the reachable set, within a part of its radius.
    Touching(f64),
    /// Rows named (strand, sample, state, side).
    Rows(HashSet<(usize, usize, usize, Side)>),
}

impl Deciding {
    pub(crate) fn contains(&self, row: &Row, edge: &Edge) -> bool {
        let named = (row.strand, row.sample, row.state, edge.side);
        edge.excess.is_finite()
            && match self {
                Self::Touching(part) => edge.excess >= -part * row.radius,
                Self::Rows(rows) => rows.contains(&named),
            }
    }
}

/// The search for the sets of a model that is not linear.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SearchSummary {
    /// Number of linearisations, each with its program.
    pub rounds: usize,
    /// Number of times that the reachable sets of all suites were computed.
    pub reachable_sets: usize,
    /// The cost of the linearised sets, Σ_k w_k Σ_i s_i 2 (R_k r)_i, which the programs minimise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linearised_cost: Option<f64>,
    /// The cost of the linearised sets as the paper sums it over distinct sample times.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub linearised_cost_of_samples: Option<f64>,
    /// The case and the time (s) at which a simulated motion under the last sets but one left every
    /// bound.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub runs_away: Option<(String, f64)>,
}
