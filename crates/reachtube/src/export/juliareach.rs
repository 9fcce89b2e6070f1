//! ReachabilityAnalysis.jl, in Julia.

use std::fmt::Write;

use super::case::ExportCase;
use super::meaning::Meaning;
use super::system::Polynomial;
use super::text::{comment, number, numbers, rows, sum, terms};
use super::{ExportFile, InputForm, Tool};

/// Number of terms of one sum: TMJets nests them.
const TERMS_PER_SUM: usize = 20;

/// Returns the script.
pub(super) fn files(case: &ExportCase, form: InputForm) -> Vec<ExportFile> {
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
    text += &match case.system.linear.is_some() {
        true => affine(case, form),
        false => polynomial(case),
    };
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
fn affine(case: &ExportCase, form: InputForm) -> String {
    let Some(system) = &case.system.linear else { return String::new() };
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

/// Returns a polynomial problem, whose inputs are states that stay constant, and its solution by
/// Taylor models.
fn polynomial(case: &ExportCase) -> String {
    let (dimension, inputs) = (case.system.dimension(), case.joints());
    let mut text = format!(
        "states = {}\n# x = ({}, {})\n@taylorize function dynamics!(dx, x, p, t)\n",
        dimension + inputs,
        case.system.states.join(", "),
        case.system.inputs.join(", ")
    );
    for (i, rate) in case.system.rates.iter().enumerate() {
        text += &equation(i + 1, rate);
    }
    for i in dimension..dimension + inputs {
        let _ = writeln!(text, "    dx[{}] = zero(x[{}])", i + 1, i + 1);
    }
    text += "    return dx\nend\n\
             X0 = Hyperrectangle([x_start + X0_centre; U_centre], [X0_radius; U_radius])\n\
             problem = @ivp(x' = dynamics!(x), dim: states, x(0) ∈ X0)\n\
             sol = solve(problem; T=horizon, alg=TMJets(abstol=1e-12, orderT=6, orderQ=2, \
             maxsteps=100_000))\nsol = overapproximate(sol, Zonotope)\n";
    text
}

/// Returns the equation of state `row`, in partial sums.
fn equation(row: usize, rate: &Polynomial) -> String {
    let terms = terms(rate, &|variable| format!("x[{}]", variable + 1));
    if terms.is_empty() {
        return format!("    dx[{row}] = zero(x[{row}])\n");
    }
    let mut text = String::new();
    let mut names = Vec::new();
    for (part, chunk) in terms.chunks(TERMS_PER_SUM).enumerate() {
        let name = format!("s{row}_{}", part + 1);
        let chunk = sum(chunk, " ");
        // A line that starts with a sign would be a statement of its own.
        let _ = writeln!(text, "    {name} = ({})", chunk.strip_prefix("+ ").unwrap_or(&chunk));
        names.push(name);
    }
    let _ = writeln!(text, "    dx[{row}] = {}", names.join(" + "));
    text
}
