//! The sizes that a LAS or LAZ file says, held against its length: its decoder takes memory for whatever is said.
//!
//! A LAZ file has its points in chunks, whose lengths are in a table behind them. Points of the formats from 6 on are in
//! layers: each chunk begins with its first point, the number of its points, and the length of each layer.

use crate::formats::ModelFault;
use crate::message::message;
use las::Header;
use laz::laszip::ChunkTable;
use std::io::{Read, Seek, SeekFrom};

/// The most points that are read.
const MAX_POINTS: u64 = 100_000_000;
/// The longest point, bytes. Those of the standard have 67; a decoder keeps kilobytes for each byte beyond.
const MAX_RECORD: u64 = 1024;
/// More points than this have no room in a byte, however much they are alike.
const MAX_IN_A_BYTE: u64 = 256;
/// The head of an extended record, which says its own length at some byte.
const EXTENDED_HEAD: u64 = 60;
const EXTENDED_LENGTH: u64 = 20;

/// How LAZ is packed.
const ALL_IN_ONE: u16 = 1;
const CHUNKED: u16 = 2;
const LAYERED: u16 = 3;

/// How the points of a LAZ file are packed, as the record of its writer says.
struct LazPacking {
    method: u16,
    /// Points in a chunk; none where each chunk has its own number.
    chunk_points: Option<u64>,
    /// Bytes of an unpacked point.
    record: u64,
    /// Layers of a chunk.
    layers: u64,
}

/// Refuses a file whose sizes are more than its length allows.
pub(super) fn hold(file: &mut (impl Read + Seek)) -> Result<(), ModelFault> {
    let length = file.seek(SeekFrom::End(0)).map_err(ModelFault::unreadable)?;
    file.rewind().map_err(ModelFault::unreadable)?;
    let head = las::raw::Header::read_from(&mut *file).map_err(unusable)?;
    let count = u64::from(head.number_of_point_records).max(head.large_file.map_or(0, |it| it.number_of_point_records));
    if count > MAX_POINTS {
        let what = format!("has {count} points, and a model may have {MAX_POINTS}");
        return Err(message![what; "cut it to the surroundings of the place, or thin its points"].into());
    }
    let (start, record) = (u64::from(head.offset_to_point_data), u64::from(head.point_data_record_length));
    if record > MAX_RECORD {
        let what = format!("has points of {record} bytes each, and they may have {MAX_RECORD}");
        return Err(message![what; "export it without extra dimensions"].into());
    }
    if let Some(extended) = head.evlr {
        let from = extended.start_of_first_evlr;
        let said = u64_at(file, from.saturating_add(EXTENDED_LENGTH))?;
        if from.saturating_add(EXTENDED_HEAD).saturating_add(said) > length {
            return Err(cut_off("its extended records end beyond its end"));
        }
    }
    let Some(bytes) = length.checked_sub(start) else { return Err(cut_off("its points begin beyond its end")) };
    file.rewind().map_err(ModelFault::unreadable)?;
    let header = Header::new(&mut *file).map_err(unusable)?;
    if !header.point_format().is_compressed {
        let there = bytes / record.max(1);
        return if there < count { Err(cut_off(&format!("it has {there} of {count} points"))) } else { Ok(()) };
    }
    if count / MAX_IN_A_BYTE > bytes {
        return Err(damaged(&format!("it says that it has {count} points, in {bytes} bytes")));
    }
    let said = header.vlrs().iter().find(|record| las::laz::is_laszip_vlr(record));
    let packing = said.and_then(|record| LazPacking::read(&record.data)).filter(|packing| packing.record == record);
    let packing = packing.ok_or_else(|| damaged("it does not say how its points are packed"))?;
    match packing.method {
        ALL_IN_ONE => Ok(()),
        _ => packing.hold_chunks(file, [start, length], count),
    }
}

impl LazPacking {
    /// None where the decoder does not know it, or would stumble over it.
    fn read(bytes: &[u8]) -> Option<LazPacking> {
        let word = |at: usize| bytes.get(at..at + 2)?.try_into().ok().map(u16::from_le_bytes);
        let chunk_points = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?);
        let chunk_points = Some(chunk_points.into()).filter(|_| ![0, u32::MAX].contains(&chunk_points));
        let mut packing = LazPacking { method: word(0)?, chunk_points, record: 0, layers: 0 };
        let count = usize::from(word(32)?);
        for item in 0..count {
            let at = 34 + 6 * item;
            let (kind, size, version) = (word(at)?, word(at + 2)?, word(at + 4)?);
            let layers = match (kind, size) {
                (0, _) | (6, 20) | (7, 8) | (8, 6) | (9, 29) => None,
                (10, 30) => Some(9),
                (11, 6) | (13, 29) => Some(1),
                (12, 8) => Some(2),
                (14, size) => Some(size),
                _ => return None,
            };
            let is_known = match layers {
                None => [ALL_IN_ONE, CHUNKED].contains(&packing.method) && (1..=2).contains(&version),
                Some(_) => packing.method == LAYERED && (3..=4).contains(&version),
            };
            if !is_known {
                return None;
            }
            packing.record += u64::from(size);
            packing.layers += u64::from(layers.unwrap_or_default());
        }
        Some(packing).filter(|packing| packing.record > 0)
    }

    /// Holds the chunks that the decoder opens against what is there, from the first point to the file's end.
    fn hold_chunks(&self, file: &mut (impl Read + Seek), ends: [u64; 2], count: u64) -> Result<(), ModelFault> {
        let [start, length] = ends;
        let mut table_at = u64_at(file, start)?;
        if !is_beyond(table_at, start) {
            // one that could not go back to its beginning writes it at the end
            table_at = u64_at(file, length.saturating_sub(8))?;
        }
        if !is_beyond(table_at, start) {
            return Err(cut_off("the table of its chunks is missing"));
        }
        let [_, chunks] = halves(u64_at(file, table_at)?);
        // each begins with a whole point
        if chunks.saturating_mul(self.record) > length - start {
            return Err(damaged(&format!("it says that it has {chunks} chunks of points, and is too short for them")));
        }
        file.seek(SeekFrom::Start(table_at)).map_err(ModelFault::unreadable)?;
        let table = ChunkTable::read(file, self.chunk_points.is_none())
            .map_err(|_| cut_off("the table of its chunks is incomplete"))?;
        let counts = table.as_ref().iter().map(|chunk| self.chunk_points.unwrap_or(chunk.point_count));
        let mut at = start + 8;
        let mut left = count;
        for points in counts {
            if left == 0 {
                break;
            }
            if points == 0 {
                return Err(damaged("it has a chunk without points"));
            }
            if self.method == LAYERED {
                at = self.end_of_chunk(file, at)?;
                if at > length {
                    return Err(damaged("it has a chunk that is longer than the file"));
                }
            }
            left = left.saturating_sub(points);
        }
        if left > 0 { Err(cut_off(&format!("{left} of its {count} points are in none of its chunks"))) } else { Ok(()) }
    }

    /// Where a chunk of layers ends, as its beginning says.
    fn end_of_chunk(&self, file: &mut (impl Read + Seek), at: u64) -> Result<u64, ModelFault> {
        // behind the first point and the number of points
        let lengths_at = at + self.record + 4;
        let mut lengths = vec![0; 4 * self.layers as usize];
        let read = file.seek(SeekFrom::Start(lengths_at)).and_then(|_| file.read_exact(&mut lengths));
        read.map_err(|_| cut_off("a chunk of its points is missing"))?;
        let (lengths, _) = lengths.as_chunks::<4>();
        let all: u64 = lengths.iter().map(|length| u64::from(u32::from_le_bytes(*length))).sum();
        Ok(lengths_at + 4 * self.layers + all)
    }
}

/// Whether a place in the file, which is signed, lies behind another.
fn is_beyond(place: u64, start: u64) -> bool {
    i64::try_from(place).is_ok() && place > start
}

fn u64_at(file: &mut (impl Read + Seek), at: u64) -> Result<u64, ModelFault> {
    let mut bytes = [0; 8];
    let read = file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(&mut bytes));
    read.map_err(|_| cut_off("it names what lies beyond its end"))?;
    Ok(u64::from_le_bytes(bytes))
}

/// The first and the second of two numbers of 32 bits.
fn halves(both: u64) -> [u64; 2] {
    [both & u64::from(u32::MAX), both >> 32]
}

pub(super) fn cut_off(what: &str) -> ModelFault {
    message![format!("is cut off: {what}"); "copy or export it again"].into()
}

pub(super) fn damaged(what: &str) -> ModelFault {
    message![format!("is damaged: {what}"); "copy or export it again"].into()
}

/// What the library says of a file that it cannot read.
pub(super) fn unusable(error: las::Error) -> ModelFault {
    message![format!("cannot be read as LAS or LAZ ({error})"); "copy or export it again"].into()
}
