//! The window: a site, its sun and its shadows at the speed of the hand. Everything that it finds, the library finds.
//!
//! One thread draws the window and never waits. A second one (`stage`) draws the picture and takes the newest wish, on a
//! device of its own; others load sites and add up hours.

mod app;
mod bare;
mod cards;
mod change;
mod clock;
mod commands;
mod components;
mod dropped;
mod easel;
mod event_loop;
mod export;
mod eye;
mod facades;
mod files;
mod found;
mod frame;
mod hours;
mod loading;
mod look;
mod panel;
mod pick;
mod plain;
mod question;
mod recovery;
mod reopening;
mod saving;
mod screen;
mod settings;
mod shown;
mod sky;
mod stage;
mod time;
mod typed;
mod unit;
mod view;
mod words;
mod work;

pub use app::App;
pub use reopening::{open, open_with, setup};
