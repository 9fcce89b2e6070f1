//! `reachtube demo`: the two main commands on the logs of a simulated arm.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use clap::{Args, FromArgMatches};
use reachtube::campaign::{CampaignOptions, record};
use reachtube::conform::Check;
use reachtube::pipeline::ModelOutput;
use reachtube::write;
use reachtube_robot::Robot;
use schemars::JsonSchema;
use serde::Serialize;

use super::{check, model};
use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;
use crate::progress::Progress;
use crate::virtual_robot_arguments::VirtualRobotArguments;

/// Files by their names in the folder: choices for `model`, a scenario and brakes for `verify` and
/// `stop`.
const FILES: [(&str, &str); 3] = [
    ("limits.toml", include_str!("../../demo/limits.toml")),
    ("cell.toml", include_str!("../../demo/cell.toml")),
    ("brakes.toml", include_str!("../../demo/brakes.toml")),
];

const HELP: &str = "\
Example:
  reachtube demo --out demo
      then open demo/page/report.html in a browser

Exit codes: 0 the model is conformant and useful, and the other logs lie in its sets; otherwise the
exit code of `model`, or where that is 0, of `check`.";

/// Record logs of a simulated arm, make a model of them, and check it on other logs
///
/// The commands `model` and `check` are shown as one types them. The folder receives the logs, the
/// model, its page, limits.toml with a choice for `model`, and cell.toml and brakes.toml for
/// `verify` and `stop`. The last three are kept where they exist.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Folder for the logs, the model and the page
    #[arg(long, value_name = "FOLDER", default_value = "reachtube-demo")]
    pub out: PathBuf,
    /// Seed of the random numbers
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    #[command(flatten)]
    pub robot: VirtualRobotArguments,
}

/// Returns the files that a folder lacks. A user may have changed existing ones.
fn missing(folder: &Path) -> Vec<(PathBuf, &'static str)> {
    let files = FILES.map(|(name, text)| (folder.join(name), text));
    files.into_iter().filter(|(path, _)| !path.exists()).collect()
}

/// Runs the demo. The outcome is the verdict on the model, and if that is good, the one on the logs
/// that no choice has seen.
pub(crate) fn run(args: &Arguments, json: bool) -> Result<Outcome> {
    let robot = Robot::lwa4p();
    let [folder, model_file] = ["recordings", "model.json"].map(|name| args.out.join(name));
    let files = missing(&args.out);
    output::claim_all([&model_file].into_iter().chain(files.iter().map(|(path, _)| path)))?;
    let sizes = CampaignOptions { seed: args.seed, ..CampaignOptions::demo() };
    let options = CampaignOptions { robot: args.robot.parameters()?, ..sizes };
    let bar = Progress::of("recording");
    let recorded = record(&robot, &options, &folder, &|done, total| bar.show(done, total))?;
    drop(bar);
    output::note(&format!(
        "recorded {} logs of a simulated {} in {}",
        recorded.recordings,
        robot.name(),
        folder.display()
    ));
    for (path, text) in &files {
        write::atomically(path, |file| file.write_all(text.as_bytes()))?;
    }
    let shown = |path: &Path| path.display().to_string();
    let [limits, logs] = [args.out.join(FILES[0].0), folder.join("excitation")];
    let [limits, logs, out] = [&limits, &logs, &args.out].map(|path| shown(path));
    let words = ["--settings", &limits, "--robot", "lwa4p", "--data", &logs, "--torque", "motor"];
    let own: model::Arguments = typed("model", &[&words[..], &["--out", &out]].concat(), json)?;
    let made = model::Made::new(&own)?;
    let outcome = made.outcome();
    if !json {
        made.print(&own, &outcome)?;
        output::print("\n")?;
    }
    let [file, others] = [&model_file, &folder.join("validation")].map(|path| shown(path));
    let words = ["--model", &file, "--data", &others];
    let others: check::Arguments = typed("check", &words, json)?;
    let (opened, checked, of_check) = check::compared(&others)?;
    if json {
        output::print_json(&DemoOutput { model: made.built.output(), check: &checked })?;
    } else {
        check::print(&opened, &checked, &of_check)?;
    }
    Ok(match outcome {
        Outcome::Done => of_check,
        outcome => outcome,
    })
}

/// Reads the arguments of a command as a user types it, which is shown on the screen.
fn typed<T: Args + FromArgMatches>(name: &'static str, words: &[&str], json: bool) -> Result<T> {
    if !json {
        let words: Vec<_> = words.iter().map(|word| quoted(word)).collect();
        output::print(&format!("$ reachtube {name} {}\n", words.join(" ")))?;
    }
    let command = T::augment_args(clap::Command::new(name));
    let found = command.get_matches_from([&[name], words].concat());
    Ok(T::from_arg_matches(&found).expect("clap has read the same arguments"))
}

/// Returns a word as a shell takes it for one.
fn quoted(word: &str) -> Cow<'_, str> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./,=".contains(c);
    match word.chars().all(is_plain) {
        true => word.into(),
        false => format!("'{}'", word.replace('\'', r"'\''")).into(),
    }
}

/// The result of `demo`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct DemoOutput<'a> {
    /// The model.
    model: ModelOutput<'a>,
    /// The check on logs that no choice has seen.
    check: &'a Check,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_with_spaces_are_quoted() {
        assert_eq!(quoted("demo/limits.toml"), "demo/limits.toml");
        assert_eq!(quoted("my demo"), "'my demo'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
    }
}
