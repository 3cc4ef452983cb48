//! Only one study at a time works in a folder, and what a dead one left there is not in the way.

use super::bytes;
use crate::shared::program::{command, done, fails, files, gnomon, numberless, site, stderr};
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Stdio};

/// A study that takes minutes, once it has begun to write.
fn running(folder: &Path, arguments: &str) -> Child {
    let mut child = command(folder, arguments).stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
    let out = folder.join("out");
    let has_begun = || out.is_dir() && numberless(&out).iter().any(|name| name == "shadow.bits.N.unfinished");
    while !has_begun() {
        assert!(child.try_wait().unwrap().is_none(), "it ended early");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child
}

fn killed(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

const LONG: &str = "profile . --technique ray-cast --size 200 --from 8:00 --to 18:00 --step 1s --bits";
const SHORT: &str = "profile . --engine cpu --size 20";

#[test]
fn a_folder_in_which_a_study_works_is_locked() {
    let folder = site();
    let path = folder.path();
    fs::create_dir(path.join("masks")).unwrap();
    let first = running(path, &format!("{LONG} --masks masks"));
    let before: Vec<String> = files(&path.join("out")).into_keys().collect();
    let process = format!("process {} on ", first.id());
    for (asked, named) in [
        (SHORT.to_owned(), "out"),
        (format!("{SHORT} --out out/../out"), "out/../out"),
        (format!("{SHORT} --out other --masks masks"), "masks"),
        (format!("{SHORT} --out masks"), "masks"),
        ("profile . --receivers surfaces --engine cpu".to_owned(), "out"),
        ("animate . --engine cpu --size 20".to_owned(), "out"),
        ("compare . open.glb --engine cpu --size 20".to_owned(), "out"),
    ] {
        let words =
            [named, "another study is working there", "since 20", &process, "gnomon profile . --technique ray-cast"];
        fails(path, &asked, 1, &words);
        fails(path, &asked, 1, &["wait until it is done, or choose another folder"]);
    }
    let after: Vec<String> = files(&path.join("out")).into_keys().collect();
    assert_eq!(before, after);
    // elsewhere nobody is in the way, and one drawing in the same folder is in nobody's
    done(path, &format!("{SHORT} --out other --masks other"));
    done(path, "shadow . --engine cpu --size 20 --at 2026-09-18T11:00 --out out/shadow.png");
    assert!(!path.join("other/.gnomon.lock").exists());
    killed(first);
}

/// Neither its lock nor its incomplete files hinder the next one, or remain after it.
#[test]
fn a_killed_study_bars_nobody() {
    let folder = site();
    let path = folder.path();
    done(path, &format!("{SHORT} --out alone"));
    let first = running(path, LONG);
    let number = first.id();
    killed(first);
    let left: Vec<String> = files(&path.join("out")).into_keys().collect();
    assert!(left.len() == 2 && left[0] == ".gnomon.lock" && left[1].starts_with("shadow.bits."), "{left:?}");
    let lock = fs::read_to_string(path.join("out/.gnomon.lock")).unwrap();
    assert!(lock.starts_with(&format!("process {number} on ")), "{lock}");
    for name in [".profile.png.7-0.tmp", ".shadow-hours.tif.123-45.tmp", ".profile.json.1-1.tmp"] {
        fs::write(path.join("out").join(name), "half").unwrap();
    }
    // what is not known to be of such a study is left alone
    let others = [".house.png.7-0.tmp", ".profile.png.tmp", "profile.png.7-0.tmp", "shadow.bits.unfinished"];
    for name in others {
        fs::write(path.join("out").join(name), "another's").unwrap();
    }
    done(path, SHORT);
    for name in others {
        assert_eq!(bytes(&path.join("out").join(name)), b"another's", "{name}");
        fs::remove_file(path.join("out").join(name)).unwrap();
    }
    let [ours, alone] = ["out", "alone"].map(|out| files(&path.join(out)));
    assert!(ours == alone, "{:?}", ours.keys());
}

/// If there is a link in place of the lock, its target is not written to.
#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_the_lock_is_not_followed() {
    let folder = site();
    let path = folder.path();
    let model = bytes(&path.join("tower.glb"));
    fs::create_dir(path.join("out")).unwrap();
    std::os::unix::fs::symlink("../tower.glb", path.join("out/.gnomon.lock")).unwrap();
    fails(path, SHORT, 1, &["out", ".gnomon.lock is not a file"]);
    assert!(bytes(&path.join("tower.glb")) == model);
    // a lock that another user left, whose file we may not write to, is taken over
    fs::remove_file(path.join("out/.gnomon.lock")).unwrap();
    fs::write(path.join("out/.gnomon.lock"), "process 1 on another host").unwrap();
    let mut readonly = path.join("out/.gnomon.lock").metadata().unwrap().permissions();
    readonly.set_readonly(true);
    fs::set_permissions(path.join("out/.gnomon.lock"), readonly).unwrap();
    done(path, SHORT);
    assert!(!path.join("out/.gnomon.lock").exists());
}

/// A study whose folder is gone ends with an error, since nobody would find its results.
#[cfg(unix)]
#[test]
fn a_folder_that_vanishes_is_told() {
    let folder = site();
    let path = folder.path();
    let asked = "profile . --technique ray-cast --size 150 --from 8:00 --to 18:00 --step 1min";
    let mut child = command(path, asked).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let mut told = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(told.any(|line| line.trim_start().starts_with("10%")), "it ended early");
    fs::remove_dir_all(path.join("out")).unwrap();
    let last = told.last().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(1), "{last}");
    assert!(
        last.starts_with("error: ")
            && last.contains("out: the folder, or its .gnomon.lock, was removed while the study worked"),
        "{last}"
    );
    assert!(!path.join("out/profile.png").exists() && !path.join("out/profile.json").exists());
    // all is well again
    assert!(!stderr(&gnomon(path, SHORT)).contains("error"));
}
