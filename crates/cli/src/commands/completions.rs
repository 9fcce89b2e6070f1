//! `reachtube completions`: completion of commands and options in a shell.

use std::path::{Path, PathBuf};

use clap::{Args, Command};
use clap_complete::Shell;
use reachtube::write;

use crate::commands::man;
use crate::error::{Error, Result};
use crate::outcome::Outcome;
use crate::output;

const HELP: &str = "\
Examples:
  reachtube completions bash > ~/.local/share/bash-completion/completions/reachtube
  reachtube completions fish > ~/.config/fish/completions/reachtube.fish
  reachtube completions --out \"$DESTDIR/usr/share\"
      for a package: the scripts of all shells, and the manual pages of all commands";

/// Print a script that completes commands and options in a shell
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct Arguments {
    /// The shell
    #[arg(required_unless_present = "out", conflicts_with = "out")]
    pub shell: Option<Shell>,
    /// Write the scripts of all shells and all manual pages to this folder, laid out as /usr/share
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

/// Where each shell looks for scripts below a folder such as /usr/share. PowerShell and Elvish look
/// nowhere: their users name the script in a file of their own.
const PLACES: [(Shell, &str); 5] = [
    (Shell::Bash, "bash-completion/completions/reachtube"),
    (Shell::Elvish, "elvish/lib/reachtube.elv"),
    (Shell::Fish, "fish/vendor_completions.d/reachtube.fish"),
    (Shell::PowerShell, "powershell/reachtube.ps1"),
    (Shell::Zsh, "zsh/site-functions/_reachtube"),
];

pub(crate) fn run(args: &Arguments, command: Command) -> Result<Outcome> {
    if let Some(folder) = &args.out {
        write_all(folder, command)?;
    } else if let Some(shell) = args.shell {
        output::write_out(script(shell, command).as_bytes())?;
    }
    Ok(Outcome::Done)
}

/// Writes what a package installs beside the command itself.
fn write_all(folder: &Path, command: Command) -> Result<()> {
    let of = |(shell, place)| (folder.join(place), script(shell, command.clone()).into_bytes());
    let mut files: Vec<(PathBuf, Vec<u8>)> = PLACES.map(of).into();
    let pages = man::pages(command).map_err(Error::output)?;
    let manual = folder.join("man/man1");
    files.extend(pages.into_iter().map(|(name, page)| (manual.join(name), page)));
    output::claim_all(files.iter().map(|(path, _)| path))?;
    for (path, content) in &files {
        write::atomically(path, |out| out.write_all(content))?;
    }
    let (scripts, pages) = (PLACES.len(), files.len() - PLACES.len());
    let folder = folder.display();
    output::note(&format!("wrote {scripts} completion scripts and {pages} pages to {folder}"));
    Ok(())
}

/// Returns the script of a shell, with the comment by which a later command recognises that it may
/// replace it. The comment is the second line, because zsh reads the first.
fn script(shell: Shell, mut command: Command) -> String {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command, "reachtube", &mut script);
    let script = String::from_utf8_lossy(&script);
    let mark = format!("# {}", reachtube_files::MARK);
    match script.split_once('\n') {
        Some((first, rest)) if first.starts_with('#') => format!("{first}\n{mark}\n{rest}"),
        _ => format!("{mark}\n{script}"),
    }
}
