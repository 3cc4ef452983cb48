//! The numbers of a checked accessor: strided, normalised, sparse, or zero.
//!
//! [`super::accessor`] has checked that all elements lie within their buffers. The reads here still go through `get`,
//! so that a mistake there would give zeros and not a crash.

use super::Fault;
use glam::DVec3;
use gltf::json::accessor::{ComponentType, Type};
use std::ops::Range;

/// A checked accessor: `count` elements, all of which can be read.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a> {
    /// Its number in the file.
    pub accessor: usize,
    /// The number of elements.
    pub count: usize,
    /// The type of its numbers.
    pub component: ComponentType,
    /// The number of components of an element.
    pub shape: Type,
    /// Whether integers represent 0 to 1, or −1 to 1.
    pub normalized: bool,
    /// Where its elements lie; `None` if they are zero.
    pub base: Option<StridedElements<'a>>,
    /// The elements that replace some of them.
    pub sparse: Option<Sparse<'a>>,
    /// The step from one number to the next, if they were rounded to steps before they were packed.
    pub rounded: Option<f64>,
}

/// Elements that lie `stride` bytes apart.
#[derive(Clone, Copy)]
pub(super) struct StridedElements<'a> {
    pub bytes: &'a [u8],
    pub stride: usize,
}

/// Elements that stand for those of the base. Looked up where they lie, so that a table costs no memory.
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
        source.and_then(|source| source.whole(self.component, index)).unwrap_or(0)
    }

    /// As [`Self::whole`], of some elements.
    pub(super) fn wholes(&self, elements: Range<usize>) -> Vec<u32> {
        // asked once what they are, and not for every number
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

    /// The first three numbers of element `index`.
    pub(super) fn vec3(&self, index: usize) -> DVec3 {
        let [x, y, z] = self.numbers(index);
        DVec3::new(x, y, z)
    }

    /// The first `N` numbers of element `index`, normalised where the accessor says so.
    pub(super) fn numbers<const N: usize>(&self, index: usize) -> [f64; N] {
        let (source, index) = self.source(index);
        std::array::from_fn(|lane| source.and_then(|source| self.number(&source, index, lane)).unwrap_or(0.0))
    }

    /// Where element `index` lies, and as which; nowhere where it is zero.
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
        // The least number of a signed type is one step below −1.
        Some(if self.normalized { f64::max(value / most, -1.0) } else { value })
    }

    /// Sparse indices must increase and stay in range, or they could not be looked up.
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
