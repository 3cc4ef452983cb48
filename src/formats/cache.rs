//! The cache of models that were read: a file that takes long to read opens at once the second time.
//!
//! An entry is a file in a folder among the user's caches. Its name is a hash of everything that affects the reading:
//! the contents of the file and of those that it refers to, the format, the request, and the program's version. Entries
//! are written whole and have a checksum. Damaged ones are removed, and the oldest ones if there are too many.

use super::{Format, Model, ReadOptions, encoded};
use siphasher::sip128::{Hasher128, SipHasher13};
use std::fs::{self, File};
use std::hash::{Hash, Hasher};
use std::io::{self, BufReader, BufWriter, Read};
use std::path::{Path, PathBuf};

/// The endings of the names of whole entries, and of those being written.
const WHOLE: &str = "model";
const PARTIAL: &str = "part";

/// A folder in which models are kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelCache {
    /// Its path; it is created if it is missing.
    pub folder: PathBuf,
    /// The greatest size of all entries together, bytes.
    pub most_bytes: u64,
}

impl ModelCache {
    /// The default size of all entries, bytes: 2 GiB.
    pub const MOST_BYTES: u64 = 2 << 30;

    /// The user's cache, if the system has a folder for caches.
    pub fn of_user() -> Option<ModelCache> {
        let folder = dirs::cache_dir()?.join("gnomon").join("models");
        Some(ModelCache { folder, most_bytes: Self::MOST_BYTES })
    }

    /// The entry of a file in its present state.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn entry(&self, format: &dyn Format, path: &Path, options: &ReadOptions) -> io::Result<CacheEntry<'_>> {
        let mut number = SipHasher13::new();
        (env!("CARGO_PKG_VERSION"), encoded::VERSION, format.name()).hash(&mut number);
        serde_json::to_string(options)?.hash(&mut number);
        add_file(&mut number, path)?;
        for named in format.named_by(path) {
            // a missing file is reported when it is read
            let is_there = add_file(&mut number, &named).is_ok();
            is_there.hash(&mut number);
        }
        Ok(CacheEntry { cache: self, name: format!("{:032x}", number.finish128().as_u128()) })
    }

    /// The files of all entries, whole and partial: their age, size and path.
    fn files(&self) -> Vec<(std::time::SystemTime, u64, PathBuf)> {
        let Ok(entries) = self.folder.read_dir() else { return Vec::new() };
        let is_ours = |path: &PathBuf| path.extension().is_some_and(|ending| ending == WHOLE || ending == PARTIAL);
        let told = |entry: fs::DirEntry| {
            let told = entry.metadata().ok()?;
            Some((told.modified().ok()?, told.len(), Some(entry.path()).filter(is_ours)?))
        };
        entries.filter_map(Result::ok).filter_map(told).collect()
    }

    /// Removes the oldest entries until the total is within the limit, but not the newest one.
    fn make_room(&self, newest: &Path) {
        let mut files = self.files();
        files.sort();
        let mut all: u64 = files.iter().map(|(_, bytes, _)| bytes).sum();
        for (_, bytes, path) in files {
            if all <= self.most_bytes {
                break;
            }
            if path != newest {
                // another process may have removed it
                let _ = fs::remove_file(path);
                all = all.saturating_sub(bytes);
            }
        }
    }
}

/// Hashes a file's length and content.
fn add_file(number: &mut SipHasher13, path: &Path) -> io::Result<()> {
    let mut file = File::open(path)?;
    let (mut bytes, mut length) = (vec![0; 1 << 18], 0_u64);
    loop {
        let count = match file.read(&mut bytes) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        number.write(bytes.get(..count).unwrap_or_default());
        length += count as u64;
    }
    length.hash(number);
    Ok(())
}

/// The entry of one file, which may not exist yet.
#[derive(Debug)]
pub struct CacheEntry<'a> {
    cache: &'a ModelCache,
    name: String,
}

impl CacheEntry<'_> {
    fn path(&self) -> PathBuf {
        self.cache.folder.join(&self.name).with_extension(WHOLE)
    }

    /// The model, if it is in the cache. A damaged entry is removed.
    pub fn read(&self) -> Option<Model> {
        let path = self.path();
        let file = File::open(&path).ok()?;
        match encoded::read(&mut BufReader::with_capacity(1 << 20, file)) {
            Ok(Ok(model)) => Some(model),
            _ => {
                let _ = fs::remove_file(path);
                None
            }
        }
    }

    /// Writes a model into the cache, unless it is larger than the whole cache may be.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn keep(&self, model: &Model) -> io::Result<()> {
        if encoded::raw_bytes(model) > self.cache.most_bytes {
            return Ok(());
        }
        fs::create_dir_all(&self.cache.folder)?;
        // two processes that read the same file write the same bytes, each to its own file
        let beside = self.cache.folder.join(format!("{}.{}.{PARTIAL}", self.name, std::process::id()));
        let written = File::create(&beside)
            .and_then(|file| encoded::write(Ok(model), &mut BufWriter::with_capacity(1 << 20, file)))
            .and_then(|()| self.put(&beside));
        if written.is_err() {
            let _ = fs::remove_file(&beside);
        }
        written
    }

    /// Renames a complete file to its entry, and makes room for it.
    fn put(&self, beside: &Path) -> io::Result<()> {
        if beside.metadata()?.len() > self.cache.most_bytes {
            return fs::remove_file(beside);
        }
        fs::rename(beside, self.path())?;
        self.cache.make_room(&self.path());
        Ok(())
    }
}
