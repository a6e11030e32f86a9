//! Told facts, held against a rollout. Nothing here reads the scenario: only who was where.

use crate::acts;
use crate::control;
use crate::door;
use crate::entry::Junction;
use crate::extras::STANDS_MPS;
use crate::keeping;
use crate::kerb;
use crate::lateral::is_on_foot;
use crate::layout::Counted;
use crate::movement::{self, Way};
use crate::others;
use crate::phases;
use crate::roadside;
use crate::seen::Seen;
use crate::side::Slant;
use crate::strips;
use crate::things;
use crate::thrown;
use crate::told::Told;
use crate::touch::{side_of, zones_off};
use crate::trailer::{self, Rig};
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::{
    ContactState, Control as Said, ControlDevice, Kind, LaneWord, LeftRight, Obeyed, Origin, StandReason, Striker,
};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::narrative::FirstMover;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Rollout, STEP_S};
use recrash_model::scenario::MissionStop;
use recrash_model::zones::ContactZone;
use recrash_roads::{RoadPart, Scenario};

/// Nearer to the middle than this a contact is on neither side. [m]
const MIDDLE_M: f64 = 0.1;

/// Whether a contact lies within a step of a told zone, and not on the other side of the vehicle than all told ones.
fn is_near(told: &[ContactZone], seen: ContactZone, outline: &OrientedBox, point: Vec2) -> bool {
    let aside_m = outline.to_local(point).y;
    let other_side = side_of(told).is_some_and(|side| side * aside_m < -MIDDLE_M);
    zones_off(told, seen) <= 1 && !other_side
}

/// Who is no farther from the place of the contact is there. [m]
const NEAR_M: f64 = 0.5;

/// Who come within this time come together. [s]
const TOGETHER_S: f64 = 1.0;

/// Who is in a lane is no farther beside the middle of it. [m]
const KEEPS_M: f64 = 0.7;

/// Who stands no farther from a stop of its task stands at it. [m]
const AT_STOP_M: f64 = 1.0;

struct Touch<'a> {
    time_s: f64,
    ego: ActorState,
    other: ActorState,
    kind: PartnerKind,
    other_box: OrientedBox,
    track: Option<&'a ActorTrack>,
}

/// Every told fact.
pub(crate) fn facts(told: &Told, scenario: &Scenario, rollout: &Rollout) -> Vec<Check> {
    let mut list = Vec::new();
    let mut fact = |kind: CheckKind, shown: bool, expected: String, observed: String| {
        let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
        list.push(Check { kind, expected, observed, result });
    };
    let Some(touch) = first_touch(rollout) else {
        for kind in told.kinds() {
            fact(kind, false, "what is told of the contact".to_owned(), "no contact".to_owned());
        }
        return list;
    };
    let by_partner = touch.track.is_none_or(|track| track.id == "cp");
    let undisturbed = told.pushed || toucher(rollout, &touch).is_none();
    let who = match (by_partner, undisturbed) {
        (true, true) => "the partner",
        (true, false) => "the partner, after another",
        (false, _) => "somebody else",
    };
    let crash = others::crash(told, rollout);
    fact(
        CheckKind::Contact,
        by_partner && undisturbed && crash.is_none(),
        "a contact with the partner, and none of others".to_owned(),
        format!("with {who} at {:.2} s{}", touch.time_s, crash.map_or(String::new(), |crash| format!("; {crash}"))),
    );
    fact(
        CheckKind::Partner,
        touch.kind == told.cp.kind,
        told.cp.kind.label().to_owned(),
        touch.kind.label().to_owned(),
    );
    let ego_track = rollout.ego_track();
    let ego_box = OrientedBox::new(touch.ego.pose(), ego_track.length_m, ego_track.width_m);
    let (ego_part, other_part) = parts_that_touch(rollout, &touch, &ego_box);
    let mut geometry = contact_geometry(
        ego_part.as_ref().unwrap_or(&ego_box),
        touch.ego.velocity(),
        other_part.as_ref().unwrap_or(&touch.other_box),
        touch.other.velocity(),
    );
    if let Some(part) = &ego_part {
        geometry.ego_zone = door::zone_of(&ego_box, part);
    }
    let trailer = told.trailer_of.and_then(Rig::of).filter(|_| trailer::is_drawn(rollout));
    if let Some(part) = &other_part {
        geometry.other_zone = match trailer {
            Some(rig) => rig.zone(part, &geometry),
            None => door::zone_of(&touch.other_box, part),
        };
    }
    if !told.sv.zones.is_empty() {
        let near = is_near(&told.sv.zones, geometry.ego_zone, &ego_box, geometry.point);
        let since = (touch.time_s / STEP_S) as usize;
        let over = !near && things::rear_goes_over(told, ego_track, &touch.other_box, since);
        let observed = geometry.ego_zone.label().to_owned() + if over { ", and the rear goes over it" } else { "" };
        fact(CheckKind::SvZones, near || over, zone_words(&told.sv.zones), observed);
    }
    if !told.cp.zones.is_empty() && told.thing.is_none() {
        let near = is_near(&told.cp.zones, geometry.other_zone, &touch.other_box, geometry.point);
        // Of one box, the part of it behind who draws it.
        let on_trailer = match trailer {
            Some(_) => other_part.is_some(),
            None => told.trailer_of.is_none() || trailer::is_on_trailer(told, &touch.other_box, geometry.point),
        };
        let (mut expected, mut observed) = (zone_words(&told.cp.zones), geometry.other_zone.label().to_owned());
        if told.trailer_of.is_some() {
            expected += ", on the trailer";
            observed += if on_trailer { ", on the trailer" } else { ", ahead of the trailer" };
        }
        fact(CheckKind::CpZones, near && on_trailer, expected, observed);
    }
    let swung =
        other_part.as_ref().zip(touch.track).is_some_and(|(part, track)| swung(rollout, track, part, touch.time_s));
    // Of a thing that stands nothing else is told.
    let touch = Touch { track: touch.track.filter(|_| !told.gate_swings), ..touch };
    if told.gate_swings {
        let observed = if swung { "its arm swung" } else { "nothing swung" };
        fact(CheckKind::CpState, swung, "swinging".to_owned(), observed.to_owned());
    } else if told.is_sliding() && touch.track.is_none() {
        fact(CheckKind::CpState, false, "moving".to_owned(), "it lies there".to_owned());
    }
    let mut states = vec![(CheckKind::SvState, &told.sv, ego_track, &touch.ego)];
    states.extend(touch.track.map(|track| (CheckKind::CpState, &told.cp, track, &touch.other)));
    for (kind, side, track, seen) in states.into_iter().filter(|(_, side, ..)| side.state_told) {
        // Who is pushed moves when it touches.
        let pushed = kind == CheckKind::CpState && told.pushed && told.thing.is_none();
        let stood = stood(track, touch.time_s);
        let (slowed, gained) = changed(track, touch.time_s);
        let (as_told, phases) = phases::check(phases::checked(&side.phases), track, touch.time_s);
        let stands_so = told.stands_so(kind == CheckKind::SvState, scenario, seen);
        let backs_first = told.backs_first.filter(|_| kind == CheckKind::CpState && !told.sv.phases.is_empty());
        let in_order = backs_first.is_none_or(|first| phases::back_in_order(first, ego_track, track, touch.time_s));
        let shown = pushed
            || state(side.state, track, seen, touch.time_s)
                && stands_so
                && (stood || !side.stood_first)
                && (slowed || side.slowed_from.is_none())
                && (gained || !side.gains)
                && as_told
                && in_order;
        let before = |stood: bool, slowed: bool, gained: bool| match (stood, slowed, gained) {
            (true, true, _) => ", had stood, then slowed",
            (true, ..) => ", had stood",
            (false, true, _) => ", had slowed",
            (false, false, true) => ", had gained speed",
            (false, false, false) => "",
        };
        let (mut expected, mut observed) = (side.state.label().to_owned(), format!("{:.2} m/s", seen.speed()));
        if !stands_so {
            expected += ", beside the lanes";
            observed += ", in a driving lane";
        }
        if let Some(first) = backs_first {
            expected += if first == Striker::Cp { ", backed first" } else { ", backed after the ego" };
            observed += if in_order { ", so it did" } else { ", so it did not" };
        }
        if side.phases.is_empty() {
            expected += before(side.stood_first, side.slowed_from.is_some(), side.gains);
            observed += before(stood, slowed, gained);
        } else {
            expected += &format!(": {}", phases::words(phases::checked(&side.phases)));
            observed += &format!(": {phases}");
        }
        fact(kind, shown, expected, observed);
    }
    for (kind, impact_mps, seen) in
        [(CheckKind::SvSpeed, told.sv.impact_mps, &touch.ego), (CheckKind::CpSpeed, told.cp.impact_mps, &touch.other)]
    {
        if let Some(impact_mps) = impact_mps {
            let speed_mps = seen.velocity().length();
            let close = (speed_mps - impact_mps).abs() <= 2.0_f64.max(0.25 * impact_mps);
            fact(kind, close, format!("{impact_mps:.1} m/s at the contact"), format!("{speed_mps:.1} m/s"));
        }
    }
    if told.pushed {
        let before = toucher(rollout, &touch);
        let kind = told.pusher.and_then(Kind::partner_kind);
        let observed = before.map_or("touched by nobody before".to_owned(), |track| {
            format!("touched by another before: {}", track.kind.label().to_lowercase())
        });
        let result = match before {
            Some(track) if kind.is_none_or(|kind| kind == track.kind) => match touch.track {
                Some(met) if !thrown::comes_as_told(told, ego_track, [met, track], (touch.time_s * 10.0) as usize) => {
                    CheckResult::CannotBeShown
                }
                _ => CheckResult::Shown,
            },
            // Who pushed a thing is not drawn.
            None if told.is_sliding() => CheckResult::CannotBeShown,
            _ => CheckResult::NotShown,
        };
        let whose = kind.map_or(String::new(), |kind| format!(": {}", kind.label().to_lowercase()));
        let expected = format!("another touched the partner first{whose}");
        list.push(Check { kind: CheckKind::PassedOn, expected, observed, result });
    }
    let mut ways = vec![(CheckKind::SvMovement, &told.sv, ego_track, touch.track, touch.other)];
    ways.extend(touch.track.map(|track| (CheckKind::CpMovement, &told.cp, track, Some(ego_track), touch.ego)));
    for (kind, side, track, other, met) in ways {
        let road_rad = ego_track.states[0].heading;
        let keeps_lane = kind == CheckKind::CpMovement && told.keeps_its_lane();
        let way = Way { scenario, track, other, met, time_s: touch.time_s, keeps_lane, road_rad };
        let slides =
            kind == CheckKind::CpMovement && keeping::slides(track.kind, until_touched(rollout, track, touch.time_s));
        let check = movement::check(side, &way);
        let check = if slides { Some(as_nobody_drives(check)) } else { check };
        if let Some((expected, result, observed)) = check {
            list.push(Check { kind, expected, observed, result });
        }
    }
    acts_of_both(told, scenario, [Some(ego_track), touch.track], touch.time_s, &mut list);
    let mut fact = |kind: CheckKind, shown: bool, expected: String, observed: String| {
        let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
        list.push(Check { kind, expected, observed, result });
    };
    if let Some((expected, shown, observed)) = things::check(told, &ego_box, &touch.other_box) {
        fact(CheckKind::Approach, shown, expected, observed);
    } else if let Some(side) = told.edge {
        let (shown, observed) = roadside::check(told, side, scenario, &touch.ego, &touch.other_box);
        fact(CheckKind::Approach, shown, roadside::words(side), observed);
    } else if let Some(track) = touch.track.filter(|_| told.origin_told) {
        let (shown, observed) = origin(told, ego_track, track, touch.time_s);
        fact(CheckKind::Approach, shown, origin_words(told), observed);
    }
    if let (Some(first), Some(track)) = (told.order, touch.track) {
        // Who stands there holds what a door of its reaches; a door of the partner's comes there when it opens.
        let ego_reach_m = if ego_part.is_some() { door::DOOR_M } else { NEAR_M };
        let number = rollout.actors.iter().position(|other| other.id == track.id);
        let door = rollout.actors.iter().find(|other| other.part_of.is_some() && other.part_of == number);
        let (partner, partner_reach_m) = match door.filter(|_| other_part.is_some()) {
            Some(door) => (door, MET_M),
            None => (track, NEAR_M),
        };
        let (shown, observed) =
            order(first, [(ego_track, ego_reach_m), (partner, partner_reach_m)], geometry.point, touch.time_s);
        fact(CheckKind::Order, shown, first.words().to_owned(), observed);
    }
    let mut held = |kind: CheckKind, expected: String, (result, observed): (CheckResult, String)| {
        list.push(Check { kind, expected, observed, result });
    };
    for (kind, side, track) in
        [(CheckKind::SvLane, &told.sv, Some(ego_track)), (CheckKind::CpLane, &told.cp, touch.track)]
    {
        if let (Some(word), Some(track)) = (side.lane, track) {
            let counted = told.counted(kind == CheckKind::SvLane);
            let expected = counted.map_or(lane_words(word).to_owned(), Counted::words);
            held(kind, expected, lane((told, word), scenario, [ego_track, track], touch.time_s));
        }
    }
    for (kind, side, track) in
        [(CheckKind::SvControl, &told.sv, Some(ego_track)), (CheckKind::CpControl, &told.cp, touch.track)]
    {
        if let (Some(said), Some(track)) = (side.control, track) {
            let arm = control::own_arm(told, scenario).filter(|_| kind == CheckKind::CpControl);
            held(kind, control::words(said), control::check(said, arm, scenario, track, touch.time_s));
        }
    }
    if told.sv.state.stands() && !told.reasons.is_empty() {
        let said: Vec<&str> = told.reasons.iter().map(|reason| reason.label()).collect();
        held(CheckKind::Reason, said.join(", "), reason(told, scenario, rollout, touch.time_s));
    }
    if told.others > 0 {
        let (all, expected, observed) = Seen::new(told, rollout, touch.time_s).others();
        let result = if all { CheckResult::Shown } else { CheckResult::CannotBeShown };
        held(CheckKind::Others, expected, (result, observed));
    }
    for (kind, side) in [(CheckKind::SvZones, &told.sv), (CheckKind::CpZones, &told.cp)] {
        if side.only_above_or_below {
            let since = (touch.time_s / STEP_S) as usize;
            let seen = match told.is_driven_over()
                && things::goes_under(told, ego_track, touch.track, &touch.other_box, since)
            {
                true => (CheckResult::Shown, "the ego drives over it".to_owned()),
                false => (CheckResult::CannotBeShown, "the simulator has no height".to_owned()),
            };
            held(kind, "top or bottom".to_owned(), seen);
        }
    }
    if let Some(owner) = told.door {
        let by_door = if owner == Striker::Sv { ego_part.is_some() } else { other_part.is_some() };
        let observed = match (ego_part.is_some(), other_part.is_some()) {
            (false, false) => "bodies touched",
            (true, _) => "the ego's door",
            (_, true) => "the partner's door",
        };
        let result = if by_door { CheckResult::Shown } else { CheckResult::NotShown };
        let whose = if owner == Striker::Sv { "the ego's door" } else { "the partner's door" };
        held(CheckKind::Door, whose.to_owned(), (result, observed.to_owned()));
    }
    list
}

/// What each of the two is told to have done.
fn acts_of_both(
    told: &Told,
    scenario: &Scenario,
    [ego, partner]: [Option<&ActorTrack>; 2],
    time_s: f64,
    list: &mut Vec<Check>,
) {
    let enters = told.sv.enters() || told.cp.enters();
    let junction = enters.then(|| Junction::of(scenario)).flatten();
    // Where no junction is drawn nobody has entered one.
    let entered = |track| junction.as_ref().and_then(|inner| inner.entered(track));
    let did = |told, track: Option<_>| track.map(|track| acts::Did { told, track, entered: entered(track) });
    let [sv, cp] = [did(told.sv.acts.as_slice(), ego), did(told.cp.acts.as_slice(), partner)];
    for (kind, one, other) in [(CheckKind::SvActs, &sv, &cp), (CheckKind::CpActs, &cp, &sv)] {
        if let Some(one) = one.as_ref().filter(|one| !one.told.is_empty()) {
            let (result, observed) = acts::check(one, other.as_ref(), time_s);
            list.push(Check { kind, expected: acts::words(one.told), observed, result });
        }
    }
}

fn lane_words(word: LaneWord) -> &'static str {
    match word {
        LaneWord::Left => "the left lane",
        LaneWord::Center => "a lane in the middle",
        LaneWord::Right => "the right lane",
        LaneWord::LeftTurn => "a lane for left turns",
        LaneWord::RightTurn => "a lane for right turns",
        LaneWord::Bike => "the bicycle lane",
        LaneWord::Bus => "the bus lane",
        LaneWord::Shoulder => "the shoulder",
        LaneWord::Curb => "at the kerb",
        LaneWord::Opposing => "the opposite side",
    }
}

/// Whether somebody begins in the told lane of its road; on the opposite side it is when they touch. Where both are told to be in a lane
/// for the same turn, side by side, there are two.
fn lane(
    (told, word): (&Told, LaneWord),
    scenario: &Scenario,
    [ego, track]: [&ActorTrack; 2],
    time_s: f64,
) -> (CheckResult, String) {
    let network = scenario.network();
    let turn_lanes = if told.turns_abreast() { 2 } else { 1 };
    // Who is told to be on the opposite side went there, or comes from there into its own.
    let at = if word == LaneWord::Opposing && !told.leaves_opposite() {
        ((time_s * 10.0) as usize).min(track.states.len() - 1)
    } else {
        0
    };
    let first = &track.states[at];
    let Some(id) = network.lane_at(first.position(), first.heading) else {
        return (CheckResult::CannotBeShown, "on no lane".to_owned());
    };
    let road = network.road(network.lane(id).road);
    if let Some(strip) = strips::strip_of(word) {
        return match strips::is_on(network, road.part, strip) {
            None => (CheckResult::CannotBeShown, "no such lane is drawn".to_owned()),
            Some(true) => (CheckResult::Shown, lane_words(word).to_owned()),
            Some(false) => (CheckResult::NotShown, "in another lane".to_owned()),
        };
    }
    let lanes = &road.lanes;
    let number = lanes.iter().position(|lane| *lane == id).unwrap_or(0);
    let way = network.lane(id);
    let (s_m, t_m) = way.local(first.position());
    let against = math::wrap_angle(way.heading(s_m) - first.heading).abs() > math::FRAC_PI_2;
    // Who is narrow may be anywhere in it.
    let drives = track.kind != PartnerKind::FixedObject;
    let most_m = if drives { KEEPS_M.max(0.5 * (way.width_at(s_m) - track.width_m)) } else { way.width_at(s_m) };
    if word != LaneWord::Opposing && (against || t_m.abs() > most_m) {
        let how = if against { "against its direction" } else { "beside its middle" };
        return (CheckResult::NotShown, format!("lane {} of {}, {how}", number + 1, lanes.len()));
    }
    let last = lanes.len() - 1;
    let shown = match word {
        // Beside the driving lanes.
        _ if matches!(road.part, RoadPart::Beside(_)) => false,
        LaneWord::Left if ego.id == track.id && told.layout.turn_lane => number == 1,
        LaneWord::Left => number == 0,
        LaneWord::Right => number == last,
        LaneWord::LeftTurn => number < turn_lanes,
        LaneWord::RightTurn => number + turn_lanes > last,
        LaneWord::Center if let Some(counted) = told.counted(ego.id == track.id) => {
            counted.place(lanes.len()) == Some(number)
        }
        LaneWord::Center => number > 0 && number < last,
        LaneWord::Opposing => {
            // Of who came over from its own side: the ego's.
            let own = if told.comes_over && ego.id != track.id { first.heading } else { ego.states[0].heading };
            let heading = network.lane(id).heading(0.0) - own;
            math::wrap_angle(heading).abs() > math::FRAC_PI_2
        }
        LaneWord::Bike | LaneWord::Bus | LaneWord::Shoulder | LaneWord::Curb => {
            return (CheckResult::CannotBeShown, "no such lane is drawn".to_owned());
        }
    };
    let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
    (result, format!("lane {} of {}, from the left", number + 1, lanes.len()))
}

/// Whether the scene holds what the ego stood for.
fn reason(told: &Told, scenario: &Scenario, rollout: &Rollout, time_s: f64) -> (CheckResult, String) {
    let ego = rollout.ego_track();
    let controlled = |device: ControlDevice| {
        let said = Said { device, state: None, obeyed: Some(Obeyed::Yes) };
        control::check(said, None, scenario, ego, time_s).0 == CheckResult::Shown
    };
    let holds = |reason: &StandReason| match reason {
        StandReason::RedLight => controlled(ControlDevice::Signal),
        StandReason::StopSign => controlled(ControlDevice::StopSign),
        StandReason::PickupDropoff => stands_at_stop(scenario, ego, time_s),
        other => Seen::new(told, rollout, time_s).reason(*other),
    };
    match told.reasons.iter().all(holds) {
        true => (CheckResult::Shown, "in the scene".to_owned()),
        false => (CheckResult::CannotBeShown, "not in the scene".to_owned()),
    }
}

/// Whether the ego stands where its task has it stop.
fn stands_at_stop(scenario: &Scenario, ego: &ActorTrack, time_s: f64) -> bool {
    let met = &ego.states[((time_s / STEP_S) as usize).min(ego.states.len() - 1)];
    let at = scenario.ego().path.project(met.position(), 0);
    let near = |stop: &MissionStop| math::hypot(at.s - stop.s_m, at.t - stop.t_m) < AT_STOP_M;
    met.velocity().length() < STANDS_MPS && scenario.draft().ego.stops.iter().any(near)
}

fn zone_words(zones: &[ContactZone]) -> String {
    zones.iter().map(|zone| zone.label()).collect::<Vec<_>>().join(" or ")
}

/// Whether who is told to have been first was at the place of the contact first, and by how much.
fn order(first: FirstMover, [ego, other]: [(&ActorTrack, f64); 2], point: Vec2, time_s: f64) -> (bool, String) {
    let there_s = |(track, reach_m): (&ActorTrack, f64)| {
        let until = ((time_s * 10.0).ceil() as usize + 1).min(track.states.len());
        let covers = |step: &usize| {
            let outline = track.outline(*step);
            let local = outline.to_local(point);
            local.x.abs() <= outline.half_length + reach_m && local.y.abs() <= outline.half_width + reach_m
        };
        // Who passed the place before, and came back to it, is there when it is back.
        let last = (0..until).rfind(&covers);
        let since = last.map(|last| (0..last).rfind(|step| !covers(step)).map_or(0, |step| step + 1));
        since.map_or(time_s, |step| 0.1 * step as f64)
    };
    let (ego_s, other_s) = (there_s(ego), there_s(other));
    let earlier_s = other_s - ego_s;
    let shown = match first {
        FirstMover::Sv => earlier_s > 0.1,
        FirstMover::Cp => earlier_s < -0.1,
        FirstMover::Both => earlier_s.abs() <= TOGETHER_S,
    };
    let observed = match (ego_s < other_s, earlier_s.abs()) {
        (_, 0.0) => "both at once".to_owned(),
        (true, by_s) => format!("the ego, by {by_s:.1} s"),
        (false, by_s) => format!("the partner, by {by_s:.1} s"),
    };
    (shown, observed)
}

/// A part is met where it is no farther from the other than this at the contact: tracks tell where it is every 0.1 s. [m]
const MET_M: f64 = 0.06;

/// The part of the ego's, or of the other's, that touched, where bodies did not.
fn parts_that_touch(
    rollout: &Rollout,
    touch: &Touch<'_>,
    ego_box: &OrientedBox,
) -> (Option<OrientedBox>, Option<OrientedBox>) {
    if ego_box.overlaps(&touch.other_box) {
        return (None, None);
    }
    let number = touch.track.and_then(|track| rollout.actors.iter().position(|other| other.id == track.id));
    let met = |owner: Option<usize>, other: &OrientedBox| {
        let of_owner = rollout.actors.iter().filter(|track| owner.is_some() && track.part_of == owner);
        let body = if owner == Some(0) { ego_box } else { &touch.other_box };
        let boxes = of_owner.map(|track| outline_at(track, touch.time_s)).filter(|part| door::is_open(body, part));
        boxes
            .map(|part| (part.nearest_points(other).2, part))
            .filter(|(gap, _)| *gap < MET_M)
            .map(|(_, part)| part)
            .next()
    };
    match met(Some(0), &touch.other_box) {
        Some(part) => (Some(part), None),
        None => (None, met(number, ego_box)),
    }
}

/// A part that has turned by less than this in the last 0.3 s does not swing. [rad]
const SWINGS_RAD: f64 = 0.05;

/// Whether the part of somebody that touches was swinging then.
fn swung(rollout: &Rollout, owner: &ActorTrack, part: &OrientedBox, time_s: f64) -> bool {
    let number = rollout.actors.iter().position(|other| other.id == owner.id);
    let parts = rollout.actors.iter().filter(|track| track.part_of == number);
    let before = parts.map(|track| outline_at(track, (time_s - 0.3).max(0.0)));
    before.map(|before| math::acos(before.axis.dot(part.axis).clamp(-1.0, 1.0))).any(|turned| turned > SWINGS_RAD)
}

/// A box between two steps.
fn outline_at(track: &ActorTrack, time_s: f64) -> OrientedBox {
    let at = (time_s / STEP_S).min((track.states.len() - 1) as f64);
    let (step, share) = (at.floor() as usize, at - at.floor());
    let (from, to) = (&track.states[step], &track.states[(step + 1).min(track.states.len() - 1)]);
    let position = from.position() + (to.position() - from.position()) * share;
    let heading = from.heading + math::wrap_angle(to.heading - from.heading) * share;
    OrientedBox::new(Pose { position, heading }, track.length_m, track.width_m)
}

/// Whom else the partner touched before.
fn toucher<'a>(rollout: &'a Rollout, touch: &Touch<'_>) -> Option<&'a ActorTrack> {
    let number = rollout.actors.iter().position(|track| track.id == "cp")?;
    rollout.events.iter().take_while(|event| event.time_s < touch.time_s).find_map(|event| match event.kind {
        EventKind::Contact { a, b, .. } if a != 0 && (a == number || b == number) => {
            rollout.actors.get(if a == number { b } else { a })
        }
        _ => None,
    })
}

/// Whether one of the others who are drawn is elsewhere than it is wanted, or goes on at red.
pub(crate) fn others_stray(told: &Told, scenario: &Scenario, rollout: &Rollout) -> bool {
    let time_s = first_touch(rollout).map_or(told.contact_s, |touch| touch.time_s);
    !told.extras.is_empty() && Seen::new(told, rollout, time_s).strays(scenario)
}

fn first_touch(rollout: &Rollout) -> Option<Touch<'_>> {
    rollout.events.iter().find_map(|event| match &event.kind {
        EventKind::Contact { a: 0, b, a_state, b_state } => {
            let track = rollout.actors.get(*b)?;
            Some(Touch {
                time_s: event.time_s,
                ego: *a_state,
                other: *b_state,
                kind: track.kind,
                other_box: OrientedBox::new(b_state.pose(), track.length_m, track.width_m),
                track: Some(track),
            })
        }
        EventKind::ObstacleContact { actor: 0, obstacle, state } => {
            let placed = rollout.obstacles.get(*obstacle)?;
            Some(Touch {
                time_s: event.time_s,
                ego: *state,
                other: ActorState::moving(placed.pose, 0.0),
                kind: PartnerKind::FixedObject,
                other_box: placed.outline(),
                track: None,
            })
        }
        _ => None,
    })
}

/// Who turns back by more than this on its way swings. [deg]
const MOST_BACK_DEG: f64 = 30.0;

/// Who meets the other earlier or later than this has touched it elsewhere than was staged. [s]
const AS_STAGED_S: f64 = 0.15;

/// Who slowed has lost at least this, who gained speed has gained it, or a quarter. [m/s]
const CHANGED_MPS: f64 = 1.0;

/// Whether somebody slowed before a time, since it last stood, and whether it gained speed.
fn changed(track: &ActorTrack, time_s: f64) -> (bool, bool) {
    let until = ((time_s * 10.0).floor() as usize).min(track.states.len() - 1);
    let now_mps = track.states[until].velocity().length();
    let stood = track.states[..until].iter().rposition(|state| state.velocity().length() < STANDS_MPS).unwrap_or(0);
    let any =
        |was: &dyn Fn(f64) -> bool| track.states[stood..=until].iter().any(|state| was(state.velocity().length()));
    (any(&|mps| mps > now_mps + CHANGED_MPS), any(&|mps| mps < now_mps - CHANGED_MPS.min(0.25 * now_mps)))
}

/// Whether a partner that drives along or across the road is beside it on its way to the contact, or swings one way and back the other, or
/// touches the ego before or after it was to.
/// Nobody tells that it did not.
pub(crate) fn strays(told: &Told, scenario: &Scenario, rollout: &Rollout) -> bool {
    let drives = !matches!(told.cp.kind, PartnerKind::Pedestrian | PartnerKind::Animal | PartnerKind::FixedObject);
    let on_road = matches!(
        told.origin,
        Origin::Behind | Origin::Ahead | Origin::Beside { .. } | Origin::Opposite | Origin::Cross { .. }
    );
    let Some(touch) = first_touch(rollout).filter(|_| drives && on_road || told.edge.is_some()) else { return false };
    if (touch.time_s - told.contact_s).abs() > AS_STAGED_S {
        return true;
    }
    let Some(track) = touch.track else { return false };
    let until = ((touch.time_s * 10.0) as usize).min(track.states.len() - 1);
    if told.comes_along_kerb() && kerb::comes_from_strip(scenario, track, until) {
        return true;
    }
    // Every second.
    let beside = track.states[..=until].iter().step_by(10).any(|state| !scenario.network().on_road(state.position()));
    let oncoming = |state: &ActorState| movement::is_against(scenario, state) == Some(true);
    if told.keeps_direction() && track.states[..=until].iter().step_by(10).filter(|state| oncoming(state)).count() > 1 {
        return true;
    }
    let off_road = |id: &str| {
        let other = rollout.actors.iter().find(|track| track.id == id)?;
        let until = until_touched(rollout, other, touch.time_s);
        Some(until.iter().step_by(10).any(|state| !scenario.network().on_road(state.position())))
    };
    if keeping::is_tight(told.cp.kind, until_touched(rollout, track, touch.time_s)) || off_road("pusher") == Some(true)
    {
        return true;
    }
    let turns = track.states[..=until].windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading));
    let (all, net) = turns.fold((0.0, 0.0), |(all, net), turn| (all + turn.abs(), net + turn));
    beside || (all - net.abs()).to_degrees() > MOST_BACK_DEG
}

/// What is said of a movement that nobody drives, whatever is told of it.
fn as_nobody_drives(check: Option<(String, CheckResult, String)>) -> (String, CheckResult, String) {
    let (expected, seen) = check.map_or_else(Default::default, |(expected, _, seen)| (expected, seen + ", "));
    let expected = if expected.is_empty() { "as somebody drives".to_owned() } else { expected };
    (expected, CheckResult::NotShown, seen + "as nobody drives")
}

/// Where somebody was until the contact, or until another touched it.
fn until_touched<'a>(rollout: &Rollout, track: &'a ActorTrack, contact_s: f64) -> &'a [ActorState] {
    let number = rollout.actors.iter().position(|other| other.id == track.id);
    let touched = rollout.events.iter().find(|event| match event.kind {
        EventKind::Contact { a, b, .. } => number == Some(a) || number == Some(b),
        _ => false,
    });
    let until_s = touched.map_or(contact_s, |event| event.time_s.min(contact_s));
    &track.states[..=((until_s / STEP_S) as usize).min(track.states.len() - 1)]
}

/// For how long the partner is off its lane.
pub(crate) fn off_lane_s(told: &Told, scenario: &Scenario, rollout: &Rollout) -> Option<f64> {
    let touch = first_touch(rollout)?;
    keeping::off_lane_s(told, scenario, touch.track.filter(|track| track.id == "cp")?, touch.time_s)
}

/// How far the partner's way is from what nobody tells otherwise: half seconds off its lane, weaving, and leaving whom it rubs along.
pub(crate) fn off_its_way(told: &Told, scenario: &Scenario, rollout: &Rollout) -> usize {
    let off_s = off_lane_s(told, scenario, rollout).unwrap_or(0.0);
    let touch =
        first_touch(rollout).and_then(|touch| Some((touch.track.filter(|track| track.id == "cp")?, touch.time_s)));
    let ego = rollout.ego_track();
    let weaves = |(track, time_s)| {
        keeping::weaves(told, track, time_s)
            + usize::from(keeping::leaves_whom_it_passes(told, ego, track, time_s))
            + if told.is_beside_line(ego, track) || told.is_far_beside(ego, track) { keeping::ABSURD } else { 0 }
    };
    (2.0 * off_s) as usize + touch.map_or(0, weaves)
}

/// Whether somebody stood before a time.
fn stood(track: &ActorTrack, time_s: f64) -> bool {
    let until = ((time_s * 10.0).floor() as usize).min(track.states.len() - 1);
    track.states[..=until].iter().any(|state| state.velocity().length() < STANDS_MPS)
}

/// Whether somebody is in a state when it touches, and was before as the state says.
fn state(told: ContactState, track: &ActorTrack, now: &ActorState, time_s: f64) -> bool {
    let step = (time_s * 10.0).floor() as usize;
    let back = |seconds: f64| track.states[step.saturating_sub((seconds * 10.0) as usize).min(track.states.len() - 1)];
    let speed = now.velocity().length();
    match told {
        ContactState::Moving => now.speed() > STANDS_MPS,
        ContactState::Reversing => now.speed() < -STANDS_MPS,
        ContactState::SettingOff => {
            now.speed() > STANDS_MPS
                && (1..=60).any(|tenth| back(0.1 * f64::from(tenth)).velocity().length() < STANDS_MPS)
        }
        ContactState::Stopped => speed < STANDS_MPS && back(1.0).velocity().length() < STANDS_MPS,
        ContactState::Parked => {
            track.states[..=step.min(track.states.len() - 1)].iter().all(|state| state.velocity().length() < STANDS_MPS)
        }
    }
}

/// Who is less aside than this is beside nobody. [m]
const ASIDE_M: f64 = 1.0;

/// Who is farther aside than this does not come along the ego's lane. [m]
const BESIDE_M: f64 = 5.0;

/// Who comes along the opposite side behind the ego is not farther aside than this. [m]
const OPPOSITE_M: f64 = 8.5;

/// Who comes over from its own side, or from the kerb, is farther aside than this when it sets out. [m]
const OVER_M: f64 = 2.0;

/// Who turned off before it reversed is so much farther aside. [m]
const TURNED_OFF_M: f64 = 3.0;

fn origin_words(told: &Told) -> String {
    let more = match (told.comes_over, told.comes_round, told.comes_across()) {
        (true, ..) => ", on its own side",
        (_, true, _) => ", behind",
        (_, _, true) => ", across",
        _ => "",
    };
    told.origin.words() + more
}

/// Whether the partner comes from where it is told, seen from the ego when it sets out.
fn origin(told: &Told, ego: &ActorTrack, other: &ActorTrack, time_s: f64) -> (bool, String) {
    let (ego_track, other_track) = (ego, other);
    let state = told.cp.state;
    let on_foot = is_on_foot(other.kind);
    // Seen when it sets out.
    let sets_out = other.states.iter().position(|state| state.velocity().length() > STANDS_MPS).unwrap_or(0);
    let stands_then = sets_out > 0;
    // Of who backs into a space, or had turned off: when it begins to back.
    let backs = other.states.iter().position(|state| state.speed() < -STANDS_MPS);
    let turned_off = matches!(told.cp.slants, Some(Slant::Stood { .. }));
    let sets_out = backs.filter(|_| told.cp.backs_in || turned_off).unwrap_or(sets_out);
    let beside_m = BESIDE_M + if turned_off { TURNED_OFF_M } else { 0.0 };
    let met = &ego.states[((time_s * 10.0) as usize).min(ego.states.len() - 1)];
    let (ego, other) = (&ego.states[sets_out.min(ego.states.len() - 1)], &other.states[sets_out]);
    // Who comes out of a driveway is behind the place where an ego stands then.
    let stands = told.sv.state.stands() && matches!(told.origin, Origin::Driveway { .. });
    let behind_met = (other.position() - met.position()).dot(Vec2::from_heading(met.heading)) < 0.0;
    let forward = Vec2::from_heading(ego.heading);
    let way = other.position() - ego.position();
    let (ahead, left) = (way.dot(forward), forward.cross(way));
    let facing = math::wrap_angle(other.heading - ego.heading).to_degrees();
    // Who reverses moves against where it faces.
    let moves = if state == ContactState::Reversing {
        math::wrap_angle((facing + 180.0).to_radians()).to_degrees()
    } else {
        facing
    };
    let on = |side: LeftRight, angle: f64| if side == LeftRight::Left { angle < 0.0 } else { angle > 0.0 };
    let beside = |side: LeftRight| if side == LeftRight::Left { left > ASIDE_M } else { left < -ASIDE_M };
    let same_way = match told.comes_across() {
        true => (30.0..150.0).contains(&facing.abs()),
        false => facing.abs() < 60.0 || state == ContactState::Reversing,
    };
    let shown = match told.origin {
        Origin::Behind => {
            let lane_m = if told.leaves_opposite() { OPPOSITE_M } else { BESIDE_M };
            let in_line = !(told.begins_in_line() && told.is_beside_line(ego_track, other_track));
            ahead < 2.0 && same_way && left.abs() < lane_m && in_line
        }
        Origin::Ahead => {
            let faces = same_way || on_foot && !told.comes_across() || state.stands();
            ahead > -2.0 && faces && left.abs() < beside_m
        }
        Origin::Opposite => facing.abs() > 120.0 && (!told.comes_over || left > OVER_M),
        Origin::Beside { side } => (facing.abs() < 60.0 || told.comes_across()) && same_way && beside(side),
        Origin::Cross { side } => (30.0..150.0).contains(&moves.abs()) && on(side, moves),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Parked { side } | Origin::Sidewalk { side } => {
            let crosswise = (30.0..150.0).contains(&facing.abs());
            let out = crosswise || !matches!(told.origin, Origin::Stall { .. } | Origin::Driveway { .. });
            let from_there = !(told.stood_beside() || told.backs_out())
                || stands_then
                    && left.abs() > OVER_M
                    && out
                    && (!told.comes_round || ahead < 0.0 || stands && behind_met);
            side.is_none_or(beside) && from_there || state.stands()
        }
        Origin::Above => false,
    };
    let along = if ahead < 0.0 { "behind" } else { "ahead" };
    let aside = if left < 0.0 { "to the right" } else { "to the left" };
    let seen = format!("{:.0} m {along}, {:.0} m {aside}, facing {facing:.0} degrees", ahead.abs(), left.abs());
    (shown, seen)
}
