//! Names of output files.

use std::collections::HashSet;

use reachtube::conform::SuiteReach;
use reachtube::export::ExportCase;
use reachtube::page::SuiteFigure;

/// Returns one file name for each reachable set: the suite's name, with the run's where runs have
/// nominal solutions of their own. The names are distinct and contain no path separators.
pub(crate) fn of_reach(reach: &[SuiteReach]) -> Vec<String> {
    distinct(reach.iter().map(SuiteReach::name), &["", "_tube"])
}

/// Returns one file name for the figures of each suite.
pub(crate) fn of_figures(figures: &[SuiteFigure]) -> Vec<String> {
    distinct(figures.iter().map(|figure| figure.suite.clone()), &["_motion", "_deviation"])
}

/// Returns one folder name for each exported case.
pub(crate) fn of_cases(cases: &[ExportCase]) -> Vec<String> {
    distinct(cases.iter().map(|case| case.reach.name()), &[""])
}

/// Makes names distinct, ignoring case, with each of the endings appended too.
fn distinct(names: impl Iterator<Item = String>, endings: &[&str]) -> Vec<String> {
    let mut taken = HashSet::new();
    let mut choose = |name: String| {
        let name = path_safe(&name);
        let numbered = (2..).map(|number| format!("{name}_{number}"));
        let free =
            |name: &String| endings.iter().all(|ending| !taken.contains(&lower(name, ending)));
        let chosen = std::iter::once(name.clone()).chain(numbered).find(free).unwrap_or_default();
        taken.extend(endings.iter().map(|ending| lower(&chosen, ending)));
        chosen
    };
    names.map(&mut choose).collect()
}

fn lower(name: &str, ending: &str) -> String {
    format!("{name}{ending}").to_lowercase()
}

fn path_safe(name: &str) -> String {
    let safe = |c: char| if c.is_alphanumeric() || "-_.+ ".contains(c) { c } else { '_' };
    let name: String = name.chars().map(safe).collect();
    if name.starts_with('.') { name.replacen('.', "_", 1) } else { name }
}

#[cfg(test)]
mod tests {
    use super::distinct;

    #[test]
    fn names_stay_in_the_folder_and_apart() {
        let names = ["A", "a", "A_tube", "../A", "", "A"].map(String::from);
        let chosen = distinct(names.into_iter(), &["", "_tube"]);
        assert_eq!(chosen, ["A", "a_2", "A_tube_2", "_._A", "", "A_3"]);
    }
}
