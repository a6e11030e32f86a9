//! Phrases that say what other words of the lexicon say, put in those before anything is read: "while at a complete stop" stood, "changed from
//! the right lane" changed lanes, "Acme was driving" is its vehicle. The places of the tokens stay.

use super::stand;
use crate::lexicon::{Lexicon, Meaning, Sense};
use crate::token::{Token, TokenKind, word};

/// Rewords the tokens of a narrative.
pub(super) fn apply(tokens: &mut Vec<Token>) {
    join_most(tokens);
    name_system(tokens);
    brake(tokens);
    name_codes(tokens);
    hold_by_hand(tokens);
    name_passenger_cars(tokens);
    name_loose_boards(tokens);
    name_holes(tokens);
    change_lanes(tokens);
    name_aliases(tokens);
    stand::apply(tokens);
    super::maneuver::apply(tokens);
    use_lanes(tokens);
    name_pickups_and_cabs(tokens);
    go_on_to(tokens);
    made_to_stop(tokens);
    driven_on(tokens);
    turn_out_to_be(tokens);
    drive_as_company(tokens);
    part_owners(tokens);
    leave_in_reverse(tokens);
}

/// "a stretch of the road that had been taken up", "a missing section of pavement": a hole.
fn name_holes(tokens: &mut [Token]) {
    const PIECES: [&str; 7] = ["section", "portion", "stretch", "part", "piece", "strip", "patch"];
    const ROADS: [&str; 6] = ["road", "roadway", "pavement", "asphalt", "street", "lane"];
    const GONE: [&str; 8] = ["removed", "missing", "milled", "excavated", "demolished", "dug", "torn", "taken"];
    for at in 0..tokens.len().saturating_sub(4) {
        let word = |ahead: usize| word(tokens, at + ahead);
        if !PIECES.contains(&word(0)) || word(1) != "of" {
            continue;
        }
        let the = usize::from(matches!(word(2), "the" | "its"));
        let gone = usize::from(GONE.contains(&word(2 + the)));
        let road = 2 + the + gone;
        if !ROADS.contains(&word(road)) {
            continue;
        }
        let be = usize::from(matches!(word(road + 2), "had" | "has")) + 1;
        let that = matches!(word(road + 1), "that" | "which") && matches!(word(road + 1 + be), "was" | "been" | "is");
        let out = usize::from(matches!(word(road + 3 + be), "up" | "out" | "away"));
        let told = that && GONE.contains(&word(road + 2 + be));
        let before = at > 0 && GONE.contains(&tokens[at - 1].text.as_str());
        if told || before || gone > 0 {
            let end = at + road + 1 + if told { 2 + be + out } else { 0 };
            tokens[at..end].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
            "pothole".clone_into(&mut tokens[at].text);
        }
    }
}

/// "the right most lane": one word.
fn join_most(tokens: &mut Vec<Token>) {
    for at in (1..tokens.len()).rev() {
        let named = tokens[at].text == "most" && matches!(tokens[at - 1].text.as_str(), "left" | "right");
        if named && tokens.get(at + 1).is_some_and(|next| next.kind == TokenKind::Word && next.text != "of") {
            tokens[at - 1].text.push_str("most");
            tokens[at - 1].end = tokens[at].end;
            tokens.remove(at);
        }
    }
}

/// "The system issued a brake command", "our system reduced speed", "the automated driving system braked": the vehicle that it drives.
fn name_system(tokens: &mut [Token]) {
    const DOES: [&str; 22] = [
        "issued",
        "applied",
        "commanded",
        "initiated",
        "braked",
        "slowed",
        "decelerated",
        "steered",
        "swerved",
        "executed",
        "performed",
        "nudged",
        "stopped",
        "began",
        "started",
        "requested",
        "reduced",
        "lowered",
        "decreased",
        "shifted",
        "reacted",
        "responded",
    ];
    for at in 1..tokens.len().saturating_sub(2) {
        let Some(first) = names_system(tokens, at) else { continue };
        let adverb = usize::from(tokens[at + 1].text.ends_with("ly"));
        let verb = at + 1 + adverb;
        if tokens.get(verb).is_some_and(|verb| DOES.contains(&verb.text.as_str())) || drives(tokens, verb) {
            tokens[first..=at].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
            "av".clone_into(&mut tokens[first].text);
        }
    }
}

/// Where the name of a system begins that ends here, behind its article: "the automated driving system", "our software", "the ADS"; not "the
/// van's braking system".
fn names_system(tokens: &[Token], at: usize) -> Option<usize> {
    const OF: [&str; 10] = [
        "automated",
        "autonomous",
        "autonomy",
        "self",
        "driving",
        "automation",
        "drive",
        "control",
        "assistance",
        "ads",
    ];
    if !matches!(tokens[at].text.as_str(), "system" | "ads" | "software" | "autonomy") {
        return None;
    }
    let article = (at.saturating_sub(4)..at).rev().find(|before| !OF.contains(&tokens[*before].text.as_str()))?;
    matches!(tokens[article].text.as_str(), "the" | "our").then_some(article + 1)
}

/// Whether a verb here is one of what drives and stands: "came to a stop", "was turning left". "Turned off", "was running" are not.
fn drives(tokens: &[Token], at: usize) -> bool {
    const STEMS: [&str; 29] = [
        "stop",
        "slow",
        "brak",
        "came",
        "proceed",
        "drove",
        "driv",
        "travel",
        "turn",
        "revers",
        "backed",
        "roll",
        "yield",
        "chang",
        "merg",
        "approach",
        "accelerat",
        "pull",
        "mov",
        "crept",
        "inch",
        "swerv",
        "veer",
        "steer",
        "drift",
        "pass",
        "cross",
        "wait",
        "made",
    ];
    let at = at + usize::from(matches!(tokens[at].text.as_str(), "was" | "had"));
    let moves = |sense| matches!(sense, Sense::Act(_) | Sense::Sided(..) | Sense::Approach | Sense::Yield);
    let found =
        Lexicon::get().longest(tokens, at, |meaning| matches!(meaning, Meaning::Verb(sense, _) if moves(sense)));
    let switched =
        |length: usize| matches!(word(tokens, at + length), "off" | "on" | "itself" | "down" | "online" | "offline");
    // "turned the lights on", "passed control to somebody", "moved to a fallback mode".
    let handles = ["turn", "pass", "mov"].iter().any(|stem| word(tokens, at).starts_with(stem))
        && (matches!(word(tokens, at + 1), "the" | "its" | "control")
            || word(tokens, at + 1) == "to" && matches!(word(tokens, at + 2), "a" | "its"));
    STEMS.iter().any(|stem| word(tokens, at).starts_with(stem))
        && found.is_some_and(|found| !switched(found.length))
        && !handles
}

/// "began to break hard", "this abrupt breaking": spelled as it sounds.
fn brake(tokens: &mut [Token]) {
    let hard = |word: &str| {
        matches!(word, "quickly" | "hard" | "suddenly" | "abruptly" | "sharply" | "heavily" | "rapidly")
            || matches!(word, "abrupt" | "sudden" | "heavy" | "emergency" | "sharp")
    };
    for at in 1..tokens.len().saturating_sub(1) {
        let brakes = match tokens[at].text.as_str() {
            "break" => "brake",
            "breaks" => "brakes",
            "breaking" => "braking",
            _ => continue,
        };
        let (before, behind) = (tokens[at - 1].text.as_str(), tokens[at + 1].text.as_str());
        let begins = |word: &str| matches!(word, "started" | "began");
        let begun = begins(before) || before == "to" && at > 1 && begins(&tokens[at - 2].text);
        let ends = matches!(behind, "but" | "and" | "." | ",") && begun;
        let part = |token: &Token| {
            matches!(
                token.text.as_str(),
                "mirror" | "glass" | "light" | "lights" | "headlight" | "window" | "windshield" | "bumper"
            )
        };
        if (hard(before) || hard(behind) || ends) && !tokens[at.saturating_sub(4)..at].iter().any(part) {
            brakes.clone_into(&mut tokens[at].text);
        }
    }
}

/// "An Acme shuttle (ACME-POD-01) was eastbound. ... ACME-POD-01 stopped": a code in brackets, by which the story goes on.
fn name_codes(tokens: &mut Vec<Token>) {
    let lexicon = Lexicon::get();
    let mut at = 1;
    while at < tokens.len() {
        let end = (at + 1..tokens.len().min(at + 2 + CODE_PARTS)).find(|&end| tokens[end].text == ")");
        let code = end.filter(|&end| tokens[at].text == "(" && is_code(&tokens[at + 1..end]));
        let Some(end) = code else {
            at += 1;
            continue;
        };
        // "An Acme shuttle hit a truck (TX-4521)": the code is the truck's.
        let article = |token: &Token| matches!(token.text.as_str(), "a" | "an" | "the" | "another");
        let of_company = (at.saturating_sub(NAME_BEFORE)..at).any(|name| {
            tokens[name].capital
                && lexicon.longest(tokens, name, |meaning| matches!(meaning, Meaning::Company)).is_some()
                && !tokens[name..at].iter().any(article)
        });
        let code: Vec<String> = tokens[at + 1..end].iter().map(|token| token.text.clone()).collect();
        let mut again = at + 1;
        while of_company && again + code.len() <= tokens.len() {
            if tokens[again..again + code.len()].iter().map(|token| &token.text).eq(&code) {
                tokens[again].end = tokens[again + code.len() - 1].end;
                "av".clone_into(&mut tokens[again].text);
                tokens.drain(again + 1..again + code.len());
            }
            again += 1;
        }
        at += 1;
    }
}

/// Whether these are the parts of a code: capitals, joined by hyphens with a number.
fn is_code(parts: &[Token]) -> bool {
    let joined = parts.windows(2).all(|pair| pair[1].start == pair[0].end + 1);
    let number = parts.last().is_some_and(|last| last.kind == TokenKind::Number && last.text.len() > 1);
    parts.len() > 1 && joined && number && parts[..parts.len() - 1].iter().all(|token| token.capital)
}

/// A code has no more parts than these. [tokens]
const CODE_PARTS: usize = 4;

/// So many words before the bracket may be of who is named. [tokens]
const NAME_BEFORE: usize = 6;

/// "a hand held stop sign", "holding up a stop sign": a paddle, and no sign that stands there.
fn hold_by_hand(tokens: &mut [Token]) {
    for at in 1..tokens.len().saturating_sub(1) {
        if tokens[at].text != "stop" || tokens[at + 1].text != "sign" {
            continue;
        }
        // "held at a stop sign" is no paddle.
        let waits =
            tokens[at.saturating_sub(2)..at].iter().any(|token| matches!(token.text.as_str(), "at" | "for" | "by"));
        let held = !waits
            && tokens[at.saturating_sub(4)..at].iter().any(|token| {
                matches!(
                    token.text.as_str(),
                    "held" | "handheld" | "holding" | "holds" | "waving" | "carrying" | "wielding"
                )
            });
        let word = |ahead: usize| word(tokens, at + ahead);
        // "with a stop sign in hand", "raised a stop sign".
        let in_hand = word(2) == "in" && (word(3) == "hand" || matches!(word(3), "his" | "her") && word(4) == "hand");
        let raised = tokens[at.saturating_sub(2)..at]
            .iter()
            .any(|token| matches!(token.text.as_str(), "raised" | "raising" | "showed"));
        let paddle = word(2) == "paddle" || in_hand || raised;
        if held || paddle {
            for (token, name) in tokens[at..].iter_mut().zip(["signal", "paddle"]) {
                name.clone_into(&mut token.text);
            }
        }
    }
}

/// "An unattended skateboard", "a skateboard that got away from its rider": nobody stands on it, also where it is named without that word.
fn name_loose_boards(tokens: &mut [Token]) {
    let alone =
        |word: &str| matches!(word, "unattended" | "riderless" | "unoccupied" | "runaway" | "abandoned" | "loose");
    let mut loose = tokens.windows(2).any(|pair| alone(&pair[0].text) && pair[1].text == "skateboard");
    for at in 0..tokens.len().saturating_sub(4) {
        let word = |ahead: usize| word(tokens, at + ahead);
        let had = usize::from(matches!(word(2), "had" | "has" | "suddenly"));
        let lost = match word(2 + had) {
            "escaped" => true,
            "got" | "gotten" | "slipped" | "slid" | "flew" | "shot" => matches!(word(3 + had), "away" | "out" | "from"),
            "broke" | "came" => matches!(word(3 + had), "free" | "loose"),
            _ => false,
        };
        if word(0) == "skateboard" && matches!(word(1), "that" | "which") && lost {
            "rolled".clone_into(&mut tokens[at + 2 + had].text);
            loose = true;
        }
    }
    loose |= (0..tokens.len()).any(|at| tokens[at].text == "skateboard" && is_riderless(&tokens[at + 1..]));
    for token in tokens.iter_mut().filter(|token| loose && token.text == "skateboard") {
        "object".clone_into(&mut token.text);
    }
}

/// "rolled downhill with nobody on it", "lying in the road": what stands behind a skateboard on which nobody is.
fn is_riderless(behind: &[Token]) -> bool {
    const WITHIN: usize = 8;
    let words: Vec<&str> =
        behind.iter().take(WITHIN).map(|token| token.text.as_str()).take_while(|word| *word != ".").collect();
    let alone = words.windows(3).any(|row| {
        matches!(
            row,
            ["with", "nobody", "on"] | ["with", "no", "rider"] | ["without", "a", "rider"] | ["no", "one", "on"]
        )
    });
    alone || matches!(words.as_slice(), ["lying", ..] | ["that", "lay", ..] | ["which", "lay", ..])
}

/// "changed from the right lane to the left one", "transitioned from the next lane": a change of lanes, and what it leaves is told behind it.
fn change_lanes(tokens: &mut [Token]) {
    for at in 0..tokens.len().saturating_sub(3) {
        let changes = match tokens[at].text.as_str() {
            "changed" | "transitioned" | "switched" | "shifted" => "lanechanged",
            "changing" | "transitioning" | "switching" | "shifting" => "lanechanging",
            "changes" | "transitions" | "switches" | "shifts" => "lanechanges",
            _ => continue,
        };
        let lane = |token: &Token| matches!(token.text.as_str(), "lane" | "lanes");
        // "from autonomous to manual mode in lane two" leaves no lane.
        let of_lane = |token: &Token| OF_LANES.contains(&token.text.as_str());
        let named = tokens[at + 2..].iter().take(LANE_WORDS).find(|token| !of_lane(token)).is_some_and(lane);
        if tokens[at + 1].text == "from" && named {
            changes.clone_into(&mut tokens[at].text);
        }
    }
}

/// "A semi-trailer truck (the Actor) came. ... The Actor turned": a name of its own, which the story goes on with.
fn name_aliases(tokens: &mut [Token]) {
    let lexicon = Lexicon::get();
    for at in 1..tokens.len().saturating_sub(2) {
        if tokens[at].text != "(" {
            continue;
        }
        let alias = at + 1 + usize::from(tokens[at + 1].text == "the");
        let closed = tokens.get(alias + 1).is_some_and(|next| next.text == ")");
        let named = closed && tokens[alias].capital && lexicon.longest(tokens, alias, |_| true).is_none();
        let known = lexicon.longest(tokens, at - 1, |meaning| matches!(meaning, Meaning::Kind(_))).is_some();
        if !(named && known) {
            continue;
        }
        let (alias, head) = (tokens[alias].text.clone(), tokens[at - 1].text.clone());
        for again in at + 4..tokens.len() {
            if tokens[again].text == alias && tokens[again - 1].text == "the" {
                head.clone_into(&mut tokens[again].text);
            }
        }
    }
}

/// Words that stand before the lane that is left.
const OF_LANES: [&str; 27] = [
    "the",
    "a",
    "its",
    "his",
    "their",
    "left",
    "right",
    "leftmost",
    "rightmost",
    "far",
    "middle",
    "center",
    "centre",
    "inner",
    "outer",
    "inside",
    "outside",
    "adjacent",
    "next",
    "immediate",
    "turn",
    "travel",
    "through",
    "number",
    "hand",
    "2",
    "1",
];

/// So many words a lane that is left may have: "the lane immediately to the left". [tokens]
const LANE_WORDS: usize = 6;

/// "went on to turn left", "set out to pass", "set about turning": it did, or began to.
fn go_on_to(tokens: &mut [Token]) {
    for at in 0..tokens.len().saturating_sub(3) {
        let word = |ahead: usize| word(tokens, at + ahead);
        let (verb, small) = match (word(0), word(1), word(2)) {
            ("go" | "move" | "carry", "on", "to") => ("proceed", 1),
            ("went" | "moved" | "carried" | "gone", "on", "to") => ("proceeded", 1),
            ("going" | "moving" | "carrying", "on", "to") => ("proceeding", 1),
            ("set" | "sets", "out", "to") => ("attempted", 1),
            ("setting", "out", "to") => ("attempting", 1),
            ("set" | "sets", "about", verb) if verb.ends_with("ing") => ("began", 1),
            ("undertook", "to", _) => ("attempted", 0),
            ("undertaking", "to", _) => ("attempting", 0),
            _ => continue,
        };
        // "set out to the west" is no purpose.
        let next = at + 2 + usize::from(small == 1 && word(2) == "to");
        let next = if small == 0 { at + 2 } else { next };
        let does = Lexicon::get().longest(tokens, next, |meaning| matches!(meaning, Meaning::Verb(..)));
        if does.is_some() && !tokens[next].capital {
            verb.clone_into(&mut tokens[at].text);
            tokens[at + 1..=at + small].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
        }
    }
}

/// "a pick-up", "another cab": a pickup and a taxi, where the words behind do not make a place or an act of it. The cab of a truck is none.
fn name_pickups_and_cabs(tokens: &mut Vec<Token>) {
    const PLACES: [&str; 15] = [
        "drop",
        "maneuver",
        "event",
        "location",
        "point",
        "area",
        "zone",
        "spot",
        "or",
        "site",
        "passengers",
        "and",
        "request",
        "time",
        "of",
    ];
    // "a zone for passenger pickups".
    for at in 1..tokens.len() {
        let picked = matches!(tokens[at - 1].text.as_str(), "passenger" | "customer" | "rider" | "curbside");
        if picked && tokens[at].text == "pickups" {
            "collections".clone_into(&mut tokens[at].text);
        }
    }
    let truck = tokens.iter().any(|token| matches!(token.text.as_str(), "truck" | "semi" | "tractor"));
    let cab = tokens.windows(2).any(|pair| matches!(pair[0].text.as_str(), "a" | "another") && pair[1].text == "cab");
    for token in tokens.iter_mut().filter(|token| cab && !truck && token.text == "cab") {
        "taxi".clone_into(&mut token.text);
    }
    for at in (1..tokens.len().saturating_sub(2)).rev() {
        let named = matches!(tokens[at - 1].text.as_str(), "a" | "the" | "another" | "that")
            || crate::chunk::is_colour(&tokens[at - 1].text);
        let one_word =
            tokens[at].text == "pick" && tokens[at + 1].text == "up" && tokens[at + 1].start == tokens[at].end + 1;
        if named && one_word && !PLACES.contains(&tokens[at + 2].text.as_str()) {
            "pickup".clone_into(&mut tokens[at].text);
            tokens[at].end = tokens[at + 1].end;
            tokens.remove(at + 1);
        }
    }
}

/// "passed it using the bike lane": in that lane.
fn use_lanes(tokens: &mut [Token]) {
    for at in 0..tokens.len().saturating_sub(2) {
        let determined = matches!(tokens[at + 1].text.as_str(), "the" | "a" | "its" | "their");
        let lane = tokens[at + 2..].iter().take(LANE_WORDS).take_while(|token| token.kind == TokenKind::Word);
        if tokens[at].text == "using" && determined && lane.into_iter().any(|token| token.text == "lane") {
            "in".clone_into(&mut tokens[at].text);
        }
    }
}

/// "A red light brought it to a halt", "made it brake", "forced the AV to stop": caused it to.
fn made_to_stop(tokens: &mut Vec<Token>) {
    let stops = |word: &str| ["stop", "halt", "brake", "slow", "wait", "yield", "swerve", "decelerate"].contains(&word);
    let lexicon = Lexicon::get();
    for at in (1..tokens.len().saturating_sub(3)).rev() {
        let makes = match word(tokens, at) {
            "brought" | "made" | "forced" | "compelled" | "obliged" | "prompted" | "required" | "led" => "caused",
            "bringing" | "making" | "forcing" | "compelling" | "obliging" | "prompting" | "requiring" => "causing",
            _ => continue,
        };
        let named = at + 1 + usize::from(matches!(word(tokens, at + 1), "the" | "our"));
        let subject =
            lexicon.longest(tokens, named, |meaning| matches!(meaning, Meaning::Subject)).map(|found| found.length);
        // "The test driver brought the vehicle to a halt" is a verb of the lexicon: nobody else did it.
        let begins = tokens[..at].iter().rposition(|token| token.text == ".").map_or(0, |stop| stop + 1);
        let drives = |token: &Token| matches!(token.text.as_str(), "driver" | "operator" | "specialist");
        if word(tokens, at).starts_with("br") && tokens[begins..at].iter().any(drives) {
            continue;
        }
        let Some(length) = subject.or((word(tokens, at + 1) == "it").then_some(1)) else { continue };
        let end = named + length;
        let halts = (word(tokens, end), word(tokens, end + 1)) == ("to", "a")
            && matches!(word(tokens, end + 2), "stop" | "halt" | "standstill");
        let bare = word(tokens, at).starts_with("ma") && stops(word(tokens, end));
        let infinitive =
            word(tokens, end) == "to" && stops(word(tokens, end + 1)) && !word(tokens, at).starts_with("br");
        if halts && word(tokens, at).starts_with("br") {
            "stop".clone_into(&mut tokens[end + 1].text);
            "completely".clone_into(&mut tokens[end + 2].text);
        } else if bare {
            let start = tokens[end].start;
            let to = Token { start, end: start, text: "to".to_owned(), kind: TokenKind::Word, capital: false };
            tokens.insert(end, to);
        } else if !infinitive {
            continue;
        }
        makes.clone_into(&mut tokens[at].text);
    }
}

/// "reversed while unparking", "backed up while leaving its space": out of there in reverse, and no second way.
fn leave_in_reverse(tokens: &mut [Token]) {
    const BACKS: [&str; 5] = ["reversed", "reversing", "reverse", "backed", "backing"];
    for at in 0..tokens.len().saturating_sub(2) {
        let up = usize::from(tokens[at + 1].text == "up");
        let Some([first, second, third]) = tokens.get(at + up + 1..at + up + 4) else { continue };
        let place = matches!(third.text.as_str(), "a" | "an" | "the" | "its" | "their" | "parking" | "driveway");
        let to = match (first.text.as_str(), second.text.as_str()) {
            ("while" | "when", "unparking") => ["completely", "completely"],
            ("while" | "when", "leaving" | "exiting" | "departing") if place => ["out", "of"],
            _ => continue,
        };
        if BACKS.contains(&tokens[at].text.as_str()) {
            for (token, word) in tokens[at + up + 1..].iter_mut().zip(to) {
                word.clone_into(&mut token.text);
            }
        }
    }
}

/// "The driver took over and eased it forward", "was guiding the AV around a bus": what it did, with its driver.
fn driven_on(tokens: &mut [Token]) {
    const WAYS: [(&str, &str); 16] = [
        ("guid", "mov"),
        ("pilot", "mov"),
        ("navigat", "mov"),
        ("thread", "mov"),
        ("coax", "mov"),
        ("maneuver", "mov"),
        ("took", "moved"),
        ("brought", "moved"),
        ("eas", "eas"),
        ("inch", "inch"),
        ("nos", "nos"),
        ("edg", "edg"),
        ("pull", "pull"),
        ("nudg", "nudg"),
        ("creep", "creep"),
        ("crept", "crept"),
    ];
    for at in 2..tokens.len().saturating_sub(2) {
        let Some((stem, way)) = WAYS.iter().find(|(stem, _)| tokens[at].text.starts_with(stem)) else { continue };
        let sentence = tokens[..at].iter().rposition(|token| token.text == ".").map_or(0, |stop| stop + 1);
        let driven = tokens[sentence..at]
            .iter()
            .any(|token| matches!(token.text.as_str(), "driver" | "operator" | "specialist" | "technician"));
        let end = match (tokens[at + 1].text.as_str(), tokens[at + 2].text.as_str()) {
            ("it", _) => at + 2,
            ("the" | "our", "av" | "vehicle" | "truck" | "shuttle") => at + 3,
            _ => continue,
        };
        let on = tokens.get(end).is_some_and(|next| {
            matches!(
                next.text.as_str(),
                "forward" | "ahead" | "around" | "past" | "into" | "through" | "onto" | "toward"
            ) || next.text == "over" && *way != "moved"
        });
        if !(driven && on) {
            continue;
        }
        let form = if *stem == *way {
            tokens[at].text.clone()
        } else if tokens[at].text.ends_with("ing") {
            "moving".to_owned()
        } else {
            "moved".to_owned()
        };
        tokens[at].text = form;
        tokens[at + 1..end].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
    }
}

/// "an object, which turned out to be a chair", "an object, later identified as a chair": apparently a chair.
fn turn_out_to_be(tokens: &mut [Token]) {
    const SAYS: [&[&str]; 9] = [
        &["which", "turned", "out", "to", "be"],
        &["that", "turned", "out", "to", "be"],
        &["which", "proved", "to", "be"],
        &["later", "identified", "as"],
        &["subsequently", "identified", "as"],
        &["later", "determined", "to", "be"],
        &["later", "found", "to", "be"],
        &["namely"],
        &["presumably"],
    ];
    for at in 0..tokens.len() {
        let says = SAYS.iter().find(|says| {
            says.iter().enumerate().all(|(ahead, word)| tokens.get(at + ahead).is_some_and(|token| token.text == *word))
        });
        let noun = |length: usize| tokens.get(at + length).is_some_and(|next| matches!(next.text.as_str(), "a" | "an"));
        if let Some(says) = says.filter(|says| noun(says.len())) {
            tokens[at..at + says.len()].iter_mut().for_each(|token| "apparently".clone_into(&mut token.text));
        }
    }
}

/// "Acme was proceeding straight", in a report of that company: its vehicle was.
fn drive_as_company(tokens: &mut [Token]) {
    let drives = |word: &str| {
        matches!(
            word,
            "proceeding"
                | "traveling"
                | "travelling"
                | "driving"
                | "stopped"
                | "turning"
                | "merging"
                | "yielding"
                | "slowing"
                | "heading"
                | "moving"
                | "waiting"
        )
    };
    for at in 0..tokens.len().saturating_sub(2) {
        let company = Lexicon::get().longest(tokens, at, |meaning| matches!(meaning, Meaning::Company));
        if company.is_some_and(|found| found.length == 1)
            && tokens[at + 1].text == "was"
            && drives(&tokens[at + 2].text)
            && at
                .checked_sub(1)
                .is_none_or(|before| matches!(tokens[before].text.as_str(), "." | "," | "when" | "while" | "as"))
        {
            "av".clone_into(&mut tokens[at].text);
        }
    }
}

/// "The side of the trucks trailer", told of a truck: its apostrophe was lost.
fn part_owners(tokens: &mut Vec<Token>) {
    const OWNERS: [(&str, &str); 6] = [
        ("trucks", "truck"),
        ("tractors", "tractor"),
        ("pickups", "pickup"),
        ("vans", "van"),
        ("suvs", "suv"),
        ("cars", "car"),
    ];
    const OWNED: [&str; 3] = ["trailer", "cab", "bed"];
    for at in (1..tokens.len().saturating_sub(1)).rev() {
        let Some((_, one)) = OWNERS.iter().find(|(several, _)| tokens[at].text == *several) else { continue };
        let before = &tokens[at.saturating_sub(OWNER_WORDS)..at];
        let the = before.iter().rposition(|token| token.text == "the");
        let many = |token: &Token| crate::token::number(&token.text).is_some() || token.text == "both";
        let alone =
            the.is_some_and(|the| !before[the..].iter().any(many)) && !before.iter().any(|token| token.text == "both");
        let known = tokens[..at].iter().any(|token| token.text == *one);
        if !(OWNED.contains(&tokens[at + 1].text.as_str()) && alone && known) {
            continue;
        }
        let (start, end) = (tokens[at].end - 1, tokens[at].end);
        (*one).clone_into(&mut tokens[at].text);
        tokens[at].end = start;
        let genitive = Token { start, end, text: "'s".to_owned(), kind: TokenKind::Word, capital: false };
        tokens.insert(at + 1, genitive);
    }
}

/// So many words before an owner may belong to its name: "the large red". [tokens]
const OWNER_WORDS: usize = 4;

/// "The passenger continued to reverse", told of a passenger car: its second word is left out.
fn name_passenger_cars(tokens: &mut [Token]) {
    let pair = |pair: &[Token], one: &str, other: &str| pair[0].text == one && pair[1].text == other;
    if !tokens.windows(2).any(|run| pair(run, "passenger", "car") || pair(run, "passenger", "vehicle")) {
        return;
    }
    for at in 1..tokens.len().saturating_sub(3) {
        let word = |ahead: usize| tokens[at + ahead].text.as_str();
        let to =
            |ahead: usize| word(ahead) == "to" && matches!(word(ahead + 1), "reverse" | "back" | "proceed" | "drive");
        let drives = match word(1) {
            "reversed" | "accelerated" | "reversing" => true,
            "proceeded" => matches!(word(2), "forward" | "straight" | "ahead"),
            "continued" => matches!(word(2), "forward" | "straight" | "reversing") || to(2),
            "began" | "started" => word(2) == "reversing" || to(2),
            _ => false,
        };
        if tokens[at - 1].text == "the" && word(0) == "passenger" && drives {
            "car".clone_into(&mut tokens[at].text);
        }
    }
}
