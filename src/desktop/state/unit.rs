//! The unit of displayed lengths. Files always use metres.

/// A unit of length.
#[derive(Clone, Copy)]
pub(in crate::desktop) struct Unit {
    /// Its length, metres.
    pub(in crate::desktop) metres: f64,
    /// Its short name.
    pub(in crate::desktop) name: &'static str,
}

impl Unit {
    /// Feet, or metres.
    pub(in crate::desktop) fn of(feet: bool) -> Unit {
        if feet { Unit { metres: 0.3048, name: "ft" } } else { Unit { metres: 1.0, name: "m" } }
    }
}
