//! Time and memory from the start of the program to the first picture of a model: `cargo bench --bench first-picture`.
//! Prints a table in Markdown; `-- FILE…` adds models of your own.
//!
//! Each is `gnomon shadow FILE` without the cache, as a separate process. The bench writes the IFC file itself: 89 MB,
//! as large as an office building with its furniture. The peak is the sum of the program's memory and that of the
//! process that reads the model.

mod ifc_text;
mod timing;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use timing::{median, timed};

/// How often each picture is drawn.
const TIMES: usize = 3;

/// Products of the synthetic file: 89 MB.
const PRODUCTS: usize = 6_360;

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let folder = std::env::temp_dir().join(format!("gnomon-bench-first-picture-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let synthetic = folder.join("synthetic.ifc");
    std::fs::write(&synthetic, ifc_text::ifc(PRODUCTS)).expect("a file");
    let own = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).map(PathBuf::from);
    println!("| model | MB | s | peak, MiB |\n|---|---|---|---|");
    for path in std::iter::once(synthetic).chain(own) {
        let (mut times, mut peak) = (Vec::new(), 0);
        for _ in 0..TIMES {
            peak = peak.max(timed(&mut times, || drawn(&path, &folder.join("shadow.png"))));
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let megabytes = std::fs::metadata(&path).expect("a file").len() as f64 / 1e6;
        println!("| {name} | {megabytes:.1} | {:.2} | {} |", median(times) / 1e3, peak >> 20);
    }
    println!("\nMedians and the largest peak of {TIMES}; {} threads.", rayon::current_num_threads());
    std::fs::remove_dir_all(&folder).expect("the bench's own folder");
}

/// Draws a picture, and gives the peak of the memory that it took, bytes.
fn drawn(model: &Path, picture: &Path) -> u64 {
    let asked = ["--at", "2026-09-18T15:00", "--place", "48.2,16.37", "--no-cache", "--quiet", "--out"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    command.arg("shadow").arg(model).args(asked).arg(picture).stdout(Stdio::null());
    let mut program = command.spawn().expect("the program");
    let peak = watched(&mut program);
    assert!(program.wait().expect("its end").success(), "no picture of {}", model.display());
    peak
}

/// Waits for the end of a program; the sum of the peaks of its processes, where the system tells them (Linux).
fn watched(program: &mut Child) -> u64 {
    let mut peaks = BTreeMap::new();
    while program.try_wait().expect("a process").is_none() {
        let children =
            std::fs::read_to_string(format!("/proc/{0}/task/{0}/children", program.id())).unwrap_or_default();
        let readers = children.split_ascii_whitespace().filter_map(|process| process.parse().ok());
        for process in std::iter::once(program.id()).chain(readers) {
            let peak = peak_of(process);
            peaks.entry(process).and_modify(|known: &mut u64| *known = peak.max(*known)).or_insert(peak);
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    peaks.values().sum()
}

fn peak_of(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_ascii_whitespace().next()?.parse::<u64>().ok());
    kibibytes.unwrap_or(0) << 10
}
