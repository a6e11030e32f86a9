//! Standing, beginning and a green light, told without a verb of their own, in the words of the lexicon: "with the AV at rest" it stood,
//! "went on to turn" proceeded to. The places of the tokens stay.

use crate::lexicon::{Lexicon, Meaning};
use crate::token::{Token, TokenKind, word};

/// Rewords the tokens of a narrative.
pub(super) fn apply(tokens: &mut [Token]) {
    for at in 0..tokens.len() {
        stand_still(tokens, at);
        has_not_moved(tokens, at);
        stand_meanwhile(tokens, at);
        stand_parked(tokens, at);
        reach_into(tokens, at);
        go_on_to(tokens, at);
        come_before(tokens, at);
        give_a_push(tokens, at);
        without_a_stop(tokens, at);
        does_not_obey(tokens, at);
        follow_suit(tokens, at);
        on_green(tokens, at);
        with_the_light(tokens, at);
    }
}

/// Puts a word in the place of these tokens: the others only say how.
fn put(tokens: &mut [Token], first: usize, end: usize, new: &str) {
    for token in &mut tokens[first..end] {
        "completely".clone_into(&mut token.text);
    }
    new.clone_into(&mut tokens[first].text);
}

/// How many words here say that somebody stands: "stationary", "at rest", "at a complete stop". "At a stop sign" does not.
fn standing(tokens: &[Token], at: usize) -> Option<usize> {
    let word = |ahead: usize| word(tokens, at + ahead);
    let length = match (word(0), word(1), word(2)) {
        ("stationary" | "motionless" | "immobile", ..) => 1,
        ("at", "rest" | "standstill", _) => 2,
        ("at", "a" | "an" | "its", "stop" | "standstill" | "halt") => 3,
        ("at", "a", "complete" | "full" | "dead" | "temporary")
            if matches!(word(3), "stop" | "standstill" | "halt") =>
        {
            4
        }
        _ => return None,
    };
    // "a stationary object", "at a stop sign", "at rest area".
    let ends = tokens.get(at + length).is_none_or(|next| {
        next.kind == TokenKind::Mark
            || matches!(
                next.text.as_str(),
                "at" | "in"
                    | "on"
                    | "behind"
                    | "for"
                    | "with"
                    | "by"
                    | "ahead"
                    | "when"
                    | "while"
                    | "and"
                    | "as"
                    | "due"
            )
            || matches!(
                next.text.as_str(),
                "because" | "near" | "before" | "after" | "waiting" | "facing" | "next" | "beside"
            )
            || matches!(
                next.text.as_str(),
                "until" | "from" | "to" | "there" | "within" | "between" | "along" | "alongside"
            )
    });
    ends.then_some(length)
}

/// Words that stand between "was" and how somebody stands.
fn says_how(word: &str) -> bool {
    matches!(
        word,
        "still"
            | "already"
            | "now"
            | "fully"
            | "completely"
            | "also"
            | "then"
            | "itself"
            | "just"
            | "initially"
            | "both"
    ) || matches!(word, "temporarily" | "momentarily" | "briefly" | "likewise" | "entirely" | "similarly" | "currently")
}

/// "was still stationary", "while at a complete stop", "the AV, at rest behind a bus, was hit", "Stationary at a light, it was hit": stopped.
fn stand_still(tokens: &mut [Token], at: usize) {
    let Some(length) = standing(tokens, at) else { return };
    let hows = (0..3).take_while(|back| at.checked_sub(back + 1).is_some_and(|at| says_how(word(tokens, at)))).count();
    let lead = (at - hows).checked_sub(1).map_or(".", |at| word(tokens, at));
    let while_so = matches!(lead, "while" | "when" | "though" | "although" | "and" | "," | ".");
    let is = matches!(lead, "is" | "was" | "were" | "been" | "being" | "are") && hows > 0;
    // "came to a stop, at a standstill": told already.
    let is = is || matches!(lead, "was" | "were") && matches!(word(tokens, at + 2), "halt" | "dead" | "temporary");
    // "Stationary at a light, it was hit", with no "while".
    let new = if matches!(lead, "," | ".") { "standing" } else { "stopped" };
    if while_so && (lead != "and" || hows > 0) || is {
        put(tokens, at, at + length, new);
    }
}

/// "at the curb, in a parked position": parked.
fn stand_parked(tokens: &mut [Token], at: usize) {
    let parallel = usize::from(word(tokens, at + 2) == "parallel");
    let parked = (word(tokens, at + 2 + parallel), word(tokens, at + 3 + parallel)) == ("parked", "position");
    let lead = at.checked_sub(1).map_or("", |at| word(tokens, at));
    if word(tokens, at) == "in" && word(tokens, at + 1) == "a" && parked && matches!(lead, "was" | "," | "while") {
        let comma = lead == ",";
        put(tokens, at + usize::from(comma), at + 4 + parallel, "parked");
        if comma {
            "while".clone_into(&mut tokens[at].text);
        }
    }
}

/// "stopped, its left rear corner partly in the next lane", "with the rear of the AV half in the bus lane": and was partly in it. A lane "of" a
/// road is that of another one.
fn reach_into(tokens: &mut [Token], at: usize) {
    let partly = matches!(word(tokens, at), "partially" | "partly" | "partway" | "halfway" | "half");
    let into = matches!(word(tokens, at + 1), "in" | "into" | "within" | "inside");
    let article = matches!(word(tokens, at + 2), "the" | "a" | "its");
    if !(partly && into && article) {
        return;
    }
    let lane = (at + 3..at + 8).find(|&at| word(tokens, at) == "lane");
    if lane.is_none_or(|lane| matches!(word(tokens, lane + 1), "of" | "on")) {
        return;
    }
    let part = |at: usize| Lexicon::get().longest(tokens, at, |meaning| matches!(meaning, Meaning::Part(_))).is_some();
    let named = |&at: &usize| {
        let leads = matches!(word(tokens, at - 1), "with" | "and" | ",");
        leads && matches!(word(tokens, at), "its" | "the") && part(at + 1)
    };
    let Some(whose) = (at.saturating_sub(REACHES_WITHIN).max(1)..at.saturating_sub(1)).rfind(named) else { return };
    // "with the rear of the bus partly in the lane" tells of that.
    let own = |of: usize| {
        let article = usize::from(matches!(word(tokens, of + 1), "the" | "its"));
        let subject = |meaning: Meaning| matches!(meaning, Meaning::Subject | Meaning::Company);
        Lexicon::get().longest(tokens, of + 1 + article, subject).is_some()
    };
    if (whose..at).filter(|&at| word(tokens, at) == "of").any(|of| !own(of)) {
        return;
    }
    let lead = word(tokens, whose - 1);
    let plain = |token: &Token| token.kind != TokenKind::Mark && !token.text.ends_with("ing") && token.text != "was";
    if !tokens[whose..at].iter().all(plain) {
        return;
    }
    let and = if lead == "with" { whose - 1 } else { whose };
    let joined = lead == "and";
    put(tokens, whose, at, "completely");
    if !joined {
        "and".clone_into(&mut tokens[and].text);
    }
    for (token, new) in tokens[at - 1..].iter_mut().zip(["was", "partially", "in"]) {
        new.clone_into(&mut token.text);
        token.capital = false;
    }
}

/// The part that reaches into a lane stands so near before "partly": "its rear driver side corner". [tokens]
const REACHES_WITHIN: usize = 9;

/// "was not in motion", "had yet to move", "had not yet moved": it stood.
fn has_not_moved(tokens: &mut [Token], at: usize) {
    let not = matches!(word(tokens, at), "not" | "n't");
    let yet = usize::from(word(tokens, at + 1) == "yet");
    if not && (word(tokens, at + 1 + yet), word(tokens, at + 2 + yet)) == ("in", "motion") {
        put(tokens, at, at + 3 + yet, "stopped");
        return;
    }
    // "was no longer in motion".
    let no_longer = (word(tokens, at), word(tokens, at + 1)) == ("no", "longer");
    if no_longer && (word(tokens, at + 2), word(tokens, at + 3)) == ("in", "motion") {
        put(tokens, at, at + 4, "stopped");
        return;
    }
    let has = matches!(word(tokens, at), "had" | "has" | "have" | "was" | "is");
    let moves = |at: usize| matches!((word(tokens, at), word(tokens, at + 1)), ("to", "move" | "start" | "proceed"));
    if has && word(tokens, at + 1) == "yet" && moves(at + 2) {
        put(tokens, at, at + 4, "stood");
    }
}

/// "with the AV (still) at rest", "with the AV stopped at a light": while it stood.
fn stand_meanwhile(tokens: &mut [Token], at: usize) {
    const NAMED: usize = 4;
    let article = matches!(word(tokens, at + 1), "the" | "it" | "both" | "traffic");
    if word(tokens, at) != "with" || !article {
        return;
    }
    let name = |token: &Token| token.kind != TokenKind::Mark && !matches!(token.text.as_str(), "of" | "on" | "its");
    for from in at + 2..tokens.len().min(at + 2 + NAMED) {
        if !name(&tokens[from - 1]) {
            return;
        }
        let how = usize::from(says_how(word(tokens, from)));
        let stopped =
            matches!(word(tokens, from + how), "stopped" | "halted") && word(tokens, from + how + 1) != "vehicles";
        let length = standing(tokens, from + how).or(if stopped { Some(1) } else { None });
        if let Some(length) = length {
            put(tokens, from + how, from + how + length, "stood");
            "while".clone_into(&mut tokens[at].text);
            return;
        }
    }
}

/// "went on to overtake it", "set out to get by", "set about turning", "was on the point of turning": how far the next verb came.
fn go_on_to(tokens: &mut [Token], at: usize) {
    let word = |ahead: usize| word(tokens, at + ahead);
    let verb = |ahead: usize| {
        word(ahead).len() > 2 && !matches!(word(ahead), "the" | "its" | "his" | "her" | "their" | "our" | "another")
    };
    let (length, new) = match (word(0), word(1), word(2)) {
        ("went" | "goes" | "going" | "moved" | "came", "on", "to") if verb(3) && !tokens[at + 3].capital => {
            (2, "proceeded")
        }
        ("set" | "sets" | "setting", "out", "to") if verb(3) => (2, "attempted"),
        ("set" | "sets", "about", next) if next.ends_with("ing") => (2, "began"),
        ("undertook" | "undertakes", "to", _) if verb(2) => (1, "began"),
        ("on", "the", "point" | "verge") if word(3) == "of" && word(4).ends_with("ing") => (4, "preparing"),
        _ => return,
    };
    put(tokens, at, at + length, new);
}

/// "slowed ahead of turning left", "with a view to turning": before.
fn come_before(tokens: &mut [Token], at: usize) {
    let length = match (word(tokens, at), word(tokens, at + 1), word(tokens, at + 2), word(tokens, at + 3)) {
        ("ahead", "of", ..) => 2,
        ("in", "advance", "of", _) => 3,
        ("with", "a", "view", "to") => 4,
        _ => return,
    };
    let verb = matches!(
        word(tokens, at + length),
        "turning" | "making" | "changing" | "pulling" | "entering" | "stopping" | "proceeding" | "crossing" | "merging"
    );
    // "ahead of turning traffic".
    let next = word(tokens, at + length + 1);
    let noun = next.starts_with("traffic")
        || next.starts_with("vehicle")
        || next.starts_with("car")
        || next.starts_with("truck");
    if verb && !noun {
        put(tokens, at, at + length, "completely");
        "before".clone_into(&mut tokens[at + length - 1].text);
    }
}

/// "gave a cart a push": pushed it.
fn give_a_push(tokens: &mut [Token], at: usize) {
    const NAMED: usize = 6;
    let push = match word(tokens, at) {
        "gave" | "given" => "pushed",
        "give" => "push",
        "giving" => "pushing",
        _ => return,
    };
    for from in at + 2..tokens.len().min(at + NAMED) {
        if tokens[from].kind == TokenKind::Mark {
            return;
        }
        let hard = usize::from(matches!(word(tokens, from + 1), "hard" | "slight" | "little" | "light" | "gentle"));
        if word(tokens, from) == "a" && matches!(word(tokens, from + 1 + hard), "push" | "shove" | "kick" | "nudge") {
            put(tokens, from, from + 2 + hard, "completely");
            push.clone_into(&mut tokens[at].text);
            return;
        }
    }
}

/// "left a lot without a full stop": without stopping.
fn without_a_stop(tokens: &mut [Token], at: usize) {
    let full = usize::from(matches!(word(tokens, at + 2), "full" | "complete" | "proper" | "required"));
    let stop = word(tokens, at + 2 + full) == "stop" && word(tokens, at + 3 + full) != "sign";
    if word(tokens, at) == "without" && word(tokens, at + 1) == "a" && stop {
        tokens[at + 1..at + 2 + full].iter_mut().for_each(|token| "ever".clone_into(&mut token.text));
        "stopping".clone_into(&mut tokens[at + 2 + full].text);
    }
}

/// "On green, it set off", "when it got a green light", "upon the change to green": the light was, or had turned, green.
fn on_green(tokens: &mut [Token], at: usize) {
    let word = |ahead: usize| word(tokens, at + ahead);
    let article = usize::from(matches!(word(1), "a" | "the" | "its"));
    let light = usize::from(matches!(word(2 + article), "light" | "signal" | "arrow"));
    let end = 2 + article + light;
    let green = word(1 + article) == "green" && !tokens[at + 1 + article].capital;
    // "on green paint", "on the green truck".
    let whole = green
        && tokens.get(at + end).is_none_or(|next| {
            light > 0
                || next.kind == TokenKind::Mark
                || matches!(
                    next.text.as_str(),
                    "it" | "the" | "and" | "when" | "as" | "at" | "from" | "to" | "into" | "through"
                )
        });
    let fronted = at.checked_sub(1).is_none_or(|before| tokens[before].kind == TokenKind::Mark);
    match word(0) {
        // "drove in on a green light" names the light itself.
        "on" | "at" if whole && (light == 0 || fronted) && (word(0) == "on" || word(1) == "the") => {
            put(tokens, at, at + end, "completely");
            if light > 0 && article > 0 {
                // "the light was green" names it.
                for (token, new) in tokens[at..].iter_mut().zip(["light", "was", "green"]) {
                    new.clone_into(&mut token.text);
                }
            } else {
                "was".clone_into(&mut tokens[at + article].text);
                "green".clone_into(&mut tokens[at + article + 1].text);
            }
        }
        "got" | "gets" | "given" | "received" if whole && article > 0 => {
            put(tokens, at, at + end, "completely");
            "turned".clone_into(&mut tokens[at + 1].text);
            "green".clone_into(&mut tokens[at + 2].text);
        }
        "the" if word(1) == "change" && word(2) == "to" && word(3) == "green" => {
            put(tokens, at, at + 3, "completely");
            "turned".clone_into(&mut tokens[at + 2].text);
        }
        _ => {}
    }
}

/// "With the light (now) green, it set off", "the light being red": it was.
fn with_the_light(tokens: &mut [Token], at: usize) {
    let light = |at: usize| matches!(word(tokens, at), "light" | "signal");
    let colour = |at: usize| matches!(word(tokens, at), "red" | "green" | "yellow") && !tokens[at].capital;
    let (with, the) = (word(tokens, at) == "with", matches!(word(tokens, at + 1), "the" | "its"));
    let now = matches!(word(tokens, at + 3), "now" | "still" | "showing" | "already" | "being");
    if with && the && light(at + 2) && (colour(at + 3) || now && colour(at + 4)) {
        let was = at + 2 + usize::from(now);
        if !now {
            let named = tokens[at + 2].text.clone();
            tokens[at + 1].text = named;
        }
        "when".clone_into(&mut tokens[at].text);
        "was".clone_into(&mut tokens[was].text);
    } else if light(at) && word(tokens, at + 1) == "being" && colour(at + 2) {
        "was".clone_into(&mut tokens[at + 1].text);
    }
}

/// "the AV followed suit": did likewise.
fn follow_suit(tokens: &mut [Token], at: usize) {
    if (word(tokens, at), word(tokens, at + 1)) == ("followed", "suit") {
        for (token, new) in tokens[at..].iter_mut().zip(["did", "likewise"]) {
            new.clone_into(&mut token.text);
        }
    }
}

/// "did not obey a red light": disobeyed it.
fn does_not_obey(tokens: &mut [Token], at: usize) {
    let obeys = matches!(word(tokens, at + 2), "obey" | "heed" | "observe");
    if word(tokens, at) == "did" && word(tokens, at + 1) == "not" && obeys {
        put(tokens, at, at + 3, "disobeyed");
    }
}
