//! Things: how they lie; those that move by themselves, as what rolls, slides or is pushed into the way, and gates; and who walks or
//! runs into it.

use crate::extras::STANDS_MPS;
use crate::ground::LANE_M;
use crate::lateral::is_on_foot;
use crate::others::Role;
use crate::pace::{Pace, start_over, when};
use crate::side::{Side, Turning};
use crate::told::Told;
use crate::touch::{self, side_of, size_of};
use recrash_model::account::{
    Account, Act, ActFact, ContactState, Fact, Kind, KindGroup, LaneWord, LeftRight, Origin, Party, PlaceKind,
    RoadFeature, Source, Striker, told,
};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorTrack, STEP_S};
use recrash_model::scenario::{Deed, ObstacleKind, Size};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// How something lies that the ego drives over, where its words say more than its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lies {
    /// A speed bump: across the lane.
    Bump,
    /// The edge of a raised pavement that the ego's underside scrapes: across the way where it turns in.
    Edge,
    /// A hole: under a wheel.
    Hole,
    /// Water: on the whole lane.
    Water,
}

/// Along the way, of a speed bump and of an edge. [m]
const BUMP_M: f64 = 0.4;
const EDGE_M: f64 = 0.3;

/// Along the way, of water that stands on the road. [m]
const WATER_M: f64 = 8.0;

impl Lies {
    /// What the words for it tell.
    pub(crate) fn of(thing: &Party, sv: &Side, place: PlaceKind) -> Option<Self> {
        let any =
            |words: &[&str]| words_of(&thing.kind).is_some_and(|text| words.iter().any(|word| text.contains(word)));
        let turns_in = matches!(sv.turning, Turning::Left | Turning::Right)
            || matches!(place, PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway);
        match told(&thing.kind)? {
            Kind::Curb | Kind::Pothole if any(&["speed bump", "speed hump", "speed table", "gate track"]) => {
                Some(Self::Bump)
            }
            Kind::Debris if any(&["spikes"]) => Some(Self::Bump),
            Kind::Pothole if any(&["water meter"]) => Some(Self::Hole),
            Kind::Pothole if any(&["water", "flood", "wet cement"]) => Some(Self::Water),
            Kind::Pothole if sv.only_above_or_below && turns_in && !any(&["hole", "removed"]) => Some(Self::Edge),
            Kind::Pothole => Some(Self::Hole),
            _ => None,
        }
    }

    /// Its size where it lies across the way.
    pub(crate) fn size(self) -> Option<Size> {
        match self {
            Self::Bump => Some(Size { length_m: BUMP_M, width_m: LANE_M }),
            Self::Edge => Some(Size { length_m: EDGE_M, width_m: LANE_M }),
            Self::Water => Some(Size { length_m: WATER_M, width_m: LANE_M }),
            Self::Hole => None,
        }
    }
}

/// Lengths and widths of things that are longer or shorter than others of their kind, by the words for them; usual ones, assumed. [m]
const SIZES_M: [(&str, f64, f64); 21] = [
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

/// The size of a small thing, where the words for it tell more than its kind.
pub(crate) fn size(thing: &Party) -> Option<Size> {
    let kind = told(&thing.kind)?;
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
pub(crate) fn partner(account: &Account) -> Option<Party> {
    let mut partner = account.partner.clone()?;
    let moves = ["roll", "slid", "blow", "blew", "tumbl", "drift"];
    let came = words_of(&account.came_from).is_some_and(|text| moves.iter().any(|stem| text.contains(stem)));
    let thing = told(&partner.kind).is_some_and(is_thing);
    if thing && came && partner.state.is_none() && !slides(&partner) {
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

fn is_thing(kind: Kind) -> bool {
    kind.group() == KindGroup::Object
}

/// Usual masses of things that move, assumed; none of what stands fast. [kg]
pub(crate) const fn mass_kg(kind: Kind) -> Option<f64> {
    match kind {
        Kind::Cone => ObstacleKind::Cone.mass_kg(),
        Kind::Debris | Kind::Object | Kind::Scooter | Kind::Sign | Kind::TreeBranch => ObstacleKind::Debris.mass_kg(),
        Kind::LooseWheel | Kind::Cart => Some(30.0),
        Kind::Cargo | Kind::Barrier => Some(50.0),
        _ => None,
    }
}

/// What is so far inside the ego's outline is under it. [m]
const UNDER_M: f64 = 0.3;

/// An animal that the ego drives over comes under it within this way. [m]
const ONTO_M: f64 = 1.5;

impl Told {
    /// Whether the partner is told to have touched the ego's underside alone, and is no thing that stands.
    pub(crate) fn is_driven_over(&self) -> bool {
        let stands = |kind| matches!(kind, Kind::Wall | Kind::Pole | Kind::Gate | Kind::Barrier | Kind::Door);
        self.sv.only_below && (self.cp.kind == PartnerKind::Animal || self.thing.is_some_and(|kind| !stands(kind)))
    }
}

/// Whether what lies on the road comes under the ego, clear of its edges, once it is touched; of an animal where it was then, as far as
/// the ego's front comes over it at once: whoever is touched is pushed on, as nothing here has a height.
pub(crate) fn goes_under(
    told: &Told,
    ego: &ActorTrack,
    thing: Option<&ActorTrack>,
    touched: &OrientedBox,
    since: usize,
) -> bool {
    let body = |pose: Pose| OrientedBox::new(pose, ego.length_m - 2.0 * UNDER_M, ego.width_m - 2.0 * UNDER_M);
    if told.cp.kind == PartnerKind::Animal {
        let met = &ego.states[since.min(ego.states.len() - 1)];
        let on = Vec2::from_heading(met.heading) * (met.speed().signum() * ONTO_M);
        let moves = met.velocity().length() > STANDS_MPS;
        return moves && body(Pose { position: met.position() + on, heading: met.heading }).overlaps(touched);
    }
    (since..ego.states.len()).any(|step| {
        let lying = thing.map_or(*touched, |track| track.outline(step.min(track.states.len() - 1)));
        body(ego.states[step].pose()).overlaps(&lying)
    })
}

/// Whether an ego that drives on is told to have been touched at its rear alone by a hole, or by what lies flat in its way.
fn passes_over(told: &Told) -> bool {
    let low = told.lies == Some(Lies::Hole) || told.thing == Some(Kind::Debris) && told.edge.is_none();
    low && told.sv.state == ContactState::Moving && told.sv.zones.iter().all(|zone| zone.is_rear())
}

/// Whether the told part of the ego's rear goes over what lies in its way, which its front has come over.
pub(crate) fn rear_goes_over(told: &Told, ego: &ActorTrack, lying: &OrientedBox, since: usize) -> bool {
    let half_m = Vec2::new(0.5 * ego.length_m, 0.5 * ego.width_m);
    let over = |zone: &ContactZone, step: usize| {
        let left = match zone {
            ContactZone::RearLeft => 1.0,
            ContactZone::RearRight => -1.0,
            _ => 0.0,
        };
        let state = &ego.states[step];
        let (pose, on) = (state.pose(), state.velocity() * STEP_S);
        let along = Vec2::from_heading(pose.heading);
        let middle = pose.position - along * (0.75 * half_m.x) + along.left() * (left * half_m.y * 2.0 / 3.0);
        // As long as it comes until the next step.
        let part = Pose { position: middle + on * 0.5, ..pose };
        OrientedBox::new(part, 0.5 * half_m.x + on.length(), half_m.y * 2.0 / 3.0).overlaps(lying)
    };
    passes_over(told) && (since..ego.states.len()).any(|step| told.sv.zones.iter().any(|zone| over(zone, step)))
}

/// Whether something lies in the lane for turns that the ego came along, and only a column tells that it turned.
pub(crate) fn lies_before_turn(told: &Told, sv: &Party) -> bool {
    let turns = matches!(told.sv.turning, Turning::Left | Turning::Right);
    let lane = matches!(told.sv.lane, Some(LaneWord::LeftTurn | LaneWord::RightTurn));
    let by_words = sv.movement.as_ref().is_some_and(|fact| fact.source.is_told()) || sv.did(Act::Turn);
    turns && lane && !by_words && told.thing.is_some() && told.edge.is_none()
}

/// Whether the ego is told to have changed lanes and driven on before it came to a thing.
pub(crate) fn changed_lanes_before(account: &Account) -> bool {
    let before = || account.sv.acts.iter().filter(|fact| !fact.after_contact && !fact.begun);
    let last = |act: Act| before().filter(|fact| fact.act == act).map(|fact| fact.step).max();
    let thing = account.partner.as_ref().and_then(|partner| told(&partner.kind)).is_some_and(is_thing);
    let changed =
        last(Act::LaneChange).filter(|_| thing && told(&account.sv.movement) == Some(Movement::ChangingLanes));
    changed.is_some_and(|changed| last(Act::Follow) > Some(changed))
}

/// The zones that meet where something lies across the ego's way.
pub(crate) fn across(told: &Told) -> Option<(ContactZone, ContactZone)> {
    told.lies.and_then(Lies::size)?;
    Some(match told.sv.state {
        ContactState::Reversing => (ContactZone::Rear, ContactZone::Front),
        _ => (ContactZone::Front, ContactZone::Rear),
    })
}

/// Points of the ego's outline that are touched: by a hole where its wheels are.
pub(crate) fn sv_points(told: &Told, zone: ContactZone) -> &'static [(f64, f64)] {
    match (told.lies, zone) {
        (Some(Lies::Hole), ContactZone::Front) => &[(1.0, 0.75), (1.0, -0.75)],
        (Some(Lies::Hole), ContactZone::FrontLeft) => &[(1.0, 0.75)],
        (Some(Lies::Hole), ContactZone::FrontRight) => &[(1.0, -0.75)],
        (Some(Lies::Bump | Lies::Edge | Lies::Water), _) => &touch::points(zone)[..1],
        _ => touch::points(zone),
    }
}

/// Points of the partner's outline that are touched: of a hole the middle of a side.
pub(crate) fn cp_points(told: &Told, zone: ContactZone) -> &'static [(f64, f64)] {
    match (told.lies, zone) {
        (Some(Lies::Hole), ContactZone::Rear | ContactZone::Front) => &touch::points(zone)[..1],
        (Some(Lies::Hole), _) => &[],
        _ if told.stands_across() => &touch::points(zone)[..1],
        _ => touch::points(zone),
    }
}

/// Nearer to the middle of the ego than this a hole is under no wheel; nor beside it by more. [m]
const WHEELS_M: (f64, f64) = (0.35, 1.3);

/// How what the ego drives over is told to lie, whether it does, and how it lies.
pub(crate) fn check(told: &Told, ego: &OrientedBox, other: &OrientedBox) -> Option<(String, bool, String)> {
    let lies = told.lies?;
    let corners = other.corners().map(|corner| ego.to_local(corner).y);
    let least_m = corners.iter().copied().fold(f64::MAX, f64::min);
    let most_m = corners.iter().copied().fold(f64::MIN, f64::max);
    if lies.size().is_some() {
        let across = least_m < -ego.half_width && most_m > ego.half_width;
        let seen = format!("from {:.1} m to the right to {most_m:.1} m to the left", -least_m);
        return Some(("across the ego's way".to_owned(), across, seen));
    }
    let left_m = ego.to_local(other.centre).y;
    let there = (WHEELS_M.0..WHEELS_M.1).contains(&left_m.abs());
    let (side, of) = match side_of(&told.sv.zones) {
        Some(side) if side > 0.0 => (" on the left", left_m > 0.0),
        Some(_) => (" on the right", left_m < 0.0),
        None => ("", true),
    };
    Some((format!("under a wheel{side}"), there && of, format!("{left_m:.1} m to the left of the ego's middle")))
}

/// Whether only the roof was touched: what did it hangs above the road.
pub(crate) fn is_overhead(sv: &Party) -> bool {
    let zones = sv.zone_values();
    !zones.is_empty() && zones.iter().all(|zone| *zone == ContactZone::Top)
}

/// Whether a thing closes an entrance, or lies across it.
pub(crate) fn is_at_entrance(thing: &Party) -> bool {
    let lies =
        words_of(&thing.kind).is_some_and(|text| ["spikes", "gate track"].iter().any(|word| text.contains(word)));
    lies || matches!(told(&thing.kind), Some(Kind::Chain | Kind::Gate | Kind::Barrier))
}

/// Whether the road is told to be a slope.
pub(crate) fn is_on_slope(account: &Account) -> bool {
    account.place.features.iter().any(|fact| fact.value == RoadFeature::Slope)
}

/// Whether a thing is told to be fixed, and no more.
pub(crate) fn is_fixed(thing: &Party) -> bool {
    told(&thing.kind) == Some(Kind::Object) && words_of(&thing.kind).is_some_and(|text| text.contains("fixed"))
}

/// How fast a thing is that rolls or slides, from how far away. [m/s, m]
pub(crate) const SLIDES_MPS: f64 = 2.0;
const SLIDES_M: f64 = 4.0;

/// The same from the edge of the ego's lane, and how much farther to its other side. [m]
const FROM_EDGE_M: f64 = 1.5;
const TO_FAR_SIDE_M: f64 = 0.7;

/// Whether it is told of a thing that it came into the way. What has fallen lies there.
pub(crate) fn slides(thing: &Party) -> bool {
    let acts = [Act::Roll, Act::Pushed, Act::Enter, Act::Cross, Act::Swerve, Act::Drift, Act::LaneChange];
    acts.into_iter().any(|act| thing.did(act))
}

/// Whether it is told of a gate or a barrier that it swung, came down, was opened or struck as the two met.
pub(crate) fn swings(kind: Kind, thing: &Party, striker: Option<Striker>) -> bool {
    let acts = [Act::OpenDoor, Act::Fall, Act::SetOff, Act::Turn, Act::Roll, Act::Swerve, Act::Drift, Act::Enter];
    let moves = striker == Some(Striker::Cp) || told(&thing.state).is_some_and(|state| !state.stands());
    matches!(kind, Kind::Gate | Kind::Barrier) && (moves || acts.into_iter().any(|act| thing.did(act)))
}

/// Size of the post of a gate that swings. [m]
pub(crate) const POST: Size = Size { length_m: 0.3, width_m: 0.3 };

/// What falls off the vehicle ahead slides for so long until it is met, and slows so; no slower than this, nor from a higher speed: no
/// scenario has a thing that is faster. [s, m/s^2, m/s]
const DROPPED_MOST_MPS: f64 = 15.0;
const DROPPED_S: f64 = 2.5;
const DROPPED_MPS2: f64 = 5.0;
const DROPPED_LEAST_MPS: f64 = 0.5;

/// Who is named no farther behind the words that a thing came from somewhere is where it came from. [byte]
const FROM_WITHIN: usize = 16;

/// Which of the others a thing fell off, or came out from under, ahead of an ego that follows it: one whose place is told with that, or who
/// is named right behind it. What had fallen before lies there.
pub(crate) fn dropped_by(account: &Account, partner: &Party, sv: &Side, place: PlaceKind) -> Option<usize> {
    let drops = matches!(told(&partner.kind)?, Kind::Debris | Kind::LooseWheel | Kind::Cargo | Kind::Object);
    let along = sv.state == ContactState::Moving && sv.turning == Turning::No && sv.aside.is_none();
    let slow = sv.impact_mps.map_or(place != PlaceKind::Highway, |mps| mps <= DROPPED_MOST_MPS);
    if !drops || !along || !slow || told(&account.came_from) != Some(Origin::Ahead) {
        return None;
    }
    let words = |source: &Source| match source {
        Source::Words { start, end, text } => Some((*start, *end, text.to_lowercase())),
        _ => None,
    };
    let falls = |text: &str| ["fell", "came off", "from under"].iter().any(|word| text.contains(word));
    let acts = partner.acts.iter().filter(|fact| !fact.after_contact);
    let said: Vec<_> = acts.filter_map(|fact| Some((fact.act, words(&fact.source)?))).collect();
    let fell = said.iter().any(|(act, (.., text))| *act == Act::Fall && falls(text));
    let from: Vec<usize> = said
        .iter()
        .filter(|(act, (.., text))| *act == Act::Enter && text.ends_with("from"))
        .map(|(_, (_, end, _))| *end)
        .collect();
    account.others.iter().position(|other| {
        let drives = other.kind.value.group() != KindGroup::Object && !other.several && !other.touched_partner;
        let place = other.place.as_ref().filter(|fact| fact.value == Origin::Ahead);
        let with_place = place.is_some_and(|fact| fell || words(&fact.source).is_some_and(|(.., text)| falls(&text)));
        let named = words(&other.kind.source)
            .is_some_and(|(start, ..)| from.iter().any(|end| (*end..=end + FROM_WITHIN).contains(&start)));
        let named = named && other.place.as_ref().is_none_or(|fact| fact.value == Origin::Ahead);
        drives && (with_place || named)
    })
}

impl Told {
    /// How fast a thing is yet that fell off the vehicle ahead. [m/s]
    pub(crate) fn dropped_mps(&self) -> Option<f64> {
        let slowed_mps = self.sv.speed_mps - DROPPED_MPS2 * DROPPED_S;
        self.dropped.map(|_| slowed_mps.max(DROPPED_LEAST_MPS.min(self.sv.speed_mps)))
    }

    /// It comes along as fast as the ego, on the vehicle ahead, and slides.
    fn dropped_pace(&self) -> Option<Pace> {
        let (from_mps, to_mps) = (self.sv.speed_mps, self.dropped_mps()?);
        let sliding_s = (from_mps - to_mps) / DROPPED_MPS2;
        let slows = Deed::Speed { to_mps, rate_mps2: DROPPED_MPS2 };
        let on_m = from_mps * (self.contact_s - DROPPED_S) + to_mps * (DROPPED_S - sliding_s);
        let driven_m = on_m + 0.5 * (from_mps + to_mps) * sliding_s;
        Some(Pace { speed_mps: from_mps, acts: vec![when(self.contact_s - DROPPED_S, slows)], driven_m })
    }

    /// Whether the partner is a kerb or a wall that stands across the ego's way: nobody tells on which side of it.
    pub(crate) fn stands_across(&self) -> bool {
        let along = matches!(self.thing, Some(Kind::Curb | Kind::Wall));
        let ahead = side_of(&self.sv.zones).is_none() || self.sv.zones.contains(&ContactZone::Front);
        along && ahead && self.lies.is_none() && self.edge.is_none()
    }

    /// Whether the partner is a thing that came into the way by itself.
    pub(crate) fn is_sliding(&self) -> bool {
        self.thing.is_some() && self.slides && self.cp.state == ContactState::Moving
    }

    /// Whether the partner comes across from aside: a thing, somebody on foot, or an animal.
    pub(crate) fn comes_across(&self) -> bool {
        self.is_sliding() || self.walks_across && self.cp.state == ContactState::Moving
    }
}

/// Whether it is told of somebody on foot, or of an animal, that it went into the ego's way or across.
pub(crate) fn walks_across(origin: Origin, partner: &Party) -> bool {
    let along = matches!(origin, Origin::Ahead | Origin::Beside { .. });
    let on_foot = told(&partner.kind).and_then(Kind::partner_kind).is_some_and(is_on_foot);
    let crosses = told(&partner.movement) == Some(Movement::NmCrossing);
    let enters = [Act::Cross, Act::Enter, Act::PullOut].into_iter().any(|act| partner.did(act));
    along && on_foot && (crosses || enters)
}

/// It lies or stands aside, and then comes; or it comes off the vehicle ahead.
pub(crate) fn pace(told: &Told) -> Option<Pace> {
    if let Some(dropped) = told.dropped_pace() {
        return Some(dropped);
    }
    // From the lane's edge where somebody drives in the next one.
    let abreast = told.extras.iter().any(|extra| matches!(extra.role, Role::Abreast | Role::Beside));
    let far = match (told.origin, side_of(&told.sv.zones)) {
        (Origin::Beside { side }, Some(touched)) => (side == LeftRight::Left) != (touched > 0.0),
        _ => false,
    };
    let way_m = match abreast && told.thing.is_some() {
        true => FROM_EDGE_M + if far { TO_FAR_SIDE_M } else { 0.0 },
        false => SLIDES_M,
    };
    told.comes_across().then(|| start_over(told.contact_s, told.cp.speed_mps, way_m)).flatten()
}

/// Across the ego's lane: from the told side, or from both.
pub(crate) fn headings(told: &Told) -> Vec<f64> {
    let from = match told.origin {
        Origin::Beside { side } | Origin::Cross { side } => vec![side],
        _ => vec![LeftRight::Right, LeftRight::Left],
    };
    let across = |side: LeftRight| if side == LeftRight::Left { -math::FRAC_PI_2 } else { math::FRAC_PI_2 };
    from.into_iter().flat_map(|side| [0.0, 0.5, -0.5].map(|off| across(side) + off)).collect()
}

/// What is told as a wall, and is no longer than this, is a pole. [m]
const SLIM_M: f64 = 0.5;

/// How a thing is drawn.
pub(crate) fn obstacle_kind(kind: Kind, told: &Told) -> ObstacleKind {
    let slim = size_of(&told.cp).0 < SLIM_M;
    match kind {
        Kind::Pothole if matches!(told.lies, Some(Lies::Bump | Lies::Edge)) => ObstacleKind::Kerb,
        Kind::Wall if slim => ObstacleKind::Pole,
        Kind::Object if told.edge.is_some() => ObstacleKind::Wall,
        Kind::Debris if told.edge.is_some() => ObstacleKind::Container,
        Kind::Wall => ObstacleKind::Wall,
        Kind::Pole => ObstacleKind::Pole,
        Kind::Curb => ObstacleKind::Kerb,
        Kind::Gate => ObstacleKind::Gate,
        Kind::Chain => ObstacleKind::Chain,
        Kind::Barrier => ObstacleKind::Barrier,
        Kind::Cone => ObstacleKind::Cone,
        Kind::Sign => ObstacleKind::Warning,
        Kind::Pothole => ObstacleKind::Pothole,
        _ => ObstacleKind::Debris,
    }
}
