//! ReachabilityAnalysis.jl, in Julia.

use std::fmt::Write;

use reachtube_reach::LinearSystem;

use super::case::ExportCase;
use super::meaning::Meaning;
use super::text::{comment, number, numbers, rows};
use super::{ExportFile, InputForm, Tool};

pub(super) fn files(case: &ExportCase, form: InputForm) -> Vec<ExportFile> {
    let Some(system) = &case.system.linear else { return Vec::new() };
    let mut text = comment("#", &Meaning::new(case, Tool::JuliaReach, form).paragraphs);
    text += "# Run: julia juliareach.jl, with ReachabilityAnalysis.jl installed.\n\
             using ReachabilityAnalysis\n\n";
    let (initial, inputs) = (case.initial_state(form), case.input_set(form));
    let vectors = [
        ("x_start", &initial.start),
        ("X0_centre", &initial.set.centre),
        ("X0_radius", &initial.set.radius),
        ("U_centre", &inputs.centre),
        ("U_radius", &inputs.radius),
    ];
    for (name, values) in vectors {
        let _ = writeln!(text, "{name} = [{}]", numbers(values.iter().copied(), ", "));
    }
    let _ = writeln!(text, "step = {}", number(case.step()));
    let _ = writeln!(text, "horizon = {}", number(case.horizon()));
    text += &affine(system, form);
    let names: Vec<String> =
        case.system.states[..2 * case.joints()].iter().map(|name| format!("\"{name}\"")).collect();
    let _ = write!(
        text,
        "\n# The bounds of each set, over the times of its row; bounds of a deviation count from\n\
         # the nominal motion.\nnames = [{}]\nunit(i) = [j == i ? 1.0 : 0.0 for j in 1:states]\n\
         open(\"juliareach_bounds.csv\", \"w\") do io\n    \
         println(io, join([\"t_from\"; \"t_to\"; [n * e for n in names for e in (\"_lower\", \
         \"_upper\")]], \",\"))\n    for R in sol\n        \
         row = [tstart(R), tend(R)]\n        for i in eachindex(names)\n            \
         push!(row, -ρ(-unit(i), R), ρ(unit(i), R))\n        end\n        \
         println(io, join(row, \",\"))\n    end\nend\n",
        names.join(", ")
    );
    vec![ExportFile::new("juliareach.jl", text)]
}

/// Returns an affine problem and its solution by support functions.
fn affine(system: &LinearSystem, form: InputForm) -> String {
    let drift: Vec<f64> = match form {
        InputForm::Deviation => vec![0.0; system.states()],
        _ => system.drift().iter().copied().collect(),
    };
    format!(
        "A = [\n{}]\nB = [\n{}]\nc = [{}]\nstates = {}\n\
         X0 = Hyperrectangle(x_start + X0_centre, X0_radius)\n\
         U = Hyperrectangle(U_centre, U_radius)\n\
         system = ConstrainedAffineControlContinuousSystem(A, B, c, Universe(states), U)\n\
         problem = InitialValueProblem(system, X0)\n\
         sol = solve(problem; T=horizon, alg=LGG09(; δ=step, template=BoxDirections(states)))\n",
        rows(system.a(), ["", " ", ";"]),
        rows(system.b(), ["", " ", ";"]),
        numbers(drift, ", "),
        system.states(),
    )
}
