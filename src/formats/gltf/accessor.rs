//! Makes readers of accessors. Every type, index and byte range is checked once, before the first number is read.

use super::Fault;
use super::buffers::Buffers;
use super::document::Document;
use super::draco::UnpackedElements;
use super::reader::{Reader, Sparse, StridedElements};
use gltf::json;
use gltf::json::validation::{Checked, USize64};

/// The most elements of an accessor without a view. Such elements take no bytes in the file, so only this limits them;
/// real ones are small.
const MAX_ZEROS: u64 = 1 << 20;

/// The most sparse entries in all accessors. Many tables may use the same bytes, and each is checked.
const MAX_SPARSE_ENTRIES: usize = 100_000_000;

/// The accessors of a file. Each is checked when it is first used.
pub(super) struct Accessors<'a, 'file> {
    document: &'a Document,
    buffers: &'a Buffers<'file>,
    known: Vec<Option<Reader<'a>>>,
    sparse_entries: usize,
}

/// The location of elements, as the file gives it.
struct ElementSpan {
    view: usize,
    offset: u64,
    count: u64,
    element_bytes: u64,
}

impl<'a, 'file> Accessors<'a, 'file> {
    pub(super) fn new(document: &'a Document, buffers: &'a Buffers<'file>) -> Self {
        Self { document, buffers, known: vec![None; document.accessors.len()], sparse_entries: 0 }
    }

    /// An accessor by its index; `user` says what needs it.
    pub(super) fn get(&mut self, index: usize, user: impl Fn() -> String) -> Result<Reader<'a>, Fault> {
        let count = self.known.len();
        let (Some(known), Some(accessor)) = (self.known.get_mut(index), self.document.accessors.get(index)) else {
            return Err(Fault::NoSuch { user: user(), what: "accessor", index, count });
        };
        if let Some(reader) = known {
            return Ok(*reader);
        }
        let reader = open(self.document, self.buffers, index, accessor)?;
        let entries = reader.sparse.map_or(0, |sparse| sparse.count);
        self.sparse_entries = self.sparse_entries.saturating_add(entries);
        if self.sparse_entries > MAX_SPARSE_ENTRIES {
            let problem = format!("is sparse, which makes more than {MAX_SPARSE_ENTRIES} entries");
            return Err(Fault::of_accessor(index, problem));
        }
        reader.check_sparse()?;
        *known = Some(reader);
        Ok(reader)
    }
}

fn open<'a>(
    document: &'a Document,
    buffers: &'a Buffers,
    index: usize,
    accessor: &'a json::Accessor,
) -> Result<Reader<'a>, Fault> {
    let (Checked::Valid(component), Checked::Valid(shape)) = (&accessor.component_type, &accessor.type_) else {
        return Err(Fault::of_accessor(index, "has a type that glTF does not know"));
    };
    let (component, shape) = (component.0, *shape);
    let element_bytes = (component.size() * shape.multiplicity()) as u64;
    let locate = |view: usize, offset: u64, count: u64, element_bytes: u64| {
        let span = ElementSpan { view, offset, count, element_bytes };
        strided(document, buffers, index, &span)
    };
    let USize64(count) = accessor.count;
    let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
    let unpacked = buffers.unpacked_elements(index);
    let base = match accessor.buffer_view {
        // the view of a compressed primitive's accessor is not read
        _ if let Some(UnpackedElements { bytes, .. }) = unpacked => {
            let stride = element_bytes as usize;
            if bytes.len() as u64 != count.saturating_mul(element_bytes) {
                return Err(Fault::of_accessor(index, "has different types in two primitives"));
            }
            Some(StridedElements { bytes, stride })
        }
        Some(view) => Some(locate(view.value(), offset, count, element_bytes)?),
        None if count > MAX_ZEROS => {
            return Err(Fault::of_accessor(index, format!("has {count} elements and no bytes to hold them")));
        }
        None => None,
    };
    let sparse = match &accessor.sparse {
        Some(table) => {
            let Checked::Valid(json::accessor::IndexComponentType(component)) = table.indices.component_type else {
                return Err(Fault::of_accessor(index, "has sparse indices of a type that glTF does not know"));
            };
            let (at, values, USize64(entries)) = (&table.indices, &table.values, table.count);
            let index_bytes = component.size() as u64;
            Some(Sparse {
                count: length(index, entries)?,
                component,
                indices: locate(at.buffer_view.value(), at.byte_offset.0, entries, index_bytes)?,
                values: locate(values.buffer_view.value(), values.byte_offset.0, entries, element_bytes)?,
            })
        }
        None => None,
    };
    Ok(Reader {
        accessor: index,
        count: length(index, count)?,
        component,
        shape,
        normalized: accessor.normalized,
        base,
        sparse,
        rounded: unpacked.and_then(|unpacked| unpacked.step),
    })
}

/// The bytes of a span, from its first element on. All of its elements must lie within the view and the buffer.
fn strided<'a>(
    document: &Document,
    buffers: &'a Buffers,
    accessor: usize,
    span: &ElementSpan,
) -> Result<StridedElements<'a>, Fault> {
    let index = span.view;
    let Some(view) = document.buffer_views.get(index) else {
        return Err(Fault::NoSuch {
            user: format!("accessor {accessor}"),
            what: "buffer view",
            index,
            count: document.buffer_views.len(),
        });
    };
    let buffer = view.buffer.value();
    let stride = view.byte_stride.map_or(span.element_bytes, |stride| stride.0 as u64);
    if stride < span.element_bytes {
        return Err(Fault::of_accessor(
            accessor,
            format!("has elements of {} bytes every {stride} bytes, so they overlap", span.element_bytes),
        ));
    }
    let Some(last) = span.count.checked_sub(1) else {
        return Ok(StridedElements { bytes: &[], stride: 0 });
    };
    let reach = stride.saturating_mul(last).saturating_add(span.element_bytes);
    let USize64(view_bytes) = view.byte_length;
    let end = span.offset.saturating_add(reach);
    let range = |start: u64, end: u64, holder: String, holds: u64| Fault::Range {
        what: format!("accessor {accessor}"),
        start,
        end,
        holder,
        holds,
    };
    if end > view_bytes {
        return Err(range(span.offset, end, format!("buffer view {index}"), view_bytes));
    }
    let (bytes, start) = match buffers.unpacked_view(index)? {
        Some(unpacked) => (unpacked, span.offset),
        None => {
            let bytes = buffers.get(buffer, &format!("buffer view {index}"))?;
            (bytes, view.byte_offset.map_or(0, |offset| offset.0).saturating_add(span.offset))
        }
    };
    let end = start.saturating_add(reach);
    let within = |start: u64, end: u64| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?);
    match (within(start, end), usize::try_from(stride)) {
        (Some(bytes), Ok(stride)) => Ok(StridedElements { bytes, stride }),
        _ => Err(range(start, end, format!("buffer {buffer}"), bytes.len() as u64)),
    }
}

/// A count that fits in memory.
fn length(accessor: usize, count: u64) -> Result<usize, Fault> {
    usize::try_from(count).map_err(|_| Fault::of_accessor(accessor, format!("has {count} elements")))
}
