use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A tool that computes reachable sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Tool {
    /// CORA, in MATLAB.
    Cora,
    /// SpaceEx.
    SpaceEx,
    /// Flow* 2.1.
    FlowStar,
    /// HyLAA 2, in Python.
    HyLaa,
    /// XSpeed, which reads SpaceEx files with one location.
    XSpeed,
    /// ReachabilityAnalysis.jl, in Julia.
    JuliaReach,
}

/// How the recorded input enters an exported model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum InputForm {
    /// The recorded input, held from sample to sample, plus U.
    Recorded,
    /// Only the deviations from the nominal motion, for affine models: no input but U. The tool's
    /// set plus the nominal motion is the reachable set.
    Deviation,
    /// Any input that stays in the box of all recorded inputs plus U.
    Range,
}

impl fmt::Display for Tool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cora => "CORA",
            Self::SpaceEx => "SpaceEx",
            Self::FlowStar => "Flow*",
            Self::HyLaa => "HyLAA",
            Self::XSpeed => "XSpeed",
            Self::JuliaReach => "JuliaReach",
        })
    }
}

impl fmt::Display for InputForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Recorded => "recorded",
            Self::Deviation => "deviation",
            Self::Range => "range",
        })
    }
}
