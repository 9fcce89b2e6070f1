use reachtube::abstraction::{Abstraction, ExpansionPoint, PolynomialModel};
use reachtube::conform::{Dynamics, Noise, Settings, Tolerance, Watch, Weights, conform};
use reachtube::recordings::DataSet;
use reachtube::{Error, Model, Result, write};
use reachtube_robot::Robot;

use super::{Opened, Outcome};
use crate::args::{ConformArgs, gap_limit};
use crate::progress::Progress;
use crate::{output, words};

pub fn run(args: &ConformArgs, json: bool) -> Result<Outcome> {
    let (robot, mut settings) = robot_and_settings(args)?;
    robot.check_physical()?;
    settings.explain = explain(args, &robot, &settings)?;
    settings.validate(robot.joint_count())?;
    let data = DataSet::open(&args.data.data)?;
    if let Some(path) = &args.out {
        write::try_at(path)?;
    }
    if let Some(folder) = &args.report {
        write::try_at(&folder.join("report.html"))?;
    }
    let bar = Progress::new();
    let show = |done: usize, total: usize| bar.show(done, total);
    let tell = |words: &str| bar.tell(words);
    let watch = Watch { reading: &show, finished: &tell, resume: args.resume.as_deref() };
    let found = conform(&robot, &data, &args.data.suites, &settings, &watch)?;
    drop(bar);
    output::notes(&found.recordings.notes);
    let model = Model::new(&robot, &data, &settings, &found);
    drop(found);
    if let Some(path) = &args.out {
        write::atomically(path, |out| out.write_all(model.to_json().as_bytes()))?;
        output::note(&format!("wrote {}", path.display()));
    }
    if json {
        output::print(&model.to_json())?;
    } else {
        output::print(&words::model(&model))?;
    }
    let verified = model.verified;
    if let Some(folder) = &args.report {
        let (page, _) = super::report::write(&Opened::with(model, robot, &args.data)?, folder)?;
        output::note(&format!("wrote {}", page.display()));
    }
    Ok(Outcome::of(verified))
}

/// The robot, and what else decides the result; from a model's file where one is given.
fn robot_and_settings(args: &ConformArgs) -> Result<(Robot, Settings)> {
    let Some(path) = &args.abstraction else {
        let robot = Robot::load(args.robot.as_deref().unwrap_or_default())?;
        let settings = settings(args, robot.joint_count())?;
        return Ok((robot, settings));
    };
    let model = PolynomialModel::load(path)?;
    let settings = settings(args, model.joints())?.with_abstraction(&model)?;
    Ok((Robot::from_description(model.robot())?, settings))
}

/// Explanations cost little beside the search for the sets of a model that is not linear, and its
/// verdict needs them more.
fn explain(args: &ConformArgs, robot: &Robot, settings: &Settings) -> Result<Option<Tolerance>> {
    match args.explain.as_deref() {
        Some("none") => Ok(None),
        Some(list) => {
            let wrong = || {
                Error::Setting(format!(
                    "--explain: \"{list}\"; give none, or 2 numbers, rad and rad/s, separated by a comma"
                ))
            };
            let (position, velocity) = list.split_once(',').ok_or_else(wrong)?;
            let parse = |text: &str| text.trim().parse().map_err(|_| wrong());
            Ok(Some(Tolerance { position: parse(position)?, velocity: parse(velocity)? }))
        }
        None => match Dynamics::new(robot, settings)? {
            Dynamics::Linear(_) => Ok(None),
            Dynamics::Polynomial(_) => Ok(Some(Tolerance::default())),
        },
    }
}

fn settings(args: &ConformArgs, joints: usize) -> Result<Settings> {
    let settings = Settings {
        abstraction: Abstraction { model: args.model, order: args.order },
        expansion_point: ExpansionPoint::from_values(&args.expansion, joints)?,
        method: args.method,
        disturbance: args.disturbance,
        centre: args.centre,
        states: args.states,
        weights: match args.weights.as_str() {
            "unit" => Weights::Unit,
            "spread" => Weights::Spread,
            list => Weights::Given(numbers("--weights", "unit, spread", list, joints)?),
        },
        noise: match args.noise.as_str() {
            "none" => Noise::None,
            "free" => Noise::Free,
            list => Noise::Fixed(numbers("--noise", "none, free", list, joints)?),
        },
        nominal: args.nominal,
        until: args.data.until,
        gap_limit: gap_limit(args.data.max_gap),
        ..Settings::new(args.data.torque, joints)
    };
    settings.validate(joints)?;
    Ok(settings)
}

/// 2n numbers, or 2: one for all positions and one for all velocities. `words` are what else the
/// option takes.
fn numbers(option: &str, words: &str, list: &str, joints: usize) -> Result<Vec<f64>> {
    let all = 2 * joints;
    let wrong = |what: String| {
        Error::Setting(format!(
            "{option}: {what}; give {words}, 2 numbers (for positions, for velocities), or {all}"
        ))
    };
    let parse = |text: &str| {
        text.trim().parse::<f64>().map_err(|_| wrong(format!("\"{text}\" is no number")))
    };
    let values = list.split(',').map(parse).collect::<Result<Vec<_>>>()?;
    match values[..] {
        [position, velocity] => Ok([vec![position; joints], vec![velocity; joints]].concat()),
        _ if values.len() == all => Ok(values),
        _ => Err(wrong(format!("{} given", values.len()))),
    }
}
