//! The model file of an arm.

use std::path::Path;
use std::sync::Arc;

use reachtube_abstraction::PolynomialModel;
use reachtube_conform::data::Drive;
use reachtube_conform::model::Loader;
use reachtube_conform::{Model, Result, Setup};
use reachtube_reach::System;
use reachtube_robot::{Robot, RobotDescription};
use serde::Deserialize;
use serde_json::Value;

use crate::arm::Arm;
use crate::record::DriveRecord;
use crate::setup::driven;
use crate::system::{system, system_of};

const REMEDY: &str = "give a file that `model` or `conform` wrote, such as arm/model.json";

/// Reads a model file, checks that its parts fit together, and returns what a problem with other
/// recordings needs of it: the arm, the model bit by bit as the file has it, and the settings.
///
/// # Errors
///
/// A file that cannot be read, or what is wrong with it.
pub fn open(path: &Path) -> Result<(Model, Setup)> {
    parse(&reachtube_files::read_text(path, REMEDY)?, path)
}

/// Reads the text of a model file as [`open`] does; errors name it `origin`.
///
/// # Errors
///
/// What is wrong with it.
pub fn parse(text: &str, origin: &Path) -> Result<(Model, Setup)> {
    Model::parse(text, origin, &ArmLoader)
}

/// Returns the JSON schema of the model file of an arm, with or without findings beside the model.
#[must_use]
pub fn model_schema() -> Value {
    let mut schema = Model::schema();
    let mut drive = reachtube_files::schema::<DriveRecord>();
    if let (Some(of_drive), Some(all)) =
        (drive["$defs"].as_object(), schema["$defs"].as_object_mut())
    {
        all.extend(of_drive.clone());
    }
    if let Some(drive) = drive.as_object_mut() {
        drive.retain(|key, _| !key.starts_with('$') && key != "title");
    }
    schema["properties"]["drive"] = drive;
    schema
}

/// What a model says of the arm that drives it.
pub trait ArmModel {
    /// Returns the record of the arm.
    ///
    /// # Panics
    ///
    /// Where something else drives the model.
    fn arm(&self) -> DriveRecord;

    /// Returns the robot, identified from all recordings that it or a fit of it has seen.
    ///
    /// # Panics
    ///
    /// As [`arm`](Self::arm).
    fn robot(&self) -> RobotDescription;

    /// Returns what a problem with other recordings needs of the model, as [`open`].
    ///
    /// # Errors
    ///
    /// A model whose parts contradict each other.
    fn setup(&self) -> Result<Setup>;
}

impl ArmModel for Model {
    fn arm(&self) -> DriveRecord {
        record(self).expect("an arm drives the model")
    }

    fn robot(&self) -> RobotDescription {
        robot_of(self, self.arm().robot)
    }

    fn setup(&self) -> Result<Setup> {
        self.loaded(&ArmLoader)
    }
}

fn record(model: &Model) -> Result<DriveRecord, String> {
    DriveRecord::deserialize(&model.drive)
        .map_err(|error| format!("drive: {error}; give the file as `conform --out` wrote it"))
}

fn robot_of(model: &Model, mut robot: RobotDescription) -> RobotDescription {
    robot.add_identified_from(model.seen.iter().cloned());
    robot
}

struct ArmLoader;

impl Loader for ArmLoader {
    fn load(&self, model: &Model) -> Result<(Arc<dyn Drive>, System), String> {
        let record = record(model)?;
        let n = record.robot.joints.len();
        let point = &record.settings.expansion_point;
        if point.q.len() != n || point.qd.len() != n {
            return Err(format!("its expansion point is not one of {n} joints; run conform again"));
        }
        if record.correction.as_ref().is_some_and(|correction| !correction.is_valid_for(n)) {
            return Err(format!("its correction is not one of {n} joints; run conform again"));
        }
        let robot = Robot::from_description(&robot_of(model, record.robot.clone()))
            .map_err(|error| error.to_string())?;
        let system = match record.polynomials() {
            Some(records) => {
                let abstraction = record.settings.abstraction;
                PolynomialModel::from_records(&robot, abstraction, point, records)
                    .map(|polynomials| system_of(polynomials, model.settings.method))
                    .map_err(|error| error.to_string())
            }
            None => system(&robot, &record.settings, model.settings.method)
                .map_err(|error| error.to_string()),
        }?;
        let arm = Arm::new(robot, record.correction, record.settings);
        Ok((driven(arm), system))
    }
}
