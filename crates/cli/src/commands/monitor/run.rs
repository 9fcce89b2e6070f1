use reachtube::Model;
use reachtube::conform::Error as ConformError;
use reachtube::conform::monitor::Schedule;
use reachtube::identify::prepare::VelocitySource;
use reachtube::pipeline::LiveMonitor;
use reachtube::recordings::{DataSet, SampleError};
use reachtube::tracking::TrackingModel;
use reachtube_files::SealedFile;

use crate::commands::monitor::arguments::Arguments;
use crate::commands::monitor::events::Events;
use crate::commands::monitor::lines::{END_OF_INPUT, follow, wrong};
use crate::commands::monitor::samples::{Kinds, Sample, Samples};
use crate::commands::monitor::tracking;
use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;

/// What samples have: positions, velocities and torques.
const KINDS: Kinds = &["q", "qd", "tau"];

/// Samples from which the time between samples is taken.
const FIRST: usize = 17;

pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    if TrackingModel::is_at(&args.model) {
        return tracking::run(args, json);
    }
    let (model, setup) = reachtube::arm::open(&args.model)?;
    if setup.dynamics().linear_system().is_none() {
        return Err(ConformError::NotLinear.into());
    }
    let mut watch = Watch {
        args,
        model: &model,
        samples: Samples::new(model.inputs(), KINDS),
        first: Vec::new(),
        monitor: None,
        events: Events::new(model.signals.clone(), json),
        next_gauge: f64::NEG_INFINITY,
    };
    let ended = follow(|number, line| watch.take(number, line));
    watch.begin().or_else(|error| if ended.is_ok() { Err(error) } else { Ok(()) })?;
    let outcome = match &mut watch.monitor {
        None => Outcome::Done,
        Some(monitor) => {
            monitor.finish();
            let words = ended.as_ref().copied().unwrap_or("error");
            watch.events.summary(monitor.found(), words)?;
            let totals = monitor.found().totals();
            if totals.rows == 0 && ended.as_ref().is_ok_and(|end| *end == END_OF_INPUT) {
                let late = monitor.delay();
                let problem = format!("no sample was compared; answers come {late:.3} s late");
                return Err(wrong(1, &problem));
            }
            Outcome::of(totals.left == 0 && totals.alarms == 0)
        }
    };
    ended.map(|_| outcome)
}

/// A monitor and what it needs before it can begin.
struct Watch<'a> {
    args: &'a Arguments,
    model: &'a Model,
    samples: Samples,
    /// The samples before the time between samples is known, with their lines.
    first: Vec<(u64, Sample)>,
    monitor: Option<LiveMonitor>,
    events: Events,
    next_gauge: f64,
}

impl Watch<'_> {
    fn take(&mut self, number: u64, line: &str) -> Result<()> {
        let read = self.samples.read(line).map_err(|problem| wrong(number, &problem))?;
        let Some(sample) = read else { return Ok(()) };
        if self.monitor.is_some() {
            return self.judge(number, &sample);
        }
        self.first.push((number, sample));
        if self.args.step.is_some() || self.first.len() >= FIRST {
            self.begin()?;
        }
        Ok(())
    }

    /// Makes the monitor, once the time between samples is known, and judges the first samples.
    fn begin(&mut self) -> Result<()> {
        if self.monitor.is_some() {
            return Ok(());
        }
        let Arguments { step, horizon, every, max_gap, .. } = self.args;
        let first = std::mem::take(&mut self.first);
        let times = first.windows(2).map(|pair| pair[1].1.t - pair[0].1.t);
        let mut steps: Vec<f64> = times.filter(|step| *step > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        let Some(step) = step.or_else(|| steps.get(steps.len() / 2).copied()) else {
            let number = first.last().map_or(1, |(number, _)| *number);
            return Err(wrong(number, "there are no two samples at increasing times"));
        };
        let step = rounded(step);
        let schedule = Schedule::new(self.model, step);
        let horizon = horizon.unwrap_or(schedule.horizon);
        let usual = Schedule::with_horizon(horizon, step);
        let schedule = Schedule {
            every: every.unwrap_or(usual.every),
            longest_gap: max_gap.unwrap_or(usual.longest_gap),
            ..usual
        };
        let velocity = match self.args.differentiate {
            true => VelocitySource::Differentiated,
            false => VelocitySource::Recorded,
        };
        let mut monitor = LiveMonitor::new(self.model, schedule, velocity)?;
        output::note(&format!(
            "samples every {step} s, windows of {:.4} s, a new one every {:.4} s",
            monitor.found().horizon(),
            monitor.found().every()
        ));
        if monitor.delay() > 0.0 {
            output::note(&format!(
                "answers come {:.3} s late: the model's recordings were filtered with samples from \
                 after each one",
                monitor.delay()
            ));
        }
        if let Some(folder) = &self.args.healthy {
            let healthy =
                LiveMonitor::learn(self.model, schedule, velocity, &DataSet::open(folder)?)?;
            self.events.healthy(&healthy);
            monitor.watch(&healthy)?;
        }
        self.monitor = Some(monitor);
        for (number, sample) in first {
            self.judge(number, &sample)?;
        }
        Ok(())
    }

    fn judge(&mut self, number: u64, sample: &Sample) -> Result<()> {
        let Some(monitor) = &mut self.monitor else { return Ok(()) };
        let Sample { t, parts } = sample;
        let [q, qd, tau] = &parts[..] else { return Ok(()) };
        let refused = |problem: SampleError| {
            let option = matches!(problem, SampleError::Gap { .. });
            let option = if option { " (--max-gap)" } else { "" };
            wrong(number, &format!("{problem}{option}"))
        };
        let left = monitor.push(*t, q, qd, tau).map_err(refused)?;
        self.events.left(left)?;
        self.events.alarms(monitor.alarms())?;
        if let Some(every) = self.args.gauge_every
            && *t >= self.next_gauge
        {
            self.events.gauge(*t, monitor.found())?;
            self.next_gauge = t + every;
        }
        Ok(())
    }
}

/// Rounds a measured time between samples to a whole rate, or to a microsecond.
fn rounded(step: f64) -> f64 {
    let of_rate = step.recip().round().recip();
    if (of_rate / step - 1.0).abs() < 1e-3 { of_rate } else { (1e6 * step).round().max(1.0) / 1e6 }
}
