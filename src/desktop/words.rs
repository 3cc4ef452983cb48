//! What the window calls the fields of a request: by its labels, and what it has none for by the site file's keys.

use crate::message::{Field, Words};

/// The words of what is set in the panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Labels;

/// The words of a site file that is opened: its keys, which nobody has seen as labels yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Keys;

impl Words for Labels {
    fn name(&self, field: Field) -> Option<&'static str> {
        label(field)
    }

    fn key(&self, field: Field) -> &'static str {
        label(field).unwrap_or_else(|| field.name())
    }

    fn at(&self, file: &str, table: &str, key: &str) -> String {
        match (table, key) {
            ("[place]", "") => "Place".to_owned(),
            ("[place]", "name") => "Name".to_owned(),
            ("[place]", "latitude") => "Latitude".to_owned(),
            ("[place]", "longitude") => "Longitude".to_owned(),
            ("[place]", "elevation") => "Elevation".to_owned(),
            ("[[model]]", "north") => "Model north".to_owned(),
            ("[[model]]", "scale") => "scale".to_owned(),
            ("[ground]", "level") => "Ground".to_owned(),
            ("[study]", "date") => "Study date".to_owned(),
            ("[study]", "dates") => "Study days".to_owned(),
            ("[study]", "from") => "From".to_owned(),
            ("[study]", "to") => "To".to_owned(),
            ("[study]", "step") => "Step".to_owned(),
            ("[study]", "technique") => "Technique".to_owned(),
            _ => Keys.at(file, table, key),
        }
    }
}

impl Words for Keys {
    fn name(&self, field: Field) -> Option<&'static str> {
        label(field)
    }
}

/// A label of the panel; or where a site file has a field that the window has not.
fn label(field: Field) -> Option<&'static str> {
    Some(match field {
        Field::Ground => "Ground",
        Field::Date => "Study date",
        Field::FromDate => "First day",
        Field::ToDate => "Last day",
        Field::From => "From",
        Field::To => "To",
        Field::Step => "Step",
        Field::Technique => "Technique",
        Field::SunSamples => "The sun as a disc",
        Field::Volumes => "Volumes and Silhouette",
        Field::MaskDiagram | Field::OverdrawDiagram => "Picture of",
        Field::Cell => "cell under [plan] in the site file",
        Field::Region => "region under [plan] in the site file",
        _ => return None,
    })
}
