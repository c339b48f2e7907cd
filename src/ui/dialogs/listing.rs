//! Contents of a folder: read in the background, filtered and sorted.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::SystemTime;

use crate::session::{Background, Wake};
use crate::ui::icons::FileSign;
use crate::ui::state::{DialogForm, FileDialogKind, MESHES};
use freebound_io::{Direction, PROJECT_EXTENSION};

/// Entry of a folder.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub(super) name: String,
    /// Name in lower case, to compare and to search.
    folded: String,
    pub(super) sign: FileSign,
    /// Kind in words.
    pub(super) kind: String,
    /// Size of a file, bytes.
    pub(super) size: Option<u64>,
    pub(super) modified: Option<SystemTime>,
}

impl Entry {
    fn new(name: String, about: Option<&std::fs::Metadata>) -> Self {
        let is_folder = about.is_some_and(std::fs::Metadata::is_dir);
        let (sign, kind) = if is_folder { (FileSign::Folder, "Folder".to_owned()) } else { kind_of(Path::new(&name)) };
        let size = about.filter(|_| !is_folder).map(std::fs::Metadata::len);
        let modified = about.and_then(|about| about.modified().ok());
        Self { folded: name.to_lowercase(), name, sign, kind, size, modified }
    }

    pub(super) fn is_folder(&self) -> bool {
        self.sign == FileSign::Folder
    }
}

/// Sign and kind of a file, by its extension.
fn kind_of(path: &Path) -> (FileSign, String) {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let of = |sign, words: &str| (sign, format!("{} {words}", extension.to_uppercase()));
    match &*extension {
        "" => (FileSign::Other, "File".to_owned()),
        PROJECT_EXTENSION => (FileSign::Project, "Project".to_owned()),
        known if MESHES.contains(&known) => of(FileSign::Mesh, "mesh"),
        _ if FileDialogKind::OpenPicture.form().fits(path) => of(FileSign::Picture, "picture"),
        _ => of(FileSign::Other, "file"),
    }
}

/// Column of the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ListColumn {
    #[default]
    Name,
    Size,
    Date,
    Kind,
}

impl ListColumn {
    pub(super) const ALL: [Self; 4] = [Self::Name, Self::Size, Self::Date, Self::Kind];

    pub(super) const fn title(self) -> &'static str {
        ["Name", "Size", "Date", "Kind"][self as usize]
    }
}

/// Order of the list. Folders come first in any order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ListOrder {
    pub(super) column: ListColumn,
    pub(super) direction: Direction,
}

impl ListOrder {
    /// Order after a click on the head of a column.
    pub(super) fn clicked(self, column: ListColumn) -> Self {
        let direction = match self.direction {
            Direction::Up if column == self.column => Direction::Down,
            _ => Direction::Up,
        };
        Self { column, direction }
    }
}

/// Number of entries that are not listed, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Unlisted {
    /// Files of other kinds, and hidden entries.
    pub(super) of_other_kinds: usize,
    /// Entries that the filter leaves out.
    pub(super) filtered: usize,
}

/// Outcome of reading a folder.
type Read = Result<Vec<Entry>, String>;

/// List of a folder, and what is shown of it.
#[derive(Debug)]
pub(super) struct Listing {
    job: Background<PathBuf, Read>,
    entries: Vec<Entry>,
    /// Places of the shown entries, in their order.
    shown: Vec<usize>,
    pub(super) unlisted: Unlisted,
    pub(super) order: ListOrder,
    /// Words that shown names contain.
    pub(super) filter: String,
    /// True if files of all kinds and hidden entries are shown.
    pub(super) shows_all: bool,
    /// Reason why the folder cannot be listed.
    pub(super) problem: Option<String>,
}

impl Listing {
    pub(super) fn new(wake: &Wake) -> Self {
        Self {
            job: Background::new("list folder", wake),
            entries: Vec::new(),
            shown: Vec::new(),
            unlisted: Unlisted::default(),
            order: ListOrder::default(),
            filter: String::new(),
            shows_all: false,
            problem: None,
        }
    }

    /// Reads a folder in the background. Nothing is listed until then.
    pub(super) fn read(&mut self, folder: &Path) {
        self.entries.clear();
        self.shown.clear();
        self.unlisted = Unlisted::default();
        self.problem = None;
        self.filter.clear();
        let path = folder.to_owned();
        self.job.start(folder.to_owned(), move |stop| entries_of(&path, stop));
    }

    /// True while a folder is read.
    pub(super) fn is_busy(&self) -> bool {
        self.job.is_busy()
    }

    /// Takes the entries once they are read. Call once per frame.
    pub(super) fn poll(&mut self, form: &DialogForm) {
        let Some((_, read)) = self.job.poll() else { return };
        match read.unwrap_or_else(|failure| Err(failure.words("listing"))) {
            Ok(entries) => self.entries = entries,
            Err(error) => self.problem = Some(format!("Cannot list this folder: {error}")),
        }
        self.arrange(form);
    }

    /// Filters and sorts the entries.
    pub(super) fn arrange(&mut self, form: &DialogForm) {
        let filter = self.filter.to_lowercase();
        let words: Vec<&str> = filter.split_whitespace().collect();
        self.unlisted = Unlisted::default();
        let mut shown = Vec::new();
        for (place, entry) in self.entries.iter().enumerate() {
            let is_hidden = entry.name.starts_with('.');
            let is_listed = !is_hidden && (entry.is_folder() || form.fits(Path::new(&entry.name)));
            if !self.shows_all && !is_listed {
                self.unlisted.of_other_kinds += 1;
            } else if words.iter().all(|word| entry.folded.contains(word)) {
                shown.push(place);
            } else {
                self.unlisted.filtered += 1;
            }
        }
        let (entries, ListOrder { column, direction }) = (&self.entries, self.order);
        shown.sort_by(|&a, &b| {
            let [a, b] = [a, b].map(|place| &entries[place]);
            let by_column = match column {
                ListColumn::Name => a.folded.cmp(&b.folded),
                ListColumn::Size => a.size.cmp(&b.size),
                ListColumn::Date => a.modified.cmp(&b.modified),
                ListColumn::Kind => a.kind.cmp(&b.kind),
            };
            let by_column = if direction == Direction::Down { by_column.reverse() } else { by_column };
            let by_name = || a.folded.cmp(&b.folded).then_with(|| a.name.cmp(&b.name));
            b.is_folder().cmp(&a.is_folder()).then(by_column).then_with(by_name)
        });
        self.shown = shown;
    }

    /// Number of shown entries.
    pub(super) fn len(&self) -> usize {
        self.shown.len()
    }

    /// Shown entry in a row.
    pub(super) fn row(&self, row: usize) -> Option<&Entry> {
        self.shown.get(row).map(|&place| &self.entries[place])
    }

    /// Row of the entry with a name.
    pub(super) fn row_of(&self, name: &str) -> Option<usize> {
        self.shown.iter().position(|&place| self.entries[place].name == name)
    }
}

/// Entries of a folder, in any order. Stops early once `stop` is set.
fn entries_of(folder: &Path, stop: &AtomicBool) -> Read {
    let read = std::fs::read_dir(folder).map_err(|error| error.to_string())?;
    let wanted = read.take_while(|_| !stop.load(Ordering::Relaxed)).flatten();
    let entry = |entry: std::fs::DirEntry| {
        // Follows links: a link to a folder is a folder.
        let about = std::fs::metadata(entry.path()).ok();
        Entry::new(entry.file_name().to_string_lossy().into_owned(), about.as_ref())
    };
    Ok(wanted.map(entry).collect())
}

/// Size of a file in words, with three digits at most.
pub(super) fn size_words(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["kB", "MB", "GB", "TB"];
    if bytes < 1000 {
        return format!("{bytes} B");
    }
    let mut size = bytes as f64 / 1e3;
    let mut unit = 0;
    while size >= 999.5 && unit + 1 < UNITS.len() {
        size /= 1e3;
        unit += 1;
    }
    let digits = usize::from(size < 9.95);
    format!("{size:.digits$} {}", UNITS[unit])
}

/// Time of a change in words: its age within a week, else its date (UTC).
pub(super) fn date_words(modified: SystemTime, now: SystemTime) -> String {
    const MINUTE: u64 = 60;
    const HOUR: u64 = 60 * MINUTE;
    const DAY: u64 = 24 * HOUR;
    let age = now.duration_since(modified).unwrap_or_default().as_secs();
    match age {
        ..MINUTE => "just now".to_owned(),
        MINUTE..HOUR => format!("{} min ago", age / MINUTE),
        HOUR..DAY => format!("{} h ago", age / HOUR),
        _ if age < 2 * DAY => "yesterday".to_owned(),
        _ if age < 7 * DAY => format!("{} days ago", age / DAY),
        _ => date_of_day(modified.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_secs() / DAY),
    }
}

/// Date of a day counted from 1970-01-01, as "2026-11-27". Counts in years that begin in March, so that the leap day is
/// the last of its year.
fn date_of_day(day: u64) -> String {
    const DAYS_OF_400_YEARS: u64 = 146_097;
    const DAYS_OF_100_YEARS: u64 = 36_524;
    const DAYS_OF_4_YEARS: u64 = 1_461;
    // Days since 0000-03-01.
    let day = day + 719_468;
    let (era, in_era) = (day / DAYS_OF_400_YEARS, day % DAYS_OF_400_YEARS);
    let leap_days = in_era / (DAYS_OF_4_YEARS - 1) + in_era / (DAYS_OF_400_YEARS - 1);
    let year_in_era = (in_era - leap_days + in_era / DAYS_OF_100_YEARS) / 365;
    let in_year = in_era - (365 * year_in_era + year_in_era / 4 - year_in_era / 100);
    // Five months from March on have 153 days.
    let months = (5 * in_year + 2) / 153;
    let day_of_month = in_year - (153 * months + 2) / 5 + 1;
    let month = if months < 10 { months + 3 } else { months - 9 };
    let year = 400 * era + year_in_era + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day_of_month:02}")
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_size_has_three_digits_and_its_unit() {
        let expected = [
            (0, "0 B"),
            (999, "999 B"),
            (1_000, "1.0 kB"),
            (9_960, "10 kB"),
            (999_499, "999 kB"),
            (999_500, "1.0 MB"),
            (12_345_678, "12 MB"),
            (4_000_000_000, "4.0 GB"),
        ];
        for (bytes, words) in expected {
            assert_eq!(size_words(bytes), words);
        }
        assert!(size_words(u64::MAX).ends_with("TB"));
    }

    #[test]
    fn days_have_their_dates_through_leap_years() {
        let expected = [
            (0, "1970-01-01"),
            (58, "1970-02-28"),
            (59, "1970-03-01"),
            (789, "1972-02-29"),
            (11_016, "2000-02-29"),
            (11_017, "2000-03-01"),
            (20_784, "2026-11-27"),
        ];
        for (day, date) in expected {
            assert_eq!(date_of_day(day), date);
        }
        let now = SystemTime::UNIX_EPOCH + Duration::from_hours(24 * 20_784);
        let ago = |seconds| date_words(now - Duration::from_secs(seconds), now);
        assert_eq!(
            [ago(3), ago(3_599), ago(90_000), ago(86_400 * 8)],
            ["just now", "59 min ago", "yesterday", "2026-11-19"]
        );
        assert_eq!(date_words(now + Duration::from_secs(9), now), "just now");
    }

    #[test]
    fn a_kind_follows_the_extension() {
        let signs = ["a.OBJ", "b.png", "c.freebound", "d.pdf", "e"].map(|name| kind_of(Path::new(name)).0);
        assert_eq!(signs, [FileSign::Mesh, FileSign::Picture, FileSign::Project, FileSign::Other, FileSign::Other]);
    }
}
