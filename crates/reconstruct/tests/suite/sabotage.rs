//! A reconstruction that was sabotaged is refused or not called true: on our own stories, and on real records where they are.

use crate::common::record;
use crate::roadside;
use crate::stories::shown;
use crate::things;
use crate::ways;
use recrash_model::account::{
    Account, ContactState, ControlDevice, Fact, Kind, KindGroup, Obeyed, Origin, SignalState, SpeedMeaning, Striker,
    told,
};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::Answer;
use recrash_model::narrative::FirstMover;
use recrash_model::profile::{Dedupe, SystemProfile};
use recrash_model::record::CrashRecord;
use recrash_model::rollout::EventKind;
use recrash_model::scenario::{
    Act, Actor, ActorPlan, Aspect, Deed, Device, Leg, ObjectSpec, ObstacleKind, PartKind, Place, ScenarioDraft,
};
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use recrash_reconstruct::{Reconstruction, held_against, reconstruct};
use recrash_records::{SourceText, ingest};
use recrash_sim::{Ego, simulate};
use sha2::{Digest, Sha256};

/// What is done to a scenario; whether it applies to this one.
type Sabotage = fn(&Account, &mut ScenarioDraft) -> bool;

/// Each with how many of our own stories it must at least be tried on.
const SABOTAGES: [(&str, usize, Sabotage); 23] = [
    ("a turning partner that goes straight", 2, turn_undone),
    ("a partner from the other direction", 20, other_direction),
    ("a partner mirrored to the other side", 3, other_side),
    ("a crossing partner that comes 2.5 s earlier", 2, order_reversed),
    ("a partner 40 m aside", 30, far_off),
    ("an ego at 1.8 times its speed", 1, too_fast),
    ("another kind of partner", 30, other_kind),
    ("things that are gone", 2, things_gone),
    ("a standing partner that rolls", 1, standing_partner_rolls),
    ("a reversing partner in forward gear", 3, forward_gear),
    ("signals and signs that are gone", 3, control_gone),
    ("a door that stays shut", 2, door_shut),
    ("a red light that is green", 2, green_for_red),
    ("a standing ego that rolls", 8, standing_ego_rolls),
    ("a partner that never stood", 1, never_stood),
    ("a partner that comes by itself", 1, nobody_throws),
    ("an oncoming partner that is on the ego's side from the start", 1, never_on_its_side),
    ("a partner that did not stand at the kerb, in a stall or in a driveway", 2, never_at_the_kerb),
    ("a thing that rolled in and lies there", 1, thing_lies),
    ("a gate that does not swing", 1, gate_stays),
    ("two others who crash of whom nothing is told", 30, others_crash),
    ("another who threw the partner", 1, other_pusher),
    ("an ego that moved up or back and stands from the start", 2, moved_nowhere),
];

/// Whether the sabotaged draft is refused, or at least one told fact is not shown.
fn is_caught(account: &Account, draft: ScenarioDraft) -> bool {
    let Ok(checked) = recrash_roads::check(draft) else { return true };
    let verdict =
        held_against(account, &checked.value, &simulate(&checked.value, Ego::Recorded)).expect("it was staged");
    verdict.faithful() == Answer::No
}

/// Of each sabotage: on how many it was tried, and which it got away with.
fn tried(made: &[(String, Account, Reconstruction)]) -> Vec<(&'static str, usize, usize, Vec<&str>)> {
    let of = |&(what, least, sabotage): &(&'static str, usize, Sabotage)| {
        let (mut count, mut passed) = (0, Vec::new());
        for (name, account, made) in made {
            let mut draft = made.draft.clone();
            if sabotage(account, &mut draft) {
                count += 1;
                if !is_caught(account, draft) {
                    passed.push(name.as_str());
                }
            }
        }
        (what, least, count, passed)
    };
    SABOTAGES.iter().map(of).collect()
}

#[test]
fn every_sabotage_of_our_own_stories_is_caught() {
    let mut made = shown();
    made.extend(ways::shown());
    made.extend(things::shown());
    made.extend(roadside::shown());
    // One whose column tells the speed at the impact.
    let text = "The AV was traveling straight when a car pulled out of a driveway on its right, and the front of the AV made \
                contact with the left side of the car.";
    let record = CrashRecord { sv_speed_mps: Some(9.0), ..record("1-1", 1, text) };
    let account = recrash_reader::account(&recrash_reader::incidents(&[record])[0]).expect("a story");
    let with_speed = reconstruct(&account).expect("it can be staged");
    assert!(with_speed.is_true(), "{:?}", with_speed.verdict);
    made.push(("impact speed".to_owned(), account, with_speed));
    for (what, least, count, passed) in tried(&made) {
        assert!(passed.is_empty(), "{what} passes in {passed:?}");
        assert!(count >= least, "{what}: tried on {count}");
    }
}

#[test]
fn sabotage_of_a_hundred_real_reconstructions_is_caught() {
    let Some(accounts) = shared_accounts() else { return };
    let made = accounts.filter_map(|account| {
        let made = reconstruct(&account).ok().filter(Reconstruction::is_true)?;
        Some((account.report.to_string(), account, made))
    });
    let made: Vec<_> = made.take(100).collect();
    assert_eq!(made.len(), 100);
    let (mut all, mut caught) = (0, 0);
    for (what, _, count, passed) in tried(&made) {
        println!("{what}: caught {} of {count}; not in {passed:?}", count - passed.len());
        all += count;
        caught += count - passed.len();
    }
    assert!(caught * 100 >= all * 98, "{caught} of {all}");
}

/// Accounts of the developed half of the real files, in an order that the report ids' hashes give.
fn shared_accounts() -> Option<impl Iterator<Item = Account>> {
    let folder = recrash_testing::shared("data/nhtsa")?;
    let names = ["ads-2021-06-to-2025-06.csv", "ads-2025-06-to-2026-01.csv"];
    let bytes = names.map(|name| std::fs::read(folder.join(name)).expect("a crash file"));
    let sources: Vec<_> = names.iter().zip(&bytes).map(|(name, bytes)| SourceText { name, bytes }).collect();
    let mut profile: SystemProfile =
        toml::from_str(include_str!("../../../../profiles/paper.toml")).expect("a profile");
    profile.records.dedupe = Dedupe::None;
    let mut incidents: Vec<_> =
        recrash_reader::incidents(&ingest(&sources, &profile).expect("crash files").value.records)
            .into_iter()
            .filter_map(|incident| {
                let hash = Sha256::digest(incident.spoken()?.record.id.report_id.as_bytes());
                (hash[31] % 2 == 0).then(|| (hash.to_vec(), incident))
            })
            .collect();
    incidents.sort_by(|one, other| one.0.cmp(&other.0));
    Some(incidents.into_iter().filter_map(|(_, incident)| recrash_reader::account(&incident)))
}

fn partner_state(account: &Account) -> Option<ContactState> {
    account.partner.as_ref().and_then(|partner| told(&partner.state))
}

fn is_thing(account: &Account) -> bool {
    let kind = account.partner.as_ref().and_then(|partner| told(&partner.kind));
    kind.is_some_and(|kind: Kind| kind.group() == KindGroup::Object)
}

/// Every place of a plan: where it begins, and where its curves lead.
fn places(plan: &mut ActorPlan) -> impl Iterator<Item = &mut Place> {
    let curves = plan.course.iter_mut().filter_map(|leg| match leg {
        Leg::Curve { to, .. } => Some(to),
        _ => None,
    });
    std::iter::once(&mut plan.start).chain(curves)
}

/// The partner's plan, the place where it begins and the one of the contact. [m, deg]
fn approach(draft: &mut ScenarioDraft) -> Option<(&mut ActorPlan, [f64; 3], [f64; 3])> {
    let plan = &mut draft.actors.iter_mut().find(|actor| actor.id == "cp")?.plan;
    let numbers = |place: &Place| match *place {
        Place::Plane { x_m, y_m, heading_deg } => Some([x_m, y_m, heading_deg]),
        Place::Lane { .. } => None,
    };
    let start = numbers(&plan.start)?;
    // The last leg leads on from the contact.
    let contact = match &plan.course[plan.course.len().checked_sub(2)?] {
        Leg::Curve { to, .. } => numbers(to)?,
        _ => return None,
    };
    Some((plan, start, contact))
}

fn turn_undone(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let movement = account.partner.as_ref().and_then(|partner| told(&partner.movement));
    let turned = matches!(movement, Some(Movement::LeftTurn | Movement::RightTurn));
    let reverses = partner_state(account) == Some(ContactState::Reversing);
    let Some((plan, start, contact)) = approach(draft).filter(|_| turned && !reverses) else { return false };
    let away_m = math::hypot(contact[0] - start[0], contact[1] - start[1]);
    let (sine, cosine) = (math::sin(contact[2].to_radians()), math::cos(contact[2].to_radians()));
    plan.start = Place::at(contact[0] - away_m * cosine, contact[1] - away_m * sine, contact[2]);
    let straight = plan.course.len() - 2;
    plan.course.drain(..straight);
    true
}

fn other_direction(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let stands = partner_state(account).is_some_and(ContactState::stands);
    let Some((plan, _, contact)) = approach(draft).filter(|_| !stands && account.came_from.is_some()) else {
        return false;
    };
    // Of who comes across ahead nobody says from which side.
    if told(&account.came_from) == Some(Origin::Ahead) && (50.0..130.0).contains(&contact[2].abs()) {
        return false;
    }
    for place in places(plan) {
        if let Place::Plane { x_m, y_m, heading_deg } = place {
            (*x_m, *y_m) = (2.0 * contact[0] - *x_m, 2.0 * contact[1] - *y_m);
            *heading_deg += 180.0;
        }
    }
    true
}

fn other_side(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let on = |zones: &[Fact<ContactZone>], sides: [ContactZone; 3]| {
        !zones.is_empty() && zones.iter().all(|zone| sides.contains(&zone.value))
    };
    let left = on(&account.sv.zones, [ContactZone::FrontLeft, ContactZone::Left, ContactZone::RearLeft]);
    let right = on(&account.sv.zones, [ContactZone::FrontRight, ContactZone::Right, ContactZone::RearRight]);
    if !left && !right || !draft.ego.route.iter().all(|road| road.starts_with("main")) {
        return false;
    }
    let Some(partner) = draft.actors.iter_mut().find(|actor| actor.id == "cp") else { return false };
    let mut mirrored = false;
    // About the ego's lane, which lies along the x axis.
    for place in places(&mut partner.plan) {
        if let Place::Plane { y_m, heading_deg, .. } = place {
            (*y_m, *heading_deg) = (-*y_m, -*heading_deg);
            mirrored = true;
        }
    }
    mirrored
}

fn order_reversed(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let ordered = matches!(told(&account.order), Some(FirstMover::Sv | FirstMover::Cp));
    let both_move = told(&account.sv.state) == Some(ContactState::Moving)
        && partner_state(account) == Some(ContactState::Moving)
        // In one lane who comes earlier comes as before, in the same order.
        && matches!(told(&account.came_from), Some(Origin::Cross { .. }));
    let Some((plan, start, contact)) = approach(draft).filter(|_| ordered && both_move) else { return false };
    let away_m = math::hypot(contact[0] - start[0], contact[1] - start[1]);
    let share = 2.5 * plan.speed_mps / away_m;
    if !(0.05..0.9).contains(&share) {
        return false;
    }
    plan.start =
        Place::at(start[0] + share * (contact[0] - start[0]), start[1] + share * (contact[1] - start[1]), start[2]);
    true
}

fn far_off(_: &Account, draft: &mut ScenarioDraft) -> bool {
    let Some(partner) = draft.actors.iter_mut().find(|actor| actor.id == "cp") else { return false };
    for place in places(&mut partner.plan) {
        if let Place::Plane { y_m, .. } = place {
            *y_m += 40.0;
        }
    }
    true
}

fn too_fast(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let fast =
        account.sv.speeds.iter().any(|speed| speed.value.meaning == SpeedMeaning::Impact && speed.value.mps > 2.6);
    let moving = told(&account.sv.state) == Some(ContactState::Moving);
    let Some(recorded) = draft.ego.recorded.as_mut().filter(|_| fast && moving) else { return false };
    recorded.speed_mps *= 1.8;
    for act in &mut recorded.acts {
        if let Deed::Speed { to_mps, rate_mps2 } = &mut act.deed {
            (*to_mps, *rate_mps2) = (1.8 * *to_mps, 1.8 * *rate_mps2);
        }
    }
    true
}

fn other_kind(_: &Account, draft: &mut ScenarioDraft) -> bool {
    let Some(partner) = draft.actors.iter_mut().find(|actor| actor.id == "cp") else { return false };
    partner.kind = match partner.kind {
        PartnerKind::Bus => PartnerKind::PassengerCar,
        _ => PartnerKind::Bus,
    };
    true
}

fn things_gone(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let there = is_thing(account) && (!draft.objects.is_empty() || !draft.actors.is_empty());
    draft.objects.clear();
    draft.actors.clear();
    there
}

fn standing_partner_rolls(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let stands = partner_state(account).is_some_and(ContactState::stands) && !is_thing(account);
    let pushed = draft.actors.iter().any(|actor| actor.id == "pusher");
    let Some(partner) = draft.actors.iter_mut().find(|actor| actor.id == "cp") else { return false };
    let Place::Plane { x_m, y_m, heading_deg } = partner.plan.start else { return false };
    if !stands || pushed || !partner.plan.course.is_empty() {
        return false;
    }
    let (sine, cosine) = (math::sin(heading_deg.to_radians()), math::cos(heading_deg.to_radians()));
    let at = |along_m: f64| Place::at(x_m + along_m * cosine, y_m + along_m * sine, heading_deg);
    // It rolls through where it stood, at the time of the contact.
    (partner.plan.start, partner.plan.speed_mps) = (at(-18.0), 2.0);
    partner.plan.course = vec![Leg::Curve { to: at(60.0), reverse: false }];
    true
}

fn forward_gear(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let reversed = partner_state(account) == Some(ContactState::Reversing);
    let Some(partner) = draft.actors.iter_mut().find(|actor| actor.id == "cp").filter(|_| reversed) else {
        return false;
    };
    for leg in &mut partner.plan.course {
        if let Leg::Curve { reverse, .. } = leg {
            *reverse = false;
        }
    }
    for place in places(&mut partner.plan) {
        if let Place::Plane { heading_deg, .. } = place {
            *heading_deg += 180.0;
        }
    }
    true
}

fn control_gone(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let there = !draft.control.is_empty() && !account.sv.controls.is_empty();
    draft.control.clear();
    there
}

fn door_shut(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let Some(owner) = told(&account.door) else { return false };
    let opens = |act: &Act| matches!(act.deed, Deed::Part { .. });
    let plan = match owner {
        Striker::Sv => draft.ego.recorded.as_mut(),
        _ => draft.actors.iter_mut().find(|actor| actor.id == "cp").map(|actor| &mut actor.plan),
    };
    let Some(plan) = plan.filter(|plan| plan.acts.iter().any(opens)) else { return false };
    plan.acts.retain(|act| !opens(act));
    true
}

fn green_for_red(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let red = account.sv.controls.last().is_some_and(|fact| {
        fact.value.device == ControlDevice::Signal
            && fact.value.state == Some(SignalState::Red)
            && fact.value.obeyed == Some(Obeyed::Yes)
    });
    for control in &mut draft.control {
        if let Device::Signal { program, .. } = &mut control.device {
            program.iter_mut().for_each(|phase| phase.show = Aspect::Green);
        }
    }
    red && !draft.control.is_empty()
}

fn standing_ego_rolls(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let stood = told(&account.sv.state) == Some(ContactState::Stopped);
    let Some(recorded) = draft.ego.recorded.as_mut().filter(|_| stood) else { return false };
    let Some(act) = recorded.acts.first_mut() else { return false };
    act.deed = Deed::Speed { to_mps: 1.5, rate_mps2: 2.0 };
    recorded.acts.truncate(1);
    true
}

fn never_stood(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let stood = partner_state(account) == Some(ContactState::SettingOff);
    let Some(partner) = draft.actors.iter_mut().find(|actor| actor.id == "cp").filter(|_| stood) else { return false };
    partner.plan.speed_mps = 4.0;
    partner.plan.acts.clear();
    true
}

fn nobody_throws(_: &Account, draft: &mut ScenarioDraft) -> bool {
    let all = draft.actors.len();
    draft.actors.retain(|actor| actor.id != "pusher");
    draft.actors.len() < all
}

fn others_crash(_: &Account, draft: &mut ScenarioDraft) -> bool {
    let Some(like) = draft.actors.first() else { return false };
    let other = |id: &str, x_m: f64, speed_mps: f64| {
        let mut plan = ActorPlan::standing(Place::at(x_m, 60.0, 0.0));
        plan.speed_mps = speed_mps;
        plan.course = vec![Leg::Curve { to: Place::at(x_m + 100.0, 60.0, 0.0), reverse: false }];
        Actor {
            id: id.to_owned(),
            kind: PartnerKind::PassengerCar,
            size: None,
            parts: Vec::new(),
            plan,
            ..like.clone()
        }
    };
    let (slow, fast) = (other("slow", 0.0, 1.0), other("fast", -20.0, 8.0));
    draft.actors.extend([slow, fast]);
    true
}

fn other_pusher(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let told =
        account.others.iter().find(|other| other.touched_partner).and_then(|other| other.kind.value.partner_kind());
    let pusher = draft.actors.iter_mut().find(|actor| actor.id == "pusher");
    let Some((told, pusher)) = told.zip(pusher) else { return false };
    pusher.kind = if told == PartnerKind::Bus { PartnerKind::Van } else { PartnerKind::Bus };
    true
}

fn moved_nowhere(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let stands = told(&account.sv.state) == Some(ContactState::Stopped);
    let sets_off = |act: &&Act| matches!(act.deed, Deed::Speed { .. });
    let moves = draft.ego.recorded.as_ref().is_some_and(|plan| plan.acts.iter().any(|act| sets_off(&act)));
    if !stands || !moves {
        return false;
    }
    let scenario = recrash_roads::check(draft.clone()).expect("it ran").value;
    let rollout = simulate(&scenario, Ego::Recorded);
    let touched = rollout.events.iter().find(|event| matches!(event.kind, EventKind::Contact { a: 0, .. }));
    let Some(touched) = touched else { return false };
    let at = rollout.actors[0].states[(touched.time_s * 10.0) as usize].pose();
    let place = Place::at(at.position.x, at.position.y, at.heading.to_degrees());
    draft.ego.recorded = Some(ActorPlan::standing(place));
    true
}

fn never_on_its_side(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let movement = account.partner.as_ref().and_then(|partner| told(&partner.movement));
    let crosses = matches!(movement, Some(Movement::CrossingIntoOpposingLane | Movement::LaneDeparture));
    let straight = draft.ego.route.iter().all(|road| road.starts_with("main"));
    if told(&account.came_from) != Some(Origin::Opposite) || !crosses || !straight {
        return false;
    }
    let Some((plan, _, [_, contact_m, _])) = approach(draft) else { return false };
    for place in places(plan) {
        if let Place::Plane { y_m, .. } = place {
            *y_m = contact_m;
        }
    }
    true
}

fn never_at_the_kerb(account: &Account, draft: &mut ScenarioDraft) -> bool {
    let origin = told(&account.came_from);
    let stood = matches!(origin, Some(Origin::Parked { .. } | Origin::Stall { .. } | Origin::Driveway { .. }));
    let kind = account.partner.as_ref().and_then(|partner| told(&partner.kind));
    let drives = stood && kind.is_some_and(Kind::is_vehicle) && partner_state(account) == Some(ContactState::Moving);
    let Some((plan, start, contact)) = approach(draft).filter(|_| drives) else { return false };
    // Who is told not to have stopped has not stood.
    if plan.speed_mps > 0.0 {
        return false;
    }
    // It comes along without a stop, and is there at the same time.
    let length_m = math::hypot(contact[0] - start[0], contact[1] - start[1]);
    plan.speed_mps = (length_m / 9.0).max(0.3);
    plan.acts.clear();
    true
}

fn thing_lies(account: &Account, draft: &mut ScenarioDraft) -> bool {
    // What appears from under the vehicle ahead may have lain there.
    if told(&account.came_from) == Some(Origin::Ahead) {
        return false;
    }
    let rolls = |draft: &ScenarioDraft| {
        draft.actors.iter().any(|actor| actor.kind == PartnerKind::FixedObject && !actor.plan.course.is_empty())
    };
    let Some((_, _, [x_m, y_m, heading_deg])) = approach(draft) else { return false };
    if !rolls(draft) {
        return false;
    }
    draft.actors.retain(|actor| actor.id != "cp");
    draft.objects.push(ObjectSpec { kind: ObstacleKind::Debris, at: Place::at(x_m, y_m, heading_deg), size: None });
    true
}

fn gate_stays(_: &Account, draft: &mut ScenarioDraft) -> bool {
    let gate = draft.actors.iter_mut().find(|actor| actor.parts.iter().any(|part| part.kind == PartKind::Arm));
    let Some(gate) = gate else { return false };
    gate.plan.acts.clear();
    true
}
