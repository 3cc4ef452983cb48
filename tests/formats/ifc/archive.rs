//! Zipped files: they are read, or refused if they are damaged or a zip bomb.

use super::house::house;
use super::{notes, read_as};
use crate::formats::zip::zipped;
use crate::shared::program::done;

#[track_caller]
fn refused(bytes: &[u8], why: &str) {
    let error = read_as("house.ifczip", bytes).expect_err("refused");
    assert!(error.contains(why), "{error}");
}

#[test]
fn a_zipped_file_is_the_file() {
    let text = house("");
    // its first entry tells the format, whatever the file is called
    let plain = read_as("house.ifc", text.as_bytes()).expect("read");
    let archived = read_as("house.zip", &zipped(&[("House.IFC", text.as_bytes())])).expect("read");
    assert_eq!(archived.parts.len(), plain.parts.len());
    for (one, other) in plain.parts.iter().zip(&archived.parts) {
        assert_eq!((&one.name, &one.positions, &one.triangles), (&other.name, &other.positions, &other.triangles));
    }
    let several = zipped(&[("readme.txt", b"text"), ("a.ifc", text.as_bytes()), ("b.ifc", text.as_bytes())]);
    // whoever opens it is told, too
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("several.ifczip"), &several).expect("written");
    let told = done(folder.path(), "check several.ifczip");
    let note = "note: several.ifczip is an archive of several models; the first is read, not b.ifc; unpack it to open";
    assert!(told.contains(note), "{told}");
    let several = read_as("house.ifczip", &several).expect("read");
    assert!(notes(&several).contains("several models; the first is read, not b.ifc"), "{}", notes(&several));
}

#[test]
fn the_others_are_told_where_the_first_of_several_cannot_be_read() {
    let text = house("");
    let archive = zipped(&[("a.ifc", &text.as_bytes()[..text.len() / 2]), ("b.ifc", text.as_bytes())]);
    let told = "is an archive of several models, of which the first is cut off: its end is missing";
    refused(&archive, told);
    refused(&archive, "copy or export it again, or unpack it to open another");
}

#[test]
fn bombs_and_broken_archives_are_refused() {
    refused(&zipped(&[("bomb.ifc", &vec![b' '; 200 << 20])]), "more than 100 times as many");
    refused(&zipped(&[("house.ifcxml", b"<ifcXML/>")]), "with no .ifc in it");
    let text = house("");
    let good = zipped(&[("house.ifc", text.as_bytes())]);
    refused(&good[..good.len() - 30], "its directory cannot be read");
    // one that says less than it holds, and one whose bytes are others
    let listed = good.windows(4).rposition(|word| word == b"PK\x01\x02").expect("listed");
    let with = |at: usize, value: u8| {
        let mut changed = good.clone();
        changed[at] = value;
        changed
    };
    refused(&with(listed + 25, 0), "differs from what the directory says");
    refused(&with(listed + 16, good[listed + 16] ^ 1), "differs from what the directory says");
    refused(&with(listed + 10, 99), "is packed by method 99");
    refused(&with(listed + 8, 1), "is encrypted");
    refused(&with(listed + 45, 0x7f), "an entry lies beyond its end");
    let mut rubbish = good.clone();
    rubbish[60..80].fill(0xff);
    refused(&rubbish, "is a zip archive that is broken");
}
