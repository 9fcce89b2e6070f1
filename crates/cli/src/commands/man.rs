//! `reachtube man`: manual pages.

use std::path::PathBuf;

use clap::{Args, Command, CommandFactory};
use clap_mangen::Man;
use reachtube::write;

use crate::cli::Cli;
use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Examples:
  reachtube man | man -l -
  reachtube man --out ~/.local/share/man/man1";

/// Print the manual page, or write one page for each command
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub struct Arguments {
    /// Write the pages of all commands to this folder: reachtube.1, reachtube-conform.1, ...
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

pub fn run(args: &Arguments) -> Result<Outcome> {
    // Building gives each command below the first its name in full, as in "reachtube-conform".
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let Some(folder) = &args.out else {
        output::write_out(&page(command).map_err(Error::Output)?)?;
        return Ok(Outcome::Done);
    };
    let commands = all(command);
    let path = |command: &Command| {
        let name = command.get_display_name().unwrap_or(command.get_name());
        folder.join(format!("{name}.1"))
    };
    let paths: Vec<PathBuf> = commands.iter().map(path).collect();
    output::claim_all(&paths)?;
    for (command, path) in commands.into_iter().zip(&paths) {
        let page = page(command).map_err(Error::Output)?;
        write::atomically(path, |out| out.write_all(&page))?;
    }
    output::note(&format!("wrote {} pages to {}", paths.len(), folder.display()));
    Ok(Outcome::Done)
}

/// Returns a command and the commands below it.
fn all(command: Command) -> Vec<Command> {
    let below: Vec<Command> = command.get_subcommands().cloned().flat_map(all).collect();
    std::iter::once(command).chain(below).collect()
}

/// Returns a manual page, with the comment by which a later command knows that it may replace it.
fn page(command: Command) -> std::io::Result<Vec<u8>> {
    let mut page = format!(".\\\" {}\n", reachtube_files::MARK).into_bytes();
    Man::new(command).render(&mut page)?;
    Ok(page)
}
