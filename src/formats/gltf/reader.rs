//! The numbers of a checked accessor: strided, normalised, sparse, or zero.
//!
//! [`super::accessor`] has checked that all elements lie within their buffers. The reads here still use `get`, so that
//! a mistake there would give zeros and not a panic.

use super::Fault;
use glam::DVec3;
use gltf::json::accessor::{ComponentType, Type};
use std::ops::Range;

/// A checked accessor: `count` elements, all of which can be read.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a> {
    /// Its index in the file.
    pub accessor: usize,
    /// The number of elements.
    pub count: usize,
    /// The type of its components.
    pub component: ComponentType,
    /// The number of components of an element.
    pub shape: Type,
    /// Whether integers represent 0 to 1, or −1 to 1.
    pub normalized: bool,
    /// Where its elements are; `None` if all are zero.
    pub base: Option<StridedElements<'a>>,
    /// The elements that replace some of them.
    pub sparse: Option<Sparse<'a>>,
    /// The step between neighbouring values, if they were quantised before they were packed.
    pub rounded: Option<f64>,
}

/// Elements that lie `stride` bytes apart.
#[derive(Clone, Copy)]
pub(super) struct StridedElements<'a> {
    pub bytes: &'a [u8],
    pub stride: usize,
}

/// Elements that replace some of the base. They are looked up in the buffer, so that a table takes no memory.
#[derive(Clone, Copy)]
pub(super) struct Sparse<'a> {
    /// The number of entries.
    pub count: usize,
    /// The type of the indices: u8, u16 or u32.
    pub component: ComponentType,
    /// Strictly increasing.
    pub indices: StridedElements<'a>,
    pub values: StridedElements<'a>,
}

impl StridedElements<'_> {
    /// The first bytes of some elements.
    fn each<const N: usize>(&self, elements: Range<usize>) -> impl Iterator<Item = [u8; N]> {
        let from = elements.start.checked_mul(self.stride).and_then(|start| self.bytes.get(start..));
        let each = from.unwrap_or_default().chunks(self.stride.max(1)).take(elements.len());
        each.map(|element| element.first_chunk().copied().unwrap_or([0; N]))
    }

    /// `N` bytes of element `index`, from its `offset`.
    fn at<const N: usize>(&self, index: usize, offset: usize) -> Option<[u8; N]> {
        let start = index.checked_mul(self.stride)?.checked_add(offset)?;
        self.bytes.get(start..)?.first_chunk().copied()
    }

    /// An integer of element `index`.
    fn whole(&self, component: ComponentType, index: usize) -> Option<u32> {
        Some(match component {
            ComponentType::U8 => self.at::<1>(index, 0)?[0].into(),
            ComponentType::U16 => u16::from_le_bytes(self.at(index, 0)?).into(),
            _ => u32::from_le_bytes(self.at(index, 0)?),
        })
    }
}

impl Reader<'_> {
    /// An index, such as a vertex: element `index` of a scalar accessor of u8, u16 or u32.
    pub(super) fn whole(&self, index: usize) -> u32 {
        let (source, index) = self.source(index);
        source.and_then(|source| source.whole(self.component, index)).unwrap_or(0)
    }

    /// As [`Self::whole`], for several elements.
    pub(super) fn wholes(&self, elements: Range<usize>) -> Vec<u32> {
        // the type is matched once, and not for every element
        match (self.base, self.component) {
            (Some(base), ComponentType::U32) if self.sparse.is_none() => {
                base.each(elements).map(u32::from_le_bytes).collect()
            }
            (Some(base), ComponentType::U16) if self.sparse.is_none() => {
                base.each(elements).map(|bytes| u16::from_le_bytes(bytes).into()).collect()
            }
            _ => elements.map(|index| self.whole(index)).collect(),
        }
    }

    /// The first three components of element `index`.
    pub(super) fn vec3(&self, index: usize) -> DVec3 {
        let [x, y, z] = self.numbers(index);
        DVec3::new(x, y, z)
    }

    /// The first `N` components of element `index`, normalised if the accessor says so.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> [f64; N] {
        let (source, index) = self.source(index);
        std::array::from_fn(|lane| source.and_then(|source| self.number(&source, index, lane)).unwrap_or(0.0))
    }

    /// Where element `index` is, and at which index there; `None` if it is zero.
    fn source(&self, index: usize) -> (Option<StridedElements<'_>>, usize) {
        match self.sparse.and_then(|sparse| Some((sparse, sparse.find(index)?))) {
            Some((sparse, entry)) => (Some(sparse.values), entry),
            None => (self.base, index),
        }
    }

    fn number(&self, source: &StridedElements, index: usize, lane: usize) -> Option<f64> {
        let offset = lane * self.component.size();
        let (value, most) = match self.component {
            ComponentType::I8 => (i8::from_le_bytes(source.at(index, offset)?).into(), f64::from(i8::MAX)),
            ComponentType::U8 => (source.at::<1>(index, offset)?[0].into(), f64::from(u8::MAX)),
            ComponentType::I16 => (i16::from_le_bytes(source.at(index, offset)?).into(), f64::from(i16::MAX)),
            ComponentType::U16 => (u16::from_le_bytes(source.at(index, offset)?).into(), f64::from(u16::MAX)),
            ComponentType::U32 => (u32::from_le_bytes(source.at(index, offset)?).into(), f64::from(u32::MAX)),
            ComponentType::F32 => {
                return Some(f32::from_le_bytes(source.at(index, offset)?).into());
            }
        };
        // the least value of a signed type is one step below −1
        Some(if self.normalized { f64::max(value / most, -1.0) } else { value })
    }

    /// Checks that sparse indices increase and are in range, so that they can be looked up.
    pub(super) fn check_sparse(&self) -> Result<(), Fault> {
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
                return Err(Fault::of_accessor(self.accessor, problem));
            }
            next = index + 1;
        }
        Ok(())
    }
}

impl Sparse<'_> {
    fn index(&self, entry: usize) -> usize {
        self.indices.whole(self.component, entry).map_or(usize::MAX, |index| index as usize)
    }

    /// The sparse entry for element `index`.
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
