//! The command as a user meets it: the real binary, its exit codes, what it prints and what it
//! writes.

mod abstraction;
mod browser;
mod defects;
mod fixture;
mod identify;
mod index;
mod nonlinear;
mod options;
mod outputs;
mod reach;
mod reproduce;
mod robots;
mod schema;
mod schunk;
mod verdicts;
