//! Partner, lanes, signals, speeds, actions and sideways moves.

use super::super::actors::Actor;
use super::super::pattern::Pattern;
use super::{Relation, Sentence, column, words};
use recrash_model::narrative::{FactSource, FactValue, LanePosition, LateralKind, LongitudinalAction, Side, Signal};
use recrash_model::record::{CrashRecord, MPS_PER_MPH};
use recrash_model::scenario::{MissingArm, ObstacleKind};

/// Faster than this is a misreading. [m/s]
const GREATEST_SPEED_MPS: f64 = 70.0;

static LANE: Pattern = Pattern::new(
    r"(?i)\b(?:(?P<far>far )?(?P<side>left|right)(?P<most>[- ]?most)?(?:[- ]hand)?|(?P<mid>middle|cent(?:er|re)|(?:second|third|2nd|3rd)(?: lane)? (?:from|to) the (?:left|right)(?:most)?))(?P<kind>(?: (?:dedicated|through|thru|travel|traffic|left|right|turn|turning|only|straight|driving))*) lanes?\b",
);
static SECOND_LANE: Pattern =
    Pattern::new(r"(?i)\b(?:second|third|2nd|3rd)(?: lane)? (?:from|to) the (?:left|right)(?:most)?(?: lane)?\b");
static SIGNAL: Pattern = Pattern::new(
    r"(?i)\b(?P<a>green|yellow|amber|red)(?: \w+){0,2}? (?:light|signal|arrow|phase)\b|\b(?:light|signal)(?: \w+){0,5}? (?:turned|changed|changing|was|had turned)(?: to)? (?P<b>green|yellow|amber|red)\b|\bon (?:a )?(?P<d>green|red|yellow)\b|\b(?P<c>stop sign|yield sign|four-way stop|all-way stop)\b",
);
static SPEED: Pattern = Pattern::new(
    r"(?i)\b(?P<n>\d{1,3}(?:\.\d{1,3})?) ?(?P<unit>mph|miles per hour|miles an hour|m\.p\.h|km/h|kph|mps|m/s|meters per second)",
);
static SPEED_LIMIT: Pattern = Pattern::new(r"(?i)\b(?:limit|posted|zone)\b");
static AT_IMPACT: Pattern =
    Pattern::new(r"(?i)\b(?:impact|contact|collision|reducing|reduced|slowed|decelerat\w+|brak\w+)\b");
static ACTION: Pattern = Pattern::new(
    r"(?i)\b(?:(?P<hard>(?:brak\w+|stopp\w+) (?:hard|suddenly|abruptly|sharply)|hard[- ]brak\w+|(?:suddenly|abruptly) (?:brak\w+|stopp\w+)|slammed (?:on )?(?:the |its )?brakes)|(?P<halt>(?:came|coming|come|slowed|braked) to (?:a|an) (?:\w+ ){0,2}?(?:stop|halt))|(?P<stood>(?:was|were|been|previously|remained|fully) (?:\w+ )?stopped|stopped (?:at|for|in|behind|and|facing|before)|stationary|at rest|at a (?:complete |full )?stop|waiting)|(?P<yielded>yield\w*)|(?P<faster>accelerat\w+|sped up|speeding up|began (?:to )?(?:mov\w+|proceed\w*|go|driv\w+)|started (?:to )?(?:mov\w+|proceed\w*|forward)|set off)|(?P<slower>brak\w+|slow(?:ed|ing|s)?|decelerat\w+))\b",
);
static LATERAL: Pattern = Pattern::new(
    r"(?i)\b(?:(?P<wide>wide(?:ly)?)|(?P<cut>cut(?:s|ting)? (?:in|into|off|across|in front)|swerv\w+ (?:in front|into))|(?P<change>(?:chang\w+|switch\w+) (?:\w+ )?lanes?|lane[- ]chang\w+|merg(?:e|ed|es|ing)|(?:moved?|moving|mov\w+ over|entered|entering|came over|coming over|cross(?:ed|es|ing)(?: over)?|turn\w+) (?:partially )?into (?:the )?[^.]{0,30}?lane)|(?P<drift>drift\w*|encroach\w*|veer\w*|swerv\w+|(?:partially|over) (?:\w+ )?(?:the )?(?:line|lane marking)))\b",
);
static TOWARDS: Pattern = Pattern::new(r"(?i)^[^.]{0,30}?\b(?:to(?:wards?)? (?:the|its) )?(?P<side>left|right)\b");
static THREE_WAY: Pattern = Pattern::new(
    r"\bT[- ](?:[Ii]ntersection|[Jj]unction)|(?i:\bthree[- ]way (?:intersection|junction|stop)|\bthree[- ]legged|\b3[- ]way (?:intersection|junction|stop))",
);
static SIDE_STREET: Pattern =
    Pattern::new(r"(?i)\b(?:intersects|joins|meets)(?: \w+){0,3} from the (?P<side>left|right)\b");
static CLOSED: Pattern = Pattern::new(
    r"(?i)\b(?P<a>left|right)(?:most)?(?: \w+){0,2} lanes? (?:was|were|is|are)(?: \w+)? closed\b|\bcones?[^.]{0,40}?\bon (?:the|its) (?P<b>left|right)\b",
);

/// Reads everything but approach, collision and contact areas.
pub(super) fn read(
    record: &CrashRecord,
    sentences: &[Sentence],
    relation: Option<Relation>,
    add: &mut impl FnMut(FactValue, FactSource),
) {
    if let Some(kind) = record.partner.known() {
        add(FactValue::Partner { kind }, column(record, "Crash With", kind.label()));
    }
    speeds(record, sentences, add);
    lanes(record, sentences, add);
    signals(record, sentences, add);
    actions(record, sentences, add);
    lateral(record, sentences, relation, add);
    layout(record, sentences, add);
}

fn speeds(record: &CrashRecord, sentences: &[Sentence], add: &mut impl FnMut(FactValue, FactSource)) {
    let (mut sv, mut cp) = (None, None);
    for sentence in sentences {
        for found in SPEED.captures_iter(sentence.text) {
            let whole = found.get_match();
            let before = &sentence.text[..whole.start()];
            let clause = &before[before.rfind([',', ';', '(']).unwrap_or(0)..];
            let Some(speed_mps) = speed(&found["n"], &found["unit"]) else { continue };
            if SPEED_LIMIT.is_match(clause) || AT_IMPACT.is_match(clause) {
                continue;
            }
            let nearest = sentence.mentions.nearest_before(whole.start());
            match nearest.or_else(|| sentence.mentions.subject_at(whole.start())) {
                Some(Actor::Sv) if sv.is_none() => sv = Some((speed_mps, whole.as_str())),
                Some(Actor::Cp) if cp.is_none() => cp = Some((speed_mps, whole.as_str())),
                _ => {}
            }
        }
    }
    match (sv, record.sv_speed_mps) {
        (Some((speed_mps, text)), _) => add(FactValue::SvSpeed { speed_mps }, words(record, text)),
        (None, Some(speed_mps)) => {
            let text = format!("{:.0}", speed_mps / MPS_PER_MPH);
            add(FactValue::SvSpeed { speed_mps }, column(record, "SV Precrash Speed (MPH)", text));
        }
        (None, None) => {}
    }
    if let Some((speed_mps, text)) = cp {
        add(FactValue::CpSpeed { speed_mps }, words(record, text));
    }
}

fn speed(number: &str, unit: &str) -> Option<f64> {
    let value: f64 = number.parse().ok()?;
    let factor = match unit.to_ascii_lowercase().as_str() {
        "km/h" | "kph" => 1.0 / 3.6,
        "mps" | "m/s" | "meters per second" => 1.0,
        _ => MPS_PER_MPH,
    };
    Some(value * factor).filter(|speed| *speed <= GREATEST_SPEED_MPS)
}

/// A lane and the words that name it.
type ToldLane<'a> = Option<(LanePosition, &'a str)>;

/// The first lane told of each: the ego, the partner.
pub(super) fn told_lanes<'a>(sentences: &[Sentence<'a>]) -> (ToldLane<'a>, ToldLane<'a>) {
    let (mut sv, mut cp) = (None, None);
    for sentence in sentences {
        let plain = LANE.captures_iter(sentence.text).filter_map(|found| {
            let whole = found.get_match();
            let turn_lane = found.name("kind").is_some_and(|kind| kind.as_str().to_lowercase().contains("turn"));
            let outermost = found.name("far").is_some() || found.name("most").is_some();
            let lane = match found.name("side").map(|side| side.as_str().to_lowercase()) {
                None => LanePosition::Middle,
                // "left turn lane" is a lane to turn left from, not the left lane.
                Some(_) if turn_lane && !outermost => return None,
                Some(side) if side == "left" => LanePosition::Leftmost,
                Some(_) => LanePosition::Rightmost,
            };
            Some((whole.start(), lane, whole.as_str()))
        });
        let second =
            SECOND_LANE.find_iter(sentence.text).map(|found| (found.start(), LanePosition::Middle, found.as_str()));
        let mut named: Vec<_> = plain.chain(second).collect();
        named.sort_by_key(|(at, ..)| *at);
        for (at, lane, text) in named {
            match sentence.mentions.subject_at(at) {
                Some(Actor::Sv) if sv.is_none() => sv = Some((lane, text)),
                Some(Actor::Cp) if cp.is_none() => cp = Some((lane, text)),
                _ => {}
            }
        }
    }
    (sv, cp)
}

fn lanes(record: &CrashRecord, sentences: &[Sentence], add: &mut impl FnMut(FactValue, FactSource)) {
    let (sv, cp) = told_lanes(sentences);
    if let Some((lane, text)) = sv {
        add(FactValue::SvLane { lane }, words(record, text));
    }
    if let Some((lane, text)) = cp {
        add(FactValue::CpLane { lane }, words(record, text));
    }
}

/// The last signal told of each: lights change.
fn signals(record: &CrashRecord, sentences: &[Sentence], add: &mut impl FnMut(FactValue, FactSource)) {
    let (mut sv, mut cp) = (None, None);
    for sentence in sentences {
        for found in SIGNAL.captures_iter(sentence.text) {
            let whole = found.get_match();
            let named = ["a", "b", "c", "d"].iter().find_map(|group| found.name(group));
            let signal = match named.map(|m| m.as_str().to_ascii_lowercase()).as_deref() {
                Some("green") => Signal::Green,
                Some("yellow" | "amber") => Signal::Yellow,
                Some("red") => Signal::Red,
                Some("yield sign") => Signal::YieldSign,
                _ => Signal::StopSign,
            };
            match sentence.mentions.subject_at(whole.start()) {
                Some(Actor::Sv) => sv = Some((signal, whole.as_str())),
                Some(Actor::Cp) => cp = Some((signal, whole.as_str())),
                _ => {}
            }
        }
    }
    if let Some((signal, text)) = sv {
        add(FactValue::SvSignal { signal }, words(record, text));
    }
    if let Some((signal, text)) = cp {
        add(FactValue::CpSignal { signal }, words(record, text));
    }
}

/// The first action of each kind.
fn actions(record: &CrashRecord, sentences: &[Sentence], add: &mut impl FnMut(FactValue, FactSource)) {
    let mut known: Vec<(Actor, LongitudinalAction)> = Vec::new();
    for sentence in sentences {
        for found in ACTION.captures_iter(sentence.text) {
            let whole = found.get_match();
            let action = if found.name("hard").is_some() {
                LongitudinalAction::BrakedHard
            } else if found.name("halt").is_some() {
                LongitudinalAction::Stopped
            } else if found.name("stood").is_some() {
                LongitudinalAction::WasStopped
            } else if found.name("yielded").is_some() {
                LongitudinalAction::Yielded
            } else if found.name("faster").is_some() {
                LongitudinalAction::Accelerated
            } else {
                LongitudinalAction::Braked
            };
            let Some(actor @ (Actor::Sv | Actor::Cp)) = sentence.mentions.subject_at(whole.start()) else { continue };
            if known.contains(&(actor, action)) {
                continue;
            }
            known.push((actor, action));
            let source = words(record, whole.as_str());
            match actor {
                Actor::Sv => add(FactValue::SvAction { action }, source),
                _ => add(FactValue::CpAction { action }, source),
            }
        }
    }
}

/// The partner's first sideways move.
fn lateral(
    record: &CrashRecord,
    sentences: &[Sentence],
    relation: Option<Relation>,
    add: &mut impl FnMut(FactValue, FactSource),
) {
    let Some(Relation::Beside(beside)) = relation else { return };
    let moved = sentences.iter().find_map(|sentence| {
        LATERAL.captures_iter(sentence.text).find_map(|found| {
            let whole = found.get_match();
            let kind = if found.name("wide").is_some() {
                LateralKind::WideTurn
            } else if found.name("cut").is_some() {
                LateralKind::CutIn
            } else if found.name("change").is_some() {
                LateralKind::LaneChange
            } else {
                LateralKind::Drift
            };
            let told = TOWARDS
                .captures(&sentence.text[whole.end()..])
                .map(|towards| if towards["side"].eq_ignore_ascii_case("left") { Side::Left } else { Side::Right });
            // A partner on the left comes to the ego by moving right.
            let towards = match beside {
                Some(Side::Left) => Some(Side::Right),
                Some(Side::Right) => Some(Side::Left),
                None => told,
            };
            let by_partner = sentence.mentions.subject_at(whole.start()) == Some(Actor::Cp);
            Some((kind, towards.filter(|_| by_partner)?, whole.as_str()))
        })
    });
    if let Some((kind, towards, text)) = moved {
        add(FactValue::CpLateral { towards, kind }, words(record, text));
    }
}

/// Three-way intersections, and cones.
fn layout(record: &CrashRecord, sentences: &[Sentence], add: &mut impl FnMut(FactValue, FactSource)) {
    let side_street = sentences.iter().find_map(|sentence| {
        let found = SIDE_STREET.captures(sentence.text)?;
        let missing = if found["side"].eq_ignore_ascii_case("left") { MissingArm::Right } else { MissingArm::Left };
        Some((missing, found.get_match().as_str()))
    });
    let three_way =
        || sentences.iter().find_map(|s| THREE_WAY.find(s.text)).map(|found| (MissingArm::Ahead, found.as_str()));
    if let Some((missing, text)) = side_street.or_else(three_way) {
        add(FactValue::ThreeWay { missing }, words(record, text));
    }
    if record.work_zone {
        let closed = sentences.iter().find_map(|sentence| {
            let found = CLOSED.captures(sentence.text)?;
            let side = found.name("a").or_else(|| found.name("b"))?;
            let side = if side.as_str().eq_ignore_ascii_case("left") { Side::Left } else { Side::Right };
            Some((side, found.get_match().as_str()))
        });
        match closed {
            Some((side, text)) => {
                add(FactValue::Obstacles { kind: ObstacleKind::Cone, side }, words(record, text));
            }
            None => {
                let why = "the column Roadway Description names a work zone; the side of its cones is not told";
                let side = Side::Left;
                add(
                    FactValue::Obstacles { kind: ObstacleKind::Cone, side },
                    FactSource::Assumed { why: why.to_owned() },
                );
            }
        }
    }
}
