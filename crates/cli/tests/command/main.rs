//! Tests of the binary: its exit codes, its output and the files it writes.

mod abstraction;
mod bad_input;
mod beyond;
mod browser;
mod convert;
mod defects;
mod description_units;
mod export;
mod faster;
mod findings;
mod fixture;
mod identify;
mod index;
mod inspect;
mod locks;
mod missing_samples;
mod model;
mod monitor;
mod newcomer;
mod nonlinear;
mod notions;
mod one_motion;
mod options;
mod output_schema;
mod outputs;
mod overwrite;
mod prismatic;
mod provenance;
mod reach;
mod reproduce;
#[path = "../../../logs/tests/logs/support.rs"]
mod robot_logs;
mod robots;
mod schema;
mod schunk;
#[path = "../../../tracking/tests/tracking/servo.rs"]
mod servo;
mod short;
mod stability;
mod stop;
mod terminal;
mod tracking;
mod verdicts;
mod verify;
mod verify_stops;
mod wrong_inputs;
