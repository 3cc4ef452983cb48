//! A thousand mutations of a small file of each format: no reader panics, hangs or uses up all memory.
//!
//! The test of a format calls [`survives`] with the smallest file that has everything its reader knows, or mutates files of
//! its own, which it reads by [`read_within_memory`].

use super::apart::apart;
use crate::model::Model;
use crate::shared::memory::CountedThread;
use gnomon::formats::{self, FORMATS, ModelError, ModelReader, ReadLimits, ReadOptions};
use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

const MUTATIONS: u64 = 1000;
/// One in this many is also read in a separate process, which is given up where it takes too much.
const WATCHED: u64 = 40;
const MOST_TIME: Duration = Duration::from_secs(10);
const MOST_MEMORY: u64 = 1 << 30;

/// Numbers that look random, and are the same each time: SplitMix64.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) % end.max(1) as u64) as usize
    }
}

/// Numbers that a reader may stumble over.
const NUMBERS: [&str; 12] = [
    "0",
    "-1",
    "1",
    "255",
    "65536",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551616",
    "1e308",
    "1e999",
    "NaN",
];

/// A file with one to four mistakes in it.
pub(super) fn mutated(bytes: &[u8], seed: u64) -> Vec<u8> {
    let mut dice = Dice(seed);
    let mut bytes = bytes.to_vec();
    for _ in 0..1 + dice.below(4) {
        let at = dice.below(bytes.len());
        let end = (at + 1 + dice.below(32)).min(bytes.len());
        match dice.below(7) {
            0 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << dice.below(8)),
            1 => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = [0, 0x7f, 0x80, 0xff][dice.below(4)]),
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(at.min(end)..end)),
            4 => {
                let copy = bytes[at.min(end)..end].to_vec();
                bytes.splice(at..at, copy);
            }
            5 => {
                // a binary count, large
                let word = [u32::MAX, i32::MAX as u32, 1 << 30, 1 << 24][dice.below(4)].to_le_bytes();
                bytes.iter_mut().skip(at).zip(word).for_each(|(byte, new)| *byte = new);
            }
            _ => swap_number(&mut bytes, at, NUMBERS[dice.below(NUMBERS.len())]),
        }
    }
    bytes
}

/// Writes another number where the next one is written in letters.
fn swap_number(bytes: &mut Vec<u8>, at: usize, number: &str) {
    let Some(first) = bytes.iter().skip(at).position(u8::is_ascii_digit).map(|found| at + found) else { return };
    let length = bytes[first..].iter().take_while(|byte| byte.is_ascii_digit() || b".eE+-".contains(byte)).count();
    bytes.splice(first..first + length, number.bytes());
}

/// Reads a file, and holds all memory that it takes to the limit.
pub(crate) fn read_within_memory(
    thread: &CountedThread,
    file: &Path,
    options: &ReadOptions,
) -> Result<formats::Model, ModelError> {
    let (read, most) = thread.run(|| formats::read(file, options));
    assert!(most < MOST_MEMORY, "{} takes {} MiB to read", file.display(), most >> 20);
    read
}

/// Reads a file in a process of its own, whose memory and time are watched.
pub(crate) fn read_watched(file: &Path) {
    let limits = ReadLimits { time: MOST_TIME, memory: Some(MOST_MEMORY) };
    let watched = ModelReader { limits, ..apart() };
    if let Err(error) = watched.read_apart(file, &ReadOptions::default()) {
        let told = error.to_string();
        let is_endured =
            ["takes longer", "takes more memory", "its reader failed"].iter().all(|end| !told.contains(end));
        assert!(is_endured, "{told}");
    }
}

/// Runs a reader on all mutations of a file; returns how many were read as models, and how many gave errors.
pub(super) fn survives(ending: &str, bytes: &[u8]) -> [usize; 2] {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(format!("model.{ending}"));
    std::fs::write(&file, bytes).unwrap();
    formats::read(&file, &ReadOptions::default()).unwrap_or_else(|error| panic!("the file itself: {error}"));
    let (mut read, mut errors) = (0, BTreeSet::new());
    let thread = CountedThread::new();
    for seed in 0..MUTATIONS {
        std::fs::write(&file, mutated(bytes, seed)).unwrap();
        match outcome(&thread, &file, seed) {
            None => read += 1,
            Some(error) => drop(errors.insert(error)),
        }
        if seed % WATCHED == 0 {
            read_watched(&file);
        }
    }
    [read, errors.len()]
}

/// What is wrong with a file, if anything; found in time, and without a panic.
fn outcome(thread: &CountedThread, file: &Path, seed: u64) -> Option<String> {
    let begun = Instant::now();
    let outcome = catch_unwind(AssertUnwindSafe(|| read_within_memory(thread, file, &ReadOptions::default())));
    let name = file.display();
    let outcome = outcome.unwrap_or_else(|_| panic!("mutation {seed} of {name}: its reader panics, or takes too much"));
    assert!(begun.elapsed() < MOST_TIME, "mutation {seed} of {name} takes {:?}", begun.elapsed());
    let told = outcome.map(|_| ()).err()?.to_string();
    // no place that is another in each run
    Some(told.replace(&name.to_string(), "model").chars().filter(|letter| !letter.is_ascii_digit()).collect())
}

/// The smallest file of each format that is tried here; formats with tests of their own call [`survives`] there.
fn samples() -> Vec<(&'static str, Vec<u8>)> {
    let mut model = Model::triangle();
    model.json["nodes"] = serde_json::json!([{"mesh": 0, "name": "wall", "translation": [1.0, 2.0, 3.0]}]);
    let gltf = serde_json::to_vec_pretty(&model.gltf()).unwrap();
    vec![("glb", model.glb()), ("gltf", gltf)]
}

#[test]
fn readers_survive_mutations() {
    for (ending, bytes) in samples() {
        assert!(FORMATS.iter().any(|format| format.endings().contains(&ending)), ".{ending} is no format's");
        let [read, errors] = survives(ending, &bytes);
        // mutations that all fail alike, or not at all, try nothing
        assert!(read > 10 && errors > 10, ".{ending}: {read} were read, and there were {errors} different errors");
    }
}

#[test]
fn mutations_are_many_and_the_same_each_time() {
    let bytes: Vec<u8> = b"v 1.0 2.0 3.0\nf 1 2 3\n".repeat(10);
    let all: BTreeSet<Vec<u8>> = (0..MUTATIONS).map(|seed| mutated(&bytes, seed)).collect();
    assert!(all.len() > 900, "only {} are different", all.len());
    assert_eq!(mutated(&bytes, 7), mutated(&bytes, 7));
    assert!(all.iter().any(|text| text.windows(10).any(|part| part == b"4294967295")), "no number is swapped");
}
