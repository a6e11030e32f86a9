//! Partners that are things: what they are, how large, how they lie, and whether they move by themselves.

use crate::reading::words::text;
use crate::told::lies::Lies;
use crate::told::side::{Side, Turning};
use crate::told::zones::side_of;
use recrash_model::account::{
    Account, Act, ActFact, ContactState, Fact, Kind, KindGroup, LeftRight, Origin, Party, PlaceKind, RoadFeature,
    Source, Striker, told,
};
use recrash_model::scenario::Size;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Words for the road itself: whose underside touches it comes over where it rises.
const PAVED: [&str; 4] = ["pavement", "asphalt", "ground", "surface"];

impl Lies {
    /// What the words for it tell.
    pub(super) fn of(thing: &Party, sv: &Side, place: PlaceKind) -> Option<Self> {
        let any =
            |words: &[&str]| words_of(&thing.kind).is_some_and(|text| words.iter().any(|word| text.contains(word)));
        let turns_in =
            matches!(sv.turning, Turning::Left | Turning::Right) || place.is_lot() || place == PlaceKind::Driveway;
        match told(&thing.kind)? {
            Kind::Curb | Kind::Pothole if any(&["speed bump", "speed hump", "speed table", "gate track"]) => {
                Some(Self::Bump)
            }
            Kind::Debris if any(&["spikes"]) => Some(Self::Bump),
            Kind::Pothole if any(&["water meter"]) => Some(Self::Hole),
            Kind::Pothole if any(&["water", "flood", "wet cement"]) => Some(Self::Water),
            // Who scrapes a cover or a plate with its underside has it in the middle.
            Kind::Pothole if sv.only_below && any(&["cover", "grate", "plate"]) => None,
            Kind::Pothole if sv.only_above_or_below && (turns_in || any(&PAVED)) && !any(&["hole", "removed"]) => {
                Some(Self::Edge)
            }
            Kind::Pothole => Some(Self::Hole),
            _ => None,
        }
    }
}

/// Lengths and widths of things that are longer or shorter than others of their kind, by the words for them; usual ones, assumed. [m]
const SIZES_M: [(&str, f64, f64); 22] = [
    ("fallen tree", 0.5, 4.0),
    ("solar panel", 1.6, 1.0),
    ("planter", 1.0, 1.0),
    ("bollard", 0.3, 0.3),
    ("pillar", 0.6, 0.6),
    ("column", 0.6, 0.6),
    ("utility box", 0.8, 0.6),
    ("electrical box", 0.8, 0.6),
    ("bench", 1.5, 0.6),
    ("cement bumper", 1.8, 0.3),
    ("door frame", 0.3, 0.3),
    ("fixed", 1.0, 1.0),
    ("bicycle", 1.7, 0.6),
    ("mattress", 1.9, 1.4),
    ("ladder", 2.5, 0.5),
    ("pallet", 1.2, 1.0),
    ("couch", 2.0, 0.9),
    ("sofa", 2.0, 0.9),
    ("dumpster", 1.8, 1.2),
    ("plywood", 2.4, 1.2),
    ("portable basketball", 1.2, 1.0),
    ("ball", 0.3, 0.3),
];

/// Words for what stands else, and lies.
const DOWN: [&str; 8] = ["fallen", "fell", "knocked", "downed", "lying", "laying", "lay", "laid"];

/// What stands else lies across the lane; a branch that is told to hang reaches into it from beside the road: along it, and across. [m]
const LIES_ACROSS: Size = Size { length_m: 0.5, width_m: 2.0 };
pub(super) const REACHES_IN: Size = Size { length_m: 1.0, width_m: 2.4 };

/// Whether it is told of what stands or hangs else that it lies: "a fallen sign", "a pole was lying across the lane".
pub(super) fn lies_down(thing: &Party) -> bool {
    let acts = thing.acts.iter().filter(|fact| !fact.after_contact).map(|fact| text(&fact.source));
    let mut said = words_of(&thing.kind).into_iter().chain(acts);
    said.any(|words| words.split(|letter: char| !letter.is_alphanumeric()).any(|word| DOWN.contains(&word)))
}

/// How words begin for what reaches into the lane from beside it, or above.
const HANGS: [&str; 9] = ["hang", "hung", "dangl", "overhang", "overhung", "overgrown", "protrud", "extend", "reach"];

/// Whether the partner is a branch or the like that is told to hang or reach into the lane, on the side that is touched.
pub(super) fn reaches_in(thing: &Party, account: &Account, sv: &Side) -> Option<LeftRight> {
    let acts = thing.acts.iter().filter(|fact| !fact.after_contact).map(|fact| &fact.source);
    let touched = account.sv.zones.iter().map(|fact| &fact.source);
    let mut said = thing.kind.iter().map(|fact| &fact.source).chain(acts).chain(touched).map(text);
    let hangs = |word: &str| word == "low" || HANGS.iter().any(|stem| word.starts_with(stem));
    let hangs = said.any(|words| words.split(|letter: char| !letter.is_alphanumeric()).any(hangs));
    let branch = hangs && told(&thing.kind) == Some(Kind::TreeBranch) && !lies_down(thing);
    side_of(&sv.zones).filter(|_| branch)
}

/// The size of a small thing, where the words for it tell more than its kind.
pub(super) fn size(thing: &Party) -> Option<Size> {
    let kind = told(&thing.kind)?;
    if matches!(kind, Kind::Sign | Kind::Pole) && lies_down(thing) {
        return Some(LIES_ACROSS);
    }
    let small = matches!(kind, Kind::Debris | Kind::Object | Kind::Scooter | Kind::Cargo | Kind::Wall | Kind::Pole);
    let text = words_of(&thing.kind).filter(|_| small)?;
    let found = SIZES_M.iter().find(|(word, ..)| text.contains(word));
    found.map(|(_, length_m, width_m)| Size { length_m: *length_m, width_m: *width_m })
}

/// The words in which a fact stands.
fn words_of<T>(fact: &Option<Fact<T>>) -> Option<String> {
    match &fact.as_ref()?.source {
        Source::Words { text, .. } => Some(text.to_lowercase()),
        _ => None,
    }
}

/// The partner, with what is told of a thing beside its own acts: "rolling into its lane" stands with from where it came.
pub(super) fn partner(account: &Account) -> Option<Party> {
    let mut partner = account.partner.clone()?;
    let moves = ["roll", "slid", "skid", "blow", "blew", "flew", "fly", "bounc", "tumbl", "drift"];
    let came = words_of(&account.came_from).is_some_and(|text| moves.iter().any(|stem| text.contains(stem)));
    let thing = told(&partner.kind).is_some_and(is_thing);
    if thing && (came || comes_off_beside(account)) && partner.state.is_none() && !slides(&partner) {
        let source = account.came_from.as_ref()?.source.clone();
        let rolls = ActFact {
            act: Act::Roll,
            side: None,
            step: 0,
            after_contact: false,
            begun: false,
            done: false,
            after_other: None,
            manner: None,
            source,
        };
        partner.acts.push(rolls);
    }
    Some(partner)
}

/// "A loose object from a truck in the left lane struck the left side of the AV": it came over from there, and lay nowhere.
fn comes_off_beside(account: &Account) -> bool {
    let Some(partner) = &account.partner else { return false };
    let beside = matches!(told(&account.came_from), Some(Origin::Beside { .. }));
    let off = |fact: &ActFact| {
        let kind = told(&partner.kind).unwrap_or(Kind::Object);
        fact.act == Act::Fall && !fact.after_contact && falls(kind, &text(&fact.source))
    };
    let drives = account.others.iter().any(|other| other.kind.value.is_vehicle());
    let gate = matches!(told(&partner.kind), Some(Kind::Gate | Kind::Barrier | Kind::TreeBranch));
    beside && drives && !gate && told(&account.striker) == Some(Striker::Cp) && partner.acts.iter().any(off)
}

fn is_thing(kind: Kind) -> bool {
    kind.group() == KindGroup::Object
}

/// Whether the ego is told to have changed lanes and driven on before it came to a thing.
pub(super) fn changed_lanes_before(account: &Account) -> bool {
    let before = || account.sv.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let last = |act: Act| before().filter(|fact| fact.act == act).map(|fact| fact.step).max();
    let thing = account.partner.as_ref().and_then(|partner| told(&partner.kind)).is_some_and(is_thing);
    let changed =
        last(Act::LaneChange).filter(|_| thing && told(&account.sv.movement) == Some(Movement::ChangingLanes));
    changed.is_some_and(|changed| last(Act::Follow) > Some(changed))
}

/// Whether a thing was moved, and the words end there: "was propelled", neither "pushed a cart" nor "pushed by a person".
pub(super) fn is_pushed_by_nobody(partner: &Party) -> bool {
    let mut pushes = partner.acts.iter().filter(|fact| fact.act == Act::Pushed);
    pushes.all(|fact| text(&fact.source).split_whitespace().last().is_some_and(|word| word.ends_with('d')))
}

/// Whether only the roof was touched: what did it hangs above the road.
pub(super) fn is_overhead(sv: &Party) -> bool {
    let zones = sv.zone_values();
    !zones.is_empty() && zones.iter().all(|zone| *zone == ContactZone::Top)
}

/// Whether a thing closes an entrance, or lies across it.
pub(super) fn is_at_entrance(thing: &Party) -> bool {
    let lies =
        words_of(&thing.kind).is_some_and(|text| ["spikes", "gate track"].iter().any(|word| text.contains(word)));
    lies || matches!(told(&thing.kind), Some(Kind::Chain | Kind::Gate | Kind::Barrier))
}

/// Whether the road is told to be a slope.
pub(super) fn is_on_slope(account: &Account) -> bool {
    account.place.features.iter().any(|fact| fact.value == RoadFeature::Slope)
}

/// Whether a thing is told to be fixed, and no more.
pub(super) fn is_fixed(thing: &Party) -> bool {
    told(&thing.kind) == Some(Kind::Object) && words_of(&thing.kind).is_some_and(|text| text.contains("fixed"))
}

/// Whether it is told of a thing that it came into the way. What has fallen lies there.
pub(super) fn slides(thing: &Party) -> bool {
    let acts = [Act::Roll, Act::Pushed, Act::Enter, Act::Cross, Act::Swerve, Act::Drift, Act::LaneChange];
    acts.into_iter().any(|act| thing.did(act))
}

/// Whether it is told of a gate or a barrier that it swung, came down, was opened or struck as the two met.
pub(super) fn swings(kind: Kind, thing: &Party, striker: Option<Striker>) -> bool {
    let acts = [Act::OpenDoor, Act::Fall, Act::SetOff, Act::Turn, Act::Roll, Act::Swerve, Act::Drift, Act::Enter];
    let moves = striker == Some(Striker::Cp) || told(&thing.state).is_some_and(|state| !state.stands());
    matches!(kind, Kind::Gate | Kind::Barrier) && (moves || acts.into_iter().any(|act| thing.did(act)))
}

/// Whether a gate is told to open, and not to have come down.
pub(super) fn opens(thing: &Party) -> bool {
    thing.did(Act::OpenDoor) && !thing.did(Act::Fall)
}

/// Size of the post of a gate that swings. [m]
pub(super) const POST: Size = Size { length_m: 0.3, width_m: 0.3 };

/// Who is named no farther behind the words that a thing came from somewhere is where it came from. [byte]
const FROM_WITHIN: usize = 16;

/// Words for what lay in the way, or stood there and went over.
const LAY_THERE: [&str; 9] = ["fallen", "blown", "lying", "laying", "tip", "toppl", "knock", "fell over", "fall over"];

/// Whether words tell that a thing came off somebody: "slid off", "came loose". What had fallen before, or tipped over, lies there; and a
/// branch breaks off a tree.
fn falls(kind: Kind, text: &str) -> bool {
    match kind {
        Kind::TreeBranch => ["fell", "came off", "from under"].iter().any(|word| text.contains(word)),
        _ => !LAY_THERE.iter().any(|word| text.contains(word)),
    }
}

/// Which of the others a thing fell off, or came out from under, ahead of an ego that follows it: one whose place is told with that, or who
/// is named right behind it.
pub(super) fn dropped_by(account: &Account, partner: &Party, sv: &Side) -> Option<usize> {
    let kind = told(&partner.kind)?;
    let drops = matches!(
        kind,
        Kind::Debris | Kind::LooseWheel | Kind::Cargo | Kind::Object | Kind::Cart | Kind::TreeBranch | Kind::Cone
    );
    let along = sv.state == ContactState::Moving && sv.turning == Turning::No && sv.aside.is_none();
    if !drops || !along || told(&account.came_from) != Some(Origin::Ahead) {
        return None;
    }
    let words = |source: &Source| match source {
        Source::Words { start, end, text } => Some((*start, *end, text.to_lowercase())),
        _ => None,
    };
    let acts = partner.acts.iter().filter(|fact| !fact.after_contact);
    let said: Vec<_> = acts.filter_map(|fact| Some((fact.act, words(&fact.source)?))).collect();
    let fell = said.iter().any(|(act, (.., text))| *act == Act::Fall && falls(kind, text));
    let from_under = |text: &str| ["fell", "came off", "from under"].iter().any(|word| text.contains(word));
    let from: Vec<usize> = said
        .iter()
        .filter(|(act, (.., text))| *act == Act::Enter && text.ends_with("from"))
        .map(|(_, (_, end, _))| *end)
        .collect();
    account.others.iter().position(|other| {
        let drives = other.kind.value.group() != KindGroup::Object && !other.several && !other.touched_partner;
        let place = other.place.as_ref().filter(|fact| fact.value == Origin::Ahead);
        let with_place =
            place.is_some_and(|fact| fell || words(&fact.source).is_some_and(|(.., text)| from_under(&text)));
        let named = words(&other.kind.source)
            .is_some_and(|(start, ..)| from.iter().any(|end| (*end..=end + FROM_WITHIN).contains(&start)));
        let named = named && other.place.as_ref().is_none_or(|fact| fact.value == Origin::Ahead);
        drives && (with_place || named)
    })
}
