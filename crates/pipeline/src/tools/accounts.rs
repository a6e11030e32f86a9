//! Accounts as a table of their main facts.

use crate::error::PipelineError;
use crate::files::output::Output;
use crate::files::store::io;
use crate::reading::accounts::coded;
use crate::reading::records::TableFormat;
use recrash_model::account::{Account, Fact, LeftRight, Origin, Party};
use recrash_records::{Column, RecordTable};
use serde::Serialize;

/// Writes accounts as a table of their main facts, a row an incident. Gives the number of rows.
///
/// # Errors
/// The file cannot be written.
pub fn write_accounts(accounts: &[Account], format: TableFormat, output: &Output) -> Result<usize, PipelineError> {
    let table = account_table(accounts);
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

/// Accounts as a table of their main facts, a row an incident.
pub fn account_table(accounts: &[Account]) -> RecordTable {
    let text = |of: &dyn Fn(&Account) -> Option<String>| Column::Text(accounts.iter().map(of).collect());
    let partner = |of: &dyn Fn(&Party) -> Option<String>| -> Column {
        Column::Text(accounts.iter().map(|account| account.partner.as_ref().and_then(of)).collect())
    };
    let whole = |of: &dyn Fn(&Account) -> usize| {
        Column::Whole(accounts.iter().map(|account| i64::try_from(of(account)).ok()).collect())
    };
    let columns = vec![
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
    ];
    RecordTable { columns, rows: accounts.len() }
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
