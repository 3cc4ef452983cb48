//! The bits of the stencil that count.

use wgpu::{CompareFunction, StencilFaceState, StencilOperation};

/// The part of the stencil that counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::shadow) enum StencilBits {
    /// All bits, in every cell.
    All,
    /// The low seven bits, in the cells whose top bit is set; the top bit is never written.
    BelowMask,
}

impl StencilBits {
    /// The top bit.
    pub(in crate::shadow) const MASK: u32 = 0x80;

    /// The mask of the bits that count, which is also the largest count without overflow to 0.
    pub(super) fn most(self) -> u32 {
        match self {
            StencilBits::All => 0xff,
            StencilBits::BelowMask => 0x7f,
        }
    }

    /// The stencil reference, for the bits that are compared.
    pub(super) fn reference(self) -> u32 {
        match self {
            StencilBits::All => 0,
            StencilBits::BelowMask => Self::MASK,
        }
    }

    /// The stencil test and operations for the cells that count.
    pub(super) fn face(self, pass_op: StencilOperation, depth_fail_op: StencilOperation) -> StencilFaceState {
        let compare = match self {
            StencilBits::All => CompareFunction::Always,
            StencilBits::BelowMask => CompareFunction::Equal,
        };
        StencilFaceState { compare, pass_op, depth_fail_op, fail_op: StencilOperation::Keep }
    }
}
