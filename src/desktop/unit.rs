//! The unit in which lengths are shown. What is written is metres.

/// A unit of length.
#[derive(Clone, Copy)]
pub(super) struct Unit {
    /// How long it is, metres.
    pub(super) metres: f64,
    /// Its short name.
    pub(super) name: &'static str,
}

impl Unit {
    /// Feet, or metres.
    pub(super) fn of(feet: bool) -> Unit {
        if feet { Unit { metres: 0.3048, name: "ft" } } else { Unit { metres: 1.0, name: "m" } }
    }
}
