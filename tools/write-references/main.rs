//! Writes the generated parts of `docs/command.md` and `docs/site-file.md`: `cargo run --example write-references`.
//!
//! The text written by hand between them is not changed. The tests include this file to check that the pages are up to
//! date.

mod blocks;
mod command;
mod site_file;

use blocks::Block;

/// A page, and what makes its generated blocks.
type Page = (&'static str, fn() -> Vec<Block>);

/// The pages, by their paths in the repository.
pub(crate) const PAGES: [Page; 2] = [("docs/command.md", command::blocks), ("docs/site-file.md", site_file::blocks)];

/// A page's text with its blocks as the definitions have them now.
///
/// # Errors
/// A block that the page has no place for, and a place for a block that does not exist.
pub(crate) fn renewed(text: &str, blocks: &[Block]) -> Result<String, String> {
    blocks::fill(text, blocks)
}

#[cfg(not(test))]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    for (path, blocks) in PAGES {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
        let text = std::fs::read_to_string(&path)?;
        std::fs::write(&path, renewed(&text, &blocks())?)?;
        println!("{}", path.display());
    }
    Ok(())
}
