//! What of a corpus a suite covers, in the cells that assessors ask for. Definitions and sources: `docs/models/coverage.md`.

mod competency;
mod crash;
mod environment;
mod matrix;
mod rules;

use recrash_model::account::{Account, Role, told};
use recrash_model::coverage::{CorpusCoverage, CoverageCell, CoverageCounts, CoverageTable, OutsideCells};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// One readable incident of the corpus, and what the suite does with it.
#[derive(Debug, Clone, Copy)]
pub struct Incident<'a> {
    /// What its reports tell.
    pub account: &'a Account,
    /// A reconstruction shows every told fact that is checked.
    pub tellable: bool,
    /// The suite's scenario that tells it so; `None` where the suite has none.
    pub scenario: Option<Tested>,
}

/// What the system under test did in a scenario.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tested {
    /// It came into the situation of the record.
    pub met: bool,
    /// It failed.
    pub failed: bool,
    /// A signal or a sign stands in the scenario.
    pub signs: bool,
}

impl Incident<'_> {
    /// The same where only a scenario counts in which a signal or a sign stands.
    fn before_signs(self) -> Self {
        Self { scenario: self.scenario.filter(|tested| tested.signs), ..self }
    }

    fn counts(&self) -> CoverageCounts {
        let scenario = self.scenario.filter(|_| self.tellable);
        let met = scenario.is_some_and(|tested| tested.met);
        CoverageCounts {
            incidents: 1,
            tellable: usize::from(self.tellable),
            told: usize::from(scenario.is_some()),
            met: usize::from(met),
            failed: usize::from(met && scenario.is_some_and(|tested| tested.failed)),
        }
    }
}

/// Counts every incident in the cells of every table.
pub fn coverage(incidents: &[Incident<'_>]) -> CorpusCoverage {
    let mut all = CoverageCounts::default();
    for incident in incidents {
        all.add(incident.counts());
    }
    let mut plans = crash::plans();
    plans.push(matrix::plan());
    plans.push(environment::plan());
    plans.push(competency::plan());
    plans.push(scenario_types());
    plans.push(rules::plan());
    CorpusCoverage { all, tables: plans.iter().map(|plan| plan.fill(incidents)).collect() }
}

/// A cell by its values, one for each axis.
type Values = Vec<String>;

/// Where an incident stands.
enum Place {
    /// In these cells; a cell that is named twice counts once.
    In(Vec<Values>),
    /// In none, and why.
    Outside(&'static str),
}

/// Whether a cell is of those that stand before a signal or a sign: one that a report tells and no scene draws covers nothing there.
fn is_of_signs(values: &Values) -> bool {
    let named = |value: &String| value.rsplit(": ").next().is_some_and(|last| SIGNS.contains(&last));
    values.iter().any(named)
}

/// Signals and signs, as values of cells name them.
const SIGNS: [&str; 5] = ["signal", "stop sign", "yield sign", "signals", "stop and yield signs"];

/// A table before anything is counted.
struct Plan {
    id: &'static str,
    name: &'static str,
    axes: Vec<&'static str>,
    /// Cells that are listed whether they are seen or not.
    listed: Vec<Values>,
    /// Cells that there are.
    possible: usize,
    overlapping: bool,
    place: fn(&Account) -> Place,
}

impl Plan {
    /// A table that lists all of its cells.
    fn listing(
        (id, name): (&'static str, &'static str),
        axes: &[&'static str],
        listed: Vec<Values>,
        place: fn(&Account) -> Place,
    ) -> Self {
        Self { id, name, axes: axes.to_vec(), possible: listed.len(), listed, overlapping: false, place }
    }

    /// The same where an incident may stand in several cells.
    fn overlapping(self) -> Self {
        Self { overlapping: true, ..self }
    }

    fn fill(&self, incidents: &[Incident<'_>]) -> CoverageTable {
        let mut cells: BTreeMap<Values, CoverageCounts> = BTreeMap::new();
        let mut outside: BTreeMap<&str, CoverageCounts> = BTreeMap::new();
        for incident in incidents {
            match (self.place)(incident.account) {
                Place::In(values) => {
                    for value in BTreeSet::from_iter(values) {
                        let counts = if is_of_signs(&value) { incident.before_signs() } else { *incident }.counts();
                        cells.entry(value).or_default().add(counts);
                    }
                }
                Place::Outside(why) => outside.entry(why).or_default().add(incident.counts()),
            }
        }
        let cell =
            |(values, counts): (Values, CoverageCounts)| CoverageCell { untold: is_untold(&values), values, counts };
        let listed: Vec<CoverageCell> =
            self.listed.iter().map(|values| cell((values.clone(), cells.remove(values).unwrap_or_default()))).collect();
        // What is not listed is there because it was seen: the most frequent first.
        let mut others: Vec<CoverageCell> = cells.into_iter().map(cell).collect();
        others.sort_by_key(|cell| std::cmp::Reverse(cell.counts.incidents));
        let mut outside: Vec<OutsideCells> =
            outside.into_iter().map(|(why, counts)| OutsideCells { why: why.to_owned(), counts }).collect();
        outside.sort_by_key(|outside| std::cmp::Reverse(outside.counts.incidents));
        CoverageTable {
            id: self.id.to_owned(),
            name: self.name.to_owned(),
            axes: self.axes.iter().map(|&axis| axis.to_owned()).collect(),
            possible: self.possible,
            overlapping: self.overlapping,
            cells: listed.into_iter().chain(others).collect(),
            outside,
        }
    }
}

/// What a value that nobody tells is called.
const NOT_TOLD: &str = "not stated";

/// Whether a value of a cell is not told; of a pair, the value stands behind its axis.
fn is_untold(values: &[String]) -> bool {
    values.iter().any(|value| value.rsplit(": ").next() == Some(NOT_TOLD))
}

/// A value in words: its name in files, without underscores.
fn words<T: Serialize>(value: &T) -> String {
    match serde_json::to_value(value) {
        Ok(serde_json::Value::String(name)) => name.replace('_', " "),
        _ => NOT_TOLD.to_owned(),
    }
}

fn words_or_not_told<T: Serialize>(value: Option<T>) -> String {
    value.map_or_else(|| NOT_TOLD.to_owned(), |value| words(&value))
}

const NOMINAL: &str = "nominal: its own driving among others who kept to theirs";
const CRITICAL: &str = "critical: somebody else's move, or both";
const FAILURE: &str = "failure: the subject vehicle was out of control";

/// The third dimension of the UN guidance: scenario type.
fn scenario_types() -> Plan {
    let listed = [NOMINAL, CRITICAL, FAILURE].map(|name| vec![name.to_owned()]).to_vec();
    Plan::listing(("scenario-type", "Scenario type"), &["type"], listed, |account| {
        use recrash_model::account::Act;
        let name = match told(&account.role) {
            _ if account.sv.did(Act::LoseControl) || account.sv.did(Act::Roll) => FAILURE,
            Some(Role::Initiator) => NOMINAL,
            Some(Role::Responder | Role::Both) => CRITICAL,
            None => return Place::Outside("whose move brought it about is not told"),
        };
        Place::In(vec![vec![name.to_owned()]])
    })
}

#[cfg(test)]
mod tests;
