//! A junction of four arms.

use crate::ground::arms::{AHEAD, Arms, LEFT, OWN, RIGHT, exit};
use crate::ground::lanes::{has, is_one_way, lanes_for, told_lane, usual_lane};
use crate::ground::pieces::{APPROACH_M, behind_median, corner_m, straight, strips};
use crate::ground::places::{at_line, places};
use crate::ground::way::{Across, Ground, with_way};
use crate::told::crash::Told;
use crate::told::others::Role;
use crate::told::side::Turning;
use crate::usual::LANE_M;
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::scenario::{GraphMap, JunctionSpec, RoadSpec, RoadStart, Strip, StripKind};

impl Told {
    /// Whether a partner that goes the ego's way is told to have come into the junction, and the ego drives: both are in it.
    pub(super) fn is_followed_in(&self) -> bool {
        let along = matches!(self.origin, Origin::Behind | Origin::Ahead | Origin::Beside { .. });
        !self.plainly && along && self.cp.enters() && self.sv.state == ContactState::Moving
    }
}

/// A junction as it is drawn.
struct Drawn<'a> {
    told: &'a Told,
    arms: Arms,
    /// What lies beside the lanes of the partner's road, on both sides of the junction, and beside those of the other one.
    beside: Vec<StripKind>,
    usual: &'static [StripKind],
    /// Whether the partner comes by the crossing road.
    crosses: bool,
    /// Whether nobody comes towards the ego.
    one_sided: bool,
}

/// Four arms; the ego comes along the one that lies behind it.
pub(super) fn junction(told: &Told, crossing: bool) -> Ground {
    let one_way = is_one_way(told);
    let straight_on = told.sv.turning == Turning::No;
    let at_kerb = (told.is_at_kerb() || told.sets_off_at_kerb()) && !crossing && straight_on && !one_way;
    let drawn = Drawn::of(told, at_kerb, one_way);
    let (lanes, cross_lanes) = (drawn.arms.lanes, drawn.arms.cross_lanes);
    let exit_name = drawn.exit_name();
    let across = Across {
        lanes,
        lane: lane(told, lanes, at_kerb, one_way),
        oncoming: if one_way || drawn.one_sided { 0 } else { lanes },
        beside: if drawn.crosses { drawn.usual.to_vec() } else { drawn.beside.clone() },
        cross_lanes,
        lane_m: LANE_M,
    };
    let places = places(told, crossing, at_kerb, lanes);
    let ground = with_way(drawn.map(), vec!["own-".to_owned(), format!("{exit_name}+")], across, places, true);
    let ground = if at_line(told).is_empty() { ground.at_walk(told).in_their_lanes(told) } else { ground };
    let ground = if at_kerb { ground.at_kerb() } else { ground }.over_line(told);
    if told.sv.turned { ground.after_turn() } else { ground }
}

/// The ego's lane, 0 is the leftmost.
fn lane(told: &Told, lanes: usize, at_kerb: bool, one_way: bool) -> usize {
    let usual = || match told.sv.turning {
        Turning::Left => usize::from(told.lets_by_on_left()).min(lanes - 1),
        Turning::No | Turning::Round if !at_kerb => usual_lane(told, lanes, one_way),
        _ => lanes - 1,
    };
    told_lane(told, lanes).unwrap_or_else(usual)
}

/// What usually lies beside the lanes there: aisles cross between stalls, and who is parked needs room for that.
fn usual_strips(told: &Told, aisles: bool, at_kerb: bool) -> &'static [StripKind] {
    let parks = at_kerb
        || told.stands_beside(false)
        || has(told, Role::Kerb)
        || told.extras.iter().any(|extra| extra.between)
        || told.crossed_near && told.cp.state == ContactState::Parked
        || told.leaves_space();
    // Stalls leave no room for more between the arms.
    let stalls = matches!(told.origin, Origin::Stall { .. }) && told.strip().is_none();
    match parks {
        _ if aisles || parks && stalls => &[StripKind::Stalls],
        true => &[StripKind::Parking, StripKind::Sidewalk],
        false => &[StripKind::Sidewalk],
    }
}

impl<'a> Drawn<'a> {
    /// What is drawn for an account.
    fn of(told: &'a Told, at_kerb: bool, one_way: bool) -> Self {
        let lot = told.place.is_lot();
        let aisles = lot && told.layout.off_street.is_none();
        let arms = Arms::of(told, lanes_for(told, if aisles { 1 } else { 2 }));
        let usual = usual_strips(told, aisles, at_kerb);
        let crosses = matches!(told.origin, Origin::Cross { .. });
        // Nobody comes towards an ego that has others parked on its left.
        let alone = one_way && told.sv.turning == Turning::No && !has(told, Role::Oncoming);
        // Nor along a one-way street; with who crosses, or a thing, another way may be meant.
        let told_so = told.keeps_one_way() && told.edge.is_none() && told.thing.is_none() && !crosses;
        Self { told, arms, beside: told.beside_lanes(usual), usual, crosses, one_sided: alone || told_so }
    }

    /// By which arm the ego leaves.
    fn exit(&self) -> &'static str {
        exit(self.told).unwrap_or(AHEAD)
    }

    /// What the road by which the ego leaves is called: a driveway is one into which nobody is told to come.
    fn exit_name(&self) -> &'static str {
        if self.arms.off_street == Some(self.exit()) && !self.crosses { "driveway" } else { self.exit() }
    }

    /// What lies beside the lanes of one of the roads, as of a street.
    fn beside(&self, id: &str) -> &[StripKind] {
        let of_partner = if self.crosses { [LEFT, RIGHT] } else { [OWN, AHEAD] };
        if of_partner.contains(&id) { &self.beside } else { self.usual }
    }

    /// The strips of one of the roads: away from the junction, and towards it.
    fn sides(&self, id: &str) -> (Vec<Strip>, Vec<Strip>) {
        let (told, beside) = (self.told, self.beside(id));
        let off_street = self.arms.off_street == Some(id);
        let lanes = match id {
            _ if off_street => 1,
            OWN | AHEAD => self.arms.lanes,
            _ => self.arms.street,
        };
        let usual = || strips(lanes, if off_street { &[] } else { beside });
        let with_edge = || strips(lanes, &told.beside_edge());
        // What stands at the edge of a road does so where the ego turns into that, else where it comes along.
        match told.edge.filter(|_| id == exit(told).unwrap_or(OWN)) {
            Some(LeftRight::Right) if id == OWN => (usual(), with_edge()),
            Some(LeftRight::Left) if id == OWN => (behind_median(usual()), usual()),
            Some(LeftRight::Right) => (with_edge(), usual()),
            Some(LeftRight::Left) => (usual(), behind_median(usual())),
            None if self.one_sided && id == OWN => (strips(0, beside), usual()),
            None if self.one_sided && id == AHEAD => (usual(), strips(0, beside)),
            None => (usual(), usual()),
        }
    }

    /// One of the roads, from the junction on.
    fn arm(&self, id: &str, bearing_deg: f64) -> RoadSpec {
        let from_m = corner_m(self.arms.lanes);
        let start = RoadStart::Arm { junction: "j".to_owned(), bearing_deg, from_m };
        let (away, towards) = self.sides(id);
        let name = if id == self.exit() { self.exit_name() } else { id };
        straight(name, start, APPROACH_M, away, towards)
    }

    /// The map of all of its roads.
    fn map(&self) -> GraphMap {
        // The first road of a map has lanes in its own direction.
        let along = if self.one_sided { [(AHEAD, 0.0), (OWN, 180.0)] } else { [(OWN, 180.0), (AHEAD, 0.0)] };
        let roads = along.into_iter().chain([(LEFT, 90.0), (RIGHT, 270.0)]);
        let roads = roads.filter(|(id, _)| self.arms.missing != Some(*id));
        // The ego's lane lies on the x axis, or beside it.
        let y_m = (self.arms.lanes as f64 - 0.5) * LANE_M;
        GraphMap {
            roads: roads.map(|(id, bearing_deg)| self.arm(id, bearing_deg)).collect(),
            junctions: vec![JunctionSpec { id: "j".to_owned(), x_m: 0.0, y_m, ends: Vec::new(), u_turns: Vec::new() }],
            areas: Vec::new(),
        }
    }
}
