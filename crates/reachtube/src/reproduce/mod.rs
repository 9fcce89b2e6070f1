//! Tables of the paper, made again.

mod table1;
mod trajectories;

pub use table1::{Cell, Paper, Speed, Table1, Table1Options, table1};
