//! The parts of the window: the picture with its overlays, fields, lists, dialogs. None of them depends on the window.

pub(in crate::desktop) mod components;
pub(in crate::desktop) mod day_strip;
pub(in crate::desktop) mod fields;
pub(in crate::desktop) mod path_dialog;
pub(in crate::desktop) mod point_sky;
pub(in crate::desktop) mod question;
pub(in crate::desktop) mod screen;
pub(in crate::desktop) mod sky;
pub(in crate::desktop) mod theme;
pub(in crate::desktop) mod time;
pub(in crate::desktop) mod verdict;
pub(in crate::desktop) mod verdict_layer;
pub(in crate::desktop) mod view;
