//! Which bits of the stencil count.

use wgpu::{CompareFunction, StencilFaceState, StencilOperation};

/// What of the stencil counts.
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

    /// The bits that count, and so the most that is counted without passing through 0.
    pub(super) fn most(self) -> u32 {
        match self {
            StencilBits::All => 0xff,
            StencilBits::BelowMask => 0x7f,
        }
    }

    /// What the stencil is compared with, by the bits that are compared.
    pub(super) fn reference(self) -> u32 {
        match self {
            StencilBits::All => 0,
            StencilBits::BelowMask => Self::MASK,
        }
    }

    /// Which cells count.
    pub(super) fn face(self, pass_op: StencilOperation, depth_fail_op: StencilOperation) -> StencilFaceState {
        let compare = match self {
            StencilBits::All => CompareFunction::Always,
            StencilBits::BelowMask => CompareFunction::Equal,
        };
        StencilFaceState { compare, pass_op, depth_fail_op, fail_op: StencilOperation::Keep }
    }
}
