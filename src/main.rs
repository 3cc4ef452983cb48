//! The program: a subcommand goes to the command's face.

use std::process::ExitCode;

fn main() -> ExitCode {
    gnomon::cli::main()
}
