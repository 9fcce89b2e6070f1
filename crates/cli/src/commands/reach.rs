use reachtube::report::{Sources, page};
use reachtube::{Result, write};
use serde_json::json;

use super::{Opened, Outcome};
use crate::args::ReachArgs;
use crate::{output, words};

pub fn run(args: &ReachArgs, json: bool) -> Result<Outcome> {
    let opened = Opened::new(&args.model)?;
    let (recordings, grids) = opened.recordings()?;
    output::notes(&recordings.notes);
    let reach = opened.reach(&recordings, &grids)?;
    let mut files = Vec::new();
    for suite in &reach {
        let samples = args.out.join(format!("{}.csv", suite.name()));
        write::atomically(&samples, |out| suite.write_samples(out))?;
        let tube = args.out.join(format!("{}_tube.csv", suite.name()));
        write::atomically(&tube, |out| suite.write_tube(out))?;
        files.push((suite, samples, tube));
    }
    let check = opened.check()?;
    let sources = Sources {
        model: &opened.model,
        settings: &opened.settings,
        data: &opened.data,
        recordings: &recordings,
        reach: &reach,
        check: &check,
    };
    for figure in &page(&sources)?.suites {
        super::report::write_figures(figure, &args.out)?;
    }
    let widths = |suite: &reachtube::reach::SuiteReach| -> Vec<f64> {
        let last = suite.upper.len() - suite.dimension;
        (last..suite.upper.len()).map(|at| suite.upper[at] - suite.lower[at]).collect()
    };
    if json {
        let rows: Vec<_> = files
            .iter()
            .map(|(suite, samples, tube)| {
                json!({ "suite": suite.suite, "run": suite.run, "samples": suite.times.len(), "duration": suite.times.last(),
                    "final_width": widths(suite), "csv": samples, "tube_csv": tube })
            })
            .collect();
        output::print_json(&json!({ "reach": rows }));
    } else {
        let row = |(suite, samples, _): &(&reachtube::reach::SuiteReach, std::path::PathBuf, std::path::PathBuf)| {
            let n = suite.dimension / 2;
            let widest = |widths: &[f64]| format!("{:.4}", widths.iter().copied().fold(0.0, f64::max));
            let widths = widths(suite);
            vec![suite.name(), suite.times.len().to_string(), widest(&widths[..n]), widest(&widths[n..]), samples.display().to_string()]
        };
        let header = ["suite", "samples", "widest q at the end [rad]", "widest qd at the end [rad/s]", "file"];
        output::print(&words::table(&header, &files.iter().map(row).collect::<Vec<_>>()));
    }
    Ok(Outcome::Done)
}
