//! Unsupported models are refused by name.

use reachtube::export::{InputForm, Meaning, Tool, files};

use crate::cases::{MODELS, lwa4p, uneven};

#[test]
fn what_a_tool_cannot_mean_is_refused_by_name() {
    let [affine, cubic, _] = MODELS.map(lwa4p);
    let uneven = uneven();
    use InputForm::{Deviation, Range, Recorded};
    let refusals = [
        (&cubic, Tool::HyLaa, Range, ["HyLAA takes affine systems only", "degree 3"]),
        (&cubic, Tool::XSpeed, Range, ["XSpeed takes affine systems only", "cora"]),
        (&cubic, Tool::Cora, Deviation, ["needs an affine model", "--input recorded"]),
        (&cubic, Tool::JuliaReach, Range, ["JuliaReach has no input", "flowstar"]),
        (&affine, Tool::JuliaReach, Recorded, ["JuliaReach has no input", "--input deviation"]),
        (&affine, Tool::HyLaa, Recorded, ["HyLAA has no input", "--input deviation"]),
        (&affine, Tool::XSpeed, Recorded, ["XSpeed has no input", "--input deviation"]),
        (&uneven, Tool::HyLaa, Deviation, ["HyLAA has one fixed step", "juliareach"]),
        (&uneven, Tool::Cora, Recorded, ["CORA has one fixed step", "flowstar"]),
    ];
    for (case, tool, form, words) in refusals {
        let error = files(case, tool, form).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
    for (case, tool) in [(&uneven, Tool::FlowStar), (&uneven, Tool::SpaceEx)] {
        files(case, tool, Recorded).unwrap();
    }
}

#[test]
fn only_tools_with_fewer_disturbances_may_be_smaller() {
    let [affine, cubic, _] = MODELS.map(lwa4p);
    let smaller =
        |case, tool: Tool| Meaning::new(case, tool, tool.default_form(case)).may_be_smaller;
    assert!(!smaller(&affine, Tool::HyLaa) && !smaller(&affine, Tool::JuliaReach));
    assert!(!smaller(&cubic, Tool::FlowStar) && !smaller(&cubic, Tool::Cora));
    let mut measurable = affine.clone();
    measurable.disturbance = reachtube::Disturbance::Measurable;
    assert!(smaller(&measurable, Tool::HyLaa) && !smaller(&measurable, Tool::Cora));
}
