use reachtube::Result;

use super::Outcome;
use crate::args::DemoArgs;

pub fn run(_args: &DemoArgs, _json: bool) -> Result<Outcome> {
    todo!()
}
