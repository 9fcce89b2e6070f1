//! Findings about the stops of a robot.

use crate::code::Code;
use reachtube_finding::{Finding, Severity};
use reachtube_scalar::number::{at_least, significant};

use crate::stop::along::{WorstStop, of_suites, proved};
use crate::stop::annex_b::AnnexB;
use crate::stop::delay_span::DelaySpan;
use crate::stop::recorded::{RecordedStop, outside};

/// Returns the findings, the verdict first; ways are in `unit`.
pub(super) fn findings(
    (stops, span): (&[WorstStop], &DelaySpan),
    table: Option<&AnnexB>,
    recorded: &[RecordedStop],
    unit: &str,
) -> Vec<Finding> {
    let verdict = outside(recorded).map(|stop| beyond(stop, unit));
    let verdict = verdict.unwrap_or_else(|| of_motions(stops, span));
    let table = table.into_iter().flat_map(|table| table.notes.iter().cloned());
    [verdict].into_iter().chain(left_out(stops)).chain(table).collect()
}

fn of_motions(stops: &[WorstStop], span: &DelaySpan) -> Finding {
    let [samples, proved] = proved(stops);
    let open = samples - proved;
    let numbers =
        |finding: Finding| finding.with("samples", samples as f64).with("not_proved", open as f64);
    if samples == 0 {
        let text = "not proved: no sample has a stop that could be followed; give longer motions, \
                    or a greater deceleration.";
        return numbers(Finding::new(Severity::Failure, Code::StandstillOpen, text));
    }
    if open == 0 {
        let text =
            format!("stands: from each of {samples} samples every joint comes to a standstill.");
        return numbers(Finding::new(Severity::Info, Code::Stands, text));
    }
    let text = format!("not proved: from {open} of {samples} samples no standstill is proved");
    let others = "the brakes may be too weak for the load, or the recorded states too far apart";
    let text = match span.with_one_delay {
        0 => format!("{text}; {others}."),
        all if all == open => format!("{text}; {span}."),
        _ => format!("{text}; {span}; else {others}."),
    };
    numbers(Finding::new(Severity::Failure, Code::StandstillOpen, text))
}

fn left_out(stops: &[WorstStop]) -> Option<Finding> {
    let count: usize = of_suites(stops).map(|worst| worst.skipped).sum();
    let noun = if count == 1 { "sample is" } else { "samples are" };
    let text = format!(
        "{count} {noun} left out, since the deceleration from there would lead beyond the end of \
         the recording."
    );
    let finding = Finding::new(Severity::Info, Code::StopsLeftOut, text);
    (count > 0).then(|| finding.with("samples", count as f64))
}

fn beyond(stop: &RecordedStop, unit: &str) -> Finding {
    let RecordedStop { recording, joint, .. } = stop;
    let not_covered = |text: String| Finding::new(Severity::Failure, Code::StopNotCovered, text);
    let finding = match stop.time {
        None => not_covered(format!(
            "not covered: {recording}: {joint} moves until the recording ends; record each stop \
             to its standstill."
        )),
        Some(_) if stop.proved_time.is_infinite() => {
            let text = format!(
                "not proved: {recording}: no standstill is proved from its first state; the \
                 brakes may be too weak for the load, or the span of `delay` too long."
            );
            Finding::new(Severity::Failure, Code::StandstillOpen, text)
        }
        Some(time) => not_covered(format!(
            "not covered: {recording}: {joint} moves {} {unit} in {time:.3} s, but {} to {} \
             {unit} in {} s are proved; the brakes may be weaker or slower than their file has \
             it, or the recording may not begin with the stop.",
            significant(stop.way, 4),
            significant(stop.proved_way[0], 4),
            significant(stop.proved_way[1], 4),
            at_least(stop.proved_time),
        )),
    };
    let finding = finding.at(format!("{recording}, {joint}")).with("way", stop.way);
    finding.with("time", stop.time.unwrap_or(f64::INFINITY)).with("proved_time", stop.proved_time)
}
