//! The beginning and the end of IFC files, by which they are told from other files, and complete ones from those that
//! are cut off.

/// Whether a file begins as STEP text whose schema is one of IFC. Other programs write other schemas in the same form.
pub(super) fn is_ifc_text(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    let Some(header) = text.strip_prefix(b"ISO-10303-21") else { return false };
    let schema = header.windows(11).position(|word| word.eq_ignore_ascii_case(b"FILE_SCHEMA"));
    let Some(rest) = schema.and_then(|at| header.get(at..)) else { return false };
    let list = rest.split(|&byte| byte == b';').next().unwrap_or_default();
    list.windows(3).any(|word| word.eq_ignore_ascii_case(b"IFC"))
}

/// Whether a text ends as STEP has it: the end of its data, and that of the file. What was cut off while it was copied or
/// written lacks them, though every record before may be whole.
#[cfg(feature = "ifc")]
pub(super) fn is_whole(text: &[u8]) -> bool {
    ["ENDSEC", ";", "END-ISO-10303-21", ";"]
        .iter()
        .rev()
        .try_fold(text, |text, word| before(without_blanks(text), word.as_bytes()))
        .is_some()
}

/// A text without the word at its end; none where that is another one.
#[cfg(feature = "ifc")]
fn before<'a>(text: &'a [u8], word: &[u8]) -> Option<&'a [u8]> {
    let (before, end) = text.split_at_checked(text.len().checked_sub(word.len())?)?;
    end.eq_ignore_ascii_case(word).then_some(before)
}

/// A text without the blanks and comments at its end; old programs end a file with the control character of their system.
#[cfg(feature = "ifc")]
fn without_blanks(mut text: &[u8]) -> &[u8] {
    loop {
        while let [rest @ .., b'\0' | b'\x1a' | b' ' | b'\t'..=b'\r'] = text {
            text = rest;
        }
        let Some(within) = text.strip_suffix(b"*/") else { return text };
        let Some(start) = within.windows(2).rposition(|pair| pair == b"/*") else { return text };
        text = within.get(..start).unwrap_or_default();
    }
}
