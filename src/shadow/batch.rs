//! Batches: casters that are counted together, few enough above each other that the stencil can hold their count.
//!
//! The stencil has 8 bits (7 besides a computation mask), and a count of exactly 256 (128) would read as light. Casters
//! are halved until an upper bound shows that no count of a half can reach that ([`layers_bound`]). Each batch keeps
//! its bound, so that as many batches as fit are counted together before the mask is drawn from the count.

use super::walls::{WallMaker, WallQuery, Walls};
use crate::gpu::GpuError;
use crate::mesh::Mesh;
use crate::volume::layers_bound;
use wgpu::CommandEncoder;

/// Walls, and an upper bound of their count.
pub(super) type CountedWalls<'a> = (&'a dyn Walls, u32);

/// Casters, their walls, and their halves if they are too many. Walls and halves are made when they are first needed.
pub(super) struct Batch {
    mesh: Mesh,
    /// Whether every shell is even, so that every multiplicity is.
    even: bool,
    walls: Option<Box<dyn Walls>>,
    halves: Option<Vec<Batch>>,
}

impl Batch {
    /// The casters in even shells, and the others.
    pub(super) fn of(casters: &Mesh) -> Vec<Batch> {
        let even = casters.in_even_shells();
        [true, false]
            .map(|wanted| Batch::new(casters.of_faces(|face| even[face as usize] == wanted), wanted))
            .into_iter()
            .filter(|batch| !batch.mesh.faces.is_empty())
            .collect()
    }

    fn new(mesh: Mesh, even: bool) -> Batch {
        Batch { mesh, even, walls: None, halves: None }
    }

    /// Appends walls that together are those of these casters, each with a count of at most `most_counted`.
    ///
    /// Without caps, walls of even shells are drawn half as often. A view ray crosses no cap before the point that it
    /// sees, so it crosses the walls an even number of times; half the count is an integer, too, and 0 exactly if the
    /// count is. That holds for any winding, and saves half of the walls.
    pub(super) fn find<'a>(
        &'a mut self,
        maker: &WallMaker,
        sought: WallQuery,
        most_counted: u32,
        encoder: &mut CommandEncoder,
        found: &mut Vec<CountedWalls<'a>>,
    ) -> Result<(), GpuError> {
        let halved = self.even && !sought.with_cap;
        let faces = self.mesh.faces.len() as u32;
        let most = most_counted << u32::from(halved);
        let bound = if faces > most { layers_bound(&self.mesh, sought.local_light.truncate()) } else { faces };
        if bound > most {
            // the cut makes only those shells odd that it passes through
            let halves = self.halves.get_or_insert_with(|| {
                let half = |low: bool| self.mesh.of_faces(|face| (face < faces / 2) == low);
                [true, false].iter().flat_map(|&low| Batch::of(&half(low))).collect()
            });
            return halves.iter_mut().try_for_each(|half| half.find(maker, sought, most_counted, encoder, found));
        }
        let walls = match &mut self.walls {
            Some(walls) => walls,
            none => none.insert(maker.walls(&self.mesh)?),
        };
        if walls.find(&self.mesh, &WallQuery { halved, ..sought }, encoder)? {
            found.push((&**walls, bound >> u32::from(halved)));
        }
        Ok(())
    }
}
