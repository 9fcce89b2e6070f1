//! What the monitor prints: events as they happen, and the summary.

use std::fmt::Write;

use reachtube::conform::data::Signals;
use reachtube::conform::monitor::{Alarm, HealthyMotion, Leave, Monitor, Totals};
use reachtube::finding::{Code, Finding, Table};
use reachtube::recordings::State;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Result;
use crate::output;

/// Prints events and the summary, as text or as one JSON object per line.
pub(super) struct Events {
    json: bool,
    signals: Signals,
    /// The first event.
    first: Option<Finding>,
    /// Upper bound of the probability of an alarm in one more healthy recording.
    alarm_bound: Option<f64>,
}

/// One line of `monitor --json`.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "event", rename_all = "lowercase")]
pub(crate) enum Event<'a> {
    /// The first value of a window outside its set; of several at its sample, the one furthest
    /// outside in parts of the radius.
    Left {
        /// The value.
        #[serde(flatten)]
        leave: &'a Leave,
        /// Name of the joint.
        name: &'a str,
        /// The code of the finding.
        code: Code,
    },
    /// A number that leaves its range in healthy motion: calibrated, not proved.
    Alarm {
        /// The number.
        #[serde(flatten)]
        alarm: &'a Alarm,
        /// Name of the joint; null for the payload.
        name: Option<&'a str>,
        /// The code of the finding.
        code: Code,
    },
    /// How much of the sets is used.
    Gauge {
        /// Time of the sample, s.
        time: f64,
        /// Parts of the radius in each state, q then qd.
        used: &'a [f64],
        /// Where in the set windows end on average, in parts of the radius, in each state.
        drift: &'a [f64],
    },
    /// The summary.
    Summary {
        /// Why the monitor ended: "end of input", "interrupt" or "error".
        ended: &'a str,
        /// What was judged.
        totals: Totals,
        /// The largest part of the radius in each state, q then qd.
        largest_used: &'a [f64],
        /// Where in the set windows end on average, in each state.
        drift: &'a [f64],
        /// The probability at most that one more healthy recording raises an alarm; null without
        /// --healthy.
        alarm_bound: Option<f64>,
        /// What the answer says, statement by statement: the verdict first.
        findings: Vec<&'a Finding>,
    },
}

impl Events {
    pub(super) fn new(signals: Signals, json: bool) -> Self {
        Self { json, signals, first: None, alarm_bound: None }
    }

    /// Prints a line for each window that is left for the first time, with its worst state.
    pub(super) fn left(&mut self, leaves: &[Leave]) -> Result<()> {
        for first in leaves.iter().filter(|leave| leave.first) {
            let of_window = leaves.iter().filter(|leave| leave.window == first.window);
            let part = |leave: &Leave| leave.excess / leave.radius;
            let worst = of_window.max_by(|a, b| part(a).total_cmp(&part(b))).unwrap_or(first);
            self.print(worst)?;
        }
        Ok(())
    }

    fn print(&mut self, leave: &Leave) -> Result<()> {
        let name = &self.signals.parts[leave.part - 1].name;
        let finding = leave.finding(&self.signals);
        let text = format!("{}\n", finding.text);
        let code = finding.code.clone();
        self.first.get_or_insert(finding);
        if self.json {
            return line(&Event::Left { leave, name, code });
        }
        output::print(&text)
    }

    /// Notes what healthy motion is.
    pub(super) fn healthy(&mut self, healthy: &HealthyMotion) {
        let bound = healthy.bound();
        self.alarm_bound = Some(bound);
        output::note(&format!(
            "alarms are calibrated, not proved: one more recording of such motion raises one with \
             probability at most {bound:.3}"
        ));
        let ranges = healthy.ranges();
        let resting = self.signals.parts.iter().zip(&ranges).filter(|(_, range)| range.is_none());
        let resting: Vec<&str> = resting.map(|(part, _)| &*part.name).collect();
        if !resting.is_empty() {
            output::note(&format!(
                "the healthy recordings move {} too little: no sudden torque on it is noticed",
                resting.join(", ")
            ));
        }
    }

    /// Prints a line for each alarm.
    pub(super) fn alarms(&mut self, alarms: &[Alarm]) -> Result<()> {
        for alarm in alarms {
            let finding = alarm.finding(&self.signals);
            if self.json {
                let name = alarm.part.map(|part| &*self.signals.parts[part - 1].name);
                line(&Event::Alarm { alarm, name, code: finding.code.clone() })?;
            } else {
                output::print(&format!("{}\n", finding.text))?;
            }
            self.first.get_or_insert(finding);
        }
        Ok(())
    }

    /// Prints how much of the sets is used at a time, s.
    pub(super) fn gauge(&self, time: f64, monitor: &Monitor) -> Result<()> {
        if self.json {
            return line(&Event::Gauge { time, used: monitor.used(), drift: monitor.drift() });
        }
        let (state, used) = greatest(monitor.used());
        let (drifting, drift) = greatest(monitor.drift());
        let n = self.signals.parts.len();
        output::print(&format!(
            "{time:.4} s: {:.0} % of the set is used, in {}; the largest drift is {:.0} %, in {}\n",
            100.0 * used,
            State::from_index(state, n),
            100.0 * drift,
            State::from_index(drifting, n),
        ))
    }

    /// Prints the summary.
    pub(super) fn summary(&self, monitor: &Monitor, ended: &str) -> Result<()> {
        let totals = monitor.totals();
        let verdict = totals.finding();
        if self.json {
            let findings: Vec<&Finding> = [&verdict].into_iter().chain(&self.first).collect();
            return line(&Event::Summary {
                ended,
                totals,
                largest_used: monitor.largest_used(),
                drift: monitor.drift(),
                alarm_bound: self.alarm_bound,
                findings,
            });
        }
        let mut text = format!("{}\n", verdict.text);
        if let Some(first) = &self.first {
            let _ = writeln!(text, "first: {}", first.text);
        }
        let n = self.signals.parts.len();
        let percent = |part: f64| format!("{:.0}", 100.0 * part);
        let row = |joint: usize| {
            let (used, drift) = (monitor.largest_used(), monitor.drift());
            let values = [used[joint], used[n + joint], drift[joint], drift[n + joint]];
            let cells = values.into_iter().map(percent);
            std::iter::once(self.signals.parts[joint].name.clone()).chain(cells).collect()
        };
        let rows = (0..n).map(row).collect();
        let header = ["joint", "q used [%]", "qd used [%]", "drift of q [%]", "drift of qd [%]"];
        let _ = write!(text, "\n{}", Table::new(header, rows));
        output::print(&text)
    }
}

/// Returns the state of the largest part, and that part.
fn greatest(parts: &[f64]) -> (usize, f64) {
    let by_size = |a: &(usize, &f64), b: &(usize, &f64)| a.1.abs().total_cmp(&b.1.abs());
    parts.iter().enumerate().max_by(by_size).map_or((0, 0.0), |(state, part)| (state, *part))
}

/// Prints an event as one line of JSON.
pub(super) fn line(event: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string(event).expect("an event has string keys");
    output::print_json_text(&(text + "\n"))
}
