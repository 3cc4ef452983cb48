//! The program: a subcommand goes to the command's face, none to the window.

use std::process::ExitCode;

fn main() -> ExitCode {
    gnomon::cli::main(WINDOW)
}

/// What opens the window, where there is one.
const WINDOW: Option<gnomon::cli::WindowOpener> = {
    #[cfg(feature = "desktop")]
    {
        Some(gnomon::desktop::open)
    }
    #[cfg(not(feature = "desktop"))]
    {
        None
    }
};
