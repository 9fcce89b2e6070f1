//! Messages that repeat for each file, on one line.

/// Endings of file names.
const ENDINGS: [&str; 3] = [".csv", ".mcap", ".db3"];

/// Number of names that a line lists.
const LISTED: usize = 3;

/// A message and the files or suites that it is about.
struct Group<'a> {
    /// The common part of the messages: their text without the name, and without numbers.
    common: String,
    first: &'a str,
    /// Each name once.
    names: Vec<&'a str>,
    /// Number of messages.
    count: usize,
}

/// Returns messages in their order, with one line in place of messages that differ in the file or
/// suite that they begin with, and in numbers. The line is the first message, with the count of
/// files and the first three names; of messages about one file, with their count.
pub(crate) fn folded(messages: &[String]) -> Vec<String> {
    let mut groups: Vec<Group> = Vec::new();
    for message in messages {
        let (name, rest) = subject(message);
        let common = without_numbers(rest);
        let known = groups.iter_mut().find(|group| !name.is_empty() && group.common == common);
        match known {
            Some(group) => group.add(name),
            None => groups.push(Group { common, first: message, names: vec![name], count: 1 }),
        }
    }
    groups.iter().map(Group::line).collect()
}

impl<'a> Group<'a> {
    fn add(&mut self, name: &'a str) {
        self.count += 1;
        if !self.names.contains(&name) {
            self.names.push(name);
        }
    }

    fn line(&self) -> String {
        let Self { first, names, count, .. } = self;
        if names.len() == 1 {
            let more = format!(" ({count} times)");
            return format!("{first}{}", if *count > 1 { &more } else { "" });
        }
        let (kind, skipped) = match names[0].strip_prefix(SUITE) {
            Some(_) => ("suites", SUITE.len()),
            None => ("files", 0),
        };
        let listed: Vec<&str> = names.iter().take(LISTED).map(|name| &name[skipped..]).collect();
        let more = if names.len() > LISTED { ", .." } else { "" };
        format!("{first} ({} {kind}: {}{more})", names.len(), listed.join(", "))
    }
}

/// Beginning of messages about a suite.
const SUITE: &str = "suite ";

/// Splits a message into the file or suite that it begins with and the rest; the name is empty if
/// there is none.
fn subject(message: &str) -> (&str, &str) {
    if message.starts_with(SUITE)
        && let Some(at) = message.find(": ")
    {
        return message.split_at(at);
    }
    let end = |ending: &str| {
        let at = message.find(ending)? + ending.len();
        message[at..].starts_with([':', ' ']).then_some(at)
    };
    match ENDINGS.iter().filter_map(|ending| end(ending)).min() {
        Some(at) => message.split_at(at),
        None => ("", message),
    }
}

/// Replaces each number by one sign.
fn without_numbers(text: &str) -> String {
    let mut common = String::new();
    for c in text.chars() {
        let is_of_number = c.is_ascii_digit() || (c == '.' && common.ends_with('#'));
        if !is_of_number {
            common.push(c);
        } else if !common.ends_with('#') {
            common.push('#');
        }
    }
    common
}

#[cfg(test)]
mod tests {
    use super::folded;

    fn of(messages: &[&str]) -> Vec<String> {
        folded(&messages.iter().map(ToString::to_string).collect::<Vec<_>>())
    }

    #[test]
    fn messages_of_several_files_are_one_line() {
        let found = of(&[
            "data/A_1.csv: joint 1: q moves 5.0 times as far",
            "data is not used",
            "data/A_2.csv: joint 1: q moves 15.25 times as far",
            "A_3.csv is not in runs.csv",
            "data/A_4.csv: joint 1: q moves 5 times as far",
            "data/A_5.csv: joint 1: q moves 1 times as far",
            "data is not used",
        ]);
        assert_eq!(
            found,
            [
                "data/A_1.csv: joint 1: q moves 5.0 times as far (4 files: data/A_1.csv, \
                 data/A_2.csv, data/A_4.csv, ..)",
                "data is not used",
                "A_3.csv is not in runs.csv",
                "data is not used",
            ]
        );
    }

    #[test]
    fn each_file_is_counted_once() {
        let [first, second, other] = [
            "a.csv: joint 1: q moves 5 times as far",
            "a.csv: joint 2: q moves 6 times as far",
            "b.csv: joint 2: q moves 6 times as far",
        ];
        assert_eq!(of(&[first, second]), ["a.csv: joint 1: q moves 5 times as far (2 times)"]);
        let found = of(&[first, second, other]);
        assert_eq!(found, ["a.csv: joint 1: q moves 5 times as far (2 files: a.csv, b.csv)"]);
    }

    #[test]
    fn messages_of_suites_are_one_line() {
        let found = of(&["suite A: it starts elsewhere", "suite M 1: it starts elsewhere"]);
        assert_eq!(found, ["suite A: it starts elsewhere (2 suites: A, M 1)"]);
    }

    #[test]
    fn other_messages_stay_apart() {
        let apart =
            ["a.csv: first", "a.csv: second", "b.csv: third", "mean 1", "mean 2", "x.csvs: first"];
        assert_eq!(of(&apart), apart);
    }
}
