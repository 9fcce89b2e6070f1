//! The set that a tool computes from an exported model, and its difference from the model's.

use reachtube_files::{MARK, TOOL};
use reachtube_reach::Disturbance;

use super::case::ExportCase;
use super::{InputForm, Tool};

/// The meaning of an export in its tool.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Meaning {
    /// Paragraphs, which are the first lines of each file.
    pub paragraphs: Vec<String>,
    /// Whether the tool supports fewer disturbances or inputs than the model, so that its set need
    /// not contain the model's.
    pub may_be_smaller: bool,
}

const ABOUT_TRIGONOMETRY: &str = "Sines and cosines are states of their own, and X0 bounds each by \
itself. The tool does not use s^2 + c^2 = 1, nor that both belong to one angle.";

const ABOUT_NOISE: &str = "The model has a noise set V of the sensors, which is not part of this \
file: add it to the tool's set before recordings are compared with it.";

/// The disturbances that a tool supports.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum Known {
    Constant,
    Sample,
    Measurable,
}

impl Meaning {
    /// Returns what `tool` computes from `case` with its input in this form.
    #[must_use]
    pub fn new(case: &ExportCase, tool: Tool, form: InputForm) -> Self {
        let known = if tool == Tool::HyLaa { Known::Sample } else { Known::Measurable };
        let asked = match case.disturbance {
            Disturbance::Constant => Known::Constant,
            Disturbance::Sample => Known::Sample,
            Disturbance::Measurable => Known::Measurable,
        };
        let may_be_smaller = known < asked;
        let mut paragraphs = vec![
            format!("{MARK} ({TOOL}): {}.", case.model),
            "Units: s, rad, rad/s, N m; m, m/s, N for a prismatic joint.".into(),
            format!(
                "{} {} {}",
                what_is_computed(case, tool, form),
                about_disturbance(known, asked),
                about_tool(case, tool, form)
            ),
        ];
        if case.system.dimension() > 2 * case.joints() {
            paragraphs.push(ABOUT_TRIGONOMETRY.into());
        }
        if case.sets.noise_set.is_some() {
            paragraphs.push(ABOUT_NOISE.into());
        }
        if let Some(lost) = &case.reach.lost {
            let time = lost.time;
            paragraphs.push(format!("bounds.csv ends at {time} s, where reachtube lost the set."));
        }
        Self { paragraphs, may_be_smaller }
    }
}

fn what_is_computed(case: &ExportCase, tool: Tool, form: InputForm) -> String {
    let affine = case.system.linear.is_some();
    let who = match tool {
        Tool::SpaceEx if !affine => "A program that reads this file".into(),
        _ => tool.to_string(),
    };
    let set = match tool {
        Tool::HyLaa => "at the samples, exactly up to floating point,",
        Tool::Cora | Tool::SpaceEx | Tool::XSpeed | Tool::FlowStar | Tool::JuliaReach => {
            "at all times, from outside,"
        }
    };
    let of = match form {
        InputForm::Recorded => "the states under the recorded input plus a disturbance in U.",
        InputForm::Deviation => {
            "the deviations from the nominal motion under a disturbance in U. The nominal motion \
             (bounds.csv) plus its set is the reachable set."
        }
        InputForm::Range => {
            "the states under any input in the box of all recorded inputs plus U. This box \
             contains the recorded input, so the set is larger than the one of bounds.csv."
        }
    };
    format!("{who} computes {set} {of}")
}

fn about_disturbance(known: Known, asked: Known) -> String {
    let name = |class| match class {
        Known::Constant => "is constant over the whole time",
        Known::Sample => "is constant over each sample",
        Known::Measurable => "is any measurable function of time",
    };
    let compared = match known.partial_cmp(&asked) {
        Some(std::cmp::Ordering::Less) => {
            "The set may therefore be SMALLER than the model's, and proves nothing about it."
        }
        Some(std::cmp::Ordering::Greater) => "The set therefore contains the model's.",
        _ => "The two agree.",
    };
    format!("In the model a disturbance {}; here it {}. {compared}", name(asked), name(known))
}

fn about_tool(case: &ExportCase, tool: Tool, form: InputForm) -> &'static str {
    let affine = case.system.linear.is_some();
    match tool {
        Tool::FlowStar if affine && form != InputForm::Recorded => {
            "Flow* bounds what a disturbance does in a step by a box: one that acts on several \
             joints is not one disturbance there, which widens the set. It computes with intervals."
        }
        Tool::FlowStar => {
            "Flow* takes an interval constant as a fresh value in each place: a disturbance that \
             acts on several joints is not one disturbance there, which widens the set. It \
             computes with Taylor models, whose remainders are proved."
        }
        Tool::SpaceEx if !affine => {
            "SpaceEx itself takes affine flows only and refuses this file, which is a carrier for \
             programs that read its format with polynomial flows, such as Hyst and CORA."
        }
        Tool::HyLaa => "HyLAA has no bounds between samples.",
        Tool::Cora | Tool::SpaceEx | Tool::XSpeed | Tool::JuliaReach => {
            "The computation is in floating point without directed rounding."
        }
    }
}
