use std::path::PathBuf;

use reachtube::conform::SuiteReach;
use reachtube::report::page;
use reachtube::{Result, write};
use serde_json::json;

use super::{Opened, Outcome, files, report};
use crate::args::ReachArgs;
use crate::numbers::number;
use crate::{output, words};

/// The reachable set of a suite or run, and where it was written.
struct Written<'a> {
    reach: &'a SuiteReach,
    samples: PathBuf,
    tube: PathBuf,
}

pub fn run(args: &ReachArgs, json: bool) -> Result<Outcome> {
    let opened = Opened::new(&args.model)?;
    write::try_at(&args.out.join("A.csv"))?;
    let recordings = opened.recordings()?;
    output::notes(&recordings.notes);
    let reach = opened.reach(&recordings)?;
    let check = opened.check()?;
    let mut written = Vec::new();
    for (reach, name) in reach.iter().zip(files::of_reach(&reach)) {
        let samples = args.out.join(format!("{name}.csv"));
        write::atomically(&samples, |out| reach.write_samples(out))?;
        let tube = args.out.join(format!("{name}_tube.csv"));
        write::atomically(&tube, |out| reach.write_tube(out))?;
        written.push(Written { reach, samples, tube });
    }
    report::write_figures(&page(&opened.sources(&recordings, &reach, &check))?, &args.out)?;
    if json {
        let rows: Vec<_> = written.iter().map(Written::json).collect();
        output::print_json(&json!({ "reach": rows }))?;
    } else {
        let header = ["suite", "run", "samples", "widest q [rad]", "widest qd [rad/s]", "file"];
        let rows: Vec<_> = written.iter().map(Written::words).collect();
        output::print(&format!(
            "reachable sets; widths at the last sample\n{}",
            words::table(&header, &rows)
        ))?;
    }
    for lost in reach.iter().filter_map(|reach| reach.lost.as_ref()) {
        output::note(&words::lost(lost));
    }
    Ok(Outcome::of(reach.iter().all(|reach| reach.lost.is_none())))
}

impl Written<'_> {
    /// Widths of the set at the last sample, 2n.
    fn final_width(&self) -> Vec<f64> {
        let SuiteReach { lower, upper, dimension, .. } = self.reach;
        (upper.len() - dimension..upper.len()).map(|at| upper[at] - lower[at]).collect()
    }

    fn json(&self) -> serde_json::Value {
        json!({
            "suite": self.reach.suite,
            "run": self.reach.run,
            "samples": self.reach.times.len(),
            "duration": self.reach.times.last(),
            "final_width": self.final_width(),
            "lost": self.reach.lost,
            "csv": self.samples,
            "tube_csv": self.tube,
        })
    }

    fn words(&self) -> Vec<String> {
        let widths = self.final_width();
        let (positions, velocities) = widths.split_at(widths.len() / 2);
        let widest = |widths: &[f64]| number(widths.iter().copied().fold(0.0, f64::max));
        vec![
            self.reach.suite.clone(),
            self.reach.run.clone().unwrap_or_else(|| "all".into()),
            self.reach.times.len().to_string(),
            widest(positions),
            widest(velocities),
            self.samples.display().to_string(),
        ]
    }
}
