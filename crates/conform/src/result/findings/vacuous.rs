//! Which sets are vacuous, although they were proved to enclose every recording.

use reachtube_scalar::number::counted;

use crate::data::signals::Signals;
use crate::model::file::Model;
use crate::plausibility::{Usefulness, Vacuity, VacuousSet};
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

/// Largest number of sets that the sentence describes.
const MOST_SETS: usize = 3;

/// Which sets of a model are vacuous; none of a model that is useful or was not proved.
pub(crate) fn vacuous(model: &Model) -> Option<Finding> {
    let said = model.usefulness.as_ref().filter(|_| model.is_vacuous())?;
    let sets = worst_first(said);
    let place = place(model, &sets);
    let first = sets.iter().take(MOST_SETS);
    let mut words: Vec<String> = first.map(|set| described(set, said, &model.signals)).collect();
    let more = sets.len().saturating_sub(MOST_SETS);
    if more > 0 {
        words.push(format!("{} more", counted(more, "set")));
    }
    let text = format!("Proved, but vacuous for {place}: {}.", words.join("; "));
    let worst = sets.first()?;
    let finding = Finding::new(Severity::Failure, Code::Vacuous, text).at(place);
    Some(
        finding
            .with("horizon", said.horizon)
            .with("part", worst.part as f64)
            .with("size", worst.size)
            .with("compared_with", worst.compared_with),
    )
}

pub(crate) fn vacuous_in_brief(model: &Model) -> Option<String> {
    let said = model.usefulness.as_ref().filter(|_| model.is_vacuous())?;
    let sets = worst_first(said);
    let worst = sets.first()?;
    Some(format!("vacuous for {}: {}", place(model, &sets), described(worst, said, &model.signals)))
}

fn worst_first(said: &Usefulness) -> Vec<&Vacuity> {
    let mut sets: Vec<&Vacuity> = said.vacuous.iter().collect();
    sets.sort_by(|a, b| factor(b).total_cmp(&factor(a)));
    sets
}

fn place(model: &Model, sets: &[&Vacuity]) -> String {
    model.signals.place(sets.iter().map(|set| set.part))
}

fn factor(set: &Vacuity) -> f64 {
    set.size / set.compared_with
}

fn described(set: &Vacuity, said: &Usefulness, signals: &Signals) -> String {
    let Vacuity { part, size, .. } = set;
    let n = signals.inputs.len();
    let [position, velocity] = [part - 1, n + part - 1].map(|state| &signals.states[state].unit);
    let times = match factor(set) {
        factor if factor < 100.0 => format!("{factor:.1} times"),
        factor => format!("{factor:.0e} times"),
    };
    let size = match size {
        size if (1e-3..1e4).contains(size) => format!("{size:.3}"),
        size => format!("{size:.1e}"),
    };
    match set.set {
        VacuousSet::Reachable => {
            let (unit, end) = (position, said.horizon);
            format!("the set of q{part} is {size} {unit} wide after {end:.3} s, {times} its motion")
        }
        VacuousSet::InitialPosition | VacuousSet::InitialVelocity => {
            let (state, unit) = match set.set {
                VacuousSet::InitialPosition => ("q", position),
                _ => ("qd", velocity),
            };
            format!(
                "X0 of {state}{part} is {size} {unit} wide, {times} what the recorded starts and \
                 the noise of the sensors explain"
            )
        }
    }
}
