//! Implicit tiling: tiles that are not written out, but follow from a quadtree or octree. Subtree files (`subtree`) say
//! which nodes of it have a tile, and which a content.

use super::subtree::Subtree;
use crate::formats::gltf::percent_decode;
use crate::formats::whole::{below, whole_named_file};
use crate::message::{Message, message};
use serde::Deserialize;
use std::cell::Cell;
use std::path::{Path, PathBuf};

/// The most levels of a tree: an axis of the finest one has a billion nodes.
const MOST_LEVELS: u32 = 30;

/// The most levels of one subtree file: its bits are indexed in 64 bits.
const MOST_SUBTREE_LEVELS: u32 = 20;

/// The most bytes of all subtree files of a tree, and the cost of opening one. A tree whose nodes all refer to one file
/// would never end.
const MOST_LIST_BYTES: u64 = 1 << 30;
const LIST_COST_BYTES: u64 = 1 << 14;

/// The address of a content. In a tree it is a template for the numbers of a node.
#[derive(Deserialize)]
pub(super) struct ContentAddress {
    /// Called `url` before 1.0.
    #[serde(alias = "url")]
    pub uri: Option<String>,
}

/// How a tile is divided.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ImplicitTiling {
    subdivision_scheme: Scheme,
    subtree_levels: u32,
    /// The levels of all subtrees together.
    available_levels: Option<u32>,
    /// The last level, as in the extension before 1.1.
    maximum_level: Option<u32>,
    subtrees: ContentAddress,
}

#[derive(Clone, Copy, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "UPPERCASE")]
enum Scheme {
    Quadtree,
    Octree,
}

/// A node of the tree.
#[derive(Clone, Copy)]
struct TreePlace {
    level: u32,
    at: [u64; 3],
}

/// A node within a subtree: its level, and its index in that level.
#[derive(Clone, Copy)]
struct ListPlace {
    level: u32,
    morton: u64,
}

impl Scheme {
    /// The number of axes that it divides. A child's index has a bit for each.
    fn axes(self) -> u32 {
        if self == Scheme::Quadtree { 2 } else { 3 }
    }

    fn children(self, of: ListPlace) -> impl Iterator<Item = ListPlace> {
        let many = 1_u64 << self.axes();
        (0..many).map(move |child| ListPlace { level: of.level + 1, morton: of.morton * many + child })
    }

    /// The index of a node's bit in a subtree's list of all levels.
    fn bit(self, of: ListPlace) -> Option<usize> {
        // the levels above have 1 + 4 + 16 + …, or 1 + 8 + 64 + … nodes
        let many = (1_u64 << self.axes()) - 1;
        let above = ((1_u64 << (self.axes() * of.level)) - 1) / many;
        usize::try_from(above + of.morton).ok()
    }

    /// The node in the tree of a node in a subtree with the root `root`: its index's bits belong to the axes in turn.
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
    /// Fills in a template for this node.
    fn address(self, template: &str) -> String {
        let [x, y, z] = self.at;
        let words = [("{level}", u64::from(self.level)), ("{x}", x), ("{y}", y), ("{z}", z)];
        words.iter().fold(template.to_owned(), |address, (word, number)| address.replace(word, &number.to_string()))
    }
}

impl ImplicitTiling {
    /// The number of levels of the tree; `None` if there are too many.
    fn levels(&self) -> Option<u32> {
        let last = self.maximum_level.and_then(|last| last.checked_add(1));
        let levels = self.available_levels.or(last).unwrap_or(MOST_LEVELS);
        let fits = levels <= MOST_LEVELS && (1..=MOST_SUBTREE_LEVELS).contains(&self.subtree_levels);
        fits.then_some(levels)
    }
}

/// The tiles of a tree.
#[derive(Default)]
pub(super) struct ImplicitTiles {
    pub tiles: Vec<ImplicitTile>,
    /// The subtree files.
    pub lists: Vec<PathBuf>,
    /// The number of subtree files that cannot be read.
    pub unread_lists: usize,
}

/// A tile of the tree.
pub(super) struct ImplicitTile {
    /// Whether it has no finer tiles below it.
    pub is_finest: bool,
    /// The addresses of its contents.
    pub contents: Vec<Option<String>>,
}

/// The traversal of a tree.
struct TreeWalk<'a> {
    tiling: &'a ImplicitTiling,
    contents: &'a [&'a ContentAddress],
    /// The folder of the tileset that was opened, and that of the tileset with the tree.
    folders: [&'a Path; 2],
    levels: u32,
    /// The roots of subtrees that are not read yet.
    roots: Vec<TreePlace>,
    read_bytes: Cell<u64>,
    found: ImplicitTiles,
}

impl ImplicitTiling {
    /// The tiles of this tree; stops at more than `most`. `None` if the tree has too many levels. Files are read only
    /// within the folder of the tileset that was opened, the first of `folders`.
    pub(super) fn tiles(
        &self,
        contents: &[&ContentAddress],
        folders: [&Path; 2],
        most: usize,
    ) -> Result<Option<ImplicitTiles>, Message> {
        let Some(levels) = self.levels() else { return Ok(None) };
        let (roots, found) = (vec![TreePlace { level: 0, at: [0; 3] }], ImplicitTiles::default());
        let mut walk = TreeWalk { tiling: self, contents, folders, levels, roots, read_bytes: Cell::new(0), found };
        while let Some(root) = walk.roots.pop() {
            let subtree = walk.subtree(root);
            if walk.read_bytes.get() > MOST_LIST_BYTES {
                return Err(message!["has more subtree files than can be read"; "export a smaller region"]);
            }
            match subtree {
                Some(subtree) => walk.add_subtree(root, &subtree, most),
                None => walk.found.unread_lists += 1,
            }
            if walk.found.tiles.len() > most {
                break;
            }
        }
        Ok(Some(walk.found))
    }
}

impl TreeWalk<'_> {
    /// Reads the subtree file of a node.
    fn subtree(&mut self, root: TreePlace) -> Option<Subtree> {
        let [home, folder] = self.folders;
        let bytes_of = |path: &Path| {
            let bytes = whole_named_file(home, path).ok()?;
            self.read_bytes.set(self.read_bytes.get() + LIST_COST_BYTES + bytes.len() as u64);
            Some(bytes)
        };
        let template = self.tiling.subtrees.uri.as_deref()?;
        let path = below(folder, &percent_decode(&root.address(template))?)?;
        let bytes = bytes_of(&path)?;
        let folder = path.parent()?.to_owned();
        self.found.lists.push(path);
        let beside = |uri: &str| bytes_of(&below(&folder, &percent_decode(uri)?)?);
        Subtree::read(&bytes, beside)
    }

    /// Adds the tiles of a subtree, and the roots of those below it to `roots`.
    fn add_subtree(&mut self, root: TreePlace, subtree: &Subtree, most: usize) {
        let scheme = self.tiling.subdivision_scheme;
        let has_tile = |of: &ListPlace| subtree.tiles.has(scheme.bit(*of));
        let mut open = vec![ListPlace { level: 0, morton: 0 }];
        open.retain(has_tile);
        while let Some(tile) = open.pop().filter(|_| self.found.tiles.len() <= most) {
            let before = (open.len(), self.roots.len());
            if root.level + tile.level + 1 < self.levels {
                if tile.level + 1 < self.tiling.subtree_levels {
                    open.extend(scheme.children(tile).filter(has_tile));
                } else {
                    let listed = |of: &ListPlace| subtree.below.has(usize::try_from(of.morton).ok());
                    let below = scheme.children(tile).filter(listed);
                    self.roots.extend(below.map(|child| scheme.place(root, child)));
                }
            }
            let is_finest = before == (open.len(), self.roots.len());
            let there = self.contents.iter().zip(&subtree.contents).filter(|(_, there)| there.has(scheme.bit(tile)));
            let address = |template: &String| scheme.place(root, tile).address(template);
            let contents = there.map(|(content, _)| content.uri.as_ref().map(address)).collect();
            self.found.tiles.push(ImplicitTile { is_finest, contents });
        }
    }
}
