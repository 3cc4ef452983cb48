//! What a reference system is called and how PROJ writes it, before its arithmetic is set up.

/// A system as it is found, before its arithmetic is set up.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) name: String,
    /// PROJ's text.
    pub(super) proj: String,
    pub(super) height_unit_m: Option<f64>,
    pub(super) doubt: Option<&'static str>,
}

/// A text that a message can hold.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 60;
    let one_line: String = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match one_line.char_indices().nth(MOST) {
        Some((end, _)) => format!("\"{}…\"", &one_line[..end]),
        None => format!("\"{one_line}\""),
    }
}
