//! From where a road user comes: rules in an order, the first that says something counts. What is told goes before what zones and
//! lanes show, and a place beside the road before a direction on it.
//!
//! A new rule goes into [`RULES`], before all that would say something else of its case.

mod spots;

use super::fallback::{square_front, zone_side};
use super::places::{
    after_its_turn, behind_in_next_lane, climbs, drives_on_another, faces_against_its_side, faces_only,
    goes_over_to_pass, lead_of_subject, on_side_street, passes_subject, screen, side_of_road, side_of_screen,
    turn_onto_its_street,
};
use super::{Clues, changed_from, first_relation, lane_side, relation_to};
use crate::chunk::Joint;
use crate::fold::Reading;
use crate::fold::controls::turns_on_red;
use crate::fold::party::has_zone;
use crate::fold::types::{turn_side, turning};
use crate::frame::Frame;
use crate::lexicon::{Relation, Sense};
use crate::token::{Token, TokenKind};
use crate::world::{Actor, SUBJECT};
use recrash_model::account::{
    Account, Act, ActFact, Compass, ContactState, Fact, Kind, KindGroup, LaneWord, LeftRight, Origin, Party,
    RoadFeature, Source, told,
};
use recrash_model::zones::ContactZone as Z;

/// A road user and what is known of its way.
struct Case<'a> {
    clues: &'a Clues<'a>,
    reading: &'a Reading<'a>,
    actor: Actor,
    account: &'a Account,
    partner: &'a Party,
    /// The side on which it is, as told.
    side: Option<LeftRight>,
    /// The side of the subject vehicle that was touched.
    touched: Option<LeftRight>,
    heading: Option<&'a Fact<Compass>>,
    /// Eighths of a turn from the direction of the subject vehicle to its own: 4 comes the other way.
    turn: Option<u8>,
    /// It was parked.
    parked: bool,
    ahead: bool,
    behind: bool,
    /// Where it is, as told first.
    first: Option<Relation>,
    sv_stands: bool,
}

type Told = Option<Fact<Origin>>;
type Rule = fn(&Case<'_>) -> Told;

const RULES: [Rule; 42] = [
    |case| case.thrown_at_the_rear(),
    |case| case.out_of_a_place(),
    |case| case.stood_in_a_stall(),
    |case| case.stood_in_a_driveway(),
    |case| case.ahead_in_the_lane_that_was_left(),
    |case| case.backwards(),
    |case| case.opens_a_door(),
    |case| case.passes_behind(),
    |case| case.on_a_side_street(),
    |case| case.enters_from_a_road(),
    |case| case.leaves_the_kerb(),
    |case| case.goes_over_from_the_kerb(),
    |case| case.backs_from_a_named_kerb(),
    |case| case.comes_on_green(),
    |case| case.moves_over_from_behind(),
    |case| case.behind_in_the_lane_it_goes_to(),
    |case| case.comes_from_behind(),
    |case| case.is_beside(),
    |case| case.turns_onto_its_street(),
    |case| case.gives_no_way(),
    |case| case.by_directions(),
    |case| case.out_from_behind(),
    |case| case.on_another_street(),
    |case| case.up_and_down_a_hill(),
    |case| case.goes_the_wrong_way(),
    |case| case.comes_the_other_way(),
    |case| case.crosses(),
    |case| case.moves_over_from_ahead(),
    |case| case.is_ahead(),
    |case| case.front_on_flank_at_a_junction(),
    |case| case.is_on_a_side(),
    |case| case.passes_over_the_line(),
    |case| case.passes_the_other_way(),
    |case| case.passes(),
    |case| case.by_lanes(),
    |case| case.changes_into_the_edge_lane(),
    |case| case.both_turn(),
    |case| case.subject_goes_backwards(),
    |case| case.touched_from_a_side_street(),
    |case| case.touched_in_a_turn(),
    |case| case.is_passed(),
    |case| case.is_rear_ended(),
];

/// So many words after a verb tell that it was green, at most: "coming straight through from the left on green". [tokens]
const ON_GREEN_WITHIN: usize = 9;

/// From where a road user comes.
pub(super) fn of_road_user(clues: &Clues<'_>, account: &Account) -> Told {
    let case = Case::new(clues, account)?;
    RULES.iter().find_map(|rule| rule(&case))
}

fn told_as(value: Origin, source: Source) -> Told {
    Some(Fact { value, source })
}

fn by_rule(value: Origin, name: &str) -> Told {
    Some(Fact::by_rule(value, name))
}

/// "As it was completing its turn": it was still turning. "After completing its turn" is over.
fn is_being_completed(reading: &Reading<'_>, fact: &ActFact) -> bool {
    let Source::Words { start, text, .. } = &fact.source else { return false };
    let ing = ["completing", "finishing"].iter().any(|word| text.starts_with(word));
    let frame = || reading.story.frames.iter().find(|frame| reading.story.tokens[frame.first].start == *start);
    ing && frame().is_none_or(|frame| frame.joint != Some(Joint::After))
}

/// "coming along the road from the right", "went through on green from its left"; "the second lane from the right" is a lane.
fn comes_from_side(words: &[&str]) -> bool {
    let counts = |word: &str| matches!(word, "second" | "third" | "fourth" | "lane" | "lanes");
    (0..words.len()).any(|at| {
        let side = matches!(words[at..], ["from", "the" | "its", "left" | "right", ..]);
        let beside = |word: &&str| counts(word) || matches!(*word, "shoulder" | "side" | "edge" | "rear");
        let lane = words.iter().skip(at + 3).take(3).any(beside) || at > 0 && counts(words[at - 1]);
        side && !lane
    })
}

fn is_flank(zone: Z) -> bool {
    matches!(zone, Z::Left | Z::Right)
}

/// Whether all zones that are told are wanted, and some are told.
fn only(party: &Party, wanted: impl Fn(Z) -> bool) -> bool {
    !party.zones.is_empty() && party.zones.iter().all(|zone| wanted(zone.value))
}

impl<'a> Case<'a> {
    fn new(clues: &'a Clues<'a>, account: &'a Account) -> Option<Self> {
        let (reading, actor) = (clues.reading, clues.actor);
        let partner = account.partner.as_ref()?;
        let walks = told(&partner.kind)
            .is_some_and(|kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Animal | KindGroup::Cyclist));
        let mut case = Self {
            clues,
            reading,
            actor,
            account,
            partner,
            side: clues.side().or_else(|| side_of_road(reading, actor, account).filter(|_| walks)),
            touched: zone_side(account),
            heading: partner.heading.as_ref(),
            turn: None,
            parked: told(&partner.state) == Some(ContactState::Parked),
            ahead: clues.any(Relation::Ahead),
            behind: clues.any(Relation::Behind),
            first: first_relation(clues),
            sv_stands: told(&account.sv.state).is_some_and(ContactState::stands),
        };
        let parked = case.frames().any(|(_, frame)| frame.sense == Sense::Parked);
        case.parked |= parked;
        // After a turn that is done, its new direction counts. That of a lane for turns, in which it drove, tells of no turn.
        let turned = |fact: &&recrash_model::account::ActFact| fact.happened() && fact.act.turns();
        let done = account.sv.acts.iter().any(|fact| turned(&fact) && fact.done && !is_being_completed(reading, fact));
        let turned = account.sv.acts.iter().any(|fact| turned(&fact)) && !turning(&account.sv) || done;
        let turned = account.sv.heading_after.as_ref().filter(|_| turned);
        let own = turned.map(|fact| fact.value).or_else(|| after_its_turn(account));
        // Who faces one way and goes backwards comes from there.
        let backs_from = case.did(Act::Reverse) && faces_only(reading, actor);
        let other = case.heading.map(|other| other.value.turned(if backs_from { 4 } else { 0 }));
        let turn = own.zip(other).map(|(own, other)| own.eighths_to(other));
        // "southeast on 9th, and southwest on 9th": along one street.
        let fronts =
            |zones: &[Fact<Z>]| zones.iter().any(|fact| matches!(fact.value, Z::Front | Z::FrontLeft | Z::FrontRight));
        let met = fronts(&account.sv.zones);
        let unturned = own == account.sv.heading.as_ref().map(|fact| fact.value);
        let apart = matches!(turn, Some(3 | 5)) || matches!(turn, Some(2 | 6)) && (met || turning(&account.sv));
        let square = apart && unturned && !backs_from && case.on_one_street();
        case.turn = if square { Some(4) } else { turn };
        Some(case)
    }

    /// Whether both directions are told of a street of one name.
    fn on_one_street(&self) -> bool {
        let (one, other) = (self.street(self.account.sv.heading.as_ref()), self.street(self.heading));
        !one.is_empty() && one == other
    }

    /// The name of the street behind a direction: "southbound North 9th Street"; a name that is left out is none.
    fn street(&self, heading: Option<&Fact<Compass>>) -> Vec<&'a str> {
        let Some(Source::Words { end, .. }) = heading.map(|heading| &heading.source) else { return Vec::new() };
        let written = |token: &&Token| {
            let name = token.capital || token.text.starts_with(|c: char| c.is_ascii_digit());
            name && !token.text.contains("xxx") && token.kind != TokenKind::Mark
        };
        let behind = self.reading.story.tokens.iter().skip_while(|token| token.start < *end);
        let name = behind.skip_while(|token| matches!(token.text.as_str(), "on" | "along"));
        name.take_while(written).map(|token| token.text.as_str()).collect()
    }

    /// What it did up to the contact.
    fn frames(&self) -> impl Iterator<Item = (usize, &'a Frame)> {
        self.reading.before(self.actor).filter(|(_, frame)| frame.happened())
    }

    fn did(&self, act: Act) -> bool {
        self.frames().any(|(_, frame)| frame.act() == Some(act))
    }

    fn moved_over(&self) -> bool {
        self.frames().any(|(_, frame)| frame.act().is_some_and(Act::leaves_line))
    }

    /// The words of the first frame of an act.
    fn words_of(&self, act: Act) -> Source {
        self.clues.source(|frame| frame.act() == Some(act))
    }

    /// The side that is told, else the one that was touched.
    fn side_or_touched(&self) -> Option<LeftRight> {
        self.side.or(self.touched)
    }

    fn beside(&self, side: LeftRight) -> Told {
        told_as(Origin::Beside { side }, self.clues.has(relation_to(side)))
    }

    fn across(&self, side: LeftRight) -> Told {
        told_as(Origin::Cross { side }, self.clues.has(relation_to(side)))
    }

    /// The side from which it goes square to the way of the subject vehicle, by the directions of both.
    fn square_side(&self) -> Option<LeftRight> {
        match self.turn? {
            2 => Some(LeftRight::Left),
            6 => Some(LeftRight::Right),
            _ => None,
        }
    }

    fn first_is_side(&self) -> bool {
        matches!(self.first, Some(Relation::Left | Relation::Right))
    }

    fn behind_first(&self) -> bool {
        self.first == Some(Relation::Behind)
    }

    fn sv_reverses(&self) -> bool {
        told(&self.account.sv.state) == Some(ContactState::Reversing)
    }

    /// Out of a spot at the other side of the road, and then on: it comes the other way.
    fn drove_on(&self, number: usize) -> bool {
        let drives = |act: Option<Act>| matches!(act, Some(Act::Follow | Act::SetOff | Act::Drift));
        self.turn == Some(4) && self.frames().any(|(later, frame)| later > number && drives(frame.act()))
    }

    /// Who drives the other way comes from there, and is beside it then.
    fn other_way(&self) -> bool {
        self.turn == Some(4)
            && !(self.did(Act::Turn) || self.did(Act::UTurn) || self.did(Act::WrongWay))
            && matches!(told(&self.partner.state), Some(ContactState::Moving | ContactState::SettingOff))
    }

    /// Thrown at its plain rear, from whatever lane it was in.
    fn thrown_at_the_rear(&self) -> Told {
        let thrown = self.did(Act::Pushed) || !self.reading.contacts.earlier.is_empty();
        if thrown && only(&self.account.sv, |zone| zone == Z::Rear) && !self.sv_reverses() {
            return by_rule(Origin::Behind, "thrown at the rear");
        }
        None
    }

    /// It was ahead in one lane, and the subject vehicle left that lane.
    fn ahead_in_the_lane_that_was_left(&self) -> Told {
        let mut acts = self.account.sv.acts.iter();
        let change = acts.find(|fact| fact.act == Act::LaneChange && !fact.after_contact)?;
        let moves = || self.did(Act::Swerve) || self.did(Act::LaneChange) || self.did(Act::Turn);
        if self.first != Some(Relation::Ahead) || !moves() {
            return None;
        }
        told_as(Origin::Beside { side: change.side?.other() }, change.source.clone())
    }

    /// "reversed toward it".
    fn backwards(&self) -> Told {
        if !self.did(Act::Reverse) || self.behind {
            return None;
        }
        // Backwards out of a way across.
        if let (Some(side), Some(heading), false) = (self.square_side(), self.heading, square_front(self.account)) {
            return told_as(Origin::Cross { side }, heading.source.clone());
        }
        let from_front = self.clues.any(Relation::Opposite) && only(&self.account.sv, |zone| zone == Z::Front);
        // "yielded to a van that was backing in the opposite lane": whom it gives way to is not in front of it then.
        let own = self.account.sv.heading.as_ref().map(|fact| fact.value);
        let against = self.clues.any(Relation::Opposite) || faces_against_its_side(self.reading, self.actor, own);
        let lead = lead_of_subject(self.reading, self.actor) && !against;
        if self.ahead || lead || from_front && self.side.is_some() {
            return told_as(Origin::Ahead, self.words_of(Act::Reverse));
        }
        if against {
            // In the opposing lane, which is on the left.
            let side = self.side.unwrap_or(LeftRight::Left);
            return told_as(Origin::Beside { side }, self.clues.has(Relation::Opposite));
        }
        if let Some(side) = self.side {
            // Its rear on a flank: it stood across.
            let across = only(&self.account.sv, is_flank) && only(self.partner, |zone| zone == Z::Rear);
            let value = if across { Origin::Cross { side } } else { Origin::Beside { side } };
            return told_as(value, self.words_of(Act::Reverse));
        }
        // "The trailer came loose and rolled back westbound": the way it rolled, and not the one it faced.
        let loose = self.did(Act::Fall) && self.turn == Some(4);
        // It faces the way of the subject vehicle, and goes backwards toward it.
        let same_way = self.turn == Some(4)
            && only(&self.account.sv, |zone| zone == Z::Front)
            && faces_only(self.reading, self.actor);
        if has_zone(&self.account.sv, Z::is_front) && (loose || same_way || !matches!(self.turn, Some(2..=6))) {
            return by_rule(Origin::Ahead, "who goes backwards into the front was ahead");
        }
        None
    }

    /// "passing behind it": across its rear, which is then on the side that it touches with.
    fn passes_behind(&self) -> Told {
        let (number, _) = self.frames().find(|(_, frame)| {
            let word = self.reading.story.tokens[frame.first].text.as_str();
            // "drove behind it" as well, where its flank met the rear of who stood.
            let drove = self.sv_stands && only(self.partner, is_flank) && (word.starts_with("dr") || word == "went");
            let crosses = word.starts_with("pass") || word.starts_with("cross") || drove;
            crosses && frame.relations.contains(&(Relation::Behind, Some(SUBJECT)))
        })?;
        if !has_zone(&self.account.sv, Z::is_rear) {
            return None;
        }
        let side = if has_zone(self.partner, |zone| matches!(zone, Z::Left | Z::FrontLeft | Z::RearLeft)) {
            LeftRight::Left
        } else if has_zone(self.partner, |zone| matches!(zone, Z::Right | Z::FrontRight | Z::RearRight)) {
            LeftRight::Right
        } else {
            return None;
        };
        let (first, end) = self.reading.window(number);
        told_as(Origin::Cross { side }, self.reading.words(first, end))
    }

    /// "on the cross street to its left".
    fn on_a_side_street(&self) -> Told {
        let side = self.side.or(self.touched.filter(|_| !self.behind && !self.ahead))?;
        let there = on_side_street(self.reading, self.actor) && !self.did(Act::Pass);
        if there { self.across(side) } else { None }
    }

    /// "entered traffic from a stop sign on the right", "from a side street": no kerb.
    fn enters_from_a_road(&self) -> Told {
        if self.parked {
            return None;
        }
        let side = self.side_or_touched()?;
        let road = |word: &str| matches!(word, "intersection" | "sign" | "street" | "avenue" | "road" | "alley");
        let curb = |word: &str| matches!(word, "curb" | "side" | "parked" | "spot" | "space" | "stall" | "lane");
        let (number, _) = self.frames().find(|(number, frame)| {
            let (first, end) = self.reading.window(*number);
            let mut words =
                self.reading.story.tokens[first..end.min(first + 14)].iter().map(|token| token.text.as_str());
            let from = words.find(|word| *word == "from").is_some();
            let rest: Vec<&str> = words.collect();
            let of_road = rest.iter().any(|word| road(word)) && !rest.iter().any(|word| curb(word));
            frame.act() == Some(Act::PullOut) && from && of_road
        })?;
        let (first, end) = self.reading.window(number);
        told_as(Origin::Cross { side }, self.reading.words(first, end))
    }

    fn moves_over_from_behind(&self) -> Told {
        let side = lane_side(self.account)?;
        if !(self.behind && self.moved_over()) {
            return None;
        }
        // "changed lanes to the left, behind it, and to the left again": it went by behind it, and met its other side.
        if self.touched == Some(side.other()) {
            return told_as(Origin::Behind, self.clues.has(Relation::Behind));
        }
        by_rule(Origin::Beside { side }, "lanes of both")
    }

    /// Behind it, in the lane that it goes to.
    fn behind_in_the_lane_it_goes_to(&self) -> Told {
        let side = self.side.filter(|_| self.behind_first() && !(self.did(Act::Pass) || self.moved_over()))?;
        let source = behind_in_next_lane(self.reading, self.actor, self.account, side)?;
        told_as(Origin::Beside { side }, source)
    }

    fn comes_from_behind(&self) -> Told {
        let elsewhere = matches!(
            self.first,
            Some(Relation::Left | Relation::Right | Relation::Ahead | Relation::Opposite | Relation::Beside)
        );
        if !self.behind || elsewhere || self.turns_behind() {
            return None;
        }
        told_as(Origin::Behind, self.clues.has(Relation::Behind))
    }

    /// "An oncoming van turned behind it": that is where it went, of who is told to go another way.
    fn turns_behind(&self) -> bool {
        let behind = |frame: &Frame| frame.relations.iter().any(|(relation, _)| *relation == Relation::Behind);
        let turns = |frame: &Frame| matches!(frame.act(), Some(Act::Turn | Act::UTurn | Act::Cross));
        let mut told = self.frames().filter(|(_, frame)| behind(frame)).peekable();
        matches!(self.turn, Some(2..=6)) && told.peek().is_some() && told.all(|(_, frame)| turns(frame))
    }

    /// Beside it, before it passes or changes lanes: on the side of its lane, else the one that was touched.
    fn is_beside(&self) -> Told {
        if self.first != Some(Relation::Beside) || self.other_way() {
            return None;
        }
        let side = lane_side(self.account).or(self.touched).or_else(|| self.side_it_left())?;
        told_as(Origin::Beside { side }, self.clues.has(Relation::Beside))
    }

    /// "was in the adjacent lane, and changed lanes to the left": it had been on the right.
    fn side_it_left(&self) -> Option<LeftRight> {
        let over = |fact: &&ActFact| matches!(fact.act, Act::LaneChange | Act::Swerve) && !fact.after_contact;
        self.partner.acts.iter().find(over)?.side.map(LeftRight::other)
    }

    /// Out of the street that crosses, into its way.
    fn turns_onto_its_street(&self) -> Told {
        let elsewhere = self.turn.is_some() || self.side.is_some() || turning(&self.account.sv);
        let from_behind = has_zone(&self.account.sv, Z::is_rear) && !has_zone(&self.account.sv, Z::is_front);
        let (side, source) = turn_onto_its_street(self.reading, self.actor).filter(|_| from_behind && !elsewhere)?;
        told_as(Origin::Cross { side }, source)
    }

    /// "entered the circle without giving way".
    fn gives_no_way(&self) -> Told {
        let gave_no_way = self.did(Act::Enter) && self.partner.did(Act::FailToYield) && !self.sv_stands;
        if !gave_no_way || self.side.is_some() || self.turn.is_some() {
            return None;
        }
        by_rule(Origin::Cross { side: self.touched? }, "the side that was touched by one who came in")
    }

    /// "the AV was northbound, the van westbound".
    fn by_directions(&self) -> Told {
        let (eighths, source) = (self.turn?, self.heading?.source.clone());
        match eighths {
            // Facing the other way and going backwards it goes the same way, beside.
            4 if self.touched.is_some() && self.did(Act::Reverse) && !self.other_way() => {
                told_as(Origin::Beside { side: self.touched? }, source)
            }
            2 | 6 => told_as(Origin::Cross { side: self.square_side()? }, source),
            4 => told_as(Origin::Opposite, source),
            // It turned into the road of the subject vehicle: it came along another one, which crosses.
            3 | 5 if self.turned_into_its_road() => {
                let side = if eighths == 3 { LeftRight::Left } else { LeftRight::Right };
                told_as(Origin::Cross { side }, source)
            }
            3 | 5 => {
                let opposite = self.clues.any(Relation::Opposite) || self.partner.did(Act::WrongWay);
                // "completed its turn and passed it": the other way.
                let turned = self.did(Act::Turn) && !self.behind;
                if opposite || turned || !self.did(Act::Pass) { told_as(Origin::Opposite, source) } else { None }
            }
            _ => self.same_way(),
        }
    }

    /// "was heading southeast, the van westbound and turned onto the southeastbound road".
    fn turned_into_its_road(&self) -> bool {
        let road = |after: Compass| {
            let own = self.account.sv.heading.as_ref().map(|own| own.value.eighths_to(after));
            matches!(own, Some(0 | 4))
        };
        self.did(Act::Turn) && self.partner.heading_after.as_ref().is_some_and(|after| road(after.value))
    }

    /// Both go the same way.
    fn same_way(&self) -> Told {
        let lane = lane_side(self.account);
        if self.ahead {
            return match self.side.or(lane) {
                Some(side) => self.beside(side),
                None => told_as(Origin::Ahead, self.clues.has(Relation::Ahead)),
            };
        }
        let passes = self.did(Act::Pass);
        if let Some(side) = self.side.filter(|_| !passes || self.first_is_side()) {
            return self.beside(side);
        }
        if let Some(side) = lane {
            return by_rule(Origin::Beside { side }, "directions of both");
        }
        if passes {
            return told_as(Origin::Behind, self.words_of(Act::Pass));
        }
        let moved_over = || self.touched.filter(|_| self.did(Act::LaneChange));
        if let Some(side) = changed_from(self.account).or_else(moved_over) {
            return told_as(Origin::Beside { side }, self.words_of(Act::LaneChange));
        }
        if let (true, false, Some(side)) = (only(&self.account.sv, is_flank), self.sv_stands, self.touched) {
            return by_rule(Origin::Beside { side }, "directions of both");
        }
        if self.sv_stands || has_zone(&self.account.sv, Z::is_rear) {
            return by_rule(Origin::Behind, "directions of both");
        }
        None
    }

    /// "A man stepped out from behind a van that was parked on the right": on foot, from the side of what hid him.
    fn out_from_behind(&self) -> Told {
        let group = told(&self.partner.kind)?.group();
        if !matches!(group, KindGroup::OnFoot | KindGroup::Cyclist | KindGroup::Animal) || self.side.is_some() {
            return None;
        }
        let own = self.account.sv.heading.as_ref().map(|heading| heading.value);
        self.frames().find_map(|(number, frame)| {
            let side = side_of_screen(self.reading, screen(self.reading, number, frame)?, own)?;
            let (first, end) = self.reading.window(number);
            told_as(Origin::Cross { side }, self.reading.words(first, end))
        })
    }

    /// "The AV drove on Elm Street, the van on Oak Street", neither of whom turned.
    fn on_another_street(&self) -> Told {
        let turns = self.did(Act::Turn) || self.did(Act::UTurn) || turning(&self.account.sv);
        if self.turn.is_some() || turns || self.ahead || self.behind || self.did(Act::Pass) || self.moved_over() {
            return None;
        }
        let (side, source) = (self.side_or_touched()?, drives_on_another(self.reading, self.actor)?);
        told_as(Origin::Cross { side }, source)
    }

    fn up_and_down_a_hill(&self) -> Told {
        if self.turn.is_some() {
            return None;
        }
        let (own, other) = (climbs(self.reading, SUBJECT)?, climbs(self.reading, self.actor)?);
        if own != other { by_rule(Origin::Opposite, "one uphill, the other downhill") } else { None }
    }

    fn goes_the_wrong_way(&self) -> Told {
        if matches!(self.turn, Some(2 | 6)) || !self.did(Act::WrongWay) {
            return None;
        }
        told_as(Origin::Opposite, self.words_of(Act::WrongWay))
    }

    /// "the oncoming van", "in the opposite direction".
    fn comes_the_other_way(&self) -> Told {
        // "turned left out of the opposite left-turn lane".
        let lane = self.partner.lane.as_ref().filter(|lane| lane.value == LaneWord::Opposing && self.did(Act::Turn));
        if let (Some(lane), None, false) = (lane, self.turn, self.did(Act::Pass) || self.behind_first()) {
            return told_as(Origin::Opposite, lane.source.clone());
        }
        if !self.clues.any(Relation::Opposite) || self.did(Act::Pass) {
            return None;
        }
        told_as(Origin::Opposite, self.clues.has(Relation::Opposite))
    }

    /// "entered the intersection from the left", "ran the light".
    fn crosses(&self) -> Told {
        let ran = self.partner.did(Act::RunRed) || self.partner.did(Act::RunStop);
        // "ran the light and struck its left side".
        let told = self.behind || self.ahead || passes_subject(self.reading, self.actor) || self.moved_over();
        let side = self.side.or_else(|| self.touched.filter(|_| ran && !told))?;
        let sided = |frame: &Frame| {
            frame.relations.iter().any(|(relation, _)| matches!(relation, Relation::Left | Relation::Right))
        };
        let enters = |frame: &Frame| matches!(frame.sense, Sense::Act(Act::Enter | Act::RunRed | Act::RunStop));
        // "passed it on the left, and turned right, crossing in front of it".
        let passed = passes_subject(self.reading, self.actor);
        let crossing = self.did(Act::Cross) && !passed
            || ran && (self.first_is_side() || self.side.is_none())
            || self.frames().any(|(_, frame)| enters(frame) && (sided(frame) || self.comes_into_it(frame)))
            || self.frames().any(|(_, frame)| frame.sense == Sense::Approach && sided(frame)) && !self.did(Act::Pass)
            || self.comes_across()
            || on_side_street(self.reading, self.actor);
        if crossing { self.across(side) } else { None }
    }

    /// "A taxi from the right entered the intersection", "a taxi was going through from the right"; "the second lane from the right" is a lane.
    fn comes_into_it(&self, frame: &Frame) -> bool {
        let sentence = self.reading.story.sentences[frame.sentence];
        let words: Vec<&str> =
            self.reading.story.tokens[sentence.first..sentence.end].iter().map(|token| token.text.as_str()).collect();
        comes_from_side(&words) && words.iter().any(|word| matches!(*word, "intersection" | "junction" | "through"))
    }

    /// "traveling from left to right", "came at a right angle from its left", "coming along the road from the right".
    fn comes_across(&self) -> bool {
        let drives = |frame: &Frame| frame.happened() && frame.act() == Some(Act::Follow) && !frame.is_contact();
        let goes_over = self.moved_over() || self.did(Act::Pass) || self.did(Act::Turn) || self.parked;
        !goes_over
            && self.frames().filter(|(_, frame)| drives(frame)).any(|(number, _)| {
                let (first, end) = self.reading.window(number);
                let words: Vec<&str> =
                    self.reading.story.tokens[first..end].iter().map(|token| token.text.as_str()).collect();
                words.windows(2).any(|pair| pair == ["right", "angle"] || pair == ["right", "angles"])
                    || words.windows(3).any(|row| matches!(row, ["left", "to", "right"] | ["right", "to", "left"]))
                    || words.contains(&"perpendicular")
                    || self.partner.lane.is_none() && !words.contains(&"over") && comes_from_side(&words)
            })
    }

    fn moves_over_from_ahead(&self) -> Told {
        if !self.ahead || self.side.is_some() || !self.moved_over() {
            return None;
        }
        by_rule(Origin::Beside { side: lane_side(self.account)? }, "lanes of both")
    }

    fn is_ahead(&self) -> Told {
        if !self.ahead || self.side.is_some() {
            return None;
        }
        told_as(Origin::Ahead, self.clues.has(Relation::Ahead))
    }

    /// Front on flank at a junction, from that side: across.
    fn front_on_flank_at_a_junction(&self) -> Told {
        let side = self.side.filter(|_| self.side == self.touched)?;
        let mut features = self.account.place.features.iter();
        let stops = features.any(|feature| matches!(feature.value, RoadFeature::StopSign | RoadFeature::Signal));
        let flank = only(&self.account.sv, is_flank) && only(self.partner, |zone| zone == Z::Front);
        let plain = !self.sv_stands && !self.moved_over() && !self.did(Act::Pass) && !self.did(Act::Turn);
        if flank && stops && plain { self.across(side) } else { None }
    }

    /// "from its left", "to its right".
    fn is_on_a_side(&self) -> Told {
        let side = self.side?;
        if !self.first_is_side() && self.did(Act::Pass) {
            return None;
        }
        let group = told(&self.partner.kind).map(|kind| kind.group());
        let robot = told(&self.partner.kind) == Some(Kind::DeliveryRobot);
        let walks = matches!(group, Some(KindGroup::OnFoot | KindGroup::Animal)) || robot;
        if walks { self.across(side) } else { self.beside(side) }
    }

    fn passes_over_the_line(&self) -> Told {
        let over = self.turn.is_none() && goes_over_to_pass(self.reading, self.actor);
        over.then(|| Fact::by_rule(Origin::Behind, "who goes over to pass comes from behind"))
    }

    fn passes_the_other_way(&self) -> Told {
        let opposite = self.clues.any(Relation::Opposite);
        opposite.then(|| Fact { value: Origin::Opposite, source: self.clues.has(Relation::Opposite) })
    }

    fn passes(&self) -> Told {
        let passes = self.did(Act::Pass) && passes_subject(self.reading, self.actor);
        passes.then(|| Fact::by_rule(Origin::Behind, "who passes comes from behind"))
    }

    /// "It turned right on red, and a car that came through on the green struck it": along the crossing road, from its left.
    fn comes_on_green(&self) -> Told {
        let tokens = &self.reading.story.tokens;
        let green = |frame: &Frame| {
            let words = &tokens[frame.first..self.reading.story.sentences[frame.sentence].end];
            words.iter().take(ON_GREEN_WITHIN).any(|token| token.text == "green")
        };
        let comes = self.frames().any(|(_, frame)| frame.act().is_some() && frame.happened() && green(frame));
        let elsewhere = self.behind
            || [self.side, self.touched].contains(&Some(LeftRight::Right))
            || told(&self.partner.lane) == Some(LaneWord::Opposing)
            || self.clues.any(Relation::Opposite);
        let own_left =
            self.account.sv.acts.iter().any(|fact| fact.act == Act::Turn && fact.side == Some(LeftRight::Left));
        let straight = turn_side(self.partner).is_none() && !self.did(Act::Turn);
        let told = comes && straight && !elsewhere && !own_left && turns_on_red(self.reading);
        told.then(|| Fact::by_rule(Origin::Cross { side: LeftRight::Left }, "at green, where it turned at red"))
    }

    fn by_lanes(&self) -> Told {
        let side = lane_side(self.account).or_else(|| changed_from(self.account))?;
        by_rule(Origin::Beside { side }, "lanes of both")
    }

    /// Who changes lanes into the leftmost one comes from the right.
    fn changes_into_the_edge_lane(&self) -> Told {
        let side = match self.account.sv.lane.as_ref()?.value {
            LaneWord::Left | LaneWord::LeftTurn => LeftRight::Right,
            LaneWord::Right | LaneWord::RightTurn | LaneWord::Curb => LeftRight::Left,
            _ => return None,
        };
        let ours = |frame: &Frame| frame.act() == Some(Act::LaneChange) && frame.object == Some(SUBJECT);
        if self.touched.is_some_and(|touched| touched != side) || !self.frames().any(|(_, frame)| ours(frame)) {
            return None;
        }
        by_rule(Origin::Beside { side }, "into the lane at the edge of the road")
    }

    /// Both turn the same way, side by side.
    fn both_turn(&self) -> Told {
        let side = self.touched?;
        let both = self.reading.did(SUBJECT, Act::Turn) && self.did(Act::Turn);
        both.then(|| Fact::by_rule(Origin::Beside { side }, "the side that was touched, where both turn"))
    }

    fn subject_goes_backwards(&self) -> Told {
        let side = self.touched.filter(|_| self.sv_reverses())?;
        by_rule(Origin::Beside { side }, "the side that was touched, where it goes backwards")
    }

    fn touched_from_a_side_street(&self) -> Told {
        let side = self.touched?;
        let there = on_side_street(self.reading, self.actor) && !self.did(Act::Pass);
        there.then(|| Fact::by_rule(Origin::Cross { side }, "the side that was touched by one on a road that crosses"))
    }

    /// Who turns and is met by one of whom no direction is told: the side that was touched tells it.
    fn touched_in_a_turn(&self) -> Told {
        let side = self.touched?;
        let turns = turning(&self.account.sv) && !turning(self.partner) && !self.did(Act::Pass);
        if !turns || has_zone(&self.account.sv, Z::is_rear) {
            return None;
        }
        if self.parked {
            return by_rule(Origin::Beside { side }, "the side that a parked one is touched with");
        }
        let left = turn_side(&self.account.sv) == Some(LeftRight::Left);
        // Who ran a red light where it had green crossed.
        let ran_red = |frame: &Frame| frame.who != Some(SUBJECT) && frame.act() == Some(Act::RunRed);
        if left && side == LeftRight::Right && !self.reading.story.frames.iter().any(ran_red) {
            return by_rule(Origin::Opposite, "the right side of a vehicle turning left that was touched");
        }
        by_rule(Origin::Cross { side }, "the side of a turning vehicle that was touched")
    }

    /// "As the AV was passing the van": beside it, and no faster.
    fn is_passed(&self) -> Told {
        if self.did(Act::Pass) || self.did(Act::Reverse) || self.sv_stands || self.sv_reverses() {
            return None;
        }
        let passes =
            |frame: &Frame| frame.act() == Some(Act::Pass) && frame.object == Some(self.actor) && frame.happened();
        let (number, frame) = self.reading.before(SUBJECT).find(|(_, frame)| passes(frame))?;
        let side = frame.side.map(LeftRight::other).or(self.touched)?;
        let (first, end) = self.reading.window(number);
        told_as(Origin::Beside { side }, self.reading.words(first, end))
    }

    fn is_rear_ended(&self) -> Told {
        let frame = &self.reading.story.frames[self.reading.contacts.first?];
        if frame.sense != Sense::RearEnd {
            return None;
        }
        let by_subject = frame.who == Some(SUBJECT);
        by_rule(if by_subject { Origin::Ahead } else { Origin::Behind }, "front on rear")
    }
}
