//! The HTML page: head, navigation, and one section for each view. Without scripts all sections stand below each other.

mod about;
mod case;
mod cluster_map;
mod compare;
mod coverage;
mod findings;
mod icon;
mod overview;
mod pairs;
mod parts;
mod records;
mod scenario;
mod story;
mod triage;
mod zones;

use crate::anchor::Anchors;
use crate::summary::Summary;
use crate::view::SuiteView;
use crate::{data, words};
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
    include_str!("../../assets/tabs.js"),
    include_str!("../../assets/table.js"),
    include_str!("../../assets/map.js"),
    include_str!("../../assets/scene.js"),
    include_str!("../../assets/plots.js"),
    include_str!("../../assets/replay.js"),
    include_str!("../../assets/tuning.js"),
    include_str!("../../assets/main.js"),
    "})();\n",
);

pub use pairs::render as render_pairs;

/// What every section needs.
pub struct Context<'a> {
    /// The suite.
    pub suite: &'a SuiteView,
    /// Its headline numbers.
    pub summary: Summary,
    /// Where each case stands on the page.
    pub anchors: Anchors,
}

/// The page.
pub fn render(suite: &SuiteView) -> String {
    let context = Context { suite, summary: Summary::of(suite), anchors: Anchors::of(suite) };
    let title = format!("{} \u{b7} recrash report", words::clean(&suite.title, 200));
    let body = html! {
        a.skip href="#main" { "Skip to the content" }
        (top(&context))
        main #main tabindex="-1" {
            (overview::section(&context))
            (records::section(&context))
            (findings::section(&context))
            @for (position, case) in suite.cases.iter().enumerate() { (case::section(&context, position, case)) }
            (about::section(&context))
        }
        (keyboard_help())
    };
    document(&title, &suite.generated_by, &body, &data::suite(suite, &context.anchors), SCRIPT)
}

/// A page with its head, its data and its script.
fn document(title: &str, generated_by: &str, body: &Markup, data: &Value, script: &str) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(content_security_policy(script));
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content=(words::clean(generated_by, 80));
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
                (body)
                #live.hidden-text role="status" aria-live="polite" {}
                script type="application/json" id="suite-data" { (PreEscaped(data::embed(data))) }
                script { (PreEscaped(script)) }
            }
        }
    };
    page.into_string()
}

/// Nothing may load, and only the style and the script of this very page may run.
fn content_security_policy(script: &str) -> String {
    format!(
        "default-src 'none'; style-src 'sha256-{}'; script-src 'sha256-{}'; img-src data:; base-uri 'none'; form-action 'none'",
        base64(&Sha256::digest(STYLE.as_bytes())),
        base64(&Sha256::digest(script.as_bytes())),
    )
}

/// Base 64 of RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let at = |position: usize| u32::from(group.get(position).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for position in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * position) & 63) as usize] as char;
            text.push(if position > group.len() { '=' } else { letter });
        }
    }
    text
}

fn top(context: &Context) -> Markup {
    html! {
        header.top {
            .top-inner {
                a.brand href="#overview" aria-label="recrash: to the overview" { (icon::brand()) span { "recrash" } }
                nav aria-label="Report" {
                    a href="#overview" { "Overview" }
                    a href="#records" { "Records & coverage" }
                    a href="#findings" { "Findings" }
                    a href="#about" { "About this run" }
                }
                .jump {
                    button.small #case-previous type="button" title="Previous scenario ( [ )" aria-label="Previous scenario" { (icon::left()) }
                    label.hidden-text for="case-jump" { "Go to a scenario" }
                    select #case-jump {
                        option value="" { "Scenarios\u{2026}" }
                        @for (position, case) in context.suite.cases.iter().enumerate() {
                            option value=(context.anchors.case(position)) { (words::clean(&case.scenario_id, 60)) }
                        }
                    }
                    button.small #case-next type="button" title="Next scenario ( ] )" aria-label="Next scenario" { (icon::right()) }
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
        ("B", "as designed, tuned, side by side"),
        ("F", "follow the ego, or stand still"),
        ("+ \u{2212} 0", "zoom in, zoom out, fit"),
        ("L", "repeat"),
        ("[ ]", "previous and next scenario"),
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
    fn base64_of_the_rfc() {
        let pairs = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (plain, coded) in pairs {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn assets_cannot_close_their_elements() {
        assert!(!STYLE.contains("</") && !SCRIPT.contains("</script") && !SCRIPT.contains("<!--"));
    }
}
