//! The reference of all commands as one page of Markdown, from the definitions that clap parses by.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use clap::{Arg, Command};

/// Columns of the page.
const WIDTH: usize = 100;

const OPENING: &str = "\
# Command reference

`reachtube man --markdown` makes this page from the command's own definitions; a test compares the
two. `reachtube COMMAND --help-all` has examples and remarks too. [The reference](reference.md)
describes output, exit codes, findings and errors.

The exit code of every command is 0 for done, 1 for not conformant and 2 for an error. If a
command uses them otherwise, its section describes it.
";

const GLOBAL: &str = "Global options";

const SHARED: &str = "Shared options";

/// Number of commands from which on an option's text is printed once.
const SEVERAL: usize = 2;

/// Returns the page for a command line that was built.
pub(crate) fn markdown(command: Command) -> String {
    let mut page = OPENING.to_string();
    let _ = writeln!(page, "\n## {GLOBAL}\n\nEvery command has these options.\n");
    for arg in command.get_arguments().filter(|arg| arg.get_help_heading() == Some(GLOBAL)) {
        page += &item(arg);
    }
    let _ = writeln!(page, "\n## {SHARED}\n");
    let shared = [Shared::new(SHARED, &command)];
    shared[0].list(&mut page);
    for below in command.get_subcommands() {
        section(&mut page, below, "reachtube", &shared);
    }
    page
}

/// Options that several of the commands below a command have.
#[derive(Clone)]
struct Shared {
    /// Heading of the section that lists them.
    heading: String,
    /// The texts to print.
    texts: Vec<String>,
}

impl Shared {
    /// Finds the options. If an option has two texts, the more frequent one is taken.
    fn new(heading: &str, command: &Command) -> Self {
        let mut found: BTreeMap<(String, String), usize> = BTreeMap::new();
        for below in command.get_subcommands() {
            let args = below_and_self(below).into_iter().flat_map(shown);
            let args = args.filter(|arg| arg.get_long().is_some());
            let texts: BTreeSet<_> = args.map(|arg| (call(arg), text(arg))).collect();
            texts.into_iter().for_each(|of_arg| *found.entry(of_arg).or_default() += 1);
        }
        let mut found: Vec<_> = found.into_iter().filter(|(_, n)| *n >= SEVERAL).collect();
        found.sort_by_key(|((call, _), n)| (call.clone(), usize::MAX - n));
        found.dedup_by(|((a, _), _), ((b, _), _)| a == b);
        Self {
            heading: heading.into(),
            texts: found.into_iter().map(|((_, text), _)| text).collect(),
        }
    }

    fn has(&self, arg: &Arg) -> bool {
        self.texts.contains(&text(arg))
    }

    fn list(&self, page: &mut String) {
        self.texts.iter().for_each(|text| page.push_str(&wrap(text, "- ", "  ")));
    }

    /// Appends a sentence that names these options of a command, if it has some.
    fn name(&self, page: &mut String, command: &Command) {
        let args = shown(command).filter(|arg| self.has(arg)).filter_map(Arg::get_long);
        let names = args.map(|long| format!("`--{long}`")).collect::<Vec<_>>().join(", ");
        if !names.is_empty() {
            let anchor = self.heading.to_lowercase().replace(' ', "-");
            leave_a_blank_line(page);
            page.push_str(&wrap(&format!("[{SHARED}](#{anchor}): {names}."), "", ""));
        }
    }
}

fn below_and_self(command: &Command) -> Vec<&Command> {
    let below = command.get_subcommands().flat_map(below_and_self);
    std::iter::once(command).chain(below).collect()
}

fn shown(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|arg| {
        let is_help = matches!(arg.get_id().as_str(), "help" | "version");
        !arg.is_hide_set() && !is_help && arg.get_help_heading() != Some(GLOBAL)
    })
}

/// Appends the sections of a command and of the commands below it.
fn section(page: &mut String, command: &Command, parent: &str, shared: &[Shared]) {
    let name = format!("{parent} {}", command.get_name());
    let _ = writeln!(page, "\n## {name}\n");
    let about = command.get_long_about().or(command.get_about());
    let about = about.map(ToString::to_string).unwrap_or_default();
    for paragraph in about.split("\n\n") {
        page.push_str(&wrap(&sentence(&escape(&joined(paragraph))), "", ""));
        page.push('\n');
    }
    if command.has_subcommands() {
        let names = command.get_subcommands().map(|below| format!("`{}`", below.get_name()));
        let names = names.collect::<Vec<_>>().join(", ");
        page.push_str(&wrap(&format!("Its commands are {names}."), "", ""));
        let own = Shared::new(&name, command);
        if !own.texts.is_empty() {
            page.push_str("\nSeveral of them have these options:\n\n");
            own.list(page);
        }
        let shared = [shared, &[own]].concat();
        for below in command.get_subcommands() {
            section(page, below, &name, &shared);
        }
        return;
    }
    let _ = writeln!(page, "{}", usage(&name, command));
    options(page, command, shared);
    if let Some(help) = command.get_after_help() {
        exit_codes(page, &help.to_string());
    }
}

/// Returns the call with what it requires, as a block of code.
fn usage(name: &str, command: &Command) -> String {
    let required = command.get_arguments().filter(|arg| arg.is_required_set());
    let words = required.map(|arg| if arg.is_positional() { values(arg) } else { call(arg) });
    let words: Vec<String> = std::iter::once(name.to_string()).chain(words).collect();
    let mut text = format!("    {} [OPTIONS]\n", words.join(" "));
    let either =
        command.get_arguments().filter(|arg| arg.is_positional() && !arg.is_required_set());
    for arg in either {
        let _ = writeln!(text, "    {name} {} [OPTIONS]", values(arg));
    }
    text
}

/// Appends the options, by their headings, in the order of their definition. Options in `shared`
/// are named only.
fn options(page: &mut String, command: &Command, shared: &[Shared]) {
    let is_own = |arg: &&Arg| !shared.iter().any(|shared| shared.has(arg));
    let args: Vec<&Arg> = shown(command).filter(is_own).collect();
    let mut headings: Vec<Option<&str>> = Vec::new();
    for arg in &args {
        if !headings.contains(&arg.get_help_heading()) {
            headings.push(arg.get_help_heading());
        }
    }
    headings.sort_by_key(Option::is_some);
    for heading in headings {
        if let Some(heading) = heading {
            leave_a_blank_line(page);
            let _ = writeln!(page, "**{heading}**\n");
        }
        for arg in args.iter().filter(|arg| arg.get_help_heading() == heading) {
            page.push_str(&item(arg));
        }
    }
    shared.iter().for_each(|shared| shared.name(page, command));
}

/// Returns one option as an item of a list: call, help, values, default, and whether it is needed.
fn item(arg: &Arg) -> String {
    let required = if arg.is_required_set() { " Required." } else { "" };
    wrap(&(text(arg) + required), "- ", "  ")
}

/// Returns one option's call, help, values and default.
fn text(arg: &Arg) -> String {
    let help = arg.get_long_help().or(arg.get_help()).map(ToString::to_string).unwrap_or_default();
    let mut text = format!("`{}`: {}", call(arg), sentence(&escape(&joined(&help))));
    let possible = arg.get_possible_values();
    let possible: Vec<_> = possible.iter().filter(|value| !value.is_hide_set()).collect();
    if arg.get_action().takes_values() && !possible.is_empty() {
        let named = possible.iter().map(|value| match value.get_help() {
            Some(help) => format!("`{}` ({})", value.get_name(), escape(&help.to_string())),
            None => format!("`{}`", value.get_name()),
        });
        let _ = write!(text, " Values: {}.", named.collect::<Vec<_>>().join(", "));
    }
    let defaults = arg.get_default_values();
    if arg.get_action().takes_values() && !defaults.is_empty() {
        let values: Vec<_> = defaults.iter().map(|value| value.to_string_lossy()).collect();
        let _ = write!(text, " Default: `{}`.", values.join(","));
    }
    text
}

/// Returns what to type for an option, for example `-q, --quiet` or `--out <FILE>`.
fn call(arg: &Arg) -> String {
    let names =
        [arg.get_short().map(|c| format!("-{c}")), arg.get_long().map(|l| format!("--{l}"))];
    let mut words = names.into_iter().flatten().collect::<Vec<_>>().join(", ");
    if arg.get_action().takes_values() {
        if !words.is_empty() {
            words.push(' ');
        }
        words.push_str(&values(arg));
    }
    words
}

fn values(arg: &Arg) -> String {
    let names = arg.get_value_names().unwrap_or_default().iter();
    let names: Vec<_> = names.map(|name| format!("<{name}>")).collect();
    let more = arg.get_num_args().is_some_and(|range| range.max_values() > names.len().max(1));
    names.join(" ") + if more { "..." } else { "" }
}

/// Appends the exit codes of the text after the options. `--help-all` has the rest: examples and
/// remarks.
fn exit_codes(page: &mut String, help: &str) {
    for block in help.split("\n\n").filter(|block| block.starts_with("Exit codes")) {
        leave_a_blank_line(page);
        page.push_str(&wrap(&escape(&joined(block)), "", ""));
    }
}

/// Ends the page with one blank line.
fn leave_a_blank_line(page: &mut String) {
    page.truncate(page.trim_end().len());
    page.push_str("\n\n");
}

fn joined(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Ends a help text with a full stop, also before a default in words.
fn sentence(text: &str) -> String {
    let default = text
        .split_once(" [default: ")
        .and_then(|(help, rest)| rest.strip_suffix(']').map(|default| (sentence(help), default)));
    match default {
        Some((help, default)) => format!("{help} Default: {default}."),
        None if text.is_empty() || text.ends_with(['.', ':']) => text.into(),
        None => format!("{text}."),
    }
}

/// Escapes what Markdown would not print, outside of code, and links pages of the documentation.
fn escape(text: &str) -> String {
    let mut in_code = false;
    let mut escaped = String::new();
    for c in text.chars() {
        in_code ^= c == '`';
        if !in_code && matches!(c, '*' | '<' | '|') {
            escaped.push('\\');
        }
        escaped.push(c);
    }
    let link = |word: &str| match word.strip_prefix("docs/").and_then(|w| w.split_once(".md")) {
        Some((page, rest)) => format!("[{page}.md]({page}.md){rest}"),
        None => word.to_string(),
    };
    escaped.split(' ').map(link).collect::<Vec<_>>().join(" ")
}

/// Breaks a text into lines of at most [`WIDTH`] columns. Code between backquotes stays whole.
fn wrap(text: &str, first: &str, next: &str) -> String {
    let mut page = first.to_string();
    let mut column = first.chars().count();
    let mut words = text.split(' ').peekable();
    let mut is_first = true;
    while let Some(word) = words.next() {
        let mut word = word.to_string();
        while word.matches('`').count() % 2 == 1
            && let Some(rest) = words.next()
        {
            word = format!("{word} {rest}");
        }
        let length = word.chars().count();
        if !is_first && column + 1 + length > WIDTH {
            page.push('\n');
            page.push_str(next);
            column = next.chars().count();
        } else if !is_first {
            page.push(' ');
            column += 1;
        }
        page.push_str(&word);
        column += length;
        is_first = false;
    }
    page + "\n"
}

#[cfg(test)]
mod tests {
    use clap::{Arg, Command};

    use super::{escape, exit_codes, markdown, sentence, wrap};

    #[test]
    fn an_option_of_two_commands_is_printed_once() {
        let arg = |name: &'static str, help: &'static str| Arg::new(name).long(name).help(help);
        let command = |name: &'static str| Command::new(name).arg(arg("lock", "Hold a joint"));
        let all = Command::new("reachtube")
            .subcommand(command("a").arg(arg("out", "A file")))
            .subcommand(command("b").arg(arg("out", "A folder")));
        let page = markdown(all);
        assert_eq!(page.matches("Hold a joint.").count(), 1, "{page}");
        assert_eq!(page.matches("[Shared options](#shared-options): `--lock`.").count(), 2);
        assert_eq!(page.matches("A file.").count(), 1);
        assert_eq!(page.matches("A folder.").count(), 1);
    }

    #[test]
    fn help_becomes_markdown() {
        assert_eq!(sentence("Positions [default: 0]"), "Positions. Default: 0.");
        assert_eq!(sentence("Runs, e.g.:"), "Runs, e.g.:");
        assert_eq!(escape("see docs/logs.md, <x> `<y>`"), "see [logs.md](logs.md), \\<x> `<y>`");
        let mut page = "- `--out`: A file.\n".to_string();
        exit_codes(&mut page, "Example:\n  reachtube demo\n\nExit codes: 0 done,\n1 not.");
        assert_eq!(page, "- `--out`: A file.\n\nExit codes: 0 done, 1 not.\n");
    }

    #[test]
    fn lines_are_broken_between_words_and_outside_of_code() {
        let text = format!("{} `a b c`: {}", "x".repeat(92), "y ".repeat(60).trim_end());
        let page = wrap(&text, "- ", "  ");
        assert!(page.lines().all(|line| line.chars().count() <= 100), "{page}");
        assert!(page.contains("\n  `a b c`: y"), "{page}");
        let words: Vec<_> = page.trim_start_matches("- ").split_whitespace().collect();
        assert_eq!(words, text.split_whitespace().collect::<Vec<_>>());
    }
}
