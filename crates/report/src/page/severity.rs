//! How bad the contacts of a case are, with the harm that the record itself reports below.

use super::{Case, parts};
use crate::view::RunView;
use crate::words::{self, fixed};
use maud::{Markup, html};
use recrash_model::record::{CrashRecord, OfVehicles};
use recrash_model::severity::{InjuryRisk, Severity, Suffered};

/// The contact of each run, and what the record says.
pub fn of_case(case: Case) -> Markup {
    let runs = case.view.runs();
    let contacts: Vec<(&str, &RunView, &Severity)> =
        runs.into_iter().filter_map(|(name, run)| Some((name, run, run.run.severity.as_ref()?))).collect();
    if contacts.is_empty() {
        return html! {};
    }
    let told = case.row.told.as_ref();
    let record = case.context.case_records(case.row).find(|record| Some(&record.id) == told);
    html! {
        details.severity {
            summary { "Severity of the contact" @if let Some((_, _, worst)) = contacts.last() { ": delta-v of the ego " (number(worst.first.delta_v_mps)) "\u{a0}m/s, of the " (worst.other()) " " (number(worst.second.delta_v_mps)) "\u{a0}m/s" } }
            .table-wrap { table.plain {
                caption.hidden-text { "What the first contact of each run does to both" }
                thead { tr { th scope="col" { "Run" } th scope="col" { "Who" } th.right scope="col" { "Speed at the contact" } th.right scope="col" { "Delta-v" } th.right scope="col" title="as on a clock, 12 straight ahead" { "Force from" } th scope="col" { "Risks to one person" } } }
                tbody { @for (name, run, severity) in &contacts {
                    (side(&words::capital(name), "ego", &severity.first))
                    (side("", run.metrics.contact.as_ref().map_or(severity.other(), |contact| contact.id.as_str()), &severity.second))
                } }
            } }
            @match record { Some(record) => (reported(record)), None => p.muted { "No record is told, so none reports any harm." } }
            p.muted.small { "By momentum with masses by kind, and published curves, each for the contacts that it covers: docs/models/severity.md. Where a speed is not told, the reconstruction assumes one." }
        }
    }
}

fn number(value: f64) -> String {
    fixed(value, 1).unwrap_or_default()
}

fn side(run: &str, who: &str, suffered: &Suffered) -> Markup {
    html! {
        tr {
            th scope="row" { (run) }
            td { (words::clean(who, 40)) }
            td.right.number { (number(suffered.impact_speed_mps)) "\u{a0}m/s" }
            td.right.number { (number(suffered.delta_v_mps)) "\u{a0}m/s" }
            td.right.number { @match suffered.force_clock { Some(hour) => { (hour) " o'clock" }, None => (parts::missing("there is no force")) } }
            td { @if suffered.risks.is_empty() { (parts::missing("no published curve covers it")) } @else { (risks(&suffered.risks)) } }
        }
    }
}

fn risks(risks: &[InjuryRisk]) -> Markup {
    html! {
        @for (i, risk) in risks.iter().enumerate() {
            @if i > 0 { ", " }
            (risk.outcome.label()) " " span.number { (number(100.0 * risk.probability)) "\u{a0}%" } span.muted { " (" (risk.curve.source()) ")" }
        }
    }
}

fn reported(record: &CrashRecord) -> Markup {
    let of = |vehicles: OfVehicles| {
        let word = |known: Option<bool>| known.map_or("unknown", |yes| if yes { "yes" } else { "no" });
        format!("subject vehicle {}, partner {}", word(vehicles.sv), word(vehicles.cp))
    };
    let injury = words::coded(&record.severity, |injury| words::name(&injury)).unwrap_or_else(str::to_owned);
    html! {
        p { b { "The record " span.mono { (words::clean(&record.id.to_string(), 60)) } " reports: " } "injury " (injury) "; towed: " (of(record.towed)) "; air bags: " (of(record.airbags)) "." }
    }
}
