//! Reads a model in a child process: the same program, started again, reads the file and writes the model in the form
//! of `super::encoded`.
//!
//! Readers from other libraries may hang, crash, exit or take all memory. In a child process each of these becomes one
//! clear error. The parent watches time and memory, and ends the child. If the parent itself ends, the child's standard
//! input closes, and the child ends, too.

use super::encoded::{self, EncodingError};
use super::{Model, ModelFault, ReadLimits, ReadOptions};
use crate::message::{Field, Message, MessagePart, message, pieces};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};
use sysinfo::{Pid, ProcessRefreshKind, ProcessesToUpdate, System};

/// The subcommand that reads a model and writes it to standard output. It is hidden in the help.
pub const SUBCOMMAND: &str = "read-model";

/// The interval at which time, memory and cancellation are checked.
const LOOK: Duration = Duration::from_millis(20);

/// Answers a request, in the child process.
///
/// # Errors
/// A malformed request, or an error of the writer.
pub fn answer(path: &Path, request: &str, out: &mut impl Write) -> io::Result<()> {
    let options: ReadOptions = serde_json::from_str(request)?;
    match super::read(path, &options) {
        Ok(model) => encoded::write(Ok(&model), out),
        Err(error) => {
            let message = match error.fault {
                ModelFault::Unusable(message) => message,
                fault => fault.to_string().into(),
            };
            encoded::write(Err(&message), out)
        }
    }
}

/// Why the child was ended.
enum EndCause {
    Wish,
    Time,
    Memory(u64),
}

/// Reads a file in a child process.
///
/// # Errors
/// Errors in the file; or that the child exceeded a limit or ended early.
pub(super) fn read(
    program: &Path,
    limits: ReadLimits,
    is_given_up: &AtomicBool,
    path: &Path,
    options: &ReadOptions,
) -> Result<Model, ModelFault> {
    let unstarted = |error: io::Error| {
        let what = format!("cannot be read, as no process can be started for it: {error}");
        ModelFault::from(message![what; "close other programs, or start Gnomon again"])
    };
    let mut process = EndingProcess(start(program, path).map_err(unstarted)?);
    // stays open while the child runs: the child ends when it is closed
    let mut ask = process.0.stdin.take();
    let request = serde_json::to_string(options);
    if let (Some(ask), Ok(request)) = (&mut ask, request) {
        // a child that ended already is reported below
        let _ = writeln!(ask, "{request}").and_then(|()| ask.flush());
    }
    let (Some(out), Some(told)) = (process.0.stdout.take(), process.0.stderr.take()) else {
        return Err(unstarted(io::ErrorKind::BrokenPipe.into()));
    };
    let (tell, outcome) = mpsc::channel();
    thread::spawn(move || {
        // if the child was ended, nobody receives this
        let _ = tell.send(encoded::read(&mut BufReader::with_capacity(1 << 20, out)));
    });
    let (tell, words) = mpsc::channel();
    thread::spawn(move || {
        let _ = tell.send(last_words(told));
    });
    match watched(&mut process, limits, is_given_up, &outcome) {
        Err(EndCause::Wish) => Err(ModelFault::GivenUp),
        Err(EndCause::Time) => Err(too_long(limits.time).into()),
        Err(EndCause::Memory(bytes)) => Err(too_large(bytes).into()),
        Ok(Ok(read)) => Ok(read?),
        Ok(Err(error)) => {
            let words = words.recv_timeout(Duration::from_secs(1)).unwrap_or_default();
            let fault = broken_off(&mut process, &error, &words);
            // Ctrl-C in a terminal reaches both processes, and the child may end before this one hears of it
            let is_wish = is_given_up.load(Ordering::Relaxed) || was_interrupted(&mut process);
            if is_wish { Err(ModelFault::GivenUp) } else { Err(fault.into()) }
        }
    }
}

fn start(program: &Path, path: &Path) -> io::Result<Child> {
    let mut command = Command::new(program);
    command.arg(SUBCOMMAND).arg("--").arg(path);
    command.env("RAYON_NUM_THREADS", rayon::current_num_threads().to_string());
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    #[cfg(windows)]
    {
        use std::os::windows::process::CommandExt as _;
        // CREATE_NO_WINDOW: no console appears beside the window
        command.creation_flags(0x0800_0000);
    }
    command.spawn()
}

/// Waits for the child's answer, or returns why the child must be ended.
fn watched(
    process: &mut EndingProcess,
    limits: ReadLimits,
    is_given_up: &AtomicBool,
    outcome: &mpsc::Receiver<Result<Result<Model, Message>, EncodingError>>,
) -> Result<Result<Result<Model, Message>, EncodingError>, EndCause> {
    let (begun, most) = (Instant::now(), limits.memory_bytes());
    let mut memory = MemoryWatch { system: System::new().ok(), process: Pid::from_u32(process.0.id()) };
    loop {
        match outcome.recv_timeout(LOOK) {
            Ok(outcome) => return Ok(outcome),
            Err(RecvTimeoutError::Disconnected) => {
                return Ok(Err(EncodingError::Damaged("its answer cannot be received")));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
        if is_given_up.load(Ordering::Relaxed) {
            return Err(EndCause::Wish);
        }
        if begun.elapsed() > limits.time {
            return Err(EndCause::Time);
        }
        if memory.bytes() > most {
            return Err(EndCause::Memory(most));
        }
    }
}

/// A child process that is ended when this is dropped.
struct EndingProcess(Child);

impl Drop for EndingProcess {
    fn drop(&mut self) {
        // it may have ended already
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Measures the memory of a process.
struct MemoryWatch {
    /// `None` on systems that do not report processes.
    system: Option<System>,
    process: Pid,
}

impl MemoryWatch {
    /// Returns 0 if the system does not report it.
    fn bytes(&mut self) -> u64 {
        let Some(system) = &mut self.system else { return 0 };
        let kind = ProcessRefreshKind::nothing().with_memory();
        system.refresh_processes_specifics(ProcessesToUpdate::Some(&[self.process]), false, kind);
        system.process(self.process).map_or(0, sysinfo::Process::memory)
    }
}

/// The last thing a process says about itself: a line of the program's own, or a panic's message. Other output comes
/// from the libraries.
fn last_words(told: impl Read) -> String {
    const MOST_LETTERS: usize = 200;
    /// Longer lines are cut.
    const LONGEST: u64 = 1 << 16;
    let (mut words, mut told, mut is_panic) = (String::new(), BufReader::new(told), false);
    loop {
        let mut line = Vec::new();
        match told.by_ref().take(LONGEST).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return words,
            Ok(_) => {}
        }
        let line = String::from_utf8_lossy(&line);
        let line = line.split_whitespace().collect::<Vec<_>>().join(" ");
        if line.is_empty() {
            continue;
        }
        if is_panic || line.starts_with("gnomon:") {
            words = line.chars().take(MOST_LETTERS).collect();
        }
        // the message of the panic is in the next line
        is_panic = line.starts_with("thread ") && line.contains(" panicked at ");
    }
}

const SMALLER: &str = "export it in parts or with less detail";

fn too_long(time: Duration) -> Message {
    let secs = time.as_secs_f64();
    let time = if secs >= 60.0 { format!("{:.0} min", secs / 60.0) } else { format!("{secs:.0} s") };
    message![
        format!("takes longer to read than {time}, and reading was stopped");
        SMALLER, MessagePart::Where(Field::ReadTime, pieces![", or allow more with ", (Field::ReadTime, "1h")])
    ]
}

fn too_large(bytes: u64) -> Message {
    let [mib, gib] = [20, 30].map(|power| bytes as f64 / f64::from(1 << power));
    let most = match gib {
        gib if gib >= 1.0 => format!("{gib:.1} GiB"),
        _ if mib >= 1.0 => format!("{mib:.0} MiB"),
        _ => format!("{:.0} KiB", (mib * 1024.0).ceil()),
    };
    message![
        format!("takes more memory to read than {most}, and reading was stopped");
        SMALLER, MessagePart::Where(Field::ReadMemory, pieces![", or allow more with ", (Field::ReadMemory, "64GiB")])
    ]
}

/// Whether a process that has ended was ended by Ctrl-C.
#[cfg(unix)]
fn was_interrupted(process: &mut EndingProcess) -> bool {
    use std::os::unix::process::ExitStatusExt as _;
    const SIGINT: i32 = 2;
    process.0.wait().is_ok_and(|status| status.signal() == Some(SIGINT))
}

/// Elsewhere it has no console, and never hears of it.
#[cfg(not(unix))]
fn was_interrupted(_: &mut EndingProcess) -> bool {
    false
}

fn broken_off(process: &mut EndingProcess, error: &EncodingError, words: &str) -> Message {
    // it may still be writing what nobody reads
    let _ = process.0.kill();
    let (ended, is_done) = match process.0.wait() {
        Ok(status) => (status.to_string(), status.success()),
        Err(error) => (error.to_string(), false),
    };
    let why = match (words, error) {
        // its exit status tells why its answer is incomplete
        ("", EncodingError::Cut(_)) if !is_done => String::new(),
        ("", error) => format!(": {error}"),
        (words, _) => format!(": {words}"),
    };
    message![
        format!("cannot be read: its reader failed ({ended}){why}");
        "export it again, from another program or in another format, such as glTF"
    ]
}
