//! The sheet of paper that drawings are made for.

/// Page size, pixels: A3 landscape at 212 dots an inch.
pub const WIDTH: u32 = 3508;
/// Page height, pixels.
pub const HEIGHT: u32 = 2480;

/// The side of a pixel when the page is printed on A3, which is 420 mm wide, metres.
pub(super) const PAPER_METRES_A_PIXEL: f64 = 0.420 / WIDTH as f64;
