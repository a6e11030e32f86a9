//! Ways to try for somebody near, by what is told of it.

use crate::nearby::aside::STANDS_AHEAD_M;
use crate::nearby::scene::{DRIVES_MPS, RIDES_MPS, Scene};
use crate::nearby::way::{SLOWS_BY_MPS, Way};
use crate::told::near::{Does, First, Near};
use crate::told::others::{Extra, Role};
use crate::told::sizes::size_of as size_of_kind;
use crate::usual::{STANDS_MPS, WALKS_MPS};
use recrash_model::account::{Kind, KindGroup, LeftRight, Origin};
use recrash_model::geometry::Pose;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::{ActorTrack, step_of};
use recrash_model::scenario::{Actor, StripKind};
use recrash_model::vehicle::VehicleSpec;

/// Where nobody tells the side, in this order.
const SIDES: [LeftRight; 2] = [LeftRight::Left, LeftRight::Right];

impl<'a> Scene<'a> {
    pub(super) fn actors(&self, extra: &Extra) -> Vec<Actor> {
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

    /// On wheels, by what it does; where that is no more than to drive or to stand, by where it is.
    fn drives(&self, near: Near, length_m: f64) -> Vec<Way> {
        let half_m = 0.5 * length_m;
        let mut list = self.does(near, half_m).unwrap_or_else(|| self.is_there(near, half_m));
        for way in &mut list {
            let slows = matches!(near.does, Does::Slows | Does::PullsOver(_));
            way.slows = slows && way.speed_mps > SLOWS_BY_MPS && way.stops_m.is_none();
        }
        list
    }

    /// Who does more than to drive or to stand.
    fn does(&self, near: Near, half_m: f64) -> Option<Vec<Way>> {
        Some(match near.does {
            Does::TurnsLeft => self.turners(),
            Does::Backs => self.backers(near.place, half_m),
            Does::Changes(side) => self.changers(near.place, side, half_m),
            Does::Turns(side) => self.turning(near.place, side),
            Does::GoesAside(side) => self.aside(near, side, half_m),
            Does::PullsOver(side) => self.aside(near, side.or(Some(LeftRight::Right)), half_m),
            Does::PullsOut => self.pulling_out(near.place, half_m),
            Does::Passes => self.passing(near, half_m),
            Does::Untold | Does::Drives | Does::Slows | Does::Stands | Does::Crosses => return None,
        })
    }

    /// Who drives or stands where it is told.
    fn is_there(&self, near: Near, half_m: f64) -> Vec<Way> {
        match near.place {
            Some(Origin::Opposite) if near.first == First::Gone => self.gone_by(),
            Some(Origin::Opposite) => self.opposite(near, half_m),
            Some(Origin::Ahead) => self.ahead(near, half_m),
            Some(Origin::Behind) => self.follows(half_m),
            Some(Origin::Beside { side }) => self.at_side(near, side, half_m),
            Some(Origin::Cross { side }) => self.crosses(side, near.does, half_m),
            _ if near.across => SIDES.into_iter().flat_map(|side| self.crosses(side, near.does, half_m)).collect(),
            _ => self.anywhere(near, half_m),
        }
    }

    /// Comes by from behind; over in its lane first, where that is told with it.
    fn passing(&self, near: Near, half_m: f64) -> Vec<Way> {
        let ways = self.passers(near.place, half_m);
        let mut list = Vec::new();
        if let Some(Does::GoesAside(Some(side))) = near.also {
            let over = |by_m: f64| ways.iter().map(move |way| way.clone().aside(side, by_m));
            list.extend([OVER_M, ASIDE_M].into_iter().flat_map(over));
        }
        list.extend(ways);
        list
    }

    /// In a lane towards the ego.
    fn opposite(&self, near: Near, half_m: f64) -> Vec<Way> {
        let moves = near.does != Does::Stands;
        let mut list = Vec::new();
        if moves {
            list.extend(self.oncoming(half_m));
        }
        if near.does == Does::Slows {
            list.extend(self.waits_opposite(half_m).iter().map(|way| self.coming_to(way)));
        }
        list.extend(self.comes_or_stands(near, self.waits_opposite(half_m)));
        if moves {
            list.extend(self.oncoming_beyond());
        }
        list
    }

    /// Ahead in the ego's lane, or in one beside that.
    fn ahead(&self, near: Near, half_m: f64) -> Vec<Way> {
        let mut list: Vec<Way> = self.loses(half_m).into_iter().collect();
        if near.does == Does::Drives && self.ego_moves_off() {
            list.extend(self.setting_off(half_m));
        }
        if near.does != Does::Stands {
            list.extend(self.leads_round(half_m));
        }
        list.extend(self.comes_or_stands(near, self.stands_ahead(half_m, 0.0)));
        list
    }

    /// Beside the ego; where no lane is there one stands at the kerb.
    fn at_side(&self, near: Near, side: LeftRight, half_m: f64) -> Vec<Way> {
        let moves = near.does != Does::Stands;
        let mut list = if moves { self.beside(side) } else { Vec::new() };
        let (in_lane, at_kerb) = (self.stands_beside(side, half_m), self.at_kerb(near, side, half_m));
        let lane = self.lies_in_lane(self.beside_m(side, self.until));
        let (first, last) = if lane { (in_lane, at_kerb) } else { (at_kerb, in_lane) };
        list.extend(first.into_iter().chain(last));
        list
    }

    /// Parked at a kerb: not who is told to stand in a lane.
    fn at_kerb(&self, near: Near, side: LeftRight, half_m: f64) -> Vec<Way> {
        if near.in_lane { Vec::new() } else { self.kerb(side, half_m) }
    }

    /// Who drives or stands, and nobody tells where.
    fn anywhere(&self, near: Near, half_m: f64) -> Vec<Way> {
        let (stands, untold) = (near.does == Does::Stands, near.does == Does::Untold);
        let at_kerbs = || SIDES.into_iter().flat_map(|side| self.at_kerb(near, side, half_m));
        let crosses = |does: Does| SIDES.into_iter().flat_map(move |side| self.crosses(side, does, half_m));
        let mut list = Vec::new();
        // Traffic beside an ego that comes out of a space is in the lanes into which that goes.
        if untold && self.told.sv_aside().is_some_and(|aside| aside.from_t_m != 0.0) {
            list.extend(self.passers(None, half_m));
        }
        if stands {
            list.extend(at_kerbs());
            list.extend(self.stands_somewhere(half_m));
        } else {
            list.extend(self.oncoming(half_m));
            list.extend(self.leads(half_m));
            list.extend(SIDES.into_iter().flat_map(|side| self.beside(side)));
            list.extend(crosses(Does::Drives));
        }
        if untold {
            list.extend(at_kerbs());
            list.extend(self.waits_opposite(half_m));
            list.extend(SIDES.into_iter().flat_map(|side| self.stands_somewhere_beside(side, half_m)));
            list.extend(crosses(Does::Stands));
            list.extend(self.stands_ahead(half_m, STANDS_AHEAD_M));
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
                    let (s_m, _) = self.at(step_of(at_s).min(self.until));
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

/// Who goes aside in its lane does so by this; who comes over the line beside the ego first by that. [m]
const ASIDE_M: f64 = 0.7;
const OVER_M: f64 = 1.0;

/// Who goes round a thing that the ego then meets leaves its line by so much for it, in so long, as it comes to it. [m, s]
const ROUND_M: [f64; 3] = [2.2, 1.5, 3.0];
const ROUND_S: f64 = 1.8;

impl Scene<'_> {
    /// Whether a thing or an animal lies there that the ego meets: nothing that stands beside the lanes, or across them.
    fn lies_ahead(&self) -> bool {
        let still = |track: &ActorTrack| (0..=self.until).all(|step| track.states[step].speed().abs() < STANDS_MPS);
        let animal = self.told.cp.kind == PartnerKind::Animal && self.partner.is_some_and(still);
        let stands = |kind: Kind| matches!(kind, Kind::Wall | Kind::Curb | Kind::Gate);
        let lies = self.told.thing.is_some_and(|kind| !stands(kind)) && self.told.edge.is_none();
        lies || animal
    }

    /// Ahead in the ego's lane, and round what lies there, or in a lane beside that.
    fn leads_round(&self, half_m: f64) -> Vec<Way> {
        let in_lane = |way: &Way| self.ground.beside(way.from.position).1.abs() < ASIDE_M;
        let (mut list, beside): (Vec<Way>, Vec<Way>) = self.leads(half_m).into_iter().partition(in_lane);
        if self.lies_ahead() {
            list.extend(self.round_thing(&[LeftRight::Left, LeftRight::Right], half_m));
        }
        list.extend(beside);
        list
    }

    /// Ahead of the ego, in its lane, and round the thing that the ego meets there.
    fn round_thing(&self, sides: &[LeftRight], half_m: f64) -> Vec<Way> {
        let thing_m = self.at(self.until).0 + self.front_m();
        let mut list = Vec::new();
        for way in self.leads(half_m) {
            let (s_m, t_m) = self.ground.beside(way.from.position);
            let from_s = (thing_m - s_m - half_m) / way.speed_mps - ROUND_S;
            if t_m.abs() < ASIDE_M && from_s > 0.0 {
                let to = |by_m: f64| sides.iter().map(move |side| (*side, by_m));
                let aside = |(side, by_m)| Way { shifts_s: Some((from_s, ROUND_S)), ..way.clone().aside(side, by_m) };
                list.extend(ROUND_M.into_iter().flat_map(to).map(aside));
            }
        }
        list
    }

    /// Along its lane, and aside in it: to either side in the lane where it is put first before it is put in another.
    fn aside(&self, near: Near, side: Option<LeftRight>, half_m: f64) -> Vec<Way> {
        let drives = Near { does: Does::Drives, ..near };
        let sides = side.map_or(vec![LeftRight::Left, LeftRight::Right], |side| vec![side]);
        let ways = self.drives(drives, half_m * 2.0).into_iter().filter(|way| way.speed_mps > 0.0);
        let over = matches!(near.place, Some(Origin::Beside { .. }));
        let by_m: &[f64] = if over { &[OVER_M, ASIDE_M] } else { &[ASIDE_M] };
        let mut ways: Vec<Way> = ways.filter(|way| way.stops_m.is_none()).collect();
        // Who comes towards the ego beside the partner is in another lane than that.
        if near.place == Some(Origin::Opposite) && self.told.origin == Origin::Opposite {
            let next_m = self.ground.opposing_m + 0.5 * self.ground.lane_m;
            ways.sort_by_key(|way| -self.ground.beside(way.from.position).1 < next_m);
        }
        let shifted = |by_m: f64| {
            let sides = &sides;
            ways.iter().flat_map(move |way| sides.iter().map(move |side| way.clone().aside(*side, by_m)))
        };
        let ahead = near.place == Some(Origin::Ahead) && self.lies_ahead();
        let round = if ahead { self.round_thing(&sides, half_m) } else { Vec::new() };
        round.into_iter().chain(by_m.iter().flat_map(|by_m| shifted(*by_m))).collect()
    }
}
