//! Reads the elements of an XML text one after another. A function that gets an element reads up to its end.

use crate::formats::left_out::label;
use crate::formats::source::{as_ascii, number, text, words};
use crate::message::{Message, message};
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

/// The text of a document, in any encoding.
pub(super) fn text_of(bytes: Vec<u8>) -> String {
    String::from_utf8(as_ascii(bytes)).unwrap_or_else(|error| text(error.as_bytes()))
}

/// The text, and the position up to which it is read.
pub(super) struct DaeXml<'a> {
    reader: Reader<&'a [u8]>,
}

impl<'a> DaeXml<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let mut reader = Reader::from_str(text);
        let config = reader.config_mut();
        // an empty element gives a start and an end
        config.expand_empty_elements = true;
        config.allow_dangling_amp = true;
        Self { reader }
    }

    fn event(&mut self) -> Result<Event<'a>, Message> {
        match self.reader.read_event() {
            Ok(Event::Eof) => Err(message!["is cut off: its last element has no end"; "copy or export it again"]),
            Ok(event) => Ok(event),
            Err(error) => {
                let what = format!("is damaged XML at byte {} ({error})", self.reader.error_position());
                Err(message![what; "copy or export it again"])
            }
        }
    }

    /// The first element of the text.
    pub(super) fn root(&mut self) -> Result<BytesStart<'a>, Message> {
        loop {
            if let Event::Start(element) = self.event()? {
                return Ok(element);
            }
        }
    }

    /// Calls the function for all elements within the current one; it must read each to its end.
    pub(super) fn children(
        &mut self,
        mut each: impl FnMut(&mut Self, &str, &BytesStart<'a>) -> Result<(), Message>,
    ) -> Result<(), Message> {
        loop {
            match self.event()? {
                Event::Start(element) => {
                    let name = element.local_name();
                    each(self, name.as_ref(), &element)?;
                }
                Event::End(_) => return Ok(()),
                _ => (),
            }
        }
    }

    /// Calls the function for the elements of one name within the current one, and skips the others.
    pub(super) fn each(
        &mut self,
        wanted: &str,
        mut each: impl FnMut(&mut Self, &BytesStart<'a>) -> Result<(), Message>,
    ) -> Result<(), Message> {
        self.children(|xml, name, element| if name == wanted { each(xml, element) } else { xml.skip() })
    }

    /// Skips the current element.
    pub(super) fn skip(&mut self) -> Result<(), Message> {
        let mut depth = 0_usize;
        loop {
            match self.event()? {
                Event::Start(_) => depth += 1,
                Event::End(_) if depth == 0 => return Ok(()),
                Event::End(_) => depth -= 1,
                _ => (),
            }
        }
    }

    /// The text of the current element, without that of elements in it.
    fn texts(&mut self, mut each: impl FnMut(&str) -> Result<(), Message>) -> Result<(), Message> {
        loop {
            match self.event()? {
                Event::Start(_) => self.skip()?,
                Event::End(_) => return Ok(()),
                Event::Text(text) => each(&text.into_inner())?,
                Event::CData(text) => each(&text.into_inner())?,
                _ => (),
            }
        }
    }

    /// The first word of the current element; empty if it has none.
    pub(super) fn word(&mut self) -> Result<String, Message> {
        let mut word = String::new();
        self.texts(|text| {
            if word.is_empty() {
                word = text.split_ascii_whitespace().next().unwrap_or_default().to_owned();
            }
            Ok(())
        })?;
        Ok(word)
    }

    /// The numbers in the current element.
    pub(super) fn numbers(&mut self) -> Result<Vec<f64>, Message> {
        let mut numbers = Vec::new();
        self.texts(|text| {
            for word in words(text.as_bytes()) {
                numbers.push(number(word).ok_or_else(|| no_number(word))?);
            }
            Ok(())
        })?;
        Ok(numbers)
    }

    /// Calls the function with each whole number in the current element and its index.
    pub(super) fn wholes(&mut self, mut each: impl FnMut(usize, u32)) -> Result<(), Message> {
        let mut before = 0;
        self.texts(|text| {
            for word in words(text.as_bytes()) {
                let whole = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
                each(before, whole.ok_or_else(|| no_number(word))?);
                before += 1;
            }
            Ok(())
        })
    }
}

fn no_number(word: &[u8]) -> Message {
    let what = format!("has `{}` where a number is expected", label(&String::from_utf8_lossy(word)));
    message![what; "the file is damaged: export it again"]
}

/// An attribute; `None` if it is missing or empty.
pub(super) fn attribute(element: &BytesStart, name: &str) -> Option<String> {
    let attribute = element.try_get_attribute(name).ok()??;
    // entities that the file defines stay as they are written
    let plain = attribute.normalized_value(XmlVersion::Implicit1_0).unwrap_or_else(|_| attribute.value.clone());
    Some(plain.into_owned()).filter(|value| !value.trim().is_empty())
}

/// The id in a reference `#id` within the file; `None` for references to other files.
pub(super) fn local_id(element: &BytesStart, name: &str) -> Option<String> {
    attribute(element, name)?.strip_prefix('#').map(str::to_owned)
}
