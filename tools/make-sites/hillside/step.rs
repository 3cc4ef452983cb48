//! The lines of a STEP file, numbered in the order of writing.

use std::fmt::Write as _;

/// A file's data section.
#[derive(Default)]
pub(super) struct Step {
    lines: String,
    last: u32,
}

/// The number of a line.
pub(super) type Line = u32;

impl Step {
    /// Adds a line, and gives its number.
    pub(super) fn add(&mut self, entity: impl AsRef<str>) -> Line {
        self.last += 1;
        let _ = writeln!(self.lines, "#{}={};", self.last, entity.as_ref());
        self.last
    }

    /// A global identifier that is the next line's own: 22 letters of IFC's 64.
    pub(super) fn guid(&self) -> String {
        format!("'0Hillside{:013}'", self.last + 1)
    }

    /// The whole file.
    pub(super) fn file(self, description: &str) -> String {
        format!(
            "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('{description}'),'2;1');\n\
             FILE_NAME('house.ifc','2026-01-01T00:00:00',(''),(''),'','','');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\n\
             DATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
            self.lines
        )
    }
}

/// Numbers of lines as a list.
pub(super) fn list(lines: &[Line]) -> String {
    let lines: Vec<String> = lines.iter().map(|line| format!("#{line}")).collect();
    format!("({})", lines.join(","))
}
