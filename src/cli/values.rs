//! Reads the values of options. Errors name the option.

use crate::message::Field;
use crate::site::typed::{self, TypedError};
use crate::site::{FieldLocation, SiteError};
use crate::sun::{Reading, SunError, parse_date, parse_duration_secs};
use chrono::NaiveDate;
use glam::DVec3;

type ReadValue<T> = Result<Option<T>, SiteError>;

pub(super) fn place(text: &Option<String>) -> ReadValue<[f64; 2]> {
    read(Field::Place, text, typed::place)
}

pub(super) fn date(field: Field, text: &Option<String>) -> ReadValue<NaiveDate> {
    read(field, text, parse_date)
}

pub(super) fn reading(field: Field, text: &Option<String>) -> ReadValue<Reading> {
    read(field, text, |text| -> Result<Reading, SunError> { text.parse() })
}

pub(super) fn step_secs(text: &Option<String>) -> ReadValue<u32> {
    read(Field::Step, text, parse_duration_secs)
}

pub(super) fn resolution_secs(text: &Option<String>) -> ReadValue<u32> {
    read(Field::Resolution, text, typed::resolution_secs)
}

pub(super) fn region(text: &Option<String>) -> ReadValue<[f64; 4]> {
    read(Field::Region, text, |text| typed::numbers(text, (Field::Region, "-300,-300,300,300")))
}

pub(super) fn point(text: &Option<String>) -> ReadValue<DVec3> {
    read(Field::Point, text, |text| vector(text, (Field::Point, "12,-3,4.5")))
}

pub(super) fn normal(text: &Option<String>) -> ReadValue<DVec3> {
    read(Field::Normal, text, |text| vector(text, (Field::Normal, "0,-1,0")))
}

fn vector(text: &str, example: (Field, &'static str)) -> Result<DVec3, TypedError> {
    typed::numbers(text, example).map(DVec3::from_array)
}

/// Reads the value of an option, if it is given.
fn read<T, E: Into<TypedError>>(
    field: Field,
    text: &Option<String>,
    reader: impl FnOnce(&str) -> Result<T, E>,
) -> ReadValue<T> {
    let read = text.as_deref().map(reader).transpose();
    read.map_err(|error| SiteError::typed(FieldLocation::Field(field), error))
}
