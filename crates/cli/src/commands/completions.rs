//! `reachtube completions`: completion of commands and options in a shell.

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use crate::cli::Cli;
use crate::error::Result;
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Examples:
  reachtube completions bash > ~/.local/share/bash-completion/completions/reachtube
  reachtube completions fish > ~/.config/fish/completions/reachtube.fish";

/// Print a script that completes commands and options in a shell
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Arguments {
    /// The shell
    pub shell: Shell,
}

pub fn run(args: &Arguments) -> Result<Outcome> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "reachtube", &mut script);
    output::write_out(&script)?;
    Ok(Outcome::Done)
}
