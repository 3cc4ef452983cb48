//! The real window on a real X server, with pointer and keys. `tests/run.sh` installs what that needs.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A program that ends with the test.
pub(super) struct Running(pub(super) Child);

impl Drop for Running {
    fn drop(&mut self) {
        // it may have ended by itself
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

pub(super) fn run(program: &str, arguments: &[&str], display: &str) -> std::process::Output {
    let output = Command::new(program).args(arguments).env("DISPLAY", display).output();
    output.unwrap_or_else(|error| panic!("{program}: {error}; tests/run.sh installs it"))
}

/// The screen as rows of red, green and blue: an X window dump of 32 bits a pixel, blue first.
pub(super) fn screen(display: &str) -> (u32, u32, Vec<u8>) {
    let dump = run("xwd", &["-root", "-silent", "-display", display], display).stdout;
    let word = |at: usize| u32::from_be_bytes(dump[at * 4..at * 4 + 4].try_into().unwrap());
    let (header, width, height, line, colours) = (word(0), word(4), word(5), word(12), word(19));
    assert_eq!(word(11), 32, "bits a pixel");
    let pixels = &dump[header as usize + colours as usize * 12..];
    let rows = pixels.chunks(line as usize).take(height as usize);
    let rgb = rows.flat_map(|row| row[..width as usize * 4].chunks(4).flat_map(|p| [p[2], p[1], p[0]])).collect();
    (width, height, rgb)
}

/// Keeps the screen as a picture, for whoever reads why a test failed; returns where.
pub(super) fn keep_screen(display: &str, what: &str) -> PathBuf {
    let (width, height, rgb) = screen(display);
    keep(what, &rgb, width, height)
}

fn keep(what: &str, rgb: &[u8], width: u32, height: u32) -> PathBuf {
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("window-{}.png", what.replace([' ', ','], "-")));
    image::save_buffer(&kept, rgb, width, height, image::ColorType::Rgb8).unwrap();
    kept
}

/// Asks the hand to act, again where a busy machine lost what it did, until the screen is as it should be; and keeps that.
fn until(display: &str, what: &str, mut hand: impl FnMut(), is_so: impl Fn(&[u8]) -> bool) -> Vec<u8> {
    let begun = Instant::now();
    loop {
        hand();
        let acted = Instant::now();
        while acted.elapsed() < Duration::from_secs(12) {
            let (width, height, rgb) = screen(display);
            let (is_so, late) = (is_so(&rgb), begun.elapsed() > Duration::from_secs(180));
            if is_so || late {
                let kept = keep(what, &rgb, width, height);
                assert!(is_so, "{what} does not come: {}", kept.display());
                return rgb;
            }
            std::thread::sleep(Duration::from_millis(200));
        }
    }
}

/// The shares of the picture's middle that lie in the sun, and in a shadow by day.
pub(super) fn shades(rgb: &[u8]) -> [f64; 2] {
    let rows = (120..560).flat_map(|row| rgb[(row * 1280 + 320) * 3..(row * 1280 + 1240) * 3].chunks(3));
    let (mut sun, mut shadow, mut all) = (0.0, 0.0, 0.0);
    for pixel in rows {
        all += 1.0;
        match pixel[0] {
            225.. => sun += 1.0,
            100..190 if pixel[2] > pixel[0] => shadow += 1.0,
            _ => {}
        }
    }
    [sun / all, shadow / all]
}

/// An X server without a screen, and its name; each test of this process has its own number.
pub(super) fn server(of_test: u32) -> (Running, String) {
    let number = 200 + (std::process::id() * 5 + of_test) % 2400;
    let display = format!(":{number}");
    let server = Command::new("Xvfb")
        // without it the server begins again when its last client goes, and drops those who come meanwhile
        .args([&display, "-screen", "0", "1280x760x24", "-nolisten", "tcp", "-noreset"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let server = Running(server.unwrap_or_else(|error| panic!("Xvfb: {error}; tests/run.sh installs it")));
    let begun = Instant::now();
    while !run("xdotool", &["getdisplaygeometry"], &display).status.success() {
        assert!(begun.elapsed() < Duration::from_secs(20), "Xvfb does not answer");
        std::thread::sleep(Duration::from_millis(50));
    }
    (server, display)
}

#[test]
fn real_window_opens_scrubs_and_closes() {
    let (_server, display) = server(0);
    let home = tempfile::tempdir().unwrap();
    let window = Command::new(env!("CARGO_BIN_EXE_gnomon"))
        .args(["open", "sites/industry"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("DISPLAY", &display)
        .env_remove("WAYLAND_DISPLAY")
        .env("HOME", home.path())
        .env("XDG_DATA_HOME", home.path())
        .env("XDG_RUNTIME_DIR", home.path())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut window = Running(window);
    let first = until(&display, "the works in the sun", || (), |rgb| shades(rgb).iter().all(|share| *share > 0.02));
    let act = |arguments: &[&str]| {
        assert!(run("xdotool", arguments, &display).status.success(), "{arguments:?}");
        // as slow as a hand
        std::thread::sleep(Duration::from_millis(200));
    };
    // no window manager gives it the keys
    act(&["search", "--name", "Gnomon", "windowfocus"]);
    // an hour by the keyboard: the shadows move
    let key = || act(&["key", "shift+Right"]);
    let differ = |rgb: &[u8]| rgb.chunks(3).zip(first.chunks(3)).filter(|(a, b)| a != b).count();
    until(&display, "an hour later", key, |rgb| differ(rgb) > 3_000);
    // to the left end of the day by the pointer: night
    let drag = || {
        act(&["mousemove", "640", "684", "mousedown", "1"]);
        act(&["mousemove", "300", "684"]);
        act(&["mousemove", "60", "684"]);
        act(&["mouseup", "1"]);
    };
    until(&display, "the night", drag, |rgb| shades(rgb)[0] < 0.02);
    assert!(window.0.try_wait().unwrap().is_none(), "the window is still open");
}

/// Without a display the command says so, and does not crash.
#[test]
fn no_display_is_told() {
    let output = Command::new(env!("CARGO_BIN_EXE_gnomon"))
        .arg("open")
        .arg("sites/tower")
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8_lossy(&output.stderr);
    let told = told.lines().find(|line| line.starts_with("error: the window")).unwrap_or_else(|| panic!("{told}"));
    assert!(told.contains("without a display"), "{told}");
}
