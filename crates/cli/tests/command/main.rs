//! Tests of the binary: its exit codes, its output and the files it writes.

mod abstraction;
mod bad_input;
mod browser;
mod convert;
mod defects;
mod export;
mod fixture;
mod identify;
mod index;
mod inspect;
mod locks;
mod model;
mod monitor;
mod nonlinear;
mod notions;
mod options;
mod output_schema;
mod outputs;
mod overwrite;
mod prismatic;
mod provenance;
mod reach;
mod renamed;
mod reproduce;
#[path = "../../../logs/tests/logs/support.rs"]
mod robot_logs;
mod robots;
mod schema;
mod schunk;
mod settings;
mod short;
mod stop;
mod terminal;
mod verdicts;
mod verify;
mod wrong_inputs;
