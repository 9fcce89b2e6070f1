//! The tables beside every export: our bounds, and the recorded input.

use std::fmt::Write;

use super::ExportFile;
use super::case::ExportCase;
use super::draws::Draws;
use super::text::{number, numbers};

/// Number of points at which `check_points.csv` has ẋ.
const CHECK_POINTS: usize = 1000;

/// Returns `bounds.csv`, `tube.csv` and `inputs.csv`.
pub(super) fn files(case: &ExportCase) -> Vec<ExportFile> {
    let text = |write: &dyn Fn(&mut dyn std::io::Write) -> std::io::Result<()>| {
        let mut bytes = Vec::new();
        write(&mut bytes).expect("memory takes every byte");
        String::from_utf8(bytes).expect("a table is text")
    };
    vec![
        ExportFile::new("bounds.csv", text(&|out| case.reach.write_samples(out))),
        ExportFile::new("tube.csv", text(&|out| case.reach.write_tube(out))),
        ExportFile::new("inputs.csv", inputs(case)),
    ]
}

/// Returns the recorded input: `t,u1,...`, held from each row's time to the next row's.
fn inputs(case: &ExportCase) -> String {
    let mut text = format!("t,{}\n", case.system.inputs.join(","));
    for (k, t) in case.grid.times().iter().enumerate() {
        let _ = writeln!(text, "{},{}", number(*t), numbers(case.input(k).iter().copied(), ","));
    }
    text
}

/// Returns `check_points.csv`: random states and inputs with ẋ as reachtube evaluates it, one
/// column per state, input and derivative.
pub(super) fn check_points(case: &ExportCase) -> ExportFile {
    let (n, system) = (case.joints(), &case.system);
    let mut draws = Draws::seeded(1);
    let mut draw = |radius: f64| draws.vector(n, radius);
    let rates = system.states.iter().map(|name| format!("{name}_rate"));
    let head: Vec<String> =
        system.states.iter().chain(&system.inputs).cloned().chain(rates).collect();
    let mut text = head.join(",") + "\n";
    for _ in 0..CHECK_POINTS {
        let (q, qd, u) = (draw(3.0), draw(2.0), draw(50.0));
        let x = system.state(&q, &qd);
        let row = [x.as_slice(), &u, &system.rate(&x, &u)].concat();
        let _ = writeln!(text, "{}", numbers(row, ","));
    }
    ExportFile::new("check_points.csv", text)
}
