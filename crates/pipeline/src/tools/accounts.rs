//! Accounts as a table of their main facts.

use crate::error::PipelineError;
use crate::files::output::Output;
use crate::files::store::io;
use crate::reading::accounts::coded;
use crate::reading::records::TableFormat;
use recrash_model::account::{Account, Fact, LeftRight, Origin, Party};
use recrash_model::incident::Incident;
use recrash_model::record::{Severity, YearMonth};
use recrash_records::{Column, RecordTable};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Writes accounts as a table of their main facts, a row an incident. Gives the number of rows.
///
/// # Errors
/// The file cannot be written.
pub fn write_accounts(
    accounts: &[Account],
    columns: &ReportedColumns,
    format: TableFormat,
    output: &Output,
) -> Result<usize, PipelineError> {
    let table = account_table(accounts, columns);
    match format {
        TableFormat::Csv => {
            let failed = |source| io("write", output.name(), source);
            let mut begun = output.begin()?;
            table.write_csv(&mut begun).map_err(failed)?;
            begun.finish().map_err(failed)?;
        }
        #[cfg(feature = "parquet")]
        TableFormat::Parquet => output.write(&table.to_parquet())?,
    }
    Ok(table.rows)
}

/// What the columns of the speaking reports say, by incident: what an account does not hold, since no word tells it.
pub type ReportedColumns = BTreeMap<String, Reported>;

/// What the columns of a report say beside its narrative.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Reported {
    entity: String,
    when: Option<YearMonth>,
    sv_speed_mps: Option<f64>,
    posted_speed_mps: Option<f64>,
    severity: Option<Severity>,
}

/// The columns of the report that speaks for each incident.
pub fn reported_columns(incidents: &[Incident]) -> ReportedColumns {
    let of = |incident: &Incident| {
        let record = &incident.spoken()?.record;
        let reported = Reported {
            entity: record.entity.clone(),
            when: record.when,
            sv_speed_mps: record.sv_speed_mps,
            posted_speed_mps: record.posted_speed_mps,
            severity: record.severity.known(),
        };
        Some((incident.id.clone(), reported))
    };
    incidents.iter().filter_map(of).collect()
}

/// Accounts as a table of their main facts, a row an incident. `docs/tables.md` has the columns.
pub fn account_table(accounts: &[Account], columns: &ReportedColumns) -> RecordTable {
    let reported = reported_cells(accounts, columns);
    let columns = fact_columns(accounts).into_iter().chain(reported).collect();
    RecordTable { columns, rows: accounts.len() }
}

fn reported_cells(accounts: &[Account], reported: &ReportedColumns) -> [(&'static str, Column); 6] {
    let of = || accounts.iter().map(|account| reported.get(&account.incident));
    let month = |part: fn(YearMonth) -> i64| Column::Whole(of().map(|each| each?.when.map(part)).collect());
    [
        ("entity", Column::Text(of().map(|each| Some(each?.entity.clone()).filter(|name| !name.is_empty())).collect())),
        ("year", month(|when| i64::from(when.year))),
        ("month", month(|when| i64::from(when.month))),
        ("sv_speed_mps", Column::Number(of().map(|each| each?.sv_speed_mps).collect())),
        ("posted_speed_mps", Column::Number(of().map(|each| each?.posted_speed_mps).collect())),
        ("severity", Column::Text(of().map(|each| each?.severity.map(|harm| coded(&harm))).collect())),
    ]
}

/// What narratives and columns together tell.
fn fact_columns(accounts: &[Account]) -> Vec<(&'static str, Column)> {
    let text = |of: &dyn Fn(&Account) -> Option<String>| Column::Text(accounts.iter().map(of).collect());
    let partner = |of: &dyn Fn(&Party) -> Option<String>| -> Column {
        Column::Text(accounts.iter().map(|account| account.partner.as_ref().and_then(of)).collect())
    };
    let whole = |of: &dyn Fn(&Account) -> usize| {
        Column::Whole(accounts.iter().map(|account| i64::try_from(of(account)).ok()).collect())
    };
    vec![
        ("incident", text(&|account| Some(account.incident.clone()))),
        ("report", text(&|account| Some(account.report.report_id.clone()))),
        ("version", whole(&|account| account.report.version as usize)),
        ("reports", whole(&|account| account.reports.len())),
        ("crash_type", text(&|account| name(&account.crash_type))),
        ("role", text(&|account| name(&account.role))),
        ("striker", text(&|account| name(&account.striker))),
        ("driver", text(&|account| name(&account.driver))),
        ("scenario", text(&|account| name(&account.scenario))),
        ("place", text(&|account| name(&account.place.kind))),
        ("sv_state", text(&|account| name(&account.sv.state))),
        ("sv_reasons", text(&|account| list(&account.sv.reasons))),
        ("sv_movement", text(&|account| name(&account.sv.movement))),
        ("sv_acts", text(&|account| acts(&account.sv))),
        ("sv_zones", text(&|account| list(&account.sv.zones))),
        ("cp_kind", partner(&|party| name(&party.kind))),
        ("cp_state", partner(&|party| name(&party.state))),
        ("cp_movement", partner(&|party| name(&party.movement))),
        ("cp_acts", partner(&acts)),
        ("cp_zones", partner(&|party| list(&party.zones))),
        ("cp_from", text(&|account| account.came_from.as_ref().map(|from| origin(from.value)))),
        ("order", text(&|account| name(&account.order))),
        ("others", whole(&|account| account.others.len())),
        ("contradictions", whole(&|account| account.contradictions.len())),
        ("words", whole(&|account| account.words as usize)),
    ]
}

fn name<T: Serialize>(fact: &Option<Fact<T>>) -> Option<String> {
    fact.as_ref().map(|fact| coded(&fact.value))
}

fn list<T: Serialize>(facts: &[Fact<T>]) -> Option<String> {
    let all: Vec<String> = facts.iter().map(|fact| coded(&fact.value)).collect();
    (!all.is_empty()).then(|| all.join(";"))
}

fn acts(party: &Party) -> Option<String> {
    let all: Vec<String> = party
        .acts
        .iter()
        .filter(|fact| !fact.after_contact)
        .map(|fact| match fact.side {
            Some(side) => format!("{}_{}", coded(&fact.act), coded(&side)),
            None => coded(&fact.act),
        })
        .collect();
    (!all.is_empty()).then(|| all.join(";"))
}

/// An origin in one word or two.
fn origin(origin: Origin) -> String {
    let sided = |name: &str, side: Option<LeftRight>| match side {
        Some(side) => format!("{name}_{}", coded(&side)),
        None => name.to_owned(),
    };
    match origin {
        Origin::Beside { side } => sided("beside", Some(side)),
        Origin::Cross { side } => sided("cross", Some(side)),
        Origin::Stall { side } => sided("stall", side),
        Origin::Driveway { side } => sided("driveway", side),
        Origin::Parked { side } => sided("parked", side),
        Origin::Sidewalk { side } => sided("sidewalk", side),
        plain => coded(&plain),
    }
}
