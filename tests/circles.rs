//! Files of a module must not depend on each other in circles: if a file uses another's items, the other must not use
//! any of its own, neither directly nor through further files. Then each file can be read alone, with those that it
//! uses.
//!
//! A file uses another if it imports an item that is declared there, or writes a path to one. Paths are followed
//! through re-exports to the declaration. So a `mod.rs` that only declares and re-exports is used by nobody, and does
//! not use what it re-exports unless it writes the name itself.

use crate::architecture::{files, without_comments};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The folders of `desktop` as layers: each knows itself and those before it, and no file beside the folders.
const LAYERS: &[&str] = &["state", "results", "work", "stage", "parts", "app"];

/// A module's path below `src`, the outermost module first.
type Module = Vec<String>;

/// One name that a file imports.
struct Import {
    path: Vec<String>,
    name: String,
    is_public: bool,
}

/// What is read of one file.
struct Source {
    imports: Vec<Import>,
    /// What it declares.
    items: BTreeSet<String>,
    /// The paths that it writes beside its imports.
    paths: Vec<Vec<String>>,
    /// All words that it writes beside its imports.
    words: BTreeSet<String>,
}

/// Names, `::`, and single characters.
fn tokens(code: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = code.trim_start();
    while !rest.is_empty() {
        let name = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        let first = rest.chars().next().map_or(1, char::len_utf8);
        let (token, after) = rest.split_at(if rest.starts_with("::") { 2 } else { name.max(first) });
        tokens.push(token);
        rest = after.trim_start();
    }
    tokens
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

impl Source {
    fn read(code: &str) -> Source {
        const DECLARES: [&str; 8] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union"];
        let code = without_comments(code);
        let tokens = tokens(&code);
        let mut source =
            Source { imports: Vec::new(), items: BTreeSet::new(), paths: Vec::new(), words: BTreeSet::new() };
        let mut at = 0;
        while at < tokens.len() {
            let before = |back: usize| at.checked_sub(back).map_or("", |at| tokens[at]);
            if tokens[at] == "use" {
                let mut imports = Vec::new();
                let end = imported(&tokens, at + 1, &[], &mut imports);
                if let Some(end) = end.filter(|end| tokens.get(*end) == Some(&";")) {
                    // `pub use`, `pub(super) use`
                    let is_public =
                        before(1) == "pub" || before(1) == ")" && tokens[..at].iter().rev().nth(2) == Some(&"(");
                    source.imports.extend(imports.into_iter().map(|import| Import { is_public, ..import }));
                    at = end;
                    continue;
                }
            }
            if is_name(tokens[at]) && !matches!(before(1), "mod" | "::") {
                let is_declared = DECLARES.contains(&before(1)) || before(1) == "!" && before(2) == "macro_rules";
                if is_declared {
                    source.items.insert(tokens[at].to_owned());
                }
                source.words.insert(tokens[at].to_owned());
                let mut path = vec![tokens[at].to_owned()];
                while tokens.get(at + 1) == Some(&"::") && tokens.get(at + 2).is_some_and(|next| is_name(next)) {
                    at += 2;
                    path.push(tokens[at].to_owned());
                }
                if path.len() > 1 {
                    source.paths.push(path);
                }
            }
            at += 1;
        }
        source
    }
}

/// Reads what follows `use`, or is in its braces, and returns where it ends; `None` if it is not an import.
fn imported(tokens: &[&str], mut at: usize, prefix: &[String], found: &mut Vec<Import>) -> Option<usize> {
    let mut path = prefix.to_vec();
    loop {
        match *tokens.get(at)? {
            "{" => {
                at += 1;
                while *tokens.get(at)? != "}" {
                    at = imported(tokens, at, &path, found)?;
                    if *tokens.get(at)? == "," {
                        at += 1;
                    }
                }
                return Some(at + 1);
            }
            "*" => return Some(at + 1),
            name if is_name(name) => path.push(name.to_owned()),
            _ => return None,
        }
        at += 1;
        if *tokens.get(at)? != "::" {
            break;
        }
        at += 1;
    }
    if path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    let mut name = path.last()?.clone();
    if *tokens.get(at)? == "as" {
        (name, at) = ((*tokens.get(at + 1)?).to_owned(), at + 2);
    }
    found.push(Import { path, name, is_public: false });
    Some(at)
}

/// All files, by their modules.
struct Sources(BTreeMap<Module, Source>);

impl Sources {
    fn read(files: &[(PathBuf, String)]) -> Sources {
        Sources(files.iter().map(|(path, code)| (module_of(path), Source::read(code))).collect())
    }

    /// The file that declares the item of a path, as seen from a module; `None` if it is not an item of the crate.
    fn declared_in(&self, from: &Module, path: &[String], depth: usize) -> Option<Module> {
        let (mut module, mut path) = (from.clone(), path);
        match path.first()?.as_str() {
            "crate" => (module, path) = (Module::new(), &path[1..]),
            "self" => path = &path[1..],
            _ => {}
        }
        while path.first().is_some_and(|first| first == "super") {
            module.pop();
            path = &path[1..];
        }
        while let Some((first, rest)) = path.split_first() {
            let below = [module.as_slice(), std::slice::from_ref(first)].concat();
            if self.0.contains_key(&below) {
                (module, path) = (below, rest);
                continue;
            }
            let source = self.0.get(&module)?;
            if source.items.contains(first) {
                return Some(module);
            }
            let import = source.imports.iter().find(|import| import.name == *first && import.path[0] != *first)?;
            return self.declared_in(&module, &[&import.path, rest].concat(), depth.checked_sub(1)?);
        }
        // the module itself, and none of its items
        None
    }

    /// Which files each file uses, and by which path.
    fn uses(&self) -> BTreeMap<&Module, BTreeMap<Module, String>> {
        let of = |(module, source): (&'_ Module, &Source)| {
            let imports =
                source.imports.iter().filter(|import| !import.is_public || source.words.contains(&import.name));
            let paths = imports.map(|import| &import.path).chain(&source.paths);
            let found = paths.filter_map(|path| Some((self.declared_in(module, path, 8)?, path.join("::"))));
            found.filter(|(used, _)| used != module).collect()
        };
        self.0.iter().map(|(module, source)| (module, of((module, source)))).collect()
    }
}

fn module_of(path: &Path) -> Module {
    let mut module: Module = path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    module.pop_if(|last| matches!(last.as_str(), "mod" | "lib"));
    module
}

/// What a file uses, directly and through others.
fn reached<'a>(uses: &'a BTreeMap<&Module, BTreeMap<Module, String>>, from: &Module) -> BTreeSet<&'a Module> {
    let (mut reached, mut waiting) = (BTreeSet::new(), vec![from]);
    while let Some(module) = waiting.pop() {
        for further in uses.get(module).into_iter().flat_map(BTreeMap::keys) {
            if reached.insert(further) {
                waiting.push(further);
            }
        }
    }
    reached
}

/// The dependencies in a circle, each with the path that causes it.
fn circles(files: &[(PathBuf, String)]) -> Vec<String> {
    let sources = Sources::read(files);
    let uses = sources.uses();
    let mut found = Vec::new();
    for (module, used) in &uses {
        let back = used.iter().filter(|(used, _)| reached(&uses, used).contains(*module));
        let name = |module: &Module| module.join("/");
        found.extend(back.map(|(used, path)| format!("{} uses {}: {path}", name(module), name(used))));
    }
    found
}

/// The dependencies of a layer on a later one or on a file beside the layers, each with its path.
fn upward(files: &[(PathBuf, String)], room: &str, layers: &[&str]) -> Vec<String> {
    let sources = Sources::read(files);
    let is_of_room = |module: &Module| module.first().is_some_and(|first| first == room);
    let layer = |module: &Module| module.get(1).and_then(|name| layers.iter().position(|layer| layer == name));
    let mut found = Vec::new();
    for (module, used) in sources.uses() {
        let Some(own) = layer(module).filter(|_| is_of_room(module)) else { continue };
        let behind = used.iter().filter(|(used, _)| is_of_room(used) && layer(used).is_none_or(|at| at > own));
        found.extend(behind.map(|(used, path)| format!("{} uses {}: {path}", module.join("/"), used.join("/"))));
    }
    found
}

#[test]
fn no_room_has_a_circle_of_files() {
    let sources = files("src", "rs");
    let arrows: usize = Sources::read(&sources).uses().values().map(BTreeMap::len).sum();
    assert!(arrows > 2 * sources.len(), "too few uses were found");
    let found = circles(&sources);
    assert!(found.is_empty(), "move what both use into a file below them:\n{}", found.join("\n"));
}

#[test]
fn layers_of_the_window_know_those_before_them() {
    let sources = files("src", "rs");
    for layer in LAYERS {
        let folder = Path::new("desktop").join(layer);
        assert!(sources.iter().any(|(path, _)| path.starts_with(&folder)), "{} has no file", folder.display());
    }
    let found = upward(&sources, "desktop", LAYERS);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn finder_of_upward_arrows_finds_them() {
    let file = |path: &str, code: &str| (PathBuf::from(path), code.to_owned());
    let files = [
        file("room/mod.rs", "mod low;\nmod high;\nmod beside;"),
        file("room/beside.rs", "use super::low::a::A;\npub struct Beside;"),
        file("room/low/mod.rs", "mod a;\nmod b;"),
        file("room/low/a.rs", "use super::super::high::High;\nuse crate::room::beside::Beside;\npub struct A;"),
        file("room/low/b.rs", "use super::a::A;\nuse crate::mesh::Mesh;"),
        file("room/high/mod.rs", "use crate::room::low::a::A;\npub struct High;"),
        file("mesh/mod.rs", "pub struct Mesh;"),
    ];
    assert_eq!(
        upward(&files, "room", &["low", "high"]),
        [
            "room/low/a uses room/beside: crate::room::beside::Beside",
            "room/low/a uses room/high: super::super::high::High"
        ]
    );
    assert_eq!(
        upward(&files, "room", &["high", "low"]),
        [
            "room/high uses room/low/a: crate::room::low::a::A",
            "room/low/a uses room/beside: crate::room::beside::Beside"
        ]
    );
}

#[test]
fn finder_of_circles_finds_them() {
    let file = |path: &str, code: &str| (PathBuf::from(path), code.to_owned());
    let lib = || file("lib.rs", "pub mod mesh;");
    let parent = [
        lib(),
        file("mesh/mod.rs", "mod weld;\nuse weld::weld;\npub struct Part;\nfn build() { weld() }"),
        file("mesh/weld.rs", "use super::Part;\npub(super) fn weld() {}"),
    ];
    assert_eq!(circles(&parent), ["mesh uses mesh/weld: weld::weld", "mesh/weld uses mesh: super::Part"]);
    let longer = [
        lib(),
        file("mesh/mod.rs", "mod a;\nmod b;\nmod c;\npub use a::{A, other as O};\npub(crate) use self::c::C;"),
        file("mesh/a.rs", "pub struct A;\npub fn other() { super::b::b(); }"),
        file("mesh/b.rs", "use crate::{\n    mesh::{C, a as _},\n};\npub fn b() -> C { C }"),
        file("mesh/c.rs", "// A\npub struct C;\nimpl C { fn of() { super::O() } }"),
    ];
    let found = circles(&longer);
    assert_eq!(
        found,
        ["mesh/a uses mesh/b: super::b::b", "mesh/b uses mesh/c: crate::mesh::C", "mesh/c uses mesh/a: super::O"]
    );
    let used_by_its_parent = file("mesh/mod.rs", "mod a;\npub use a::A;\npub struct B;\nfn of(a: A) {}");
    let child = || file("mesh/a.rs", "pub struct A(super::B);");
    assert_eq!(circles(&[lib(), used_by_its_parent, child()]).len(), 2);
    let re_exported = file("mesh/mod.rs", "mod a;\npub use a::A;\npub struct B;");
    assert_eq!(circles(&[lib(), re_exported, child()]), [""; 0]);
    let one_way = [
        lib(),
        file("mesh/mod.rs", "//! Of [`a::A`].\nmod a;\nmod b;\npub use a::A;"),
        file("mesh/a.rs", "pub struct A; // super::b::B"),
        file("mesh/b.rs", "use super::A;\nuse super::a;\npub struct B(A);"),
    ];
    assert_eq!(circles(&one_way), [""; 0]);
}
