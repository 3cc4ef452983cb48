//! A real window that is killed, before a real X server: the next one offers what was not saved.

use super::xvfb::{Running, run, server};
use super::{sample, small_site};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Waits for something; which is asked for again where a busy machine lost it.
fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(120), "{what} does not come");
        std::thread::sleep(Duration::from_millis(200));
    }
}

fn open(path: Option<&Path>, display: &str, home: &Path) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    if let Some(path) = path {
        command.arg("open").arg(path);
    }
    command
        .env("DISPLAY", display)
        .env_remove("WAYLAND_DISPLAY")
        .envs(["HOME", "XDG_DATA_HOME", "XDG_RUNTIME_DIR"].map(|name| (name, home)))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
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
    let mut first = Running(open(Some(&model), &display, home.path()));
    until("the window", || has_title("^Gnomon$"));
    std::thread::sleep(Duration::from_secs(3));
    until("the model, which is not saved", || {
        key(&["key", "ctrl+a"]);
        key(&["type", "48,2; 16,37"]);
        key(&["key", "Return"]);
        has_title("[^ ] works.glb .* Gnomon$")
    });
    until("what is kept", || kept().is_some_and(|kept| kept.contains("latitude = 48.2")));
    // SIGKILL
    first.0.kill().unwrap();
    first.0.wait().unwrap();

    // the next window offers it, and Enter restores it
    let mut second = Running(open(None, &display, home.path()));
    until("the window", || has_title("^Gnomon$"));
    until("what was not saved", || {
        key(&["key", "Return"]);
        has_title("[^ ] works.glb .* Gnomon$")
    });
    assert!(kept().is_some(), "it is still not saved");
    second.0.kill().unwrap();
    second.0.wait().unwrap();

    // one that opens another site offers it all the same
    let mut third = Running(open(Some(&sample("industry/site.toml")), &display, home.path()));
    until("the other site", || has_title("^industry/site.toml .* Gnomon$"));
    until("what was not saved", || {
        key(&["key", "Return"]);
        has_title("[^ ] works.glb .* Gnomon$")
    });
    assert!(third.0.try_wait().unwrap().is_none(), "the window is still open");
}
