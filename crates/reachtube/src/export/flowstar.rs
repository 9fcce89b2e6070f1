//! Flow* 2.1: a model file.

use std::fmt::Write;

use reachtube_scalar::Interval;

use super::case::{ExportCase, bounds};
use super::meaning::Meaning;
use super::text::{comment, number, sum, terms};
use super::{ExportFile, InputForm, Tool};

/// Returns the model file.
pub(super) fn files(case: &ExportCase, form: InputForm) -> Vec<ExportFile> {
    let header = comment("#", &Meaning::new(case, Tool::FlowStar, form).paragraphs);
    let model = match form {
        InputForm::Recorded => hybrid(case),
        InputForm::Deviation | InputForm::Range => continuous(case, form),
    };
    vec![ExportFile::new("flowstar.model", header + &model)]
}

/// Returns a system without jumps.
fn continuous(case: &ExportCase, form: InputForm) -> String {
    let states = &case.system.states;
    let inputs: Vec<String> = bounds(&case.input_set(form)).into_iter().map(interval).collect();
    let initial: String = states
        .iter()
        .zip(case.initial_state(form).bounds())
        .map(|(name, side)| format!("    {name} in {}\n", interval(side)))
        .collect();
    format!(
        "continuous reachability\n{{\n  state var {}\n\n{}    print on\n  }}\n\n  poly ode 1\n  \
         {{\n{}  }}\n\n  init\n  {{\n{initial}  }}\n}}\n",
        states.join(", "),
        settings(case, "q1", "qd1"),
        equations(case, form, &|j| inputs[j].clone()),
    )
}

/// Returns a system whose input is a state that jumps at each sample: `left` is the time for which
/// the input is still held, and `t` tells the jumps apart.
fn hybrid(case: &ExportCase) -> String {
    let names = &case.system.states;
    let disturbance: Vec<String> = bounds(&case.sets.input_set).into_iter().map(interval).collect();
    let held: Vec<String> = (1..=case.joints()).map(|j| format!("u{j}")).collect();
    let mut states = names.clone();
    states.extend(held.iter().cloned().chain(["left".into(), "t".into()]));
    let mut flow =
        equations(case, InputForm::Recorded, &|j| format!("(u{} + {})", j + 1, disturbance[j]));
    held.iter().for_each(|name| {
        let _ = writeln!(flow, "    {name}' = 0.0");
    });
    flow += "    left' = - 1.0\n    t' = 1.0\n";
    let mut initial: String = names
        .iter()
        .zip(case.initial_state(InputForm::Recorded).bounds())
        .map(|(name, side)| format!("    {name} in {}\n", interval(side)))
        .collect();
    for (name, value) in jump(case, 0).into_iter().chain([("t".into(), 0.0)]) {
        let _ = writeln!(initial, "    {name} in {}", interval(Interval::point(value)));
    }
    let jumps: String = (1..case.steps()).map(|k| transition(case, k)).collect();
    format!(
        "hybrid reachability\n{{\n  state var {}\n\n{}    max jumps {}\n    print on\n  }}\n\n  \
         modes\n  {{\n  motion\n  {{\n  poly ode 1\n  {{\n{flow}  }}\n  inv\n  {{\n    \
         left >= 0.0\n  }}\n  }}\n  }}\n\n  jumps\n  {{\n{jumps}  }}\n\n  init\n  {{\n  \
         motion\n  {{\n{initial}  }}\n  }}\n}}\n",
        states.join(", "),
        settings(case, "q1", "qd1"),
        case.steps() - 1,
    )
}

/// Returns the values that the states take at sample `k`: the held input, and its duration.
pub(super) fn jump(case: &ExportCase, k: usize) -> Vec<(String, f64)> {
    let held = case.input(k).iter().enumerate().map(|(j, u)| (format!("u{}", j + 1), *u));
    let span = match case.grid.step() {
        Some(step) => step,
        None => case.grid.times()[k + 1] - case.grid.times()[k],
    };
    held.chain([("left".into(), span)]).collect()
}

/// Returns the middles of the spans before and after sample `k`, s, between which its jump is.
pub(super) fn window(case: &ExportCase, k: usize) -> [f64; 2] {
    let times = case.grid.times();
    [k - 1, k].map(|from| 0.5 * (times[from] + times[from + 1]))
}

fn transition(case: &ExportCase, k: usize) -> String {
    let [from, to] = window(case, k).map(number);
    let reset: String = jump(case, k)
        .into_iter()
        .map(|(name, value)| format!(" {name}' := {}", number(value)))
        .collect();
    format!(
        "  motion -> motion\n  guard {{ left = 0.0 t in [{from} , {to}] }}\n  \
         reset {{{reset} }}\n  interval aggregation\n"
    )
}

/// Returns the equations of the states; `input` is the text of an input.
fn equations(case: &ExportCase, form: InputForm, input: &dyn Fn(usize) -> String) -> String {
    let system = &case.system;
    let name = |variable: usize| match variable.checked_sub(system.dimension()) {
        None => system.states[variable].clone(),
        Some(j) => input(j),
    };
    let rates = system.states.iter().zip(&system.rates);
    rates
        .map(|(state, rate)| {
            // Deviations have no drift.
            let terms = match form {
                InputForm::Deviation => terms(&rate.without_constant(), &name),
                _ => terms(rate, &name),
            };
            let sum = sum(&terms, "");
            // The grammar has no plus without a left side.
            format!("    {state}' = {}\n", sum.strip_prefix("+ ").unwrap_or(&sum))
        })
        .collect()
}

fn settings(case: &ExportCase, x: &str, y: &str) -> String {
    format!(
        "  setting\n  {{\n    fixed steps {}\n    time {}\n    remainder estimation 1e-3\n    \
         QR precondition\n    gnuplot interval {x}, {y}\n    fixed orders 3\n    cutoff 1e-12\n    \
         precision 53\n    output reachtube\n",
        number(case.step()),
        number(case.horizon()),
    )
}

/// Returns an interval; its spaces keep the signs with their numbers.
fn interval(side: Interval) -> String {
    format!("[{} , {}]", number(side.lo()), number(side.hi()))
}
