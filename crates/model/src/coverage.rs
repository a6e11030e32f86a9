//! What of a corpus of crashes a suite covers: incidents counted cell by cell (`docs/models/coverage.md`).

use serde::{Deserialize, Serialize};

/// Readable incidents of a corpus, counted in the cells of several tables.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CorpusCoverage {
    /// All readable incidents.
    pub all: CoverageCounts,
    /// In the order of the page.
    pub tables: Vec<CoverageTable>,
}

/// One way to cut the corpus.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoverageTable {
    /// Name in files and on the command line: `eu-2022-1426`.
    pub id: String,
    /// Name for people.
    pub name: String,
    /// What each cell's values are values of.
    pub axes: Vec<String>,
    /// Cells that the table has, seen or not; those of which a value is not told do not count.
    pub possible: usize,
    /// An incident may stand in several cells, so that cells do not add up to all.
    pub overlapping: bool,
    /// Cells with an incident, and where `possible` are few enough to list, those without.
    pub cells: Vec<CoverageCell>,
    /// Incidents that stand in no cell, by why.
    pub outside: Vec<OutsideCells>,
}

/// One cell.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoverageCell {
    /// One for each axis.
    pub values: Vec<String>,
    /// A value is not told: the cell is none of the table's own, and no hole.
    pub untold: bool,
    /// What of it is told and tested.
    pub counts: CoverageCounts,
}

/// Incidents that stand in no cell of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct OutsideCells {
    /// Why.
    pub why: String,
    /// How many.
    pub counts: CoverageCounts,
}

/// Incidents, each count a part of the one before it, but `failed`, which is a part of `met`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoverageCounts {
    /// Incidents of the corpus whose narrative can be read.
    pub incidents: usize,
    /// Of those, the ones whose own crash can be told: a reconstruction shows every told fact that is checked.
    pub tellable: usize,
    /// Of those, the ones that the suite holds, told so.
    pub told: usize,
    /// Of those, the ones that the system under test drove, coming into the situation of the record.
    pub met: usize,
    /// Of those, the ones that it failed.
    pub failed: usize,
}

/// What a cell lacks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hole {
    /// The corpus has incidents in it, and the suite tells none of them.
    NotTold,
    /// The suite tells some, and the system under test came into the situation of none.
    NotMet,
    /// The corpus has no incident in it.
    NotSeen,
}

impl Hole {
    /// For tables.
    pub fn label(self) -> &'static str {
        match self {
            Self::NotTold => "none in suite",
            Self::NotMet => "none tested",
            Self::NotSeen => "no incident",
        }
    }
}

impl CoverageCounts {
    /// Counts one more incident.
    pub fn add(&mut self, other: Self) {
        self.incidents += other.incidents;
        self.tellable += other.tellable;
        self.told += other.told;
        self.met += other.met;
        self.failed += other.failed;
    }
}

impl CorpusCoverage {
    /// The table of this name.
    pub fn table(&self, id: &str) -> Option<&CoverageTable> {
        self.tables.iter().find(|table| table.id == id)
    }
}

impl CoverageTable {
    /// Cells with at least one incident.
    pub fn seen(&self) -> usize {
        self.count(|counts| counts.incidents > 0)
    }

    /// Cells of which the suite tells at least one incident.
    pub fn told(&self) -> usize {
        self.count(|counts| counts.told > 0)
    }

    /// Cells in whose situation the system under test came at least once.
    pub fn met(&self) -> usize {
        self.count(|counts| counts.met > 0)
    }

    fn count(&self, holds: fn(&CoverageCounts) -> bool) -> usize {
        self.cells.iter().filter(|cell| !cell.untold && holds(&cell.counts)).count()
    }

    /// Cells with this hole, those with the most incidents first.
    pub fn holes(&self, hole: Hole) -> Vec<&CoverageCell> {
        let mut holes: Vec<&CoverageCell> = self.cells.iter().filter(|cell| cell.hole() == Some(hole)).collect();
        holes.sort_by_key(|cell| std::cmp::Reverse(cell.counts.incidents));
        holes
    }

    /// Cells of which no incident is seen; of those, only `cells` of a table that lists all are named.
    pub fn unseen(&self) -> usize {
        self.possible - self.seen()
    }
}

impl CoverageCell {
    /// What is missing; `None` where an incident of the cell was told and tested, and where a value is not told.
    pub fn hole(&self) -> Option<Hole> {
        match self.counts {
            _ if self.untold => None,
            CoverageCounts { incidents: 0, .. } => Some(Hole::NotSeen),
            CoverageCounts { told: 0, .. } => Some(Hole::NotTold),
            CoverageCounts { met: 0, .. } => Some(Hole::NotMet),
            _ => None,
        }
    }

    /// Its values in a row.
    pub fn name(&self) -> String {
        self.values.join(", ")
    }
}
