//! The interpretation of logs in words.

use std::path::Path;

use reachtube::recordings::Understood;

/// Number of names of columns that are listed.
const LISTED: usize = 6;

/// Describes each log, in one line if the log before it has the same columns and units.
pub(crate) fn understood(logs: &[Understood]) -> String {
    let mut text = String::new();
    let mut before = None;
    for log in logs {
        let columns = columns(log);
        text += &format!(
            "{}: {} samples, {:.3} s, {}",
            files(log),
            log.samples,
            log.duration,
            match log.separator {
                "messages" => "in messages".into(),
                separator => format!("separated by {separator}"),
            }
        );
        if before.as_ref() == Some(&columns) {
            text += ", columns as above\n";
        } else {
            text += &format!("\n{columns}");
        }
        before = Some(columns);
    }
    if !logs.is_empty() {
        text.push('\n');
    }
    text
}

/// Returns the path of the first file, and the names of the others.
fn files(log: &Understood) -> String {
    let name = |path: &String| {
        let name = Path::new(path).file_name().map(|name| name.to_string_lossy().into_owned());
        format!(" + {}", name.unwrap_or_default())
    };
    let (first, others) = log.files.split_first().expect("a log has a file");
    format!("{first}{}", others.iter().map(name).collect::<String>())
}

fn columns(log: &Understood) -> String {
    let [angle, speed] = log.angle_units;
    let ratio = log.ratio.map_or_else(String::new, |ratio| {
        format!("; q moves {ratio:.3} times as far as the integral of qd")
    });
    let qd = match log.qd[..] {
        [] => "none; differentiated from the positions".into(),
        _ => format!("{} [{speed}/s]{ratio}", listed(&log.qd)),
    };
    let tau = match log.torque {
        "measured" => listed(&log.tau),
        "demanded" => {
            format!("{} (demanded by the controller's model, not measured)", listed(&log.tau))
        }
        "current" => format!("{} (motor currents, which need gains)", listed(&log.tau)),
        _ => "none".into(),
    };
    let lines = [
        ("time", format!("{} [{}]", log.time, log.time_unit)),
        ("joints", listed(&log.joints)),
        ("q", format!("{} [{angle}]", listed(&log.q))),
        ("qd", qd),
        ("tau", tau),
        ("temp", listed(&log.temperature)),
        ("unused", listed(&log.unused)),
    ];
    let shown = lines.into_iter().filter(|(_, text)| !text.is_empty());
    shown.map(|(name, text)| format!("  {name:<8}{text}\n")).collect()
}

/// Lists names: all, or the first ones and the last.
fn listed(names: &[String]) -> String {
    match names {
        [some @ .., last] if names.len() > LISTED => {
            format!("{}, .., {last} ({})", some[..LISTED - 2].join(", "), names.len())
        }
        _ => names.join(", "),
    }
}
