//! The HTML page: head, navigation, and one section for each view of the suite. A scenario's section comes from its own file
//! when it is looked at. Without scripts all sections of the suite stand below each other.

mod about;
mod case;
mod cluster_map;
mod compare;
mod corpus;
mod coverage;
mod findings;
mod icon;
mod overview;
mod pairs;
mod parts;
mod records;
mod scenario;
mod severity;
mod story;
mod triage;
mod types;
mod zones;

use crate::search::ToldRecords;
use crate::summary::Summary;
use crate::view::{CaseContext, CaseRow, CaseView, SuiteView};
use crate::{data, words};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::Value;
use sha2::{Digest, Sha256};

const STYLE: &str = concat!(
    include_str!("../../assets/base.css"),
    include_str!("../../assets/parts.css"),
    include_str!("../../assets/case.css"),
);

const SCRIPT: &str = concat!(
    "'use strict';\n(() => {\n",
    include_str!("../../assets/data.js"),
    include_str!("../../assets/cases.js"),
    include_str!("../../assets/tabs.js"),
    include_str!("../../assets/table.js"),
    include_str!("../../assets/map.js"),
    include_str!("../../assets/scene.js"),
    include_str!("../../assets/plots.js"),
    include_str!("../../assets/replay.js"),
    include_str!("../../assets/facts.js"),
    include_str!("../../assets/tuning.js"),
    include_str!("../../assets/main.js"),
    "})();\n",
);

/// Runs before anything is drawn, so that rows that nobody sees yet are never laid out.
const FIRST_SCRIPT: &str = "document.documentElement.classList.add('js');";

pub use case::file as case_file;
pub use pairs::render as render_pairs;

/// What every section needs.
pub struct Context<'a> {
    /// The suite.
    pub suite: &'a SuiteView,
    /// Its headline numbers.
    pub summary: Summary,
    /// The record that each case tells.
    pub told: ToldRecords<'a>,
}

/// What every part of a case's section needs.
#[derive(Clone, Copy)]
pub struct Case<'a> {
    /// What belongs to the suite.
    pub context: CaseContext<'a>,
    /// What the tables say of it.
    pub row: &'a CaseRow,
    /// Everything else.
    pub view: &'a CaseView,
}

/// The page.
pub fn render(suite: &SuiteView) -> String {
    let context = Context { suite, summary: Summary::of(suite), told: ToldRecords::of(suite) };
    let title = format!("{} \u{b7} recrash report", words::clean(&suite.title, 200));
    let body = html! {
        a.skip href="#main" { "Skip to the content" }
        (top())
        main #main tabindex="-1" {
            (overview::section(&context))
            (records::section(&context))
            (findings::section(&context))
            (about::section(&context))
        }
        (keyboard_help())
    };
    let data = data::suite(suite, &context.told, &cluster_map::shown(suite));
    document(&title, &suite.generated_by, &body, &data, SCRIPT, Cases::Beside)
}

/// Whether a page reads files of cases from beside it.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cases {
    /// It does.
    Beside,
    /// Everything stands in the page.
    Inside,
}

/// A page with its head, its data and its script.
fn document(title: &str, generated_by: &str, body: &Markup, data: &Value, script: &str, cases: Cases) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                @for policy in policies(script, cases) { meta http-equiv="Content-Security-Policy" content=(policy); }
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(words::clean(generated_by, 80));
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
                script { (PreEscaped(FIRST_SCRIPT)) }
            }
            body {
                (icon::sprite())
                (body)
                #live.hidden-text role="status" aria-live="polite" {}
                script type="application/json" id="suite-data" { (PreEscaped(data::embed(data))) }
                script { (PreEscaped(script)) }
            }
        }
    };
    page.into_string()
}

/// What may load and run; a browser holds a page to every policy.
///
/// The first: nothing loads, and only the style and the scripts of this very page run, by their hashes. Where cases stand in
/// files, `strict-dynamic` adds the scripts that those scripts themselves ask for: the page's script asks for files of
/// `report/` only, by names that the page holds; a script that text of a record or a model had smuggled into markup is
/// asked for by no script and does not run. No name of a place is trusted for its own sake, so the page works alike from a
/// disk, where a file has no host that a policy could name, and from a server.
///
/// The second keeps what is asked for at home: files beside the page, on the same disk or server. Nothing comes from a
/// network that the page itself did not come from.
fn policies(script: &str, cases: Cases) -> Vec<String> {
    let hash = |text: &str| format!("'sha256-{}'", BASE64.encode(Sha256::digest(text.as_bytes())));
    let scripts = format!("{} {}", hash(FIRST_SCRIPT), hash(script));
    let dynamic = if cases == Cases::Beside { " 'strict-dynamic'" } else { "" };
    let mut policies = vec![format!(
        "default-src 'none'; style-src {}; script-src {scripts}{dynamic}; img-src data:; base-uri 'none'; form-action 'none'",
        hash(STYLE),
    )];
    if cases == Cases::Beside {
        policies.push(format!("script-src 'self' file: {scripts}"));
    }
    policies
}

fn top() -> Markup {
    html! {
        header.top {
            .top-inner {
                a.brand href="#overview" aria-label="recrash: to the overview" { (icon::brand()) span { "recrash" } }
                nav aria-label="Report" {
                    a href="#overview" aria-current="page" { "Overview" }
                    a href="#records" { "Records & coverage" }
                    a href="#findings" { "Findings" }
                    a href="#about" { "About this run" }
                }
                .jump {
                    button.small #case-find type="button" title="Find a scenario ( / )" aria-label="Find a scenario" { (icon::search()) }
                    button.small #case-previous type="button" title="Previous scenario of the table ( [ )" aria-label="Previous scenario of the table" { (icon::left()) }
                    span #case-place.muted.number { }
                    button.small #case-next type="button" title="Next scenario of the table ( ] )" aria-label="Next scenario of the table" { (icon::right()) }
                    button.small #help-open type="button" title="Keyboard shortcuts ( ? )" aria-label="Keyboard shortcuts" { "?" }
                }
            }
        }
    }
}

fn keyboard_help() -> Markup {
    let keys = [
        ("Space", "play or pause"),
        ("\u{2190} \u{2192}", "one step of 0.1 s back or on; with Shift one second"),
        ("Home, End", "to the start, to the end"),
        ("M", "to the moment of the least gap"),
        (", .", "to the event before, to the next one: handover, contact, least gap, hard braking, end"),
        ("B", "the next run, or two side by side"),
        ("F", "follow the ego, or stand still"),
        ("+ \u{2212} 0", "zoom in, zoom out, fit"),
        ("L", "repeat"),
        ("[ ]", "previous and next scenario of the table, as it is sorted and filtered"),
        ("/", "search the table of scenarios"),
        ("?", "this list"),
    ];
    html! {
        dialog #help aria-labelledby="help-title" {
            h2 #help-title { "Keyboard" }
            dl.keys { @for (key, what) in keys { dt { kbd { (key) } } dd { (what) } } }
            form method="dialog" { button type="submit" { "Close" } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn assets_cannot_close_their_elements() {
        assert!(!STYLE.contains("</") && !SCRIPT.contains("</script") && !SCRIPT.contains("<!--"));
    }

    #[test]
    fn only_a_page_with_cases_beside_it_may_load_and_only_from_there() {
        let (beside, inside) = (policies(SCRIPT, Cases::Beside), policies(SCRIPT, Cases::Inside));
        assert!(beside[0].starts_with("default-src 'none'") && beside[0].contains("'strict-dynamic'"));
        assert!(beside[1].starts_with("script-src 'self' file: 'sha256-"));
        assert_eq!(inside.len(), 1);
        assert!(!inside[0].contains("dynamic") && !inside[0].contains("self"));
        assert!(!beside.concat().contains("unsafe") && !beside.concat().contains("http"));
    }
}
