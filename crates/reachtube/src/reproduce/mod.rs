//! Tables of the paper, reproduced, and the bounds for the next motion put to the test.

mod coverage;
pub(crate) mod error;
mod full_speed_motion;
mod paper;
mod random_motions;
mod speed;
mod table1;
mod table2;
mod trajectories;

pub use coverage::{Coverage, CoverageOptions, CoverageRow, coverage};
pub use error::ReproduceError;
pub use paper::{Paper, PaperSets};
pub use speed::Speed;
pub use table1::{Cell, Table1, Table1Options, table1};
pub use table2::{Table2, Table2Case, Table2Options, table2};
