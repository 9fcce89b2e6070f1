//! Flow*'s model file, and SpaceEx's and XSpeed's XML and configuration.

use reachtube::export::{ExportCase, InputForm, Polynomial, Tool, bounds};
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
    let text = text(case, Tool::FlowStar, form, "flowstar.model");
    let names = names(case, form);
    assert_eq!(between(&text, "state var ", "\n"), names.join(", "));
    let sides = bounds(&case.input_set(form));
    let disturbance = |text: &str| {
        let read = numbers_between(text, "[", "]");
        sides.iter().position(|side| [side.lo(), side.hi()] == read[..])
    };
    let held = |name: &str| -> Option<usize> {
        let (held, set) = name.strip_prefix("(u")?.strip_suffix(')')?.split_once(" + ")?;
        let j = disturbance(set)?;
        assert_eq!(held, (j + 1).to_string());
        Some(j)
    };
    let variable = |name: &str| -> Option<usize> {
        let input = match form {
            InputForm::Recorded => held(name),
            _ if name.starts_with('[') => disturbance(name),
            _ => None,
        };
        let state = || case.system.states.iter().position(|state| state == name);
        input.map(|j| case.system.dimension() + j).or_else(state)
    };
    let equations = between(&text, "poly ode 1\n  {\n", "\n  }").replace("\n        ", " ");
    let mut rates = Vec::new();
    for (line, name) in joined(&equations).iter().zip(&names) {
        let right = line.strip_prefix(&format!("{name}' = ")).expect(line);
        // The lexer takes a plus without a left side for an error.
        assert!(!right.starts_with('+'));
        rates.push(polynomial(right, &|name| variable(name)));
    }
    let dimension = case.system.dimension();
    assert_eq!(rates[..dimension], expected(case, form)[..]);
    let initial = between(&text, "  init\n  {\n", "\n  }\n");
    let read: Vec<f64> = initial
        .lines()
        .filter(|line| line.contains(" in "))
        .flat_map(|line| numbers_between(line, "[", "]"))
        .collect();
    assert_sides(&read[..2 * dimension], &case.initial_state(form).bounds());
    assert_eq!(number(between(&text, "    time ", "\n")), case.horizon());
    if form == InputForm::Recorded {
        let start: Vec<f64> = read[2 * dimension..].iter().copied().step_by(2).collect();
        let resets: Vec<Vec<f64>> = text.split("reset {").skip(1).map(reset).collect();
        assert_eq!([&[start[..start.len() - 1].to_vec()], &resets[..]].concat(), jumps(case));
        let windows: Vec<[f64; 2]> = text
            .split("guard { left = 0.0 t in ")
            .skip(1)
            .map(|text| numbers_between(text, "[", "]").try_into().unwrap())
            .collect();
        assert_windows(&windows, case);
    }
}

/// Reads the values of `u1' := 0.5 u2' := -1.5 }`.
fn reset(text: &str) -> Vec<f64> {
    let text = &text[..text.find('}').unwrap()];
    text.split(":=").skip(1).map(|part| number(part.split_whitespace().next().unwrap())).collect()
}

/// Joins the lines that continue a sum.
fn joined(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        match line.contains("' = ") {
            true => lines.push(line.trim().into()),
            false => *lines.last_mut().unwrap() += &format!(" {}", line.trim()),
        }
    }
    lines
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
    let disturbances: Vec<String> = (1..=case.joints()).map(|j| format!("du{j}")).collect();
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
        content("invariant").split(" & ").filter(|part| part.contains("du")).map(bound).collect();
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
