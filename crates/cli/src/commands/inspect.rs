use reachtube::Result;
use reachtube::recordings::{DataSet, inspect};

use super::Outcome;
use crate::args::{InspectArgs, gap_limit};
use crate::progress::Progress;
use crate::{output, words};

pub fn run(args: &InspectArgs, json: bool) -> Result<Outcome> {
    let bar = Progress::new();
    let inspection = inspect(&DataSet::open(&args.data)?, gap_limit(args.max_gap))?;
    drop(bar);
    output::notes(&inspection.notes);
    if json {
        output::print_json(&inspection)?;
    } else {
        output::print(&words::inspection(&inspection))?;
    }
    Ok(Outcome::Done)
}
