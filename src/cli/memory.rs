//! `--memory`: reads a number of bytes as people write it.

/// The units, and the bytes of each.
const UNITS: [(&str, u64); 6] =
    [("KiB", 1 << 10), ("MiB", 1 << 20), ("GiB", 1 << 30), ("kB", 1_000), ("MB", 1_000_000), ("GB", 1_000_000_000)];

/// Reads a whole number with its unit: `512MiB`, `4GB`.
pub(super) fn parse(text: &str) -> Result<u64, String> {
    let digits = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let unit = UNITS.iter().find(|(name, _)| *name == unit);
    let bytes = number.parse().ok().zip(unit).and_then(|(number, (_, bytes)): (u64, _)| number.checked_mul(*bytes));
    bytes.ok_or_else(|| "write a whole number and its unit, KiB, MiB, GiB, kB, MB or GB, for example 512MiB".to_owned())
}
