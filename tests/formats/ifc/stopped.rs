//! A file that takes long to read: that is shown, and Ctrl-C ends it.

use super::house::house;
use crate::shared::program::command;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The block with as many round holes as take the reader minutes.
fn holes() -> String {
    let mut text = String::new();
    for number in 0..400 {
        let [hole, shape, body, solid, place, point, round, axes, middle] =
            std::array::from_fn(|at| 1000 + 20 * number + at);
        let (up, along, radius) = (100 + number * 37 % 29_000, 6000 + number * 53 % 8000, 400 + number % 97);
        let _ = write!(
            text,
            "#{hole}=IFCOPENINGELEMENT('00000000000000000{hole:05}',$,'Hole',$,$,#20,#{shape},$,$);\n\
             #{shape}=IFCPRODUCTDEFINITIONSHAPE($,$,(#{body}));\n\
             #{body}=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#{solid}));\n\
             #{solid}=IFCEXTRUDEDAREASOLID(#{round},#{place},#7,60.);\n\
             #{place}=IFCAXIS2PLACEMENT3D(#{point},$,$);\n\
             #{point}=IFCCARTESIANPOINT((0.,0.,{up}.));\n\
             #{round}=IFCCIRCLEPROFILEDEF(.AREA.,$,#{axes},{radius}.);\n\
             #{axes}=IFCAXIS2PLACEMENT2D(#{middle},$);\n\
             #{middle}=IFCCARTESIANPOINT(({along}.,-3000.));\n\
             #{}=IFCRELVOIDSELEMENT('10000000000000000{hole:05}',$,$,$,#100,#{hole});\n",
            middle + 1
        );
    }
    house(&text)
}

/// The processes that a process has started.
#[cfg(target_os = "linux")]
fn children(of: u32) -> Vec<u32> {
    let listed = std::fs::read_to_string(format!("/proc/{of}/task/{of}/children")).unwrap_or_default();
    listed.split_whitespace().filter_map(|number| number.parse().ok()).collect()
}

fn interrupt(process: u32) {
    assert!(Command::new("kill").args(["-INT", &process.to_string()]).status().unwrap().success());
}

/// What the command says on stderr, and its exit status: interrupted once it shows what it reads.
fn interrupted(folder: &Path, arguments: &str, to: impl Fn(u32) -> u32) -> (String, Option<i32>) {
    let mut program = command(folder, arguments);
    let mut child = program.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let (mut told, mut begun) = (String::new(), None);
    for line in BufReader::new(child.stderr.take().unwrap()).lines() {
        let line = line.unwrap();
        if line.starts_with("reading holes.ifc") && begun.is_none() {
            begun = Some(Instant::now());
            interrupt(to(child.id()));
        }
        told += &(line + "\n");
    }
    let status = child.wait().unwrap();
    let took = begun.expect("the reading is shown").elapsed();
    assert!(took < Duration::from_secs(60), "it ended after {took:?}");
    (told, status.code())
}

/// Ctrl-C ends the command and the process that reads for it, with one line; and so does one that reaches that process alone.
#[test]
fn ctrl_c_ends_the_reading() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("holes.ifc"), holes()).unwrap();
    let asked = "profile holes.ifc --no-cache --date 2026-03-21 --from 10:00 --to 12:00 --size 64";
    let reader = std::cell::Cell::new(None);
    let command_itself = |process: u32| {
        #[cfg(target_os = "linux")]
        reader.set(children(process).first().copied());
        process
    };
    let (told, status) = interrupted(folder.path(), asked, command_itself);
    let lines: Vec<&str> = told.lines().collect();
    assert_eq!((status, lines.len()), (Some(130), 2), "{told}");
    assert!(lines[0].starts_with("reading holes.ifc, 2"), "{told}");
    assert!(lines[1].starts_with("error: ") && lines[1].contains("holes.ifc: was not read to its end"), "{told}");
    assert!(!folder.path().join("out").exists());
    #[cfg(target_os = "linux")]
    {
        let reader = reader.get().expect("a process that reads");
        assert!(!Path::new(&format!("/proc/{reader}/exe")).exists(), "the reader goes on");
        let (told, status) = interrupted(folder.path(), asked, |process| children(process)[0]);
        assert_eq!((status, told.lines().count()), (Some(130), 2), "{told}");
    }
}
