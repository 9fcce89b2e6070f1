//! The JSON schemas of files and results, generated from the types that are written.

use clap::ValueEnum;
use reachtube::arm::model_schema;
use reachtube::campaign::RecordedCampaign;
use reachtube::identify::Summary;
use reachtube::pipeline::{ModelOutput, VerifyOutput};
use reachtube::recordings::Inspection;
use reachtube::systems::{SystemCheck, SystemDescription, SystemModel};
use reachtube::tracking::TrackingCheck;
use reachtube::verify::StopStudy;
use reachtube::{Check, abstraction};
use reachtube_files::{schema, schema_of_any};
use reachtube_logs::LogInspection;
use schemars::JsonSchema;
use serde_json::Value;

use crate::commands::r#abstract::AbstractOutput;
use crate::commands::convert::ConvertOutput;
use crate::commands::demo::DemoOutput;
use crate::commands::excite::ExciteOutput;
use crate::commands::export::{
    ModelExport, PaddingsExport, RobotExport, ShieldExport, TolerancesExport,
};
use crate::commands::monitor::{Event, TrackingEvent};
use crate::commands::prepare::PrepareOutput;
use crate::commands::reach::ReachOutput;
use crate::commands::report::ReportOutput;
use crate::commands::reproduce::Numbers;
use crate::commands::robot::RobotOutput;
use crate::commands::system::{SystemOutput, TubesOutput};
use crate::commands::tracking::{PlansOutput, TrackingOutput};
use crate::output::ErrorOutput;

/// What a schema describes.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(crate) enum SchemaOf {
    /// A model file
    Model,
    /// An abstraction file
    Abstraction,
    /// A file with a system
    System,
    /// A model file of a system
    SystemModel,
    /// What each command prints with --json
    Results,
}

pub(crate) fn schema_of(what: SchemaOf) -> Value {
    match what {
        SchemaOf::Model => model_schema(),
        SchemaOf::Abstraction => abstraction::file_schema(),
        SchemaOf::System => schema::<SystemDescription>(),
        SchemaOf::SystemModel => schema::<SystemModel>(),
        SchemaOf::Results => results(),
    }
}

/// Returns the schema of what each command prints, with a definition for each.
fn results() -> Value {
    schema_of_any(
        "What commands print with --json; numbers are in SI units",
        &[
            ("abstract", AbstractOutput::json_schema),
            ("campaign", RecordedCampaign::json_schema),
            ("check", Check::json_schema),
            ("check_system", SystemCheck::json_schema),
            ("check_tracking", TrackingCheck::json_schema),
            ("conform_system", SystemOutput::json_schema),
            ("convert", ConvertOutput::json_schema),
            ("demo", DemoOutput::json_schema),
            ("error", ErrorOutput::json_schema),
            ("excite", ExciteOutput::json_schema),
            ("export", ModelExport::json_schema),
            ("export_paddings", PaddingsExport::json_schema),
            ("export_robot", RobotExport::json_schema),
            ("export_shield", ShieldExport::json_schema),
            ("export_tolerances", TolerancesExport::json_schema),
            ("identify", Summary::json_schema),
            ("inspect", Inspection::json_schema),
            ("inspect_logs", LogInspection::json_schema),
            ("model", ModelOutput::json_schema),
            ("model_tracking", TrackingOutput::json_schema),
            ("monitor", Event::json_schema),
            ("monitor_tracking", TrackingEvent::json_schema),
            ("prepare", PrepareOutput::json_schema),
            ("reach", ReachOutput::json_schema),
            ("reach_plan", PlansOutput::json_schema),
            ("reach_system", TubesOutput::json_schema),
            ("report", ReportOutput::json_schema),
            ("reproduce", Numbers::json_schema),
            ("robot_show", RobotOutput::json_schema),
            ("stop", StopStudy::json_schema),
            ("verify", VerifyOutput::json_schema),
        ],
    )
}
