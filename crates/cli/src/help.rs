//! Help on one screen: usage, an example, and the options used most. `--help-all` has the rest.
//!
//! Each command defines one text of examples and remarks after its options. The manual pages print
//! it as it is, and the reference its exit codes. Here it becomes the two screens. Options that are
//! rare are hidden from the first by `hide_short_help` where they are defined.

use std::ffi::OsString;
use std::fmt::Write;

use clap::{Arg, Command, CommandFactory};

use crate::cli::Cli;

/// Columns of a screen.
const WIDTH: usize = 100;

/// Number of examples on the first screen.
const FEW_EXAMPLES: usize = 2;

/// The commands in the order in which they are needed.
const GROUPS: &[(&str, &[&str])] = &[
    ("From logs to a model", &["model", "check", "inspect", "export", "report"]),
    ("Put the sets to use", &["verify", "stop", "monitor"]),
    (
        "The steps of `model`, one by one",
        &["identify", "prepare", "conform", "abstract", "reach", "excite", "convert"],
    ),
    ("The paper, and the rest", &["demo", "campaign", "reproduce", "robot", "completions", "man"]),
];

const TEMPLATE: &str =
    "{about-with-newline}\n{usage-heading} {usage}\n\n{before-help}{all-args}{after-help}";

/// The template of the first screen, which lists the commands in groups.
const FIRST: &str = "{about-with-newline}\n{usage-heading} {usage}\n\n{before-help}Options:\n\
                     {options}{after-help}";

/// Returns the command line with its help, for arguments that were typed.
pub(crate) fn command(line: &[OsString]) -> Command {
    let is_long = line.iter().any(|argument| argument == "--help-all");
    let mut root = below(Cli::command(), is_long).help_template(FIRST).max_term_width(WIDTH);
    let commands = groups(&root);
    let examples = |text: Option<&clap::builder::StyledStr>| {
        format!("{}\n\n{commands}", text.map(ToString::to_string).unwrap_or_default())
    };
    let short = examples(root.get_before_help());
    let long = examples(root.get_before_long_help());
    root = root.before_help(short).before_long_help(long);
    root
}

/// Gives a command and the commands below it their screens.
fn below(command: Command, is_long: bool) -> Command {
    let names: Vec<String> =
        command.get_subcommands().map(|below| below.get_name().to_string()).collect();
    let command = names.into_iter().fold(command, |command, name| {
        command.mut_subcommand(name, |command| below(command, is_long))
    });
    let command = match command.get_after_help().map(ToString::to_string) {
        Some(text) => with_examples(command, &text),
        None => command,
    };
    // Headings take half of the screen.
    let command = if is_long { command } else { command.mut_args(without_heading) };
    command.help_template(TEMPLATE)
}

fn without_heading(arg: Arg) -> Arg {
    if arg.is_global_set() { arg } else { arg.help_heading(None::<&str>) }
}

/// Puts the examples of a text before the options. The first screen has some of them, and the exit
/// codes.
fn with_examples(command: Command, text: &str) -> Command {
    let blocks = text.split("\n\n");
    let (examples, remarks): (Vec<&str>, Vec<&str>) =
        blocks.partition(|block| block.starts_with("Example"));
    let few: Vec<String> = examples.iter().map(|block| first_examples(block)).collect();
    let codes: Vec<&str> =
        remarks.iter().filter(|block| block.starts_with("Exit codes")).copied().collect();
    command
        .before_help(few.join("\n\n"))
        .before_long_help(examples.join("\n\n"))
        .after_help(codes.join("\n\n"))
        .after_long_help(remarks.join("\n\n"))
}

/// Returns the first examples of a block. A call begins two blanks from the left; what belongs to
/// it is further right.
fn first_examples(block: &str) -> String {
    let mut count = 0;
    let is_of_first = |line: &&str| {
        count += usize::from(line.starts_with("  ") && !line.starts_with("   "));
        count <= FEW_EXAMPLES
    };
    block.lines().take_while(is_of_first).collect::<Vec<_>>().join("\n")
}

/// Lists the commands in groups.
fn groups(root: &Command) -> String {
    let names = GROUPS.iter().flat_map(|(_, names)| *names);
    let width = names.map(|name| name.len()).max().unwrap_or_default();
    let mut text = String::new();
    for (title, names) in GROUPS {
        let _ = writeln!(text, "{title}:");
        for name in *names {
            let about = root.find_subcommand(name).and_then(Command::get_about);
            let about = about.map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "  {name:<width$}  {about}");
        }
    }
    text.trim_end().into()
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::{GROUPS, first_examples};
    use crate::cli::Cli;

    #[test]
    fn every_command_is_in_a_group() {
        let root = Cli::command();
        let mut all: Vec<&str> = root.get_subcommands().map(clap::Command::get_name).collect();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| *names).copied().collect();
        all.sort_unstable();
        grouped.sort_unstable();
        assert_eq!(grouped, all);
    }

    #[test]
    fn an_example_keeps_its_lines() {
        let block = "Examples:\n  a --x \\\n      --y\n      a note\n  b\n  c\n      more";
        assert_eq!(first_examples(block), "Examples:\n  a --x \\\n      --y\n      a note\n  b");
    }
}
