//! Sentences that several commands print about a model.

use reachtube::Disturbance;
use reachtube::conform::{Lost, Notion, TraceVerdict};
use reachtube::number::at_least;

/// Reports where a reachable set ended before its suite.
pub(crate) fn lost(lost: &Lost) -> String {
    format!(
        "{}: the reachable set could not be computed beyond {:.3} s, where {} grew fastest; later \
         samples are not enclosed (--until {:.3} uses only the samples before)",
        lost.case, lost.time, lost.state, lost.time
    )
}

/// Says in which directions recorded points must lie in the reachable set.
pub(crate) fn notion_words(notion: Notion) -> &'static str {
    match notion {
        Notion::Hull => "each state by itself",
        Notion::PhasePlane => "position and velocity of each joint together",
        Notion::Exact | Notion::Trace => "all states together",
    }
}

/// Says how many recordings are motions of the model, and what U lacks for the others.
pub(crate) fn traces(traces: &TraceVerdict, runs: usize, disturbance: Disturbance) -> String {
    let mut text = format!(
        "{} of {runs} recordings proved to be one motion of the model each, within V",
        runs - traces.unproved
    );
    if let Some(worst) = &traces.worst {
        text += &match traces.factor {
            Some(factor) => {
                format!("; U must be {} times as large for all, as {worst} needs", at_least(factor))
            }
            None => format!(
                "; no U up to 1024 times as large suffices for {worst}: {}its start may lie at the \
                 edges of X0 and V, or its positions and velocities may not agree; a larger V \
                 helps (conform --noise)",
                match disturbance {
                    Disturbance::Constant => {
                        "a disturbance that never changes cannot follow what changes during the \
                         motion (conform --disturbance sample can); or "
                    }
                    Disturbance::Sample | Disturbance::Measurable => "",
                }
            ),
        };
    }
    text
}
