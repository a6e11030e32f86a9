//! Which units of work of a suite are done: a file of lines (`units.jsonl`) that grows by one line a unit.
//!
//! A line says which unit was made of what, and which files it wrote. The last line of a unit counts. A line that was cut off
//! by the end of the program is dropped: its unit is made again. Before a unit writes its first file, a line says which files
//! it is about to write: where the program ends in between, what it wrote is not taken for a person's edit.

use crate::error::PipelineError;
use crate::files::store::{Store, is_plain_name, read_bytes};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// The file.
const JOURNAL: &str = "units.jsonl";
/// Greatest size of a journal that is read. [bytes]
const MAX_JOURNAL: u64 = 1 << 28;
/// Lines that may be out of date before the file is written anew.
const SPARE_LINES: usize = 256;

/// A finished unit of work: the hash of what went in, and the files that came out.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Unit {
    /// Hash of everything that decided what came out.
    pub inputs: String,
    /// Files, by name.
    pub outputs: BTreeMap<String, Made>,
}

/// A file as a unit wrote it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Made {
    /// SHA-256 of the content.
    pub hash: String,
    /// Size. [bytes]
    pub size: u64,
    /// Time of last change, since 1970. [ns]
    pub changed_ns: u64,
}

/// Files that a unit is about to write; with the SHA-256 of what will stand in those that people may edit.
pub(crate) type Begun = BTreeMap<String, Option<String>>;

/// A line with neither says that the unit is gone.
#[derive(Serialize, Deserialize)]
struct Line {
    unit: String,
    /// The unit is done.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    made: Option<Unit>,
    /// Its work begins.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    writing: Option<Begun>,
}

/// The units of a suite.
#[derive(Debug, Default)]
pub(crate) struct Journal {
    units: BTreeMap<String, Unit>,
    /// Work that began, and of which nothing says that it was done.
    begun: BTreeMap<String, Begun>,
    lines: usize,
}

impl Journal {
    /// Reads the journal of a folder; an empty one where there is none.
    ///
    /// # Errors
    /// It cannot be read, a line in the middle is none, or names a file outside the folder.
    pub fn read(store: &Store) -> Result<Self, PipelineError> {
        let mut journal = Self::default();
        let text = read_text(store)?;
        let damaged = |number: usize, problem: String| lost(store, format!("line {number}: {problem}"));
        let whole = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        for (number, line) in text[..whole].split(|byte| *byte == b'\n').enumerate().filter(|(_, l)| !l.is_empty()) {
            let line: Line = serde_json::from_slice(line).map_err(|error| damaged(number + 1, error.to_string()))?;
            let made = line.made.iter().flat_map(|unit| unit.outputs.keys());
            let mut names = made.chain(line.writing.iter().flat_map(BTreeMap::keys));
            if let Some(name) = names.find(|name| !is_plain_name(name)) {
                return Err(damaged(number + 1, format!("{name:?} is no name of a suite's file")));
            }
            journal.take(line);
        }
        // What was cut off must not become the beginning of the next line.
        if whole < text.len() {
            journal.lines = usize::MAX;
        }
        Ok(journal)
    }

    /// An empty one in the place of one that cannot be read.
    pub fn anew() -> Self {
        Self { lines: usize::MAX, ..Self::default() }
    }

    /// Whether it knows of no work at all.
    pub fn is_empty(&self) -> bool {
        self.units.is_empty() && self.begun.is_empty()
    }

    fn take(&mut self, line: Line) {
        self.lines = self.lines.saturating_add(1);
        match line {
            Line { unit, made: Some(made), .. } => {
                self.begun.remove(&unit);
                self.units.insert(unit, made);
            }
            Line { unit, writing: Some(begun), .. } => {
                self.begun.insert(unit, begun);
            }
            Line { unit, .. } => {
                self.begun.remove(&unit);
                self.units.remove(&unit);
            }
        }
    }

    fn add(&mut self, store: &Store, line: Line) -> Result<(), PipelineError> {
        store.append(JOURNAL, &text_of(&line))?;
        self.take(line);
        Ok(())
    }

    /// Writes the file anew where too much of it is out of date.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn tidy(&mut self, store: &Store) -> Result<(), PipelineError> {
        // One for the beginning and one for the end of each.
        let needed = 2 * self.units.len() + self.begun.len();
        if self.lines <= 2 * needed + SPARE_LINES {
            return Ok(());
        }
        let made = self.units.iter().map(|(unit, made)| done(unit, made.clone()));
        let lines = made.chain(self.begun.iter().map(|(unit, begun)| begins(unit, begun.clone())));
        let text: Vec<u8> = lines.flat_map(|line| text_of(&line)).collect();
        store.write(JOURNAL, &text)?;
        self.lines = self.units.len() + self.begun.len();
        Ok(())
    }

    /// A unit.
    pub fn get(&self, unit: &str) -> Option<&Unit> {
        self.units.get(unit)
    }

    /// What a unit is about to write, where it is not done with it.
    pub fn begun(&self, unit: &str) -> Option<&Begun> {
        self.begun.get(unit)
    }

    /// Names of the units that begin with this, done or begun.
    pub fn beginning_with(&self, prefix: &str) -> Vec<String> {
        let done = self.units.range(prefix.to_owned()..).map(|(name, _)| name);
        let begun = self.begun.range(prefix.to_owned()..).map(|(name, _)| name);
        let done = done.take_while(|name| name.starts_with(prefix));
        let begun = begun.take_while(|name| name.starts_with(prefix));
        done.chain(begun).cloned().collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// Notes that a unit is about to write these files.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn begin(&mut self, store: &Store, unit: &str, files: Begun) -> Result<(), PipelineError> {
        self.add(store, begins(unit, files))
    }

    /// Notes that a unit is done.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn note(&mut self, store: &Store, unit: &str, made: Unit) -> Result<(), PipelineError> {
        self.add(store, done(unit, made))
    }

    /// Takes a unit for one that was made of something else, as long as this program runs.
    pub fn outdate(&mut self, unit: &str) {
        if let Some(made) = self.units.get_mut(unit) {
            made.inputs.clear();
        }
    }

    /// Forgets a unit.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn forget(&mut self, store: &Store, unit: &str) -> Result<(), PipelineError> {
        self.add(store, Line { unit: unit.to_owned(), made: None, writing: None })
    }
}

/// The bytes of the journal; none where there is none.
fn read_text(store: &Store) -> Result<Vec<u8>, PipelineError> {
    let path = store.path(JOURNAL);
    if store.stamp(JOURNAL).is_some() {
        return read_bytes(&path, MAX_JOURNAL).map_err(|error| lost(store, error.to_string()));
    }
    match path.symlink_metadata() {
        Ok(_) => Err(lost(store, "it is no regular file".to_owned())),
        Err(_) => Ok(Vec::new()),
    }
}

/// There is no knowing what people edited.
pub(crate) fn lost(store: &Store, problem: String) -> PipelineError {
    PipelineError::NoJournal { path: store.path(JOURNAL), problem }
}

fn done(unit: &str, made: Unit) -> Line {
    Line { unit: unit.to_owned(), made: Some(made), writing: None }
}

fn begins(unit: &str, files: Begun) -> Line {
    Line { unit: unit.to_owned(), made: None, writing: Some(files) }
}

fn text_of(line: &Line) -> Vec<u8> {
    let mut text = serde_json::to_vec(line).expect("a line serialises");
    text.push(b'\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::store::write_suite_file;

    fn unit(inputs: &str) -> Unit {
        let made = Made { hash: "00".into(), size: 1, changed_ns: 2 };
        Unit { inputs: inputs.into(), outputs: BTreeMap::from([("4-scenarios/a.json".to_owned(), made)]) }
    }

    #[test]
    fn the_last_line_of_a_unit_counts_and_a_cut_off_one_does_not() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::create(folder.path(), write_suite_file).unwrap();
        let mut journal = Journal::read(&store).unwrap();
        journal.note(&store, "design/a", unit("1")).unwrap();
        journal.note(&store, "design/b", unit("2")).unwrap();
        journal.note(&store, "design/a", unit("3")).unwrap();
        journal.forget(&store, "design/b").unwrap();
        store.append(JOURNAL, b"{\"unit\":\"design/c\",\"ma").unwrap();
        let mut again = Journal::read(&store).unwrap();
        assert_eq!(again.get("design/a"), Some(&unit("3")));
        assert_eq!((again.get("design/b"), again.get("design/c")), (None, None));
        again.tidy(&store).unwrap();
        assert_eq!(std::fs::read_to_string(store.path(JOURNAL)).unwrap().lines().count(), 1);
    }

    #[test]
    fn work_that_began_is_known_until_it_is_done_and_when_the_file_is_written_anew() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::create(folder.path(), write_suite_file).unwrap();
        let mut journal = Journal::read(&store).unwrap();
        let files = Begun::from([("4-scenarios/a.json".to_owned(), Some("11".to_owned()))]);
        journal.note(&store, "design/a", unit("1")).unwrap();
        for name in ["design/a", "design/b"] {
            journal.begin(&store, name, files.clone()).unwrap();
        }
        journal.lines = usize::MAX;
        journal.tidy(&store).unwrap();
        let mut again = Journal::read(&store).unwrap();
        assert_eq!(again.beginning_with("design/"), ["design/a", "design/b"]);
        assert_eq!((again.get("design/a"), again.begun("design/a")), (Some(&unit("1")), Some(&files)));
        assert_eq!((again.get("design/b"), again.begun("design/b")), (None, Some(&files)));
        again.note(&store, "design/a", unit("2")).unwrap();
        again.forget(&store, "design/b").unwrap();
        let last = Journal::read(&store).unwrap();
        assert_eq!((last.get("design/a"), last.begun("design/a")), (Some(&unit("2")), None));
        assert_eq!(last.beginning_with("design/"), ["design/a"]);
    }

    #[test]
    fn a_line_that_names_a_file_outside_is_refused_with_its_number() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::create(folder.path(), write_suite_file).unwrap();
        for name in ["../x", "/etc/x", "a/b/c", "a/../../x", "", "a\\b", ".hidden", "a//b"] {
            let made = Made { hash: "00".into(), size: 1, changed_ns: 2 };
            let evil = Unit { inputs: String::new(), outputs: BTreeMap::from([(name.to_owned(), made)]) };
            let begun = begins("tune/a", Begun::from([(name.to_owned(), None)]));
            for line in [done("tune/a", evil), begun] {
                std::fs::write(store.path(JOURNAL), text_of(&line)).unwrap();
                let error = Journal::read(&store).unwrap_err().to_string();
                assert!(error.contains("line 1"), "{name}: {error}");
            }
        }
    }
}
