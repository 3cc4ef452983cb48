//! Examines the beginning of a JSON file, as far as its first bytes show it.

/// Whether a head is JSON and has a member of this name, at any depth.
pub(super) fn has_key(head: &[u8], key: &str) -> bool {
    members(head, key).next().is_some()
}

/// Whether a head is JSON and has a member of this name with wanted text.
pub(super) fn has_member(head: &[u8], key: &str, wanted: impl Fn(&str) -> bool) -> bool {
    members(head, key).any(|value| {
        let text = value.strip_prefix('"').and_then(|value| value.split('"').next());
        text.is_some_and(&wanted)
    })
}

/// The text after each member of this name.
fn members<'a>(head: &'a [u8], key: &str) -> impl Iterator<Item = &'a str> {
    let head = super::whole::without_mark(head).trim_ascii_start();
    let is_json = head.first() == Some(&b'{');
    // the head may end within a character
    let text = match std::str::from_utf8(head) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&head[..error.valid_up_to()]).unwrap_or_default(),
    };
    let quoted = format!("\"{key}\"");
    let behind = text.match_indices(&quoted).map(|(at, found)| &text[at + found.len()..]).collect::<Vec<_>>();
    let values = behind.into_iter().filter_map(|behind| behind.trim_start().strip_prefix(':').map(str::trim_start));
    values.filter(move |_| is_json)
}
