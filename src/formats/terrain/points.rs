//! Reads LAS and LAZ: measured points by class. Ground becomes terrain; buildings and vegetation are read on request.

use super::geokeys::MapKeys;
use super::las_records::{self, MapRecord};
use super::las_sizes::{self, unusable};
use super::map::TerrainMap;
use super::point_cells::{CellBlocks, PointCells};
use super::{NamedSheet, of_metres, thin};
use crate::formats::left_out::LeftOutTally;
use crate::formats::source::stem;
use crate::formats::{Format, LeftOut, Model, ModelFault, PartKind, ReadOptions};
use crate::message::{Message, message};
use glam::DVec3;
use las::{Header, PointData, Reader, Vlr};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Seek as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// LAS and LAZ, also COPC: `.las`, `.laz`.
pub struct LasPoints;

/// Bytes of points that are read in one go.
const AT_ONCE: u64 = 1 << 24;

/// The classes of ground, and of its key points (ASPRS LAS 1.4-R15, table 17).
const GROUND: [u8; 2] = [2, 8];
/// Where a point's flags are in its record.
const FLAGS_AT: usize = 15;
/// The classes of errors, low or high.
const NOISE: [u8; 2] = [7, 18];

/// The classes that can be requested, with their numbers.
const CLASSES: [(&str, &[u8]); POINT_CLASSES.len()] =
    [(POINT_CLASSES[0], &[6]), (POINT_CLASSES[1], &[3, 4, 5]), (POINT_CLASSES[2], &[17]), (POINT_CLASSES[3], &[9])];

/// The classes of points that can be read besides the ground.
pub const POINT_CLASSES: [&str; 4] = ["building", "vegetation", "bridge", "water"];

impl Format for LasPoints {
    fn name(&self) -> &'static str {
        "LAS or LAZ"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["las", "laz"]
    }

    fn keys(&self) -> &'static [&'static str] {
        &["terrain_error", "classes"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(b"LASF")
    }

    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        true
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        // others' code may still stumble over what is damaged
        catch_unwind(AssertUnwindSafe(|| model(path, options))).unwrap_or_else(|_| {
            Err(message!["makes the reader of LAS and LAZ fail: it is damaged"; "copy or export it again"].into())
        })
    }
}

/// Lets a part also be selected by its class alone, and by the file's name.
fn name_by_class(part: &mut super::Part, file: &str) {
    let class = part.name.rsplit('/').next().unwrap_or_default().to_owned();
    part.aliases.extend([class, file.to_owned()]);
}

/// The model of a file.
fn model(path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
    let mut file = BufReader::new(File::open(path).map_err(ModelFault::unreadable)?);
    las_sizes::hold(&mut file)?;
    let extended = las_records::extended(&mut file)?;
    file.rewind().map_err(ModelFault::unreadable)?;
    let mut reader = Reader::new(file).map_err(unusable)?;
    let keys = keys(reader.header(), &extended);
    let mut notes = Vec::new();
    let map = TerrainMap::of(keys.crs, keys.height_unit_m, keys.map_unit_m, &mut notes);
    let points = ClassedPoints::read(&mut reader, map.height_unit_m)?;
    let name = stem(path);
    notes.push(points.note());
    let (ground, is_classified) = points.ground()?;
    let cells = PointCells::of(&ground, is_classified)?;
    notes.extend(cells.notes(is_classified));
    let sheet = thin::sheet(&cells.grid, map.error_m(options) as f32);
    let mut sheets: Vec<NamedSheet> =
        vec![(format!("{name}/ground"), sheet.positions, sheet.triangles, PartKind::Terrain)];
    let mut left_out = Vec::new();
    for (class, numbers) in CLASSES {
        let of_class = points.of_classes(numbers);
        let is_asked = options.point_classes.iter().any(|asked| asked == class);
        if of_class.is_empty() {
            if is_asked {
                let what = format!("has no points of the class {class}, for which `classes` asks");
                notes.push(message![what; "classify its points, and export it again"]);
            }
            continue;
        }
        if !is_asked {
            // without classified ground, these points are what the ground is made of
            if !is_classified {
                continue;
            }
            let why = format!("`classes = [\"{class}\"]` under [[model]] in a site file lets this class stand there");
            left_out.push(LeftOut { what: format!("points of class {class}"), count: of_class.len() as u64, why });
            continue;
        }
        let (of_class, beyond) = cells.parted(of_class);
        if !beyond.is_empty() {
            let what = format!("points of class {class}");
            left_out.push(LeftOut { what, count: beyond.len() as u64, why: "beyond the ground points".to_owned() });
        }
        if !of_class.is_empty() {
            let CellBlocks { positions, triangles } = cells.blocks(&of_class);
            sheets.push((format!("{name}/{class}"), positions, triangles, PartKind::Building));
        }
    }
    let other = points.others();
    if is_classified && other > 0 {
        let why = "neither ground nor of a class that can be asked".to_owned();
        left_out.push(LeftOut { what: "points of other classes".into(), count: other, why });
    }
    let mut model = of_metres(sheets, map, notes);
    model.parts.iter_mut().for_each(|part| name_by_class(part, &name));
    left_out.extend(points.left_out.into_left_out());
    model.left_out = left_out;
    Ok(model)
}

/// Points by class, in the file's coordinates, heights in metres.
struct ClassedPoints {
    by_class: BTreeMap<u8, Vec<DVec3>>,
    /// The points that are of no class, whatever they say.
    left_out: LeftOutTally,
}

impl ClassedPoints {
    fn read(reader: &mut Reader, unit_m: f64) -> Result<ClassedPoints, ModelFault> {
        let count = reader.header().number_of_points();
        let (mut by_class, mut left_out) = (BTreeMap::<u8, Vec<DVec3>>::new(), LeftOutTally::default());
        let mut read = 0;
        // memory is taken as points come
        let at_once = AT_ONCE / u64::from(reader.header().point_format().len()).max(1);
        while read < count {
            let points: PointData = reader.read_points(at_once.min(count - read)).map_err(unusable)?;
            if points.is_empty() {
                let what = format!("is cut off: it has {read} of {count} points");
                return Err(message![what; "copy or export it again"].into());
            }
            read += points.len() as u64;
            let places = points.x().zip(points.y()).zip(points.z());
            for ((((x, y), z), class), is_withheld) in places.zip(points.classification()).zip(withheld(&points)) {
                let point = DVec3::new(x, y, z * unit_m);
                if is_withheld {
                    left_out.add("points", "marked as withheld, which means deleted");
                } else if NOISE.contains(&class) {
                    left_out.add("points of noise", "classified as errors of the measurement");
                } else if !point.is_finite() {
                    left_out.add("points", "their coordinates are not finite numbers");
                } else {
                    by_class.entry(class).or_default().push(point);
                }
            }
        }
        Ok(ClassedPoints { by_class, left_out })
    }

    fn note(&self) -> Message {
        let count: usize = self.by_class.values().map(Vec::len).sum();
        message![format!("has {count} points")]
    }

    fn of_classes(&self, classes: &[u8]) -> Vec<DVec3> {
        classes.iter().filter_map(|class| self.by_class.get(class)).flatten().copied().collect()
    }

    /// The ground points, and whether they are classified as such; otherwise all points.
    fn ground(&self) -> Result<(Vec<DVec3>, bool), ModelFault> {
        let ground = self.of_classes(&GROUND);
        if !ground.is_empty() {
            return Ok((ground, true));
        }
        let all: Vec<DVec3> = self.by_class.values().flatten().copied().collect();
        if all.is_empty() {
            return Err(message![
                "has no points except noise, deleted ones and those without finite coordinates"; "export it with the points of the ground, of class 2"
            ]
            .into());
        }
        Ok((all, false))
    }

    /// The number of points that are neither ground nor in a class that can be requested.
    fn others(&self) -> u64 {
        let is_asked = |class: &u8| GROUND.contains(class) || CLASSES.iter().any(|(_, of)| of.contains(class));
        self.by_class.iter().filter(|(class, _)| !is_asked(class)).map(|(_, points)| points.len() as u64).sum()
    }
}

/// Whether each of the points is deleted (ASPRS LAS 1.4-R15, tables 8 and 16): the flag stands beside the class up to
/// format 5, and among more flags from 6 on.
fn withheld(points: &PointData) -> impl Iterator<Item = bool> {
    let flag = if points.format().is_extended { 0x04 } else { 0x80 };
    let records = points.raw_bytes().chunks_exact(points.record_len().max(1));
    records.map(move |record| record.get(FLAGS_AT).is_some_and(|flags| flags & flag != 0))
}

/// The map of the points: from WKT if there is any, otherwise from GeoTIFF's keys, wherever their records stand.
fn keys(header: &Header, extended: &[MapRecord]) -> MapKeys {
    let record = |number: u16| -> Option<&[u8]> {
        let is_it = |record: &&Vlr| record.record_id == number && record.user_id == las_records::PROJECTION;
        let plain = header.vlrs().iter().find(is_it).map(|record| record.data.as_slice());
        plain.or_else(|| Some(extended.iter().find(|record| record.number == number)?.data.as_slice()))
    };
    let shorts = |bytes: &[u8]| bytes.as_chunks::<2>().0.iter().map(|pair| u16::from_le_bytes(*pair)).collect();
    let directory: Vec<u16> = record(las_records::KEYS).map(shorts).unwrap_or_default();
    let text = |number| record(number).map(|data| String::from_utf8_lossy(data).into_owned());
    let keys = MapKeys::of(&directory, &text(las_records::KEY_TEXTS).unwrap_or_default());
    let wkt =
        text(las_records::WKT).map(|wkt| wkt.trim_end_matches('\0').trim().to_owned()).filter(|wkt| !wkt.is_empty());
    match wkt {
        Some(wkt) => MapKeys { height_unit_m: vertical_unit_m(&wkt), crs: Some(wkt), ..keys },
        None => keys,
    }
}

/// The unit of the heights in metres, from the vertical part of a WKT.
fn vertical_unit_m(wkt: &str) -> Option<f64> {
    let vertical = ["VERT_CS[", "VERTCRS["].iter().find_map(|mark| wkt.find(mark).map(|at| &wkt[at..]))?;
    // UNIT["metre",1 or LENGTHUNIT["metre",1
    let unit = &vertical[vertical.find("UNIT[")?..];
    let number = unit.split(',').nth(1)?.trim_end_matches(']').trim();
    number.parse().ok().filter(|unit| (1e-3..1e4).contains(unit))
}
