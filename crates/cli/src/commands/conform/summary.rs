//! The text that `conform` prints.

use std::fmt::Write;

use reachtube::Model;
use reachtube::conform::{Enclosure, Equations, MOST_TIGHT, Notion, Witness};
use reachtube::recordings::State;
use reachtube::units::ColumnUnit;
use reachtube_robot::JointKind;

use super::dependence::dependence;
use super::fit_summary::{any_run, fit_summary};
use super::next_motion::next_motion;
use crate::table::{plural, table};
use crate::verdict::{lost, notion_words, traces};
use reachtube::number::{four_decimals, interval};

/// Largest number of touching values in the table.
const MOST_PLACES: usize = 6;

/// Returns the result of `conform`, with a table like Table II of the paper.
pub(crate) fn summary(model: &Model) -> String {
    let mut text = verdict(model);
    let _ = writeln!(text, "{}\n", cost(model));
    text.push_str(&sets(model));
    text.push_str(&sensor_noise(model));
    let _ = writeln!(text, "{}", explained(model));
    for warning in &model.warnings {
        let _ = writeln!(text, "warning: {}", warning.text);
    }
    text.push_str(&fit_summary(model));
    text.push_str(&any_run(model));
    text.push_str(&touching(model));
    if let Some((explained, tolerance)) = model.explained.as_ref().zip(model.settings.explain) {
        let _ = writeln!(text, "\n{}", explained.words(tolerance, &model.robot.kinds()));
    }
    text.push_str(&next_motion(model));
    text.push_str(&dependence(model));
    text
}

/// Returns the verdict, and the sets and motions that speak against it.
fn verdict(model: &Model) -> String {
    let (suites, proof) = (model.data.suites.len(), &model.proof);
    let runs: usize = model.data.run_count();
    let how = match proof.enclosure {
        Enclosure::Inner => "proved with directed rounding",
        Enclosure::Outer => "lie in the computed outer set, an enclosure with directed rounding",
    };
    let mut text = format!(
        "{}: {runs} {} in {suites} {}; {} of {} rows (suite, sample, state) {how}, at \
         samples\n",
        outcome(model),
        plural(runs, "recording"),
        plural(suites, "suite"),
        proof.rows - proof.violations.count,
        proof.rows
    );
    if let Some(points) = &proof.points {
        let _ = writeln!(
            text,
            "{} of {} recorded points ({}) proved to lie in the {}",
            points.points - points.unproved,
            points.points,
            notion_words(points.notion),
            proof.enclosure.set_name()
        );
    }
    if let Some(found) = &proof.traces {
        let _ = writeln!(text, "{}", traces(found, runs, model.settings.disturbance));
    }
    for set in &proof.lost {
        let _ = writeln!(text, "{}", lost(set));
    }
    if let Some((case, time)) = model.search.as_ref().and_then(|search| search.runs_away.as_ref()) {
        let _ = writeln!(
            text,
            "{case}: a simulated motion under nearly these sets diverged before {time:.3} s; the \
             model is unstable there"
        );
    }
    text
}

fn outcome(model: &Model) -> &'static str {
    match (model.verified, model.gap_of_not_minimal()) {
        (false, _) => "NOT PROVED conformant",
        (true, Some(_)) => "conformant, not minimal",
        (true, None) => "conformant",
    }
}

/// Returns the cost of the sets and its distance from the optimum, where that is known.
fn cost(model: &Model) -> String {
    let Some(cost) = model.cost else {
        return "no cost: a reachable set could not be computed to the end".into();
    };
    let quality = match (model.cost_lower_bound, &model.search) {
        (Some(bound), _) => {
            let optimal = match (model.gap_of_not_minimal(), model.optimality_gap) {
                (Some(gap), _) if model.settings.notion == Notion::Trace => format!(
                    "NOT the smallest: all of U was widened by one factor until motions of the \
                     model passed through the recordings; {gap:.1e} of the bound above it"
                ),
                (Some(gap), _) => format!(
                    "NOT the smallest: the solver stopped {gap:.1e} of the bound above it, so \
                     smaller sets may enclose the recordings"
                ),
                (None, Some(gap)) if gap > 0.0 => format!("optimal to a relative {gap:.0e}"),
                (None, _) => "optimal".into(),
            };
            format!(" ({optimal}; lower bound {})", four_decimals(bound))
        }
        (None, Some(search)) => format!(
            " ({}{} {}, the reachable sets of all suites computed {} {})",
            search
                .linearised_cost
                .map(|cost| format!("{} for the linearised sets; ", four_decimals(cost)))
                .unwrap_or_default(),
            search.rounds,
            plural(search.rounds, "round"),
            search.reachable_sets,
            plural(search.reachable_sets, "time")
        ),
        (None, None) if model.calibration.is_some() => " (calibrated, not the smallest)".into(),
        (None, None) => String::new(),
    };
    format!(
        "cost {}{quality}: weighted widths of the reachable sets, summed over states and samples",
        four_decimals(cost)
    )
}

/// Returns the sets joint by joint, as in Table II of the paper.
fn sets(model: &Model) -> String {
    let n = model.joints();
    let kinds = model.robot.kinds();
    let units = [JointKind::position_unit, JointKind::velocity_unit, JointKind::force_unit];
    let [q, qd, u] = units.map(|unit| ColumnUnit::new(&kinds, unit));
    let mut header = vec!["joint".into(), q.head("X0 q"), qd.head("X0 qd"), u.head("U")];
    if model.noise_set.is_some() {
        header.extend([q.head("V q"), qd.head("V qd")]);
    }
    let row = |joint: usize| {
        let mut row = vec![
            model.robot.joints[joint].name.clone(),
            q.cell(joint, interval(model.initial_set.bounds(joint))),
            qd.cell(joint, interval(model.initial_set.bounds(n + joint))),
            u.cell(joint, interval(model.input_set.bounds(joint))),
        ];
        if let Some(noise) = &model.noise_set {
            row.push(q.cell(joint, interval(noise.bounds(joint))));
            row.push(qd.cell(joint, interval(noise.bounds(n + joint))));
        }
        row
    };
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    table(&header, &(0..n).map(row).collect::<Vec<_>>())
}

/// Returns the noise of the sensors, where it limits V or X0.
fn sensor_noise(model: &Model) -> String {
    let Some(noise) = &model.sensor_noise else { return String::new() };
    let (q, qd) = noise.radius.split_at(model.joints());
    let kinds = model.robot.kinds();
    let [position, velocity] = [JointKind::position_unit, JointKind::velocity_unit]
        .map(|unit| JointKind::units(&kinds, unit));
    let list = |radii: &[f64]| {
        radii.iter().map(|radius| format!("{radius:.1e}")).collect::<Vec<_>>().join(" ")
    };
    let source = if noise.estimated {
        "estimated from the recordings, 5 standard deviations"
    } else {
        "given"
    };
    format!("sensor noise ({source}): q {} {position}; qd {} {velocity}\n", list(q), list(qd))
}

/// Returns how much of the motion the nominal solutions explain, joint by joint.
fn explained(model: &Model) -> String {
    let (q, qd) = model.nominal_explains.split_at(model.joints());
    let list = |parts: &[Option<f64>]| {
        let percent = |part: &Option<f64>| match part {
            Some(part) if *part > 0.0 => format!("{:.1}", 100.0 * part),
            Some(_) => "0".into(),
            None => "-".into(),
        };
        parts.iter().map(percent).collect::<Vec<_>>().join(" ")
    };
    let errors = model.input_error.iter().map(|error| format!("{error:.2}"));
    let kinds = model.robot.kinds();
    let by = match model.settings.equations {
        Equations::Model => "",
        Equations::Robot => ", by the robot's own equations",
    };
    format!(
        "variance explained by the nominal motions{by}: q {} %; qd {} %\n\
         error of the input that the robot predicts, root mean square: {} {}",
        list(q),
        list(qd),
        errors.collect::<Vec<_>>().join(" "),
        JointKind::units(&kinds, JointKind::force_unit)
    )
}

/// Returns the recorded values that touch the reachable sets.
fn touching(model: &Model) -> String {
    let set = match model.proof.enclosure {
        Enclosure::Inner => "the reachable set",
        Enclosure::Outer => "the linearised set",
    };
    let count = match model.tight.len() {
        1 => "1 recorded value touches".into(),
        MOST_TIGHT => format!("{MOST_TIGHT} or more recorded values touch"),
        count => format!("{count} recorded values touch"),
    };
    let decide = if model.tight.len() == 1 { "decides" } else { "decide" };
    format!(
        "\n{count} {set} and {decide} X0 and U:\n{}",
        places(&model.tight, &model.robot.kinds())
    )
}

fn places(places: &[Witness], kinds: &[JointKind]) -> String {
    // Margins of both units stand in one column.
    let is_plain = kinds.iter().all(|kind| *kind == JointKind::Revolute);
    let unit = |state: &State| match is_plain {
        true => String::new(),
        false => format!(" {}", state.kind.unit(kinds[state.joint])),
    };
    let row = |place: &Witness| {
        vec![
            place.run.clone(),
            format!("{:.3} s", place.time),
            place.state.to_string(),
            format!("{:?}", place.side).to_lowercase(),
            format!("{:.1e}{}", 0.0 - place.excess, unit(&place.state)),
        ]
    };
    let rows: Vec<_> = places.iter().take(MOST_PLACES).map(row).collect();
    let margin = if is_plain { "margin [rad, rad/s]" } else { "margin" };
    let mut text = table(&["run", "time", "state", "side", margin], &rows);
    if places.len() > MOST_PLACES {
        let _ = writeln!(text, "  and {} more; --json lists all", places.len() - MOST_PLACES);
    }
    text
}

#[cfg(test)]
mod tests {
    use reachtube::conform::Trust;
    use reachtube::{
        Keep, MemoryRuns, Model, Problem, Robot, Run, Settings, Setup, Silent, Torque, conform,
    };

    use super::summary;

    /// Two runs of the arm at rest, a little apart.
    fn problem() -> Problem {
        let mut runs = MemoryRuns::default();
        for offset in [0.0, 0.001] {
            let states = [vec![offset; 6], vec![0.0; 6]].concat().repeat(3);
            let run = Run::new(6, vec![0.0, 0.004, 0.008], states, vec![0.0; 18]).unwrap();
            runs.push(&format!("run{offset}"), Some("A"), None, run);
        }
        let setup = Setup::new(Robot::lwa4p(), Settings::new(Torque::Compensated, 6)).unwrap();
        Problem::read(setup, Box::new(runs), &[], Keep::Needed, &Silent).unwrap()
    }

    #[test]
    fn an_unsolved_program_is_not_reported_as_solved() {
        let problem = problem();
        let mut model = Model::new(&problem, &conform(&problem, &Silent, None).unwrap());
        let solved = summary(&model);
        assert!(solved.starts_with("conformant: ") && solved.contains("(optimal"), "{solved}");
        model.optimality_gap = Some(29.0);
        model.trust = Trust::without_optimum(problem.recordings(), 29.0);
        let unsolved = summary(&model);
        for part in ["conformant, not minimal: ", "NOT the smallest", "2.9e1", "no scenario bound"]
        {
            assert!(unsolved.contains(part), "{part} is not in\n{unsolved}");
        }
    }
}
