//! Elements of an XML text, one after another. A function that is given an element reads to the element's end.

use crate::formats::left_out::label;
use crate::formats::source::{as_ascii, number, text, words};
use crate::message::{Message, message};
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

/// The text of a document, in whatever letters it is written.
pub(super) fn text_of(bytes: Vec<u8>) -> String {
    String::from_utf8(as_ascii(bytes)).unwrap_or_else(|error| text(error.as_bytes()))
}

/// The text, from where it was read to.
pub(super) struct DaeXml<'a> {
    reader: Reader<&'a [u8]>,
}

impl<'a> DaeXml<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let mut reader = Reader::from_str(text);
        let config = reader.config_mut();
        // an element without content is one that begins and ends
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

    /// Gives all elements within the one that was given last, each of which is to be read to its end.
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

    /// Gives the elements of one name within the one that was given last; the others are passed over.
    pub(super) fn each(
        &mut self,
        wanted: &str,
        mut each: impl FnMut(&mut Self, &BytesStart<'a>) -> Result<(), Message>,
    ) -> Result<(), Message> {
        self.children(|xml, name, element| if name == wanted { each(xml, element) } else { xml.skip() })
    }

    /// Passes over the element that was given last.
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

    /// The texts of the element that was given last, without those of elements in it.
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

    /// The first word of the element that was given last; empty where it has none.
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

    /// The numbers of the element that was given last.
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

    /// Gives the whole numbers of the element that was given last, each with how many stand before it.
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
    let what = format!("has `{}` where a number is to stand", label(&String::from_utf8_lossy(word)));
    message![what; "the file is damaged: export it again"]
}

/// An attribute; none where the element has none, or an empty one.
pub(super) fn attribute(element: &BytesStart, name: &str) -> Option<String> {
    let attribute = element.try_get_attribute(name).ok()??;
    // entities of the file's own stay as they are written
    let plain = attribute.normalized_value(XmlVersion::Implicit1_0).unwrap_or_else(|_| attribute.value.clone());
    Some(plain.into_owned()).filter(|value| !value.trim().is_empty())
}

/// What an address leads to within the file, `#id`; none where it leads out of it.
pub(super) fn local_id(element: &BytesStart, name: &str) -> Option<String> {
    attribute(element, name)?.strip_prefix('#').map(str::to_owned)
}
