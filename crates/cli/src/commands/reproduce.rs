use reachtube::reproduce::{Table1Options, table1 as make_table1};
use reachtube::{Result, write};
use reachtube_robot::Robot;

use super::Outcome;
use crate::args::Table1Args;
use crate::progress::Progress;
use crate::{output, words};

/// Table I of the paper.
pub fn table1(args: &Table1Args, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    robot.check_physical()?;
    if let Some(path) = &args.out {
        write::try_at(path)?;
    }
    let options = Table1Options {
        motions: args.motions,
        seed: args.seed,
        orders: args.orders.clone(),
        model3_up_to: args.model3_up_to,
        range: args.range,
    };
    let bar = Progress::of("simulating");
    let table = make_table1(&robot, &options, &|done, total| bar.show(done, total))?;
    drop(bar);
    if let Some(path) = &args.out {
        write::atomically(path, |out| table.write_csv(out))?;
        output::note(&format!("wrote {}", path.display()));
    }
    if json {
        output::print_json(&table)?;
    } else {
        output::print(&words::table1(&table))?;
    }
    Ok(Outcome::Done)
}
