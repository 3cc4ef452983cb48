//! A real window that is killed, on a real X server: the next one offers the unsaved settings.

use super::xvfb::{Running, keep_screen, run, server};
use super::{sample, small_site};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A window on a display, and the file with its output.
struct Window<'a> {
    process: Running,
    display: &'a str,
    says: PathBuf,
}

impl Window<'_> {
    /// Waits for something, and repeats the request if a busy machine lost it.
    fn until(&mut self, what: &str, mut is_so: impl FnMut() -> bool) {
        let begun = Instant::now();
        while !is_so() {
            let ended = self.process.0.try_wait().unwrap();
            if ended.is_some() || begun.elapsed() > Duration::from_secs(180) {
                let kept = keep_screen(self.display, what);
                let said = std::fs::read_to_string(&self.says).unwrap();
                panic!("{what} does not come: {}; the window (ended: {ended:?}) said: {said}", kept.display());
            }
            std::thread::sleep(Duration::from_millis(200));
        }
    }

    /// SIGKILL.
    fn kill(mut self) {
        self.process.0.kill().unwrap();
        self.process.0.wait().unwrap();
    }
}

fn open<'a>(path: Option<&Path>, display: &'a str, home: &Path) -> Window<'a> {
    let says = home.join("says");
    let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    if let Some(path) = path {
        command.arg("open").arg(path);
    }
    let process = command
        .env("DISPLAY", display)
        .env_remove("WAYLAND_DISPLAY")
        .envs(["HOME", "XDG_DATA_HOME", "XDG_RUNTIME_DIR"].map(|name| (name, home)))
        .stdout(Stdio::null())
        .stderr(std::fs::File::create(&says).unwrap())
        .spawn()
        .unwrap();
    Window { process: Running(process), display, says }
}

#[test]
fn killed_window_loses_nothing() {
    let (_server, display) = server(3);
    let home = tempfile::tempdir().unwrap();
    let (folder, site) = small_site();
    std::fs::remove_file(site).unwrap();
    let model = folder.path().join("works.glb");
    let recovery = home.path().join("gnomon/recovery");
    let kept = || {
        let entries = recovery.read_dir().ok()?.flatten();
        let file = entries.map(|entry| entry.path()).find(|path| path.extension().is_some_and(|is| is == "json"))?;
        std::fs::read_to_string(file).ok()
    };
    // a letter before the name is the mark; xdotool reads the title as Latin-1
    let has_title = |title: &str| run("xdotool", &["search", "--name", title], &display).status.success();
    // no window manager gives it the keys
    let key = |keys: &[&str]| {
        run("xdotool", &["search", "--name", "Gnomon", "windowfocus"], &display);
        std::thread::sleep(Duration::from_millis(300));
        run("xdotool", keys, &display);
        std::thread::sleep(Duration::from_millis(1500));
    };

    // the field for the place has the keys, and Enter opens the model there
    let mut window = open(Some(&model), &display, home.path());
    window.until("the window", || has_title("^Gnomon$"));
    std::thread::sleep(Duration::from_secs(3));
    window.until("the model, which is not saved", || {
        key(&["key", "ctrl+a"]);
        key(&["type", "48,2; 16,37"]);
        key(&["key", "Return"]);
        has_title("[^ ] works.glb .* Gnomon$")
    });
    window.until("what is kept", || kept().is_some_and(|kept| kept.contains("latitude = 48.2")));
    window.kill();

    // the next window offers it, and Enter restores it
    let mut window = open(None, &display, home.path());
    window.until("the window", || has_title("^Gnomon$"));
    window.until("what was not saved", || {
        key(&["key", "Return"]);
        has_title("[^ ] works.glb .* Gnomon$")
    });
    assert!(kept().is_some(), "it is still not saved");
    window.kill();

    // one that opens another site offers it all the same
    let mut window = open(Some(&sample("industry/site.toml")), &display, home.path());
    window.until("the other site", || has_title("^industry/site.toml .* Gnomon$"));
    window.until("what was not saved", || {
        key(&["key", "Return"]);
        has_title("[^ ] works.glb .* Gnomon$")
    });
    assert!(window.process.0.try_wait().unwrap().is_none(), "the window is still open");
}
