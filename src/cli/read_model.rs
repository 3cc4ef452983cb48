//! `gnomon read-model`: reads a model file and writes the model to standard output. The program starts this subcommand
//! itself, as a child process. The parent holds the child's standard input open; when it closes, the model is no longer
//! needed.

use crate::formats::child;
use clap::Args;
use std::io::{self, BufRead, BufReader, BufWriter};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct ReadModelArgs {
    path: PathBuf,
}

pub(super) fn read_model(asked: &ReadModelArgs) -> anyhow::Result<()> {
    let mut input = BufReader::new(io::stdin());
    let mut request = String::new();
    input.read_line(&mut request)?;
    std::thread::spawn(move || {
        let _ = io::copy(&mut input, &mut io::sink());
        std::process::exit(1);
    });
    Ok(child::answer(&asked.path, &request, &mut BufWriter::with_capacity(1 << 20, io::stdout().lock()))?)
}
