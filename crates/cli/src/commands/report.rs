use std::path::{Path, PathBuf};

use reachtube::report::{Sources, SuiteFigure, page, suite_svg, write_html};
use reachtube::{Result, write};
use serde_json::json;

use super::{Opened, Outcome};
use crate::args::ReportArgs;
use crate::output;

pub fn run(args: &ReportArgs, json: bool) -> Result<Outcome> {
    let opened = Opened::new(&args.model)?;
    let page = write(&opened, &args.out)?;
    if json {
        output::print_json(&json!({ "report": page }));
    } else {
        output::print(&format!("wrote {}\n", page.display()));
    }
    Ok(Outcome::Done)
}

/// Writes the page and its figures into `folder`; returns the page's path.
pub fn write(opened: &Opened, folder: &Path) -> Result<PathBuf> {
    let check = opened.check()?;
    let (recordings, grids) = opened.recordings()?;
    let reach = opened.reach(&recordings, &grids)?;
    let sources = Sources {
        model: &opened.model,
        settings: &opened.settings,
        data: &opened.data,
        recordings: &recordings,
        reach: &reach,
        check: &check,
    };
    let page = page(&sources)?;
    for figure in &page.suites {
        write_figures(figure, folder)?;
    }
    let mut html = Vec::new();
    write_html(&page, &mut html)?;
    let path = folder.join("report.html");
    write::atomically(&path, |out| out.write_all(&html))?;
    Ok(path)
}

/// Writes each view of a suite as SVG: A_motion.svg, A_deviation.svg.
pub fn write_figures(figure: &SuiteFigure, folder: &Path) -> Result<()> {
    for &view in figure.views() {
        let svg = suite_svg(figure, view)?;
        let name = format!("{}_{}.svg", figure.suite, format!("{view:?}").to_lowercase());
        write::atomically(&folder.join(name), |out| out.write_all(svg.as_bytes()))?;
    }
    Ok(())
}
