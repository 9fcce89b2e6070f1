//! CORA, in MATLAB. The functions without CORA's classes run in GNU Octave too.

use std::fmt::Write;

use reachtube_files::TOOL;

use super::case::ExportCase;
use super::meaning::Meaning;
use super::text::{comment, number, numbers, rows, sum, terms};
use super::{ExportFile, InputForm, Tool, tables};

/// Number of terms that one statement adds: MATLAB nests each addition of a sum.
const TERMS_PER_STATEMENT: usize = 40;

/// Compares bounds, samples x states, with ours; without any class of CORA.
const COMPARE: &str = "\
function [outside, ratio] = cora_compare(lower, upper)
% Compares bounds, one row per sample and one column per state, with bounds.csv: by how many widths
% ours lie outside at most, and how many times as wide these are at most.
ours = dlmread('bounds.csv', ',', 1, 0);
samples = min(size(ours, 1), size(lower, 1));
states = size(lower, 2);
low = ours(1:samples, 2:3:3*states-1);
high = ours(1:samples, 4:3:3*states+1);
width = max(high - low, 1e-12);
lower = lower(1:samples, :);
upper = upper(1:samples, :);
outside = max(0, max(max(max((lower - low)./width, (high - upper)./width))));
ratio = max(max((upper - lower)./width));
end
";

/// Returns the right-hand side, the data, the script that runs CORA, and points to check the
/// right-hand side at.
pub(super) fn files(case: &ExportCase, form: InputForm) -> Vec<ExportFile> {
    let header = comment("%", &Meaning::new(case, Tool::Cora, form).paragraphs);
    vec![
        ExportFile::new("cora_reach.m", script(case, form, &header)),
        ExportFile::new("cora_data.m", data(case, form, &header)),
        ExportFile::new("cora_dynamics.m", dynamics(case, form, &header)),
        ExportFile::new("cora_compare.m", COMPARE.into()),
        tables::check_points(case),
    ]
}

/// Returns the function f = cora_dynamics(x, u), which CORA differentiates symbolically.
fn dynamics(case: &ExportCase, form: InputForm, header: &str) -> String {
    let system = &case.system;
    let mut text = format!(
        "function f = cora_dynamics(x, u)\n% The derivative of the state x under the input u.\n\
         {header}% x = ({})\n% u = ({})\n",
        system.states.join(", "),
        system.inputs.join(", ")
    );
    if form == InputForm::Deviation {
        text += "% This is the equation of the states themselves; deviations have no drift.\n";
    }
    let name = |variable: usize| match variable.checked_sub(system.dimension()) {
        None => format!("x({})", variable + 1),
        Some(input) => format!("u({})", input + 1),
    };
    for (i, rate) in system.rates.iter().enumerate() {
        let (terms, row) = (terms(rate, &name), i + 1);
        if terms.is_empty() {
            // A product, so that a symbolic x makes f symbolic.
            let _ = writeln!(text, "f({row},1) = 0.0*x(1);");
        }
        for (part, chunk) in terms.chunks(TERMS_PER_STATEMENT).enumerate() {
            let before = if part == 0 { String::new() } else { format!("f({row},1) ") };
            let _ = writeln!(text, "f({row},1) = {before}{};", sum(chunk, " ..."));
        }
    }
    text + "end\n"
}

/// Returns the function data = cora_data(), plain numbers.
fn data(case: &ExportCase, form: InputForm, header: &str) -> String {
    let (initial, inputs) = (case.initial_state(form), case.input_set(form));
    let mut text = format!(
        "function data = cora_data()\n% The numbers of the model, without any class of CORA.\n\
         {header}"
    );
    let column = |values: &[f64]| format!("[{}]", numbers(values.iter().copied(), "; "));
    if let Some(system) = &case.system.linear {
        let _ = write!(text, "data.A = [\n{}];\n", rows(system.a(), ["", ", ", ";"]));
        let _ = write!(text, "data.B = [\n{}];\n", rows(system.b(), ["", ", ", ";"]));
        let drift = match form {
            InputForm::Deviation => vec![0.0; system.states()],
            _ => system.drift().iter().copied().collect(),
        };
        let _ = writeln!(text, "data.c = {};", column(&drift));
    }
    let columns = [
        ("x_start", &initial.start),
        ("X0_centre", &initial.set.centre),
        ("X0_radius", &initial.set.radius),
        ("U_centre", &inputs.centre),
        ("U_radius", &inputs.radius),
    ];
    for (name, values) in columns {
        let _ = writeln!(text, "data.{name} = {};", column(values));
    }
    let _ = writeln!(text, "data.step = {};", number(case.step()));
    let _ = writeln!(text, "data.steps = {};", case.steps());
    let _ = writeln!(text, "data.horizon = {};", number(case.horizon()));
    if form == InputForm::Recorded {
        let row = |k: usize| format!("  {};\n", numbers(case.input(k).iter().copied(), ", "));
        let rows: String = (0..case.steps()).map(row).collect();
        let _ = write!(text, "% One column per step, held over it.\ndata.u = [\n{rows}]';\n");
    }
    text + "end\n"
}

fn script(case: &ExportCase, form: InputForm, header: &str) -> String {
    let affine = case.system.linear.is_some();
    let (states, inputs) = (case.system.dimension(), case.joints());
    let system = match affine {
        true => "sys = linearSys('reachtube', data.A, data.B, data.c);".into(),
        false => format!("sys = nonlinearSys('reachtube', @cora_dynamics, {states}, {inputs});"),
    };
    // CORA takes U about the input trajectory with its centre at 0.
    let input = match form {
        InputForm::Recorded => {
            "params.U = zonotope(0*data.U_centre, diag(data.U_radius));\n\
             params.u = data.u + data.U_centre;\n"
        }
        _ => "params.U = zonotope(data.U_centre, diag(data.U_radius));\n",
    };
    let options = match affine {
        true => "options.linAlg = 'wrapping-free';\n",
        false => "options.alg = 'lin';\noptions.tensorOrder = 2;\n",
    };
    // The nominal motion has no width.
    let nominal = match form {
        InputForm::Deviation => {
            "ours = dlmread('bounds.csv', ',', 1, 0);\nnominal = ours(:, 3:3:end);\n\
             samples = min(size(ours, 1), size(lower, 1));\n\
             lower = lower(1:samples, :) + nominal(1:samples, :);\n\
             upper = upper(1:samples, :) + nominal(1:samples, :);\nt = t(1:samples);\n"
        }
        _ => "",
    };
    format!(
        "% Runs CORA (2024 to 2026), writes cora_bounds.csv, and compares it with bounds.csv.\n\
         {header}\
         data = cora_data();\n{system}\n\
         params.tFinal = data.horizon;\n\
         params.R0 = zonotope(data.x_start + data.X0_centre, diag(data.X0_radius));\n\
         {input}\
         options.timeStep = data.step;\noptions.taylorTerms = 4;\noptions.zonotopeOrder = 200;\n\
         {options}R = reach(sys, params, options);\n\n\
         names = {{{}}};\nt = [];\nlower = [];\nupper = [];\n\
         for k = 1:numel(R(1).timePoint.set)\n  \
         box = interval(project(R(1).timePoint.set{{k}}, 1:{}));\n  \
         t(k, 1) = R(1).timePoint.time{{k}};\n  \
         lower(k, :) = infimum(box)';\n  upper(k, :) = supremum(box)';\nend\n{nominal}\
         file = fopen('cora_bounds.csv', 'w');\nfprintf(file, 't');\n\
         head = [strcat(names, '_lower'), strcat(names, '_upper')];\n\
         fprintf(file, ',%s', head{{:}});\n\
         fprintf(file, '\\n');\nfclose(file);\n\
         dlmwrite('cora_bounds.csv', [t, lower, upper], '-append', 'precision', 17);\n\
         [outside, ratio] = cora_compare(lower, upper);\n\
         fprintf(['{TOOL}: wrote cora_bounds.csv, %d samples; bounds.csv is at most %.3g ' ...\n  \
         'widths outside, and the sets are at most %.4g times as wide\\n'], ...\n  \
         numel(t), outside, ratio);\n",
        case.system.states[..2 * inputs]
            .iter()
            .map(|name| format!("'{name}'"))
            .collect::<Vec<_>>()
            .join(", "),
        2 * inputs,
    )
}
