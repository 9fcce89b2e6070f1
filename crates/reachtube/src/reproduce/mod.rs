//! Tables of the paper, reproduced.

pub(crate) mod error;
mod full_speed_motion;
mod paper;
mod speed;
mod table1;
mod trajectories;

pub use error::ReproduceError;
pub use paper::Paper;
pub use speed::Speed;
pub use table1::{Cell, Table1, Table1Options, table1};
