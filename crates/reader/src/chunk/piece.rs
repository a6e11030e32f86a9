//! Parts of vehicles: "the rear bumper of the van", "its left side mirror".

use super::noun::can_own;
use super::{Chunk, Chunker, DETERMINERS, Noun, Piece, Placed};
use crate::lexicon::{Meaning, Part};
use crate::token::TokenKind;

/// Most tokens that name one part.
const LONGEST_PIECE: usize = 14;

/// A part that is being read.
struct Draft {
    piece: Piece,
    /// The token behind what is read.
    at: usize,
    /// How many words name a part, and not only where it is.
    nouns: usize,
}

impl Draft {
    fn add(&mut self, part: Part) {
        if !self.piece.parts.contains(&part) {
            self.piece.parts.push(part);
        }
    }
}

impl Chunker<'_> {
    /// A part of a vehicle, with whose it is.
    pub(super) fn piece(&self, first: usize) -> Option<(Piece, usize)> {
        let determined = DETERMINERS.contains(&self.text(first));
        if self.names_no_part(first, determined) {
            return None;
        }
        let its = matches!(self.text(first), "its" | "their" | "his" | "her");
        let piece = Piece { parts: Vec::new(), door: false, mirror: false, open: false, owner: None, its };
        let own = usize::from(determined && self.text(first + 1) == "own");
        let mut draft = Draft { piece, at: first + usize::from(determined) + own, nouns: 0 };
        self.parts(first, &mut draft);
        if draft.piece.parts.is_empty() || draft.at == first {
            return None;
        }
        if self.text(first) == "our" {
            draft.piece.owner = Some(Noun { subject: true, ..Noun::unnamed() });
        }
        let draft = match self.text(draft.at) {
            "of" => match self.of_a_door(&draft) {
                Some((piece, end)) => return Some((piece, end - first)),
                None => self.of_whom(draft)?,
            },
            // "a sensor at its front right".
            "at" | "on"
                if draft.piece.parts == [Part::Noun]
                    && matches!(self.text(draft.at + 1), "its" | "their" | "the")
                    && self.names_a_corner(draft.at + 2) =>
            {
                draft.piece.its = self.text(draft.at + 1) != "the";
                self.further_parts(draft.at + 2, &mut draft);
                if self.text(draft.at) == "of" { self.of_whom(draft)? } else { draft }
            }
            // "a sensor on the roof of the AV", "the lidar on top of it".
            "on" if draft.piece.parts == [Part::Noun] && self.on_top(draft.at + 1).is_some() => {
                let at = self.on_top(draft.at + 1)?;
                self.further_parts(at, &mut draft);
                if self.text(draft.at) == "of" { self.of_whom(draft)? } else { draft }
            }
            "on" if draft.nouns > 0 => {
                self.on_the_side(&mut draft);
                if matches!(self.text(draft.at), "of" | "on") { self.of_whom(draft)? } else { draft }
            }
            _ => draft,
        };
        let mut draft = draft;
        self.side_told_behind(&mut draft);
        self.end_told_behind(&mut draft);
        (self.is_sure(first, &draft) && !self.is_side_of_road(&draft)).then_some((draft.piece, draft.at - first))
    }

    /// Whether words that may name a part name a thing by itself, a lane, where somebody is, or a place.
    fn names_no_part(&self, first: usize, determined: bool) -> bool {
        // "a van, left of it, turned": where it was.
        let aside = matches!(self.text(first), "left" | "right") && self.text(first + 1) == "of";
        // "at the west side of the curb": a place.
        let of_street = || {
            self.compass_word(first - 1)
                && self.text(first) == "side"
                && (first..first + 4).any(|at| self.text(at) == "curb")
        };
        self.loose_wheel(first).is_some()
            || self.loose_part(first).is_some()
            // "its right lane" is a lane of the road.
            || determined && self.lane(first + 1).is_some()
            || first > self.first
                && (aside && self.tokens[first - 1].kind == TokenKind::Mark || of_street())
    }

    /// Reads the words of a part: "open rear passenger side door".
    fn parts(&self, first: usize, draft: &mut Draft) {
        let mut at = draft.at;
        let mut read = at;
        while at < self.tokens.len().min(first + LONGEST_PIECE) {
            let word = self.text(at);
            if matches!(word, "open" | "opened" | "opening") && self.tokens.get(at + 1).is_some() {
                (draft.piece.open, at) = (true, at + 1);
                continue;
            }
            if self.goes_on(at, &draft.piece.parts) {
                at += 1;
                continue;
            }
            let Some((part, length)) = self.part(at) else { break };
            let named = |names: &[&str]| (at..at + length).any(|at| names.contains(&self.text(at)));
            draft.piece.door |= named(&["door", "doors"]);
            draft.piece.mirror |= named(&["mirror"]);
            draft.nouns += usize::from(part == Part::Noun || named(&["side", "end"]));
            // "the driver side rear passenger door": whose seat it is at, and no side.
            let seat = self.text(at) == "passenger" && length == 1 && draft.piece.parts.contains(&Part::Left);
            if !(seat && matches!(self.text(at + 1), "door" | "doors")) {
                draft.add(part);
            }
            at += length;
            read = at;
        }
        draft.at = at.min(read.max(first));
    }

    /// Whether a small word here stands within a part.
    fn goes_on(&self, at: usize, parts: &[Part]) -> bool {
        if parts.is_empty() {
            return false;
        }
        match self.text(at) {
            // "the roof-mounted sensor dome".
            "mounted" => self.part(at + 1).is_some(),
            "and" => self.part(at + 1).is_some() && self.noun(at + 1).is_none(),
            // "its front, passenger side bumper".
            "," => {
                let side = matches!(self.part(at + 1), Some((Part::Left | Part::Right, length)) if self.part(at + 1 + length).is_some());
                parts.iter().all(|part| matches!(part, Part::Front | Part::Rear)) && side
            }
            _ => false,
        }
    }

    /// "the front corner on the driver side".
    fn on_the_side(&self, draft: &mut Draft) {
        let ends = draft.piece.parts.iter().any(|part| matches!(part, Part::Front | Part::Rear));
        let sided = draft.piece.parts.iter().any(|part| matches!(part, Part::Left | Part::Right));
        let end = ends || draft.piece.mirror;
        if !end || sided || !matches!(self.text(draft.at + 1), "the" | "its" | "our") {
            return;
        }
        if let Some((part @ (Part::Left | Part::Right), length)) = self.part(draft.at + 2) {
            draft.add(part);
            draft.at += 2 + length;
            draft.at += usize::from(self.text(draft.at) == "side");
        }
    }

    /// "the front bumper of the van, on the driver side,", "its rear on the passenger side": the side of an end.
    fn side_told_behind(&self, draft: &mut Draft) {
        let on = draft.at + usize::from(self.text(draft.at) == ",");
        let on = on + usize::from(on > draft.at && self.text(on) == "likewise");
        let before = (draft.at, draft.piece.parts.len());
        if self.text(on) == "on" {
            draft.at = on;
            self.on_the_side(draft);
            let sided = draft.piece.parts.len() > before.1 && self.text(draft.at - 1) == "side";
            if !sided || self.text(draft.at) == "of" {
                draft.at = before.0;
                draft.piece.parts.truncate(before.1);
            }
        }
    }

    /// "its left side near the rear", "the right side of the van, at the front,": the end of a side.
    fn end_told_behind(&self, draft: &mut Draft) {
        let at = draft.at + usize::from(self.text(draft.at) == ",");
        let ends = draft.piece.parts.iter().any(|part| matches!(part, Part::Front | Part::Rear));
        let sided = draft.piece.parts.iter().any(|part| matches!(part, Part::Left | Part::Right));
        let near = matches!(self.text(at), "at" | "near" | "toward" | "towards")
            && matches!(self.text(at + 1), "the" | "its" | "their");
        if ends || !sided || !near {
            return;
        }
        let Some((part @ (Part::Front | Part::Rear), length)) = self.part(at + 2) else { return };
        let mut end = at + 2 + length;
        // "the left side at the rear door", "near the front wheel": on the side all the same.
        let inner =
            (end..end + 3).take_while(|&at| self.tokens.get(at).is_some_and(|next| next.kind == TokenKind::Word));
        if inner.into_iter().any(|at| is_along_a_side(self.text(at))) {
            return;
        }
        while let Some((Part::Noun, length)) = self.part(end) {
            end += length;
        }
        if self.text(end) != "of" {
            draft.add(part);
            draft.at = end;
        }
    }

    /// "its bumper touched that of the van": the same part of another.
    pub(super) fn that_of(&self, at: usize, before: &[Placed]) -> Option<(Piece, usize)> {
        if self.text(at) != "that" || self.text(at + 1) != "of" {
            return None;
        }
        let named = before.iter().rev().find_map(|placed| match &placed.chunk {
            Chunk::Piece(piece) => Some(piece),
            _ => None,
        })?;
        let (owner, length) = self.noun(at + 2).filter(|(noun, _)| noun.subject || noun.kind.is_some_and(can_own))?;
        let piece = Piece { open: false, owner: Some(owner), its: false, ..named.clone() };
        let mut draft = Draft { piece, at: at + 2 + length, nouns: 1 };
        // "likewise on the left side".
        let mut unsided = Draft { piece: draft.piece.clone(), ..draft };
        unsided.piece.parts.retain(|part| !matches!(part, Part::Left | Part::Right));
        self.side_told_behind(&mut unsided);
        if unsided.at > draft.at {
            draft = unsided;
        }
        Some((draft.piece, draft.at - at))
    }

    /// The first word of the owner: "the rear of both the van and the bus" has one, the first.
    fn owner_at(&self, draft: &Draft) -> usize {
        let behind = draft.at + 1;
        behind + usize::from(self.text(behind) == "both")
    }

    /// "the edge of the open door": the door, and the token behind it.
    fn of_a_door(&self, draft: &Draft) -> Option<(Piece, usize)> {
        let behind = self.owner_at(draft);
        let door = (behind + 1..behind + 4).find(|&at| matches!(self.text(at), "door" | "doors"))?;
        if !DETERMINERS.contains(&self.text(behind)) {
            return None;
        }
        let (inner, length) = self.piece(behind).filter(|(inner, _)| inner.door)?;
        if door >= behind + length {
            return None;
        }
        let Piece { mut parts, mirror, open, its, .. } = draft.piece.clone();
        for part in inner.parts {
            if !parts.contains(&part) {
                parts.push(part);
            }
        }
        let (open, its) = (open || inner.open, its || inner.its);
        Some((Piece { parts, door: true, mirror, open, owner: inner.owner, its }, behind + length))
    }

    /// Whose it is by the words behind "of" or "on"; `None` where it is of nobody.
    fn of_whom(&self, mut draft: Draft) -> Option<Draft> {
        let behind = self.owner_at(&draft);
        let owner = self.noun(behind).filter(|(noun, _)| noun.subject || noun.kind.is_some_and(can_own));
        if let Some((owner, length)) = owner {
            draft.piece.owner = Some(owner);
            draft.at = behind + length;
            // "the center of the van's front bumper".
            if self.text(draft.at) == "'s" && self.part(draft.at + 1).is_some() {
                self.further_parts(draft.at + 1, &mut draft);
            }
        } else if let ("its" | "their", own) =
            (self.text(behind), behind + 1 + usize::from(self.text(behind + 1) == "own"))
            && self.part(own).is_some()
        {
            draft.piece.its = true;
            self.further_parts(own, &mut draft);
        } else if let ("of", "the", Some((inner, length))) =
            (self.text(draft.at), self.text(behind), self.piece(behind))
            && inner.owner.is_some() | inner.its | self.side_at(behind + 1).is_some()
        {
            // "the rear of the left side", "the left half of the rear bumper of the van".
            inner.parts.iter().for_each(|part| draft.add(*part));
            draft.piece = Piece { owner: inner.owner, its: inner.its, parts: draft.piece.parts, ..draft.piece };
            draft.at = behind + length;
        } else if self.text(behind) == "it" {
            (draft.piece.its, draft.at) = (true, behind + 1);
        } else if self.text(draft.at) == "of" {
            return None;
        }
        Some(draft)
    }

    /// Where "the roof", "top" stands behind "on".
    fn on_top(&self, at: usize) -> Option<usize> {
        let at = at + usize::from(matches!(self.text(at), "the" | "its"));
        matches!(self.part(at), Some((Part::Top, _))).then_some(at)
    }

    /// "right rear", "front left corner".
    fn names_a_corner(&self, at: usize) -> bool {
        let Some((one, length)) = self.part(at) else { return false };
        let other = self.part(at + length).map(|(part, _)| part);
        let end = |part: Part| matches!(part, Part::Front | Part::Rear);
        let side = |part: Part| matches!(part, Part::Left | Part::Right);
        other.is_some_and(|other| end(one) && side(other) || side(one) && end(other))
    }

    /// A side of a vehicle that is named here: "left side", "driver side".
    fn side_at(&self, at: usize) -> Option<Part> {
        let (part, length) = self.part(at).filter(|(part, _)| matches!(part, Part::Left | Part::Right))?;
        (self.text(at + length - 1) == "side" || self.text(at + length) == "side").then_some(part)
    }

    fn further_parts(&self, at: usize, draft: &mut Draft) {
        draft.at = at;
        while let Some((part, length)) = self.part(draft.at) {
            draft.add(part);
            draft.at += length;
        }
    }

    /// "the front", "the left" alone are places unless somebody owns them or a part is named.
    fn is_sure(&self, first: usize, draft: &Draft) -> bool {
        let Draft { piece, at, nouns } = draft;
        let placed = piece.parts.iter().any(|part| *part != Part::Noun);
        let possessed = first > self.first && self.text(first - 1) == "'s" && placed;
        let owned = piece.owner.is_some() || piece.its;
        // "a van whose front struck it".
        let whose = placed && first > self.first && self.text(first - 1) == "whose";
        let bare = whose || placed && self.text(first) == "the" && self.ends_clause(*at);
        let plain_noun = piece.parts == [Part::Noun] && !owned && !piece.door;
        let of_vehicles = matches!(
            self.text(at - 1),
            "mirror" | "bumper" | "sensor" | "wheel" | "tire" | "handlebar" | "handlebars" | "fender"
        );
        (owned || *nouns > 0 || possessed || bare) && (!plain_noun || of_vehicles)
    }

    /// "on the left side of the road".
    fn is_side_of_road(&self, draft: &Draft) -> bool {
        let Draft { piece, at, .. } = draft;
        matches!(self.text(at - 1), "side" | "lane" | "edge" | "hand")
            && piece.owner.is_none()
            && !piece.its
            && !piece.parts.iter().any(|part| matches!(part, Part::Front | Part::Rear))
            && matches!(self.text(at.wrapping_sub(2)), "left" | "right" | "hand")
            && self.text(*at) == "of"
    }

    fn ends_clause(&self, at: usize) -> bool {
        at >= self.tokens.len() || matches!(self.text(at), "," | "." | "and" | "by" | "when" | "while" | "as" | "with")
    }

    pub(super) fn part(&self, at: usize) -> Option<(Part, usize)> {
        let found = self.lexicon.longest(self.tokens, at, |meaning| matches!(meaning, Meaning::Part(_)))?;
        let Meaning::Part(part) = found.meaning else { return None };
        // "driver" and "passenger" are sides only before a part.
        let alone = found.length == 1 && matches!(self.text(at), "driver" | "drivers" | "passenger" | "passengers");
        if alone || (found.length == 2 && self.text(at + 1) == "'s") {
            let behind = at + found.length;
            let next = self.lexicon.longest(self.tokens, behind, |meaning| matches!(meaning, Meaning::Part(_)))?;
            let is_part = matches!(next.meaning, Meaning::Part(Part::Noun | Part::Front | Part::Rear));
            let person =
                matches!(self.text(behind), "side") || !matches!(self.text(behind), "back" | "body" | "arm" | "window");
            if !is_part || !person {
                return None;
            }
        }
        if matches!(self.text(at), "back")
            && matches!(self.text(at + 1), "to" | "into" | "onto" | "out" | "up" | "down" | "and" | "in")
        {
            return None;
        }
        if matches!(self.text(at), "light")
            && !matches!(self.text(at.wrapping_sub(1)), "tail" | "head" | "brake" | "side")
        {
            return None;
        }
        Some((part, found.length))
    }
}

/// Whether a part stands along a side, and at no corner: "the rear door", "the front wheel".
pub fn is_along_a_side(word: &str) -> bool {
    matches!(word, "door" | "doors" | "wheel" | "wheels" | "tire" | "tires" | "window" | "axle" | "pillar")
}
