//! Remarks about single cells, gathered so that a thousand equal ones become one diagnostic with a count.

use crate::text::excerpt;
use recrash_model::{Diagnostic, Location, Severity};
use std::collections::BTreeMap;

/// Most different texts listed by one kind of remark on one column; the rest is counted.
const MOST_TEXTS: usize = 20;

/// A kind of remark about a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Remark {
    /// A code that is in no code table.
    UnlistedCode,
    /// A cell that should hold a number, a date, a time or a tick.
    Unreadable,
}

#[derive(Debug, Default)]
struct Seen {
    texts: BTreeMap<String, (u64, u64)>,
    more: u64,
}

/// Remarks about the cells of one file.
#[derive(Debug, Default)]
pub struct Notes {
    by_column: BTreeMap<(Remark, &'static str), Seen>,
    windows_1252_cells: u64,
    mended_narratives: u64,
}

impl Notes {
    /// Remembers one cell.
    pub fn add(&mut self, remark: Remark, column: &'static str, text: &str, row: u64) {
        let seen = self.by_column.entry((remark, column)).or_default();
        let text = excerpt(text);
        let room = seen.texts.len() < MOST_TEXTS;
        match seen.texts.get_mut(&text) {
            Some((count, _)) => *count += 1,
            None if room => {
                seen.texts.insert(text, (1, row));
            }
            None => seen.more += 1,
        }
    }

    /// Remembers a cell that was no UTF-8.
    pub fn add_windows_1252(&mut self) {
        self.windows_1252_cells += 1;
    }

    /// Remembers a narrative with characters that were encoded twice.
    pub fn add_mended(&mut self) {
        self.mended_narratives += 1;
    }

    /// The diagnostics, by column.
    pub fn diagnostics(&self, file: &str) -> Vec<Diagnostic> {
        let mut all = Vec::new();
        for ((remark, column), seen) in &self.by_column {
            all.push(seen.diagnostic(*remark, column, file));
        }
        let in_file = || Location { file: Some(file.to_owned()), ..Location::default() };
        if self.windows_1252_cells > 0 {
            let message = format!("{} cells are no UTF-8 and were read as Windows-1252", self.windows_1252_cells);
            all.push(Diagnostic::new(Severity::Note, "records.encoding", in_file(), message));
        }
        if self.mended_narratives > 0 {
            let message =
                format!("{} narratives held characters that were encoded twice; mended", self.mended_narratives);
            all.push(Diagnostic::new(Severity::Note, "records.encoded-twice", in_file(), message));
        }
        all
    }
}

impl Seen {
    fn diagnostic(&self, remark: Remark, column: &str, file: &str) -> Diagnostic {
        let total: u64 = self.more + self.texts.values().map(|(count, _)| count).sum::<u64>();
        let mut listed: Vec<String> = self
            .texts
            .iter()
            .map(|(text, (count, row))| format!("\"{text}\" x {count} (first in row {row})"))
            .collect();
        if self.more > 0 {
            listed.push(format!("and {} more cells", self.more));
        }
        let (severity, code, what, hint) = match remark {
            Remark::UnlistedCode => (
                Severity::Note,
                "records.unlisted-code",
                "cells hold a code that is in no code table",
                "kept as text; such a record matches no template",
            ),
            Remark::Unreadable => {
                (Severity::Warning, "records.unreadable-cell", "cells could not be read", "taken as empty")
            }
        };
        let location = Location { file: Some(file.to_owned()), column: Some(column.to_owned()), ..Location::default() };
        Diagnostic::new(severity, code, location, format!("{total} {what}: {}", listed.join(", "))).with_hint(hint)
    }
}
