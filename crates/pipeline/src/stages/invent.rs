//! Templates that no record is of: the crash of each is invented, and named so.

use crate::error::PipelineError;
use crate::suite::Suite;
use recrash_model::profile::Tells;
use recrash_model::record::RecordSet;
use recrash_model::selection::{Cluster, Selection};
use recrash_model::template::Template;
use recrash_model::{Diagnostic, Location, Severity};

/// Refuses what a suite that goes by accounts cannot do.
pub(crate) fn check(suite: &Suite) -> Result<(), PipelineError> {
    match suite.options().invent && suite.profile().records.tells == Tells::Accounts {
        true => Err(PipelineError::bad_input(format!(
            "the profile \"{}\" tells crashes by their accounts and invents none; choose one that goes by templates, such as paper",
            suite.profile().name
        ))),
        false => Ok(()),
    }
}

/// Adds a case for every template of the profile that no record is of, as far as the rules can stage it.
pub(super) fn add(selection: &mut Selection, records: &RecordSet) -> Option<Diagnostic> {
    let (staged, unknown): (Vec<Template>, Vec<Template>) =
        selection.coverage.holes_possible.iter().partition(|template| recrash_agents::can_stage(template));
    for template in &staged {
        let lends = |at: &&usize| {
            let alike = records.records[**at].template().map_or(0, |other| alike(template, &other));
            (std::cmp::Reverse(alike), **at)
        };
        let Some(&pick_index) = records.usable.iter().min_by_key(lends) else { break };
        selection.clusters.push(Cluster {
            number: selection.clusters.len() + 1,
            scenario_id: format!("invented-{}", template.slug()),
            template: *template,
            pick: records.records[pick_index].id.clone(),
            pick_index,
            members: Vec::new(),
            radius: 0.0,
            invented: true,
        });
    }
    let message = format!("{} templates that no record is of have an invented crash each", staged.len());
    let hint = match unknown.len() {
        0 => "they stand for no crash that happened: no figure of coverage counts them".to_owned(),
        more => format!("they stand for no crash that happened; {more} more templates cannot be staged by the rules"),
    };
    let remark = Diagnostic::new(Severity::Note, "select.invented", Location::default(), message).with_hint(hint);
    (!staged.is_empty()).then_some(remark)
}

/// How many values two templates share; the road counts most, since it lends the surroundings.
fn alike(a: &Template, b: &Template) -> u32 {
    4 * u32::from(a.road == b.road)
        + u32::from(a.sv == b.sv)
        + u32::from(a.cp == b.cp)
        + u32::from(a.work_zone == b.work_zone)
}
