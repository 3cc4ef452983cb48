//! Reads the attributes of a shapefile: the wanted columns of a dBASE table.

use super::flatbuffer::bytes_at;
use super::tags::FootprintTags;

/// The bytes of a column's description.
const COLUMN_BYTES: usize = 32;

/// A table, row by row.
pub(super) struct AttributeTable<'a> {
    rows: &'a [u8],
    row_bytes: usize,
    columns: Vec<WantedColumn>,
}

struct WantedColumn {
    name: String,
    first: usize,
    bytes: usize,
    is_truth: bool,
}

impl<'a> AttributeTable<'a> {
    /// Reads the table's header; `None` if the bytes are not a dBASE table.
    pub(super) fn of(bytes: &'a [u8]) -> Option<Self> {
        let head_bytes = usize::from(u16::from_le_bytes(bytes_at(bytes, 8)?));
        let row_bytes = usize::from(u16::from_le_bytes(bytes_at(bytes, 10)?));
        let rows = bytes.get(head_bytes..).filter(|_| row_bytes > 0)?;
        let mut columns = Vec::new();
        // a row begins with the mark of deleted rows
        let mut first = 1;
        let described = bytes.get(COLUMN_BYTES..head_bytes)?.chunks_exact(COLUMN_BYTES);
        for column in described.take_while(|column| column[0] != b'\r') {
            let name = column[..11].split(|&byte| byte == 0).next().unwrap_or_default();
            let (name, width) = (text(name), usize::from(column[16]));
            if FootprintTags::wants(&name) {
                columns.push(WantedColumn { name, first, bytes: width, is_truth: column[11] == b'L' });
            }
            first += width;
        }
        Some(Self { rows, row_bytes, columns })
    }

    /// The attributes in a row, from 0; `None` without such a row.
    pub(super) fn row(&self, number: usize) -> Option<FootprintTags> {
        let first = number.checked_mul(self.row_bytes)?;
        let row = self.rows.get(first..first.checked_add(self.row_bytes)?)?;
        let mut tags = FootprintTags::default();
        for column in &self.columns {
            let value = row.get(column.first..column.first + column.bytes).unwrap_or_default();
            let value = text(value.split(|&byte| byte == 0).next().unwrap_or_default());
            let value = match value.trim() {
                "T" | "t" | "Y" | "y" if column.is_truth => "yes",
                _ if column.is_truth => "no",
                // stars mean that the number did not fit
                value => value.trim_start_matches('*'),
            };
            tags.set(&column.name, value);
        }
        Some(tags)
    }
}

/// Text in UTF-8, otherwise in Latin-1, as in most other tables.
fn text(bytes: &[u8]) -> String {
    std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(|&byte| char::from(byte)).collect(), str::to_owned)
}
