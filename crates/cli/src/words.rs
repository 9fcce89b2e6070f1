//! Results in words and tables.

use std::fmt::Write;

use reachtube::Model;
use reachtube::abstraction::{ModelKind, PolynomialModel};
use reachtube::conform::MOST_TIGHT;
use reachtube::conform::{Check, Enclosure, Lost, Place, Trust};
use reachtube::recordings::{Group, Inspection};
use reachtube::reproduce::{Cell, Paper, Speed, Table1};

use crate::numbers::{interval, number};

/// A word for so many.
fn plural(count: usize, word: &str) -> String {
    format!("{word}{}", if count == 1 { "" } else { "s" })
}

/// A table with right-aligned columns, the first left-aligned.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count());
        cells.chain([header[column].chars().count()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(width).collect();
    let line = |cells: Vec<&str>| {
        let aligned = cells.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        format!("  {}\n", aligned.collect::<Vec<_>>().join("   ").trim_end())
    };
    let mut text = line(header.to_vec());
    rows.iter().for_each(|row| text.push_str(&line(row.iter().map(String::as_str).collect())));
    text
}

/// The result of `abstract`.
pub fn abstraction(model: &PolynomialModel, seconds: f64) -> String {
    let mut text = String::new();
    let point = model.expansion_point();
    let at = |name: &str, values: &[f64]| match values.iter().all(|v| *v == 0.0) {
        true => format!("{name} = 0"),
        false => format!("{name} = {values:?}"),
    };
    let _ = writeln!(
        text,
        "model {} of order {} of {}, about {} rad, {} rad/s, {} N m",
        u32::from(model.kind()),
        model.order(),
        model.robot().name,
        at("q", &point.q),
        at("qd", &point.qd),
        at("u", &point.input())
    );
    let _ = writeln!(
        text,
        "{} states, degree {}, {} terms, made in {}\n",
        model.states(),
        model.degree(),
        model.term_count(),
        duration(seconds)
    );
    let rows: Vec<Vec<String>> =
        (0..model.joints()).map(|i| joint_of_abstraction(model, i)).collect();
    match model.remainder() {
        Some(remainder) => {
            text.push_str(&table(&["joint", "terms", "left out [rad/s^2], proved", "seen"], &rows));
            let _ = writeln!(
                text,
                "\nleft out: forward dynamics minus model, over the box (cut into {}); seen: the largest that a search found in it",
                remainder.boxes
            );
        }
        None => text.push_str(&table(&["joint", "terms"], &rows)),
    }
    text
}

fn joint_of_abstraction(model: &PolynomialModel, i: usize) -> Vec<String> {
    let mut row = vec![
        model.robot().joints[i].name.clone(),
        model.acceleration()[i].term_count().to_string(),
    ];
    if let Some(remainder) = model.remainder() {
        let bound = remainder.bounds[i].map(|[low, high]| interval((low, high)));
        row.push(bound.unwrap_or_else(|| "no bound found".into()));
        row.push(number(remainder.seen[i]));
    }
    row
}

fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}

/// The result of `reproduce table1`, in the paper's layout.
pub fn table1(table: &Table1) -> String {
    let (options, [slow, fast]) = (&table.options, table.durations);
    let mut text = format!(
        "Table I for {}: mean |velocity error| over time and joints [rad/s], against articulated bodies\n\
         mean ± standard deviation over {} random point-to-point motions (seed {}) within {} rad of 0, {slow:.2} s (slow) and {fast:.2} s (fast) long, inputs held over 4 ms\n\n",
        table.robot,
        options.motions,
        options.seed,
        number(options.range)
    );
    let kinds = [ModelKind::One, ModelKind::Two, ModelKind::Three];
    let rows: Vec<Vec<String>> = options
        .orders
        .iter()
        .flat_map(|order| Speed::ALL.map(|speed| (*order, speed)))
        .map(|(order, speed)| {
            let cells = kinds.map(|kind| table1_cell(table.cell(kind, order, speed)));
            [order.to_string(), speed.name().into()]
                .into_iter()
                .chain(cells.into_iter().flatten())
                .collect()
        })
        .collect();
    let header = ["p", "speed", "model 1", "paper", "model 2", "paper", "model 3", "paper"];
    text.push_str(&self::table(&header, &rows));
    if options.orders.iter().any(|order| *order > options.model3_up_to) {
        let _ = writeln!(
            text,
            "\n-: left out; model 3 is simulated up to order {} (--model3-up-to)",
            options.model3_up_to
        );
    }
    text
}

/// Ours and the paper's number.
fn table1_cell(cell: Option<&Cell>) -> [String; 2] {
    let Some(cell) = cell else { return ["-".into(), String::new()] };
    let spread = cell.spread.map(|spread| format!(" ± {}", number(spread))).unwrap_or_default();
    let ours = match (cell.mean, cell.diverged) {
        (None, diverged) => format!("∞ ({diverged} diverged)"),
        (Some(mean), 0) => format!("{}{spread}", number(mean)),
        (Some(mean), diverged) => format!("{}{spread} ({diverged} diverged)", number(mean)),
    };
    let paper = match cell.paper {
        Some(Paper::Error(error)) => format!("{error:.4}"),
        Some(Paper::Diverged) => "∞".into(),
        None => String::new(),
    };
    [ours, paper]
}

/// The result of `conform`, with a table like Table II of the paper.
pub fn model(model: &Model) -> String {
    let runs: usize = model.data.suites.iter().map(|suite| suite.runs.len()).sum();
    let mut text = String::new();
    let verdict = if model.verified { "conformant" } else { "NOT PROVED conformant" };
    let (suites, proof) = (model.data.suites.len(), &model.proof);
    let how = match proof.enclosure {
        Enclosure::Inner => "proved with directed rounding",
        Enclosure::Outer => {
            "in the computed reachable set, an outer enclosure with directed rounding"
        }
    };
    let _ = writeln!(
        text,
        "{verdict}: {runs} {} in {suites} {}; {} of {} bounds (suite, sample, state, side) {how}, at samples",
        plural(runs, "recording"),
        plural(suites, "suite"),
        proof.proved,
        proof.rows
    );
    proof.lost.iter().for_each(|lost| text.push_str(&format!("{}\n", self::lost(lost))));
    if let Some((case, time)) = model.search.as_ref().and_then(|search| search.runs_away.as_ref()) {
        let _ = writeln!(
            text,
            "{case}: a simulated motion under nearly these sets ran away before {time:.3} s: the model is unstable there"
        );
    }
    let _ = writeln!(text, "{}\n", cost(model));
    text.push_str(&sets(model));
    let touched = match proof.enclosure {
        Enclosure::Inner => "the reachable set",
        Enclosure::Outer => "the linearised set",
    };
    let _ = writeln!(
        text,
        "\n{} {touched} and decide X0 and U:",
        match model.tight.len() {
            1 => "1 recorded value touches".into(),
            MOST_TIGHT => format!("{MOST_TIGHT} recorded values or more touch"),
            touching => format!("{touching} recorded values touch"),
        }
    );
    text.push_str(&places(&model.tight, 6));
    if let Some((explained, tolerance)) = model.explained.as_ref().zip(model.settings.explain) {
        let _ = writeln!(text, "\n{}", explained.words(tolerance));
    }
    let _ = writeln!(text, "\n{}", trust(&model.trust, "touch the set"));
    text
}

/// What the sets cost, and how near that is to the least.
fn cost(model: &Model) -> String {
    let Some(cost) = model.cost else { return "no cost: a reachable set was lost".into() };
    let widths = "weighted widths of the reachable set, summed over states and samples";
    match (model.cost_lower_bound, &model.search) {
        (Some(bound), _) => {
            let gap = match (cost - bound).max(0.0) / cost {
                part if part > 0.0 => format!("at most {part:.0e} above the least"),
                _ => "the least there is to the solver's accuracy".into(),
            };
            format!("cost {} ({widths}), {gap}", number(cost))
        }
        (None, Some(search)) => {
            let linearised = search
                .linearised_cost
                .map(|cost| format!(", {} of the linearised set", number(cost)));
            format!(
                "cost {} ({widths}){}; {} {}, the reachable sets of all suites computed {} {}",
                number(cost),
                linearised.unwrap_or_default(),
                search.rounds,
                plural(search.rounds, "round"),
                search.reachable_sets,
                plural(search.reachable_sets, "time")
            )
        }
        (None, None) => format!("cost {} ({widths})", number(cost)),
    }
}

/// Where a reachable set ended.
pub fn lost(lost: &Lost) -> String {
    format!(
        "{}: the reachable set could not be followed beyond {:.3} s, where {} grew fastest; what is recorded later is not enclosed (--until {:.3} leaves it out)",
        lost.case, lost.time, lost.state, lost.time
    )
}

/// The sets, joint by joint, as in Table II of the paper.
fn sets(model: &Model) -> String {
    let n = model.joints();
    let mut header = vec!["joint", "X0 q [rad]", "X0 qd [rad/s]", "U [N m]"];
    if model.noise_set.is_some() {
        header.extend(["V q [rad]", "V qd [rad/s]"]);
    }
    let row = |joint: usize| {
        let mut row = vec![
            model.robot.joints[joint].name.clone(),
            interval(model.initial_set.bounds(joint)),
            interval(model.initial_set.bounds(n + joint)),
            interval(model.input_set.bounds(joint)),
        ];
        if let Some(noise) = &model.noise_set {
            row.extend([interval(noise.bounds(joint)), interval(noise.bounds(n + joint))]);
        }
        row
    };
    table(&header, &(0..n).map(row).collect::<Vec<_>>())
}

fn places(places: &[Place], most: usize) -> String {
    let row = |place: &Place| {
        vec![
            place.run.clone(),
            format!("{:.3} s", place.time),
            place.state.clone(),
            format!("{:?}", place.side).to_lowercase(),
            format!("{:.1e}", 0.0 - place.excess),
        ]
    };
    let rows: Vec<_> = places.iter().take(most).map(row).collect();
    let mut text = table(&["run", "time", "state", "side", "inside by"], &rows);
    if places.len() > most {
        let _ = writeln!(text, "  and {} more, which --json lists", places.len() - most);
    }
    text
}

fn trust(trust: &Trust, role: &str) -> String {
    format!(
        "the next motion leaves the set with probability at most {:.3} (confidence {:.0} %): {} {}, {} of them {role};\n{}",
        trust.violation_probability,
        100.0 * trust.confidence,
        trust.motions,
        plural(trust.motions, "motion"),
        trust.deciding,
        trust.basis
    )
}

/// The result of `check`.
pub fn check(check: &Check) -> String {
    let mut text = String::new();
    let verdict = if check.conformant { "conformant" } else { "not conformant" };
    let _ = writeln!(
        text,
        "{verdict}: {} {}; {} of {} values (suite, sample, state) outside the reachable set\n",
        check.runs,
        plural(check.runs, "recording"),
        check.violations.count,
        check.rows
    );
    let row = |suite: &reachtube::conform::SuiteCheck| {
        vec![
            suite.suite.clone(),
            suite.runs.to_string(),
            suite.rows.to_string(),
            suite.violations.count.to_string(),
            suite.violations.worst.as_ref().map_or_else(|| "-".into(), witness),
        ]
    };
    let rows: Vec<_> = check.suites.iter().map(row).collect();
    text.push_str(&table(&["suite", "runs", "values", "outside", "furthest"], &rows));
    check.lost.iter().for_each(|lost| text.push_str(&format!("{}\n", self::lost(lost))));
    match &check.trust {
        Some(held_out) => {
            let _ = writeln!(text, "\n{}", trust(held_out, "leave the set"));
        }
        None => text.push_str(
            "\nthe model was fitted to some of these recordings: this says nothing about the next motion\n",
        ),
    }
    text
}

/// A place in one line.
pub fn witness(place: &Place) -> String {
    let unit = if place.state.starts_with("qd") { "rad/s" } else { "rad" };
    format!(
        "{} at {:.3} s: joint {}, {} {} {unit} beyond the {} side",
        place.run,
        place.time,
        place.joint,
        place.state,
        number(place.excess),
        format!("{:?}", place.side).to_lowercase()
    )
}

/// The result of `inspect`.
pub fn inspection(inspection: &Inspection) -> String {
    let (runs, joints) = (inspection.runs, inspection.joints);
    let (recordings, of) = (plural(runs, "recording"), plural(joints, "joint"));
    let mut text = format!("{}: {runs} {recordings} of {joints} {of}\n", inspection.folder);
    for group in &inspection.groups {
        text.push('\n');
        text.push_str(&group_words(group));
    }
    text.push_str(LEGEND);
    text
}

const LEGEND: &str = "
start, end: spread of the first and of the last positions over the runs, rad
drift: correlation of the last position with the order of the runs, near +1 or -1 where the robot changes, as it does warming up
sticks: samples slower than 0.01 rad/s
q - int qd: largest difference of q and the integral of qd, rad
";

fn group_words(group: &Group) -> String {
    let [fewest, most] = group.samples;
    let samples = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
    let rate = match group.step {
        _ if most == 1 => String::new(),
        Some(step) => format!(" every {step} s"),
        None => format!(" every {} to {} s", number(group.steps[0]), number(group.steps[1])),
    };
    let kind = if group.suite { "suite" } else { "no suite:" };
    let motion =
        group.motion.as_ref().map_or_else(String::new, |motion| format!(" (motion {motion})"));
    let torque = match group.same_torque {
        _ if group.runs == 1 => "",
        true => ", the same torques in all",
        false => ", torques or times differ",
    };
    let mut text = format!(
        "{kind} {}{motion}: {} {} of {samples} {}{rate}, {:.3} s{torque}\n",
        group.name,
        group.runs,
        plural(group.runs, "run"),
        plural(most, "sample"),
        group.duration
    );
    let row = |(index, joint): (usize, &reachtube::recordings::JointSummary)| {
        vec![
            (index + 1).to_string(),
            format!("[{:.3}, {:.3}]", joint.position[0], joint.position[1]),
            format!("{:.3}", joint.speed),
            format!("{:.2}", joint.torque),
            number(joint.start_spread),
            joint.end_spread.map_or_else(|| "-".into(), number),
            joint.drift.map_or_else(|| "-".into(), |drift| format!("{drift:+.2}")),
            format!("{:.0} %", 100.0 * joint.sticking),
            format!("{:.1e}", joint.integral_gap),
        ]
    };
    let rows: Vec<_> = group.joints.iter().enumerate().map(row).collect();
    let header = [
        "joint",
        "q [rad]",
        "|qd| [rad/s]",
        "|tau| [N m]",
        "start",
        "end",
        "drift",
        "sticks",
        "q - int qd",
    ];
    text.push_str(&table(&header, &rows));
    text
}
