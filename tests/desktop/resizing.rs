//! A real window that a user resizes while pictures and hours are drawn on a graphics device.

use super::xvfb::{Running, run, screen, server, shades};
use super::*;
use eframe::NativeOptions;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::sync::mpsc;

/// The variable that names the test whose window a process shows.
const WINDOW_OF: &str = "GNOMON_TEST_WINDOW_OF";

/// Whether this process shows the window of a test that runs in another process.
pub(super) fn shows_window_of(test: &str) -> bool {
    std::env::var(WINDOW_OF).is_ok_and(|of| of == test)
}

/// For eframe: the window is not on the main thread, which runs tests.
pub(super) fn on_any_thread(options: &mut NativeOptions) {
    options.event_loop_builder = Some(Box::new(|_builder| {
        // elsewhere there is no Xvfb either
        #[cfg(target_os = "linux")]
        winit::platform::x11::EventLoopBuilderExtX11::with_any_thread(_builder, true);
    }));
}

/// A test in a separate process with a display: its output line by line, each after this mark.
pub(super) struct Watched {
    pub(super) process: Running,
    lines: mpsc::Receiver<String>,
    pub(super) said: Vec<String>,
    _home: tempfile::TempDir,
}

/// The beginning of each line that a window prints.
pub(super) const SAYS: &str = "window: ";

impl Watched {
    pub(super) fn start(test: &str, display: &str) -> Watched {
        let home = tempfile::tempdir().expect("a folder");
        let mut process = Command::new(std::env::current_exe().expect("this program"))
            .args([&format!("desktop::{test}"), "--exact", "--nocapture"])
            .env(WINDOW_OF, test)
            .env("DISPLAY", display)
            .env_remove("WAYLAND_DISPLAY")
            .env("HOME", home.path())
            .env("XDG_DATA_HOME", home.path())
            .env("XDG_RUNTIME_DIR", home.path())
            .stdout(Stdio::piped())
            .spawn()
            .expect("this program");
        let out = BufReader::new(process.stdout.take().expect("its output"));
        let (tell, lines) = mpsc::channel();
        std::thread::spawn(move || {
            for line in out.lines().map_while(Result::ok) {
                if let Some((_, said)) = line.split_once(SAYS) {
                    // who has seen enough listens no more
                    let _ = tell.send(said.to_owned());
                }
            }
        });
        Watched { process: Running(process), lines, said: Vec::new(), _home: home }
    }

    /// Waits until it says so.
    pub(super) fn until(&mut self, what: &str) {
        self.wait(what, |said| said == what);
    }

    /// Waits until it prints a line with this beginning.
    pub(super) fn until_any(&mut self, what: &str) {
        self.wait(what, |said| said.starts_with(what));
    }

    fn wait(&mut self, what: &str, is_so: impl Fn(&str) -> bool) {
        let begun = Instant::now();
        loop {
            let left = Duration::from_secs(240).saturating_sub(begun.elapsed());
            match self.lines.recv_timeout(left) {
                Ok(said) => self.said.push(said),
                Err(error) => panic!("'{what}' does not come ({error}): {:#?}", self.said),
            }
            if self.said.last().is_some_and(|said| is_so(said)) {
                return;
            }
        }
    }
}

/// The works, drawn and added up by the stencil at a number of instants, on a device that may be a software adapter.
pub(super) fn stencil_site(step: &str) -> (tempfile::TempDir, PathBuf) {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).expect("a site file");
    let text = text.replace("step = \"2h\"", &format!("step = \"{step}\"\ntechnique = \"stencil\""));
    std::fs::write(&site, text).expect("a site file");
    (folder, site)
}

const RESIZED: &str = "resizing::window_lives_that_is_resized_a_hundred_times";
const SIZES: usize = 100;

/// Continues drawing at any size, and returns the result.
fn resized_window() {
    let (_folder, site) = stencil_site("10min");
    let mut studies = 0;
    let mut sizes = std::collections::HashSet::new();
    let (mut size, mut changed, mut said) = (egui::Vec2::ZERO, Instant::now(), String::new());
    desktop::open_with(Some(&site), &on_any_thread, &mut |app, context| {
        let now = context.content_rect().size();
        if now != size {
            (size, changed) = (now, Instant::now());
            sizes.insert((now.x as u32, now.y as u32));
        }
        if !app.is_adding() && app.wanted_view().is_some() && changed.elapsed() < Duration::from_secs(1) {
            app.find_hours(context);
            studies += 1;
        }
        // a hand would draw frames, too
        context.request_repaint_after(Duration::from_millis(20));
        let faults = app.fault_and_notice();
        let state = if app.is_settled() { "settled" } else { "at work" };
        let now = format!("{} x {} {state} {faults:?}", size.x, size.y);
        if now != said {
            println!("{SAYS}{now}");
            said = now;
            if app.is_settled() {
                println!("{SAYS}after {studies} studies and {} sizes", sizes.len());
            }
        }
    })
    .expect("a window");
}

#[test]
fn window_lives_that_is_resized_a_hundred_times() {
    if shows_window_of(RESIZED) {
        return resized_window();
    }
    let (_server, display) = server(1);
    let mut window = Watched::start(RESIZED, &display);
    window.until("1280 x 760 settled [None, None]");
    let found = run("xdotool", &["search", "--name", "Gnomon"], &display).stdout;
    let id = String::from_utf8_lossy(&found).lines().last().expect("a window").to_owned();
    let resize = |width: usize, height: usize| {
        let size = [width, height].map(|side| side.to_string());
        assert!(run("xdotool", &["windowsize", &id, &size[0], &size[1]], &display).status.success());
    };
    for number in 0..SIZES {
        resize(700 + number * 37 % 540, 420 + number * 53 % 320);
        // while one picture after another is drawn, and in the midst of one
        std::thread::sleep(Duration::from_millis([40, 110][number % 2]));
        if number % 25 == 24 {
            // all of the screen, as a window that is maximised, and some pictures of it
            resize(1280, 760);
            std::thread::sleep(Duration::from_millis(1200));
        }
    }
    resize(1100, 700);
    window.until("1100 x 700 settled [None, None]");
    let (_, _, rgb) = screen(&display);
    assert!(shades(&rgb).iter().all(|share| *share > 0.01), "the picture is there: {:?}", shades(&rgb));
    let faults: Vec<_> = window.said.iter().filter(|said| said.contains("Some(")).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    // hours were found on the way, at many sizes
    window.until_any("after ");
    let last = window.said.last().cloned().unwrap_or_default();
    let numbers: Vec<usize> = last.split(' ').filter_map(|word| word.parse().ok()).collect();
    assert!(numbers[0] >= 2 && numbers[1] >= SIZES / 5, "{last}");
}
