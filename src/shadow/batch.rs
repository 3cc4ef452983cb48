//! Casters that are counted together, so few over each other that the stencil holds their count.
//!
//! The stencil holds 8 bits, and a count of exactly 256 would read as light. Casters are halved until a bound shows
//! that no count of a half can reach 256 ([`layers_bound`]); halves are drawn one after the other.

use crate::mesh::Mesh;
use crate::silhouette::{DirectedEdge, Kind, SilhouetteFinder};
use crate::volume::{Volume, layers_bound};
use glam::DVec3;

/// The most that an 8-bit stencil counts without passing through 0.
const MOST_COUNTED: u32 = 255;

/// Casters, their finder, and their halves where they are too many. Finder and halves are made when first needed.
pub(super) struct Batch {
    mesh: Mesh,
    /// Every shell is even, so that every multiplicity is even.
    even: bool,
    kind: Kind,
    finder: Option<Box<dyn SilhouetteFinder>>,
    halves: Option<Box<[Batch; 2]>>,
}

impl Batch {
    /// The casters in even shells, and the others.
    pub(super) fn of(casters: &Mesh, kind: Kind) -> Vec<Batch> {
        let even = casters.in_even_shells();
        [true, false]
            .map(|wanted| Batch::new(casters.of_faces(|face| even[face as usize] == wanted), wanted, kind))
            .into_iter()
            .filter(|batch| !batch.mesh.faces.is_empty())
            .collect()
    }

    fn new(mesh: Mesh, even: bool, kind: Kind) -> Batch {
        Batch { mesh, even, kind, finder: None, halves: None }
    }

    /// Calls `each` with volumes that together are that of these casters, none of which counts beyond the stencil.
    ///
    /// Without caps, walls of even shells stand half as often. There, every wall that a view ray crosses on its way
    /// to what it sees stands an even number of times, for the ray crosses no cap; so half the count is as whole a
    /// number, and 0 where the count is. That is so for any winding, and saves half of the walls.
    pub(super) fn volumes(&mut self, to_sun: DVec3, with_cap: bool, each: &mut dyn FnMut(&Mesh, Volume)) {
        let halved = self.even && !with_cap;
        let faces = self.mesh.faces.len() as u32;
        let most = MOST_COUNTED << u32::from(halved);
        if faces > most && layers_bound(&self.mesh, to_sun) > most {
            // a cut goes through shells, and leaves them odd
            let kind = self.kind;
            let halves = self.halves.get_or_insert_with(|| {
                Box::new(
                    [true, false]
                        .map(|low| Batch::new(self.mesh.of_faces(|face| (face < faces / 2) == low), false, kind)),
                )
            });
            for half in halves.iter_mut() {
                half.volumes(to_sun, with_cap, each);
            }
            return;
        }
        let finder = self.finder.get_or_insert_with(|| self.kind.build(&self.mesh));
        let mut volume = Volume::find(&self.mesh, &mut **finder, to_sun.extend(0.0), with_cap);
        if halved {
            // an edge's walls stand in a row
            let once = volume.walls.chunks_exact(2).map(|twice| twice[0]);
            volume.walls = once.collect::<Vec<DirectedEdge>>();
        }
        each(&self.mesh, volume);
    }
}
