//! Manoeuvres that are told by a noun, put in the words of their verbs: "was midway through a left turn", "carried out a lane change", "during
//! its overtaking maneuver". The places of the tokens stay.

use crate::token::{Token, word};

/// What somebody does whose manoeuvre a noun tells.
#[derive(Clone, Copy, PartialEq)]
enum Does {
    Turn,
    ChangeLanes,
    Reverse,
    Pass,
    Park,
    Stop,
    Swerve,
    UTurn,
}

/// A noun of a manoeuvre.
struct Named {
    does: Does,
    side: Option<&'static str>,
    /// "a change of lanes", "a left": what the lexicon does not know.
    of_lanes: bool,
    /// The token behind it.
    end: usize,
}

/// A noun has so many words at most: "its slow unprotected left hand turn". [tokens]
const WORDS: usize = 6;

/// Rewords the manoeuvres of a narrative.
pub(super) fn apply(tokens: &mut [Token]) {
    for at in 0..tokens.len().saturating_sub(2) {
        answer_with(tokens, at);
        if let Some((from, is_clause)) = midway(tokens, at) {
            let stopped = stops_within(tokens, at);
            let told = |named: &Named| named.does != Does::Stop && !(stopped && named.does == Does::Turn);
            if let Some(named) = named(tokens, from).filter(told) {
                let first = if is_clause {
                    "while".clone_into(&mut tokens[at].text);
                    at + 1
                } else {
                    at
                };
                reword(tokens, first, &named, "ing");
            }
        } else if let Some((from, form, begins)) = does(tokens, at)
            && let Some(named) = named(tokens, from).filter(|named| is_unknown(&tokens[at].text, named, begins))
        {
            let first = if begins { at + 1 } else { at };
            reword(tokens, first, &named, if begins { "ing" } else { form });
        } else if let Some((from, form)) = goes_into(tokens, at)
            && let Some(named) = named(tokens, from).filter(|named| named.does == Does::Turn)
        {
            reword(tokens, at, &named, form);
        }
    }
}

/// "reacted with hard braking and a shift to the right": it braked, and shifted to the right.
fn answer_with(tokens: &mut [Token], at: usize) {
    let answers = matches!(word(tokens, at), "reacted" | "responded" | "answered")
        && matches!(word(tokens, at + 1), "with" | "by");
    let Some((verb, end)) = answer(tokens, at + 2).filter(|_| answers) else { return };
    let more = answer(tokens, end + 1).filter(|_| matches!(word(tokens, end), "and" | ","));
    for (verb, first, end) in
        [Some((verb, at, end)), more.map(|(verb, last)| (verb, end + 1, last))].into_iter().flatten()
    {
        tokens[first..end].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
        verb.clone_into(&mut tokens[first].text);
    }
}

/// What a noun for an answer says as a verb, and the token behind it: "a hard brake", "deceleration", "a slight nudge".
fn answer(tokens: &[Token], from: usize) -> Option<(&'static str, usize)> {
    const HOW: [&str; 14] = [
        "hard",
        "harsh",
        "heavy",
        "strong",
        "firm",
        "sudden",
        "sharp",
        "quick",
        "immediate",
        "emergency",
        "light",
        "slight",
        "small",
        "brief",
    ];
    let first = from + usize::from(matches!(word(tokens, from), "a" | "an" | "its"));
    let noun = (first..first + 3).find(|at| !HOW.contains(&word(tokens, *at)))?;
    let verb = match word(tokens, noun) {
        "braking" | "brake" | "brakes" | "deceleration" => "braked",
        "shift" | "nudge" => "shifted",
        "swerve" => "swerved",
        "move" => "moved",
        "steering" => "steered",
        _ => return None,
    };
    let long = matches!(word(tokens, noun + 1), "maneuver" | "application" | "input" | "action");
    Some((verb, noun + 1 + usize::from(long)))
}

/// "during", "still in", "midway through", "in the middle of", "engaged in": the token behind it, and whether a clause begins with it.
fn midway(tokens: &[Token], at: usize) -> Option<(usize, bool)> {
    let word = |ahead: usize| word(tokens, at + ahead);
    let begins = at == 0 || matches!(tokens[at - 1].text.as_str(), "." | "\u{b6}");
    Some(match (word(0), word(1), word(2), word(3)) {
        ("during", ..) => (at + 1, true),
        ("while" | "still", "in", ..) => (at + 2, true),
        ("midway" | "halfway" | "partway" | "well", "through" | "into", ..) => (at + 2, false),
        ("some" | "part", "way", "through" | "into", _) => (at + 3, false),
        ("most" | "part", "of", "the", "way") if matches!(word(4), "through" | "into") => (at + 5, false),
        ("in", "the", "middle" | "midst" | "process" | "course" | "act", "of") => (at + 4, false),
        ("engaged", "in", ..) => (at + 2, false),
        // "In a left turn, it braked".
        ("in", "a" | "its" | "an", ..) if begins && ends_at_comma(tokens, at + 1) => (at + 1, false),
        _ => return None,
    })
}

/// "stopped midway through its turn": who stands in it has begun it, and turns no more (`fold/nominal.rs`).
fn stops_within(tokens: &[Token], at: usize) -> bool {
    let through = matches!(tokens[at].text.as_str(), "midway" | "halfway" | "partway" | "part");
    let last = at.checked_sub(1).map_or("", |last| tokens[last].text.as_str());
    through && matches!(last, "stopped" | "stop" | "halt" | "halted" | "stopping" | "stationary" | "standstill")
}

fn ends_at_comma(tokens: &[Token], from: usize) -> bool {
    named(tokens, from).is_some_and(|named| tokens.get(named.end).is_some_and(|next| next.text == ","))
}

/// A verb that says no more than that it was done, or begun: the token behind it, its form, and whether it was begun.
fn does(tokens: &[Token], at: usize) -> Option<(usize, &'static str, bool)> {
    let word = tokens[at].text.as_str();
    let form = match word {
        _ if word.ends_with("ing") => "ing",
        "undertake" | "effect" | "conduct" | "commence" | "carry" | "perform" | "execute" | "make" | "attempt" => "",
        "undertook" | "undertaken" | "made" | "began" => "ed",
        _ if word.ends_with("ed") => "ed",
        _ => return None,
    };
    const DONE: [&str; 11] =
        ["undert", "effect", "conduct", "perform", "execut", "mak", "made", "complet", "resum", "continu", "finish"];
    const BEGUN: [&str; 6] = ["commenc", "began", "beginn", "start", "initiat", "attempt"];
    let is = |stems: &[&str]| stems.iter().any(|stem| word.starts_with(stem));
    let out = word.starts_with("carr") && tokens.get(at + 1).is_some_and(|next| next.text == "out");
    match (is(&DONE) || out, is(&BEGUN)) {
        (true, _) => Some((at + 1 + usize::from(out), form, false)),
        (_, true) => Some((at + 1, form, true)),
        _ => None,
    }
}

/// "making a left turn" and the like are known: these are not.
fn is_unknown(verb: &str, named: &Named, begins: bool) -> bool {
    let rare =
        ["undert", "effect", "conduct", "carr", "resum", "continu", "finish"].iter().any(|stem| verb.starts_with(stem));
    match named.does {
        Does::Turn => rare || verb.starts_with("commenc") || named.of_lanes && (begins || verb.starts_with("exec")),
        Does::ChangeLanes => rare || verb.starts_with("commenc") || named.of_lanes,
        Does::Stop => !begins,
        Does::Reverse | Does::Pass | Does::Park | Does::Swerve => true,
        Does::UTurn => rare || begins,
    }
}

/// "advancing into the turn", "entered a left turn", "coming out of its turn": the token behind it, and the form.
fn goes_into(tokens: &[Token], at: usize) -> Option<(usize, &'static str)> {
    let word = |ahead: usize| word(tokens, at + ahead);
    let form = match word(0) {
        "entering" | "advancing" | "proceeding" | "moving" | "going" | "continuing" | "coming" => "ing",
        "entered" | "advanced" | "proceeded" | "moved" | "went" | "continued" | "came" => "ed",
        _ => return None,
    };
    match (word(0), word(1), word(2)) {
        ("coming" | "came", "out", "of") => Some((at + 3, form)),
        ("entering" | "entered", ..) => Some((at + 1, form)),
        ("coming" | "came", ..) => None,
        (_, "into" | "through", _) => Some((at + 2, form)),
        _ => None,
    }
}

/// The noun of a manoeuvre that begins here with an article.
fn named(tokens: &[Token], from: usize) -> Option<Named> {
    let word = |at: usize| word(tokens, at);
    if !matches!(word(from), "a" | "an" | "the" | "its" | "his" | "her" | "their") {
        return None;
    }
    if let Some(named) = ellipsis(tokens, from) {
        return Some(named);
    }
    let noun = (from + 1..from + WORDS).find(|at| {
        matches!(
            word(*at),
            "turn" | "change" | "maneuver" | "manoeuvre" | "movement" | "pass" | "overtake" | "stop" | "swerve"
        )
    })?;
    let between: Vec<&str> = (from + 1..noun).map(word).collect();
    let how = |word: &&str| {
        matches!(*word, "left" | "right" | "hand" | "unprotected" | "protected" | "slow" | "wide" | "sharp" | "own")
            || matches!(*word, "gradual" | "sudden" | "short" | "slight")
    };
    // "a three-point turn", "a U-turn".
    let about = word(noun) == "turn" && (between == ["u"] || between.last() == Some(&"point"));
    let (last, before) = between.split_last().map_or(("", &[][..]), |(last, before)| (*last, before));
    let plain = between.iter().all(how);
    let maneuver = matches!(word(noun), "maneuver" | "manoeuvre" | "movement") && before.iter().all(how);
    let (does, end) = match word(noun) {
        "turn" if about => (Does::UTurn, noun + 1),
        "turn" if plain => (Does::Turn, noun + 1),
        "change" if last == "lane" && before.iter().all(how) => (Does::ChangeLanes, noun + 1),
        "change" if plain && word(noun + 1) == "of" && matches!(word(noun + 2), "lane" | "lanes") => {
            (Does::ChangeLanes, noun + 3)
        }
        "pass" | "overtake" if between.is_empty() && word(from) != "the" => (Does::Pass, noun + 1),
        "swerve" if plain => (Does::Swerve, noun + 1),
        "stop" if matches!(word(from), "its" | "his" | "her") && between.is_empty() => (Does::Stop, noun + 1),
        _ if maneuver && matches!(last, "backing" | "reversing" | "reverse" | "backward") => (Does::Reverse, noun + 1),
        _ if maneuver && matches!(last, "passing" | "overtaking") => (Does::Pass, noun + 1),
        _ if maneuver && last == "parking" => (Does::Park, noun + 1),
        _ => return None,
    };
    // "the turn lane", "a left turn phase", "the left turn of the van", "a stop sign".
    if OF_TURNS.contains(&word(end)) {
        return None;
    }
    let side = between.iter().find_map(|word| match *word {
        "left" => Some("left"),
        "right" => Some("right"),
        _ => None,
    });
    Some(Named { does, side, of_lanes: end == noun + 3, end })
}

/// "began an unprotected left onto Elm Street": its noun is left out.
fn ellipsis(tokens: &[Token], from: usize) -> Option<Named> {
    let word = |at: usize| word(tokens, at);
    let how = |word: &str| matches!(word, "unprotected" | "protected" | "wide" | "sharp" | "gentle" | "quick");
    let at = from + 1 + usize::from(how(word(from + 1)));
    let side = match word(at) {
        "left" => "left",
        "right" => "right",
        _ => return None,
    };
    let ends = matches!(
        word(at + 1),
        "" | "." | "," | "onto" | "into" | "toward" | "towards" | "from" | "off" | "when" | "as" | "and"
    );
    ends.then_some(Named { does: Does::Turn, side: Some(side), of_lanes: true, end: at + 1 })
}

/// Writes the verb of a manoeuvre in the place of its noun and of the words before it.
fn reword(tokens: &mut [Token], first: usize, named: &Named, form: &str) {
    if named.does == Does::UTurn {
        return turn_about(tokens, first, named.end, form);
    }
    let stem = match (named.does, form) {
        (Does::UTurn, _) => return,
        (Does::Turn, _) => "turn",
        (Does::ChangeLanes, "") => "lanechange",
        (Does::ChangeLanes, _) => "lanechang",
        (Does::Reverse, "") => "reverse",
        (Does::Reverse, _) => "revers",
        (Does::Pass, _) => "pass",
        (Does::Park, _) => "park",
        (Does::Swerve, "") => "swerve",
        (Does::Swerve, _) => "swerv",
        (Does::Stop, "") => "stop",
        (Does::Stop, _) => "stopp",
    };
    tokens[first..named.end].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
    tokens[first].text = format!("{stem}{form}");
    if let Some(side) = named.side.filter(|_| first + 1 < named.end) {
        side.clone_into(&mut tokens[first + 1].text);
    }
}

/// "making a u turn", for one of several points too.
fn turn_about(tokens: &mut [Token], first: usize, end: usize, form: &str) {
    let makes = match form {
        "ing" => "making",
        "ed" => "made",
        _ => "make",
    };
    if end < first + 4 {
        return;
    }
    tokens[first..end].iter_mut().for_each(|token| "completely".clone_into(&mut token.text));
    for (token, word) in tokens[end - 4..end].iter_mut().zip([makes, "a", "u", "turn"]) {
        word.clone_into(&mut token.text);
    }
}

/// What a manoeuvre is part of the name of, or whose it is: "the left turn phase", "the right turn of the van".
const OF_TURNS: [&str; 22] = [
    "maneuver",
    "maneuvers",
    "lane",
    "lanes",
    "only",
    "pocket",
    "pockets",
    "bay",
    "bays",
    "signal",
    "signals",
    "phase",
    "arrow",
    "light",
    "interval",
    "movement",
    "movements",
    "of",
    "by",
    "sign",
    "line",
    "bar",
];
