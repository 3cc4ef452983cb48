//! Reads the JSON of a tileset and its nested tilesets, and places their contents.

use super::implicit::{ContentAddress, ImplicitTiling};
use crate::formats::ModelFault;
use crate::formats::gltf::percent_decode;
use crate::formats::left_out::{LeftOutTally, label};
use crate::formats::whole::{below, whole_named_file, without_mark};
use crate::message::{Message, message};
use glam::DMat4;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// How deeply tilesets may be nested.
const MOST_DEEP: usize = 12;

/// The most contents that are read, and the most tiles that are visited.
const MOST_CONTENTS: usize = 100_000;
const MOST_TILES: usize = 1_000_000;

#[derive(Deserialize)]
struct Tileset {
    #[serde(default)]
    asset: TilesetAsset,
    root: TilesetTile,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct TilesetAsset {
    /// Only in tilesets before 1.0.
    gltf_up_axis: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct TilesetTile {
    /// Column-major.
    transform: Option<[f64; 16]>,
    refine: Option<String>,
    content: Option<ContentAddress>,
    #[serde(default)]
    contents: Vec<ContentAddress>,
    #[serde(default)]
    children: Vec<TilesetTile>,
    implicit_tiling: Option<ImplicitTiling>,
    #[serde(default)]
    extensions: TileExtensions,
}

/// Extensions that became part of 1.1.
#[derive(Default, Deserialize)]
struct TileExtensions {
    #[serde(rename = "3DTILES_implicit_tiling")]
    implicit_tiling: Option<ImplicitTiling>,
    #[serde(rename = "3DTILES_multiple_contents")]
    contents: Option<SeveralContents>,
}

#[derive(Deserialize)]
struct SeveralContents {
    #[serde(alias = "content")]
    contents: Vec<ContentAddress>,
}

impl TilesetTile {
    fn contents(&self) -> Vec<&ContentAddress> {
        let further = self.extensions.contents.iter().flat_map(|several| &several.contents);
        self.content.iter().chain(&self.contents).chain(further).collect()
    }
}

/// A placed content of a tile.
pub(super) struct TileContent {
    pub path: PathBuf,
    /// Its address without the ending.
    pub name: String,
    pub world: DMat4,
    /// Whether its glTF is y up, as in all but the oldest tilesets.
    pub is_y_up: bool,
}

/// All placed contents.
#[derive(Default)]
pub(super) struct TileList {
    pub contents: Vec<TileContent>,
    /// Nested tilesets, and subtree files.
    pub tilesets: Vec<PathBuf>,
    pub tally: LeftOutTally,
    tiles: usize,
}

/// Finds the contents of a tileset.
pub(super) fn contents(path: &Path, bytes: &[u8]) -> Result<TileList, ModelFault> {
    let mut list = TileList::default();
    let tileset = parsed(bytes)?;
    let home = path.parent().unwrap_or(Path::new(""));
    let at = TilesetPlace { home, folder: home, is_y_up: tileset.is_y_up(), deep: MOST_DEEP };
    list.add(&tileset.root, DMat4::IDENTITY, false, at)?;
    Ok(list)
}

fn parsed(bytes: &[u8]) -> Result<Tileset, Message> {
    serde_json::from_slice(without_mark(bytes)).map_err(|error| match error.classify() {
        serde_json::error::Category::Eof => message![format!("is cut off ({error})"); "copy or export it again"],
        _ => message![format!("is not a tileset ({error})"); "export it again"],
    })
}

impl Tileset {
    fn is_y_up(&self) -> bool {
        !self.asset.gltf_up_axis.as_deref().is_some_and(|axis| axis.eq_ignore_ascii_case("z"))
    }
}

/// Where a tileset's file is.
#[derive(Clone, Copy)]
struct TilesetPlace<'a> {
    /// The folder of the tileset that was opened. Links must not lead out of it.
    home: &'a Path,
    folder: &'a Path,
    is_y_up: bool,
    /// How many more levels of tilesets may be nested.
    deep: usize,
}

/// Where a tile is placed.
#[derive(Clone, Copy)]
struct TilePlace<'a> {
    world: DMat4,
    /// Whether finer tiles are added to it, instead of replacing it.
    adds: bool,
    tileset: TilesetPlace<'a>,
}

impl TileList {
    /// Adds a tile and those below it. The JSON parser limits the depth of the recursion.
    fn add(&mut self, tile: &TilesetTile, around: DMat4, adds: bool, at: TilesetPlace<'_>) -> Result<(), Message> {
        self.count_tile()?;
        let world = tile.transform.map_or(around, |transform| around * DMat4::from_cols_array(&transform));
        // a tile inherits what it does not define
        let adds = tile.refine.as_deref().map_or(adds, |refine| refine.eq_ignore_ascii_case("add"));
        let place = TilePlace { world, adds, tileset: at };
        if let Some(tiling) = tile.implicit_tiling.as_ref().or(tile.extensions.implicit_tiling.as_ref()) {
            return self.add_implicit(tiling, &tile.contents(), place);
        }
        for content in tile.contents() {
            if adds || tile.children.is_empty() {
                self.add_content(content.uri.as_deref(), place)?;
            } else {
                self.leave_out_coarser();
            }
        }
        tile.children.iter().try_for_each(|child| self.add(child, world, adds, at))
    }

    /// Adds the tiles of a tree that have no finer ones; or all, if finer tiles are added to them.
    fn add_implicit(
        &mut self,
        tiling: &ImplicitTiling,
        contents: &[&ContentAddress],
        place: TilePlace<'_>,
    ) -> Result<(), Message> {
        let folders = [place.tileset.home, place.tileset.folder];
        let Some(found) = tiling.tiles(contents, folders, MOST_TILES - self.tiles)? else {
            self.tally.add("implicit tilings", "the tree has too many levels");
            return Ok(());
        };
        self.tilesets.extend(found.lists);
        for _ in 0..found.unread_lists {
            self.tally.add("lists of tiles", "the file cannot be read");
        }
        for tile in found.tiles {
            self.count_tile()?;
            for uri in tile.contents {
                if place.adds || tile.is_finest {
                    self.add_content(uri.as_deref(), place)?;
                } else {
                    self.leave_out_coarser();
                }
            }
        }
        Ok(())
    }

    fn count_tile(&mut self) -> Result<(), Message> {
        self.tiles += 1;
        if self.tiles > MOST_TILES {
            return Err(message![format!("has more than {MOST_TILES} tiles"); "export a smaller region"]);
        }
        Ok(())
    }

    fn leave_out_coarser(&mut self) {
        self.tally.add("tiles", "finer ones are used instead");
    }

    /// Adds the content at an address.
    fn add_content(&mut self, uri: Option<&str>, place: TilePlace<'_>) -> Result<(), Message> {
        let TilePlace { world, adds, tileset: at } = place;
        let uri = uri.and_then(|uri| percent_decode(uri.split(['?', '#']).next()?));
        let Some(path) = uri.as_deref().and_then(|uri| below(at.folder, uri)) else {
            self.tally.add("contents", "the address is outside of the tileset's folder");
            return Ok(());
        };
        if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) {
            return self.add_tileset(&path, world, adds, at);
        }
        if self.contents.len() >= MOST_CONTENTS {
            return Err(message![format!("has more than {MOST_CONTENTS} contents"); "export a smaller region"]);
        }
        let name = label(&Path::new(uri.as_deref().unwrap_or_default()).with_extension("").to_string_lossy());
        self.contents.push(TileContent { path, name, world, is_y_up: at.is_y_up });
        Ok(())
    }

    /// Adds a nested tileset at its tile's place. One that cannot be read is left out, like a content.
    fn add_tileset(&mut self, path: &Path, world: DMat4, adds: bool, at: TilesetPlace<'_>) -> Result<(), Message> {
        let read = || parsed(&whole_named_file(at.home, path).ok()?).ok();
        let tileset = (at.deep > 0).then(read).flatten();
        let Some(tileset) = tileset else {
            let why = if at.deep > 0 { "the file cannot be read" } else { "tilesets are nested too deeply" };
            self.tally.add("tilesets", why);
            return Ok(());
        };
        self.tilesets.push(path.to_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        let at = TilesetPlace { folder, is_y_up: tileset.is_y_up(), deep: at.deep - 1, ..at };
        self.add(&tileset.root, world, adds, at)
    }
}
