//! The command: one face of the program. It takes options, and writes files and answers. Each subcommand is a few
//! lines; the work is done in `deliver`.
//!
//! Results go to stdout, progress and notes to stderr. The exit status is 0 for success, 1 for a failure, 2 for wrong
//! use, and 130 after an interruption; `judge` answers with its own, 0 for a site that passes, 1 for one that does not, and 3 for
//! nothing but a report.

mod animate;
mod arguments;
mod command_line;
mod commands;
mod compare;
mod convert;
mod draw;
mod envelope;
mod eye;
mod interrupt;
mod judge;
mod memory;
mod model;
mod options;
mod output;
mod patches;
mod probe;
mod profile;
mod progress;
mod read_model;
mod reading_progress;
mod ruled_site;
mod rules;
mod technique;
mod values;
mod verify;
mod volumes;
mod wrong_use;

use crate::deliver::DeliverError;
use crate::export::ExportError;
use crate::fault;
use crate::site::SiteError;
use crate::study::StudyError;
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use command_line::{Arguments, Command};
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;
use wrong_use::WrongUse;

pub use options::Options;

/// Opens the window, with a site or a model in it if one is named.
pub type WindowOpener = fn(Option<&Path>) -> anyhow::Result<()>;

/// Every subcommand and option, as they are parsed. `docs/command.md` is generated from it.
pub fn definition() -> clap::Command {
    Arguments::command()
}

/// Parses the command line and runs the subcommand. Without one it opens the window, if the program has one.
pub fn main(window: Option<WindowOpener>) -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => return refuse(&error),
    };
    let done = match (&arguments.command, window) {
        (None, Some(window)) => window(None).map(|()| ExitCode::SUCCESS),
        (Some(Command::Open(asked)), Some(window)) => window(Some(&asked.path)).map(|()| ExitCode::SUCCESS),
        (Some(Command::Open(_)), None) => {
            let what = "open: this gnomon was built without a window; build it with the feature desktop";
            Err(WrongUse(what.to_owned()).into())
        }
        (Some(command), _) => run(command),
        (None, None) => {
            // if stderr is closed there is nobody to tell
            let _ = write!(io::stderr(), "{}", Arguments::command().render_help());
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(status) => status,
        Err(error) => {
            complain(&fault::line(error.as_ref(), &Options));
            let status = status(&error);
            // of a judgement 1 is the verdict that the site fails
            let is_judgement = matches!(arguments.command, Some(Command::Judge(_)));
            ExitCode::from(if is_judgement && status == 1 { 2 } else { status })
        }
    }
}

fn run(command: &Command) -> anyhow::Result<ExitCode> {
    if let Command::ReadModel(asked) = command {
        // Ctrl-C ends it at once, and its parent too
        return read_model::read_model(asked).map(|()| ExitCode::SUCCESS);
    }
    let threads = command.common().and_then(|common| common.threads);
    // this thread is one of them, so work does not move between it and idle ones
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, usize::from)).use_current_thread();
    pool.build_global().map_err(|error| match threads {
        Some(threads) => anyhow::anyhow!("--threads {threads}: {error}; use fewer"),
        None => anyhow::anyhow!("the worker threads could not be created: {error}; use --threads with fewer"),
    })?;
    interrupt::listen();
    if command.common().is_some_and(|common| common.quiet) {
        reading_progress::be_quiet();
    }
    let done = match command {
        Command::Judge(asked) => return judge::judge(asked),
        Command::Envelope(asked) => envelope::envelope(asked),
        Command::Profile(asked) => profile::profile(asked),
        Command::Compare(asked) => compare::compare(asked),
        Command::Shadow(asked) => commands::shadow(asked),
        Command::Animate(asked) => animate::animate(asked),
        Command::Sun(asked) => commands::sun(asked),
        Command::Check(asked) => commands::check(asked),
        Command::Volumes(asked) => volumes::volumes(asked),
        Command::Verify(asked) => verify::verify(asked),
        Command::Probe(asked) => probe::probe(asked),
        Command::Convert(asked) => convert::convert(asked),
        Command::Rules(asked) => rules::rules(asked),
        // answered in `main`
        Command::Open(_) | Command::ReadModel(_) => Ok(()),
    };
    done.map(|()| ExitCode::SUCCESS)
}

/// The exit status of an error.
fn status(error: &anyhow::Error) -> u8 {
    let wrong_use = error.is::<WrongUse>()
        || error.downcast_ref().is_some_and(SiteError::is_wrong_use)
        || error.downcast_ref().is_some_and(StudyError::is_wrong_use)
        || error.downcast_ref().is_some_and(ExportError::is_wrong_use)
        || error.downcast_ref().is_some_and(DeliverError::is_wrong_use);
    let interrupted = matches!(error.downcast_ref(), Some(StudyError::Interrupted))
        || error.downcast_ref().is_some_and(DeliverError::is_interrupted)
        || error.downcast_ref().is_some_and(SiteError::is_given_up);
    match (interrupted, wrong_use) {
        (true, _) => 130,
        (_, true) => 2,
        _ => 1,
    }
}

/// Prints clap's output: help and version unchanged, a mistake on one line.
fn refuse(error: &clap::Error) -> ExitCode {
    match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => {
            // a closed pipe wants no more help
            let _ = error.print();
            return ExitCode::SUCCESS;
        }
        ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand => {
            let _ = error.print();
        }
        _ => {
            let text = error.to_string();
            let told = text.lines().map(str::trim).take_while(|line| !line.starts_with("Usage:"));
            // clap's tip that an option could be a value is not helpful
            let idle = |line: &str| ["For more", "tip: to pass"].iter().any(|idle| line.starts_with(idle));
            let told: Vec<_> = told.filter(|line| !line.is_empty() && !idle(line)).collect();
            let told = told.join("; ").replace("error: ", "").replace(":; ", ": ").replace("tip: ", "");
            complain(&format!("{told}; see --help"));
        }
    }
    ExitCode::from(2)
}

fn complain(line: &str) {
    // if stderr is closed there is nobody to tell
    let _ = writeln!(io::stderr(), "error: {line}");
}
