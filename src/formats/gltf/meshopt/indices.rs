//! Modes 1 and 2: triangles, and other sequences of indices.

/// A queue of the 16 newest entries, newest first.
struct Newest<T> {
    entries: [Option<T>; 16],
    next: usize,
}

impl<T: Copy> Newest<T> {
    fn new() -> Self {
        Self { entries: [None; 16], next: 0 }
    }

    fn push(&mut self, entry: T) {
        if let Some(into) = self.entries.get_mut(self.next % 16) {
            *into = Some(entry);
        }
        self.next = (self.next + 1) % 16;
    }

    fn get(&self, age: usize) -> Option<T> {
        *self.entries.get((self.next + 15 - age % 16) % 16)?
    }
}

/// The state of the decoder of triangles.
struct TriangleDecoder<'a> {
    data: &'a [u8],
    next: u32,
    last: u32,
    edges: Newest<[u32; 2]>,
    vertices: Newest<u32>,
}

/// Decodes `count` indices of `stride` bytes; `None` if the bytes are not a complete stream of them.
pub(super) fn triangles(source: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let (&header, body) = source.split_first()?;
    // the low bits are a version; EXT_meshopt_compression has versions 0 and 1
    if !matches!(header, 0xE0 | 0xE1) || !count.is_multiple_of(3) {
        return None;
    }
    let (body, table) = body.split_last_chunk::<16>()?;
    let (codes, data) = body.split_at_checked(count / 3)?;
    let mut decoder = TriangleDecoder { data, next: 0, last: 0, edges: Newest::new(), vertices: Newest::new() };
    let mut decoded = Vec::with_capacity(codes.len() * 3 * 4);
    for &code in codes {
        for vertex in decoder.triangle(code, table, header == 0xE1)? {
            put(&mut decoded, vertex, stride)?;
        }
    }
    decoder.data.is_empty().then_some(decoded)
}

impl TriangleDecoder<'_> {
    fn triangle(&mut self, code: u8, table: &[u8; 16], is_second: bool) -> Option<[u32; 3]> {
        match (code >> 4, code & 15) {
            (15, low @ 0..=13) => {
                let pair = *table.get(usize::from(low))?;
                let a = self.fresh();
                self.whole(a, pair, false)
            }
            (15, low) => {
                let (&pair, rest) = self.data.split_first()?;
                self.data = rest;
                if pair == 0 {
                    self.next = 0;
                }
                let a = if low == 14 { self.fresh() } else { self.explicit()? };
                self.whole(a, pair, true)
            }
            (edge, low) => {
                let [a, b] = self.edges.get(edge.into())?;
                let (c, is_new) = match low {
                    0 => (self.fresh(), true),
                    13 | 14 if is_second => {
                        self.last = if low == 13 { self.last.wrapping_sub(1) } else { self.last.wrapping_add(1) };
                        (self.last, true)
                    }
                    15 => (self.explicit()?, true),
                    _ => (self.vertices.get(low.into())?, false),
                };
                if is_new {
                    self.vertices.push(c);
                }
                self.edges.push([c, b]);
                self.edges.push([a, c]);
                Some([a, b, c])
            }
        }
    }

    /// A triangle whose second and third vertex are encoded in the halves of a byte.
    fn whole(&mut self, a: u32, pair: u8, may_be_explicit: bool) -> Option<[u32; 3]> {
        let (b, b_is_new) = self.named(pair >> 4, may_be_explicit)?;
        let (c, c_is_new) = self.named(pair & 15, may_be_explicit)?;
        self.vertices.push(a);
        if b_is_new {
            self.vertices.push(b);
        }
        if c_is_new {
            self.vertices.push(c);
        }
        self.edges.push([b, a]);
        self.edges.push([c, b]);
        self.edges.push([a, c]);
        Some([a, b, c])
    }

    fn named(&mut self, half: u8, may_be_explicit: bool) -> Option<(u32, bool)> {
        Some(match half {
            0 => (self.fresh(), true),
            15 if may_be_explicit => (self.explicit()?, true),
            15 => return None,
            _ => (self.vertices.get(usize::from(half) - 1)?, false),
        })
    }

    fn fresh(&mut self) -> u32 {
        let vertex = self.next;
        self.next = self.next.wrapping_add(1);
        vertex
    }

    fn explicit(&mut self) -> Option<u32> {
        let code = varint(&mut self.data)?;
        self.last = self.last.wrapping_add((code >> 1) ^ (code & 1).wrapping_neg());
        Some(self.last)
    }
}

/// Decodes `count` indices of `stride` bytes; `None` if the bytes are not a complete stream of them.
pub(super) fn sequence(source: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    let (&header, body) = source.split_first()?;
    if !matches!(header, 0xD0 | 0xD1) {
        return None;
    }
    let (mut data, _) = body.split_last_chunk::<4>()?;
    let (mut last, mut decoded) = ([0_u32; 2], Vec::new());
    for _ in 0..count {
        let code = varint(&mut data)?;
        let last = last.get_mut(code as usize & 1)?;
        let delta = code >> 1;
        *last = last.wrapping_add((delta >> 1) ^ (delta & 1).wrapping_neg());
        put(&mut decoded, *last, stride)?;
    }
    data.is_empty().then_some(decoded)
}

fn put(decoded: &mut Vec<u8>, vertex: u32, stride: usize) -> Option<()> {
    match stride {
        2 => decoded.extend((vertex as u16).to_le_bytes()),
        4 => decoded.extend(vertex.to_le_bytes()),
        _ => return None,
    }
    Some(())
}

/// An integer of one to five bytes, low bits first.
fn varint(data: &mut &[u8]) -> Option<u32> {
    let mut number = 0;
    for shift in [0, 7, 14, 21, 28] {
        let (&byte, rest) = data.split_first()?;
        *data = rest;
        number |= u32::from(byte & 127) << shift;
        if byte < 128 {
            return Some(number);
        }
    }
    None
}
