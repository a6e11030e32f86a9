//! Which units of work of a suite are done: a file of lines (`units.jsonl`) that grows by one line a unit.
//!
//! A line says which unit was made of what, and which files it wrote. The last line of a unit counts. A line that was cut off
//! by the end of the program is dropped: its unit is made again.

use crate::error::PipelineError;
use crate::files::store::{Store, is_plain_name};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The file.
const JOURNAL: &str = "units.jsonl";
/// Greatest size of a journal that is read. [bytes]
const MAX_JOURNAL: usize = 1 << 28;
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

#[derive(Serialize, Deserialize)]
struct Line {
    unit: String,
    /// Absent where the unit is gone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    made: Option<Unit>,
}

/// The units of a suite.
#[derive(Debug, Default)]
pub(crate) struct Journal {
    units: BTreeMap<String, Unit>,
    lines: usize,
}

impl Journal {
    /// Reads the journal of a folder; an empty one where there is none.
    ///
    /// # Errors
    /// A line in the middle is none, or names a file outside the folder.
    pub fn read(store: &Store) -> Result<Self, PipelineError> {
        let mut journal = Self::default();
        let text = store.read_or_empty(JOURNAL);
        let damaged = |number: usize, problem: String| PipelineError::Damaged {
            path: store.path(JOURNAL),
            problem: format!("line {number}: {problem}"),
        };
        if text.len() > MAX_JOURNAL {
            return Err(damaged(0, format!("{} bytes are more than a journal has", text.len())));
        }
        let whole = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        for (number, line) in text[..whole].split(|byte| *byte == b'\n').enumerate().filter(|(_, l)| !l.is_empty()) {
            let line: Line = serde_json::from_slice(line).map_err(|error| damaged(number + 1, error.to_string()))?;
            let names = line.made.iter().flat_map(|unit| unit.outputs.keys());
            if let Some(name) = names.into_iter().find(|name| !is_plain_name(name)) {
                return Err(damaged(number + 1, format!("{name:?} is no name of a suite's file")));
            }
            journal.lines += 1;
            match line.made {
                Some(unit) => journal.units.insert(line.unit, unit),
                None => journal.units.remove(&line.unit),
            };
        }
        // What was cut off must not become the beginning of the next line.
        if whole < text.len() {
            journal.lines = usize::MAX;
        }
        Ok(journal)
    }

    /// Writes the file anew where too much of it is out of date.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn tidy(&mut self, store: &Store) -> Result<(), PipelineError> {
        if self.lines <= 2 * self.units.len() + SPARE_LINES {
            return Ok(());
        }
        let mut text = Vec::new();
        for (unit, made) in &self.units {
            text.extend(line(unit, Some(made)));
        }
        store.write(JOURNAL, &text)?;
        self.lines = self.units.len();
        Ok(())
    }

    /// A unit.
    pub fn get(&self, unit: &str) -> Option<&Unit> {
        self.units.get(unit)
    }

    /// Names of the units that begin with this.
    pub fn beginning_with(&self, prefix: &str) -> Vec<String> {
        self.units
            .range(prefix.to_owned()..)
            .map(|(name, _)| name)
            .take_while(|n| n.starts_with(prefix))
            .cloned()
            .collect()
    }

    /// Notes that a unit is done.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn note(&mut self, store: &Store, unit: &str, made: Unit) -> Result<(), PipelineError> {
        store.append(JOURNAL, &line(unit, Some(&made)))?;
        self.lines = self.lines.saturating_add(1);
        self.units.insert(unit.to_owned(), made);
        Ok(())
    }

    /// Forgets a unit, and gives it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn forget(&mut self, store: &Store, unit: &str) -> Result<Option<Unit>, PipelineError> {
        let gone = self.units.remove(unit);
        if gone.is_some() {
            store.append(JOURNAL, &line(unit, None))?;
            self.lines = self.lines.saturating_add(1);
        }
        Ok(gone)
    }
}

fn line(unit: &str, made: Option<&Unit>) -> Vec<u8> {
    let line = Line { unit: unit.to_owned(), made: made.cloned() };
    let mut text = serde_json::to_vec(&line).expect("a line serialises");
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
    fn a_line_that_names_a_file_outside_is_refused_with_its_number() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::create(folder.path(), write_suite_file).unwrap();
        for name in ["../x", "/etc/x", "a/b/c", "a/../../x", "", "a\\b", ".hidden", "a//b"] {
            let made = Made { hash: "00".into(), size: 1, changed_ns: 2 };
            let evil = Unit { inputs: String::new(), outputs: BTreeMap::from([(name.to_owned(), made)]) };
            std::fs::write(store.path(JOURNAL), line("tune/a", Some(&evil))).unwrap();
            let error = Journal::read(&store).unwrap_err().to_string();
            assert!(error.contains("line 1"), "{name}: {error}");
        }
    }
}
