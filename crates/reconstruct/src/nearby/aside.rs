//! Ways of others near who are beside the lanes, or on a crossing road.

use crate::ground::pieces::corner_m;
use crate::nearby::scene::{DRIVES_MPS, Scene};
use crate::nearby::way::Way;
use crate::told::near::Does;
use crate::usual::TURNS_MPS;
use recrash_model::account::{Act, LeftRight, Origin};
use recrash_model::geometry::Pose;
use recrash_model::scenario::StripKind;

/// Who stands in a lane, and is not told to be ahead, stands so far ahead of the ego there. [m]
pub(super) const STANDS_AHEAD_M: f64 = 12.0;

impl<'a> Scene<'a> {
    /// Backs a little: in the lane towards the ego, where it is told there; else out of where it is parked, or stands.
    pub(super) fn backers(&self, place: Option<Origin>, half_m: f64) -> Vec<Way> {
        let sides = match place {
            Some(Origin::Opposite) => Vec::new(),
            Some(Origin::Stall { side: Some(side) } | Origin::Parked { side: Some(side) }) => vec![side],
            _ => vec![LeftRight::Right, LeftRight::Left],
        };
        let parked = sides.into_iter().flat_map(|side| self.kerb(side, half_m));
        parked.chain(self.waits_opposite(half_m)).map(|way| Way { backs: true, ..way }).collect()
    }

    pub(super) fn stands_beside(&self, side: LeftRight, half_m: f64) -> Vec<Way> {
        self.stands_at(self.beside_m(side, self.until), half_m)
    }

    /// Stands on a line beside the ego's, about where that is at the contact.
    fn stands_at(&self, t_m: f64, half_m: f64) -> Vec<Way> {
        let (s_m, _) = self.at(self.until);
        let inside = |s_m: f64| self.ground.junction && s_m + 2.0 > self.ground.first_m();
        let at_line = self.ground.junction.then(|| self.ground.first_m() - half_m - 2.0);
        let places = [2.0, -6.0, 8.0, 12.0].into_iter().map(|on_m| s_m + on_m).chain(at_line);
        places.filter(|s_m| !inside(*s_m)).map(|s_m| Way::stands(self.road(s_m, t_m))).collect()
    }

    /// The same of one of which nobody tells where it stands: in a lane of the other direction it faces as they do there.
    pub(super) fn stands_somewhere_beside(&self, side: LeftRight, half_m: f64) -> Vec<Way> {
        let t_m = self.beside_m(side, self.until);
        let against = self.is_two_way() && -t_m > self.ground.opposing_m - 0.5 * self.ground.lane_m;
        let turned = if against { std::f64::consts::PI } else { 0.0 };
        let mut ways = self.stands_beside(side, half_m);
        ways.iter_mut().for_each(|way| way.from.heading += turned);
        ways
    }

    /// Stands in a lane, and nobody tells in which: in that to which the ego is on its way, or ahead, or beside; towards the ego last, but
    /// for a partner that comes from there, for which that one may be in the way.
    pub(super) fn stands_somewhere(&self, half_m: f64) -> Vec<Way> {
        let (left, right) = (LeftRight::Left, LeftRight::Right);
        let changes = self.told.sv.acts.iter().any(|doing| doing.act == Act::LaneChange);
        let to = self.told.sv.aside.filter(|_| changes);
        let beside = |side: LeftRight| self.stands_somewhere_beside(side, half_m);
        let mut list = Vec::new();
        if self.told.origin == Origin::Opposite {
            list.extend(self.waits_opposite(half_m));
            list.extend(beside(left));
        }
        list.extend(to.into_iter().flat_map(|side| self.stands_at(self.beside_m(side, 0), half_m)));
        list.extend(self.stands_ahead(half_m, STANDS_AHEAD_M));
        list.extend([right, left].into_iter().flat_map(beside));
        list.extend(self.waits_opposite(half_m));
        list.extend([left, right].into_iter().flat_map(|side| self.crosses(side, Does::Stands, half_m)));
        list
    }

    /// Parked at a kerb, in a stall, or on a shoulder.
    pub(super) fn kerb(&self, side: LeftRight, half_m: f64) -> Vec<Way> {
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

    pub(super) fn crosses(&self, side: LeftRight, does: Does, half_m: f64) -> Vec<Way> {
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
    pub(super) fn turners(&self) -> Vec<Way> {
        let Some(exit) = self.arm(LeftRight::Right, true, 0.0) else { return Vec::new() };
        let begins = self.against(self.ground.first_m() + 2.0 * corner_m(self.ground.lanes) - 6.0);
        let turns = |speed_mps: f64, before_s: f64| {
            let way = Way::straight(begins, speed_mps, (self.contact_s - before_s).max(0.5));
            Way { by: vec![begins, exit], ..way }
        };
        let usual = [4.0, 3.0, 5.5, 7.0, 2.0].map(|before_s| turns(TURNS_MPS, before_s));
        // Before an ego that has set off at green just now.
        let faster = [2.5, 2.0, 3.0].map(|before_s| turns(DRIVES_MPS, before_s));
        usual.into_iter().chain(faster).collect()
    }
}
