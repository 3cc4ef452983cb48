//! A part of a study: one tile at some instants, for programs that distribute the work.

use super::tile_sum::TileSum;
use super::{Event, OnEvent, StudyError, TiledStudy, Wants, tell};
use crate::profile::Shaded;
use crate::sun;
use crate::view::Tile;

impl TiledStudy<'_> {
    /// Computes a part of the study, for a program that distributes the work: the shaded time of one tile at some of
    /// the instants, which may come from another process. Time between two instants belongs to the later one. Sums of
    /// instants that make up the track add up to the tile's own sum to the bit, and [`paste`](super::paste) joins
    /// tiles. If the device fails, so does this call. The listener receives [`Event::Drawn`] after each of the instants,
    /// and can end the work also between them ([`Event::Between`]).
    ///
    /// # Errors
    /// [`StudyError::OtherTile`] for a tile of another study; [`StudyError::Shadow`] if drawing fails;
    /// [`StudyError::Interrupted`] if the listener ends the work.
    pub fn sum(&self, tile: Tile, instants: &[sun::Instant], on_event: &mut OnEvent<'_>) -> Result<Shaded, StudyError> {
        if !self.tiles.contains(&tile) {
            return Err(StudyError::OtherTile);
        }
        let mut technique = self.look().technique_of(tile)?;
        let mut sum = TileSum::new(self.site, self.drawn().resolution_secs, self.machine.gpu(), &tile);
        let track = &self.site.track.instants;
        for (index, instant) in instants.iter().enumerate() {
            let at = track.binary_search_by_key(&instant.time, |own| own.time);
            match at.ok().filter(|at| track[*at].weight_secs == instant.weight_secs) {
                _ if instant.night => {}
                Some(at) => {
                    let go_on = &mut || tell(on_event, Event::Between);
                    sum.add(at, technique.as_mut(), &Wants::default(), go_on)?;
                }
                None => sum.add_mask(&technique.draw(instant.to_sun)?, instant.weight_secs)?,
            }
            let (count, time) = (instants.len(), instant.time);
            tell(on_event, Event::Drawn { index, count, time, mask: None, bits: None })?;
        }
        Ok(sum.finish()?)
    }
}
