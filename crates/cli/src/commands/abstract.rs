use std::time::Instant;

use reachtube::abstraction::{ExpansionPoint, OperatingBox, PolynomialModel};
use reachtube::{Result, write};
use reachtube_robot::Robot;
use serde_json::json;

use super::Outcome;
use crate::args::AbstractArgs;
use crate::progress::Progress;
use crate::{output, words};

pub fn run(args: &AbstractArgs, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    robot.check_physical()?;
    let point = ExpansionPoint::from_values(&args.at, robot.joint_count())?;
    if let Some(path) = &args.out {
        write::try_at(path)?;
    }
    let started = Instant::now();
    let mut model = PolynomialModel::new(&robot, args.model, args.order, &point)?;
    let seconds = started.elapsed().as_secs_f64();
    if !args.operating_box.is_empty() {
        let _bar = Progress::new();
        let operating_box = OperatingBox::about(&point, &args.operating_box)?;
        let most = args.most_boxes.unwrap_or_else(|| model.usual_boxes());
        model.set_remainder(model.bound_remainder(&operating_box, most)?);
    }
    if let Some(path) = &args.out {
        write::atomically(path, |out| out.write_all(model.to_json().as_bytes()))?;
        output::note(&format!("wrote {}", path.display()));
    }
    if args.print {
        output::print(&model.to_string())?;
    } else if json {
        let terms: Vec<usize> = model.acceleration().iter().map(|f| f.term_count()).collect();
        output::print_json(&json!({
            "model": model.kind(),
            "order": model.order(),
            "states": model.states(),
            "variables": model.layout().names(),
            "degree": model.degree(),
            "terms": terms,
            "remainder": model.remainder(),
            "seconds": seconds,
        }))?;
    } else {
        output::print(&words::abstraction(&model, seconds))?;
    }
    Ok(Outcome::Done)
}
