//! Time and memory from the start of the program to the first picture of a model: `cargo bench --bench first-picture`.
//! Prints a table in Markdown; `-- FILE…` adds models of your own.
//!
//! Each is `gnomon shadow FILE` without the cache, as a separate process. The bench writes two IFC files of 89 MB itself,
//! as large as an office building with its furniture: one of face sets, with 35 triangles a kilobyte, and one of faceted
//! breps, with 8; exported buildings have 7 to 24. The peak is the most memory that the program and the process that
//! reads the model have at one time.

mod ifc_text;
mod timing;

use ifc_text::FurnitureAs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use timing::{median, timed};

/// How often each picture is drawn.
const TIMES: usize = 3;

/// The synthetic files, with so many products that each has 89 MB.
const FILES: [(&str, usize, FurnitureAs); 2] =
    [("face-sets.ifc", 6_360, FurnitureAs::FaceSet), ("breps.ifc", 1_165, FurnitureAs::Brep)];

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let folder = std::env::temp_dir().join(format!("gnomon-bench-first-picture-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let synthetic = FILES.map(|(name, products, furniture_as)| {
        let path = folder.join(name);
        std::fs::write(&path, ifc_text::ifc(products, furniture_as)).expect("a file");
        path
    });
    let own = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).map(PathBuf::from);
    println!("| model | MB | s | peak, MiB |\n|---|---|---|---|");
    for path in synthetic.into_iter().chain(own) {
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

/// Draws a picture, and gives the peak of the memory that its processes took at one time, bytes.
fn drawn(model: &Path, picture: &Path) -> u64 {
    let asked = ["--at", "2026-09-18T15:00", "--place", "48.2,16.37", "--no-cache", "--quiet", "--out"];
    let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    command.arg("shadow").arg(model).args(asked).arg(picture).stdout(Stdio::null());
    let mut program = command.spawn().expect("the program");
    let peak = watched(&mut program);
    assert!(program.wait().expect("its end").success(), "no picture of {}", model.display());
    peak
}

/// Waits for the end of a program; the most that its processes took at one time, where the system tells it (Linux).
fn watched(program: &mut Child) -> u64 {
    let mut peak = 0;
    while program.try_wait().expect("a process").is_none() {
        let children =
            std::fs::read_to_string(format!("/proc/{0}/task/{0}/children", program.id())).unwrap_or_default();
        let readers = children.split_ascii_whitespace().filter_map(|process| process.parse().ok());
        peak = peak.max(std::iter::once(program.id()).chain(readers).map(resident).sum());
        std::thread::sleep(Duration::from_millis(5));
    }
    peak
}

fn resident(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kibibytes = line.and_then(|line| line.split_ascii_whitespace().next()?.parse::<u64>().ok());
    kibibytes.unwrap_or(0) << 10
}
