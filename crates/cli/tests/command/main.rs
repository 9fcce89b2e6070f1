//! Tests of the binary: its exit codes, its output and the files it writes.

mod abstraction;
mod browser;
mod defects;
mod fixture;
mod identify;
mod index;
mod locks;
mod nonlinear;
mod options;
mod outputs;
mod prismatic;
mod reach;
mod reproduce;
mod robots;
mod schema;
mod schunk;
mod verdicts;
