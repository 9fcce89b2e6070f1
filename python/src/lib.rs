//! The native part of the Python package `reachtube`. It converts arrays and text and calls the
//! product; the classes that users see are in Python, in `python/reachtube`.

mod abstraction;
mod arrays;
mod conformance;
mod dynamics;
mod excitation;
mod failure;
mod findings;
mod fleet;
mod flowpipe;
mod identification;
mod logs;
mod logs_on_disk;
mod manifest;
mod model;
mod monitor;
mod pool;
mod prepare;
mod recordings;
mod robot;
mod safety;
mod systems;
mod tracking;
mod watched;

use pyo3::prelude::*;

#[pymodule]
mod _reachtube {
    #[pymodule_export]
    use crate::abstraction::NativeAbstraction;
    #[pymodule_export]
    use crate::conformance::{
        among_others, check, check_model, conform, model_schema, reach, report,
    };
    #[pymodule_export]
    use crate::excitation::excite;
    #[pymodule_export]
    use crate::findings::{check_findings, model_findings, model_report};
    #[pymodule_export]
    use crate::fleet::{NativeFleet, NativeFold};
    #[pymodule_export]
    use crate::flowpipe::flowpipe;
    #[pymodule_export]
    use crate::identification::identify;
    #[pymodule_export]
    use crate::logs::read_log;
    #[pymodule_export]
    use crate::model::{cut, model, prepared};
    #[pymodule_export]
    use crate::monitor::NativeMonitor;
    #[pymodule_export]
    use crate::prepare::prepare;
    #[pymodule_export]
    use crate::recordings::{NativeRun, NativeSource};
    #[pymodule_export]
    use crate::robot::NativeRobot;
    #[pymodule_export]
    use crate::safety::{stop, verify};
    #[pymodule_export]
    use crate::systems::{
        check_runs, check_system, conform_system, given_system, open_system, parse_system,
        reach_runs,
    };
    #[pymodule_export]
    use crate::tracking::{
        check_tracking, make_tracking, paddings, parse_tracking, plan_tube, tolerances,
    };
    #[pymodule_export]
    use crate::version;
}

/// Returns the version of the library.
#[pyfunction]
fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}
