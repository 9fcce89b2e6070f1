use std::fmt::Write;

use reachtube::{Result, write};
use reachtube_robot::{Column, ColumnKind, Criterion, Excitation, ExcitationSettings, Robot};
use serde_json::json;

use super::Outcome;
use crate::args::ExciteArgs;
use crate::numbers::number;
use crate::output;

pub fn run(args: &ExciteArgs, json: bool) -> Result<Outcome> {
    let robot = Robot::load(&args.robot)?;
    write::try_at(&args.out)?;
    let settings = ExcitationSettings {
        period: args.period,
        harmonics: args.harmonics,
        criterion: if args.condition { Criterion::Condition } else { Criterion::LogDeterminant },
        acceleration: args.acceleration.clone(),
        speed: args.speed,
        seed: args.seed,
        ..ExcitationSettings::default()
    };
    let n = robot.joint_count();
    let motor_and_friction =
        [ColumnKind::MotorInertia, ColumnKind::Coulomb, ColumnKind::Offset, ColumnKind::Viscous1];
    let columns =
        [Column::of_joints(n, &ColumnKind::INERTIAL), Column::of_joints(n, &motor_and_friction)]
            .concat();
    let found = robot.excitation(&columns, &settings)?;
    let text = csv(&found, n, args.rate);
    write::atomically(&args.out, |out| out.write_all(text.as_bytes()))?;
    output::note(&format!("wrote {}", args.out.display()));
    if json {
        let (now, before) = (found.quality.condition, found.before.condition);
        output::print_json(
            &json!({ "condition": now, "condition_before": before, "period": args.period }),
        )?;
    } else {
        output::print(&words(&found, &robot))?;
    }
    Ok(Outcome::Done)
}

fn words(found: &Excitation, robot: &Robot) -> String {
    let mut text = format!(
        "condition of the base regressor {} (a random motion: {}), ln det of its information {} ({})\n",
        number(found.quality.condition),
        number(found.before.condition),
        number(found.quality.log_determinant),
        number(found.before.log_determinant)
    );
    for (j, joint) in robot.joints().iter().enumerate() {
        let [low, high] = found.trajectory.position_range(j);
        let speed = found.trajectory.speed_bound(j);
        let _ =
            writeln!(text, "  {}: {low:.3} to {high:.3} rad, at most {speed:.3} rad/s", joint.name);
    }
    text.push_str(
        "only joint limits were looked at: check that the arm hits neither itself nor what is around it\n",
    );
    text
}

/// t, q1..qn, qd1..qdn, qdd1..qddn of one period.
fn csv(found: &Excitation, joints: usize, rate: f64) -> String {
    let names = |prefix: &str| (1..=joints).map(|i| format!(",{prefix}{i}")).collect::<String>();
    let mut text = format!("t{}{}{}\n", names("q"), names("qd"), names("qdd"));
    for sample in found.trajectory.samples(rate) {
        let _ = write!(text, "{:.6}", sample.t);
        for value in sample.q.iter().chain(&sample.qd).chain(&sample.qdd) {
            let _ = write!(text, ",{value:.7}");
        }
        text.push('\n');
    }
    text
}
