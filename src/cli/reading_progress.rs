//! What is shown on stderr while a model is read that takes long: a spinner on a terminal, and lines otherwise. Readers do not
//! say how far they are, so the time that has gone by is all that can be shown.

use crate::export::bytes;
use crate::formats::ReadingListener;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// What takes no longer is not shown.
const SOON: Duration = Duration::from_secs(3);
/// From one line to the next.
const AGAIN: Duration = Duration::from_secs(30);
/// How often a spinner's time is looked at.
const TICK: Duration = Duration::from_millis(200);

static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Shows nothing from now on.
pub(super) fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

/// Shows what is heard.
pub(super) fn listener() -> ReadingListener {
    let shown = Mutex::new(None);
    ReadingListener::new(move |path| {
        if let Ok(mut shown) = shown.lock() {
            *shown = path.filter(|_| !IS_QUIET.load(Ordering::Relaxed)).and_then(ShownReading::start);
        }
    })
}

/// A file that is being read, until this is dropped.
struct ShownReading {
    /// Closed when the reading has ended.
    goes_on: Option<mpsc::Sender<()>>,
    shows: Option<JoinHandle<()>>,
}

impl ShownReading {
    /// `None` where the system gives no thread: reading goes on without.
    fn start(path: &Path) -> Option<ShownReading> {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let size = std::fs::metadata(path).map_or_else(|_| String::new(), |found| format!(", {}", bytes(found.len())));
        let what = format!("reading {name}{size}");
        let (goes_on, ends) = mpsc::channel();
        let shows = thread::Builder::new().spawn(move || show(&what, &ends)).ok()?;
        Some(ShownReading { goes_on: Some(goes_on), shows: Some(shows) })
    }
}

impl Drop for ShownReading {
    fn drop(&mut self) {
        self.goes_on = None;
        // nothing is shown after it
        if let Some(shows) = self.shows.take() {
            let _ = shows.join();
        }
    }
}

/// Shows what is done until the channel is closed.
fn show(what: &str, ends: &mpsc::Receiver<()>) {
    let begun = Instant::now();
    let lasts = |time: Duration| matches!(ends.recv_timeout(time), Err(RecvTimeoutError::Timeout));
    if !lasts(SOON) {
        return;
    }
    if !io::stderr().is_terminal() {
        let mut line = what.to_owned();
        loop {
            // nobody is left to tell that stderr is closed
            let _ = writeln!(io::stderr(), "{line}");
            if !lasts(AGAIN) {
                return;
            }
            line = format!("{what}: {} s", begun.elapsed().as_secs());
        }
    }
    let style = ProgressStyle::with_template("{spinner} {msg}").unwrap_or_else(|_| ProgressStyle::default_spinner());
    let spinner = ProgressBar::new_spinner().with_style(style);
    while lasts(TICK) {
        spinner.set_message(format!("{what}: {} s", begun.elapsed().as_secs()));
        spinner.tick();
    }
    spinner.finish_and_clear();
}
