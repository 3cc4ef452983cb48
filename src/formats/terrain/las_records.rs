//! Reads the extended records of a LAS or LAZ file that say its map; the decoder reads the first extended record only.
//!
//! Each has a head of 60 bytes: 2 reserved ones, its user, its number, its length, and a description (ASPRS LAS 1.4-R15,
//! table 25).

use super::las_sizes::{cut_off, damaged, unusable};
use crate::formats::ModelFault;
use std::io::{ErrorKind, Read, Seek, SeekFrom};

/// The user of the records that say the map.
pub(super) const PROJECTION: &str = "LASF_Projection";
/// The numbers of those: WKT, GeoTIFF's keys, and their texts.
pub(super) const WKT: u16 = 2112;
pub(super) const KEYS: u16 = 34735;
pub(super) const KEY_TEXTS: u16 = 34737;

const HEAD: u64 = 60;
/// The most heads that are read; files have a handful.
const MOST_RECORDS: u32 = 10_000;
/// The longest record on the map, bytes. WKT has a few thousand.
const LONGEST: u64 = 1 << 20;

/// A record that says the map.
pub(super) struct MapRecord {
    pub number: u16,
    pub data: Vec<u8>,
}

/// The extended records that say the map, the first of each number.
pub(super) fn extended(file: &mut (impl Read + Seek)) -> Result<Vec<MapRecord>, ModelFault> {
    file.rewind().map_err(ModelFault::unreadable)?;
    let Some(said) = las::raw::Header::read_from(&mut *file).map_err(unusable)?.evlr else { return Ok(Vec::new()) };
    if said.number_of_evlrs > MOST_RECORDS {
        return Err(damaged(&format!("it says that it has {} extended records", said.number_of_evlrs)));
    }
    let mut records: Vec<MapRecord> = Vec::new();
    let mut at = said.start_of_first_evlr;
    for _ in 0..said.number_of_evlrs {
        let mut head = [0; HEAD as usize];
        read_at(file, at, &mut head)?;
        let number = u16::from_le_bytes([head[18], head[19]]);
        let mut length = [0; 8];
        length.copy_from_slice(&head[20..28]);
        let length = u64::from_le_bytes(length);
        let is_of_map =
            head[2..18].strip_prefix(PROJECTION.as_bytes()).is_some_and(|rest| rest.iter().all(|b| *b == 0));
        let is_new = records.iter().all(|record| record.number != number);
        if is_of_map && is_new && [WKT, KEYS, KEY_TEXTS].contains(&number) {
            if length > LONGEST {
                return Err(damaged(&format!("it says its map in {length} bytes")));
            }
            let mut data = vec![0; length as usize];
            read_at(file, at.saturating_add(HEAD), &mut data)?;
            records.push(MapRecord { number, data });
        }
        at = at.saturating_add(HEAD).saturating_add(length);
    }
    Ok(records)
}

fn read_at(file: &mut (impl Read + Seek), at: u64, bytes: &mut [u8]) -> Result<(), ModelFault> {
    let read = file.seek(SeekFrom::Start(at)).and_then(|_| file.read_exact(bytes));
    read.map_err(|error| match error.kind() {
        // a place beyond what a file can have is refused as input
        ErrorKind::UnexpectedEof | ErrorKind::InvalidInput => cut_off("its extended records end beyond its end"),
        _ => ModelFault::unreadable(error),
    })
}
