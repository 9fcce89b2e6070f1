//! The order in which the runs of a suite were recorded.

use std::collections::BTreeMap;
use std::path::Path;

use crate::defect::Defect;
use crate::text::quoted;

const REMEDY: &str = "number the runs of a suite 1, 2, 3, ... in the order in which they were \
                      recorded, or omit the column";

/// The order of a run in a line of the index.
pub(crate) struct WrittenOrder<'a> {
    /// Suite, and kind of a run without a suite. Runs with equal groups are counted together.
    pub group: (Option<&'a str>, Option<&'a str>),
    /// Line in the index, from 1.
    pub line: u64,
    /// Entry of the column `order`.
    pub order: Option<&'a str>,
    /// Entry of the column `repeat`.
    pub repeat: Option<&'a str>,
}

/// Returns the place of each run in the order of its group, from 1.
///
/// The column `order` decides. Without it, `repeat` does where it numbers all runs of the group,
/// and otherwise the order of the lines does.
///
/// # Errors
///
/// A defect for each entry of `order` that is missing, no number from 1, or given twice.
pub(crate) fn orders(index: &Path, runs: &[WrittenOrder]) -> Result<Vec<u64>, Vec<Defect>> {
    let mut groups: BTreeMap<_, Vec<usize>> = BTreeMap::new();
    for (at, run) in runs.iter().enumerate() {
        groups.entry(run.group).or_default().push(at);
    }
    let (mut found, mut defects) = (vec![0; runs.len()], Vec::new());
    for members in groups.values() {
        let places = if members.iter().any(|&at| runs[at].order.is_some()) {
            let written = strict(index, runs, members);
            written.unwrap_or_else(|found| {
                defects.extend(found);
                vec![0; members.len()]
            })
        } else {
            repeats(runs, members).unwrap_or_else(|| (1..=members.len() as u64).collect())
        };
        members.iter().zip(places).for_each(|(&at, place)| found[at] = place);
    }
    if defects.is_empty() { Ok(found) } else { Err(defects) }
}

/// Returns the entries of `order` of a group.
fn strict(index: &Path, runs: &[WrittenOrder], members: &[usize]) -> Result<Vec<u64>, Vec<Defect>> {
    let (mut first, mut places, mut defects) = (BTreeMap::new(), Vec::new(), Vec::new());
    for &at in members {
        let WrittenOrder { line, order, .. } = runs[at];
        let text = order.unwrap_or_default();
        let problem = match place(text) {
            None if text.is_empty() => {
                "order is empty, but other runs of the suite have one".to_string()
            }
            None => format!("order is {}, not a whole number from 1", quoted(text)),
            Some(place) => match first.insert(place, line) {
                Some(before) => {
                    format!("order {place} is given to a run of the suite on line {before} already")
                }
                None => {
                    places.push(place);
                    continue;
                }
            },
        };
        defects.push(Defect::new(index, Some(line), problem, REMEDY));
    }
    if defects.is_empty() { Ok(places) } else { Err(defects) }
}

/// Returns the entries of `repeat` of a group where they number all of its runs.
fn repeats(runs: &[WrittenOrder], members: &[usize]) -> Option<Vec<u64>> {
    let places: Option<Vec<u64>> =
        members.iter().map(|&at| runs[at].repeat.and_then(place)).collect();
    places.filter(|places| {
        let distinct: std::collections::BTreeSet<_> = places.iter().collect();
        distinct.len() == places.len()
    })
}

fn place(text: &str) -> Option<u64> {
    text.parse().ok().filter(|place| *place >= 1)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{WrittenOrder, orders};

    /// Returns the orders, or the defects as text, of runs given as suite, order and repeat.
    fn found(runs: &[(&str, &str, &str)]) -> Result<Vec<u64>, String> {
        let mut written = Vec::new();
        for (line, &(suite, order, repeat)) in (2..).zip(runs) {
            let [suite, order, repeat] =
                [suite, order, repeat].map(|text| Some(text).filter(|text| !text.is_empty()));
            written.push(WrittenOrder { group: (suite, None), line, order, repeat });
        }
        orders(Path::new("runs.csv"), &written)
            .map_err(|defects| defects.iter().map(|defect| format!("{defect}\n")).collect())
    }

    #[test]
    fn order_wins_over_repeat_and_repeat_over_the_lines() {
        let runs = [("A", "7", "1"), ("A", "3", "2"), ("B", "", "2"), ("B", "", "1")];
        assert_eq!(found(&runs).unwrap(), [7, 3, 2, 1]);
        let lines = [("A", "", ""), ("B", "", "1"), ("A", "", ""), ("B", "", "1"), ("", "", "x")];
        assert_eq!(found(&lines).unwrap(), [1, 1, 2, 2, 1]);
    }

    #[test]
    fn an_order_that_orders_nothing_is_a_defect_with_its_line() {
        let runs = [("A", "1", ""), ("A", "", ""), ("A", "1", ""), ("B", "0", ""), ("C", "x", "")];
        let problems = found(&runs).unwrap_err();
        for part in [
            "runs.csv:3: order is empty, but other runs of the suite have one",
            "runs.csv:4: order 1 is given to a run of the suite on line 2 already",
            "runs.csv:5: order is \"0\", not a whole number from 1",
            "runs.csv:6: order is \"x\", not a whole number from 1",
        ] {
            assert!(problems.contains(part), "{part} is not in {problems}");
        }
        assert_eq!(problems.lines().count(), 4);
    }
}
