//! The words for the road, and for the places on it.

use crate::reading::words::{span, text};
use crate::told::layout::{Counted, Layout, OffStreet, Standing, StoodOpen};
use crate::told::zones::side_of;
use recrash_model::account::{
    Account, Act, ActFact, Fact, LaneLine, LaneWord, LeftRight, Origin, Party, RoadFeature, SignalState, Source,
    StandReason, Striker, told,
};
use recrash_model::template::Movement;

/// The number of the outermost lane, which is told as the left or the right one.
const FIRST: [&str; 2] = ["1", "one"];

impl Counted {
    fn of(text: &str) -> Option<Self> {
        let text = text.replace('#', " number ");
        let words: Vec<&str> =
            text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let has = |word: &str| words.iter().any(|other| other.eq_ignore_ascii_case(word));
        let counts = [
            (2, ["second", "2nd", "two", "2"]),
            (3, ["third", "3rd", "three", "3"]),
            (4, ["fourth", "4th", "four", "4"]),
        ];
        // "The number two lane", "the #2 lane", "lane 2"; in "lane 1 of 2" the 1 counts, which is the outermost.
        let is_number = |word: &str| FIRST.contains(&word) || counts.iter().any(|(_, all)| all[2..].contains(&word));
        let leads = |at: usize, word: &str| word.eq_ignore_ascii_case("number") || at == 0 && word == "lane";
        let pairs = words.windows(2).enumerate();
        let numbered = pairs.filter(|(at, pair)| leads(*at, pair[0])).map(|(_, pair)| pair[1]);
        let numbered = numbered.map(str::to_lowercase).find(|word| is_number(word));
        let names = |names: &[&str; 4]| match &numbered {
            Some(number) => names[2..].contains(&number.as_str()),
            None => names[..2].iter().any(|name| has(name)),
        };
        let (number, _) = counts.into_iter().find(|(_, all)| names(all))?;
        // From the left, where no side is told.
        let from = match (has("left") || has("leftmost"), has("right") || has("rightmost")) {
            (_, false) => LeftRight::Left,
            (false, true) => LeftRight::Right,
            (true, true) => return None,
        };
        Some(Self { from, number })
    }
}

impl Layout {
    pub(super) fn of(account: &Account, partner: &Party) -> Self {
        let has = |feature: RoadFeature| account.place.features.iter().any(|fact| fact.value == feature);
        Self {
            sv: standing(account, &account.sv),
            cp: standing(account, partner),
            narrow: has(RoadFeature::NarrowStreet),
            one_way: has(RoadFeature::OneWay),
            stalls: has(RoadFeature::Stall),
            off_street: ways_off_street(account, partner, false),
            cp_into: ways_off_street(account, partner, true) == Some(OffStreet::Into),
            cp_off_street: is_told_on(account, partner, &["alley", "driveway", "parking lot", "garage"]),
            at_junction: account.place.features.iter().any(is_at_junction),
            slip_lane: account.place.features.iter().any(is_in_slip_lane),
            three_arms: told(&account.place.arms) == Some(3),
            splits: splits_lanes(partner),
            crosswalk: is_told_on(account, partner, &["crosswalk", "sidewalk"])
                && !is_told_on(account, partner, &BESIDE_WALK),
            beside_crosswalk: is_told_on(account, partner, &BESIDE_WALK),
            along_kerb: passes_by_kerb(account, partner)
                || is_told_on(account, partner, &["between"]) && is_told_on(account, partner, &BESIDE_KERB),
            right_behind: account.came_from.as_ref().is_some_and(|fact| {
                let words = text(&fact.source);
                RIGHT_BEHIND.iter().any(|word| words.contains(word))
            }),
            abreast: drives_abreast(account, partner),
            centre_line: has(RoadFeature::DoubleYellowLine),
            right_lane: goes_out_right(account, partner),
            turn_lane: has(RoadFeature::TurnLane) && goes_to_turn_lane(account, partner)
                || goes_out_left(account, partner),
            left_to_come: goes_to_turn_left(&account.sv),
            arrow: turns_on_arrow(&account.sv),
            light_changes: light_changes(&account.sv),
            on_red: turns_on_red(&account.sv),
            rear_door: rear_door(account, partner),
            stood_open: stood_open(account, partner),
        }
    }
}

/// Whether words tell that the ego was at a junction: "in a queue of traffic at the intersection", not the name of that alone.
fn is_at_junction(feature: &Fact<RoadFeature>) -> bool {
    let words = text(&feature.source);
    let at = ["at ", "for ", "approach", "reach", "towards "].iter().any(|lead| words.starts_with(lead));
    feature.value == RoadFeature::Intersection && at
}

/// How the ego, or the partner, is told to turn at a way off the street: what is told with nobody else's turn is the ego's.
fn ways_off_street(account: &Account, partner: &Party, of_partner: bool) -> Option<OffStreet> {
    let turns = |party: &Party| turn_spans(&party.acts);
    let others: Vec<(usize, usize)> = account.others.iter().flat_map(|other| turn_spans(&other.acts)).collect();
    let within = |spans: &[(usize, usize)], at: (usize, usize)| spans.iter().any(|span| span.0 < at.1 && at.0 < span.1);
    let partners = turns(partner);
    account.place.features.iter().find_map(|feature| {
        let at = span(&feature.source)?;
        let is_partners = within(&partners, at);
        let here = if of_partner { is_partners } else { !is_partners && !within(&others, at) };
        turns_off_street(feature)
            .filter(|way| here && (of_partner || *way == OffStreet::Into || !drives_on_after(&account.sv, at)))
    })
}

/// Whether somebody drives on after a turn whose words stand here: it has left that road.
fn drives_on_after(party: &Party, at: (usize, usize)) -> bool {
    let before = || party.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let this = |fact: &&ActFact| span(&fact.source).is_some_and(|span| span.0 < at.1 && at.0 < span.1);
    let turn = before().filter(|fact| fact.act == Act::Turn).find(this);
    let stands = |act: Act| matches!(act, Act::Slow | Act::Stop | Act::Hold | Act::Park);
    turn.is_some_and(|turn| before().any(|fact| fact.step > turn.step && !stands(fact.act)))
}

/// Where the words for somebody's turns stand.
fn turn_spans(acts: &[ActFact]) -> Vec<(usize, usize)> {
    acts.iter().filter(|fact| fact.act == Act::Turn).filter_map(|fact| span(&fact.source)).collect()
}

/// Whether words tell that the ego was in a slip lane: "in the slip lane", not the name of that alone.
fn is_in_slip_lane(feature: &Fact<RoadFeature>) -> bool {
    let words = text(&feature.source);
    feature.value == RoadFeature::Merge
        && words.contains("lane")
        && ["in ", "on ", "into "].iter().any(|lead| words.starts_with(lead))
}

/// How somebody turns by the words for a way off the street: "turned left into a parking lot", "turning right out of an alley".
fn turns_off_street(feature: &Fact<RoadFeature>) -> Option<OffStreet> {
    let words = text(&feature.source);
    let way = matches!(
        feature.value,
        RoadFeature::Driveway | RoadFeature::ParkingLot | RoadFeature::Garage | RoadFeature::Alley
    );
    let has = |list: &[&str]| way && words.contains("turn") && list.iter().any(|word| words.contains(word));
    let out = has(&["out of ", " from ", "exit", "leaving "]) || words.starts_with("left ");
    match (has(&[" into ", " toward"]), way && out) {
        (true, _) => Some(OffStreet::Into),
        (false, true) => Some(OffStreet::OutOf),
        (false, false) => None,
    }
}

/// Whether words tell that somebody passes between two lanes: "a lane-splitting van", "riding in between lanes".
fn splits_lanes(party: &Party) -> bool {
    let between = |text: String| text.contains("splitting") || text.ends_with("between");
    party.acts.iter().any(|fact| fact.act == Act::Pass && !fact.after_contact && between(text(&fact.source)))
}

/// So many bytes behind the words that somebody passed, at most, begin those for who is parked on its other side.
const BEHIND_PASS: usize = 60;

/// "squeezed between the AV and the curb", "passed on the right, between the AV and a row of parked cars": no lane is there.
fn passes_by_kerb(account: &Account, partner: &Party) -> bool {
    let parking = account.place.features.iter().filter(|fact| fact.value == RoadFeature::ParkingLane);
    let parking: Vec<usize> = parking.filter_map(|fact| Some(span(&fact.source)?.0)).collect();
    let by = |fact: &ActFact| {
        let words = text(&fact.source);
        let between = words.contains("between") && !words.contains("lane") && !words.ends_with("between");
        let end = span(&fact.source).map_or(0, |(_, end)| end);
        let parked =
            fact.side == Some(LeftRight::Right) && parking.iter().any(|at| (end..end + BEHIND_PASS).contains(at));
        fact.act == Act::Pass && !fact.after_contact && (between || parked)
    };
    partner.acts.iter().any(by)
}

/// Words for somebody that crosses where no crosswalk is.
const BESIDE_WALK: [&str; 6] =
    ["outside", "not in the crosswalk", "away from the crosswalk", "ahead of the crosswalk", "mid-block", "midblock"];

/// Words for what is at the edge of the road.
const BESIDE_KERB: [&str; 4] = ["curb", "kerb", "gutter", "parked"];

/// Whether words for the way of the partner, or for what it did before the contact, hold one of these: "rode off the sidewalk".
fn is_told_on(account: &Account, partner: &Party, words: &[&str]) -> bool {
    let acts = partner.acts.iter().filter(|fact| !fact.after_contact).map(|fact| &fact.source);
    let from = account.came_from.iter().map(|fact| &fact.source);
    let lane = partner.lane.iter().map(|fact| &fact.source);
    acts.chain(from).chain(lane).map(text).any(|text| words.iter().any(|word| begins_word(&text, word)))
}

/// Whether a word of the text begins so: "alleys" does with "alley", "Valley" does not.
fn begins_word(text: &str, word: &str) -> bool {
    text.match_indices(word).any(|(at, _)| !text[..at].ends_with(char::is_alphanumeric))
}

/// Words for who is behind the ego in its lane.
const RIGHT_BEHIND: [&str; 2] = ["directly behind", "immediately behind"];

/// Words for two that drive side by side, and for one that comes up to the other.
const ABREAST: [&str; 9] = [
    "next to",
    "to the side of",
    "alongside",
    "side by side",
    "side-by-side",
    "abreast",
    "same pace",
    "beside it",
    "beside the",
];
const COMES_UP: [&str; 6] = ["came up", "coming up", "approach", "overt", "pass", "behind"];

/// Whether words for the place of a partner beside the ego have the two drive side by side: "a van was next to it in the left lane"; not who
/// "came up alongside".
fn drives_abreast(account: &Account, partner: &Party) -> bool {
    let beside = account.came_from.as_ref().filter(|fact| matches!(fact.value, Origin::Beside { .. }));
    let passes = matches!(told(&partner.movement), Some(Movement::Passing)) || partner.did(Act::Pass);
    // A lane next to the ego's is no vehicle next to it.
    // Nor is "alongside, a little behind its midpoint" behind it.
    let of_lane = |text: String| {
        let near = ["a little behind", "slightly behind", "just behind"].iter();
        let text = text.replace("lane next to", "lane").replace("lane beside", "lane");
        near.fold(text, |text, words| text.replace(words, ""))
    };
    beside.map(|fact| of_lane(text(&fact.source))).is_some_and(|text| {
        let has = |words: &[&str]| words.iter().any(|word| text.contains(word));
        !passes && has(&ABREAST) && !has(&COMES_UP)
    })
}

/// Whether the partner is told in a lane for left turns beside an ego in the left lane, or goes out to its left there, past the ego.
fn goes_to_turn_lane(account: &Account, partner: &Party) -> bool {
    let lane = |party: &Party| told(&party.lane);
    let out = |fact: &ActFact| matches!(fact.act, Act::LaneChange | Act::Pass) && fact.side == Some(LeftRight::Left);
    let goes = match (lane(partner), told(&account.came_from)) {
        (Some(LaneWord::LeftTurn), Some(Origin::Beside { side })) => side == LeftRight::Left,
        (Some(LaneWord::LeftTurn) | None, Some(Origin::Behind)) => {
            partner.acts.iter().any(|fact| out(fact) && !fact.after_contact)
        }
        _ => false,
    };
    lane(&account.sv) == Some(LaneWord::Left) && goes
}

/// Whether the partner changes lanes to its left behind an ego in the left lane, which is then the left one of those that go on.
fn goes_out_left(account: &Account, partner: &Party) -> bool {
    let out = |fact: &ActFact| fact.act == Act::LaneChange && fact.side == Some(LeftRight::Left) && !fact.after_contact;
    let left = told(&account.sv.lane) == Some(LaneWord::Left) && told(&partner.lane).is_none();
    left && told(&account.came_from) == Some(Origin::Behind)
        && partner.acts.iter().any(out)
        && !comes_into_its_lane(account)
}

/// Whether nothing tells that a partner that changes lanes behind the ego was in the ego's: neither words for its place, nor a touched side of
/// the ego's, past which it would go.
fn comes_into_its_lane(account: &Account) -> bool {
    let behind = account.came_from.as_ref().is_some_and(|fact| text(&fact.source).contains("behind"));
    !behind && side_of(&account.sv.zone_values()).is_none()
}

/// Whether the partner changes lanes to its right behind an ego in the right lane, or out of the lane on the right of that: it is then the
/// right one of those that go on.
fn goes_out_right(account: &Account, partner: &Party) -> bool {
    let out =
        |fact: &ActFact| fact.act == Act::LaneChange && fact.side == Some(LeftRight::Right) && !fact.after_contact;
    let right = told(&account.sv.lane) == Some(LaneWord::Right);
    let stays = told(&partner.lane).is_none_or(|lane| lane == LaneWord::Right);
    let changes = matches!(told(&partner.movement), Some(Movement::ChangingLanes | Movement::Merging));
    match told(&account.came_from) {
        Some(Origin::Behind) => right && stays && partner.acts.iter().any(out) && !comes_into_its_lane(account),
        Some(Origin::Beside { side: LeftRight::Right }) => right && told(&partner.lane).is_none() && changes,
        _ => false,
    }
}

fn standing(account: &Account, party: &Party) -> Standing {
    let lane = party.lane.as_ref().and_then(|lane| Counted::of(&text(&lane.source)));
    let double = sources(party).any(|source| text(source).contains("double"));
    let stands = |fact: &&ActFact| matches!(fact.act, Act::Hold | Act::Park) && !fact.after_contact && !fact.begun;
    // Who is partly in a lane and partly beside it is in none.
    let partly = told(&party.astride).is_some_and(|over| over.line == LaneLine::Edge);
    let in_lane = double || !partly && party.acts.iter().rfind(stands).is_some_and(is_in_lane);
    let last = party.acts.iter().rfind(stands).map_or(String::new(), |fact| text(&fact.source));
    // Where it lets somebody in or out there, it is at the kerb.
    let edge = last.ends_with(" edge") || last.ends_with("lane") && last.contains("edge of");
    let boards = party.reasons.iter().any(|fact| fact.value == StandReason::PickupDropoff) && !in_lane;
    Standing { counted: lane, at_kerb: edge && boards || stands_at_kerb(account, party), in_lane, lane_edge: edge }
}

/// "parked in the travel lane": the reader's words of who stands in a lane end with it.
fn is_in_lane(fact: &ActFact) -> bool {
    text(&fact.source).ends_with("lane")
}

/// So many bytes behind the words that somebody stands, at most, begin those for the kerb: "was stopped to the right of the AV in a curbside
/// parking spot".
const BEHIND_STAND: usize = 50;

/// Whether words for the kerb, or for room to park, stand right behind those that somebody stood.
fn stands_at_kerb(account: &Account, party: &Party) -> bool {
    let stands = |fact: &&ActFact| {
        matches!(fact.act, Act::Hold | Act::Stop | Act::Park | Act::PullOver) && !fact.after_contact && !fact.begun
    };
    let ends: Vec<usize> =
        party.acts.iter().filter(stands).filter_map(|fact| span(&fact.source)).map(|at| at.1).collect();
    let kerb = |fact: &&Fact<RoadFeature>| {
        let words = text(&fact.source);
        fact.value == RoadFeature::ParkingLane && (words.contains("curb") || words.contains("edge of"))
    };
    let kerbs = account.place.features.iter().filter(kerb).filter_map(|fact| span(&fact.source));
    let mut kerbs = kerbs.map(|at| at.0);
    // "It was held by a light, with a van parked at the curb": that kerb is the van's.
    let others = account.others.iter().flat_map(|other| &other.acts).filter(stands);
    let others: Vec<usize> = others.filter_map(|fact| Some(span(&fact.source)?.0)).collect();
    let of_other = |from: usize, kerb: usize| others.iter().any(|start| (from..=kerb).contains(start));
    kerbs.any(|kerb| {
        let behind = |end: usize| (end..end + BEHIND_STAND).contains(&kerb) && !of_other(end, kerb);
        ends.iter().any(|end| behind(*end) || kerb + BEHIND_STAND > *end && kerb < *end)
    })
}

/// Whether somebody is told to be about to turn left, or to do so after the contact, and not to have turned before.
fn goes_to_turn_left(party: &Party) -> bool {
    if told(&party.turns_next) == Some(LeftRight::Left) {
        return true;
    }
    let left = |fact: &ActFact| fact.act == Act::Turn && fact.side == Some(LeftRight::Left);
    let turned = party.acts.iter().any(|fact| fact.act == Act::Turn && !fact.after_contact && !fact.begun);
    !turned && party.acts.iter().any(left)
}

/// Whether a light is told to be for a turn alone: a green arrow, or a protected turn.
fn turns_on_arrow(party: &Party) -> bool {
    let texts = party.acts.iter().map(|fact| &fact.source).chain(party.controls.iter().map(|fact| &fact.source));
    let green = party
        .controls
        .last()
        .is_some_and(|fact| matches!(fact.value.state, Some(SignalState::Green | SignalState::TurnedGreen)));
    let words = |text: String| {
        let words: Vec<&str> = text.split(|letter: char| !letter.is_alphanumeric()).collect();
        let alone = |next: &str| matches!(next, "left" | "turn" | "arrow" | "signal" | "phase");
        text.contains("arrow") || words.windows(2).any(|pair| pair[0] == "protected" && alone(pair[1]))
    };
    green && texts.map(text).any(words)
}

/// Whether words tell that somebody's light changed, or that it waited for green: "waiting for the light to turn green".
fn light_changes(party: &Party) -> bool {
    let reasons = party.reasons.iter().map(|fact| &fact.source);
    let standing = party.standing.iter().map(|fact| &fact.source);
    let controls = party.controls.iter().map(|fact| &fact.source);
    let acts = party.acts.iter().filter(|fact| !fact.after_contact).map(|fact| &fact.source);
    let mut texts = reasons.chain(standing).chain(controls).chain(acts).map(text);
    let turned = party.controls.iter().any(|fact| {
        matches!(fact.value.state, Some(SignalState::Green | SignalState::TurnedGreen | SignalState::Yellow))
    });
    let light = |text: &str| text.contains("light") || text.contains("signal");
    turned || texts.any(|text| text.contains("green") || light(&text) && text.contains("chang"))
}

/// Whether words tell that somebody turned at red: "a right turn on red". Not "stopped on red".
fn turns_on_red(party: &Party) -> bool {
    let acts = party.acts.iter().filter(|fact| !fact.after_contact).map(|fact| &fact.source);
    let turns = |source: &Source| {
        let words = text(source).replace('-', " ");
        words.contains("on red") && ["turn", "right on", "left on"].iter().any(|turn| words.contains(turn))
    };
    acts.chain(party.controls.iter().map(|fact| &fact.source)).any(turns)
}

/// So many words before "door" tell which one it is.
const BEFORE_DOOR: usize = 5;

/// Whether the words for the door that opened tell a rear one, or a front one.
fn rear_door(account: &Account, partner: &Party) -> Option<bool> {
    let opens = |party: &Party| {
        party.acts.iter().filter(|fact| fact.act == Act::OpenDoor).map(|fact| fact.source.clone()).collect::<Vec<_>>()
    };
    let mut all = opens(&account.sv);
    all.extend(opens(partner));
    all.extend(account.door.iter().map(|fact| fact.source.clone()));
    all.iter().map(text).find_map(|text| {
        let words: Vec<&str> =
            text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        let door = words.iter().position(|word| *word == "door")?;
        words[door.saturating_sub(BEFORE_DOOR)..door].iter().rev().find_map(|word| match *word {
            "rear" | "back" => Some(true),
            "front" => Some(false),
            _ => None,
        })
    })
}

/// Since when a door had stood open: "with its door open", "a rider opened the door, and a van began to go round"; nothing where no words tell that
/// it had: "the opening door of a parked car".
fn stood_open(account: &Account, partner: &Party) -> Option<StoodOpen> {
    let of_sv = told(&account.door)? == Striker::Sv;
    let (owner, other) = if of_sv { (&account.sv, partner) } else { (partner, &account.sv) };
    let Some(opened) = owner.acts.iter().find(|fact| fact.act == Act::OpenDoor) else {
        let open = account.door.as_ref().is_some_and(|fact| is_open(&text(&fact.source)));
        return open.then_some(if of_sv { StoodOpen::Shortly } else { StoodOpen::AllAlong });
    };
    let comes = |fact: &ActFact| matches!(fact.act, Act::Pass | Act::SetOff | Act::Reverse) && !fact.after_contact;
    let then = other.acts.iter().any(|fact| comes(fact) && fact.after_other == Some(opened.step));
    then.then_some(StoodOpen::Shortly)
}

/// "its open door", "a door that was ajar"; neither "the opening door" nor "which had opened".
fn is_open(text: &str) -> bool {
    text.split(|letter: char| !letter.is_alphanumeric()).any(|word| matches!(word, "open" | "ajar"))
}

fn sources(party: &Party) -> impl Iterator<Item = &Source> {
    let kind = party.kind.iter().map(|fact| &fact.source);
    let state = party.state.iter().map(|fact| &fact.source);
    kind.chain(state).chain(party.acts.iter().map(|fact| &fact.source))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counted_lanes_have_a_number_from_the_left() {
        let third = Counted::of("third lane from the right").unwrap();
        assert_eq!((third.place(4), third.place(3), third.place(2)), (Some(1), Some(0), None));
        let second = Counted::of("the second from the left lane").unwrap();
        assert_eq!((second.place(4), second.words().as_str()), (Some(1), "the second lane from the left"));
        let fourth = Counted::of("the fourth from the right lane").unwrap();
        assert_eq!((fourth.place(5), fourth.words().as_str()), (Some(1), "the fourth lane from the right"));
        let third = Counted::of("lane 3").unwrap();
        assert_eq!((third.place(4), third.place(2)), (Some(2), None));
        assert_eq!(Counted::of("number two lane").unwrap().place(3), Some(1));
        assert_eq!(Counted::of("#2 lane").unwrap().place(3), Some(1));
        assert_eq!(Counted::of("lane 1 of 2"), None);
        assert_eq!(Counted::of("lane 2 of 3").unwrap().place(3), Some(1));
        assert_eq!(Counted::of("the right lane"), None);
        assert_eq!(Counted::of("the left of two lanes"), None);
    }
}
