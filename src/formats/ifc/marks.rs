//! Recognises IFC files by their beginning, and complete ones by their end.

/// Whether a file begins as STEP text with an IFC schema. Other programs write other schemas in the same form.
pub(super) fn is_ifc_text(head: &[u8]) -> bool {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    let Some(header) = text.strip_prefix(b"ISO-10303-21") else { return false };
    let schema = header.windows(11).position(|word| word.eq_ignore_ascii_case(b"FILE_SCHEMA"));
    let Some(rest) = schema.and_then(|at| header.get(at..)) else { return false };
    let list = rest.split(|&byte| byte == b';').next().unwrap_or_default();
    list.windows(3).any(|word| word.eq_ignore_ascii_case(b"IFC"))
}

/// Whether a text has the ends of a STEP file's data and of the file. A truncated file lacks them, although all of its
/// records may be whole.
#[cfg(feature = "ifc")]
pub(super) fn is_whole(text: &[u8]) -> bool {
    ["ENDSEC", ";", "END-ISO-10303-21", ";"]
        .iter()
        .rev()
        .try_fold(text, |text, word| before(without_blanks(text), word.as_bytes()))
        .is_some()
}

/// The text before a final word; `None` if it ends differently.
#[cfg(feature = "ifc")]
fn before<'a>(text: &'a [u8], word: &[u8]) -> Option<&'a [u8]> {
    let (before, end) = text.split_at_checked(text.len().checked_sub(word.len())?)?;
    end.eq_ignore_ascii_case(word).then_some(before)
}

/// The text without trailing blanks and comments. Old programs end a file with their system's control character.
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
