//! Tables and figures of the paper, reproduced, and the bounds for the next motion put to the test.

mod chosen_model;
mod claims;
mod coverage;
mod exemplary;
mod figures;
mod full_speed_motion;
mod paper;
mod paper_page;
mod reproduced;
mod table1;
mod table2;
mod table3;
mod tables;
mod trajectories;
mod virtual_motions;

pub use claims::Claim;
pub use coverage::{Coverage, CoverageOptions, CoverageRow, coverage};
pub use figures::PaperFigure;
pub use paper::{Paper, Speed};
pub use reproduced::{Item, ReproduceOptions, Reproduced, reproduce};
pub use table1::{Cell, Table1, Table1Options, table1};
pub use table2::{Table2, Table2Case, Table2Options};
pub use table3::Table3;
pub use tables::Sheet;
