//! Reading of the oracle files.

use reachtube_robot::{
    Convention, InertiaPoint, JointDescription, ParameterSet, PlacementDescription, Robot,
    RobotDescription,
};
use serde_json::Value;

/// The folder of reference values, beside the repository.
pub(crate) const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/");

/// Reads a JSON file of the shared folder. Tests that need one are ignored unless requested.
pub(crate) fn oracle(path: &str) -> Value {
    let text = std::fs::read_to_string(format!("{FOLDER}{path}"));
    serde_json::from_str(&text.unwrap_or_else(|error| panic!("{path}: {error}"))).unwrap()
}

/// Returns the numbers of a JSON array.
pub(crate) fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn triple(v: &Value) -> [f64; 3] {
    numbers(v).try_into().unwrap()
}

fn joint(link: &Value) -> JointDescription {
    let rows = |key: &str| -> [[f64; 3]; 3] {
        link[key].as_array().unwrap().iter().map(triple).collect::<Vec<_>>().try_into().unwrap()
    };
    let i = rows("inertia_com");
    JointDescription {
        name: link["joint"].as_str().unwrap().into(),
        placement: Some(PlacementDescription {
            rotation: Some(rows("R")),
            translation: triple(&link["p"]),
            rpy: None,
        }),
        axis: Some(triple(&link["axis"])),
        mass: link["mass"].as_f64().unwrap(),
        com: Some(triple(&link["com"])),
        inertia: [i[0][0], i[0][1], i[0][2], i[1][1], i[1][2], i[2][2]],
        about: InertiaPoint::Com,
        armature: link["armature"].as_f64(),
        ..Default::default()
    }
}

/// Describes the robot of an oracle by placements.
pub(crate) fn description(oracle: &Value) -> RobotDescription {
    RobotDescription {
        schema_version: 1,
        name: oracle["name"].as_str().unwrap().into(),
        parameters: ParameterSet::Physical,
        convention: Convention::Standard,
        gravity: triple(&oracle["gravity"]),
        locked: Vec::new(),
        identified_from: Vec::new(),
        joints: oracle["links"].as_array().unwrap().iter().map(joint).collect(),
    }
}

/// Returns the robot of `shared/oracle/<name>.json`.
pub(crate) fn oracle_robot(name: &str) -> Robot {
    Robot::from_description(&description(&oracle(&format!("oracle/{name}.json")))).unwrap()
}
