//! How well a way of touching fits what is told, beside the zones that meet.

use crate::ground::way::Ground;
use crate::told::crash::Told;
use crate::told::doing::Doing;
use crate::told::side::{Side, Turning, size_of};
use crate::told::zones::side_of;
use crate::touch::boxes::velocity;
use crate::touch::lanes::turn_m;
use crate::usual::{LANE_M, NARROW_M};
use recrash_model::account::{ContactState, CrashType, Origin, Striker};
use recrash_model::geometry::{Pose, Vec2};
use recrash_model::math;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;

/// Whether two that touch do so with a front on a rear, and not along a flank: seen along the ego they overlap less than across it.
pub(super) fn is_face_on(told: &Told, sv: Pose, cp: Pose) -> bool {
    let ((sv_length, sv_width), (cp_length, cp_width)) = (size_of(&told.sv), size_of(&told.cp));
    let (ahead, way) = (Vec2::from_heading(sv.heading), cp.position - sv.position);
    let turn = cp.heading - sv.heading;
    let (cos, sin) = (math::cos(turn).abs(), math::sin(turn).abs());
    let along_m = 0.5 * (sv_length + cos * cp_length + sin * cp_width) - way.dot(ahead).abs();
    let across_m = 0.5 * (sv_width + cos * cp_width + sin * cp_length) - ahead.cross(way).abs();
    along_m < across_m
}

/// Who is nearer to the middle of the road than this counts as on its right side. [m]
const RIGHT_SIDE_M: f64 = 1.8;

/// How far beside the ego's line somebody came along that turned to this pose. [m]
pub(super) fn aside_before_m(told: &Told, sv: Pose, cp: Pose, came: f64) -> f64 {
    let turn = math::wrap_angle(cp.heading - came);
    (cp.position.y - turn.signum() * turn_m(told) * (1.0 - math::cos(turn)) - sv.position.y).abs()
}

impl Told {
    /// Whether the partner turns across the ego's way from the lane beside it.
    pub(super) fn turns_from_beside(&self) -> bool {
        matches!(self.origin, Origin::Beside { .. }) && matches!(self.cp.turning, Turning::Left | Turning::Right)
    }

    /// Whether the front of the one who is told to have been struck meets a flank of the one who is told to have struck it.
    pub(super) fn is_struck_otherwise(&self, (sv_seen, cp_seen): (ContactZone, ContactZone)) -> bool {
        let flank = |zone: ContactZone| matches!(zone, ContactZone::Left | ContactZone::Right) || zone.is_rear();
        let drives = |side: &Side| side.state == ContactState::Moving;
        match self.striker {
            _ if self.thing.is_some() => false,
            Some(Striker::Cp) if drives(&self.cp) && self.cp.zones.is_empty() => sv_seen.is_front() && flank(cp_seen),
            Some(Striker::Sv) if drives(&self.sv) && self.sv.zones.is_empty() => cp_seen.is_front() && flank(sv_seen),
            _ => false,
        }
    }

    /// Whether of two that drive on beside each other, of whom the partner leaves its lane, the one comes to the other who is not told to have
    /// struck it.
    pub(super) fn strikes_otherwise(&self, (sv, cp): (Pose, Pose)) -> bool {
        let drives = |side: &Side| side.state == ContactState::Moving && side.turning == Turning::No;
        let beside = self.crash_type == CrashType::Lateral && matches!(self.origin, Origin::Beside { .. });
        // Across the road.
        let to_cp = (cp.position.y - sv.position.y).signum();
        let comes = |side: &Side, pose: Pose| velocity(side, pose.heading).y * to_cp;
        let (sv_mps, cp_mps) = (comes(&self.sv, sv), -comes(&self.cp, cp));
        let other = match self.striker {
            Some(Striker::Cp) => sv_mps > cp_mps,
            Some(Striker::Sv) => cp_mps > sv_mps,
            _ => false,
        };
        beside && self.leaves_its_lane() && drives(&self.sv) && drives(&self.cp) && other
    }

    /// Whether the partner is told to pass; or to have begun to, or come by, and to touch with its flank or its rear.
    pub(super) fn rubs_by(&self) -> bool {
        let flank = |zone: &ContactZone| zone.is_rear() || matches!(zone, ContactZone::Left | ContactZone::Right);
        let told = !self.cp.zones.is_empty() && self.cp.zones.iter().all(flank) && !self.goes_out();
        let passes = |doing: &Doing| doing.is_pass() || told && doing.is_begun_pass();
        let comes_by = self.cp.movement == Some(Movement::Passing) && self.sv.state.stands();
        self.cp.acts.iter().any(passes) || told && comes_by && self.origin != Origin::Opposite
    }

    /// Whether the partner comes behind an ego that turns, by the same way.
    pub(super) fn turns_behind(&self) -> bool {
        let turns = match self.sv.turning {
            Turning::Left => Movement::LeftTurn,
            Turning::Right => Movement::RightTurn,
            Turning::No | Turning::Round => return false,
        };
        // Behind an ego that has turned it goes straight on again.
        let over = self.sv.turned || self.sv.state.stands();
        // Nor has who stood behind it another way at once.
        let stood = self.cp.stood_first || self.cp.state == ContactState::SettingOff;
        let over = over || stood && self.crash_type == CrashType::FrontToRear;
        let same = self.cp.movement.is_none_or(|movement| movement == turns || over && movement == Movement::Straight);
        let moves = matches!(self.cp.state, ContactState::Moving | ContactState::SettingOff);
        same && moves && self.origin == Origin::Behind && self.thing.is_none() && self.rig.is_none()
    }

    /// Whether a partner that is told to go the wrong way along a crossing road is on the side of it where its way is the right one.
    pub(super) fn goes_right_way(&self, cp: Pose) -> bool {
        let wrong_way = self.cp.movement == Some(Movement::WrongWay);
        matches!(self.origin, Origin::Cross { side } if wrong_way && side.sign() * cp.position.x < RIGHT_SIDE_M)
    }

    /// Whether a partner that has a signal or a sign on the crossing road, and goes straight on, is beside the lanes that lead there.
    pub(super) fn crosses_off_lanes(&self, ground: &Ground, cp: Pose) -> bool {
        let own_way =
            !self.crosses_at_walk() && !matches!(self.cp.movement, Some(Movement::WrongWay | Movement::Backing));
        let straight = self.cp.turning == Turning::No && self.cp.state != ContactState::Reversing && own_way;
        let lanes_m = ground.cross_lanes as f64 * LANE_M;
        let told = straight && self.cp.control.is_some() && ground.junction;
        matches!(self.origin, Origin::Cross { side } if told && !(0.0..=lanes_m).contains(&(-side.sign() * cp.position.x)))
    }

    /// Whether the partner drives straight on behind an ego that leaves its lane.
    pub(super) fn keeps_straight_behind(&self) -> bool {
        let drives = |side: &Side| side.state == ContactState::Moving && side.turning == Turning::No;
        let straight = self.cp.movement.is_none_or(|movement| movement == Movement::Straight) && !self.cp.dodges;
        self.origin == Origin::Behind && drives(&self.sv) && drives(&self.cp) && straight && self.sv_aside().is_some()
    }

    /// Whether somebody narrow passes the ego from behind: it comes by beside that.
    pub(super) fn passes_narrow(&self) -> bool {
        let passes = self.cp.movement == Some(Movement::Passing) || self.rubs_by();
        let narrow = size_of(&self.cp).1 < NARROW_M && self.comes_along_lanes();
        narrow && passes && self.origin == Origin::Behind && side_of(&self.sv.zones).is_some()
    }

    /// Whether they rub along each other: a flank takes part, and it is not the front of the one on the rear of the other. An oncoming one
    /// does too where a flank of the ego alone is told.
    pub(super) fn scrapes(&self) -> bool {
        let flank = |zone: &ContactZone| matches!(zone, ContactZone::Left | ContactZone::Right);
        let alone = !self.sv.zones.is_empty() && self.sv.zones.iter().all(flank);
        let straight = self.sv.turning == Turning::No && self.cp.turning == Turning::No;
        let meets = self.crash_type == CrashType::HeadOn && self.origin == Origin::Opposite && straight && alone;
        (self.crash_type == CrashType::Lateral || meets) && side_of(&self.sv.zones).is_some()
    }

    /// Whether the front of the one is told to have met the rear of the other, both in one lane.
    pub(super) fn runs_into_rear(&self) -> bool {
        let in_line = matches!(self.origin, Origin::Behind | Origin::Ahead);
        let straight = self.sv.turning == Turning::No && self.cp.turning == Turning::No && self.thing.is_none();
        self.crash_type == CrashType::FrontToRear && in_line && straight
    }

    /// Whether a partner that passes an ego at the kerb would come out from there: it came along the lane.
    pub(super) fn swings_out(&self, ground: &Ground, turned: f64) -> bool {
        self.comes_along_kerb() && self.passes_from_behind() && ground.stands_m > 0.0 && turned > SWINGS_OUT_RAD
    }

    /// Whether a partner of which a column alone tells that it changed lanes, and that touches the ego on a told side, is yet well within the
    /// ego's lane.
    pub(super) fn stays_in_lane(&self, ground: &Ground, cp: Pose) -> bool {
        let changes = matches!(self.cp.movement, Some(Movement::ChangingLanes)) && self.cp.aside.is_none();
        let told =
            self.cp.merges_in || self.cp.changed_lanes || self.cp.passes || self.cp.acts.iter().any(Doing::goes_aside);
        let drives = self.cp.state == ContactState::Moving && self.origin == Origin::Behind;
        let corner = side_of(&self.sv.zones).is_some() && self.sv.turning == Turning::No;
        changes && drives && !told && corner && ground.beside(cp.position).1.abs() < 0.5 * LANE_M - TO_LINE_M
    }

    /// Whether a partner that stood from the start along the road would stand askew, of which nobody tells.
    pub(super) fn stands_askew(&self, cp: Pose) -> bool {
        let along = matches!(self.origin, Origin::Ahead | Origin::Beside { .. }) && self.sv.turning == Turning::No;
        let stood = self.cp.state == ContactState::Stopped && self.cp.stands_from_start && self.cp.slants.is_none();
        along && stood && self.thing.is_none() && !self.diagonal && math::sin(cp.heading).abs() > ASKEW
    }

    /// Whether a partner that is told to stand beside the lanes would stand in one, or askew.
    pub(super) fn is_parked_otherwise(&self, ground: &Ground, cp: Pose) -> bool {
        let askew = math::sin(cp.heading).abs() > ASKEW && !self.diagonal;
        if (self.parks_behind() || self.backs_in_line() && self.is_at_kerb()) && ground.is_in_lanes(cp, 0.0, 0.0) {
            return true;
        }
        self.stands_beside(false) && (askew || ground.is_in_lanes(cp, 0.0, 0.0))
    }
}

/// Who is at the line has its middle no farther from that. [m]
const TO_LINE_M: f64 = 0.3;

/// Who has turned out of the lane by more swings out. [rad]
const SWINGS_OUT_RAD: f64 = 0.02;

/// Sine of the angle to the road at which who is parked along it stands askew.
const ASKEW: f64 = 0.1;

impl Told {
    /// Whether an oncoming partner that drives straight on touches an ego that stands on the ego's side of the road. Nobody tells that it
    /// left its own: it does so late.
    pub(crate) fn is_met_on_wrong_side(&self, ground: &Ground, cp: Pose) -> bool {
        self.is_met_by_oncoming() && cp.position.y < ground.opposing_y_m() - 0.5 * ground.lane_m
    }
}
