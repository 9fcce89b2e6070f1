//! Reachset conformance: the smallest uncertainty sets for which every recording lies in the
//! reachable set of a model, found by programs and proved with directed rounding.
//!
//! A [`Problem`] is a model, [`Settings`] and recordings that are read once. [`conform`] finds its
//! sets, [`Model`] writes them to a file, [`check()`] compares other recordings with the reachable
//! sets ([`Hulls`]) of a model, [`reach()`] returns these sets at samples and between them, and
//! [`explain()`] searches for the motion of the model closest to each run.

mod advice;
mod answer;
mod any_run;
mod check;
mod check_job;
mod claim;
mod conformance;
mod data;
mod deviation;
mod error;
mod explain;
mod fit;
mod flowpipes;
mod found;
mod grids;
mod growth;
mod hulls;
mod job;
mod linear;
mod model;
mod next_motion;
mod nominal;
mod optimality;
mod plausibility;
mod progress;
mod reach;
mod result;
mod rows;
mod search;
mod sets;
mod tube;
mod verdict;
mod weights;
mod witness;

pub use advice::Advice;
pub use answer::Answer;
pub use any_run::AnyRun;
pub use check::{Check, check, check_elsewhere};
pub use check_job::{CheckJob, Opened};
pub use claim::certificate::Certificate;
pub use claim::part_points::{FleetProblem, PartPoints, PartReader};
pub use claim::phase_plane::PhasePlane;
pub use claim::remote::PointServer;
pub use claim::witness::{PointVerdict, PointWitness};
pub use conformance::{Conformance, conform, conform_elsewhere};
pub use data::case::Case;
pub use data::condition::Condition;
pub use data::correction::{InputCorrection, JointCorrection};
pub use data::dynamics::Dynamics;
pub use data::envelope::Envelope;
pub use data::fold::fold::Fold;
pub use data::fold::of_fold::OnDefect;
pub use data::input::RunInput;
pub use data::problem::{Keep, Problem};
pub use data::recordings::Recordings;
pub use data::sensor_noise::SensorNoise;
pub use data::settings::{
    Centre, Equations, InitialLimit, Method, Noise, NominalStart, Notion, Settings, States,
    Tolerance, Weights,
};
pub use data::setup::Setup;
pub use data::side::Side;
pub use data::suite::Suite;
pub use data::summary::RunSummary;
pub use deviation::{Deviation, Nominal};
pub use error::{Error, Result};
pub use explain::trace::TraceVerdict;
pub use explain::{Explanation, explain};
pub use fit::fit::{Fitted, fit};
pub use fit::group::{FitSettings, Group};
pub use fit::record::{
    FitRecord, FittedParameter, GroupCost, PullCost, TorquePrediction, UnseenMotion,
};
pub use found::SearchSummary;
pub use grids::{Grid, Grids};
pub use growth::Growth;
pub use hulls::{Enclosure, Hulls, Lost};
pub use job::{Basis, Job};
pub use linear::block::Block;
pub use linear::program::{Program, Solution};
pub use model::{DataRecord, Explained, Model, Residual, RunRecord, SuiteRecord};
pub use next_motion::calibration::{Calibration, Gauge};
pub use next_motion::deciding_runs::{DecidingRun, DecidingRuns};
pub use next_motion::rates::{Rate, Rates};
pub use next_motion::trends::Trend;
pub use next_motion::trust::{CONFIDENCE, Trust};
pub use next_motion::without_motion::LeftOut;
pub use plausibility::{JointWidth, Usefulness, Vacuity, VacuousSet, Warning, WarningKind};
pub use progress::{Progress, Silent};
pub use reach::{SuiteReach, reach};
pub use result::code::Code;
pub use result::finding::{Finding, Severity};
pub use result::front_end::{FrontEnd, Setting};
pub use result::remedy::Remedy;
pub use result::report::{Report, Section};
pub use result::table::Table;
pub use rows::{Edge, Row};
pub use sets::UncertaintySets;
pub use verdict::{SuiteVerdict, Verdict, Violations};
pub use witness::Witness;
