//! Accessors → numbers: strided, normalised, sparse, or without a view. Ranges are checked once, before the first read.

use super::Fault;
use super::buffers::Buffers;
use super::document::Document;
use glam::DVec3;
use gltf::json;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::validation::{Checked, USize64};

/// The most elements an accessor may have without a view. Such elements cost the file nothing, so nothing but this
/// bounds them; real ones are small.
const MAX_ZEROS: u64 = 1 << 20;

/// The accessors of a file; each is checked when it is first asked for.
pub(super) struct Accessors<'a, 'file> {
    document: &'a Document,
    buffers: &'a Buffers<'file>,
    known: Vec<Option<Reader<'a>>>,
}

/// A checked accessor: `count` elements, all of which can be read.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a> {
    /// Its number in the file.
    pub accessor: usize,
    /// Elements.
    pub count: usize,
    pub component: ComponentType,
    pub shape: Type,
    /// Whether whole numbers stand for 0 to 1, or −1 to 1.
    pub normalized: bool,
    /// Whether its elements lie in a view, and not only in a sparse table or nowhere.
    pub has_view: bool,
    base: Option<Strided<'a>>,
    sparse: Option<Sparse<'a>>,
}

/// Elements that lie `stride` bytes apart.
#[derive(Clone, Copy)]
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

/// Elements that stand for those of the base. Looked up where they lie, so that a table costs no memory.
#[derive(Clone, Copy)]
struct Sparse<'a> {
    count: usize,
    component: ComponentType,
    /// Strictly increasing.
    indices: Strided<'a>,
    values: Strided<'a>,
}

/// Where elements lie, as the file says it.
struct Span {
    view: usize,
    offset: u64,
    count: u64,
    element_bytes: u64,
}

impl<'a, 'file> Accessors<'a, 'file> {
    pub(super) fn new(document: &'a Document, buffers: &'a Buffers<'file>) -> Self {
        Self {
            document,
            buffers,
            known: vec![None; document.accessors.len()],
        }
    }

    /// An accessor by its number; `user` says who asks.
    pub(super) fn get(
        &mut self,
        index: usize,
        user: impl Fn() -> String,
    ) -> Result<Reader<'a>, Fault> {
        let count = self.known.len();
        let (Some(known), Some(accessor)) = (
            self.known.get_mut(index),
            self.document.accessors.get(index),
        ) else {
            return Err(Fault::NoSuch {
                user: user(),
                what: "accessor",
                index,
                count,
            });
        };
        if let Some(reader) = known {
            return Ok(*reader);
        }
        let reader = open(self.document, self.buffers, index, accessor)?;
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
    let (Checked::Valid(component), Checked::Valid(shape)) =
        (&accessor.component_type, &accessor.type_)
    else {
        return Err(fault(index, "has a type that glTF does not know"));
    };
    let (component, shape) = (component.0, *shape);
    let element_bytes = (component.size() * shape.multiplicity()) as u64;
    let locate = |view: usize, offset: u64, count: u64, element_bytes: u64| {
        let span = Span {
            view,
            offset,
            count,
            element_bytes,
        };
        strided(document, buffers, index, &span)
    };
    let USize64(count) = accessor.count;
    let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
    let base = match accessor.buffer_view {
        Some(view) => Some(locate(view.value(), offset, count, element_bytes)?),
        None if count > MAX_ZEROS => {
            return Err(fault(
                index,
                format!("has {count} elements and no bytes to hold them"),
            ));
        }
        None => None,
    };
    let sparse = match &accessor.sparse {
        Some(table) => {
            let Checked::Valid(json::accessor::IndexComponentType(component)) =
                table.indices.component_type
            else {
                return Err(fault(
                    index,
                    "has sparse indices of a type that glTF does not know",
                ));
            };
            let (at, values, USize64(entries)) = (&table.indices, &table.values, table.count);
            let index_bytes = component.size() as u64;
            Some(Sparse {
                count: length(index, entries)?,
                component,
                indices: locate(
                    at.buffer_view.value(),
                    at.byte_offset.0,
                    entries,
                    index_bytes,
                )?,
                values: locate(
                    values.buffer_view.value(),
                    values.byte_offset.0,
                    entries,
                    element_bytes,
                )?,
            })
        }
        None => None,
    };
    let reader = Reader {
        accessor: index,
        count: length(index, count)?,
        component,
        shape,
        normalized: accessor.normalized,
        has_view: base.is_some(),
        base,
        sparse,
    };
    reader.check_sparse()?;
    Ok(reader)
}

/// The bytes of a span, from its first element on; all of its elements lie within the view and the buffer.
fn strided<'a>(
    document: &Document,
    buffers: &'a Buffers,
    accessor: usize,
    span: &Span,
) -> Result<Strided<'a>, Fault> {
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
    if let Some(extension) = compression(view)
        && buffers.is_placeholder(buffer)
    {
        return Err(Fault::Compressed {
            what: format!("buffer view {index} is"),
            extension: extension.into(),
        });
    }
    let stride = view
        .byte_stride
        .map_or(span.element_bytes, |stride| stride.0 as u64);
    if stride < span.element_bytes {
        return Err(fault(
            accessor,
            format!(
                "has elements of {} bytes every {stride} bytes, so they overlap",
                span.element_bytes
            ),
        ));
    }
    let Some(last) = span.count.checked_sub(1) else {
        return Ok(Strided {
            bytes: &[],
            stride: 0,
        });
    };
    let reach = stride
        .saturating_mul(last)
        .saturating_add(span.element_bytes);
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
        return Err(range(
            span.offset,
            end,
            format!("buffer view {index}"),
            view_bytes,
        ));
    }
    let bytes = buffers.get(buffer, &format!("buffer view {index}"))?;
    let start = view
        .byte_offset
        .map_or(0, |offset| offset.0)
        .saturating_add(span.offset);
    let end = start.saturating_add(reach);
    let within =
        |start: u64, end: u64| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?);
    match (within(start, end), usize::try_from(stride)) {
        (Some(bytes), Ok(stride)) => Ok(Strided { bytes, stride }),
        _ => Err(range(
            start,
            end,
            format!("buffer {buffer}"),
            bytes.len() as u64,
        )),
    }
}

/// The extension that compresses a view, where one does.
fn compression(view: &json::buffer::View) -> Option<&str> {
    let mut names = view.extensions.as_ref()?.others.keys();
    names
        .find(|name| name.ends_with("_meshopt_compression"))
        .map(String::as_str)
}

impl Strided<'_> {
    /// `bytes` of element `index`, from its `offset`.
    fn at<const N: usize>(&self, index: usize, offset: usize) -> Option<[u8; N]> {
        let start = index.checked_mul(self.stride)?.checked_add(offset)?;
        self.bytes.get(start..)?.first_chunk().copied()
    }

    /// A whole number of element `index`.
    fn whole(&self, component: ComponentType, index: usize) -> Option<u32> {
        Some(match component {
            ComponentType::U8 => self.at::<1>(index, 0)?[0].into(),
            ComponentType::U16 => u16::from_le_bytes(self.at(index, 0)?).into(),
            _ => u32::from_le_bytes(self.at(index, 0)?),
        })
    }
}

impl Reader<'_> {
    /// A vertex number or the like: element `index` of a scalar accessor of u8, u16 or u32.
    pub(super) fn whole(&self, index: usize) -> u32 {
        let (source, index) = self.source(index);
        source
            .and_then(|source| source.whole(self.component, index))
            .unwrap_or(0)
    }

    /// The first three numbers of element `index`.
    pub(super) fn vec3(&self, index: usize) -> DVec3 {
        let [x, y, z] = self.numbers(index);
        DVec3::new(x, y, z)
    }

    /// The first `N` numbers of element `index`, normalised where the accessor says so.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> [f64; N] {
        let (source, index) = self.source(index);
        std::array::from_fn(|lane| {
            source
                .and_then(|source| self.number(&source, index, lane))
                .unwrap_or(0.0)
        })
    }

    /// Where element `index` lies, and as which; nowhere where it is zero.
    fn source(&self, index: usize) -> (Option<Strided<'_>>, usize) {
        match self
            .sparse
            .and_then(|sparse| Some((sparse, sparse.find(index)?)))
        {
            Some((sparse, entry)) => (Some(sparse.values), entry),
            None => (self.base, index),
        }
    }

    fn number(&self, source: &Strided, index: usize, lane: usize) -> Option<f64> {
        let offset = lane * self.component.size();
        let (value, most) = match self.component {
            ComponentType::I8 => (
                i8::from_le_bytes(source.at(index, offset)?).into(),
                f64::from(i8::MAX),
            ),
            ComponentType::U8 => (source.at::<1>(index, offset)?[0].into(), f64::from(u8::MAX)),
            ComponentType::I16 => (
                i16::from_le_bytes(source.at(index, offset)?).into(),
                f64::from(i16::MAX),
            ),
            ComponentType::U16 => (
                u16::from_le_bytes(source.at(index, offset)?).into(),
                f64::from(u16::MAX),
            ),
            ComponentType::U32 => (
                u32::from_le_bytes(source.at(index, offset)?).into(),
                f64::from(u32::MAX),
            ),
            ComponentType::F32 => {
                return Some(f32::from_le_bytes(source.at(index, offset)?).into());
            }
        };
        // The least number of a signed type is one step below −1.
        Some(if self.normalized {
            f64::max(value / most, -1.0)
        } else {
            value
        })
    }

    /// Sparse indices must increase, or they could not be looked up.
    fn check_sparse(&self) -> Result<(), Fault> {
        let Some(sparse) = self.sparse else {
            return Ok(());
        };
        let mut next = 0;
        for entry in 0..sparse.count {
            let index = sparse.index(entry);
            if index < next || index >= self.count {
                let problem = format!(
                    "has the sparse index {index} at {entry}, out of order or beyond its {} elements",
                    self.count
                );
                return Err(fault(self.accessor, problem));
            }
            next = index + 1;
        }
        Ok(())
    }
}

impl Sparse<'_> {
    fn index(&self, entry: usize) -> usize {
        self.indices
            .whole(self.component, entry)
            .map_or(usize::MAX, |index| index as usize)
    }

    /// The entry that stands for element `index`.
    fn find(&self, index: usize) -> Option<usize> {
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            match self.index(middle).cmp(&index) {
                std::cmp::Ordering::Equal => return Some(middle),
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Greater => high = middle,
            }
        }
        None
    }
}

/// A count that memory could hold.
fn length(accessor: usize, count: u64) -> Result<usize, Fault> {
    usize::try_from(count).map_err(|_| fault(accessor, format!("has {count} elements")))
}

pub(super) fn fault(accessor: usize, problem: impl Into<String>) -> Fault {
    Fault::Accessor {
        accessor,
        problem: problem.into(),
    }
}
