//! The window. It owns everything that is open, and has its frame, its panel and its commands.

pub(in crate::desktop) mod cards;
pub(in crate::desktop) mod commands;
pub(in crate::desktop) mod device;
pub(in crate::desktop) mod dropping;
pub(in crate::desktop) mod judge_card;
pub(in crate::desktop) mod judge_desk;
pub(in crate::desktop) mod judge_lists;
pub(in crate::desktop) mod judge_section;
pub(in crate::desktop) mod judge_table;
pub(in crate::desktop) mod judge_tools;
pub(in crate::desktop) mod judge_view;
pub(in crate::desktop) mod judging;
pub(in crate::desktop) mod menus;
pub(in crate::desktop) mod messages;
pub(in crate::desktop) mod opening;
pub(in crate::desktop) mod panel;
pub(in crate::desktop) mod panel_row;
pub(in crate::desktop) mod placing;
pub(in crate::desktop) mod receiving;
pub(in crate::desktop) mod recovery;
pub(in crate::desktop) mod saving;
pub(in crate::desktop) mod state;
pub(in crate::desktop) mod study;
pub(in crate::desktop) mod window;
