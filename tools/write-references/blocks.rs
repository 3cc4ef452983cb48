//! Generated blocks in a page that is otherwise written by hand: `<!-- generated: NAME -->`, the text, `<!-- end -->`.

/// A block's name, and its lines.
pub(crate) type Block = (String, String);

const BEGIN: &str = "<!-- generated: ";
const BEGIN_ENDS: &str = " -->";
const END: &str = "<!-- end -->";

/// The page with every block's text replaced.
pub(super) fn fill(page: &str, blocks: &[Block]) -> Result<String, String> {
    let mut filled = String::new();
    let mut seen = Vec::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        filled.push_str(line);
        filled.push('\n');
        let Some(name) = line.strip_prefix(BEGIN).and_then(|rest| rest.strip_suffix(BEGIN_ENDS)) else { continue };
        let (_, text) = blocks
            .iter()
            .find(|(known, _)| known == name)
            .ok_or_else(|| format!("nothing generates the block {name}; take it out of the page"))?;
        if !lines.by_ref().any(|line| line == END) {
            return Err(format!("the block {name} has no line {END}"));
        }
        filled.push_str(&format!("\n{}\n\n{END}\n", text.trim()));
        seen.push(name);
    }
    match blocks.iter().find(|(name, _)| !seen.contains(&name.as_str())) {
        Some((name, _)) => {
            Err(format!("the page has no place for {name}; write the lines {BEGIN}{name}{BEGIN_ENDS} and {END}"))
        }
        None => Ok(filled),
    }
}

/// A table's row, with what would end a cell escaped.
pub(super) fn row<const N: usize>(cells: [&str; N]) -> String {
    format!("| {} |\n", cells.map(|cell| cell.replace('|', "\\|")).join(" | "))
}

/// A table's head.
pub(super) fn head<const N: usize>(names: [&str; N]) -> String {
    row(names) + &row(names.map(|_| "---"))
}
