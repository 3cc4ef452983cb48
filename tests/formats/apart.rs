//! Reading in a separate process: it gives the same model, and whatever goes wrong there becomes one clear error.

use crate::shared::program::site;
use gnomon::formats::{self, ModelReader, ReadOptions, ReadingListener, SceneName};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// The program itself.
pub(super) fn apart() -> ModelReader {
    ModelReader { program: Some(PathBuf::from(env!("CARGO_BIN_EXE_gnomon"))), ..ModelReader::default() }
}

#[test]
fn model_that_is_read_apart_is_the_same() {
    let folder = site();
    let (file, options) = (folder.path().join("tower.glb"), ReadOptions::default());
    let here = formats::read(&file, &options).unwrap();
    let there = apart().read_apart(&file, &options).unwrap();
    assert_eq!(format!("{here:?}"), format!("{there:?}"));
    assert!(here.triangles() == 12 && here.format == "glTF");
    // the reader of glTF is ours, and needs no program
    assert!(ModelReader::default().read(&file, &options).is_ok());
    let told = ModelReader::default().read_apart(&file, &options).unwrap_err().to_string();
    assert!(told.contains("name a program"), "{told}");
}

#[test]
fn mistakes_in_a_file_are_told_as_elsewhere() {
    let folder = site();
    let (file, options) = (folder.path().join("bad.glb"), ReadOptions::default());
    std::fs::write(&file, b"glTF no more").unwrap();
    let [here, there] = [formats::read(&file, &options), apart().read_apart(&file, &options)];
    assert_eq!(here.unwrap_err().to_string(), there.unwrap_err().to_string());
}

#[test]
fn program_that_is_not_there_is_told() {
    let folder = site();
    let nowhere = ModelReader { program: Some(folder.path().join("no-program")), ..ModelReader::default() };
    let told = nowhere.read_apart(&folder.path().join("tower.glb"), &ReadOptions::default()).unwrap_err().to_string();
    assert!(told.contains("no process can be started"), "{told}");
}

/// Formats that need third-party code are read by the named program, and all others are not.
#[test]
fn readers_of_others_run_apart() {
    let folder = site();
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.path().join(name), bytes).unwrap();
    let (_, draco) = super::compressed::draco();
    write("draco.gltf", draco.to_string().as_bytes());
    write("hill.tif", b"II*\0");
    write("tileset.json", br#"{"geometricError":1,"root":{}}"#);
    write("house.ifc", b"ISO-10303-21;");
    write("points.las", b"LASF");
    let nowhere = ModelReader { program: Some(folder.path().join("no-program")), ..ModelReader::default() };
    let is_apart = |name: &str, options: &ReadOptions| {
        let read = nowhere.read(&folder.path().join(name), options);
        read.is_err_and(|error| error.to_string().contains("no process can be started"))
    };
    let options = ReadOptions::default();
    for name in ["draco.gltf", "hill.tif", "tileset.json", "house.ifc", "points.las"] {
        assert!(is_apart(name, &options), "{name}");
    }
    assert!(!is_apart("tower.glb", &options));
    // the face knows by which key a scene was asked for that is not there
    let scene = ReadOptions { scene: Some(SceneName::Number(9)), ..ReadOptions::default() };
    assert!(!is_apart("draco.gltf", &scene));
    let file = folder.path().join("draco.gltf");
    let (here, there) = (formats::read(&file, &options).unwrap(), apart().read(&file, &options).unwrap());
    assert_eq!(format!("{here:?}"), format!("{there:?}"));
}

/// What is read is heard of, and what nobody needs any more is not read, nor used.
#[test]
fn reading_is_heard_and_given_up() {
    let folder = site();
    let heard = Arc::new(Mutex::new(Vec::new()));
    let hears = Arc::clone(&heard);
    let given_up = Arc::new(AtomicBool::new(false));
    let gives_up = Arc::clone(&given_up);
    let listener = ReadingListener::new(move |path| {
        hears.lock().unwrap().push(path.map(|path| path.file_name().unwrap().to_owned()));
        // the second one while it is read
        gives_up.store(hears.lock().unwrap().len() == 3, Ordering::Relaxed);
    });
    let reading = ModelReader::default().until(&given_up).heard_by(listener);
    let read = |name: &str| reading.read(&folder.path().join(name), &ReadOptions::default());
    assert!(read("tower.glb").is_ok());
    assert!(read("open.glb").is_err_and(|error| error.is_given_up()));
    let names = [Some("tower.glb"), None, Some("open.glb"), None].map(|name| name.map(std::ffi::OsString::from));
    assert_eq!(*heard.lock().unwrap(), names);
}

/// Programs that do what a bad reader may do.
#[cfg(unix)]
mod bad_readers {
    use super::*;
    use gnomon::cli::Options;
    use gnomon::formats::{ModelError, ModelFault, ReadLimits};
    use gnomon::message::Worded as _;
    use std::io::Write;
    use std::path::Path;
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    /// A program; another process writes it, since a file that is still open here cannot be started.
    fn program(folder: &Path, text: &str) -> PathBuf {
        let path = folder.join("reader.sh");
        let mut writer = Command::new("sh")
            .args(["-c", "cat > \"$0\" && chmod +x \"$0\""])
            .arg(&path)
            .stdin(Stdio::piped())
            .spawn()
            .unwrap();
        writer.stdin.take().unwrap().write_all(format!("#!/bin/sh\n{text}\n").as_bytes()).unwrap();
        assert!(writer.wait().unwrap().success());
        path
    }

    /// The result of a model that such a program reads, within a few seconds whatever it does.
    fn read(text: &str, limits: ReadLimits, given_up: &Arc<AtomicBool>) -> ModelError {
        let folder = site();
        let program = Some(program(folder.path(), text));
        let reading = ModelReader { program, limits, ..ModelReader::default().until(given_up) };
        let begun = Instant::now();
        let error = reading.read_apart(&folder.path().join("tower.glb"), &ReadOptions::default()).unwrap_err();
        assert!(begun.elapsed() < Duration::from_secs(30), "{text} took {:?}", begun.elapsed());
        assert!(error.to_string().contains("tower.glb: "), "{error} names the file");
        error
    }

    fn told(text: &str) -> String {
        read(text, ReadLimits::default(), &Arc::default()).to_string()
    }

    #[test]
    fn one_that_hangs_is_ended() {
        let limits = ReadLimits { time: Duration::from_millis(300), memory: None };
        let error = read("exec sleep 600", limits, &Arc::default());
        let told = error.message().in_words(&Options);
        assert!(told.contains("takes longer to read than") && told.contains("--read-time 1h"), "{told}");
    }

    #[test]
    fn one_that_takes_all_memory_is_ended() {
        let limits = ReadLimits { memory: Some(200 << 20), ..ReadLimits::default() };
        let error = read("exec tail /dev/zero", limits, &Arc::default());
        let told = error.message().in_words(&Options);
        assert!(told.contains("takes more memory to read than 200 MiB"), "{told}");
        assert!(told.contains("--read-memory"), "{told}");
        // a face without such an option names none
        assert!(!error.to_string().contains("memory to read a model"), "{error}");
    }

    #[test]
    fn one_that_breaks_off_is_told_with_its_last_words() {
        let told = told("echo \"thread 'main' panicked at reader.rs:7:\" >&2; echo 'no such wall' >&2; exit 101");
        assert!(told.contains("its reader failed") && told.contains("no such wall"), "{told}");
        assert!(super::bad_readers::told("kill -ABRT $$").contains("signal: 6"));
        let long = "x".repeat(300);
        for (said, ends) in [
            ("info: loaded libEGL\\nhint: libEGL, see man", "failed (exit status: 3)"),
            ("gnomon: no such door\\nnote: run with `RUST_BACKTRACE=1`", "(exit status: 3): gnomon: no such door"),
            (
                "thread '<unnamed>' (12) panicked at a.rs:1:\\nno floor\\nnote: run with it\\nlibEGL warning",
                ": no floor",
            ),
            (&format!("gnomon: {long}"), &format!(": gnomon: {}", &long[..192])),
        ] {
            let told = super::bad_readers::told(&format!("printf \"%b\\n\" \"{}\" >&2; exit 3", said.replace('`', "")));
            let what = told.split("; export it again").next().unwrap_or_default();
            assert!(what.ends_with(ends), "{told}");
        }
    }

    #[test]
    fn one_that_gives_something_else_is_told() {
        assert!(told("echo 'a model, I promise, of many a wall'").contains("they begin with a different mark"));
        let cut = format!("\"{}\" \"$@\" | head -c 400", env!("CARGO_BIN_EXE_gnomon"));
        assert!(told(&cut).contains("they end early"));
    }

    /// On a terminal Ctrl-C reaches the reader, too, and it may end before anybody here hears of it.
    #[test]
    fn one_that_ctrl_c_ends_is_given_up() {
        // a run in the background ignores the signal, and so would the reader
        let script = "exec env --default-signal=INT sh -c 'kill -INT $$; sleep 600'";
        let error = read(script, ReadLimits::default(), &Arc::default());
        assert!(error.is_given_up(), "{error}");
    }

    #[test]
    fn one_that_nobody_waits_for_is_ended() {
        let given_up = Arc::new(AtomicBool::new(false));
        let sets = Arc::clone(&given_up);
        let setter = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(200));
            sets.store(true, Ordering::Relaxed);
        });
        let error = read("exec sleep 600", ReadLimits::default(), &given_up);
        setter.join().unwrap();
        assert!(matches!(error.fault, ModelFault::GivenUp) && error.is_given_up(), "{error}");
    }
}
