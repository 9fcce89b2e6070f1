//! Options that every command has.

use std::sync::OnceLock;

use clap::{ArgAction, Args};
use reachtube_files::Overwrite;

// A comment, not a doc comment: clap would show it as the description of the command.
// Options that every command has.
#[derive(Debug, Clone, Copy, Default, Args)]
#[command(next_help_heading = "Global options")]
pub(crate) struct GlobalOptions {
    /// Print the result as JSON on standard output.
    ///
    /// An error is printed as JSON on standard error.
    #[arg(long, global = true)]
    pub json: bool,
    /// Overwrite existing files that carry no mark of reachtube
    #[arg(long, global = true)]
    pub force: bool,
    /// Print no notes and no progress; warnings and errors remain
    #[arg(long, short, global = true, conflicts_with = "verbose")]
    pub quiet: bool,
    /// Print the whole answer, every note, and how long each step took
    #[arg(long, short, global = true)]
    pub verbose: bool,
    /// Print the options used most
    #[arg(long, short, global = true, action = ArgAction::HelpShort)]
    help: Option<bool>,
    /// Print all options and examples
    #[arg(long, global = true, action = ArgAction::HelpLong)]
    help_all: Option<bool>,
}

static OPTIONS: OnceLock<GlobalOptions> = OnceLock::new();

impl GlobalOptions {
    /// Makes these the options of the process. Later calls have no effect.
    pub(crate) fn install(self) {
        OPTIONS.get_or_init(|| self);
    }

    /// Returns the files that commands may replace.
    pub(crate) fn overwrite(self) -> Overwrite {
        if self.force { Overwrite::Any } else { Overwrite::Own }
    }
}

pub(crate) fn global() -> GlobalOptions {
    OPTIONS.get().copied().unwrap_or_default()
}
