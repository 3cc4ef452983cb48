//! The documents for people: links that lead somewhere, and a README that can be read.

use std::path::{Path, PathBuf};

/// So long may the README be.
const README_LINES: usize = 100;

/// README, CONTRIBUTING and all of `docs`, with its folders of pages.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let in_folder = |folder: &Path| {
        let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        entries.filter(|path| path.extension().is_some_and(|it| it == "md")).collect::<Vec<_>>()
    };
    [root.to_owned(), root.join("docs"), root.join("docs/benchmarks"), root.join("docs/rules")]
        .iter()
        .flat_map(|it| in_folder(it))
        .collect()
}

/// Its lines that are no code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The anchors of a page's headings, as they are made where the repository is shown.
fn anchors(text: &str) -> Vec<String> {
    let headings = prose(text).filter(|line| line.starts_with('#'));
    let anchor = |heading: &str| {
        let words = heading.trim_start_matches('#').trim().to_lowercase();
        words
            .chars()
            .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
            .map(|c| if c == ' ' { '-' } else { c })
            .collect()
    };
    headings.map(anchor).collect()
}

/// Where the links of a page's text point to.
fn links(text: &str) -> Vec<&str> {
    let after = prose(text).flat_map(|line| line.split("](").skip(1));
    after.filter_map(|rest| rest.split(')').next()).filter(|target| !target.contains("://")).collect()
}

/// What is wrong with the links of a page.
fn faults(path: &Path, text: &str) -> Vec<String> {
    let leads = |target: &str| {
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let to = if file.is_empty() { path.to_owned() } else { path.with_file_name(file) };
        if anchor.is_empty() {
            return to.exists();
        }
        let page = if file.is_empty() { Ok(text.to_owned()) } else { std::fs::read_to_string(&to) };
        page.is_ok_and(|page| anchors(&page).iter().any(|known| known == anchor))
    };
    let broken = links(text).into_iter().filter(|target| !leads(target));
    broken.map(|target| format!("{}: {target} leads nowhere", path.display())).collect()
}

#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    let mut found = Vec::new();
    for path in documents() {
        let text = std::fs::read_to_string(&path).expect("a document");
        count += links(&text).len();
        found.extend(faults(&path, &text));
    }
    assert!(count > 100, "only {count} links were checked");
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_broken_link_is_seen() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/page.md");
    let text =
        "# A page\n[a](words.md) [b](#a-page) [c](https://nowhere) [d](words.md#words)\n```\n[e](nothing)\n```\n";
    assert!(faults(&path, text).is_empty());
    for broken in ["[a](nothing.md)", "[b](#nothing)", "[c](words.md#nothing)", "![d](pictures/nothing.png)"] {
        assert_eq!(faults(&path, broken).len(), 1, "{broken}");
    }
}

#[test]
fn the_readme_is_short_and_has_the_two_commands() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).expect("a README");
    assert!(text.lines().count() <= README_LINES, "{} lines", text.lines().count());
    let commands = ["cargo run --release -- profile sites/headquarters --out out ", "tests/run.sh "];
    for command in commands {
        assert!(text.lines().any(|line| line.starts_with(command)), "the README does not have {command}");
    }
}

/// Words over which readers stumble, with what follows them, and each with a plainer one.
const STUMBLES: &[(&str, &str)] = &[
    ("anew ", "again"),
    ("whence ", "from where"),
    ("told of ", "reported"),
    ("gone on with ", "continued"),
    ("hang together ", "are connected"),
    ("hangs together ", "is connected"),
    ("seed 0", "the paper's author, title and section"),
    ("told from ", "lies before, or differs from"),
    ("is no number ", "is NaN"),
];

/// The same only in documents, including the changelog: readers of code know who "is told" means.
const STUMBLES_OF_DOCUMENTS: &[(&str, &str)] =
    &[("is told ", "is reported"), ("are told ", "are reported"), ("stays told ", "remains reported")];

/// The words of a text at which readers stumble, in any case.
fn stumbles(of: &[(&str, &str)], name: &str, text: &str) -> Vec<String> {
    let lines = text.lines().enumerate();
    let found = lines.flat_map(|(at, line)| {
        let line = format!(" {} ", line.to_lowercase().replace(|c: char| !c.is_alphanumeric(), " "));
        let has = move |word: &str| line.contains(&format!(" {word}"));
        of.iter().filter(move |(word, _)| has(word)).map(move |(word, plain)| (at, word.trim_end(), plain))
    });
    found.map(|(at, word, plain)| format!("{name}:{}: \"{word}\"; write \"{plain}\"", at + 1)).collect()
}

#[test]
fn source_and_documents_have_plain_words() {
    let mut found = Vec::new();
    for (folder, extension) in [("src", "rs"), ("shaders", "wgsl"), ("sites", "md")] {
        let texts = crate::architecture::files(folder, extension);
        assert!(texts.len() > 3, "too few files were found in {folder}");
        found.extend(
            texts.iter().flat_map(|(path, text)| stumbles(STUMBLES, &format!("{folder}/{}", path.display()), text)),
        );
    }
    for path in documents() {
        let (name, text) = (path.display().to_string(), std::fs::read_to_string(&path).expect("a document"));
        // the changelog speaks of what was
        if !path.ends_with("changelog.md") {
            found.extend(stumbles(STUMBLES, &name, &text));
        }
        found.extend(stumbles(STUMBLES_OF_DOCUMENTS, &name, &text));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    for of in [STUMBLES, STUMBLES_OF_DOCUMENTS] {
        for (word, _) in of {
            assert_eq!(stumbles(of, "", &format!("// It was {word}4.")).len(), 1, "{word}");
        }
    }
    assert!(stumbles(STUMBLES, "", "a manewver, Whencefrom").is_empty());
}
