//! Findings about a fit of the nominal model.

use reachtube_scalar::number::{counted, four_decimals};

use crate::fit::record::{FitRecord, FittedParameter, MOST_ERRORS};
use crate::next_motion::any_run::AnyRun;
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

/// A parameter beyond this factor, or below 1 over it, no longer is what its name says.
const MOST_FACTOR: f64 = 1.5;

/// The gain of the fit, or the reason for its rejection.
pub(crate) fn fitted(record: &FitRecord, is_linear: bool) -> Finding {
    if !record.taken {
        return not_taken(record);
    }
    let FitRecord { pull, identified_cost, cost, .. } = record;
    let text = format!(
        "The nominal model was fitted for small sets: cost{} {} before, {} after ({:+.1} %), \
         a local optimum for a pull of {pull} toward the identified values.",
        if is_linear { "" } else { " of the linear model" },
        four_decimals(*identified_cost),
        four_decimals(*cost),
        100.0 * (cost / identified_cost - 1.0),
    );
    Finding::new(Severity::Info, Code::Fitted, text)
        .with("cost_before", *identified_cost)
        .with("cost", *cost)
        .with("pull", *pull)
}

/// That the model keeps its identified values, since a fit carries over worse to motions that
/// were left out of it.
fn not_taken(record: &FitRecord) -> Finding {
    let [identified, fitted] = record.carried_over();
    let size = |cost: Option<f64>| {
        let words = |cost| format!("cost {}", four_decimals(cost));
        cost.map_or_else(|| "no factor is enough".into(), words)
    };
    let text = format!(
        "The fit was not taken: with a motion left out of it, the sets that then grow until \
         they enclose this motion {} in the mean, and with the identified model {}. Fit to \
         more motions, or fit fewer groups.",
        size(fitted),
        size(identified),
    );
    Finding::new(Severity::Warning, Code::FitNotTaken, text)
        .with("identified", identified.unwrap_or(f64::INFINITY))
        .with("fitted", fitted.unwrap_or(f64::INFINITY))
}

/// That fitted values are no measurements, and how many compensate for model error; `None` if
/// none changed.
pub(crate) fn parameters_moved(record: &FitRecord) -> Option<Finding> {
    let changed = || record.parameters.iter().filter(|p| p.has_changed());
    let is_far = |p: &&FittedParameter| {
        p.factor.is_some_and(|factor| !(1.0 / MOST_FACTOR..=MOST_FACTOR).contains(&factor))
    };
    let beyond = changed().filter(|p| p.is_beyond_error()).count();
    let far = changed().filter(is_far).count();
    let mut words = Vec::new();
    if beyond > 0 {
        words.push(format!(
            "{} moved by more than {MOST_ERRORS} standard errors",
            counted(beyond, "value")
        ));
    }
    if far > 0 {
        words.push(format!("{} changed by a factor beyond {MOST_FACTOR}", counted(far, "value")));
    }
    let text = match words.is_empty() {
        true => "The fitted values were chosen for small sets; do not read them as \
                 measurements."
            .into(),
        false => format!(
            "{}. Such a value compensates for model error; do not read it as a measurement.",
            words.join(", and ")
        ),
    };
    changed().next().map(|_| {
        Finding::new(Severity::Info, Code::ParametersMoved, text)
            .with("beyond_error", beyond as f64)
            .with("beyond_factor", far as f64)
    })
}

/// What holds where the run is unknown, of a model whose friction depends on it.
pub(crate) fn any_run(any: &AnyRun) -> Finding {
    let radii = any.sets.input_set.radius.iter().map(|radius| format!("{radius:.3}"));
    let text = format!(
        "Friction depends on the run: this model needs the order of the run in its suite, or \
         the temperatures. If the run is unknown, the sets cost {}, around the nominal motion \
         of run {} ({}; radii of U {}). The model file has these sets as any_run.",
        four_decimals(any.cost),
        any.condition.place,
        if any.verified { "proved" } else { "NOT proved" },
        radii.collect::<Vec<_>>().join(" ")
    );
    Finding::new(Severity::Info, Code::AnyRun, text).with("cost", any.cost)
}
