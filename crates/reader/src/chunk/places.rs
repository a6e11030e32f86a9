//! Directions, lanes and places beside the road.

use super::{Chunker, Spot};
use crate::token::TokenKind;
use recrash_model::account::{Compass, LaneWord};

impl Chunker<'_> {
    /// One of eight directions, and its tokens.
    pub(super) fn compass(&self, at: usize) -> Option<(Compass, usize)> {
        let word = self.text(at);
        let bare = |word: &str| -> Option<Compass> {
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
        };
        // "going east to west": where it ends.
        if let (Some(_), "to", Some(end)) = (bare(word), self.text(at + 1), bare(self.text(at + 2))) {
            return Some((end, 3));
        }
        let stem =
            word.strip_suffix("bound").or_else(|| word.strip_suffix("bounds")).or_else(|| word.strip_suffix("erly"));
        if let Some(compass) = stem.filter(|stem| !stem.is_empty()).and_then(bare) {
            return Some((compass, 1));
        }
        match word {
            "nb" => return Some((Compass::North, 1)),
            "sb" => return Some((Compass::South, 1)),
            "eb" => return Some((Compass::East, 1)),
            "wb" => return Some((Compass::West, 1)),
            _ => {}
        }
        let mut compass = bare(word)?;
        let mut length = 1;
        // "south west bound".
        if let (Compass::North | Compass::South, Some(second)) =
            (compass, self.text(at + 1).strip_suffix("bound").and_then(bare).or_else(|| bare(self.text(at + 1))))
        {
            compass = match (compass, second) {
                (Compass::North, Compass::East) => Compass::Northeast,
                (Compass::North, Compass::West) => Compass::Northwest,
                (Compass::South, Compass::East) => Compass::Southeast,
                (Compass::South, Compass::West) => Compass::Southwest,
                _ => compass,
            };
            length = 2;
        }
        if self.text(at + length) == "bound" || self.text(at + length) == "bounds" {
            return Some((compass, length + 1));
        }
        // A street's name: "on West Elm Street", "US-9 South".
        let token = &self.tokens[at];
        let named_behind =
            self.tokens.get(at + length).is_some_and(|next| next.capital && next.kind != TokenKind::Name);
        let named_before = at > self.first && self.tokens[at - 1].kind == TokenKind::Number;
        if (token.capital && named_behind)
            || named_before
            || (token.capital && self.text(at.wrapping_sub(1)) == "street")
        {
            return None;
        }
        matches!(self.text(at + length), "side" | "of" | "corner" | "end" | "leg" | "curb" | "crosswalk")
            .then_some(())
            .map_or(Some((compass, length)), |()| None)
    }

    pub(super) fn lane(&self, at: usize) -> Option<(LaneWord, usize)> {
        let word = self.text(at);
        if word == "shoulder" {
            return Some((LaneWord::Shoulder, 1));
        }
        // "the second lane from the right", "the second from the right lane": neither the first nor the last.
        if matches!(word, "second" | "third" | "2nd" | "3rd" | "number") {
            let words: Vec<&str> = (at + 1..at + 6).map(|at| self.text(at)).collect();
            match words.as_slice() {
                ["lane", "from", "the", "left" | "right", ..] | ["from", "the", "left" | "right", "lane", ..] => {
                    return Some((LaneWord::Center, 5));
                }
                ["lane", "from", "left" | "right", ..] => return Some((LaneWord::Center, 4)),
                ["lane", "from", "the", "leftmost" | "rightmost", ..]
                | ["from", "the", "leftmost" | "rightmost", "lane", ..] => {
                    return Some((LaneWord::Center, 5));
                }
                ["from", "leftmost" | "rightmost", "lane", ..] => return Some((LaneWord::Center, 4)),
                ["to", "the", "left" | "right", "lane", ..] => return Some((LaneWord::Center, 5)),
                ["to" | "from", "left" | "right", "lane", ..] => return Some((LaneWord::Center, 4)),
                ["leftmost" | "rightmost", "lane", ..] => return Some((LaneWord::Center, 3)),
                _ => {}
            }
        }
        let modifier = |word: &str| {
            matches!(
                word,
                "left"
                    | "of"
                    | "two"
                    | "three"
                    | "four"
                    | "right"
                    | "leftmost"
                    | "rightmost"
                    | "most"
                    | "center"
                    | "centre"
                    | "middle"
                    | "turn"
                    | "turning"
                    | "only"
                    | "hand"
                    | "through"
                    | "dedicated"
                    | "travel"
                    | "bike"
                    | "bicycle"
                    | "bus"
                    | "hov"
                    | "far"
                    | "adjacent"
                    | "number"
                    | "inside"
                    | "outside"
                    | "curb"
                    | "parking"
                    | "opposing"
                    | "opposite"
                    | "oncoming"
                    | "designated"
                    | "and"
                    | "second"
                    | "carpool"
                    | "same"
                    | "thru"
                    | "traffic"
                    | "driving"
                    | "merge"
                    | "slow"
                    | "fast"
                    | "passing"
                    | "straight"
                    | "next"
                    | "neighboring"
                    | "emergency"
            )
        };
        if !modifier(word) || matches!(word, "and" | "of" | "two" | "three" | "four") {
            return None;
        }
        let mut end = at;
        while end < self.tokens.len() && end < at + 7 {
            let here = self.text(end);
            if matches!(here, "lane" | "lanes") {
                break;
            }
            if !modifier(here) && self.compass(end).is_none() && self.tokens[end].kind != TokenKind::Number {
                return None;
            }
            end += 1;
        }
        if !matches!(self.text(end), "lane" | "lanes") {
            return None;
        }
        let words: Vec<&str> = (at..end).map(|at| self.text(at)).collect();
        let has = |word: &str| words.contains(&word);
        let left = has("left") || has("leftmost") || has("inside") || has("fast");
        let right = has("right") || has("rightmost") || has("outside") || has("slow");
        let turn = has("turn") || has("turning");
        let adjacent = has("adjacent") || has("next") || has("neighboring");
        // "the left adjacent lane" is a place beside somebody, and is told as a relation.
        if adjacent {
            return None;
        }
        let lane = if has("bike") || has("bicycle") {
            LaneWord::Bike
        } else if has("bus") {
            LaneWord::Bus
        } else if has("opposing") || has("opposite") || has("oncoming") {
            LaneWord::Opposing
        } else if has("parking") || has("curb") {
            LaneWord::Curb
        } else if has("emergency") {
            LaneWord::Shoulder
        } else if turn && left {
            LaneWord::LeftTurn
        } else if turn && right {
            LaneWord::RightTurn
        } else if left {
            LaneWord::Left
        } else if right {
            LaneWord::Right
        } else if has("center") || has("middle") || has("centre") {
            LaneWord::Center
        } else {
            return None;
        };
        Some((lane, end + 1 - at))
    }

    pub(super) fn spot(&self, at: usize) -> Option<(Spot, usize)> {
        let (one, two) = (self.text(at), self.text(at + 1));
        Some(match (one, two) {
            (
                "parking" | "angled" | "perpendicular",
                "space" | "spot" | "stall" | "spaces" | "spots" | "stalls" | "position",
            ) => (Spot::Stall, 2),
            ("angled" | "perpendicular", "parking") if matches!(self.text(at + 2), "space" | "spot" | "stall") => {
                (Spot::Stall, 3)
            }
            ("parking", "lot" | "garage" | "area" | "structure") => (Spot::Driveway, 2),
            ("stall" | "carport", _) => (Spot::Stall, 1),
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
            ("driveway" | "garage" | "alley" | "alleyway" | "lot", _) => (Spot::Driveway, 1),
            ("sidewalk", _) => (Spot::Sidewalk, 1),
            ("side" | "cross", "street" | "road") => (Spot::SideStreet, 2),
            _ => return None,
        })
    }
}
