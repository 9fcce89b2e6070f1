use reachtube::Result;

use super::{Opened, Outcome};
use crate::args::ModelArgs;
use crate::{output, words};

pub fn run(args: &ModelArgs, json: bool) -> Result<Outcome> {
    let check = Opened::new(args)?.check()?;
    output::notes(&check.notes);
    if json {
        output::print_json(&check)?;
    } else {
        output::print(&words::check(&check))?;
    }
    Ok(Outcome::of(check.conformant))
}
