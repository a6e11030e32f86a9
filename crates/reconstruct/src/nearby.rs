//! Where others stand and drive who have no part in what the ego does, and those with one who do not fit where they are put first: in the
//! first place that shows what is told of them, where they hinder nobody.

mod deeds;
mod several;

use crate::control;
use crate::extras::STANDS_MPS;
use crate::ground::{Ground, LANE_M, corner_m};
use crate::movement;
use crate::near::{Does, NEAR_M, Near};
use crate::others::{Extra, Role};
use crate::pace::{next, when};
use crate::seen::Seen;
use crate::side::size_of as size_of_kind;
use crate::speeds::{TURNS_MPS, WALKS_MPS};
use crate::told::Told;
use recrash_model::account::{Kind, KindGroup, LeftRight, Origin, PlaceKind, StandReason};
use recrash_model::geometry::{OrientedBox, Pose, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Rollout};
use recrash_model::scenario::{Actor, ActorPlan, Deed, Leg, Place, ScenarioDraft, Strip, StripKind};
use recrash_model::vehicle::VehicleSpec;
use recrash_roads::{Scenario, check_on};
use recrash_sim::Ego;

/// Nobody comes closer to it. [m]
const CLEAR_M: f64 = 0.5;

/// Usual speeds: on a street, in a lot, of who rides. [m/s]
const DRIVES_MPS: f64 = 7.0;
const LOT_MPS: f64 = 3.0;
const RIDES_MPS: f64 = 4.0;

/// Who slows does so long before the contact, by so much; who passes is faster than the ego by so much. [s, m/s]
const SLOWS_BEFORE_S: f64 = 3.0;
const SLOWS_BY_MPS: f64 = 2.0;
const PASSES_BY_MPS: f64 = 4.0;
const BRAKES_MPS2: f64 = 2.5;

/// Who backs begins to so long before the contact, and does so over this way. [s, m, m/s, m/s^2]
const BACKS_BEFORE_S: f64 = 2.5;
const BACKS_M: f64 = 1.5;
const BACKS_MPS: f64 = 1.0;
const BACKS_MPS2: f64 = 1.0;

/// Who changes lanes takes so long, and has done so this long before the contact. [s]
const CHANGES_S: f64 = 3.5;
const CHANGED_BEFORE_S: f64 = 0.5;

/// Who comes along and stands at the contact drives as far as in this share of the time at its speed. [-]
const COMES_SHARE: f64 = 0.7;

/// What fell off somebody begins so far behind it. [m]
const RIGHT_BEHIND_M: f64 = 0.7;

/// Who makes room for somebody between it and the ego is so far over in its lane. [m]
const FAR_OVER_M: f64 = 0.9;

/// Who comes over ahead of an ego that stands does so slowly. [m/s]
const MERGES_MPS: f64 = 3.0;

/// How somebody comes to be near: where it is at first, what it drives, and where it goes.
struct Way {
    from: Pose,
    speed_mps: f64,
    /// It stands after so much of its way. [m]
    stops_m: Option<f64>,
    slows: bool,
    /// It moves so far to the right before the contact. [m]
    shifts_m: f64,
    /// It goes backwards.
    backs: bool,
    /// It stands at first, and sets off at a time to a speed. [s, m/s]
    sets_off: Option<(f64, f64)>,
    /// Places on its way, after which it goes straight on.
    by: Vec<Pose>,
}

impl Way {
    fn stands(from: Pose) -> Self {
        Self {
            from,
            speed_mps: 0.0,
            stops_m: None,
            slows: false,
            shifts_m: 0.0,
            backs: false,
            sets_off: None,
            by: Vec::new(),
        }
    }

    /// Straight on, where it is at a place at a time.
    fn straight(at: Pose, speed_mps: f64, at_s: f64) -> Self {
        let from = Pose { position: at.position - Vec2::from_heading(at.heading) * (speed_mps * at_s), ..at };
        Self { speed_mps, ..Self::stands(from) }
    }

    fn plan(&self, contact_s: f64) -> ActorPlan {
        if self.backs {
            let end = Pose { position: self.from.position - Vec2::from_heading(self.from.heading) * 20.0, ..self.from };
            let begins_s = tenth((contact_s - BACKS_BEFORE_S).max(0.1));
            let goes = when(begins_s, Deed::Speed { to_mps: BACKS_MPS, rate_mps2: BACKS_MPS2 });
            return ActorPlan {
                course: vec![Leg::Curve { to: place(end), reverse: true }],
                acts: vec![goes, next(Deed::Stop { rate_mps2: BACKS_MPS2, at_m: Some(BACKS_M) })],
                ..ActorPlan::standing(place(self.from))
            };
        }
        if let Some(off) = self.sets_off {
            return self.out(off);
        }
        if self.speed_mps == 0.0 {
            return ActorPlan::standing(place(self.from));
        }
        let last = self.by.last().copied().unwrap_or(self.from);
        let on_m = self.speed_mps * (contact_s + 10.0) + 20.0;
        let end = Pose { position: last.position + Vec2::from_heading(last.heading) * on_m, ..last };
        let stops = self.stops_m.map(|at_m| when(0.1, Deed::Stop { rate_mps2: BRAKES_MPS2, at_m: Some(at_m) }));
        let slower = Deed::Speed { to_mps: self.speed_mps - SLOWS_BY_MPS, rate_mps2: BRAKES_MPS2 };
        let slows = self.slows.then(|| when(tenth(contact_s - SLOWS_BEFORE_S), slower));
        let shift = Deed::Shift { to_t_m: self.shifts_m, over_m: CHANGES_S * self.speed_mps };
        let shifts = (self.shifts_m != 0.0).then(|| when(tenth(contact_s - CHANGES_S - CHANGED_BEFORE_S), shift));
        ActorPlan {
            speed_mps: self.speed_mps,
            course: self.by.iter().chain([&end]).map(|to| Leg::Curve { to: place(*to), reverse: false }).collect(),
            acts: stops.into_iter().chain(slows).chain(shifts).collect(),
            ..ActorPlan::standing(place(self.from))
        }
    }
}

fn place(pose: Pose) -> Place {
    Place::at(pose.position.x, pose.position.y, pose.heading.to_degrees())
}

fn tenth(time_s: f64) -> f64 {
    (time_s * 10.0).round() / 10.0
}

/// The crash with them: of each the first place that shows what is told of it. What is assumed is said.
pub(crate) fn with_near(
    told: &Told,
    ground: &Ground,
    begun: (ScenarioDraft, Rollout),
) -> (ScenarioDraft, Rollout, Vec<String>) {
    let (mut draft, mut rollout) = begun;
    let mut assumed = Vec::new();
    // Who stands ahead, and is told only by why the ego stood, may be the partner.
    for extra in told.wanted.iter().filter(|extra| extra.role != Role::Lead || !extra.of.is_empty()) {
        let id = extra.id();
        if rollout.actors.iter().any(|track| track.id == id) {
            continue;
        }
        let Some(scene) = Scene::of(told, ground, &rollout) else { break };
        if let Some(with) = scene.with_first(extra, (&draft, &rollout)) {
            (draft, rollout) = with;
            if let Some(near) = extra.near {
                assumed.push(format!("where {id} is that has no part in what the ego does: {}", near.words()));
            }
            assumed.extend(extra.assumed());
        }
    }
    for extra in told.wanted.iter().filter(|extra| extra.several) {
        let Some(scene) = Scene::of(told, ground, &rollout) else { break };
        if let Some(with) = scene.with_second(extra, (&draft, &rollout)) {
            (draft, rollout) = with;
        }
    }
    (draft, rollout, assumed)
}

/// Whether somebody touches nobody, crosses no red light, is on the road where it is a vehicle, and all else is as without it.
fn hinders_nobody(id: &str, scenario: &Scenario, (before, after): (&Rollout, &Rollout)) -> bool {
    let Some(track) = after.actors.iter().find(|track| track.id == id) else { return false };
    let contacts = |rollout: &Rollout| -> Vec<(String, String, f64)> {
        let name = |number: usize| rollout.actors[number].id.clone();
        let of = |event: &recrash_model::rollout::Event| match event.kind {
            EventKind::Contact { a, b, .. } => Some((name(a), name(b), event.time_s)),
            EventKind::ObstacleContact { actor, obstacle, .. } => {
                Some((name(actor), format!("obstacle {obstacle}"), event.time_s))
            }
            _ => None,
        };
        rollout.events.iter().filter_map(of).collect()
    };
    let first_s = contacts(after).first().map_or(f64::MAX, |(_, _, at_s)| *at_s);
    let of = |track: &ActorTrack, step: usize| {
        let state = &track.states[step.min(track.states.len() - 1)];
        OrientedBox::new(state.pose(), track.length_m, track.width_m)
    };
    let until = ((first_s * 10.0 + 10.0) as usize).min(track.states.len() - 1);
    let clear = |step: usize| {
        let own = of(track, step);
        after.actors.iter().all(|other| other.id == id || own.gap(&of(other, step)) > CLEAR_M)
            && after.obstacles.iter().all(|placed| own.gap(&placed.outline()) > CLEAR_M)
    };
    let drives = VehicleSpec::of(track.kind).length_m > 2.5;
    let on_road = |step: usize| !drives || scenario.network().on_road(track.states[step].position());
    let met = &after.ego_track().states[..=((first_s * 10.0) as usize).min(after.ego_track().states.len() - 1)];
    contacts(before) == contacts(after)
        && (0..=until).all(clear)
        && !is_cut_off(track, met)
        && !(drives && goes_wrong_way(scenario, track, met))
        && (0..=until).step_by(5).all(on_road)
        && !control::runs_red(scenario, track)
}

/// Whose way an ego that turns left bars by this much of its turn, it has let by; farther ahead than this nobody minds. [rad, m/s, m]
const BARS_RAD: f64 = 0.15;
const COMES_MPS: f64 = 1.0;
const MINDS_M: f64 = 25.0;

/// Whether somebody comes towards an ego that turns left across its way as it is touched.
fn is_cut_off(track: &ActorTrack, ego: &[ActorState]) -> bool {
    let (first, last) = (&ego[0], &ego[ego.len() - 1]);
    let state = &track.states[(ego.len() - 1).min(track.states.len() - 1)];
    let ahead_m = Vec2::from_heading(first.heading).dot(state.position() - last.position());
    let oncoming = math::wrap_angle(state.heading - first.heading).abs() > 2.0 && state.speed() > COMES_MPS;
    let turns = math::wrap_angle(last.heading - first.heading) > BARS_RAD;
    turns && oncoming && (0.0..MINDS_M).contains(&ahead_m)
}

/// Whether somebody who sets out the ego's way drives in a lane that leads the other way.
fn goes_wrong_way(scenario: &Scenario, track: &ActorTrack, ego: &[ActorState]) -> bool {
    let same_way = math::wrap_angle(track.states[0].heading - ego[0].heading).abs() < 1.0;
    let until = ego.len().min(track.states.len());
    let wrong = |state: &ActorState| state.speed() > COMES_MPS && movement::is_against(scenario, state) == Some(true);
    same_way && track.states[..until].iter().step_by(5).any(wrong)
}

/// The crash, as it is without whoever is near.
struct Scene<'a> {
    told: &'a Told,
    ground: &'a Ground,
    ego: &'a ActorTrack,
    partner: Option<&'a ActorTrack>,
    contact_s: f64,
    until: usize,
}

impl<'a> Scene<'a> {
    fn of(told: &'a Told, ground: &'a Ground, rollout: &'a Rollout) -> Option<Self> {
        let touched = |event: &recrash_model::rollout::Event| {
            let ego =
                matches!(event.kind, EventKind::Contact { a: 0, .. } | EventKind::ObstacleContact { actor: 0, .. });
            ego.then_some(event.time_s)
        };
        let contact_s = rollout.events.iter().find_map(touched)?;
        let ego = rollout.ego_track();
        let until = ((contact_s * 10.0) as usize).min(ego.states.len() - 1);
        let partner = rollout.actors.iter().find(|track| track.id == "cp");
        Some(Self { told, ground, ego, partner, contact_s, until })
    }

    /// The same with somebody in the first of its places that shows what is told of it: one in which the ego stands for whom it gave way to
    /// goes before the others.
    fn with_first(&self, extra: &Extra, begun: (&ScenarioDraft, &Rollout)) -> Option<(ScenarioDraft, Rollout)> {
        let (draft, rollout) = begun;
        let gives_way = extra.awaited && extra.near.is_some() && self.told.reasons.contains(&StandReason::Yield);
        let mut best = None;
        for actor in self.actors(extra) {
            let mut with = draft.clone();
            with.actors.push(actor);
            let recorded = with.ego.recorded.clone()?;
            with.control = control::devices(self.told, self.ground, &recorded, &with.actors);
            let Ok(checked) = check_on(with, Some(&self.ground.network)) else { continue };
            let driven = recrash_sim::simulate(&checked.value, Ego::Recorded);
            let seen = Seen::new(self.told, &driven, self.contact_s);
            if !hinders_nobody(&extra.id(), &checked.value, (rollout, &driven)) || !seen.holds(extra) {
                continue;
            }
            let waited_for = !gives_way || seen.reason(StandReason::Yield);
            let found = || (checked.value.draft().clone(), driven.clone());
            if waited_for {
                return Some(found());
            }
            best = best.or_else(|| Some(found()));
        }
        best
    }

    fn actors(&self, extra: &Extra) -> Vec<Actor> {
        let kind = extra.kind.partner_kind().unwrap_or(PartnerKind::PassengerCar);
        let size = size_of_kind(extra.kind);
        let spec = VehicleSpec::of(kind);
        let length_m = size.map_or(spec.length_m, |size| size.length_m);
        let ways = match (extra.near, extra.kind.group()) {
            (Some(near), KindGroup::OnFoot | KindGroup::Animal | KindGroup::Cyclist | KindGroup::Object) => {
                self.walks(extra.kind, near)
            }
            (Some(near), _) => self.drives(near, length_m),
            (None, _) => self.elsewhere(extra, 0.5 * length_m),
        };
        let actor = |way: Way| Actor {
            id: extra.id(),
            kind,
            size,
            mass_kg: None,
            parts: Vec::new(),
            plan: way.plan(self.contact_s),
        };
        ways.into_iter().map(actor).collect()
    }

    fn front_m(&self) -> f64 {
        0.5 * self.ego.length_m
    }

    /// How far along its road the ego is, and how far to the right of its line. [m]
    fn at(&self, step: usize) -> (f64, f64) {
        self.ground.beside(self.ego.states[step].position())
    }

    /// A place on the ego's road; where the ego turns, straight on through the junction.
    fn road(&self, s_m: f64, t_m: f64) -> Pose {
        let line_m = self.ground.first_m();
        if s_m <= line_m || !self.ground.junction {
            return self.ground.pose(s_m, t_m);
        }
        let line = self.ground.pose(line_m, t_m);
        Pose { position: line.position + Vec2::from_heading(line.heading) * (s_m - line_m), ..line }
    }

    fn against(&self, s_m: f64) -> Pose {
        self.against_in(0, s_m)
    }

    /// In a lane towards the ego, 0 is the next one.
    fn against_in(&self, lane: usize, s_m: f64) -> Pose {
        let pose = self.road(s_m, -self.ground.opposing_m - lane as f64 * LANE_M);
        Pose { heading: pose.heading + std::f64::consts::PI, ..pose }
    }

    /// How fast the ego came, on average, and the usual speed.
    fn speeds(&self) -> [f64; 2] {
        let way_m: f64 = (0..self.until)
            .map(|step| self.ego.states[step].position().distance(self.ego.states[step + 1].position()))
            .sum();
        let lot = matches!(self.told.place, PlaceKind::ParkingLot | PlaceKind::Garage | PlaceKind::Driveway);
        let usual_mps = if lot { LOT_MPS } else { DRIVES_MPS };
        [(way_m / self.contact_s.max(1.0)).max(LOT_MPS), usual_mps]
    }

    /// Strips on the right and on the left of the ego's road.
    fn sides(&self) -> [&[Strip]; 2] {
        let road = &self.ground.map.roads[0];
        // The ego goes against the line of a road that is drawn from the junction.
        if self.ground.junction { [&road.left, &road.right] } else { [&road.right, &road.left] }
    }

    fn is_two_way(&self) -> bool {
        self.sides()[1].iter().any(|strip| strip.kind == StripKind::Driving)
    }

    fn drives(&self, near: Near, length_m: f64) -> Vec<Way> {
        let half_m = 0.5 * length_m;
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let stands = near.does == Does::Stands;
        let untold = near.does == Does::Untold;
        let mut list = Vec::new();
        match near.place {
            _ if near.does == Does::TurnsLeft => list.extend(self.turners()),
            _ if near.does == Does::Backs => list.extend(self.backers(near.place, half_m)),
            _ if let Does::Changes(side) = near.does => list.extend(self.changers(near.place, side, half_m)),
            _ if let Does::Turns(side) = near.does => list.extend(self.turning(near.place, side)),
            _ if let Does::GoesAside(side) = near.does => list.extend(self.aside(near, side, half_m)),
            _ if let Does::PullsOver(side) = near.does => {
                list.extend(self.aside(near, side.or(Some(LeftRight::Right)), half_m));
            }
            _ if near.does == Does::PullsOut => list.extend(self.pulling_out(near.place, half_m)),
            _ if near.does == Does::Passes => list.extend(self.passers(near.place, half_m)),
            Some(Origin::Opposite) => {
                if !stands {
                    list.extend(self.oncoming(half_m));
                }
                if near.does == Does::Slows {
                    list.extend(self.waits_opposite(half_m).iter().map(|way| self.coming_to(way)));
                }
                list.extend(self.comes_or_stands(near, self.waits_opposite(half_m)));
            }
            Some(Origin::Ahead) => {
                list.extend(self.loses(half_m));
                if !stands {
                    list.extend(self.leads(half_m));
                }
                list.extend(self.comes_or_stands(near, self.stands_ahead(half_m, 0.0)));
            }
            Some(Origin::Behind) => list.extend(self.follows(half_m)),
            Some(Origin::Beside { side }) => {
                if !stands {
                    list.extend(self.beside(side));
                }
                list.extend(self.stands_beside(side, half_m));
                list.extend(self.kerb(side, half_m));
            }
            Some(Origin::Cross { side }) => list.extend(self.crosses(side, near.does, half_m)),
            _ if near.across => {
                list.extend(self.crosses(left, near.does, half_m));
                list.extend(self.crosses(right, near.does, half_m));
            }
            _ => {
                if !stands {
                    list.extend(self.oncoming(half_m));
                    list.extend(self.leads(half_m));
                    list.extend(self.beside(left));
                    list.extend(self.beside(right));
                    list.extend(self.crosses(left, Does::Drives, half_m));
                    list.extend(self.crosses(right, Does::Drives, half_m));
                }
                if stands || untold {
                    list.extend(self.kerb(left, half_m));
                    list.extend(self.kerb(right, half_m));
                    list.extend(self.waits_opposite(half_m));
                    list.extend(self.stands_beside(left, half_m));
                    list.extend(self.stands_beside(right, half_m));
                    list.extend(self.crosses(left, Does::Stands, half_m));
                    list.extend(self.crosses(right, Does::Stands, half_m));
                    list.extend(self.stands_ahead(half_m, 12.0));
                }
            }
        }
        for way in &mut list {
            let slows = matches!(near.does, Does::Slows | Does::PullsOver(_));
            way.slows = slows && way.speed_mps > SLOWS_BY_MPS && way.stops_m.is_none();
        }
        list
    }

    /// Who has a part, and does not fit where it is put first, in other places that show the same.
    fn elsewhere(&self, extra: &Extra, half_m: f64) -> Vec<Way> {
        let sides = match extra.side {
            Some(side) => vec![side],
            None => vec![LeftRight::Right, LeftRight::Left],
        };
        match extra.role {
            Role::Kerb => sides.into_iter().flat_map(|side| self.kerb(side, half_m)).collect(),
            Role::Beside => sides.into_iter().flat_map(|side| self.stands_beside(side, half_m)).collect(),
            Role::Abreast => sides.into_iter().flat_map(|side| self.beside(side)).collect(),
            Role::Crosser => sides.into_iter().flat_map(|side| self.crosses(side, Does::Drives, half_m)).collect(),
            Role::Oncoming if self.is_two_way() => [0.5, 1.0, 2.0, 3.0, 4.5, 5.2]
                .into_iter()
                .flat_map(|before_s| {
                    let at_s = (self.contact_s - before_s).max(0.5);
                    let (s_m, _) = self.at(((at_s * 10.0) as usize).min(self.until));
                    let lanes = 0..self.ground.oncoming.max(1);
                    lanes.map(move |lane| Way::straight(self.against_in(lane, s_m), DRIVES_MPS, at_s))
                })
                .collect(),
            Role::Lead | Role::Thing if !extra.goes => self.stands_ahead(half_m, 0.0),
            Role::Lead => self.setting_off(half_m),
            Role::Slower => self.leads(half_m).into_iter().map(|way| Way { slows: true, ..way }).collect(),
            Role::Walker | Role::Animal => sides.into_iter().flat_map(|side| self.crossing(extra.kind, side)).collect(),
            Role::Merger => sides.into_iter().flat_map(|side| self.mergers(side, half_m)).collect(),
            _ => Vec::new(),
        }
    }

    /// In the lane towards the ego: it comes by, is yet to come, or drives off where the ego's road begins behind a junction.
    fn oncoming(&self, half_m: f64) -> Vec<Way> {
        if !self.is_two_way() {
            return Vec::new();
        }
        let (s_m, _) = self.at(self.until);
        let [_, usual_mps] = self.speeds();
        let at = |on_m: f64| Way::straight(self.against(s_m + on_m), usual_mps, self.contact_s);
        let from_m = self.ground.first_m() - half_m - 2.0;
        let off = (self.ground.junction && from_m > s_m - NEAR_M)
            .then(|| Way::straight(self.against(from_m), usual_mps, 0.0));
        [12.0, 24.0, -10.0, -25.0].into_iter().map(at).chain(off).collect()
    }

    /// In the lane towards the ego, where no junction is; else at the other side of it.
    fn waits_opposite(&self, half_m: f64) -> Vec<Way> {
        if !self.is_two_way() {
            return Vec::new();
        }
        let (s_m, _) = self.at(self.until);
        let line_m = self.ground.first_m();
        let across_m = line_m + 2.0 * corner_m(self.ground.lanes) + half_m + 1.0;
        let place = |lane: usize, on_m: f64| {
            let at_m = s_m + on_m;
            let inside = self.ground.junction && at_m + half_m > line_m;
            Way::stands(self.against_in(lane, if inside { at_m.max(across_m) } else { at_m }))
        };
        let lanes = 0..self.ground.oncoming.max(1);
        lanes.flat_map(|lane| [10.0, 20.0, 30.0, 4.0].map(|on_m| place(lane, on_m))).collect()
    }

    /// Comes along to where somebody stands.
    pub(super) fn coming_to(&self, way: &Way) -> Way {
        let [_, speed_mps] = self.speeds();
        let way_m = COMES_SHARE * speed_mps * self.contact_s;
        let from = way.from.position - Vec2::from_heading(way.from.heading) * way_m;
        Way { speed_mps, stops_m: Some(way_m), ..Way::stands(Pose { position: from, ..way.from }) }
    }

    /// Backs a little: in the lane towards the ego, where it is told there; else out of where it is parked, or stands.
    fn backers(&self, place: Option<Origin>, half_m: f64) -> Vec<Way> {
        let sides = match place {
            Some(Origin::Opposite) => Vec::new(),
            Some(Origin::Stall { side: Some(side) } | Origin::Parked { side: Some(side) }) => vec![side],
            _ => vec![LeftRight::Right, LeftRight::Left],
        };
        let parked = sides.into_iter().flat_map(|side| self.kerb(side, half_m));
        parked.chain(self.waits_opposite(half_m)).map(|way| Way { backs: true, ..way }).collect()
    }

    /// The ego's line, those of the lanes beside it, and that to which it goes. [m]
    fn lines(&self) -> Vec<f64> {
        let to_m = self.told.sv_aside().map(|aside| aside.to_t_m).filter(|to_m| to_m.abs() >= LANE_M);
        let from_m = self.told.sv_aside().map_or(0.0, |aside| aside.from_t_m);
        to_m.into_iter().chain([from_m, -LANE_M, LANE_M]).collect()
    }

    /// Ahead in the ego's lane, or beside that, and drives on.
    fn leads(&self, half_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(0);
        let mut list = Vec::new();
        for t_m in self.lines() {
            for speed_mps in self.speeds() {
                let from =
                    |on_m: f64| Way::straight(self.road(s_m + self.front_m() + half_m + on_m, t_m), speed_mps, 0.0);
                list.extend([8.0, 14.0, 22.0, 30.0].map(from));
            }
        }
        list
    }

    /// Drives on ahead of what fell off it.
    fn loses(&self, half_m: f64) -> Option<Way> {
        let thing = self.partner.filter(|_| self.told.dropped.is_some())?;
        let (pose, on_m) = (thing.states[0].pose(), 0.5 * thing.length_m + half_m + RIGHT_BEHIND_M);
        let from = Pose { position: pose.position + Vec2::from_heading(pose.heading) * on_m, ..pose };
        let (s_m, _) = self.ground.beside(from.position);
        Some(Way::straight(self.road(s_m, self.at(0).1), thing.states[0].speed(), 0.0))
    }

    fn stands_ahead(&self, half_m: f64, least_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let front_m = s_m + self.front_m() + half_m;
        let far = [3.0, 5.0, 7.5, 10.0, 16.0, 24.0, 30.0].into_iter().filter(|on_m| *on_m >= least_m);
        let places = far.flat_map(|on_m| self.lines().into_iter().map(move |t_m| (front_m + on_m, t_m)));
        let across_m = self.ground.first_m() + 2.0 * corner_m(self.ground.lanes) + half_m;
        let inside = |s_m: f64| self.ground.junction && s_m + half_m > self.ground.first_m() && s_m < across_m;
        let beyond = self.ground.junction.then(|| Way::stands(self.road(across_m + 1.0, 0.0)));
        let stands = |(s_m, t_m): (f64, f64)| Way::stands(self.road(s_m, t_m));
        places.filter(|(s_m, _)| !inside(*s_m)).map(stands).chain(beyond).collect()
    }

    /// Behind the ego: it comes along and stands, or stands where the ego does from the start.
    fn follows(&self, half_m: f64) -> Vec<Way> {
        let rear = (0..=self.until).map(|step| self.at(step).0).fold(f64::MAX, f64::min) - self.front_m() - half_m;
        let (s_m, _) = self.at(self.until);
        let mut list = Vec::new();
        for t_m in self.lines().into_iter().filter(|t_m| *t_m == 0.0 || self.ground.lanes > 1) {
            for speed_mps in self.speeds().into_iter().rev() {
                for behind_m in [6.0, 12.0, 18.0, 26.0] {
                    let rests_m = s_m - self.front_m() - half_m - behind_m;
                    let way_m = COMES_SHARE * speed_mps * self.contact_s;
                    let from = self.road(rests_m - way_m, t_m);
                    list.push(Way { speed_mps, stops_m: Some(way_m), ..Way::stands(from) });
                }
            }
            list.extend([6.0, 12.0, 20.0].map(|behind_m| Way::stands(self.road(rear - behind_m, t_m))));
        }
        list
    }

    fn beside_m(&self, side: LeftRight, step: usize) -> f64 {
        let lane_m = (self.at(step).1 / LANE_M).round() * LANE_M;
        lane_m + if side == LeftRight::Left { -LANE_M } else { LANE_M }
    }

    fn beside(&self, side: LeftRight) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let t_m = [self.beside_m(side, self.until), self.beside_m(side, 0)];
        let mut list = Vec::new();
        for speed_mps in self.speeds() {
            for (on_m, before_s) in [(4.0, 0.0), (10.0, 0.0), (-8.0, 0.0), (14.0, 0.0), (6.0, 2.0), (0.0, 4.0)] {
                let at = |t_m: f64| Way::straight(self.road(s_m + on_m, t_m), speed_mps, self.contact_s - before_s);
                list.extend(t_m.map(at));
            }
            // It comes along, and stands there.
            let way_m = COMES_SHARE * speed_mps * self.contact_s;
            let rests = |on_m: f64| Way {
                speed_mps,
                stops_m: Some(way_m),
                ..Way::stands(self.road(s_m + on_m - way_m, t_m[0]))
            };
            list.extend([0.0, -6.0, 6.0, -12.0].map(rests));
        }
        // Far over in its lane, where somebody comes between.
        let sign = if side == LeftRight::Left { -1.0 } else { 1.0 };
        let over = |way: &Way| {
            let away = Vec2::from_heading(way.from.heading).left() * (-sign * FAR_OVER_M);
            Way { from: Pose { position: way.from.position + away, ..way.from }, by: Vec::new(), ..*way }
        };
        let far: Vec<Way> = list.iter().map(over).collect();
        list.extend(far);
        list
    }

    fn stands_beside(&self, side: LeftRight, half_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let t_m = self.beside_m(side, self.until);
        let inside = |s_m: f64| self.ground.junction && s_m + 2.0 > self.ground.first_m();
        let at_line = self.ground.junction.then(|| self.ground.first_m() - half_m - 2.0);
        let places = [2.0, -6.0, 8.0, 12.0].into_iter().map(|on_m| s_m + on_m).chain(at_line);
        places.filter(|s_m| !inside(*s_m)).map(|s_m| Way::stands(self.road(s_m, t_m))).collect()
    }

    /// Comes from behind, and is beside the ego or ahead of it at the contact.
    fn passers(&self, place: Option<Origin>, half_m: f64) -> Vec<Way> {
        let (s_m, t_m) = self.at(self.until);
        let sides = match place {
            Some(Origin::Beside { side }) => vec![side],
            _ => vec![LeftRight::Left, LeftRight::Right],
        };
        let mut list = Vec::new();
        for side in sides {
            let sign = if side == LeftRight::Left { -1.0 } else { 1.0 };
            for on_m in [8.0, 14.0, 4.0, 22.0] {
                let speed_mps = self.speeds()[0].max(LOT_MPS) + PASSES_BY_MPS;
                // Beside one that is parked it comes along the lane.
                let line_m =
                    if t_m.abs() > 0.5 * LANE_M && t_m * sign < 0.0 { 0.0 } else { self.beside_m(side, self.until) };
                list.push(Way::straight(self.road(s_m + on_m + half_m, line_m), speed_mps, self.contact_s));
            }
        }
        list
    }

    /// Changes from beside the ego's lane into that, ahead of it.
    fn mergers(&self, from: LeftRight, half_m: f64) -> Vec<Way> {
        let (s_m, t_m) = self.at(self.until);
        let to_m = self.told.sv_aside().map_or(t_m, |aside| aside.from_t_m);
        let shifts_m = if from == LeftRight::Left { LANE_M } else { -LANE_M };
        let [mean_mps, _] = self.speeds();
        let place = |on_m: f64| self.road(s_m + self.front_m() + half_m + on_m, to_m - shifts_m);
        let way = |speed_mps: f64, on_m: f64| Way { shifts_m, ..Way::straight(place(on_m), speed_mps, self.contact_s) };
        match self.ego.states[self.until].velocity().length() < STANDS_MPS {
            true => [14.0, 18.0, 22.0].map(|on_m| way(MERGES_MPS, on_m)).into(),
            false => [6.0, 10.0, 14.0, 20.0].map(|on_m| way(mean_mps, on_m)).into(),
        }
    }

    /// Changes from one lane to the next, ahead of the ego or beside it.
    fn changers(&self, place: Option<Origin>, side: Option<LeftRight>, half_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let behind = place == Some(Origin::Behind);
        let far: &[f64] = if behind { &[-18.0, -24.0, -32.0] } else { &[8.0, 14.0, 3.0, 22.0, 30.0] };
        let sides = side.map_or(vec![LeftRight::Left, LeftRight::Right], |side| vec![side]);
        let mut list = Vec::new();
        for side in sides {
            let shifts_m = if side == LeftRight::Left { -LANE_M } else { LANE_M };
            for to_m in [-LANE_M, LANE_M, 0.0] {
                for speed_mps in self.speeds() {
                    for on_m in far {
                        let at = self.road(s_m + self.front_m() + half_m + on_m, to_m - shifts_m);
                        list.push(Way { shifts_m, ..Way::straight(at, speed_mps, self.contact_s) });
                    }
                }
            }
        }
        list
    }

    /// Parked at a kerb, in a stall, or on a shoulder.
    fn kerb(&self, side: LeftRight, half_m: f64) -> Vec<Way> {
        let [right, left] = self.sides();
        let strips = if side == LeftRight::Left { left } else { right };
        let has = |kind: StripKind| strips.iter().any(|strip| strip.kind == kind);
        let (sign, kerb_m) = match side {
            LeftRight::Left => (-1.0, self.ground.kerbs_m[0]),
            LeftRight::Right => (1.0, self.ground.kerbs_m[1]),
        };
        let stalls = has(StripKind::Stalls);
        if !stalls && !has(StripKind::Parking) && !has(StripKind::Shoulder) {
            return Vec::new();
        }
        let wider_m = 0.5 * (StripKind::Stalls.usual_width_m() - StripKind::Parking.usual_width_m());
        let t_m = sign * (kerb_m + if stalls { wider_m } else { 0.0 });
        let turned = match (stalls, side == LeftRight::Left && self.is_two_way()) {
            (true, _) => 0.5 * std::f64::consts::PI,
            (false, true) => std::f64::consts::PI,
            (false, false) => 0.0,
        };
        let (s_m, _) = self.at(self.until);
        let inside = |s_m: f64| self.ground.junction && s_m + half_m + 5.0 > self.ground.first_m();
        let stands = |s_m: f64| {
            let pose = self.road(s_m, t_m);
            Way::stands(Pose { heading: pose.heading + turned, ..pose })
        };
        let places = [10.0, 17.0, -9.0, 25.0, -16.0].into_iter().map(|on_m| s_m + on_m);
        places.filter(|s_m| !inside(*s_m)).map(stands).collect()
    }

    /// Where the crossing road's lanes from one side, and to it, are: a pose on the line where the junction begins, facing into it.
    fn arm(&self, side: LeftRight, out: bool, back_m: f64) -> Option<Pose> {
        if !self.ground.junction {
            return None;
        }
        let corner_m = corner_m(self.ground.lanes);
        let centre_m = self.ground.first_m() + corner_m;
        // The middle of the ego's road, and of the crossing one.
        let middle_m = 0.5 * LANE_M - self.ground.opposing_m;
        let sign = if side == LeftRight::Left { -1.0 } else { 1.0 };
        // Seen from the ego, who comes from the left drives on its own right: nearer to the ego.
        let lane_m = 0.5 * LANE_M * sign * if out { -1.0 } else { 1.0 };
        let pose = self.road(centre_m + lane_m, middle_m + sign * (corner_m + back_m));
        let turned = 0.5 * std::f64::consts::PI * sign * if out { -1.0 } else { 1.0 };
        Some(Pose { heading: pose.heading + turned, ..pose })
    }

    fn crosses(&self, side: LeftRight, does: Does, half_m: f64) -> Vec<Way> {
        let Some(line) = self.arm(side, false, half_m + 1.0) else { return Vec::new() };
        let mut list = Vec::new();
        if does != Does::Stands {
            let through = |before_s: f64| Way::straight(line, DRIVES_MPS, self.contact_s - before_s);
            list.extend([2.5, 4.0, 5.5, 7.0, 1.2, 3.2].map(through));
            // Yet to come.
            list.extend([-2.0, -3.5].map(through));
        }
        if !matches!(does, Does::Drives | Does::Slows) {
            list.push(Way::stands(line));
        }
        list
    }

    /// From the opposite side through the junction, and left into the road on the ego's right.
    fn turners(&self) -> Vec<Way> {
        let Some(exit) = self.arm(LeftRight::Right, true, 0.0) else { return Vec::new() };
        let begins = self.against(self.ground.first_m() + 2.0 * corner_m(self.ground.lanes) - 6.0);
        let turns = |before_s: f64| {
            let way = Way::straight(begins, TURNS_MPS, (self.contact_s - before_s).max(0.5));
            Way { by: vec![begins, exit], ..way }
        };
        [4.0, 3.0, 5.5, 7.0, 2.0].into_iter().map(turns).collect()
    }

    /// Somebody on foot, or an animal, on the sidewalk or beside the lanes; who rides does so at their edge.
    fn walks(&self, kind: Kind, near: Near) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let [right, left] = self.sides();
        let [left_m, right_m] = self.ground.kerbs_m;
        let rides = kind.group() == KindGroup::Cyclist;
        let own_mps = if rides { RIDES_MPS } else { WALKS_MPS };
        let sides = match near.place {
            Some(Origin::Beside { side } | Origin::Cross { side }) => vec![side],
            Some(Origin::Opposite) => vec![LeftRight::Left],
            _ => vec![LeftRight::Right, LeftRight::Left],
        };
        if near.does == Does::Crosses {
            return sides.into_iter().flat_map(|side| self.coming_across(kind, side)).collect();
        }
        let half_m = 0.5 * StripKind::Parking.usual_width_m();
        let mut list = Vec::new();
        for side in sides {
            let (strips, kerb_m, sign) = match side {
                LeftRight::Left => (left, left_m, -1.0),
                LeftRight::Right => (right, right_m, 1.0),
            };
            let edge_m = kerb_m - half_m;
            let parking = strips.iter().any(|strip| strip.kind == StripKind::Parking);
            let walk_m = edge_m + if parking { 2.0 * half_m + 0.9 } else { 0.9 };
            let turned = if side == LeftRight::Left { std::f64::consts::PI } else { 0.0 };
            let place = |on_m: f64, t_m: f64| {
                let pose = self.road(s_m + on_m, sign * t_m);
                Pose { heading: pose.heading + turned, ..pose }
            };
            let beside = matches!(near.place, Some(Origin::Beside { .. }));
            let lines = if rides || beside { vec![edge_m - 0.2, edge_m + 0.5, walk_m] } else { vec![walk_m] };
            for t_m in lines {
                let there: &[f64] = if beside { &[3.0, -2.0, 8.0] } else { &[10.0, 5.0, 18.0, -6.0, 28.0, -12.0] };
                if !matches!(near.does, Does::Drives | Does::Slows | Does::Passes) {
                    list.extend(there.iter().map(|on_m| Way::stands(place(*on_m, t_m))));
                }
                let speeds = if rides { vec![self.speeds()[0].min(8.0), own_mps] } else { vec![own_mps] };
                for speed_mps in speeds {
                    list.extend(there.iter().map(|on_m| Way::straight(place(*on_m, t_m), speed_mps, self.contact_s)));
                }
            }
        }
        list
    }
}
