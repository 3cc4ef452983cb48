//! The request for a study on the plan, and the names of its files.

use crate::deliver::disk::bits;
use crate::deliver::lines::Lines;
use crate::deliver::shelf::KEEP_EVERY;
use crate::deliver::sink::SecondFolder;
use crate::export::figure;
use crate::site::Site;
use crate::study::{Budget, Stopwatch, Wants};
use std::path::{Path, PathBuf};

pub(super) const DRAWING: &str = "profile.png";
pub(super) const RASTER: &str = "shadow-hours.tif";
pub(super) const REPORT: &str = "profile.json";

/// The request for a study on the plan.
#[derive(Clone, Debug)]
pub struct ProfileRequest<'a> {
    /// `profile.png`
    pub drawing: bool,
    /// `shadow-hours.tif`
    pub raster: bool,
    /// `profile.json`
    pub report: bool,
    /// Drawings of lines.
    pub lines: &'a [Lines],
    /// The folder for each instant's mask.
    pub masks: Option<&'a Path>,
    /// `shadow.bits`: one bit per cell for every instant with a sun.
    pub bits: bool,
    /// Whether statistics of counting shadow volumes are wanted.
    pub statistics: bool,
    /// The memory for everything that grows with the plan, bytes; `None` for no limit.
    pub memory: Option<u64>,
    /// A stopwatch that has been running since before the site was read.
    pub watch: Stopwatch,
}

impl<'a> ProfileRequest<'a> {
    /// A request without files. The stopwatch must have been running since before the site was read.
    pub fn of(watch: Stopwatch) -> ProfileRequest<'a> {
        ProfileRequest {
            drawing: false,
            raster: false,
            report: false,
            lines: &[],
            masks: None,
            bits: false,
            statistics: false,
            memory: None,
            watch,
        }
    }

    /// The names of its files, without the masks.
    pub fn names(&self) -> Vec<PathBuf> {
        let kinds = [(self.drawing, DRAWING), (self.raster, RASTER), (self.report, REPORT), (self.bits, bits::NAME)];
        let kinds = kinds.into_iter().filter(|(asked, _)| *asked).map(|(_, name)| name);
        kinds.chain(self.lines.iter().flat_map(|lines| lines.names())).map(PathBuf::from).collect()
    }

    pub(super) fn mask_files(&self, site: &Site) -> Option<SecondFolder<'a>> {
        let folder = self.masks?;
        let files = (0..site.track.instants.len()).map(|index| mask_path(folder, index)).collect();
        Some(SecondFolder { folder, files })
    }

    /// Whether each instant's shadow is needed at the end.
    pub(super) fn holds_outlines(&self) -> bool {
        self.lines.contains(&Lines::Outlines)
    }

    pub(super) fn wants(&self, site: &Site, is_kept: bool) -> Wants {
        Wants {
            masks: self.masks.is_some(),
            // a different path to the same folder is the same study
            masks_in: self.masks.map(|folder| folder.canonicalize().unwrap_or_else(|_| folder.to_owned())),
            bits: self.bits || self.holds_outlines(),
            lines: !self.lines.is_empty(),
            surface: false,
            statistics: self.statistics,
            // outlines are not stored
            keep_every: (is_kept && !self.holds_outlines()).then_some(KEEP_EVERY),
            budget: self.memory.map(|bytes| Budget {
                bytes,
                drawing: if self.drawing { figure::profile_bytes(&site.grid) } else { 0 },
            }),
        }
    }
}

/// The path of an instant's mask.
pub(super) fn mask_path(folder: &Path, index: usize) -> PathBuf {
    folder.join(format!("mask-{index:04}.png"))
}
