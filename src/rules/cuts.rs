//! The cuts: how high the sun must stand to count, and how far in front of a façade's plane.

use super::error::RuleError;
use super::reader::TableReader;
use crate::choice::words;
use glam::DVec3;

/// How the angle between the sun and a façade is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GrazingIn {
    /// In plan: between the façade's line and the sun's ray.
    Plan,
    /// In space: between the façade's plane and the sun's ray.
    Space,
}

words!(GrazingIn, [
    "plan" => GrazingIn::Plan,
    "space" => GrazingIn::Space,
]);

/// The limits below which the sun does not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunCuts {
    /// The least altitude, degrees.
    pub above_deg: f64,
    /// Whether the sun must stand above that altitude; otherwise, at it is enough.
    pub is_strict: bool,
    /// The least angle to the façade, degrees.
    pub off_facade_deg: f64,
    /// How that angle is measured.
    pub off_facade_in: GrazingIn,
}

impl Default for SunCuts {
    fn default() -> Self {
        SunCuts { above_deg: 0.0, is_strict: false, off_facade_deg: 0.0, off_facade_in: GrazingIn::Space }
    }
}

impl SunCuts {
    /// The keys that `[sun]` may have.
    pub(super) const KEYS: &[&str] = &["above", "strict", "off_facade", "off_facade_in"];

    pub(super) fn read(table: TableReader) -> Result<SunCuts, RuleError> {
        let cuts = SunCuts {
            above_deg: table.number("above", 0.0, 90.0)?.unwrap_or(0.0),
            is_strict: table.flag("strict")?,
            off_facade_deg: table.number("off_facade", 0.0, 90.0)?.unwrap_or(0.0),
            off_facade_in: table.word("off_facade_in")?.unwrap_or(GrazingIn::Space),
        };
        if table.has("off_facade") != table.has("off_facade_in") {
            let what = "an angle to the façade needs both off_facade and off_facade_in, \"plan\" or \"space\"";
            return Err(table.wrong("off_facade", what));
        }
        table.finish()?;
        Ok(cuts)
    }

    /// Whether the sun counts: it is high enough and, if the receiver has an outward normal, far enough in front of its
    /// plane. A sun in the plane or behind it never counts.
    pub fn admits(&self, altitude_deg: f64, to_sun: DVec3, outward: Option<DVec3>) -> bool {
        let is_high = if self.is_strict { altitude_deg > self.above_deg } else { altitude_deg >= self.above_deg };
        is_high && outward.is_none_or(|outward| self.is_before(to_sun, outward))
    }

    fn is_before(&self, to_sun: DVec3, outward: DVec3) -> bool {
        let flat = |v: DVec3| DVec3::new(v.x, v.y, 0.0);
        let (sun, outward) = match self.off_facade_in {
            GrazingIn::Space => (to_sun, outward),
            GrazingIn::Plan => (flat(to_sun), flat(outward)),
        };
        // in plan, a sun at the zenith and a roof's normal have no direction
        let lengths = sun.length() * outward.length();
        let toward = sun.dot(outward);
        if !(toward > 0.0 && lengths > 0.0) {
            return false;
        }
        let angle_deg = (toward / lengths).clamp(-1.0, 1.0).asin().to_degrees();
        // rounding must not refuse a sun exactly at the limit
        angle_deg >= self.off_facade_deg - 1e-9
    }
}
