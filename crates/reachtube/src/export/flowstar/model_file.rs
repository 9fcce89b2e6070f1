//! The model file: a linear system whose disturbances are time-varying parameters in \[-1, 1\], for
//! which Flow* needs no remainder estimate.

use reachtube_reach::LinearSystem;
use reachtube_scalar::Interval;

use crate::export::InputForm;
use crate::export::case::{ExportCase, bounds};
use crate::export::text::number;

/// Returns the model of A x + B u + d, where u = c + r w with |w| at most 1.
///
/// # Guarantee
///
/// Outer: coefficients and constants that were computed are intervals, rounded outward.
pub(super) fn linear(case: &ExportCase, form: InputForm, system: &LinearSystem) -> String {
    let states = &case.system.states;
    let parameters: Vec<String> = (1..=case.joints()).map(|j| format!("w{j}")).collect();
    let rate = |i: usize| format!("    {}' = {}\n", states[i], rate(case, form, system, i));
    let rates: String = (0..states.len()).map(rate).collect();
    let initial: String = states
        .iter()
        .zip(case.initial_state(form).bounds())
        .map(|(name, side)| format!("    {name} in {}\n", interval(side)))
        .collect();
    format!(
        "continuous reachability\n{{\n  state var {}\n\n{}  lti ode\n  {{\n    \
         time-var {{ {} }}\n    {{\n{rates}    }}\n  }}\n\n  init\n  {{\n{initial}  }}\n}}\n",
        states.join(", "),
        settings(case),
        parameters.join(", "),
    )
}

/// Returns the derivative of state `i`.
fn rate(case: &ExportCase, form: InputForm, system: &LinearSystem, i: usize) -> String {
    let names = case.system.states.iter().enumerate();
    let mut terms: Vec<String> = names
        .filter(|(k, _)| system.a()[(i, *k)] != 0.0)
        .map(|(k, name)| format!("{}*{name}", signed(system.a()[(i, k)])))
        .collect();
    // Deviations have no drift.
    let mut constant = match form {
        InputForm::Deviation => Interval::point(0.0),
        _ => Interval::point(system.drift()[i]),
    };
    let input = case.input_set(form);
    for (j, side) in bounds(&input).into_iter().enumerate() {
        let gain = Interval::point(system.b()[(i, j)]);
        if gain == Interval::point(0.0) {
            continue;
        }
        constant += gain * Interval::point(side.mid());
        let radius = (gain * Interval::point(side.rad())).mag();
        let sign = if gain.hi() < 0.0 { '-' } else { '+' };
        terms.push(format!("{sign} {}*w{}", number(radius), j + 1));
    }
    terms.push(format!("+ {}", interval(constant)));
    let sum = terms.join(" ");
    // The grammar has no plus without a left side.
    sum.strip_prefix("+ ").unwrap_or(&sum).into()
}

fn signed(coefficient: f64) -> String {
    let sign = if coefficient.is_sign_negative() { '-' } else { '+' };
    format!("{sign} {}", number(coefficient.abs()))
}

/// Returns the settings. The grammar requires a remainder estimate, which linear systems ignore.
fn settings(case: &ExportCase) -> String {
    format!(
        "  setting\n  {{\n    fixed steps {}\n    time {}\n    remainder estimation 0.1\n    \
         QR precondition\n    gnuplot interval q1, qd1\n    fixed orders 4\n    cutoff 1e-12\n    \
         precision 53\n    output reachtube\n    print off\n  }}\n\n",
        number(case.step()),
        number(case.horizon()),
    )
}

/// Returns an interval; its spaces keep the signs with their numbers.
fn interval(side: Interval) -> String {
    format!("[{} , {}]", number(side.lo()), number(side.hi()))
}
