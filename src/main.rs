//! The program: with a subcommand it is the command, without one it opens the window.

use std::process::ExitCode;

fn main() -> ExitCode {
    gnomon::cli::main(WINDOW)
}

/// The function that opens the window, if there is one.
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
