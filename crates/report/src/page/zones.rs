//! Contact zones on a small outline of each vehicle: what the record ticks, and where the runs touched.

use super::Case;
use crate::view::RunView;
use crate::words;
use maud::{Markup, html};
use recrash_model::metrics::Contact;
use recrash_model::zones::ContactZone;

/// Both vehicles.
pub fn zones(case: Case) -> Markup {
    let pick = case.context.case_records(case.row).next();
    let last = case.view.runs().last().map(|(name, run)| (*name, *run));
    let seen =
        |of: fn(&Contact) -> ContactZone| last.and_then(|(_, run): (_, &RunView)| run.metrics.contact.as_ref()).map(of);
    let run_name = last.map_or("run", |(name, _)| name);
    html! {
        .zones {
            (vehicle("SV (ego)", "ego", pick.map_or(&[][..], |record| &record.sv_zones), seen(|contact| contact.ego_zone), run_name))
            (vehicle("CP (partner)", "partner", pick.map_or(&[][..], |record| &record.cp_zones), seen(|contact| contact.other_zone), run_name))
            ul.zone-key {
                li { span.swatch.said {} " ticked in the record" }
                li { span.swatch.seen {} " touched in the run (" (run_name) ")" }
                li { span.swatch.said.seen {} " both" }
            }
        }
    }
}

/// Place of a zone on a grid of three by three, the front at the top.
fn cell(zone: ContactZone) -> Option<(u32, u32)> {
    Some(match zone {
        ContactZone::FrontLeft => (0, 0),
        ContactZone::Front => (1, 0),
        ContactZone::FrontRight => (2, 0),
        ContactZone::Left => (0, 1),
        ContactZone::Right => (2, 1),
        ContactZone::RearLeft => (0, 2),
        ContactZone::Rear => (1, 2),
        ContactZone::RearRight => (2, 2),
        ContactZone::Top | ContactZone::Bottom => return None,
    })
}

fn vehicle(name: &str, class: &str, said: &[ContactZone], seen: Option<ContactZone>, run_name: &str) -> Markup {
    let told = if said.is_empty() { "none ticked".to_owned() } else { words::zones(said) };
    let touched = seen.map_or("no contact", ContactZone::label);
    html! {
        figure.zone-figure {
            svg.(class) viewBox="0 0 84 132" role="img" aria-label={ (name) ". Record: " (told) ". Run (" (run_name) "): " (touched) "." } {
                @for zone in ContactZone::ALL {
                    @if let Some((column, row)) = cell(zone) {
                        @let (x, width) = [(4, 18), (24, 36), (62, 18)][column as usize];
                        @let (y, height) = [(4, 26), (32, 68), (102, 26)][row as usize];
                        rect.zone.said[said.contains(&zone)].seen[seen == Some(zone)] x=(x) y=(y) width=(width) height=(height) rx="4" { title { (zone.label()) } }
                    }
                }
                rect.body x="20" y="22" width="44" height="88" rx="11" {}
                path.glass d="M25 46 Q42 38 59 46 L56 58 H28z" {}
                path.glass d="M28 92 H56 L58 100 Q42 105 26 100z" {}
                path.nose d="M42 26l6 8h-12z" {}
            }
            figcaption { b { (name) } br; span.muted { "record: " } (told) br; span.muted { "run: " } (touched) }
        }
    }
}
