//! Tests of models of an arm under its controller, with logs whose truth is known.

mod cautions;
mod common;
mod delays;
mod monitored;
mod plans;
mod real_logs;
mod second_way;
mod servo;
mod servo_model;
mod simulated;
mod smallest;
mod spoiled;
mod stability;
