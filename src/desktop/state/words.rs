//! The window's words for the fields of a request: the labels of its panel, and for fields without a label the keys of
//! the site file.

use crate::message::{Field, Words};

/// The words for settings in the panel: keys are labels.
#[derive(Clone, Copy, Debug)]
pub(in crate::desktop) struct PanelWords;

/// The same for several models: the panel has no fields for their north and scale, so these keep their keys.
#[derive(Clone, Copy, Debug)]
struct SeveralModelsWords;

/// The words for the panel of a site with this number of models.
pub(in crate::desktop) fn of_panel(models: usize) -> &'static dyn Words {
    if models > 1 { &SeveralModelsWords } else { &PanelWords }
}

/// The words for the contents of files: keys stay keys.
#[derive(Clone, Copy, Debug)]
pub(in crate::desktop) struct FileWords;

impl Words for PanelWords {
    fn name(&self, field: Field) -> Option<&'static str> {
        FileWords.name(field)
    }

    fn key(&self, field: Field) -> &'static str {
        match field {
            Field::Date => "\"Study date\"",
            Field::From => "\"Window\"",
            Field::To => "\"to\"",
            Field::Step => "\"step\"",
            Field::Resolution => "\"Resolution\"",
            _ => field.name(),
        }
    }

    fn setting(&self, table: &str, key: &str, value: Option<&str>, written: &str) -> String {
        match (table, key, value) {
            ("[ground]", "level", _) => "\"Ground\" under Place".to_owned(),
            ("[place]", "", _) => "\"Latitude\" and \"Longitude\" under Place".to_owned(),
            ("[place]", "latitude", _) => "\"Latitude\"".to_owned(),
            ("[place]", "longitude", _) => "\"Longitude\"".to_owned(),
            ("[place]", "elevation", _) => "\"Elevation\" under Place".to_owned(),
            ("[[model]]", "north", _) => "\"Model north\" under Place".to_owned(),
            ("[[area]]", "", _) => "an area (\"Draw an area\" under Judge by a rule)".to_owned(),
            ("[[window]]", "", _) => "a window (\"Pick windows\" under Judge by a rule)".to_owned(),
            ("[plot]", "", _) => "the plot (\"Draw the plot\" under Judge by a rule)".to_owned(),
            ("[before]", "", _) => "the state before (a component's name under Components)".to_owned(),
            // the panel has no fields for them
            ("[[model]]", "crs" | "position", _) => format!("`{key}` under [[model]] in the site file"),
            ("[[model]]", "scale", None) => "\"scale\" under Place".to_owned(),
            ("[[model]]", "scale", Some(value)) => format!("{value} for \"scale\" under Place"),
            ("[[model]]", "receives", _) => "\"receives\" under Components".to_owned(),
            ("[[model]]", "casts", None) => "\"casts\" under Components".to_owned(),
            ("[[model]]", "casts", Some(_)) => "\"casts\" switched off under Components".to_owned(),
            _ => written.to_owned(),
        }
    }

    fn at(&self, file: &str, table: &str, key: &str) -> String {
        let label = match (table, key) {
            ("[place]", "") => "Place",
            ("[place]", "latitude") => "Latitude",
            ("[place]", "longitude") => "Longitude",
            ("[place]", "elevation") => "Elevation",
            ("[[model]]", "north") => "Model north",
            ("[[model]]", "scale") => "Model north, scale",
            ("[ground]", "level") => "Ground",
            ("[study]", "date") => "Study date",
            ("[study]", "dates") => "Study days",
            ("[study]", "from") => "Window",
            ("[study]", "to") => "Window, to",
            ("[study]", "step") => "Study date, step",
            ("[study]", "resolution") => "Resolution",
            ("[study]", "technique") => "Technique",
            _ => return FileWords.at(file, table, key),
        };
        label.to_owned()
    }
}

impl Words for SeveralModelsWords {
    fn name(&self, field: Field) -> Option<&'static str> {
        PanelWords.name(field)
    }

    fn key(&self, field: Field) -> &'static str {
        PanelWords.key(field)
    }

    fn setting(&self, table: &str, key: &str, value: Option<&str>, written: &str) -> String {
        match (table, key) {
            ("[[model]]", "north" | "scale") => written.to_owned(),
            _ => PanelWords.setting(table, key, value, written),
        }
    }

    fn at(&self, file: &str, table: &str, key: &str) -> String {
        match (table, key) {
            ("[[model]]", "north" | "scale") => FileWords.at(file, table, key),
            _ => PanelWords.at(file, table, key),
        }
    }
}

impl Words for FileWords {
    fn name(&self, field: Field) -> Option<&'static str> {
        Some(match field {
            Field::Technique => "Technique",
            Field::Step => "step",
            Field::Resolution => "Resolution",
            Field::SunSamples => "The sun as a disc",
            Field::Volumes => "Volumes and Silhouette",
            Field::MaskDiagram | Field::OverdrawDiagram => "Picture of",
            Field::Cell => "cell under [plan] in the site file",
            _ => return None,
        })
    }
}
