//! Reads material libraries (MTL): which materials are see-through, and which files the libraries refer to.

use crate::formats::left_out::label;
use crate::formats::source::{TextLines, as_ascii, beside, keyword, number, text, words};
use crate::formats::whole::{whole_file, whole_named_file};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The files that a line of libraries may mean: the whole line, as names have spaces, and each word.
pub(super) fn beside_each(model: &Path, names: &str) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = beside(model, names).into_iter().collect();
    let several = || names.split_ascii_whitespace();
    if several().nth(1).is_some() {
        found.extend(several().filter_map(|name| beside(model, name)));
    }
    found
}

/// The names of materials that are translucent or cut out, and the libraries that cannot be read.
pub(super) fn see_through(model: &Path, libraries: &[String]) -> (BTreeSet<String>, Vec<String>) {
    let folder = model.parent().unwrap_or(Path::new(""));
    let (mut faded, mut missing, mut seen) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    for names in libraries.iter().filter(|names| seen.insert(names.as_str())) {
        let found: Vec<PathBuf> = beside_each(model, names).into_iter().filter(|file| file.is_file()).collect();
        let read: Vec<Vec<u8>> = found.iter().filter_map(|file| whole_named_file(folder, file).ok()).collect();
        if read.is_empty() {
            missing.insert(label(names));
        }
        for library in read {
            faded.extend(materials(&as_ascii(library)));
        }
    }
    (faded, missing.into_iter().collect())
}

/// The opacity of a material: `d` has priority over `Tr`, which some programs write inverted.
#[derive(Default)]
struct Opacity {
    name: String,
    dissolve: Option<f64>,
    transparency: Option<f64>,
    is_cut_out: bool,
}

impl Opacity {
    fn is_faded(&self) -> bool {
        let opacity = self.dissolve.or(self.transparency.map(|through| 1.0 - through));
        self.is_cut_out || opacity.is_some_and(|opacity| opacity < 1.0)
    }
}

/// The names of a library's see-through materials.
fn materials(library: &[u8]) -> Vec<String> {
    let (mut faded, mut material) = (Vec::new(), Opacity::default());
    let mut close = |material: &mut Opacity, name: String| {
        let closed = std::mem::replace(material, Opacity { name, ..Opacity::default() });
        if closed.is_faded() {
            faded.push(closed.name);
        }
    };
    for line in TextLines::new(library) {
        let Some((word, rest)) = keyword(line) else { continue };
        // `d -halo 0.5`
        let last = || words(rest).last().and_then(number);
        match word {
            b"newmtl" => close(&mut material, label(&text(rest))),
            b"d" => material.dissolve = last(),
            b"Tr" => material.transparency = last(),
            b"map_d" => material.is_cut_out = true,
            _ => (),
        }
    }
    close(&mut material, String::new());
    faded
}

/// The images that a library refers to; empty if it cannot be read.
pub(super) fn textures(library: &Path) -> Vec<PathBuf> {
    let Ok(source) = whole_file(library) else { return Vec::new() };
    let source = as_ascii(source);
    let named = TextLines::new(&source).filter_map(|line| {
        let (word, rest) = keyword(line)?;
        let is_map = word.starts_with(b"map_") || matches!(word, b"bump" | b"disp" | b"decal" | b"refl" | b"norm");
        // options come before the name
        let words = || words(rest);
        let name = if words().next()?.starts_with(b"-") { text(words().last()?) } else { text(rest) };
        beside(library, &name).filter(|_| is_map)
    });
    named.collect()
}
