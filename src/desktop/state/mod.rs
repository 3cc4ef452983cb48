//! The state of the window: what is open, the settings, and their copy in case of a crash. Nothing is drawn here, and
//! no thread runs.

pub(in crate::desktop) mod bare_model;
pub(in crate::desktop) mod clock;
pub(in crate::desktop) mod component_state;
pub(in crate::desktop) mod eye;
pub(in crate::desktop) mod judging;
pub(in crate::desktop) mod pick;
pub(in crate::desktop) mod project;
pub(in crate::desktop) mod recovery;
pub(in crate::desktop) mod saving;
pub(in crate::desktop) mod settings;
pub(in crate::desktop) mod technique;
pub(in crate::desktop) mod unit;
pub(in crate::desktop) mod words;
