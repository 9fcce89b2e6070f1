//! How far the sets depend on single motions and runs.

use reachtube_scalar::number::{at_least, plural};

use crate::model::file::Model;
use crate::next_motion::trends::Trend;
use crate::next_motion::without_motion::LeftOut;
use crate::result::code::Code;
use reachtube_finding::{Finding, Severity};

/// The meaning of the table of the sets without each motion, and the motion that the others
/// foretell least; `None` if there is no table to expect.
pub(crate) fn left_out(model: &Model) -> Option<Finding> {
    let is_linear = !model.a.is_empty();
    let text = match (model.left_out.is_empty(), model.data.motions()) {
        (true, 0 | 1) => return None,
        (true, _) if is_linear => return None,
        (true, _) => {
            "The sets without each motion are computed by the method `program` and for the \
             notion `hull` only. Otherwise, find sets for the suites of the other motions, and \
             check the motion that was left out."
        }
        (false, _) if model.fit.as_ref().is_some_and(|fit| fit.taken) => match is_linear {
            true => {
                "The nominal model was fitted and the sets were found without each motion. \
                     They describe these motions and bound no other."
            }
            false => {
                "The sets were found without each motion, for a nominal model that was \
                     fitted to all. They describe these motions and bound no other."
            }
        },
        (false, _) => {
            "The sets were found without each motion. They describe these motions and bound \
             no other."
        }
    };
    let motions = model.left_out.len() as f64;
    let finding = Finding::new(Severity::Info, Code::LeftOut, text).with("motions", motions);
    Some(match furthest(&model.left_out) {
        None => finding,
        Some(left @ LeftOut { motion, gauge, .. }) => {
            let growth = match gauge {
                Some(gauge) => {
                    format!("would have to grow {} times to enclose it", at_least(*gauge))
                }
                None => "enclose it under no growth that was found".into(),
            };
            let more = format!(
                " Without motion {motion} they {growth}, and another motion may lie as far \
                 out.{}",
                in_turn(left)
            );
            let text = finding.text.clone() + &more;
            let number = |gauge: &Option<f64>| gauge.unwrap_or(f64::INFINITY);
            Finding { text, ..finding }
                .at(motion)
                .with("growth", number(gauge))
                .with("initial_growth", number(&left.initial_gauge))
                .with("input_growth", number(&left.input_gauge))
        }
    })
}

/// Finding that the robot changed while it was recorded; `None` if it did not.
pub(crate) fn robot_changed(trends: &[Trend], noun: &str) -> Option<Finding> {
    let mut suites: Vec<String> = trends.iter().map(|trend| trend.suite.clone()).collect();
    suites.dedup();
    let place = format!("{} {}", plural(suites.len(), "suite"), suites.join(", "));
    let text = format!(
        "The robot changed while it was recorded: in {place}, {noun}s follow the order of the \
         runs, as a robot that warms up does. A later motion may lie further out."
    );
    let finding = Finding::new(Severity::Warning, Code::RobotChanged, text).at(place);
    (!suites.is_empty()).then(|| finding.with("parts", trends.len() as f64))
}

/// Returns which of X0 and U has to grow for a motion, in words; no words if it is not known.
fn in_turn(left: &LeftOut) -> String {
    let Some(initial) = left.initial_gauge else { return String::new() };
    let input = match left.input_gauge {
        Some(input) => format!("U {} times", at_least(input)),
        None => "no U that was found".into(),
    };
    format!(
        " Grown one after the other, its start needs X0 {} times, and the rest then needs {input}.",
        at_least(initial)
    )
}

/// Returns the motion whose absence needs the most growth, if one needs any.
fn furthest(all: &[LeftOut]) -> Option<&LeftOut> {
    let growth = |left: &LeftOut| left.gauge.unwrap_or(f64::INFINITY);
    let computed = all.iter().filter(|left| left.cost.is_some());
    computed.max_by(|a, b| growth(a).total_cmp(&growth(b))).filter(|left| growth(left) > 1.0)
}
