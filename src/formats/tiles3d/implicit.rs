//! Implicit tiling: tiles that are not written out, but follow from a tree of squares or cubes. Which of its places have a
//! tile, and which a content, lists of tiles say (`subtree`).

use super::subtree::Subtree;
use super::tileset::{ContentAddress, TileList, TilePlace};
use crate::formats::gltf::percent_decode;
use crate::formats::whole::{below, whole_named_file};
use crate::message::{Message, message};
use serde::Deserialize;
use std::cell::Cell;
use std::path::Path;

/// The most levels of a tree: an axis of the finest one has a thousand million places.
const MOST_LEVELS: u32 = 30;

/// The most levels of one list: so many bits of a place's number are counted in 64.
const MOST_SUBTREE_LEVELS: u32 = 20;

/// The most bytes that all lists of a tree may have, and what opening one counts as: a tree that never ends, whose places all
/// lead to one file, must not be followed for long.
const MOST_LIST_BYTES: u64 = 1 << 30;
const LIST_COST_BYTES: u64 = 1 << 14;

/// How a tile is divided.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ImplicitTiling {
    subdivision_scheme: Scheme,
    subtree_levels: u32,
    /// Of all lists together.
    available_levels: Option<u32>,
    /// The number of the last one, as the extension had it.
    maximum_level: Option<u32>,
    subtrees: ContentAddress,
}

#[derive(Clone, Copy, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
enum Scheme {
    Quadtree,
    Octree,
}

/// A place of the tree.
#[derive(Clone, Copy)]
struct TreePlace {
    level: u32,
    at: [u64; 3],
}

/// A place within a list: its level there, and its number in that level.
#[derive(Clone, Copy)]
struct ListPlace {
    level: u32,
    morton: u64,
}

impl Scheme {
    /// In how many axes it divides; each child's number has a bit for each.
    fn axes(self) -> u32 {
        if self == Scheme::Quadtree { 2 } else { 3 }
    }

    fn children(self, of: ListPlace) -> impl Iterator<Item = ListPlace> {
        let many = 1_u64 << self.axes();
        (0..many).map(move |child| ListPlace { level: of.level + 1, morton: of.morton * many + child })
    }

    /// The bit of a place among those of all levels of a list.
    fn bit(self, of: ListPlace) -> Option<usize> {
        // the levels above have 1 + 4 + 16 …, or 1 + 8 + 64 … places
        let many = (1_u64 << self.axes()) - 1;
        let above = ((1_u64 << (self.axes() * of.level)) - 1) / many;
        usize::try_from(above + of.morton).ok()
    }

    /// The place in the tree of one in a list, whose first place is `root`: the bits of its number go to the axes in turn.
    fn place(self, root: TreePlace, of: ListPlace) -> TreePlace {
        let axes = self.axes();
        let mut at = root.at.map(|whole| whole << of.level);
        for bit in 0..axes * of.level {
            let set = of.morton >> bit & 1;
            if let Some(axis) = at.get_mut((bit % axes) as usize) {
                *axis |= set << (bit / axes);
            }
        }
        TreePlace { level: root.level + of.level, at }
    }
}

impl TreePlace {
    /// The address of what belongs to this place.
    fn address(self, template: &str) -> String {
        let [x, y, z] = self.at;
        let words = [("{level}", u64::from(self.level)), ("{x}", x), ("{y}", y), ("{z}", z)];
        words.iter().fold(template.to_owned(), |address, (word, number)| address.replace(word, &number.to_string()))
    }
}

impl ImplicitTiling {
    /// How many levels the tree has; none where it has more than can be counted.
    fn levels(&self) -> Option<u32> {
        let last = self.maximum_level.and_then(|last| last.checked_add(1));
        let levels = self.available_levels.or(last).unwrap_or(MOST_LEVELS);
        let fits = levels <= MOST_LEVELS && (1..=MOST_SUBTREE_LEVELS).contains(&self.subtree_levels);
        fits.then_some(levels)
    }
}

impl TileList {
    /// Adds the tiles of a tree that have no finer ones, or all where those are added to.
    pub(super) fn add_implicit(
        &mut self,
        tiling: &ImplicitTiling,
        contents: &[&ContentAddress],
        place: TilePlace<'_>,
    ) -> Result<(), Message> {
        let Some(levels) = tiling.levels() else {
            self.tally.add("implicit tilings", "the tree has more levels than any on Earth");
            return Ok(());
        };
        let mut roots = vec![TreePlace { level: 0, at: [0; 3] }];
        let read = Cell::new(0);
        while let Some(root) = roots.pop() {
            let subtree = self.subtree(tiling, root, place, &read);
            if read.get() > MOST_LIST_BYTES {
                return Err(message!["has more lists of tiles than can be read"; "export a smaller region"]);
            }
            let Some(subtree) = subtree else {
                self.tally.add("lists of tiles", "the file cannot be read");
                continue;
            };
            self.add_subtree(tiling, (root, levels), &subtree, (contents, place), &mut roots)?;
        }
        Ok(())
    }

    /// Reads the list of the tiles from a place on.
    fn subtree(
        &mut self,
        tiling: &ImplicitTiling,
        root: TreePlace,
        place: TilePlace<'_>,
        read: &Cell<u64>,
    ) -> Option<Subtree> {
        let bytes_of = |path: &Path| {
            let bytes = whole_named_file(place.tileset.home, path).ok()?;
            read.set(read.get() + LIST_COST_BYTES + bytes.len() as u64);
            Some(bytes)
        };
        let template = tiling.subtrees.uri.as_deref()?;
        let path = below(place.tileset.folder, &percent_decode(&root.address(template))?)?;
        let bytes = bytes_of(&path)?;
        let folder = path.parent()?.to_owned();
        self.tilesets.push(path);
        let beside = |uri: &str| bytes_of(&below(&folder, &percent_decode(uri)?)?);
        Subtree::read(&bytes, beside)
    }

    /// Adds the tiles of a list; where it ends, those below are added to `roots`.
    fn add_subtree(
        &mut self,
        tiling: &ImplicitTiling,
        (root, levels): (TreePlace, u32),
        subtree: &Subtree,
        (contents, place): (&[&ContentAddress], TilePlace<'_>),
        roots: &mut Vec<TreePlace>,
    ) -> Result<(), Message> {
        let scheme = tiling.subdivision_scheme;
        let has_tile = |of: &ListPlace| subtree.tiles.has(scheme.bit(*of));
        let mut open = vec![ListPlace { level: 0, morton: 0 }];
        open.retain(has_tile);
        while let Some(tile) = open.pop() {
            self.count_tile()?;
            let before = (open.len(), roots.len());
            if root.level + tile.level + 1 < levels {
                if tile.level + 1 < tiling.subtree_levels {
                    open.extend(scheme.children(tile).filter(has_tile));
                } else {
                    let listed = |of: &ListPlace| subtree.below.has(usize::try_from(of.morton).ok());
                    let below = scheme.children(tile).filter(listed);
                    roots.extend(below.map(|child| scheme.place(root, child)));
                }
            }
            let is_finest = before == (open.len(), roots.len());
            for (content, there) in contents.iter().zip(&subtree.contents) {
                if !there.has(scheme.bit(tile)) {
                    continue;
                }
                if place.adds || is_finest {
                    let uri = content.uri.as_deref().map(|template| scheme.place(root, tile).address(template));
                    self.add_content(uri.as_deref(), place)?;
                } else {
                    self.leave_out_coarser();
                }
            }
        }
        Ok(())
    }
}
