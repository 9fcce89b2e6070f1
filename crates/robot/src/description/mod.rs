//! Descriptions of robots: the TOML format, which model files embed as JSON.

pub(crate) mod joint_description;
mod lock;
pub(crate) mod read;
pub(crate) mod robot_description;
pub(crate) mod validity;
mod values;
