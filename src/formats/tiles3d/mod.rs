//! Reads 3D Tiles: a tileset with its contents, or a single content. Only the finest tiles are used.
//!
//! A tile's content is glTF, with y up. Tiles are z up, and place their contents in coordinates around the Earth's
//! centre. The files of this folder, in the order of the flow: `tileset` (finds and places contents), `implicit` and
//! `subtree` (tiles that are not written out), `b3dm` (finds the glTF in a content), `build` (makes parts).

use super::whole::{whole_file, whole_named_file};
use super::{Format, Model, ModelFault, ReadOptions, json_head};
use build::TileBuilder;
use glam::DMat4;
use std::path::{Path, PathBuf};

mod b3dm;
mod build;
mod implicit;
mod subtree;
mod tileset;

/// 3D Tiles, `tileset.json` and `.b3dm`.
pub(super) struct Tiles3d;

impl Format for Tiles3d {
    fn name(&self) -> &'static str {
        "3D Tiles"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["b3dm", "json"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        head.starts_with(b3dm::MAGIC) || ["geometricError", "root"].iter().all(|key| json_head::has_key(head, key))
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        let bytes = whole_file(path)?;
        let mut builder = TileBuilder::new(options.scale);
        if bytes.starts_with(b3dm::MAGIC) {
            builder.add(path, &bytes, "", DMat4::IDENTITY, true)?;
            return builder.finish();
        }
        let listed = tileset::contents(path, &bytes)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        for content in &listed.contents {
            let bytes = match whole_named_file(folder, &content.path) {
                Ok(bytes) => bytes,
                Err(fault) => {
                    builder.fail(&content.name, &fault);
                    continue;
                }
            };
            if let Err(fault) = builder.add(&content.path, &bytes, &content.name, content.world, content.is_y_up) {
                builder.fail(&content.name, &fault);
            }
            builder.check_size()?;
        }
        builder.finish_with(listed.tally)
    }

    /// Contents are often compressed by Draco, which is only known when they are opened.
    fn is_foreign(&self, _path: &Path, _options: &ReadOptions) -> bool {
        true
    }

    fn named_by(&self, path: &Path) -> Vec<PathBuf> {
        let listed = whole_file(path).ok().and_then(|bytes| tileset::contents(path, &bytes).ok());
        let files = listed.map(|listed| {
            let contents = listed.contents.into_iter().map(|content| content.path);
            listed.tilesets.into_iter().chain(contents).collect::<Vec<_>>()
        });
        files.unwrap_or_default()
    }
}
