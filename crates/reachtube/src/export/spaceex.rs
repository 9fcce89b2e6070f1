//! SpaceEx, and XSpeed, which reads its files: a model in XML and a configuration.

use std::fmt::Write;

use super::case::{ExportCase, bounds};
use super::meaning::Meaning;
use super::text::{comment, number, terms};
use super::{ExportFile, InputForm, Tool};

pub(super) fn files(case: &ExportCase, tool: Tool, form: InputForm) -> Vec<ExportFile> {
    let lines = Meaning::new(case, tool, form).paragraphs;
    let name = if tool == Tool::XSpeed { "xspeed" } else { "spaceex" };
    vec![
        ExportFile::new(&format!("{name}.xml"), model(case, tool, form, &lines)),
        ExportFile::new(&format!("{name}.cfg"), configuration(case, tool, form, &lines)),
    ]
}

/// Returns the automaton: one location, in which U is the invariant of inputs that nothing
/// controls. A recorded input is a variable that jumps at each sample.
fn model(case: &ExportCase, tool: Tool, form: InputForm, lines: &[String]) -> String {
    let recorded = form == InputForm::Recorded;
    let param = |name: &str, controlled: bool| {
        format!(
            "    <param name=\"{name}\" type=\"real\" local=\"false\" d1=\"1\" d2=\"1\" \
             dynamics=\"any\" controlled=\"{controlled}\" />\n"
        )
    };
    let mut params: String = case.system.states.iter().map(|name| param(name, true)).collect();
    if recorded {
        let held = jump(case, 0).into_iter().map(|(name, _)| name).chain(["t".into()]);
        held.for_each(|name| params += &param(&name, true));
    }
    (0..case.joints()).for_each(|j| params += &param(&disturbance(tool, j), false));
    let transitions: String = match recorded {
        true => (1..case.steps()).map(|k| transition(case, k)).collect(),
        false => String::new(),
    };
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!--\n{}-->\n\
         <sspaceex xmlns=\"http://www-verimag.imag.fr/xml-namespaces/sspaceex\" version=\"0.2\" \
         math=\"SpaceEx\">\n  <component id=\"model\">\n{params}    \
         <location id=\"1\" name=\"motion\" x=\"200\" y=\"200\" width=\"300\" \
         height=\"200\">\n      \
         <invariant>{}</invariant>\n      <flow>{}</flow>\n    </location>\n{transitions}  \
         </component>\n</sspaceex>\n",
        // Two hyphens would end the comment.
        comment(" ", lines).replace("--", "- -"),
        escaped(&invariant(case, tool, form)),
        escaped(&flow(case, tool, form)),
    )
}

/// Returns the command of XSpeed, which reads neither times nor variables from its files.
fn command(case: &ExportCase) -> String {
    format!(
        "#\n# XSpeed reads its times and variables from the command line only:\n\
         # xspeed -m xspeed.xml -c xspeed.cfg --time-horizon {} --time-step {} -v q1,qd1 \
         -o q1.txt\n\
         # Model-Translator.jar of XSpeed must be in this folder, and java installed.\n",
        number(case.horizon()),
        number(case.step()),
    )
}

/// Returns the name of a disturbance. XSpeed takes a variable for an input if its name begins with
/// u; SpaceEx has the held input under that name.
fn disturbance(tool: Tool, j: usize) -> String {
    match tool {
        Tool::XSpeed => format!("u{}", j + 1),
        _ => format!("du{}", j + 1),
    }
}

fn invariant(case: &ExportCase, tool: Tool, form: InputForm) -> String {
    let sides = bounds(&case.input_set(form)).into_iter().enumerate();
    let mut parts: Vec<String> = sides
        .map(|(j, side)| {
            let name = disturbance(tool, j);
            format!("{name} >= {} & {name} <= {}", number(side.lo()), number(side.hi()))
        })
        .collect();
    if form == InputForm::Recorded {
        parts.push("left >= 0.0".into());
    }
    parts.join(" &\n        ")
}

fn flow(case: &ExportCase, tool: Tool, form: InputForm) -> String {
    let (system, recorded) = (&case.system, form == InputForm::Recorded);
    let name = |variable: usize| match variable.checked_sub(system.dimension()) {
        None => system.states[variable].clone(),
        Some(j) if recorded => format!("(u{} + {})", j + 1, disturbance(tool, j)),
        Some(j) => disturbance(tool, j),
    };
    let mut parts: Vec<String> = Vec::new();
    for (state, rate) in system.states.iter().zip(&system.rates) {
        let rate = match form {
            InputForm::Deviation => rate.without_constant(),
            _ => rate.clone(),
        };
        let terms = terms(&rate, &name);
        // A sum that starts with a sign is read by every parser after a zero.
        parts.push(format!("{state}' == 0.0 {}", terms.join(" ")).trim_end().into());
    }
    if recorded {
        parts.extend((1..=case.joints()).map(|j| format!("u{j}' == 0.0")));
        parts.extend(["left' == -1.0".into(), "t' == 1.0".into()]);
    }
    parts.join(" &\n        ")
}

/// Returns the values that the states take at sample `k`: the held input, and its duration.
fn jump(case: &ExportCase, k: usize) -> Vec<(String, f64)> {
    let held = case.input(k).iter().enumerate().map(|(j, u)| (format!("u{}", j + 1), *u));
    let span = match case.grid.step() {
        Some(step) => step,
        None => case.grid.times()[k + 1] - case.grid.times()[k],
    };
    held.chain([("left".into(), span)]).collect()
}

/// Returns the middles of the spans before and after sample `k`, s, between which its jump is.
fn window(case: &ExportCase, k: usize) -> [f64; 2] {
    let times = case.grid.times();
    [k - 1, k].map(|from| 0.5 * (times[from] + times[from + 1]))
}

fn transition(case: &ExportCase, k: usize) -> String {
    let [from, to] = window(case, k).map(number);
    let assignment: Vec<String> = jump(case, k)
        .into_iter()
        .map(|(name, value)| format!("{name} := {}", number(value)))
        .collect();
    format!(
        "    <transition source=\"1\" target=\"1\">\n      <guard>{}</guard>\n      \
         <assignment>{}</assignment>\n    </transition>\n",
        escaped(&format!("left <= 0.0 & t >= {from} & t <= {to}")),
        escaped(&assignment.join(" & ")),
    )
}

fn configuration(case: &ExportCase, tool: Tool, form: InputForm, lines: &[String]) -> String {
    let mut initially: Vec<String> = Vec::new();
    for (name, side) in case.system.states.iter().zip(case.initial_state(form).bounds()) {
        initially.push(match side.lo() == side.hi() {
            true => format!("{name} == {}", number(side.lo())),
            false => format!("{name} >= {} & {name} <= {}", number(side.lo()), number(side.hi())),
        });
    }
    if form == InputForm::Recorded {
        let values = jump(case, 0).into_iter().chain([("t".into(), 0.0)]);
        initially.extend(values.map(|(name, value)| format!("{name} == {}", number(value))));
    }
    if tool == Tool::XSpeed {
        initially.push("loc()==motion".into());
    }
    let jumps = match form {
        InputForm::Recorded => case.steps() as i64 - 1,
        _ => 0,
    };
    let mut text = comment("#", lines);
    if tool == Tool::XSpeed {
        text += &command(case);
    }
    let _ = write!(
        text,
        "system = \"model\"\ninitially = \"{}\"\nforbidden = \"\"\nscenario = \"supp\"\n\
         directions = \"box\"\nset-aggregation = \"none\"\nsampling-time = {}\ntime-horizon = {}\n\
         iter-max = {jumps}\noutput-variables = \"{}\"\noutput-format = \"INTV\"\n\
         rel-err = 1.0e-12\n\
         abs-err = 1.0e-13\nflowpipe-tolerance = 0.001\n",
        initially.join(" & "),
        number(case.step()),
        number(case.horizon()),
        case.system.states[..2 * case.joints()].join(","),
    );
    text
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
