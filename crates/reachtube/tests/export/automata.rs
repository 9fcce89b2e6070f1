//! Flow*'s model file and program, and SpaceEx's and XSpeed's XML and configuration.

use reachtube::export::{ExportCase, InputForm, Polynomial, Tool, bounds};
use reachtube::reach::LinearSystem;
use reachtube::scalar::Interval;

use crate::cases::{in_clean_clones, recorded, text, uneven};
use crate::reader::{assert_bits, between, number, numbers_between, polynomial};

const FORMS: [InputForm; 3] = [InputForm::Recorded, InputForm::Deviation, InputForm::Range];

#[test]
fn automata_have_every_bit() {
    in_clean_clones().iter().for_each(read_back);
    read_back(&uneven());
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn recorded_automata_have_every_bit() {
    recorded().iter().for_each(read_back);
}

fn read_back(case: &ExportCase) {
    for form in FORMS {
        if Tool::FlowStar.check(case, form).is_ok() {
            flowstar(case, form);
        }
        for (tool, name) in [(Tool::SpaceEx, "spaceex"), (Tool::XSpeed, "xspeed")] {
            if tool.check(case, form).is_ok() {
                spaceex(case, tool, form, name);
            }
        }
    }
}

/// Returns the right-hand sides that a form has, of the states and of what counts the samples.
fn expected(case: &ExportCase, form: InputForm) -> Vec<Polynomial> {
    let without = |rate: &Polynomial| Polynomial {
        terms: rate.terms.iter().filter(|term| !term.factors.is_empty()).cloned().collect(),
    };
    match form {
        InputForm::Deviation => case.system.rates.iter().map(without).collect(),
        _ => case.system.rates.clone(),
    }
}

/// Returns the names of states and, where the input is recorded, of the held input and the clocks.
fn names(case: &ExportCase, form: InputForm) -> Vec<String> {
    let mut names = case.system.states.clone();
    if form == InputForm::Recorded {
        names.extend((1..=case.joints()).map(|j| format!("u{j}")));
        names.extend(["left".into(), "t".into()]);
    }
    names
}

/// Returns the values of the held input and of `left`, after each jump and at the start.
fn jumps(case: &ExportCase) -> Vec<Vec<f64>> {
    let times = case.grid.times();
    let span = |k: usize| case.grid.step().unwrap_or(times[k + 1] - times[k]);
    (0..case.steps()).map(|k| [case.input(k), &[span(k)]].concat()).collect()
}

/// Asserts that each guard is met at its own sample, and at no other.
fn assert_windows(windows: &[[f64; 2]], case: &ExportCase) {
    let times = case.grid.times();
    assert_eq!(windows.len(), case.steps() - 1);
    for (k, [from, to]) in windows.iter().enumerate() {
        assert!(
            times[k] < *from && *from < times[k + 1] && times[k + 1] < *to && *to < times[k + 2]
        );
    }
}

fn assert_sides(read: &[f64], sides: &[Interval]) {
    let written: Vec<f64> = sides.iter().flat_map(|side| [side.lo(), side.hi()]).collect();
    assert_bits(read, &written, "sides");
}

fn flowstar(case: &ExportCase, form: InputForm) {
    match &case.system.linear {
        Some(system) if form != InputForm::Recorded => flowstar_model(case, form, system),
        _ => flowstar_program(case, form),
    }
}

/// Reads the linear model: A to the bit, and disturbances and constants that enclose ours.
fn flowstar_model(case: &ExportCase, form: InputForm, system: &LinearSystem) {
    let text = text(case, Tool::FlowStar, form, "flowstar.model");
    let states = &case.system.states;
    assert_eq!(between(&text, "state var ", "\n"), states.join(", "));
    let parameters: Vec<String> = (1..=case.joints()).map(|j| format!("w{j}")).collect();
    assert_eq!(between(&text, "time-var { ", " }"), parameters.join(", "));
    let equations = between(&text, " }\n    {\n", "    }\n");
    assert_eq!(equations.lines().count(), states.len());
    let sides = bounds(&case.input_set(form));
    for (i, line) in equations.lines().enumerate() {
        let right = line.trim().strip_prefix(&format!("{}' = ", states[i])).expect(line);
        // The lexer takes a plus without a left side for an error.
        assert!(!right.starts_with('+'));
        let (sum, constant) = right.rsplit_once('[').unwrap();
        let constant = numbers_between(&format!("[{constant}"), "[", "]");
        let name = |name: &str| {
            let own = states.iter().chain(&parameters).position(|own| own == name);
            own.filter(|_| !name.is_empty())
        };
        let read = polynomial(sum.trim_end().trim_end_matches('+'), &name);
        let mut row = vec![0.0; states.len() + case.joints()];
        for term in &read.terms {
            row[term.factors[0].variable] = term.coefficient;
        }
        let a: Vec<f64> = system.a().row(i).iter().copied().collect();
        // A zero has no term.
        assert!(row.iter().zip(&a).all(|(read, a)| read == a), "{line}");
        let mut middle = if form == InputForm::Deviation { 0.0 } else { system.drift()[i] };
        for (j, side) in sides.iter().enumerate() {
            let exact = system.b()[(i, j)] * side.rad();
            let read = row[states.len() + j];
            let size = exact.abs().max(f64::MIN_POSITIVE);
            assert!(
                read.abs() >= exact.abs() && read.abs() - exact.abs() <= 1e-14 * size,
                "{line}"
            );
            assert!(read == 0.0 || read.is_sign_negative() == exact.is_sign_negative());
            middle += system.b()[(i, j)] * side.mid();
        }
        let slack = 1e-13 * (1.0 + middle.abs());
        assert!(constant[0] <= middle + slack && middle - slack <= constant[1], "{line}");
        assert!(constant[1] - constant[0] <= 1e-12 * (1.0 + middle.abs()), "{line}");
    }
    let read: Vec<f64> = between(&text, "  init\n  {\n", "\n  }\n")
        .lines()
        .flat_map(|line| numbers_between(line, "[", "]"))
        .collect();
    assert_sides(&read, &case.initial_state(form).bounds());
    assert_eq!(number(between(&text, "    time ", "\n")), case.horizon());
    assert_eq!(number(between(&text, "fixed steps ", "\n")), case.step());
}

/// Reads the program: its polynomials, sets, times and inputs to the bit.
fn flowstar_program(case: &ExportCase, form: InputForm) {
    let text = text(case, Tool::FlowStar, form, "flowstar.cpp");
    let states = &case.system.states;
    let rates = between(&text, "  return {\n", "  };\n");
    let variable = |name: &str| {
        let input = name.strip_prefix("u[").and_then(|rest| rest.strip_suffix(']'));
        let input = input.map(|j| states.len() + j.parse::<usize>().unwrap());
        input.or_else(|| states.iter().position(|state| state == name))
    };
    let read: Vec<Polynomial> = rates
        .split(",\n")
        .filter(|sum| !sum.trim().is_empty())
        .map(|sum| {
            let sum = sum.replace("\" + u[", "u[").replace("] + \"", "]").replace(['"', '\n'], "");
            assert!(!sum.trim_start().starts_with('+'));
            polynomial(&sum, &variable)
        })
        .collect();
    assert_eq!(read, case.system.rates);
    let table = |name: &str| numbers_of(between(&text, &format!("const double {name}"), "};"));
    let of = |sides: &[Interval]| -> Vec<f64> {
        sides.iter().flat_map(|side| [side.lo(), side.hi()]).collect()
    };
    assert_bits(&table("X0[][2] ="), &of(&case.initial_state(form).bounds()), "X0");
    assert_bits(&table("U[][2] ="), &of(&bounds(&case.input_set(form))), "U");
    assert_bits(&table("TIMES[] ="), case.grid.times(), "times");
    let inputs = match form {
        InputForm::Recorded => case.inputs[..case.steps() * case.joints()].to_vec(),
        _ => vec![0.0; case.joints()],
    };
    assert_bits(&table("INPUTS[][JOINTS] ="), &inputs, "inputs");
}

/// Reads the numbers of a braced list.
fn numbers_of(text: &str) -> Vec<f64> {
    let words = text.split(|c: char| c.is_whitespace() || "{},".contains(c));
    words.filter(|word| !word.is_empty()).map(number).collect()
}

fn spaceex(case: &ExportCase, tool: Tool, form: InputForm, name: &str) {
    let xml = text(case, tool, form, &format!("{name}.xml"));
    let document = roxmltree::Document::parse(&xml).unwrap();
    let of = |tag: &'static str| document.descendants().filter(move |node| node.has_tag_name(tag));
    let content = |tag| of(tag).next().unwrap().text().unwrap().replace('\n', " ");
    let params = |controlled: &str| -> Vec<String> {
        let kept = of("param").filter(|node| node.attribute("controlled") == Some(controlled));
        kept.map(|node| node.attribute("name").unwrap().to_string()).collect()
    };
    let (names, dimension) = (names(case, form), case.system.dimension());
    // XSpeed takes a variable for an input if its name begins with u.
    let prefix = if tool == Tool::XSpeed { "u" } else { "du" };
    let disturbances: Vec<String> = (1..=case.joints()).map(|j| format!("{prefix}{j}")).collect();
    assert_eq!((params("true"), params("false")), (names.clone(), disturbances.clone()));
    let variable = |name: &str| {
        let input = disturbances.iter().enumerate().position(|(j, du)| match form {
            InputForm::Recorded => name == format!("(u{} + {du})", j + 1),
            _ => name == du,
        });
        let state = || case.system.states.iter().position(|state| state == name);
        input.map(|j| dimension + j).or_else(state)
    };
    let flow = content("flow");
    let rates: Vec<Polynomial> = flow
        .split(" & ")
        .zip(&names)
        .take(dimension)
        .map(|(equation, name)| {
            let right = equation.trim().strip_prefix(&format!("{name}' == ")).expect(equation);
            polynomial(right, &variable)
        })
        .collect();
    assert_eq!(rates, expected(case, form));
    assert_eq!(flow.split(" & ").count(), names.len());
    let sides: Vec<f64> =
        content("invariant").split(" & ").filter(|part| part.contains('u')).map(bound).collect();
    assert_sides(&sides, &bounds(&case.input_set(form)));
    let start = spaceex_start(case, form, &text(case, tool, form, &format!("{name}.cfg")));
    if form == InputForm::Recorded {
        let parts = |node: roxmltree::Node| -> Vec<String> {
            node.text().unwrap().split(" & ").map(String::from).collect()
        };
        let values = |node| parts(node).iter().map(|part| bound(part)).collect::<Vec<f64>>();
        let assigned: Vec<Vec<f64>> = of("assignment").map(values).collect();
        assert_eq!([&[start], &assigned[..]].concat(), jumps(case));
        let window = |node| -> [f64; 2] { values(node)[1..].try_into().unwrap() };
        assert_windows(&of("guard").map(window).collect::<Vec<_>>(), case);
    }
}

/// Checks the initial states and returns the initial values of the held input and of `left`.
fn spaceex_start(case: &ExportCase, form: InputForm, configuration: &str) -> Vec<f64> {
    let initially = between(configuration, "initially = \"", "\"");
    let of = |name: &String| -> Vec<f64> {
        let parts = initially.split(" & ").filter(|part| part.starts_with(&format!("{name} ")));
        parts.map(bound).collect()
    };
    let sides = |name| match of(name)[..] {
        [single] => vec![single; 2],
        ref both => both.to_vec(),
    };
    let initial: Vec<f64> = case.system.states.iter().flat_map(sides).collect();
    assert_sides(&initial, &case.initial_state(form).bounds());
    let held = names(case, form).split_off(case.system.dimension());
    held.iter().filter(|name| *name != "t").flat_map(of).collect()
}

/// Reads the number of `du1 >= -0.5`.
fn bound(text: &str) -> f64 {
    number(text.trim().rsplit(' ').next().unwrap())
}
