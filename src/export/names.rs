//! Names as they appear in text output and in CSV.

/// A field of a CSV line.
pub(super) fn field(text: &str) -> String {
    if text.contains([',', '"', '\r', '\n']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// A name without characters that would break the line.
pub(super) fn plain(name: &str) -> String {
    name.replace(char::is_control, " ")
}
