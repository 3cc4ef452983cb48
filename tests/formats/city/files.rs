//! Minimal writers of shapefiles, FlatGeobuf and 3D Tiles.

/// A ring of plan, closed, clockwise as shapefiles have outlines.
pub(super) type Ring = Vec<[f64; 2]>;

/// A shapefile of polygons, each of some rings.
pub(super) fn shapefile(kind: u32, shapes: &[Vec<Ring>], z: f64) -> Vec<u8> {
    let records = shapes.iter().map(|rings| {
        let points: Vec<[f64; 2]> = rings.concat();
        let mut record = Vec::new();
        record.extend(kind.to_le_bytes());
        record.extend([0; 32]);
        record.extend((rings.len() as u32).to_le_bytes());
        record.extend((points.len() as u32).to_le_bytes());
        let mut first = 0_u32;
        for ring in rings {
            record.extend(first.to_le_bytes());
            first += ring.len() as u32;
        }
        points.as_flattened().iter().for_each(|number| record.extend(number.to_le_bytes()));
        if kind == 15 {
            record.extend([0; 16]);
            points.iter().for_each(|_| record.extend(z.to_le_bytes()));
        }
        record
    });
    shapefile_of(kind, records.collect())
}

pub(super) fn shapefile_of(kind: u32, records: Vec<Vec<u8>>) -> Vec<u8> {
    let mut file = Vec::new();
    file.extend(9994_u32.to_be_bytes());
    file.extend([0; 20]);
    let bytes = 100 + records.iter().map(|record| 8 + record.len()).sum::<usize>();
    file.extend((bytes as u32 / 2).to_be_bytes());
    file.extend(1000_u32.to_le_bytes());
    file.extend(kind.to_le_bytes());
    file.extend([0; 64]);
    for (at, record) in records.iter().enumerate() {
        file.extend((at as u32 + 1).to_be_bytes());
        file.extend((record.len() as u32 / 2).to_be_bytes());
        file.extend(record);
    }
    file
}

/// A table of dBASE with text columns of 20 letters.
pub(super) fn dbase(columns: &[&str], rows: &[&[&str]]) -> Vec<u8> {
    let mut file = vec![3, 126, 1, 1];
    file.extend((rows.len() as u32).to_le_bytes());
    file.extend((32 * (columns.len() as u16 + 1) + 1).to_le_bytes());
    file.extend((20 * columns.len() as u16 + 1).to_le_bytes());
    file.extend([0; 20]);
    for column in columns {
        let mut description = [0; 32];
        description[..column.len()].copy_from_slice(column.as_bytes());
        description[11] = b'C';
        description[16] = 20;
        file.extend(description);
    }
    file.push(b'\r');
    for row in rows {
        file.push(b' ');
        for value in *row {
            let mut cell = value.as_bytes().to_vec();
            cell.resize(20, b' ');
            file.extend(cell);
        }
    }
    file
}

/// A field of a FlatBuffers table.
pub(super) enum Field {
    None,
    Inline(Vec<u8>),
    /// A list of numbers or letters: how many, and their bytes.
    List(u32, Vec<u8>),
    Table(Vec<Field>),
    Tables(Vec<Vec<Field>>),
}

pub(super) fn text(text: &str) -> Field {
    Field::List(text.len() as u32, text.as_bytes().to_vec())
}

pub(super) fn f64s(numbers: &[f64]) -> Field {
    Field::List(numbers.len() as u32, numbers.iter().flat_map(|number| number.to_le_bytes()).collect())
}

pub(super) fn u32s(numbers: &[u32]) -> Field {
    Field::List(numbers.len() as u32, numbers.iter().flat_map(|number| number.to_le_bytes()).collect())
}

/// A buffer with its length before it.
pub(super) fn flatbuffer(root: &[Field]) -> Vec<u8> {
    let mut buffer = vec![4, 0, 0, 0];
    add_table(root, &mut buffer);
    // the table lies behind its list of offsets
    let table = 4 + 4 + 2 * root.len();
    buffer[..4].copy_from_slice(&(table as u32).to_le_bytes());
    let mut sized = (buffer.len() as u32).to_le_bytes().to_vec();
    sized.extend(buffer);
    sized
}

/// Adds a table behind its list of offsets, and gives where it is. What it refers to follows.
fn add_table(fields: &[Field], buffer: &mut Vec<u8>) -> usize {
    let offsets = buffer.len();
    let table = offsets + 4 + 2 * fields.len();
    buffer.extend((4 + 2 * fields.len() as u16).to_le_bytes());
    buffer.extend(0_u16.to_le_bytes());
    buffer.resize(table, 0);
    buffer.extend(((table - offsets) as i32).to_le_bytes());
    let mut references = Vec::new();
    for (number, field) in fields.iter().enumerate() {
        let at = buffer.len();
        let offset = match field {
            Field::None => 0,
            Field::Inline(bytes) => {
                buffer.extend(bytes);
                at - table
            }
            _ => {
                buffer.extend([0; 4]);
                references.push((at, field));
                at - table
            }
        };
        buffer[offsets + 4 + 2 * number..][..2].copy_from_slice(&(offset as u16).to_le_bytes());
    }
    for (at, field) in references {
        let to = match field {
            Field::Table(fields) => add_table(fields, buffer),
            Field::List(count, bytes) => {
                let to = buffer.len();
                buffer.extend(count.to_le_bytes());
                buffer.extend(bytes);
                to
            }
            Field::Tables(tables) => {
                let to = buffer.len();
                buffer.extend((tables.len() as u32).to_le_bytes());
                let first = buffer.len();
                buffer.resize(first + 4 * tables.len(), 0);
                for (number, fields) in tables.iter().enumerate() {
                    let slot = first + 4 * number;
                    let table = add_table(fields, buffer);
                    buffer[slot..slot + 4].copy_from_slice(&((table - slot) as u32).to_le_bytes());
                }
                to
            }
            Field::None | Field::Inline(_) => unreachable!("they are in the table"),
        };
        buffer[at..at + 4].copy_from_slice(&((to - at) as u32).to_le_bytes());
    }
    table
}

/// A `.glb` of one mesh without indices, with y up, under a node.
pub(super) fn glb(triangles: &[[f32; 3]], extension: &str) -> Vec<u8> {
    let mut binary: Vec<u8> = triangles.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let bound = |pick: fn(f32, f32) -> f32| {
        [0, 1, 2].map(|axis| triangles.iter().map(|corner| corner[axis]).reduce(pick).unwrap_or(0.0))
    };
    let mut json = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"name\":\"tower\",\"mesh\":0}}],\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}}}}]}}],\"accessors\":[{{\"bufferView\":0,\
         \"componentType\":5126,\"count\":{},\"type\":\"VEC3\",\"min\":{:?},\"max\":{:?}}}],\"bufferViews\":[{{\"buffer\":0,\
         \"byteLength\":{}}}],\"buffers\":[{{\"byteLength\":{}}}]{extension}}}",
        triangles.len(),
        bound(f32::min),
        bound(f32::max),
        binary.len(),
        binary.len()
    );
    json.push_str(&" ".repeat(json.len().next_multiple_of(4) - json.len()));
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json.as_bytes()), (b"BIN\0", binary.as_slice())] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}

/// A batched model around a glTF, with a table of features.
pub(super) fn b3dm(gltf: &[u8], table: &str) -> Vec<u8> {
    let mut file = b"b3dm".to_vec();
    let length = 28 + table.len() + gltf.len();
    for number in [1, length, table.len(), 0, 0, 0] {
        file.extend((number as u32).to_le_bytes());
    }
    file.extend(table.as_bytes());
    file.extend(gltf);
    file
}
