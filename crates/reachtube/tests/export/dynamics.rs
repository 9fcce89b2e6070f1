//! Right-hand sides: against the model's own polynomials, and as each tool has them.

use reachtube::abstraction::PolynomialModel;
use reachtube::export::{ExportCase, InputForm, Polynomial, Tool, files};
use reachtube::{ExpansionPoint, ModelKind, Robot};

use crate::cases::{Numbers, about_a_moving_point, in_clean_clones, lwa4p, recorded, text};
use crate::reader::{between, polynomial};

#[test]
fn the_terms_are_those_of_the_model() {
    let robot = Robot::lwa4p();
    for (kind, order) in [(ModelKind::One, 3), (ModelKind::Two, 3)] {
        let model = PolynomialModel::new(&robot, kind, order, &ExpansionPoint::zero(6)).unwrap();
        let (case, records) = (lwa4p((kind, order)), model.records());
        for (rate, terms) in case.system.rates[6..12].iter().zip(&records.acceleration) {
            assert_eq!(rate.terms.len(), terms.len());
            for (term, record) in rate.terms.iter().zip(terms) {
                let mut exponents = vec![0; records.variables.len()];
                term.factors
                    .iter()
                    .for_each(|factor| exponents[factor.variable - 6] = factor.power);
                assert_eq!(
                    (term.coefficient.to_bits(), &exponents),
                    (record.1.to_bits(), &record.0)
                );
            }
        }
    }
}

#[test]
fn the_terms_have_the_values_of_the_model() {
    let mut numbers = Numbers::new();
    for case in in_clean_clones() {
        let n = case.joints();
        let [q, qd, u] = [1.0, 1.0, 20.0].map(|radius| numbers.vector(n, radius));
        let x = case.system.state(&q, &qd);
        let variables = [x.as_slice(), &u].concat();
        let value = |rate: &Polynomial| -> f64 {
            let product = |term: &reachtube::export::Term| {
                let factors = term.factors.iter();
                let powers =
                    factors.map(|f| (variables[f.variable] - f.origin).powi(f.power.into()));
                term.coefficient * powers.product::<f64>()
            };
            rate.terms.iter().map(product).sum()
        };
        let rates = case.system.rate(&x, &u);
        for (rate, expected) in case.system.rates.iter().zip(&rates) {
            assert!((value(rate) - expected).abs() < 1e-11 * expected.abs().max(1.0));
        }
        // Sines and cosines change as the angle's do.
        if case.system.dimension() == 4 * n {
            assert_eq!(rates[2 * n], qd[0] * q[0].cos());
            assert_eq!(rates[3 * n], -qd[0] * q[0].sin());
        }
    }
}

#[test]
fn cora_has_every_bit_of_the_polynomials() {
    in_clean_clones().iter().for_each(cora);
}

#[test]
#[ignore = "needs the recordings in ../shared"]
fn recorded_models_have_every_bit_of_the_polynomials() {
    recorded().iter().for_each(cora);
}

/// Reads `f(3,1) = ...;` and `f(3,1) = f(3,1) + ...;`.
fn cora(case: &ExportCase) {
    let (dimension, inputs) = (case.system.dimension(), case.joints());
    let text = text(case, Tool::Cora, InputForm::Recorded, "cora_dynamics.m");
    assert!(text.lines().all(|line| line.len() < 1000));
    let statements = text.replace(" ...\n", "");
    let mut rates = vec![Polynomial::default(); dimension];
    for line in statements.lines().filter(|line| line.starts_with("f(")) {
        let row: usize = between(line, "f(", ",1)").parse().unwrap();
        let (left, right) = line.strip_suffix(';').unwrap().split_once(" = ").unwrap();
        let sum = match right.strip_prefix(&format!("{left} ")) {
            Some(more) => {
                assert!(!rates[row - 1].terms.is_empty());
                more
            }
            None => {
                assert!(rates[row - 1].terms.is_empty());
                right
            }
        };
        let variable = |name: &str| {
            let index = |letter: &str, count: usize| -> Option<usize> {
                let inner = name.strip_prefix(letter)?.strip_prefix('(')?.strip_suffix(')')?;
                let index: usize = inner.parse().unwrap();
                assert!((1..=count).contains(&index));
                Some(index - 1)
            };
            index("x", dimension).or_else(|| Some(dimension + index("u", inputs)?))
        };
        rates[row - 1].terms.extend(polynomial(sum, &variable).terms);
    }
    assert_eq!(rates, case.system.rates);
}

/// Returns whether a file says what is computed: tables and what only compares do not.
fn has_head(name: &str) -> bool {
    !name.ends_with(".csv") && name != "cora_compare.m"
}

#[test]
fn the_first_lines_say_what_is_computed() {
    let cases = [lwa4p((ModelKind::One, 1)), about_a_moving_point()];
    for (case, tool) in cases
        .iter()
        .flat_map(|case| [Tool::Cora, Tool::SpaceEx, Tool::FlowStar].map(|tool| (case, tool)))
    {
        let form = tool.default_form(case);
        let written = files(case, tool, form).unwrap();
        for file in written.iter().filter(|file| has_head(&file.name)) {
            let head = &file.text[..file.text.len().min(1500)].replace("\n% ", " ");
            let head = head.replace("\n# ", " ").replace("\n// ", " ").replace("\n  ", " ");
            assert!(head.contains("Written by reachtube"), "{}", file.name);
            let who = match (tool, case.system.linear.is_some()) {
                (Tool::SpaceEx, false) => "A program that reads this file".into(),
                _ => tool.to_string(),
            };
            assert!(head.contains(&format!("{who} computes")), "{}", file.name);
            assert!(
                file.text
                    .lines()
                    .take_while(|line| line.starts_with(['%', '#', '/']))
                    .all(|line| line.len() <= 100),
                "{}",
                file.text
            );
        }
    }
}
