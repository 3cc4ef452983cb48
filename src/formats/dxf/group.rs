//! Reads the bytes of a DXF file as groups: a code, and a value whose type depends on the code.

use crate::formats::source::{TextLines, number, text};
use crate::message::{Message, message};

/// The first bytes of a binary file.
pub(super) const SENTINEL: &[u8] = b"AutoCAD Binary DXF\r\n\x1A\0";

/// A code and its value.
#[derive(Clone, Copy)]
pub(super) struct DxfGroup<'a> {
    pub code: i32,
    value: DxfValue<'a>,
}

#[derive(Clone, Copy)]
enum DxfValue<'a> {
    Text(&'a [u8]),
    Real(f64),
    Whole(i64),
}

impl<'a> DxfGroup<'a> {
    /// The value as text; empty if it is stored as a number.
    pub(super) fn bytes(&self) -> &'a [u8] {
        match self.value {
            DxfValue::Text(text) => text.trim_ascii(),
            _ => &[],
        }
    }

    /// A name, in which characters beyond ASCII may be written as `\U+00E4`.
    pub(super) fn name(&self) -> String {
        let plain = text(self.bytes());
        let mut parts = plain.split("\\U+");
        let mut name = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let code = part.get(..4).and_then(|digits| u32::from_str_radix(digits, 16).ok()).and_then(char::from_u32);
            match (code, part.get(4..)) {
                (Some(letter), Some(rest)) => name.extend([letter].into_iter().chain(rest.chars())),
                _ => name.extend(["\\U+", part]),
            }
        }
        crate::formats::left_out::label(&name)
    }

    /// The value as a finite number; `None` if it is not one.
    pub(super) fn real(&self) -> Option<f64> {
        match self.value {
            DxfValue::Text(text) => number(text.trim_ascii()),
            DxfValue::Real(real) => Some(real).filter(|real| real.is_finite()),
            DxfValue::Whole(whole) => Some(whole as f64),
        }
    }

    /// The value as a whole number.
    pub(super) fn whole(&self) -> Option<i64> {
        match self.value {
            DxfValue::Text(text) => std::str::from_utf8(text.trim_ascii()).ok()?.parse().ok(),
            DxfValue::Real(real) => Some(real as i64),
            DxfValue::Whole(whole) => Some(whole),
        }
    }
}

/// The groups of a file, in order.
pub(super) enum DxfGroups<'a> {
    Written(TextLines<'a>),
    Stored { rest: &'a [u8], at: usize, has_short_codes: bool },
}

impl<'a> DxfGroups<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        match bytes.strip_prefix(SENTINEL) {
            // until release 12 a code is one byte; the first group is always 0 `SECTION`
            Some(rest) => Self::Stored { rest, at: SENTINEL.len(), has_short_codes: rest.get(1) != Some(&0) },
            None => Self::Written(TextLines::new(bytes)),
        }
    }

    /// The reader's position, for a message.
    pub(super) fn position(&self) -> String {
        match self {
            Self::Written(lines) => format!("line {}", lines.number),
            Self::Stored { at, .. } => format!("byte {at}"),
        }
    }

    /// The next group; `None` at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<DxfGroup<'a>>, Message> {
        let group = match self {
            Self::Written(lines) => {
                let Some(code) = lines.next() else { return Ok(None) };
                // blank lines at the end
                if code.trim_ascii().is_empty() && lines.clone().all(|line| line.trim_ascii().is_empty()) {
                    return Ok(None);
                }
                let code = std::str::from_utf8(code.trim_ascii()).ok().and_then(|code| code.parse().ok());
                code.zip(lines.next()).map(|(code, value)| DxfGroup { code, value: DxfValue::Text(value) })
            }
            Self::Stored { rest: [], .. } => return Ok(None),
            Self::Stored { rest, at, has_short_codes } => {
                let before = rest.len();
                let group = stored(rest, *has_short_codes);
                *at += before - rest.len();
                group
            }
        };
        match group {
            Some(group) => Ok(Some(group)),
            None => {
                let what = format!("is cut off or damaged at {}", self.position());
                Err(message![what; "copy or export it again"])
            }
        }
    }
}

fn stored<'a>(rest: &mut &'a [u8], has_short_codes: bool) -> Option<DxfGroup<'a>> {
    let code = match has_short_codes {
        true => match take::<1>(rest)? {
            [255] => i16::from_le_bytes(take(rest)?),
            [code] => code.into(),
        },
        false => i16::from_le_bytes(take(rest)?),
    };
    let value = match code {
        10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => DxfValue::Real(f64::from_le_bytes(take(rest)?)),
        60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => {
            DxfValue::Whole(i16::from_le_bytes(take(rest)?).into())
        }
        90..=99 | 420..=429 | 440..=459 | 1071 => DxfValue::Whole(i32::from_le_bytes(take(rest)?).into()),
        160..=169 => DxfValue::Whole(i64::from_le_bytes(take(rest)?)),
        290..=299 => DxfValue::Whole(take::<1>(rest)?[0].into()),
        310..=319 | 1004 => {
            let [length] = take::<1>(rest)?;
            let (_, behind) = rest.split_at_checked(length.into())?;
            *rest = behind;
            DxfValue::Text(&[])
        }
        _ => {
            let end = rest.iter().position(|&byte| byte == 0)?;
            let (text, behind) = rest.split_at_checked(end)?;
            *rest = behind.get(1..)?;
            DxfValue::Text(text)
        }
    };
    Some(DxfGroup { code: code.into(), value })
}

fn take<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    let (bytes, behind) = rest.split_first_chunk::<N>()?;
    *rest = behind;
    Some(*bytes)
}

pub(super) fn cut_off(groups: &DxfGroups) -> Message {
    let what = format!("is cut off in {}", groups.position());
    message![what; "copy or export it again"]
}
