//! The command's words for the fields of a request: its options.

use super::{interrupt, reading_progress};
use crate::formats::ModelReader;
use crate::message::{Field, Words};
use crate::site::Overrides;

/// An empty request. Notes use the command's words, and models are read as the program does.
pub(super) fn nothing_asked() -> Overrides {
    let reading = ModelReader::of_this_program().until(interrupt::asked()).heard_by(reading_progress::listener());
    Overrides { words: &Options, reading, ..Overrides::default() }
}

/// The command's words for fields.
#[derive(Clone, Copy, Debug)]
pub struct Options;

impl Words for Options {
    fn name(&self, field: Field) -> Option<&'static str> {
        Some(match field {
            Field::Place => "--place",
            Field::Up => "--up",
            Field::DefaultHeight => "--default-height",
            Field::ReadTime => "--read-time",
            Field::ReadMemory => "--read-memory",
            Field::Check => "gnomon check",
            Field::Ground => "--ground",
            Field::Date => "--date",
            Field::FromDate => "--from-date",
            Field::ToDate => "--to-date",
            Field::From => "--from",
            Field::To => "--to",
            Field::Step => "--step",
            Field::Resolution => "--resolution",
            Field::At => "--at",
            Field::Point => "--point",
            Field::Normal => "--normal",
            Field::Points => "--points",
            Field::On => "--on",
            Field::Spacing => "--spacing",
            Field::Height => "--height",
            Field::Region => "--region",
            Field::Cell => "--cell",
            Field::Size => "--size",
            Field::Receivers => "--receivers",
            Field::View => "--view",
            Field::PatchCell => "--patch-cell",
            Field::Technique => "--technique",
            Field::Silhouette => "--silhouette",
            Field::HextreeDepth => "--hextree-depth",
            Field::Engine => "--engine",
            Field::MapSize => "--map-size",
            Field::Pcf => "--pcf",
            Field::SmoothieWidth => "--smoothie-width",
            Field::SunSamples => "--sun-samples",
            Field::Volumes => "--show",
            Field::MaskDiagram => "--show mask",
            Field::OverdrawDiagram => "--show overdraw",
            Field::Statistics => "--stats",
            Field::Lines => "--draw",
            Field::Outlines => "--draw outlines",
            Field::Masks => "--masks",
            Field::Bits => "--bits",
            Field::Memory => "--memory",
            Field::Hours => "--hours",
            Field::Sky => "--sky",
            Field::Out => "--out",
            Field::Csv => "--csv",
            Field::All => "--all",
            Field::Json => "--json",
        })
    }
}
