//! Directions, lanes and places beside the road.

use super::{Chunker, DETERMINERS, Noun, Spot};
use crate::token::{Token, TokenKind, number};
use recrash_model::account::{Compass, Kind, KindGroup, LaneWord};

/// Most tokens of the name of a lane before "lane".
const LONGEST_LANE_NAME: usize = 9;

/// "partially in one lane and partially in another one": both stand so near. [tokens]
const BOTH_WITHIN: usize = 12;

/// "had three lanes. It was in the middle one": so many words before it. [tokens]
const LANES_BEFORE: usize = 40;

const LEFT: &[&str] = &["left", "leftmost", "inside", "fast", "inner", "innermost"];
const RIGHT: &[&str] = &["right", "rightmost", "outside", "slow", "outer", "outermost"];
const BUS: &[&str] = &["bus", "transit"];
const TURN: &[&str] = &["turn", "turning"];
/// Words for one of two lanes for the same turn.
const OF_TWO: &[&str] = &["outer", "outside", "outermost", "inner", "inside", "innermost"];

const MIDDLE: &[&str] = &["center", "middle", "centre"];

/// What the words before "lane" make of it: the first whose words are all there.
const LANES: [(&[&[&str]], LaneWord); 18] = [
    (&[&["bike", "bicycle", "cycle"]], LaneWord::Bike),
    // "the rightmost bus and turn lane": who else may use it says where it is.
    (&[BUS, TURN, LEFT], LaneWord::LeftTurn),
    (&[BUS, TURN, RIGHT], LaneWord::RightTurn),
    (&[BUS, &["leftmost"]], LaneWord::Left),
    (&[BUS, &["rightmost"]], LaneWord::Right),
    (&[BUS], LaneWord::Bus),
    (&[&["opposing", "opposite", "oncoming"]], LaneWord::Opposing),
    (&[&["parking", "curb", "curbside"]], LaneWord::Curb),
    (&[&["emergency"]], LaneWord::Shoulder),
    // "the middle shared turn lane", "the center two-way turn lane": between both directions.
    (&[TURN, &["center", "middle", "centre", "shared", "way"]], LaneWord::LeftTurn),
    // "the leftmost right turn lane".
    (&[TURN, &["leftmost"], &["right"]], LaneWord::RightTurn),
    (&[TURN, LEFT], LaneWord::LeftTurn),
    (&[TURN, RIGHT], LaneWord::RightTurn),
    // "the right-middle lane": of two in the middle.
    (&[MIDDLE, &["left"]], LaneWord::Center),
    (&[MIDDLE, &["right"]], LaneWord::Center),
    (&[LEFT], LaneWord::Left),
    (&[RIGHT], LaneWord::Right),
    (&[MIDDLE], LaneWord::Center),
];

/// Words that stand before "lane" in its name.
fn in_lane_names(word: &str) -> bool {
    matches!(word, "left" | "right" | "leftmost" | "rightmost" | "far" | "center" | "centre" | "middle")
        || matches!(word, "turn" | "turning" | "only" | "hand" | "through" | "thru" | "straight" | "dedicated")
        || matches!(word, "travel" | "driving" | "traffic" | "bike" | "bicycle" | "bus" | "hov" | "carpool" | "merge")
        || matches!(word, "adjacent" | "next" | "neighboring" | "same" | "inside" | "outside" | "curb" | "parking")
        || matches!(word, "opposing" | "opposite" | "oncoming" | "designated" | "emergency" | "slow" | "fast")
        || matches!(word, "passing" | "number" | "second" | "of" | "and" | "two" | "three" | "four")
        || matches!(word, "shared" | "way" | "vehicle" | "transit" | "expanded" | "additional" | "new")
        || matches!(word, "inner" | "innermost" | "outer" | "outermost" | "curbside" | "cycle" | "exit" | "express")
        || matches!(word, "deceleration" | "acceleration" | "auxiliary" | "general" | "purpose" | "side")
        || matches!(word, "singular" | "single" | "sole" | "lone" | "reserved" | "own")
}

/// Words with which the name of a lane does not begin.
fn only_inside_lane_names(word: &str) -> bool {
    matches!(word, "and" | "of" | "two" | "three" | "four" | "way" | "vehicle" | "side" | "own" | "purpose")
        || matches!(word, "single" | "new" | "additional")
}

/// So many lanes.
fn count(word: &str) -> Option<u8> {
    number(word).filter(|number| (1..=MOST_LANES).contains(number))
}

/// A road has no more lanes in one direction.
const MOST_LANES: u8 = 6;

/// The lane with this number from the left, of so many where that is told; of which else one more is there.
const fn of_so_many(number: u8, many: Option<u8>) -> Option<LaneWord> {
    match (number, many) {
        (1, _) => Some(LaneWord::Left),
        (_, Some(many)) if number == many => Some(LaneWord::Right),
        (_, Some(many)) if number > many => None,
        _ => Some(LaneWord::Center),
    }
}

/// One of eight directions.
fn direction(word: &str) -> Option<Compass> {
    Some(match word {
        "north" => Compass::North,
        "northeast" => Compass::Northeast,
        "east" => Compass::East,
        "southeast" => Compass::Southeast,
        "south" => Compass::South,
        "southwest" => Compass::Southwest,
        "west" => Compass::West,
        "northwest" => Compass::Northwest,
        _ => return None,
    })
}

/// One of four directions by its letter.
fn letter(word: &str) -> Option<Compass> {
    Some(match word {
        "n" => Compass::North,
        "s" => Compass::South,
        "e" => Compass::East,
        "w" => Compass::West,
        _ => return None,
    })
}

/// The way of a road or a side of it: "northbound".
pub fn bound(word: &str) -> Option<Compass> {
    word.strip_suffix("bound").and_then(direction)
}

impl Chunker<'_> {
    /// Whether one of the eight directions stands here alone.
    pub(super) fn compass_word(&self, at: usize) -> bool {
        direction(self.text(at)).is_some()
    }

    /// One of eight directions, and its tokens.
    pub(super) fn compass(&self, at: usize) -> Option<(Compass, usize)> {
        let word = self.text(at);
        // "going east to west": where it ends.
        if let (Some(_), "to", Some(end)) = (direction(word), self.text(at + 1), direction(self.text(at + 2))) {
            return Some((end, 3));
        }
        let stem = ["bound", "bounds", "erly", "ward", "wards"].into_iter().find_map(|end| word.strip_suffix(end));
        if let Some(compass) = stem.and_then(direction) {
            return Some((compass, 1));
        }
        // "n/b": one mark between the two letters.
        let slashed = |next: &Token| next.text == "b" && next.start == self.tokens[at].end + 1;
        if self.tokens.get(at + 1).is_some_and(slashed) {
            return letter(word).map(|compass| (compass, 2));
        }
        // "nb".
        if let Some(compass) = word.strip_suffix('b').and_then(letter) {
            return Some((compass, 1));
        }
        let (compass, length) = self.in_two_words(direction(word)?, at);
        if matches!(self.text(at + length), "bound" | "bounds") {
            return Some((compass, length + 1));
        }
        let place = matches!(self.text(at + length), "side" | "of" | "corner" | "end" | "leg" | "curb" | "crosswalk");
        (!place && !self.is_in_a_name(at, length)).then_some((compass, length))
    }

    /// "south west bound": a direction with the one behind it, and its tokens.
    fn in_two_words(&self, compass: Compass, at: usize) -> (Compass, usize) {
        let next = self.text(at + 1);
        let second = next.strip_suffix("bound").and_then(direction).or_else(|| direction(next));
        let (Compass::North | Compass::South, Some(second)) = (compass, second) else { return (compass, 1) };
        let both = match (compass, second) {
            (Compass::North, Compass::East) => Compass::Northeast,
            (Compass::North, Compass::West) => Compass::Northwest,
            (Compass::South, Compass::East) => Compass::Southeast,
            (Compass::South, Compass::West) => Compass::Southwest,
            _ => compass,
        };
        (both, 2)
    }

    /// A street's name: "on West Elm Street", "US-9 South".
    fn is_in_a_name(&self, at: usize, length: usize) -> bool {
        let capital = self.tokens[at].capital;
        let named_behind = self
            .tokens
            .get(at + length)
            .is_some_and(|next| next.capital && next.kind != TokenKind::Name || capital && next.text.contains("xxx"));
        let named_before = at > self.first && self.tokens[at - 1].kind == TokenKind::Number;
        named_before || capital && (named_behind || self.text(at.wrapping_sub(1)) == "street")
    }

    /// A lane, and its tokens: "the left turn lane", "the shoulder".
    pub(super) fn lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let word = self.text(at);
        if word == "shoulder" {
            return (!self.is_of_a_body(at)).then_some((LaneWord::Shoulder, 1));
        }
        if let Some((lane, length)) = self.counted_lane(at).or_else(|| self.counted_turn_lane(at)) {
            // "the second lane from the left among the lanes for left turns".
            let of = at + length;
            let among = matches!(self.text(of), "among" | "of") && self.text(of + 1) == "the";
            let turns =
                self.lane(of + 2).filter(|(lane, _)| among && matches!(lane, LaneWord::LeftTurn | LaneWord::RightTurn));
            return turns.map(|(lane, more)| (lane, length + 2 + more)).or(Some((lane, length)));
        }
        if let Some(numbered) = self.numbered_lane(at).or_else(|| self.ordinal_lane(at)) {
            return Some(numbered);
        }
        let two_way = word == "two" && self.text(at + 1) == "way";
        if let Some(that) = self.that_lane(at) {
            return Some(that);
        }
        if matches!(word, "lane" | "lanes") {
            return self.told_behind_lane(at).map(|(lane, length)| (lane, 1 + length));
        }
        if let Some(one) = self.one_of_lanes(at) {
            return Some(one);
        }
        if !in_lane_names(word) || !two_way && only_inside_lane_names(word) {
            return None;
        }
        let end = (at..self.tokens.len().min(at + LONGEST_LANE_NAME)).find(|&behind| {
            let inside = in_lane_names(self.text(behind)) || self.compass(behind).is_some();
            !inside && self.tokens[behind].kind != TokenKind::Number && !self.is_of_them(at, behind)
        });
        let end = end.unwrap_or(self.tokens.len().min(at + LONGEST_LANE_NAME));
        let has = |words: &[&str]| (at..end).any(|at| words.contains(&self.text(at)));
        let pocket = matches!(self.text(end), "pocket" | "bay") && has(TURN)
            || self.text(end) == "track" && has(&["cycle", "bike", "bicycle"]);
        if !pocket && !matches!(self.text(end), "lane" | "lanes") {
            return None;
        }
        let named = LANES.iter().find(|(names, _)| names.iter().all(|words| has(words))).map(|(_, lane)| *lane);
        // "the bike-shared lane" is one for all.
        let named = named.filter(|lane| *lane != LaneWord::Bike || !has(&["shared"]));
        let other = has(TURN) && has(OF_TWO) && !has(&["left", "right", "leftmost", "rightmost"]);
        let named = if other { self.turn_lanes_before(at).or(named) } else { named };
        if let Some((lane, length)) = self.told_behind_lane(end) {
            // "the left turn lane farthest to the right".
            let turns = named.filter(|lane| matches!(lane, LaneWord::LeftTurn | LaneWord::RightTurn));
            return Some((turns.unwrap_or(lane), end + 1 + length - at));
        }
        // "the left adjacent lane" is a place beside somebody, and is told as a relation.
        if has(&["adjacent", "next", "neighboring"]) {
            return None;
        }
        Some((named?, end + 1 - at))
    }

    /// "the shoulder of the pedestrian", "the cyclist's shoulder": no part of the road.
    fn is_of_a_body(&self, at: usize) -> bool {
        let somebody = |noun: &Noun| {
            let rides = |kind: Kind| matches!(kind.group(), KindGroup::OnFoot | KindGroup::Cyclist);
            noun.occupant.is_some() || noun.kind.is_some_and(rides)
        };
        let of = self.text(at + 1) == "of" && self.noun(at + 2).is_some_and(|(noun, _)| somebody(&noun));
        let owned = at > self.first + 1 && self.text(at - 1) == "'s";
        // "the highway's shoulder".
        let of_road = owned
            && matches!(
                self.text(at - 2),
                "highway" | "freeway" | "interstate" | "road" | "roadway" | "street" | "avenue" | "ramp" | "lane"
            );
        of || owned && !of_road
    }

    /// "the inner of two left turn lanes, and a van in the outer turn lane": that is for the same turn.
    fn turn_lanes_before(&self, at: usize) -> Option<LaneWord> {
        let before = (at.saturating_sub(LANES_BEFORE)..at).rev();
        before.filter(|at| TURN.contains(&self.text(at + 1))).find_map(|at| match self.text(at) {
            "left" => Some(LaneWord::LeftTurn),
            "right" => Some(LaneWord::RightTurn),
            _ => None,
        })
    }

    /// "the rightmost of the three lanes", "the right one of two lanes": small words between.
    fn is_of_them(&self, first: usize, at: usize) -> bool {
        let count = |at: usize| {
            number(self.text(at)).is_some()
                || matches!(
                    self.text(at),
                    "turn"
                        | "through"
                        | "travel"
                        | "designated"
                        | "dedicated"
                        | "northbound"
                        | "southbound"
                        | "eastbound"
                        | "westbound"
                )
        };
        // "to the left of the two lanes" is a place.
        let place = first >= 2 && self.text(first - 1) == "the" && self.text(first - 2) == "to";
        match self.text(at) {
            "its" if self.text(at + 1) == "lanes" => !place && self.text(at - 1) == "of",
            "the" | "its" | "these" | "those" => !place && self.text(at - 1) == "of" && count(at + 1),
            "several" | "multiple" | "five" | "six" => !place && self.text(at - 1) == "of",
            "one" => self.text(at + 1) == "of",
            _ => false,
        }
    }

    /// "A van was unloading in the rightmost lane, and it stopped in that lane": the one that was named last.
    fn that_lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let that = self.text(at) == "that" && self.text(at + 1) == "lane";
        if !that || at < 2 || !matches!(self.text(at - 1), "in" | "within") {
            return None;
        }
        let last = (at.saturating_sub(LANES_BEFORE)..at - 1).rfind(|&at| self.text(at) == "lane")?;
        let named = (last.saturating_sub(LONGEST_LANE_NAME)..=last).filter(|&at| in_lane_names(self.text(at)));
        let (lane, _) = named.filter_map(|at| self.lane(at).filter(|(_, length)| at + length > last)).next()?;
        Some((lane, 2))
    }

    /// "The street has three lanes, and it was in the right one": one of those that were named before.
    fn one_of_lanes(&self, at: usize) -> Option<(LaneWord, usize)> {
        let word = self.text(at);
        let named = at >= 2
            && matches!(self.text(at - 1), "the" | "its")
            && matches!(self.text(at - 2), "in" | "within" | "using" | "into" | "to" | "toward" | "towards")
            && (at.saturating_sub(LANES_BEFORE)..at).any(|at| self.text(at) == "lanes");
        // "in the one farthest right".
        if let (true, "one", Some((lane, length))) = (named, word, self.told_behind_lane(at)) {
            return Some((lane, 1 + length));
        }
        if !named || self.text(at + 1) != "one" || self.text(at + 2) == "of" {
            return None;
        }
        let side = |words: &[&str]| words.contains(&word);
        let lane = match () {
            () if side(LEFT) => LaneWord::Left,
            () if side(RIGHT) => LaneWord::Right,
            () if side(&["center", "middle", "centre"]) => LaneWord::Center,
            () => return None,
        };
        Some((lane, 2))
    }

    /// What the words behind "lane" make of it, and their tokens: "farthest to the left", "for left turns", "2 of 3".
    fn told_behind_lane(&self, lane: usize) -> Option<(LaneWord, usize)> {
        let behind = lane + 1;
        // "just left of the slip lane for right turns".
        if lane > 0 && self.text(lane - 1) == "slip" {
            return None;
        }
        let side_at = |at: usize| match self.text(at) {
            "left" => Some(LaneWord::Left),
            "right" => Some(LaneWord::Right),
            _ => None,
        };
        let the = |at: usize| at + usize::from(self.text(at) == "the");
        match self.text(behind) {
            "farthest" | "furthest" | "nearest" | "closest" => {
                let to = behind + 1 + usize::from(matches!(self.text(behind + 1), "to" | "on"));
                let side = the(to);
                // "the lane closest to the curb".
                let near = matches!(self.text(behind), "nearest" | "closest");
                let lane = match self.text(side) {
                    "curb" | "sidewalk" | "shoulder" if near => Some(LaneWord::Right),
                    "median" | "centerline" if near => Some(LaneWord::Left),
                    _ => side_at(side),
                }?;
                let end = side + 1 + usize::from(self.text(side + 1) == "side");
                (self.text(end) != "of").then_some((lane, end - behind))
            }
            "on" | "at" if self.text(behind + 1) == "the" && self.text(behind + 2) == "far" => {
                Some((side_at(behind + 3)?, 4))
            }
            "second" | "third" | "fourth" | "2nd" | "3rd" | "4th" if self.text(behind + 1) == "from" => {
                let side = the(behind + 2);
                side_at(side).map(|_| (LaneWord::Center, side + 1 - behind))
            }
            "for" | "reserved" | "designated" | "dedicated" | "meant" | "marked" | "intended" => self.lane_for(behind),
            _ => {
                let at = behind + usize::from(self.text(behind) == "number");
                // "lane number 2, the leftmost".
                let named: Vec<&str> = (at + 1..at + 4).map(|at| self.text(at)).collect();
                if let (Some(_), [",", "the", side @ ("leftmost" | "rightmost")]) =
                    (count(self.text(at)), named.as_slice())
                {
                    let lane = if *side == "leftmost" { LaneWord::Left } else { LaneWord::Right };
                    return Some((lane, at + 4 - behind));
                }
                let many = if self.text(at + 1) == "of" { count(self.text(at + 2)) } else { None };
                if many.is_none() && !self.is_name_of_lane(lane) {
                    return None;
                }
                let named = of_so_many(count(self.text(at))?, many)?;
                Some((named, at + if many.is_some() { 3 } else { 1 } - behind))
            }
        }
    }

    /// "in lane 3", "from lane 4 into lane 3 of the highway": a number behind "lane" is its name where no article stands before that; not
    /// "changed lane 2 seconds before".
    fn is_name_of_lane(&self, lane: usize) -> bool {
        let before = matches!(self.text(lane.wrapping_sub(1)), "in" | "into" | "from" | "to" | "within" | "out" | "of");
        let ends = matches!(self.text(lane + 2), "." | "," | ";" | ")" | "of" | "on" | "in" | "into" | "to" | "and");
        let ends =
            ends || matches!(self.text(lane + 2), "" | "when" | "while" | "as" | "with" | "at" | "for" | "behind");
        self.text(lane) == "lane" && before && ends
    }

    /// "(a lane) reserved for right turns", "for turning left", "for parking".
    fn lane_for(&self, at: usize) -> Option<(LaneWord, usize)> {
        let to = at + usize::from(self.text(at) != "for");
        if !matches!(self.text(to), "for" | "to") {
            return None;
        }
        let from = to + 1 + usize::from(self.text(to + 1) == "making");
        let (one, two) = (self.text(from), self.text(from + 1));
        let (lane, words) = match (one, two) {
            ("left", "turn" | "turns" | "turning") | ("turning" | "turns", "left") => (LaneWord::LeftTurn, 2),
            ("right", "turn" | "turns" | "turning") | ("turning" | "turns", "right") => (LaneWord::RightTurn, 2),
            ("parking", _) => (LaneWord::Curb, 1),
            ("bicycles" | "cyclists" | "bikes" | "bicyclists", _) => (LaneWord::Bike, 1),
            ("buses", _) => (LaneWord::Bus, 1),
            ("oncoming" | "opposing", "traffic" | "vehicles") => (LaneWord::Opposing, 2),
            _ => return None,
        };
        Some((lane, from + words - at))
    }

    /// "partially in the left lane and partially in the parking lane": in neither alone, of a lane and a strip.
    pub(super) fn is_partly_there(&self, at: usize) -> bool {
        let partly = |at: usize| matches!(self.text(at), "partially" | "partly" | "partway");
        let in_name = |at: &usize| in_lane_names(self.text(*at)) || matches!(self.text(*at), "the" | "a" | "its");
        let from = (self.first..at).rev().take(LONGEST_LANE_NAME).take_while(in_name).last().unwrap_or(at);
        let inside = from >= self.first + 2 && matches!(self.text(from - 1), "in" | "within" | "on" | "inside");
        if !inside || !partly(from - 2) {
            return false;
        }
        let mut near = from.saturating_sub(2 + BOTH_WITHIN).max(self.first)..(at + BOTH_WITHIN).min(self.tokens.len());
        let strip = |at: usize| {
            matches!(self.text(at), "parking" | "bike" | "bicycle" | "curb" | "shoulder") && self.text(at + 1) == "lane"
        };
        near.clone().any(strip) && near.any(|at| at != from - 2 && partly(at))
    }

    /// "the second lane from the right", "the second from the right lane": neither the first nor the last.
    fn counted_lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        // "the first lane from the right".
        if let ("first" | "1st", "lane", "from") = (self.text(at), self.text(at + 1), self.text(at + 2)) {
            let side = at + 3 + usize::from(self.text(at + 3) == "the");
            let lane = match self.text(side) {
                "left" => LaneWord::Left,
                "right" => LaneWord::Right,
                _ => return None,
            };
            return Some((lane, side + 1 - at));
        }
        if !matches!(self.text(at), "second" | "third" | "fourth" | "2nd" | "3rd" | "4th" | "number") {
            return None;
        }
        // "the second of the three lanes".
        let of = at + 1;
        let many = of + 1 + usize::from(matches!(self.text(of + 1), "the" | "its"));
        if self.text(of) == "of" && self.text(many + 1) == "lanes" {
            let number = match self.text(at) {
                "second" | "2nd" => 2,
                "third" | "3rd" => 3,
                _ => return None,
            };
            // From which side it is counted is not told.
            let many = count(self.text(many)).filter(|many| number < *many)?;
            return (many > 2)
                .then_some((LaneWord::Center, (at..at + 6).find(|&at| self.text(at) == "lanes")? + 1 - at));
        }
        // "the second from the right westbound lane".
        let named: Vec<usize> = (at + 1..at + 7).filter(|&at| !self.text(at).ends_with("bound")).take(5).collect();
        let words: Vec<&str> = named.iter().map(|&at| self.text(at)).collect();
        let count = match words.as_slice() {
            ["lane", "from", "the", "left" | "right" | "leftmost" | "rightmost", ..]
            | ["from", "the", "left" | "right" | "leftmost" | "rightmost", "lane", ..]
            | ["to", "the", "left" | "right", "lane", ..] => 5,
            ["lane", "from", "left" | "right", ..]
            | ["from", "left" | "right" | "leftmost" | "rightmost", "lane", ..]
            | ["to", "left" | "right", "lane", ..] => 4,
            ["leftmost" | "rightmost", "lane", ..] => 3,
            _ => return None,
        };
        Some((LaneWord::Center, named[count - 2] + 1 - at))
    }

    /// "the second from the right designated right turn lane": a lane for turns all the same.
    fn counted_turn_lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let counts = matches!(self.text(at), "second" | "third" | "2nd" | "3rd") && self.text(at + 1) == "from";
        let side = at + 2 + usize::from(self.text(at + 2) == "the");
        if !counts || !matches!(self.text(side), "left" | "right" | "leftmost" | "rightmost") {
            return None;
        }
        let (lane, length) = self.lane(side + 1)?;
        matches!(lane, LaneWord::LeftTurn | LaneWord::RightTurn).then_some((lane, side + 1 + length - at))
    }

    /// "the number 2 lane (of 3)", "the #1 lane": lanes are counted from the left.
    fn numbered_lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let (number, from) = match self.text(at).strip_prefix('#') {
            Some(digits) if !digits.is_empty() => (count(digits)?, at + 1),
            _ if self.text(at) == "number" => (count(self.text(at + 1))?, at + 2),
            _ => return None,
        };
        let lane = (from..from + 3).find(|&at| self.text(at) == "lane")?;
        // "partially in the number 2 lane": and in another one.
        let partly = at >= 3 && matches!(self.text(at - 3), "partially" | "partly");
        if partly || !(from..lane).all(|at| in_lane_names(self.text(at)) || self.compass(at).is_some()) {
            return None;
        }
        if self.text(lane + 1) == "("
            && let Some((_, named)) =
                LANES.iter().find(|(names, _)| names.iter().all(|words| words.contains(&self.text(lane + 2))))
        {
            return Some((*named, lane + 3 - at));
        }
        let of = lane + 1 + usize::from(self.text(lane + 1) == "(");
        let many = if self.text(of) == "of" { count(self.text(of + 1)) } else { None };
        let end = if many.is_some() { of + 2 } else { lane + 1 };
        Some((of_so_many(number, many)?, end - at))
    }

    /// "the second lane on a four-lane section": in the middle, where more are told than that; "in the second lane" is too, on any road.
    fn ordinal_lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let number = match self.text(at) {
            "second" | "2nd" => 2,
            "third" | "3rd" => 3,
            _ => return None,
        };
        let lane = at + 1 + usize::from(matches!(self.text(at + 1), "travel" | "through" | "traffic" | "driving"));
        let ends =
            matches!(self.text(lane + 1), "." | "," | "and" | "when" | "while" | "as" | "with" | "behind" | "at");
        let plain = at >= 2 && self.text(at - 1) == "the" && matches!(self.text(at - 2), "in" | "within");
        if number == 2 && plain && ends && self.text(lane) == "lane" {
            return Some((LaneWord::Center, lane + 1 - at));
        }
        let on = matches!(self.text(lane + 1), "of" | "on" | "in") && matches!(self.text(lane + 2), "a" | "an" | "the");
        let many = count(self.text(lane + 3)).filter(|_| on && matches!(self.text(lane + 4), "lane" | "lanes"))?;
        // From which side it is counted is not told.
        let between = self.text(lane) == "lane" && number < many;
        between.then_some((LaneWord::Center, lane + 1 - at))
    }

    /// "near a pedestrian crossing". "It hit a pedestrian crossing" tells of somebody.
    pub(super) fn is_behind_a_place_word(&self, at: usize) -> bool {
        let back = |by: usize| at.checked_sub(by).map_or("", |at| self.text(at));
        let before = if DETERMINERS.contains(&back(1)) { back(2) } else { back(1) };
        matches!(
            before,
            "at" | "near" | "through" | "of" | "past" | "before" | "approaching" | "approached" | "toward" | "towards"
        )
    }

    /// "from a", "out of the nearby": a place that somebody leaves stands behind.
    fn is_come_out_of(&self, at: usize) -> bool {
        let from = (at.saturating_sub(3)..at)
            .rfind(|&at| self.text(at) == "from" || self.text(at) == "of" && at > 0 && self.text(at - 1) == "out");
        from.is_some_and(|from| from + 1 < at && super::is_determiner(self.text(from + 1)))
    }

    /// A place beside the road, and its tokens: "a parking stall", "an alley".
    pub(super) fn spot(&self, at: usize) -> Option<(Spot, usize)> {
        let (one, two) = (self.text(at), self.text(at + 1));
        Some(match (one, two) {
            (
                "parking" | "angled" | "perpendicular" | "diagonal",
                "space" | "spot" | "stall" | "spaces" | "spots" | "stalls" | "position",
            ) => (Spot::Stall, 2),
            ("angled" | "perpendicular" | "diagonal", "parking")
                if matches!(self.text(at + 2), "space" | "spot" | "stall") =>
            {
                (Spot::Stall, 3)
            }
            ("parking", "lot" | "garage" | "area" | "structure") => (Spot::Driveway, 2),
            ("stall" | "carport", _) => (Spot::Stall, 1),
            // "out of a construction area", "from a work site": beside the road, where nobody drives through it.
            ("construction" | "work" | "job" | "building" | "loading" | "staging", "area" | "site" | "yard")
                if self.is_come_out_of(at) =>
            {
                (Spot::Driveway, 2)
            }
            // Not "the toll plaza", "the field of view".
            ("jobsite" | "yard" | "depot" | "plaza" | "property" | "farm" | "field" | "barn", next)
                if self.is_come_out_of(at)
                    && next != "of"
                    && at.checked_sub(1).is_none_or(|at| self.text(at) != "toll") =>
            {
                (Spot::Driveway, 1)
            }
            // "pulled out of that exit": of a lot, and no ramp.
            ("exit", next)
                if self.is_come_out_of(at) && !matches!(next, "ramp" | "ramps" | "lane" | "lanes" | "door" | "of") =>
            {
                (Spot::Driveway, 1)
            }
            // "out of a space", "from its spot".
            ("space" | "spot" | "bay", _)
                if at >= 2
                    && matches!(self.text(at - 1), "a" | "its" | "the" | "his" | "her" | "their")
                    && matches!(self.text(at - 2), "of" | "from") =>
            {
                (Spot::Stall, 1)
            }
            ("parking" | "loading", "bay") => (Spot::Stall, 2),
            ("car", "park") | ("service" | "filling", "station") => (Spot::Driveway, 2),
            ("minor" | "intersecting" | "crossing", "street" | "road") => (Spot::SideStreet, 2),
            ("gas", "station") | ("driveway", "exit") => (Spot::Driveway, 2),
            ("shopping" | "strip" | "apartment", "center" | "mall" | "plaza" | "complex") | ("car", "wash") => {
                (Spot::Driveway, 2)
            }
            ("driveway" | "garage" | "alley" | "alleyway" | "lot", _) => (Spot::Driveway, 1),
            ("sidewalk", _) => (Spot::Sidewalk, 1),
            ("side" | "cross", "street" | "road") => (Spot::SideStreet, 2),
            _ => return None,
        })
    }
}
