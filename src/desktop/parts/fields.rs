//! Fields for typing. The text is read when it is finished, in any usual spelling. Text that cannot be read changes
//! nothing, and the reason is shown below its field.

use crate::desktop::state::words::PanelWords;
use crate::message::Worded;
use crate::site::typed::{self, Axis, Degrees, TypedError};
use eframe::egui::{self, DragValue, Id, Response, Ui, emath};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// The text that is being typed, and the texts that could not be read.
#[derive(Default)]
pub(in crate::desktop) struct TypedText {
    /// The field into which text is being typed, and the text.
    now: Option<(String, String)>,
    /// For each field, what it showed when other text was typed, and why that text is refused.
    faults: BTreeMap<String, (String, String)>,
}

/// The range of a number field, and how it shows the number.
pub(in crate::desktop) struct NumberField<'a> {
    /// The change per point when it is dragged.
    pub(in crate::desktop) speed: f64,
    /// The numbers that it accepts.
    pub(in crate::desktop) range: RangeInclusive<f64>,
    /// The unit of the number.
    pub(in crate::desktop) unit: &'static str,
    /// The text after the number.
    pub(in crate::desktop) suffix: &'a str,
    /// The number of decimals that it shows.
    pub(in crate::desktop) decimals: RangeInclusive<usize>,
}

impl TypedText {
    /// A text field. Returns what was read from the text once it was finished.
    pub(in crate::desktop) fn text<T>(
        &mut self,
        ui: &mut Ui,
        (name, label): (&str, Id),
        said: &str,
        width: f32,
        read: impl FnOnce(&str) -> Result<T, TypedError>,
    ) -> Option<T> {
        self.forget(name, said);
        let mut text = match &self.now {
            Some((field, typed)) if field == name => typed.clone(),
            _ => said.to_owned(),
        };
        let response = ui.add(egui::TextEdit::singleline(&mut text).desired_width(width)).labelled_by(label);
        if response.changed() {
            self.faults.remove(name);
            self.now = Some((name.to_owned(), text));
        }
        if !response.lost_focus() {
            return None;
        }
        let (_, text) = self.now.take_if(|(field, _)| field == name)?;
        let read = read(&text);
        self.keep(name, said, read.as_ref().err());
        read.ok()
    }

    /// A number field, which can also be dragged.
    pub(in crate::desktop) fn number(
        &mut self,
        ui: &mut Ui,
        field: (&str, Id),
        value: &mut f64,
        number: &NumberField<'_>,
    ) -> Response {
        self.read_number(ui, field, value, number, |text| typed::within(text, number.range.clone(), number.unit))
    }

    fn read_number(
        &mut self,
        ui: &mut Ui,
        (name, label): (&str, Id),
        value: &mut f64,
        number: &NumberField<'_>,
        read: impl Fn(&str) -> Result<f64, TypedError>,
    ) -> Response {
        let before = *value;
        self.forget(name, &before.to_string());
        let shown = RefCell::new(String::new());
        let fault = Cell::new(None);
        let parse = |text: &str| {
            // an unchanged value keeps the decimals that are not shown
            if *shown.borrow() == text {
                return Some(before);
            }
            read(text).map_err(|error| fault.set(Some(error))).ok()
        };
        let format = |value, decimals| {
            let text = emath::format_with_decimals_in_range(value, decimals);
            shown.borrow_mut().clone_from(&text);
            text
        };
        let drag = DragValue::new(value).speed(number.speed).range(number.range.clone()).suffix(number.suffix);
        let drag = drag.min_decimals(*number.decimals.start()).max_decimals(*number.decimals.end());
        // read only when finished: its beginning may be a different number
        let drag = drag.update_while_editing(false);
        let response = ui.add(drag.custom_formatter(format).custom_parser(parse)).labelled_by(label);
        let fault = fault.take();
        if fault.is_some() || response.changed() || response.gained_focus() {
            self.keep(name, &before.to_string(), fault.as_ref());
        }
        response
    }

    /// A field for a latitude or longitude in degrees. Returns both if a place is typed into it.
    pub(in crate::desktop) fn degrees(
        &mut self,
        ui: &mut Ui,
        field: (&str, Id),
        value: &mut f64,
        axis: Axis,
    ) -> (bool, Option<[f64; 2]>) {
        let place = Cell::new(None);
        let read = |text: &str| match typed::degrees(text, axis)? {
            Degrees::One(value) => Ok(value),
            Degrees::Both(both) => {
                place.set(Some(both));
                Ok(if axis == Axis::Latitude { both[0] } else { both[1] })
            }
        };
        let range = -axis.most()..=axis.most();
        let number = NumberField { speed: 0.01, range, unit: "degrees", suffix: "°", decimals: 4..=6 };
        let response = self.read_number(ui, field, value, &number, read);
        (response.changed(), place.take())
    }

    /// Shows why the text typed into one of these fields is refused.
    pub(in crate::desktop) fn show_faults(&self, ui: &mut Ui, names: &[&str]) {
        for (_, fault) in names.iter().filter_map(|name| self.faults.get(*name)) {
            refused(ui, fault);
        }
    }

    fn keep(&mut self, name: &str, said: &str, fault: Option<&TypedError>) {
        match fault {
            Some(fault) => self.faults.insert(name.to_owned(), (said.to_owned(), fault.in_words(&PanelWords))),
            None => self.faults.remove(name),
        };
    }

    /// Forgets a refused text once the field shows something else, after an undo or with another site.
    fn forget(&mut self, name: &str, said: &str) {
        if self.faults.get(name).is_some_and(|(then, _)| then != said) {
            self.faults.remove(name);
        }
    }
}

/// Shows below a field why the typed text is refused.
pub(in crate::desktop) fn refused(ui: &mut Ui, fault: &str) {
    let text = egui::RichText::new(fault.replace('`', "").replace(" -", " −")).color(ui.visuals().error_fg_color);
    ui.add(egui::Label::new(text).wrap());
}
