//! Whose trailer is told to have touched.

use crate::told::rig::Rig;
use crate::told::side::Side;
use recrash_model::account::{ContactState, Origin, Party, Source, told};

/// Whether it is told that the trailer touched: "the left side of the truck's trailer", by which the partner is named, or which is what
/// touched.
pub(super) fn touches(partner: &Party) -> bool {
    let words = |source: &Source| match source {
        Source::Words { text, .. } => without_whole(text.to_lowercase()),
        _ => String::new(),
    };
    let named = partner.kind.as_ref().is_some_and(|kind| {
        let text = words(&kind.source);
        text.contains("trailer") && [" side", " corner", " end", " rear"].iter().any(|word| text.contains(word))
    });
    let part =
        |text: String| ["the ", "its ", "our "].iter().any(|word| text.starts_with(word)) && text.ends_with("trailer");
    let touched = partner.zones.iter().any(|zone| part(words(&zone.source)));
    (named || touched) && told(&partner.kind).and_then(Rig::of).is_some()
}

/// Names of a tractor with its trailer, as one.
const WHOLE: [&str; 5] = ["tractor trailer", "tractor-trailer", "semi trailer", "semi-trailer", "semitrailer"];

/// Words without the names for the whole: "the mirror of the tractor trailer" is not on its trailer.
fn without_whole(text: String) -> String {
    WHOLE.iter().fold(text, |text, name| text.replace(name, "truck"))
}

/// What is drawn of somebody who comes by with a trailer that touches.
pub(super) fn rig(partner: &Party, side: &Side, origin: Origin) -> Option<Rig> {
    let beside = matches!(origin, Origin::Opposite | Origin::Beside { .. } | Origin::Behind);
    let comes_by = beside && matches!(side.state, ContactState::Moving | ContactState::SettingOff);
    told(&partner.kind).and_then(Rig::of).filter(|_| comes_by && touches(partner))
}
