//! `reachtube man`: manual pages, and the same as one page of Markdown.

use std::path::PathBuf;

use clap::{Args, Command};
use clap_mangen::Man;
use reachtube::write;

use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::schema::{SchemaOf, schema_of};
use crate::{output, reference};

const HELP: &str = "\
Examples:
  reachtube man | man -l -
  reachtube man --out ~/.local/share/man/man1
  reachtube man --markdown > docs/cli.md
      the reference of the documentation
  reachtube man --schema results
      the JSON schema of what each command prints with --json";

/// Print the manual page, or write one page for each command
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// Write the pages of all commands to this folder: reachtube.1, reachtube-conform.1, ...
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Print all commands and their options as one page of Markdown
    #[arg(long, conflicts_with = "out")]
    pub markdown: bool,
    /// Print the JSON schema of a model file, of an abstraction file, or of what each command
    /// prints with --json
    #[arg(long, value_enum, value_name = "WHAT", conflicts_with_all = ["out", "markdown"])]
    pub schema: Option<SchemaOf>,
}

pub(crate) fn run(args: &Arguments, command: Command) -> Result<Outcome> {
    if let Some(what) = args.schema {
        output::print_json(&schema_of(what))?;
    } else if args.markdown {
        output::write_out(reference::markdown(built(command)).as_bytes())?;
    } else if let Some(folder) = &args.out {
        let pages = pages(command).map_err(Error::output)?;
        let paths: Vec<PathBuf> = pages.iter().map(|(name, _)| folder.join(name)).collect();
        output::claim_all(&paths)?;
        for ((_, page), path) in pages.iter().zip(&paths) {
            write::atomically(path, |out| out.write_all(page))?;
        }
        output::note(&format!("wrote {} pages to {}", paths.len(), folder.display()));
    } else {
        output::write_out(&page(built(command)).map_err(Error::output)?)?;
    }
    Ok(Outcome::Done)
}

/// Returns the manual page of each command under its file's name.
pub(crate) fn pages(command: Command) -> std::io::Result<Vec<(String, Vec<u8>)>> {
    let named = |command: Command| {
        let name = format!("{}.1", command.get_display_name().unwrap_or(command.get_name()));
        Ok((name, page(command)?))
    };
    all(built(command)).into_iter().map(named).collect()
}

/// Returns the command line. Building gives each command below the first its name in full, as in
/// "reachtube-conform".
fn built(command: Command) -> Command {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    command
}

fn all(command: Command) -> Vec<Command> {
    let below: Vec<Command> = command.get_subcommands().cloned().flat_map(all).collect();
    std::iter::once(command).chain(below).collect()
}

/// Returns a manual page, with the comment by which a later command recognises that it may replace
/// it.
fn page(command: Command) -> std::io::Result<Vec<u8>> {
    let mut page = format!(".\\\" {}\n", reachtube_files::MARK).into_bytes();
    Man::new(command).render(&mut page)?;
    Ok(page)
}
