//! The words of an answer: one constructor for each code.

mod beyond_proof;
mod check;
mod dependence;
mod fit;
mod held_out;
mod limits;
mod new_motions;
pub(crate) mod plausibility;
mod sets;
mod stiction;
mod vacuous;
mod verdict;

pub(crate) use check::{
    at_rest, growth_needed, least_growth, note, other_recordings, other_start, use_unknown,
};
pub(crate) use dependence::{left_out, robot_changed};
pub(crate) use fit::{any_run, fitted, parameters_moved};
pub(crate) use limits::{beyond_recordings, reach_of_proof};
pub(crate) use new_motions::{
    calibrated, fitted_to_these, next_motion, next_motion_in_brief, next_motion_of_fit,
};
pub(crate) use sets::touching;
pub(crate) use vacuous::{vacuous, vacuous_in_brief};
pub(crate) use verdict::{
    cost, furthest_point, furthest_value, lost_in_brief, not_smallest, outcome_of_fit,
    place_outside, points, recordings_of_fit, unstable, verdict_of_check, verdict_of_fit,
};
