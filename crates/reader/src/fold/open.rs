//! What the words for somebody leave open: who does something, what kind it is, to which side it turns.

use super::Reading;
use crate::frame::Frame;
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{Account, Act, Fact, Kind, LaneWord, LeftRight, Origin, Source, told};
use recrash_model::template::Movement;

/// The lane of who comes from behind and goes round in that of those who come towards it, where no other is told of it.
pub(super) fn oncoming_lane(reading: &Reading<'_>, account: &Account) -> Option<Fact<LaneWord>> {
    let actor = reading.contacts.partner?;
    let behind = told(&account.came_from) == Some(Origin::Behind);
    if !behind || account.partner.as_ref()?.lane.is_some() {
        return None;
    }
    let tokens = &reading.story.tokens;
    let word = |at: usize| tokens.get(at).map_or("", |token| token.text.as_str());
    let goes = |frame: &Frame| {
        matches!(frame.act(), Some(Act::Pass | Act::LaneChange | Act::Drift | Act::Swerve | Act::Enter | Act::Cross))
    };
    let mut frames = reading.before(actor).filter(|(_, frame)| frame.happened() && goes(frame));
    frames.find_map(|(number, _)| {
        let (first, end) = reading.window(number);
        (first..end).find_map(|at| {
            let lane = if word(at + 1) == "traffic" { at + 2 } else { at + 1 };
            let there = matches!(word(at), "oncoming" | "opposing" | "opposite") && word(lane).starts_with("lane");
            (there && lane < end).then(|| reading.told(LaneWord::Opposing, at, lane + 1))
        })
    })
}

/// Who does what a frame tells: "the wheel of a van came off and rolled over" is told of the wheel.
pub(super) fn doer(reading: &Reading<'_>, frame: &Frame) -> Option<Actor> {
    let loose = |actor: &Actor| {
        let kind = reading.story.world.actors[*actor].kind;
        matches!(kind, Some(Kind::LooseWheel | Kind::Debris | Kind::Cargo | Kind::Object))
    };
    let comes_off = matches!(frame.act(), Some(Act::Roll | Act::Fall)) && frame.who == Some(SUBJECT);
    reading.contacts.partner.filter(loose).filter(|_| comes_off).or(frame.who)
}

/// The side of a turn that only the column tells.
pub(super) fn turned_by_column(reading: &Reading<'_>, actor: Actor, act: Act) -> Option<LeftRight> {
    let own = reading.record.sv_movement.known().filter(|_| actor == SUBJECT);
    let other = reading.record.cp_movement.known().filter(|_| Some(actor) == reading.contacts.partner);
    match own.or(other).filter(|_| act == Act::Turn)? {
        Movement::LeftTurn => Some(LeftRight::Left),
        Movement::RightTurn => Some(LeftRight::Right),
        _ => None,
    }
}

/// Whether the words for somebody name a truck of any size.
pub(super) fn is_any_truck(kind: &Fact<Kind>) -> bool {
    let Source::Words { text, .. } = &kind.source else { return false };
    let plain = ["truck", "commercial vehicle", "work truck", "utility truck", "commercial truck"];
    let text = text.to_lowercase();
    let words = text.split_once(' ').filter(|(article, _)| matches!(*article, "a" | "the" | "another" | "this"));
    kind.value == Kind::HeavyTruck && plain.contains(&words.map_or(text.as_str(), |(_, words)| words))
}
