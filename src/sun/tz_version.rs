//! The releases of the IANA Time Zone Database, in order.

/// A release of the database, such as 2026f. Later ones compare greater.
///
/// A release has its year and a letter; the 26th release of a year is followed by `za`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TzVersion {
    year: i32,
    // longer suffixes are later, so the length is compared before the letters
    length: usize,
    letters: String,
}

impl TzVersion {
    /// Earlier than every release: for a bundle without a version.
    pub(super) fn unknown() -> TzVersion {
        TzVersion { year: 0, length: 0, letters: String::new() }
    }

    /// Reads `2026f`, and ignores suffixes of packagers (`2026f-dfsg`). `None` for text that is not a release.
    pub fn parse(text: &str) -> Option<TzVersion> {
        let (year, rest) = text.trim().split_at_checked(4)?;
        let length = rest.bytes().take_while(u8::is_ascii_lowercase).count();
        let (letters, rest) = rest.split_at(length);
        let is_whole = year.bytes().all(|byte| byte.is_ascii_digit())
            && length > 0
            && !rest.starts_with(|next: char| next.is_alphanumeric());
        let year = year.parse().ok().filter(|_| is_whole)?;
        Some(TzVersion { year, length, letters: letters.to_owned() })
    }

    /// The year of the release.
    pub fn year(&self) -> i32 {
        self.year
    }
}

impl std::fmt::Display for TzVersion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}{}", self.year, self.letters)
    }
}
