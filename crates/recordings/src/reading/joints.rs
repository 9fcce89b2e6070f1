//! Which column belongs to which joint.

use std::collections::BTreeMap;

use super::name::{ColumnName, words};
use super::options::LoggedOptions;

/// A column of a file of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Column {
    /// Number of the file, from 0.
    pub file: usize,
    /// Number of the column in the file, from 0.
    pub at: usize,
    pub text: String,
    pub name: ColumnName,
}

/// The joints that columns are matched with.
#[derive(Debug, Clone, Default)]
pub(super) struct Joints {
    /// Names in the order of the result.
    pub names: Vec<String>,
    /// For each joint, its place among numbered columns.
    pub places: Vec<usize>,
    /// Number of the first joint in numbered columns; 0 or 1 where it is `None`.
    pub first: Option<usize>,
}

/// Columns that are not one for each joint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Mismatch {
    /// No column names these joints (from 0), but others do.
    Missing(Vec<usize>),
    /// Two columns are of one joint.
    Twice([String; 2]),
    /// Numbered columns are not as many as the joints.
    Count(Vec<String>),
}

/// A column for each joint, and the columns of no joint.
pub(super) type Matched = (Vec<Column>, Vec<Column>);

impl Joints {
    /// Returns the joints of the robot, if one is given.
    pub(super) fn of_robot(options: &LoggedOptions) -> Option<Self> {
        let joints = options.robot?;
        let names: Vec<String> = joints.iter().map(|joint| joint.name.clone()).collect();
        let given = options.joints;
        if given.len() == names.len() && !given.iter().all(|name| names.contains(name)) {
            // The log has other names than the robot.
            let places = (0..given.len()).collect();
            return Some(Self { names: given.to_vec(), places, first: options.columns.first });
        }
        let place = |(at, name): (usize, &String)| {
            options.joints.iter().position(|other| other == name).unwrap_or(at)
        };
        let places = names.iter().enumerate().map(place).collect();
        Some(Self { names, places, first: options.columns.first })
    }

    /// Keeps the joints that are named, if there are names, or else the joints of the columns with
    /// commands, if these are given.
    pub(super) fn choose(&mut self, names: &[String], commands: Option<&[Column]>) {
        let commanded = commands.map(|columns| self.matched(columns));
        if !names.is_empty() {
            self.names = names.to_vec();
        } else if let Some(Err(Mismatch::Missing(missing))) = commanded {
            missing.iter().rev().for_each(|joint| drop(self.names.remove(*joint)));
        }
        // Numbered columns are in the order of their numbers.
        let number = |name: &String| name.parse::<usize>().ok();
        self.places = match self.names.iter().map(number).collect::<Option<Vec<_>>>() {
            Some(all) => all.iter().map(|own| all.iter().filter(|n| *n < own).count()).collect(),
            None => (0..self.names.len()).collect(),
        };
    }

    /// Returns one of the columns for each joint: by the joints' names, or else by numbers.
    pub(super) fn matched(&self, columns: &[Column]) -> Result<Matched, Mismatch> {
        let named = self.by_name(columns);
        if named.is_ok() {
            return named;
        }
        let numbered = self.by_number(columns)?;
        match (numbered, named) {
            (Some(matched), _) => Ok(matched),
            (None, Err(mismatch)) => Err(mismatch),
            (None, Ok(matched)) => Ok(matched),
        }
    }

    fn by_name(&self, columns: &[Column]) -> Result<Matched, Mismatch> {
        let full: Vec<Vec<String>> = self.names.iter().map(|name| words(name)).collect();
        let short: Vec<Vec<String>> = full.iter().map(|words| without_joint(words)).collect();
        let mut found: Vec<Option<&Column>> = vec![None; full.len()];
        let mut others = Vec::new();
        for column in columns {
            let best = [&full, &short].into_iter().find_map(|names| {
                let named = (0..names.len()).filter(|joint| column.name.contains(&names[*joint]));
                named.max_by_key(|joint| names[*joint].len())
            });
            let Some(joint) = best else {
                others.push(column.clone());
                continue;
            };
            if let Some(other) = found[joint].replace(column) {
                return Err(Mismatch::Twice([other.text.clone(), column.text.clone()]));
            }
        }
        let missing: Vec<usize> = (0..found.len()).filter(|i| found[*i].is_none()).collect();
        if missing.is_empty() {
            Ok((found.into_iter().flatten().cloned().collect(), others))
        } else if missing.len() < found.len() {
            Err(Mismatch::Missing(missing))
        } else {
            Err(Mismatch::Count(columns.iter().map(|column| column.text.clone()).collect()))
        }
    }

    /// Returns `None` if no series of columns counts the joints.
    fn by_number(&self, columns: &[Column]) -> Result<Option<Matched>, Mismatch> {
        let mut series: BTreeMap<Vec<&str>, BTreeMap<usize, &Column>> = BTreeMap::new();
        for column in columns {
            let Some(number) = column.name.number() else { continue };
            let of_series = series.entry(column.name.series()).or_default();
            if let Some(other) = of_series.insert(number, column) {
                return Err(Mismatch::Twice([other.text.clone(), column.text.clone()]));
            }
        }
        let counts = |numbers: &BTreeMap<usize, &Column>| {
            let first = *numbers.keys().next().unwrap_or(&0);
            let last = *numbers.keys().last().unwrap_or(&0);
            let from = self.first.map_or(first <= 1, |from| first == from);
            from && numbers.len() == self.names.len() && last + 1 - first == numbers.len()
        };
        let mut fitting = series.values().filter(|numbers| counts(numbers));
        let Some(numbers) = fitting.next() else { return Ok(None) };
        let in_order: Vec<&Column> = numbers.values().copied().collect();
        if let Some(other) = fitting.next().and_then(|other| other.values().next()) {
            return Err(Mismatch::Twice([in_order[0].text.clone(), other.text.clone()]));
        }
        let chosen: Vec<Column> =
            self.places.iter().map(|place| in_order[*place].clone()).collect();
        let others = columns.iter().filter(|column| !chosen.contains(column)).cloned();
        let others = others.collect();
        Ok(Some((chosen, others)))
    }
}

/// Returns the columns whose names are `pattern` with a number in place of `{}`, in the order of
/// the numbers, which follow one another from `first` on, or from 0 or 1. A pattern without `{}` is
/// the name of one column.
pub(super) fn by_pattern(columns: &[Column], pattern: &str, first: Option<usize>) -> Vec<Column> {
    let Some((before, after)) = pattern.split_once("{}") else {
        return columns.iter().filter(|column| column.text == pattern).cloned().collect();
    };
    let number = |column: &Column| -> Option<usize> {
        column.text.strip_prefix(before)?.strip_suffix(after)?.parse().ok()
    };
    let column = |wanted: usize| columns.iter().find(|column| number(column) == Some(wanted));
    let first = first.unwrap_or_else(|| usize::from(column(0).is_none()));
    (first..).map_while(column).cloned().collect()
}

/// Returns the words of a joint's name without "joint", which logs often omit. The result is empty
/// if the name has no other word.
fn without_joint(words: &[String]) -> Vec<String> {
    let rest: Vec<String> = words.iter().filter(|word| *word != "joint").cloned().collect();
    let is_word = |word: &String| word.len() > 1 && word.parse::<usize>().is_err();
    if rest.iter().any(is_word) { rest } else { Vec::new() }
}

/// Returns names in few words: a series by its ends, and at most three others.
pub(super) fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let stem = |name: &str| words(name).into_iter().filter(|w| w.parse::<usize>().is_err());
    let mut groups: Vec<Vec<&str>> = Vec::new();
    for name in names {
        match groups.last_mut() {
            Some(group) if stem(group[0]).eq(stem(name)) => group.push(name),
            _ => groups.push(vec![name]),
        }
    }
    let parts: Vec<String> = groups
        .iter()
        .flat_map(|group| match group[..] {
            [first, _, .., last] => vec![format!("{first} to {last}")],
            _ => group.iter().map(|name| (*name).to_string()).collect(),
        })
        .collect();
    match parts.len() {
        0..=8 => parts.join(", "),
        count => format!("{} and {} more", parts[..8].join(", "), count - 8),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(names: &[&str]) -> Vec<Column> {
        let column = |(at, text): (usize, &&str)| Column {
            file: 0,
            at,
            text: (*text).into(),
            name: ColumnName::new(text),
        };
        names.iter().enumerate().map(column).collect()
    }

    fn matched(joints: &[&str], names: &[&str]) -> Result<Vec<usize>, Mismatch> {
        let joints = Joints {
            names: joints.iter().map(|name| (*name).into()).collect(),
            places: (0..joints.len()).collect(),
            first: None,
        };
        let (found, _) = joints.matched(&columns(names))?;
        Ok(found.iter().map(|column| column.at).collect())
    }

    #[test]
    fn joints_are_found_by_name_or_by_number() {
        let arm = ["arm_1_joint", "arm_2_joint"];
        let swapped = ["arm_2_joint_position", "arm_1_joint_position", "head_joint_position"];
        assert_eq!(matched(&arm, &swapped), Ok(vec![1, 0]));
        assert_eq!(matched(&arm, &["actual_q_1", "actual_q_0"]), Ok(vec![1, 0]));
        // Numbers from 0 of joints with numbers from 1 in their names.
        let joints = ["joint1", "joint2", "joint3"];
        assert_eq!(matched(&joints, &["q_joint_0", "q_joint_1", "q_joint_2"]), Ok(vec![0, 1, 2]));
        assert_eq!(
            matched(&["elbow_joint", "wrist_joint"], &["wrist_pos", "elbow_pos"]),
            Ok(vec![1, 0])
        );
    }

    #[test]
    fn columns_that_are_not_one_for_each_joint_are_a_mismatch() {
        let arm = ["arm_1_joint", "arm_2_joint"];
        assert_eq!(matched(&arm, &["arm_1_joint_pos"]), Err(Mismatch::Missing(vec![1])));
        let counted = matched(&arm, &["q0", "q1", "q2"]);
        assert!(matches!(counted, Err(Mismatch::Count(names)) if names.len() == 3));
        let twice = matched(&arm, &["left_q_1", "left_q_2", "right_q_1", "right_q_2"]);
        assert!(matches!(twice, Err(Mismatch::Twice(_))));
    }

    #[test]
    fn names_are_listed_in_few_words() {
        assert_eq!(listed(["q_0", "q_1", "q_2", "mode"]), "q_0 to q_2, mode");
        assert_eq!(listed(["a", "b"]), "a, b");
    }

    #[test]
    fn numbers_stand_in_place_of_the_braces() {
        let names = ["m2_pos", "m1_pos", "m3_pos", "m5_pos", "other"];
        let columns = columns(&names);
        let found = |pattern, first| -> Vec<usize> {
            by_pattern(&columns, pattern, first).iter().map(|column| column.at).collect()
        };
        assert_eq!(found("m{}_pos", None), [1, 0, 2]);
        assert_eq!(found("m{}_pos", Some(5)), [3]);
        assert_eq!(found("m{}_pos", Some(0)), [0; 0]);
        assert_eq!(found("other", None), [4]);
    }
}
