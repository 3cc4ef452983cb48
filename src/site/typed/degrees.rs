//! Latitude and longitude as people type them, one or both.

use super::number::number;
use super::{Axis, TypedError};
use crate::sun::SunError;

impl Axis {
    fn of(letter: char) -> Axis {
        if matches!(letter, 'N' | 'S') { Axis::Latitude } else { Axis::Longitude }
    }

    fn checked(self, value: f64) -> Result<f64, TypedError> {
        let (low, high) = (-self.most(), self.most());
        if (low..=high).contains(&value) {
            return Ok(value);
        }
        let what = if self == Axis::Latitude { "latitude" } else { "longitude" };
        Err(SunError::OutOfRange { what, value, low, high, unit: "degrees" }.into())
    }
}

/// The contents of a field for one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Degrees {
    /// The angle.
    One(f64),
    /// Latitude and longitude.
    Both([f64; 2]),
}

/// Reads an angle as people write it, or a whole place if one is pasted: `48.2082`, `48,2082`, `48.2082° N`, `48°12'30"
/// N`.
///
/// # Errors
/// [`TypedError::Degrees`], and [`SunError::OutOfRange`].
pub fn degrees(text: &str, axis: Axis) -> Result<Degrees, TypedError> {
    let one = single(&plain(text)).filter(|(_, letter)| letter.is_none_or(|letter| Axis::of(letter) == axis));
    let one = one.map(|(value, _)| axis.checked(value));
    if let Some(Ok(value)) = one {
        return Ok(Degrees::One(value));
    }
    match (place(text), one) {
        (Ok(both), _) => Ok(Degrees::Both(both)),
        // two angles, one of which is out of range
        (Err(TypedError::Sun(error)), None) => Err(error.into()),
        (Err(_), Some(Err(error))) => Err(error),
        (Err(_), _) => Err(TypedError::Degrees { text: text.trim().to_owned(), axis }),
    }
}

/// Reads latitude and longitude as people write them: `48.2082, 16.3738`, `48,2082; 16,3738`, `48.2082 16.3738`,
/// `48°12'30" N 16°22'26" E`. Letters say which is which; without them the latitude comes first. Degrees, north and
/// east positive.
///
/// # Errors
/// [`TypedError::Place`], and [`SunError::OutOfRange`].
pub fn place(text: &str) -> Result<[f64; 2], TypedError> {
    let bad = || TypedError::Place(text.trim().to_owned());
    let plain = plain(text);
    let (first, second) = halves(&plain).ok_or_else(bad)?;
    let [(a, first), (b, second)] = [single(first).ok_or_else(bad)?, single(second).ok_or_else(bad)?];
    let [first, second] = [first.map(Axis::of), second.map(Axis::of)];
    if first.is_some() && first == second {
        return Err(bad());
    }
    let is_turned = first == Some(Axis::Longitude) || second == Some(Axis::Latitude);
    let (latitude, longitude) = if is_turned { (b, a) } else { (a, b) };
    Ok([Axis::Latitude.checked(latitude)?, Axis::Longitude.checked(longitude)?])
}

/// Replaces the variants of signs that keyboards and word processors use.
fn plain(text: &str) -> String {
    let one = |char: char| match char {
        '−' | '–' => '-',
        'º' | '˚' => '°',
        '′' | '’' | '‘' | '´' | '`' => '\'',
        '″' | '”' | '“' => '"',
        char if char.is_whitespace() => ' ',
        char => char.to_ascii_uppercase(),
    };
    let text = text.trim().chars().map(one).collect::<String>();
    text.replace("''", "\"")
}

/// Splits the two angles of a place at the most certain separator.
fn halves(text: &str) -> Option<(&str, &str)> {
    let letters: Vec<usize> = text.match_indices(['N', 'S', 'E', 'W']).map(|(at, _)| at).collect();
    let is_apart = |at: usize| text[..at].ends_with(' ') || text[at + 1..].starts_with(' ');
    let commas: Vec<usize> = text.match_indices(',').map(|(at, _)| at).collect();
    let loose: Vec<usize> = commas.iter().copied().filter(|at| is_apart(*at)).collect();
    let signs: Vec<usize> = text.match_indices('°').map(|(at, _)| at).collect();
    if text.contains(';') {
        return text.split_once(';');
    }
    if let [at] = loose[..] {
        return Some((&text[..at], &text[at + 1..]));
    }
    if let [first, second] = letters[..] {
        let at = if first == 0 { second } else { first + 1 };
        let (first, second) = text.split_at(at);
        return Some((first.trim_end_matches([',', ' ']), second.trim_start_matches([',', ' '])));
    }
    if let [_, second] = signs[..] {
        let is_of_number = |char: char| char.is_ascii_digit() || matches!(char, '.' | ',' | '-');
        let (first, second) = text.split_at(text[..second].trim_end_matches(is_of_number).len());
        return Some((first.trim_end(), second.trim_start_matches(',')));
    }
    // a single letter may be part of degrees and minutes
    if let [first, second] = text.split(' ').filter(|part| !part.is_empty()).collect::<Vec<_>>()[..]
        && letters.len() != 1
    {
        return Some((first, second));
    }
    match commas[..] {
        [at] | [_, at, _] => Some((&text[..at], &text[at + 1..])),
        _ => None,
    }
}

/// Degrees, or degrees, minutes and seconds, with the letter beside them.
fn single(text: &str) -> Option<(f64, Option<char>)> {
    let is_letter = |char: &char| matches!(char, 'N' | 'S' | 'E' | 'W');
    let text = text.trim();
    let (text, letter) = match (text.chars().next().filter(is_letter), text.chars().last().filter(is_letter)) {
        (Some(letter), None) => (&text[1..], Some(letter)),
        (None, Some(letter)) => (&text[..text.len() - 1], Some(letter)),
        (None, None) => (text, None),
        (Some(_), Some(_)) => return None,
    };
    let text = text.trim();
    let (negative, mut rest) = match text.strip_prefix('-') {
        // a sign and a letter could contradict each other
        Some(_) if letter.is_some() => return None,
        Some(rest) => (true, rest.trim_start()),
        None => (matches!(letter, Some('S' | 'W')), text.strip_prefix('+').unwrap_or(text)),
    };
    let mut value = 0.0;
    let mut is_whole = true;
    for (index, (mark, size)) in [('°', 1.0), ('\'', 60.0), ('"', 3600.0)].into_iter().enumerate() {
        if rest.is_empty() && index > 0 {
            break;
        }
        let end = rest.find(|char: char| !char.is_ascii_digit() && !matches!(char, '.' | ',')).unwrap_or(rest.len());
        let part = number(&rest[..end]).ok()?;
        if !is_whole || (index > 0 && part >= 60.0) {
            return None;
        }
        is_whole = part.fract() == 0.0 && !rest[..end].contains(['.', ',']);
        value += part / size;
        rest = rest[end..].trim_start();
        match rest.strip_prefix(mark) {
            Some(after) => rest = after.trim_start(),
            // spaces separate minutes from degrees only if a letter follows
            None if rest.is_empty() || letter.is_some() => {}
            None => return None,
        }
    }
    rest.is_empty().then_some((if negative { -value } else { value }, letter))
}
