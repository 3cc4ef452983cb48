//! Runs the program as its users do, in folders of its own, and reads what it leaves there.

use crate::model::{F32, Model, U16};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

pub(crate) const STUDY: &str = "[study]\ndate = 2026-09-18\nfrom = \"10:00\"\nto = \"12:00\"\nstep = \"30min\"\n";
pub(crate) const PLACE: &str = "[place]\nname = \"Paris\"\nlatitude = 48.8583\nlongitude = 2.2945\n";

/// A closed box of 10 × 10 × 20 m on the ground, as a binary glTF; without its lid where `open`.
fn tower(open: bool) -> Vec<u8> {
    let mut model = Model::new();
    let corners: Vec<f32> = (0..8)
        .flat_map(|i| [(i & 1) as f32 * 10.0 - 5.0, (i >> 2) as f32 * 20.0, ((i >> 1) & 1) as f32 * -10.0 + 5.0])
        .collect();
    // East, north, up are x, −z and y: sides counter-clockwise from outside.
    let sides: [[u16; 4]; 6] = [[4, 5, 7, 6], [0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices: Vec<u16> =
        sides[usize::from(open)..].iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    let floats: Vec<u8> = corners.iter().flat_map(|number| number.to_le_bytes()).collect();
    let positions = model.accessor("VEC3", F32, 8, &floats);
    let indices = model.accessor("SCALAR", U16, indices.len(), &bytes);
    model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    model.json["nodes"] = json!([{"mesh": 0, "name": "tower"}]);
    model.glb()
}

/// A folder with a tower and its site.
pub(crate) fn site() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("tower.glb"), tower(false)).unwrap();
    fs::write(folder.path().join("open.glb"), tower(true)).unwrap();
    let text = format!("{PLACE}[[model]]\npath = \"tower.glb\"\n{STUDY}");
    fs::write(folder.path().join("site.toml"), text).unwrap();
    folder
}

pub(crate) fn command(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gnomon"));
    command.current_dir(folder).args(arguments.split_whitespace());
    // where it is not set drivers say so, and the command's own words are all that may be told
    command.env("XDG_RUNTIME_DIR", folder);
    command
}

pub(crate) fn gnomon(folder: &Path, arguments: &str) -> Output {
    command(folder, arguments).output().unwrap()
}

/// Standard output of a command that must succeed.
pub(crate) fn done(folder: &Path, arguments: &str) -> String {
    let output = gnomon(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments}: {}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Expects a failure with a message of one line that contains these words.
pub(crate) fn fails(folder: &Path, arguments: &str, status: i32, words: &[&str]) {
    let output = gnomon(folder, arguments);
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(status), "{arguments}: {told}");
    assert!(output.stdout.is_empty(), "{arguments}");
    assert!(told.starts_with("error: ") && told.lines().count() == 1, "{arguments}: {told}");
    for word in words {
        assert!(told.contains(word), "{arguments}: {told:?} does not say {word:?}");
    }
}

/// The names in a folder, in order.
pub(crate) fn names(folder: PathBuf) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// How many pixels of a drawing meet a condition.
pub(crate) fn pixels(path: PathBuf, so: impl Fn([u8; 3]) -> bool) -> usize {
    image::open(path).unwrap().into_rgb8().pixels().filter(|pixel| so(pixel.0)).count()
}

/// All files of a folder, without timings.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            found.extend(files(&entry.path()).into_iter().map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
            continue;
        }
        let mut bytes = fs::read(entry.path()).unwrap();
        if name.ends_with(".json") {
            let mut json: Value = serde_json::from_slice(&bytes).unwrap();
            json["timings_secs"] = Value::Null;
            bytes = json.to_string().into_bytes();
        }
        found.insert(name, bytes);
    }
    found
}

/// The names of a folder's files, without the numbers of studies.
pub(crate) fn numberless(folder: &Path) -> Vec<String> {
    let short = |name: String| match name.strip_suffix(".unfinished").and_then(|name| name.rsplit_once('.')) {
        Some((words, number)) if number.len() == 16 => format!("{words}.N.unfinished"),
        _ => name,
    };
    let mut names: Vec<String> = files(folder).into_keys().map(short).collect();
    names.sort();
    names
}

/// The sums that the only stopped study in a folder has stored.
pub(crate) fn left(folder: &Path) -> PathBuf {
    let is_it = |name: &String| name.starts_with("profile.") && name.ends_with(".unfinished") && !name.contains("sums");
    let found: Vec<String> = files(folder).into_keys().filter(is_it).collect();
    assert_eq!(found.len(), 1, "{found:?}");
    folder.join(&found[0])
}

/// Starts a study, stops it with Ctrl-C when it has reported some progress, and returns its output.
#[cfg(unix)]
pub(crate) fn stopped(folder: &Path, arguments: &str, when: &str) -> String {
    use std::io::{BufRead, BufReader, Write};
    use std::process::Stdio;
    let asked = command(folder, arguments);
    // on a busy machine it gives way to who stops it
    let mut study = Command::new("nice");
    study.args(["-n", "5"]).arg(asked.get_program()).args(asked.get_args()).current_dir(folder);
    study.envs(asked.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let mut child = study.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    // it waits already: starting it takes as long as some hundred instants
    let kill = format!("read line && kill -INT {}", child.id());
    let mut killer = Command::new("sh").args(["-c", &kill]).stdin(Stdio::piped()).spawn().unwrap();
    let mut ask = killer.stdin.take();
    let mut told = String::new();
    for line in BufReader::new(child.stderr.take().unwrap()).lines() {
        let line = line.unwrap();
        if line.trim_start().starts_with(when)
            && let Some(mut ask) = ask.take()
        {
            ask.write_all(b"now\n").unwrap();
        }
        told += &(line + "\n");
    }
    drop(ask);
    killer.wait().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{told}");
    told
}
