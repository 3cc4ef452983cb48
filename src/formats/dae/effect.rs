//! Effects: how much light a material lets through.

use super::xml::{DaeXml, attribute};
use crate::message::Message;
use quick_xml::events::BytesStart;

/// An effect's opacity (Collada 1.5, "Determining Transparency").
#[derive(Default)]
pub(super) struct DaeEffect {
    /// `A_ONE`, `RGB_ZERO` and so on; `A_ONE` by default.
    opaque: String,
    /// Red, green, blue, alpha.
    colour: Option<[f64; 4]>,
    transparency: Option<f64>,
    is_cut_out: bool,
}

/// Reads the current element as an effect.
pub(super) fn read(xml: &mut DaeXml) -> Result<DaeEffect, Message> {
    let mut effect = DaeEffect::default();
    xml.each("profile_COMMON", |xml, _| {
        xml.each("technique", |xml, _| {
            xml.children(|xml, name, _| match name {
                "phong" | "lambert" | "blinn" | "constant" => {
                    xml.children(|xml, name, element| effect.shader(xml, name, element))
                }
                _ => xml.skip(),
            })
        })
    })?;
    Ok(effect)
}

impl DaeEffect {
    fn shader(&mut self, xml: &mut DaeXml, name: &str, element: &BytesStart) -> Result<(), Message> {
        match name {
            "transparent" => {
                self.opaque = attribute(element, "opaque").unwrap_or_default();
                xml.children(|xml, name, _| match name {
                    "color" => {
                        self.colour = xml.numbers()?.first_chunk().copied();
                        Ok(())
                    }
                    "texture" => {
                        self.is_cut_out = true;
                        xml.skip()
                    }
                    _ => xml.skip(),
                })
            }
            "transparency" => xml.each("float", |xml, _| {
                self.transparency = xml.numbers()?.first().copied();
                Ok(())
            }),
            _ => xml.skip(),
        }
    }

    pub(super) fn is_see_through(&self) -> bool {
        let [red, green, blue, alpha] = self.colour.unwrap_or([1.0; 4]);
        let transparency = self.transparency.unwrap_or(1.0);
        // luminance with Collada's weights
        let grey = 0.212671 * red + 0.71516 * green + 0.072169 * blue;
        let opacity = match self.opaque.as_str() {
            "RGB_ZERO" => 1.0 - grey * transparency,
            "RGB_ONE" => grey * transparency,
            "A_ZERO" => 1.0 - alpha * transparency,
            _ => alpha * transparency,
        };
        // many programs write the opposite, and nobody models what is invisible
        self.is_cut_out || opacity > 0.0 && opacity < 0.999
    }
}
