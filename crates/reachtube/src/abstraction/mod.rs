//! The three models of the forward dynamics (Sec. IV-B of the paper). So far: model 1 at order p = 1.

mod expansion_point;
mod model1;

pub use expansion_point::ExpansionPoint;
pub use model1::linear_model;
