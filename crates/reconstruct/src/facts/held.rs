//! Told facts, held against a rollout: who was where when. Of the scenario only its roads, signals and stops are read.

use crate::facts::acts::{self, Did};
use crate::facts::contact::{
    self, MET_M, Touch, crash, first_touch, is_near, order, parts_that_touch, swung, toucher, zone_words,
};
use crate::facts::junction::Junction;
use crate::facts::lane::{lane, lane_words};
use crate::facts::movement::{self, Way};
use crate::facts::origin::{origin, origin_words};
use crate::facts::seen::Seen;
use crate::facts::state::{changed, stands_at_stop, state, stood};
use crate::facts::strays::until_touched;
use crate::facts::{edge, keeping, phases, signals, things, thrown};
use crate::told::crash::Told;
use crate::told::layout::Counted;
use crate::told::phase;
use crate::told::rig::Rig;
use crate::touch::opening::{self, DOOR_M};
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::{Control as Said, ControlDevice, Kind, Obeyed, Origin, StandReason, Striker};
use recrash_model::geometry::OrientedBox;
use recrash_model::metrics::{Check, CheckKind, CheckResult};
use recrash_model::rollout::{ActorTrack, Rollout, STEP_S};
use recrash_roads::Scenario;

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
    let crash = crash(told, rollout);
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
        geometry.ego_zone = opening::zone_of(&ego_box, part);
    }
    let trailer = told.trailer_of.and_then(Rig::of).filter(|_| contact::is_drawn(rollout));
    if let Some(part) = &other_part {
        geometry.other_zone = match trailer {
            Some(rig) => rig.zone(part, &geometry),
            None => opening::zone_of(&touch.other_box, part),
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
            None => told.trailer_of.is_none() || contact::is_on_trailer(told, &touch.other_box, geometry.point),
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
        let (as_told, phases) = phases::check(phase::checked(&side.phases), track, touch.time_s);
        let stands_so = told.stands_so(kind == CheckKind::SvState, scenario, seen);
        let backs_first = told.backs_first.filter(|_| kind == CheckKind::CpState && !told.sv.phases.is_empty());
        let in_order = backs_first.is_none_or(|first| phases::back_in_order(first, ego_track, track, touch.time_s));
        let rolls_out = kind == CheckKind::CpState && told.rolls_out();
        let shown = pushed
            || !(rolls_out && stood)
                && state(side.state, track, seen, touch.time_s)
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
        if rolls_out {
            expected += ", without a stop";
        }
        if side.phases.is_empty() {
            expected += before(side.stood_first, side.slowed_from.is_some(), side.gains);
            observed += before(stood, slowed, gained);
        } else {
            expected += &format!(": {}", phase::words(phase::checked(&side.phases)));
            observed += &format!(": {phases}");
        }
        fact(kind, shown, expected, observed);
    }
    for (kind, side, seen) in [(CheckKind::SvSpeed, &told.sv, &touch.ego), (CheckKind::CpSpeed, &told.cp, &touch.other)]
    {
        if let Some(told_mps) = side.impact_mps {
            let speed_mps = seen.velocity().length();
            let close = (speed_mps - told_mps).abs() <= 2.0_f64.max(0.25 * told_mps);
            let [of, at] = if side.came_so { ["as it came", " at the contact"] } else { ["at the contact", ""] };
            fact(kind, close, format!("{told_mps:.1} m/s {of}"), format!("{speed_mps:.1} m/s{at}"));
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
        let parks_at_kerb = kind == CheckKind::CpMovement && told.parks_behind();
        let crosses = kind == CheckKind::CpMovement && matches!(told.origin, Origin::Cross { .. });
        let way =
            Way { scenario, track, other, met, time_s: touch.time_s, keeps_lane, road_rad, parks_at_kerb, crosses };
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
        let (shown, observed) = edge::check(told, side, scenario, &touch.ego, &touch.other_box);
        fact(CheckKind::Approach, shown, edge::words(side), observed);
    } else if let Some(track) = touch.track.filter(|_| told.origin_told) {
        let (shown, observed) = origin(told, ego_track, track, touch.time_s);
        fact(CheckKind::Approach, shown, origin_words(told), observed);
    }
    if let (Some(first), Some(track)) = (told.order, touch.track) {
        // Who stands there holds what a door of its reaches; a door of the partner's comes there when it opens, and an ego within its reach
        // was there before.
        let number = rollout.actors.iter().position(|other| other.id == track.id);
        let door = rollout.actors.iter().find(|other| other.part_of.is_some() && other.part_of == number);
        let door = door.filter(|_| other_part.is_some());
        let ego_reach_m = if ego_part.is_some() || door.is_some() { DOOR_M } else { MET_M };
        let partner = door.unwrap_or(track);
        let (shown, observed) =
            order(first, [(ego_track, ego_reach_m), (partner, MET_M)], geometry.point, touch.time_s);
        fact(CheckKind::Order, shown, first.words().to_owned(), observed);
    }
    let mut held = |kind: CheckKind, expected: String, (result, observed): (CheckResult, String)| {
        list.push(Check { kind, expected, observed, result });
    };
    for (kind, side, track) in
        [(CheckKind::SvLane, &told.sv, Some(ego_track)), (CheckKind::CpLane, &told.cp, touch.track)]
    {
        if let (Some(word), Some(track)) = (side.lane.filter(|_| !side.lane_to_come), track) {
            let counted = told.counted(kind == CheckKind::SvLane);
            let expected = counted.map_or(lane_words(word).to_owned(), Counted::words);
            held(kind, expected, lane((told, word), scenario, [ego_track, track], touch.time_s));
        }
    }
    for (kind, side, track) in
        [(CheckKind::SvControl, &told.sv, Some(ego_track)), (CheckKind::CpControl, &told.cp, touch.track)]
    {
        if let (Some(said), Some(track)) = (side.control, track) {
            let of_partner = kind == CheckKind::CpControl;
            let arm = signals::own_arm(told, scenario).filter(|_| of_partner);
            let seen = signals::check(said, arm, scenario, track, touch.time_s);
            let seen = if of_partner && signals::is_beside_road(told) { signals::beside_road(seen) } else { seen };
            held(kind, signals::words(said), seen);
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
    let did = |told, track: Option<_>| track.map(|track| Did { told, track, entered: entered(track) });
    let [sv, cp] = [did(told.sv.acts.as_slice(), ego), did(told.cp.acts.as_slice(), partner)];
    for (kind, one, other) in [(CheckKind::SvActs, &sv, &cp), (CheckKind::CpActs, &cp, &sv)] {
        if let Some(one) = one.as_ref().filter(|one| !one.told.is_empty()) {
            let (result, observed) = acts::check(one, other.as_ref(), time_s);
            list.push(Check { kind, expected: acts::words(one.told), observed, result });
        }
    }
}

/// Whether the scene holds what the ego stood for.
fn reason(told: &Told, scenario: &Scenario, rollout: &Rollout, time_s: f64) -> (CheckResult, String) {
    let ego = rollout.ego_track();
    let controlled = |device: ControlDevice| {
        let said = Said { device, state: None, obeyed: Some(Obeyed::Yes) };
        signals::check(said, None, scenario, ego, time_s).0 == CheckResult::Shown
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

/// What is said of a movement that nobody drives, whatever is told of it.
fn as_nobody_drives(check: Option<(String, CheckResult, String)>) -> (String, CheckResult, String) {
    let (expected, seen) = check.map_or_else(Default::default, |(expected, _, seen)| (expected, seen + ", "));
    let expected = if expected.is_empty() { "as somebody drives".to_owned() } else { expected };
    (expected, CheckResult::NotShown, seen + "as nobody drives")
}
