//! The window. It owns everything that is open, and has its frame, its panel and its commands.

pub(in crate::desktop) mod cards;
pub(in crate::desktop) mod commands;
pub(in crate::desktop) mod device;
pub(in crate::desktop) mod dropping;
pub(in crate::desktop) mod menus;
pub(in crate::desktop) mod messages;
pub(in crate::desktop) mod opening;
pub(in crate::desktop) mod panel;
pub(in crate::desktop) mod placing;
pub(in crate::desktop) mod receiving;
pub(in crate::desktop) mod recovery;
pub(in crate::desktop) mod saving;
pub(in crate::desktop) mod state;
pub(in crate::desktop) mod study;
pub(in crate::desktop) mod window;
