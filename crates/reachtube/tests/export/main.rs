//! Every exported file is read back, and holds the model bit by bit.

mod affine;
mod automata;
mod cases;
mod dynamics;
mod reader;
mod refusals;
mod robots;
mod shield;
