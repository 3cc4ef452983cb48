//! The colours of strips.

use crate::export::figure::scale::Rgb;

/// The colours of sun, of shade, of night, and of times that were not requested.
pub(super) const SUN: Rgb = [250, 218, 128];
pub(super) const SHADE: Rgb = crate::look::LOOK.plan_ground_shade;
pub(super) const NIGHT: Rgb = [62, 70, 88];
pub(super) const OUTSIDE: Rgb = [226, 224, 217];
