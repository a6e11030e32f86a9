//! Ways of others near who turn at a junction, come out of where they are parked, set off, or come across the road.

use crate::ground::pieces::corner_m;
use crate::nearby::scene::{DRIVES_MPS, RIDES_MPS, Scene};
use crate::nearby::way::{GOES_MPS, LEADS_MPS, Way};
use crate::others::stand::stands;
use crate::told::near::{First, Near};
use crate::usual::{LANE_M, SLIDES_MPS, TURNS_MPS, WALKS_MPS};
use recrash_model::account::{Kind, KindGroup, LeftRight, Origin};
use recrash_model::geometry::{Pose, Vec2};

/// Who stood ahead sets off so long before the ego does. [s]
const EARLIER_S: f64 = 0.8;

/// A thing that begins to move takes so long more for its way. [s]
const GAINS_S: f64 = 0.7;

/// Who comes across waits so far beyond the lanes. [m]
const BEYOND_M: f64 = 0.9;

impl Scene<'_> {
    /// Through the junction, from the arm where it is told, into the one to which it turns.
    pub(super) fn turning(&self, from: Option<Origin>, side: Option<LeftRight>) -> Vec<Way> {
        if !self.ground.junction {
            return Vec::new();
        }
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let (line_m, over_m) = (self.ground.first_m(), 2.0 * corner_m(self.ground.lanes));
        let sides = side.map_or(vec![right, left], |side| vec![side]);
        let arms = match from {
            Some(from @ (Origin::Opposite | Origin::Cross { .. } | Origin::Ahead)) => vec![from],
            Some(Origin::Beside { .. }) => vec![Origin::Ahead],
            _ => vec![Origin::Cross { side: left }, Origin::Cross { side: right }, Origin::Opposite, Origin::Ahead],
        };
        let mut list = Vec::new();
        for (from, to) in arms.into_iter().flat_map(|from| sides.iter().map(move |side| (from, *side))) {
            let ways = match (from, to) {
                (Origin::Opposite, to) => (Some(self.against(line_m + over_m)), self.arm(to.other(), true, 0.0)),
                (Origin::Cross { side }, to) => {
                    let on = (side == left) == (to == left);
                    let exit = if on { self.road(line_m + over_m, 0.0) } else { self.against(line_m) };
                    (self.arm(side, false, 0.0), Some(exit))
                }
                (_, to) => (Some(self.road(line_m, 0.0)), self.arm(to, true, 0.0)),
            };
            let (Some(enters), Some(exit)) = ways else { continue };
            for before_s in [2.5, 4.0, 1.5, 5.5, 7.0] {
                let way = Way::straight(enters, TURNS_MPS, (self.contact_s - before_s).max(0.5));
                list.push(Way { by: vec![enters, exit], ..way });
            }
        }
        list
    }

    /// Out of where it is parked, into the lane beside that.
    pub(super) fn pulling_out(&self, from: Option<Origin>, half_m: f64) -> Vec<Way> {
        let sides = match from {
            Some(Origin::Beside { side } | Origin::Parked { side: Some(side) }) => vec![side],
            _ => vec![LeftRight::Right, LeftRight::Left],
        };
        let mut list = Vec::new();
        for side in sides {
            for way in self.kerb(side, half_m) {
                // To its own left on the right side of the road, and on the left one of a road with two ways.
                let shifts_m = if side == LeftRight::Right || self.is_two_way() { -0.8 * LANE_M } else { 0.8 * LANE_M };
                for before_s in [3.5, 5.0, 2.5] {
                    let sets_off = Some(((self.contact_s - before_s).max(0.2), GOES_MPS));
                    list.push(Way { sets_off, shifts_m, ..Way::stands(way.from) });
                }
            }
        }
        list
    }

    /// Whether the ego stands first, and drives on then: who goes on ahead stood there too.
    pub(super) fn ego_moves_off(&self) -> bool {
        stands(self.ego, self.until).first().is_some_and(|(from, to)| *from == 0 && *to < self.until)
    }

    /// Ahead of the ego: it stands there, and sets off before the ego does.
    pub(super) fn setting_off(&self, half_m: f64) -> Vec<Way> {
        let stood = stands(self.ego, self.until);
        let ends = stood.iter().map(|(_, to)| 0.1 * *to as f64 - EARLIER_S);
        let mut times: Vec<f64> = ends.chain([1.5, 3.0].map(|before_s| self.contact_s - before_s)).collect();
        times.retain(|at_s| *at_s > 0.2);
        // In the lane, along the ego's way, or straight ahead of it.
        let ahead = |step: usize| {
            let (s_m, t_m) = self.at(step);
            let ego = self.ego.states[step].pose();
            [2.5, 4.0, 6.0].into_iter().flat_map(move |on_m| {
                let on_m = self.front_m() + half_m + on_m;
                let straight = Pose { position: ego.position + Vec2::from_heading(ego.heading) * on_m, ..ego };
                [self.ground.pose(s_m + on_m, 0.0), self.ground.pose(s_m + on_m, t_m), straight]
            })
        };
        let steps = stood.iter().rev().map(|(from, _)| *from);
        let froms: Vec<Pose> = if stood.is_empty() {
            self.stands_ahead(half_m, 0.0).into_iter().map(|way| way.from).collect()
        } else {
            steps.flat_map(ahead).collect()
        };
        let off = |at_s: f64| {
            let goes = move |from: &Pose| Way { sets_off: Some((at_s, LEADS_MPS)), ..Way::stands(*from) };
            froms.iter().map(goes).collect::<Vec<_>>()
        };
        times.into_iter().flat_map(off).collect()
    }

    /// Where somebody stands: who is told to have come along comes there.
    pub(super) fn comes_or_stands(&self, near: Near, places: Vec<Way>) -> Vec<Way> {
        match near.first {
            First::Came => places.iter().map(|way| self.coming_to(way)).collect(),
            _ => places,
        }
    }

    /// From beyond the lanes of one side to those of the other: it is in them at the contact, or has crossed them. A thing lies at their edge
    /// until somebody throws it, or loses it.
    pub(super) fn coming_across(&self, kind: Kind, side: LeftRight) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let [left_m, right_m] = self.ground.lane_edges_m;
        let (edge_m, other_m, sign) = match side {
            LeftRight::Left => (left_m, right_m, -1.0),
            LeftRight::Right => (right_m, left_m, 1.0),
        };
        let speed_mps = own_mps(kind);
        let ends_m = [edge_m - 1.5, 0.5, -other_m - BEYOND_M];
        let far = [8.0, 13.0, 20.0, 28.0, -9.0, -16.0];
        let way = |on_m: f64, end_m: f64| {
            let way_m = edge_m + BEYOND_M - end_m;
            let line = self.road(s_m + on_m, sign * (edge_m + BEYOND_M));
            let from = Pose { heading: line.heading + 0.5 * std::f64::consts::PI * sign, ..line };
            let begins_s = self.contact_s - way_m / speed_mps;
            (begins_s > 0.0).then(|| match kind.group() {
                KindGroup::Object => {
                    let sets_off = Some(((begins_s - GAINS_S).max(0.2), speed_mps));
                    Way { sets_off, ..Way::stands(from) }
                }
                _ => Way::straight(from, speed_mps, begins_s),
            })
        };
        far.into_iter().flat_map(|on_m| ends_m.map(|end_m| way(on_m, end_m))).flatten().collect()
    }

    /// Across the ego's way, ahead of where it stands or slows.
    pub(super) fn crossing(&self, kind: Kind, side: LeftRight) -> Vec<Way> {
        let sign = -side.sign();
        let mut steps: Vec<usize> = stands(self.ego, self.until).into_iter().map(|(from, _)| from).collect();
        steps.push(self.until);
        let mut list = Vec::new();
        for step in steps {
            let ego = self.ego.states[step].pose();
            for on_m in [3.0, 2.0, 4.5, 6.5] {
                let met = ego.position + Vec2::from_heading(ego.heading) * (self.front_m() + on_m);
                let at = Pose { position: met, heading: ego.heading + 0.5 * std::f64::consts::PI * sign };
                for on_s in [0.0, 0.8, 1.6, -1.0] {
                    let at_s = (0.1 * step as f64 + on_s).clamp(0.5, self.contact_s - 0.3);
                    list.push(Way::straight(at, own_mps(kind), at_s));
                }
            }
        }
        list
    }
}

/// How fast somebody comes across who is no vehicle.
fn own_mps(kind: Kind) -> f64 {
    match kind.group() {
        KindGroup::OnFoot => WALKS_MPS,
        KindGroup::Cyclist => RIDES_MPS,
        KindGroup::Animal | KindGroup::Object => SLIDES_MPS,
        _ => DRIVES_MPS,
    }
}
