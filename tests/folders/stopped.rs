//! The files of a stopped study are verified when they are resumed, and other studies do not remove them.

use super::bytes;
use crate::shared::program::{command, done, files, gnomon, left, numberless, site, stderr, stopped};
use gnomon::deliver::disk::unfinished::{self, Checks, StoredStudy};
use gnomon::profile::{Statistics, Unfinished};
use std::fs;
use std::path::Path;
use std::process::Stdio;

#[test]
fn one_flipped_bit_is_noticed_wherever_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let statistics = Statistics { cells: 7, silhouette_cells: Some(3), fragments: 90, fragments_without_mask: 1 << 40 };
    for (shaded, statistics) in
        [(vec![1_u32, 70_000, 0, 255].into(), None), (vec![1_u64 << 40, 3, 0].into(), Some(statistics))]
    {
        let begun = Unfinished { study: 0x12ab, tiles: 3, done: 17, shaded, statistics };
        let checks = Checks { bits: 5, sums: u64::MAX, masks: vec![1, 2, 3] };
        unfinished::keep(folder.path(), &begun, &checks).unwrap();
        let path = folder.path().join("profile.00000000000012ab.unfinished");
        let kept = || unfinished::kept(folder.path(), 0x12ab).unwrap();
        assert!(matches!(kept(), StoredStudy::Whole(whole) if *whole == (begun.clone(), checks.clone())));
        let right = bytes(&path);
        for at in 0..right.len() {
            let mut wrong = right.clone();
            wrong[at] ^= 1 << (at % 8);
            fs::write(&path, wrong).unwrap();
            assert!(matches!(kept(), StoredStudy::Damaged), "byte {at}");
        }
        for length in [0, 8, 20, right.len() - 1] {
            fs::write(&path, &right[..length]).unwrap();
            assert!(matches!(kept(), StoredStudy::Damaged), "{length} bytes");
        }
        fs::write(&path, [&right[..], &[0]].concat()).unwrap();
        assert!(matches!(kept(), StoredStudy::Damaged), "a byte more");
        // whole, and of another study
        fs::write(folder.path().join("profile.00000000000012ac.unfinished"), &right).unwrap();
        assert!(matches!(unfinished::kept(folder.path(), 0x12ac).unwrap(), StoredStudy::Damaged));
        assert!(matches!(unfinished::kept(folder.path(), 0x12ad).unwrap(), StoredStudy::Nothing));
    }
}

const STUDY: &str = "profile . --technique ray-cast --size 64 --from 9:00 --to 15:00 --step 1min --write tif,json";

/// Flips a bit of a file: of the first cells of bits and sums, which are done first, or in the middle.
fn flip(path: &Path) {
    let mut wrong = bytes(path);
    let name = path.file_name().unwrap().to_str().unwrap();
    let at = match name.split('.').nth(1) {
        Some("bits") => u64::from_le_bytes(wrong[8..16].try_into().unwrap()) as usize + 1,
        Some("sums") => 5,
        _ => wrong.len() / 2,
    };
    wrong[at] ^= 4;
    fs::write(path, wrong).unwrap();
}

#[test]
fn damaged_files_are_not_gone_on_with() {
    let folder = site();
    let path = folder.path();
    // masks go with a plan in one go, and sums with one in tiles
    let whole = format!("{STUDY} --bits --masks masks");
    let tiles = format!("{STUDY} --bits --memory 40KiB");
    for (name, asked, damaged) in [
        ("whole", whole.as_str(), &["profile.", "shadow.bits.", "mask-0003.png"][..]),
        ("tiles", tiles.as_str(), &["profile.", "shadow.bits.", "profile.sums."]),
    ] {
        let asked = |out: &str| asked.replace("--masks masks", &format!("--masks {out}/masks")) + " --out " + out;
        let right = format!("right-{name}");
        done(path, &asked(&right));
        let right = files(&path.join(&right));
        for file in damaged {
            let out = format!("{name}-{}", file.trim_end_matches('.'));
            stopped(path, &asked(&out), "70%");
            let number = left(&path.join(&out));
            let number = number.file_name().unwrap().to_str().unwrap().strip_prefix("profile.").unwrap();
            let file = if file.ends_with('.') { format!("{file}{number}") } else { format!("masks/{file}") };
            flip(&path.join(&out).join(&file));
            let told = stderr(&gnomon(path, &asked(&out)));
            assert!(
                !told.contains("continues")
                    && told.contains(&format!("{out}/{file} was changed since the study was stopped")),
                "{told}"
            );
            assert!(told.contains("starts over"), "{told}");
            assert!(files(&path.join(&out)) == right, "{out}: {:?}", files(&path.join(&out)).keys());
        }
        // and where nothing is, it goes on
        stopped(path, &asked("well"), "40%");
        let told = stderr(&gnomon(path, &asked("well")));
        assert!(told.contains("continues where it was stopped") && !told.contains("starts over"), "{told}");
        assert!(files(&path.join("well")) == right, "{name}");
        fs::remove_dir_all(path.join("well")).unwrap();
    }
}

/// Another study wrote into the same folder of masks meanwhile.
#[test]
fn masks_of_another_study_are_not_kept() {
    let folder = site();
    let path = folder.path();
    let study = |date: &str, out: &str| format!("{STUDY} --date {date} --masks masks --out {out}");
    done(path, &study("2026-09-18", "right").replace("--masks masks", "--masks right-masks"));
    stopped(path, &study("2026-09-18", "out"), "50%");
    done(path, &study("2026-06-18", "other"));
    let told = stderr(&gnomon(path, &study("2026-09-18", "out")));
    assert!(
        told.contains("masks/mask-0000.png was changed since the study was stopped") && told.contains("starts over"),
        "{told}"
    );
    assert!(files(&path.join("masks")) == files(&path.join("right-masks")));
    assert!(files(&path.join("out")) == files(&path.join("right")));
    // those beyond a shorter study's are told of
    let told = stderr(&gnomon(path, &study("2026-09-18", "short").replace("1min", "1h")));
    assert!(told.contains("masks/mask-0007.png and the masks after it belong to another study"), "{told}");
    assert!(!stderr(&gnomon(path, &study("2026-09-18", "out"))).contains("of another study"));
}

#[test]
fn several_stopped_studies_lie_side_by_side() {
    let folder = site();
    let path = folder.path();
    let study = |date: &str, out: &str| format!("{STUDY} --date {date} --bits --out {out}");
    let dates = ["2026-09-18", "2026-06-18", "2026-03-18"];
    for date in &dates[..2] {
        let told = stopped(path, &study(date, "out"), "40%");
        assert!(!told.contains("starts over"), "{told}");
    }
    let both = ["profile.N.unfinished", "profile.N.unfinished", "shadow.bits.N.unfinished", "shadow.bits.N.unfinished"];
    assert_eq!(numberless(&path.join("out")), both);
    // a third one is done, says what is there, and leaves it
    let told = stderr(&gnomon(path, &study(dates[2], "out").replace("1min", "1h")));
    assert!(told.contains(".unfinished and another one keep other studies that were stopped"), "{told}");
    assert!(
        told.contains("continues when the same request is made again") && told.contains("can be removed"),
        "{told}"
    );
    assert!(numberless(&path.join("out")).starts_with(&both.map(str::to_owned)[..2]));
    // bits without what their study kept are nobody's
    let orphan = path.join("out/shadow.bits.0123456789abcdef.unfinished");
    fs::write(&orphan, "of a study that was killed").unwrap();
    for (date, others) in dates[..2].iter().zip([1, 0]) {
        let told = stderr(&gnomon(path, &study(date, "out")));
        assert!(told.contains("continues where it was stopped"), "{told}");
        assert_eq!(told.matches("keeps another study").count(), others, "{told}");
        assert!(!orphan.exists());
        done(path, &study(date, "alone"));
        for name in ["shadow-hours.tif", "shadow.bits"] {
            assert!(bytes(&path.join("out").join(name)) == bytes(&path.join("alone").join(name)), "{date}: {name}");
        }
    }
    assert_eq!(numberless(&path.join("out")), ["profile.json", "shadow-hours.tif", "shadow.bits"]);
}

/// The files of a stopped study still exist after the next run was killed.
#[test]
fn a_killed_study_goes_on_from_what_it_kept_before() {
    let folder = site();
    let path = folder.path();
    let asked = |out: &str| format!("{STUDY} --bits --masks {out}/masks --out {out}");
    stopped(path, &asked("out"), "20%");
    let mut second = command(path, &asked("out")).stderr(Stdio::null()).stdout(Stdio::null()).spawn().unwrap();
    while !path.join("out/masks/mask-0180.png").exists() && second.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    second.kill().unwrap();
    assert!(!second.wait().unwrap().success());
    let told = stderr(&gnomon(path, &asked("out")));
    assert!(told.contains("continues where it was stopped"), "{told}");
    done(path, &asked("right"));
    assert!(files(&path.join("out")) == files(&path.join("right")));
}

/// A limit on the size of files acts like a full disk: one error says so, and no incomplete file is left.
#[test]
fn a_full_disk_leaves_nothing_half() {
    let folder = site();
    let path = folder.path();
    let limited = |blocks: u32, asked: &str| {
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" {asked}");
        let mut command = std::process::Command::new("bash");
        command.args(["-c", &script, env!("CARGO_BIN_EXE_gnomon")]).current_dir(path).env("XDG_RUNTIME_DIR", path);
        let output = command.output().unwrap();
        let told = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{asked}: {told}");
        let errors: Vec<&str> = told.lines().filter(|line| line.starts_with("error: ")).collect();
        assert!(errors.len() == 1 && errors[0].contains("cannot write out/"), "{told}");
        told
    };
    done(path, "profile . --engine cpu --size 500 --out old");
    fs::rename(path.join("old"), path.join("out")).unwrap();
    let old = files(&path.join("out"));
    // the drawing has no room: the raster, which has, is not put beside the old drawing
    let told = limited(50, "profile . --engine cpu --size 500 --date 2026-06-18 --quiet");
    assert!(told.contains("free some space"), "{told}");
    assert!(files(&path.join("out")) == old);
    limited(50, "profile . --engine cpu --size 500 --date 2026-06-18 --bits --step 1min --quiet");
    assert!(files(&path.join("out")) == old, "{:?}", files(&path.join("out")).keys());
}
