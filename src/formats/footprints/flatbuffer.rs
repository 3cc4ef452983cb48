//! Reads tables of FlatBuffers, as far as FlatGeobuf needs them. Every offset is checked; data outside of the bytes
//! counts as absent.

/// A table in a buffer.
#[derive(Clone, Copy)]
pub(super) struct FlatTable<'a> {
    bytes: &'a [u8],
    at: usize,
    fields: usize,
    fields_bytes: usize,
}

/// `N` bytes at an offset.
pub(super) fn bytes_at<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..at.checked_add(N)?)?.try_into().ok()
}

fn u32_at(bytes: &[u8], at: usize) -> Option<usize> {
    bytes_at(bytes, at).map(|bytes| u32::from_le_bytes(bytes) as usize)
}

impl<'a> FlatTable<'a> {
    /// The root table of a buffer.
    pub(super) fn root(bytes: &'a [u8]) -> Option<Self> {
        Self::at(bytes, u32_at(bytes, 0)?)
    }

    fn at(bytes: &'a [u8], at: usize) -> Option<Self> {
        let back = i32::from_le_bytes(bytes_at(bytes, at)?);
        let fields = usize::try_from(i64::try_from(at).ok()? - i64::from(back)).ok()?;
        let fields_bytes = usize::from(u16::from_le_bytes(bytes_at(bytes, fields)?));
        Some(Self { bytes, at, fields, fields_bytes })
    }

    /// The offset of a field's value; `None` if the table does not have the field.
    fn field(&self, number: usize) -> Option<usize> {
        let entry = 4 + 2 * number;
        if entry + 2 > self.fields_bytes {
            return None;
        }
        let offset = u16::from_le_bytes(bytes_at(self.bytes, self.fields + entry)?);
        (offset > 0).then_some(self.at + usize::from(offset))
    }

    pub(super) fn u8(&self, number: usize) -> Option<u8> {
        bytes_at::<1>(self.bytes, self.field(number)?).map(|[byte]| byte)
    }

    pub(super) fn u16(&self, number: usize) -> Option<u16> {
        bytes_at(self.bytes, self.field(number)?).map(u16::from_le_bytes)
    }

    pub(super) fn i32(&self, number: usize) -> Option<i32> {
        bytes_at(self.bytes, self.field(number)?).map(i32::from_le_bytes)
    }

    pub(super) fn u64(&self, number: usize) -> Option<u64> {
        bytes_at(self.bytes, self.field(number)?).map(u64::from_le_bytes)
    }

    /// The bytes of a list with elements of a size, and the offset of the first.
    fn list(&self, number: usize, element: usize) -> Option<(usize, &'a [u8])> {
        let at = self.field(number)?;
        let at = at.checked_add(u32_at(self.bytes, at)?)?;
        let length = u32_at(self.bytes, at)?.checked_mul(element)?;
        let first = at.checked_add(4)?;
        Some((first, self.bytes.get(first..first.checked_add(length)?)?))
    }

    pub(super) fn bytes(&self, number: usize) -> Option<&'a [u8]> {
        self.list(number, 1).map(|(_, bytes)| bytes)
    }

    pub(super) fn text(&self, number: usize) -> Option<&'a str> {
        std::str::from_utf8(self.bytes(number)?).ok()
    }

    pub(super) fn u32s(&self, number: usize) -> Option<impl Iterator<Item = usize> + 'a> {
        let (_, bytes) = self.list(number, 4)?;
        Some(bytes.chunks_exact(4).filter_map(|bytes| u32_at(bytes, 0)))
    }

    pub(super) fn f64s(&self, number: usize) -> Option<impl Iterator<Item = f64> + 'a> {
        let (_, bytes) = self.list(number, 8)?;
        Some(bytes.chunks_exact(8).filter_map(|bytes| bytes_at(bytes, 0).map(f64::from_le_bytes)))
    }

    pub(super) fn table(&self, number: usize) -> Option<FlatTable<'a>> {
        let at = self.field(number)?;
        Self::at(self.bytes, at.checked_add(u32_at(self.bytes, at)?)?)
    }

    pub(super) fn tables(&self, number: usize) -> impl Iterator<Item = FlatTable<'a>> + 'a {
        let bytes = self.bytes;
        let (first, list) = self.list(number, 4).unwrap_or_default();
        let offsets = list.chunks_exact(4).enumerate();
        offsets.filter_map(move |(at, offset)| {
            let at = first + 4 * at;
            Self::at(bytes, at.checked_add(u32_at(offset, 0)?)?)
        })
    }
}
