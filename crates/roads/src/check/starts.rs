//! Where on its way a partner begins: relative to the ego, or by when it reaches the place where their ways meet.

use super::names::{TURNS, approach_name, turn_name};
use super::remarks::{Remarks, shown};
use crate::conflict::Conflict;
use crate::network::{RoadNetwork, RoadPart};
use crate::path::LanePath;
use crate::scenario::Placement;
use recrash_model::geometry::OrientedBox;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{Approach, MapKind, MapSpec, Partner, ScenarioDraft, Start, Turn};
use recrash_model::vehicle::VehicleSpec;

/// Somebody on foot may start this far from where its way meets the ego's: beside the ego's lane. [m]
const STEP_OUT_M: f64 = 3.0;

/// Room in a bend is looked for in steps of this, up to so many of them. [m]
const ROOM_STEP_M: f64 = 0.05;
const MOST_ROOM_STEPS: u32 = 20;

/// The longest arm a map may have. [m]
const LONGEST_ARM_M: f64 = 300.0;

/// A partner, the way it takes, and the ego it meets.
pub(super) struct Entry<'a> {
    pub(super) draft: &'a ScenarioDraft,
    pub(super) partner: &'a Partner,
    /// JSON path of the partner.
    pub(super) path: &'a str,
    pub(super) network: &'a RoadNetwork,
    pub(super) ego: &'a Placement,
    pub(super) way: &'a LanePath,
}

/// When the ego is where the ways meet, and how fast the partner goes there.
struct Meeting<'a> {
    conflict: &'a Conflict,
    /// Time that the ego needs. [s]
    ego_s: f64,
    /// Speed of the partner. [m/s]
    speed_mps: f64,
}

impl Entry<'_> {
    /// Where it begins: along its way, and to the right of its lane's centre. [m]
    pub(super) fn start(&self, conflict: Option<&Conflict>, remarks: &mut Remarks) -> Option<(f64, f64)> {
        match self.partner.start {
            Start::Offset { delta_s_m, delta_t_m } => Some((self.offset_start(delta_s_m, remarks)?, delta_t_m)),
            Start::ArrivalGap { arrival_gap_s } => {
                let s = self.timed_start(conflict, arrival_gap_s, remarks)?;
                Some((s, room_in_bend(self.network, self.way, self.partner.kind, s)))
            }
        }
    }

    /// The start given relative to the ego. [m]
    fn offset_start(&self, delta_s_m: f64, remarks: &mut Remarks) -> Option<f64> {
        let Some((s, last)) = self.beside_ego(self.draft.ego.s_m + delta_s_m) else {
            let message = format!(
                "delta_s_m counts along the ego's own road, but the partner comes from \"{}\"",
                approach_name(self.partner.approach)
            );
            let hint = "use start: {\"arrival_gap_s\": seconds} (0 is a collision course), \
                        or approach \"same\" or \"opposite\"";
            remarks.error("scenario.start-form", format!("{}.start", self.path), message, hint);
            return None;
        };
        let first = first_place(self.network, self.way, self.partner.kind);
        // A hair outside is rounding.
        if s < first - 1e-9 || s > last + 1e-9 {
            let (least, most) = match self.partner.approach {
                Approach::Opposite => (delta_s_m + s - last, delta_s_m + s - first),
                _ => (delta_s_m - s + first, delta_s_m - s + last),
            };
            let message = format!(
                "{} m {} the ego is no place on the partner's way",
                shown(delta_s_m.abs()),
                if delta_s_m < 0.0 { "behind" } else { "ahead of" }
            );
            let (least, most) = (shown(round_up(least)), shown(round_down(most)));
            let hint = format!("allowed: delta_s_m from {least} to {most} m, or a longer map");
            remarks.error("scenario.start-off-road", format!("{}.start.delta_s_m", self.path), message, hint);
            return None;
        }
        Some(s.clamp(first, last))
    }

    /// Where on the partner's way a place along the ego's road lies, and the last place it may start at; `None` from where the ego's
    /// road does not lead. [m]
    fn beside_ego(&self, along: f64) -> Option<(f64, f64)> {
        let (way, ego) = (self.way, self.ego);
        match self.partner.approach {
            Approach::Same => {
                // Lanes of one approach are equally long; behind it, beside the ego's own way, as far as that is the same.
                let beside = along > self.draft.map.carriageway().approach_m && way.roads == ego.path.roads;
                let s = if beside && along <= ego.path.length_m {
                    way.project(ego.path.pose(along, 0.0).position, 0).s
                } else {
                    along
                };
                Some((s, way.length_m))
            }
            Approach::Opposite if self.draft.map.kind() == MapKind::Road => {
                let beside = ego.path.pose(along, 0.0).position;
                Some((way.project(beside, 0).s, way.length_m))
            }
            // The arm ahead lies in line with the approach: there the distance is that along the x axis.
            Approach::Opposite => Some((way.pose(0.0, 0.0).position.x - along, arm_length(self.network, way))),
            Approach::Left | Approach::Right | Approach::Ring => None,
        }
    }

    /// The start given by when it reaches the conflict. [m]
    fn timed_start(&self, conflict: Option<&Conflict>, arrival_gap_s: f64, remarks: &mut Remarks) -> Option<f64> {
        let meeting = self.meeting(conflict, remarks)?;
        let Meeting { conflict, ego_s, speed_mps } = meeting;
        let s = conflict.s_b - speed_mps * (ego_s + arrival_gap_s);
        let arm = match self.partner.kind {
            // People and animals step onto the road anywhere: for them the arm ends right beside the ego's lane.
            PartnerKind::Pedestrian | PartnerKind::OtherNonMotorist | PartnerKind::Animal => conflict.s_b - STEP_OUT_M,
            _ => arm_length(self.network, self.way).min(conflict.s_b),
        };
        let first = first_place(self.network, self.way, self.partner.kind).min(arm);
        if (first..=arm).contains(&s) {
            return Some(s);
        }
        let message = format!(
            "to reach the conflict {} s {} the ego (which needs {} s) at {} m/s, the partner would have to start {}",
            shown(arrival_gap_s.abs()),
            if arrival_gap_s < 0.0 { "before" } else { "after" },
            shown(ego_s),
            shown(speed_mps),
            if s < first {
                format!("{} m before the first place on its arm that has room for all of it", shown(first - s))
            } else {
                format!("{} m behind the end of its arm", shown(s - arm))
            }
        );
        let hint = self.other_gaps(&meeting, s, (first, arm));
        remarks.error("scenario.arrival-gap", format!("{}.start.arrival_gap_s", self.path), message, hint);
        None
    }

    /// The meeting that a start by time is counted from; `None` where one of the two never comes there.
    fn meeting<'b>(&self, conflict: Option<&'b Conflict>, remarks: &mut Remarks) -> Option<Meeting<'b>> {
        let (draft, partner) = (self.draft, self.partner);
        let at = || format!("{}.start.arrival_gap_s", self.path);
        let Some(conflict) = conflict else {
            let message = format!(
                "the way of a partner from \"{}\" turning {} never meets the ego's ({}), so there is no arrival to time",
                approach_name(partner.approach),
                turn_name(partner.turn),
                turn_name(draft.ego.turn)
            );
            let hint = match partner.approach {
                Approach::Same | Approach::Opposite => {
                    "use start: {\"delta_s_m\", \"delta_t_m\"} relative to the ego, or another turn".to_owned()
                }
                _ => format!(
                    "choose a turn that crosses the ego's way or merges with it; these do: {}",
                    meeting_turns(partner, self.network, self.ego)
                ),
            };
            remarks.error("scenario.no-conflict", at(), message, hint);
            return None;
        };
        let speed_mps = partner.policy.target_speed();
        if speed_mps < 0.1 {
            let message = "the partner wants to stand still, so it never arrives";
            let hint = "give the policy a target speed, or place the partner with delta_s_m";
            remarks.error("scenario.no-arrival", at(), message, hint);
            return None;
        }
        let ego_s = (conflict.s_a - draft.ego.s_m) / draft.ego.target_speed_mps;
        if ego_s <= 0.0 {
            let behind = shown(draft.ego.s_m - conflict.s_a);
            let message = format!("the ego starts {behind} m behind the place of the conflict");
            let hint = format!("allowed: ego.s_m below {} m", shown(conflict.s_a));
            remarks.error("scenario.no-arrival", "ego.s_m", message, hint);
            return None;
        }
        Some(Meeting { conflict, ego_s, speed_mps })
    }

    /// What to do about a start at `s` that lies off the places from `first` to the end of its arm.
    fn other_gaps(&self, meeting: &Meeting<'_>, s: f64, (first, arm): (f64, f64)) -> String {
        let gap_from = |place: f64| (meeting.conflict.s_b - place) / meeting.speed_mps - meeting.ego_s;
        let (earliest, latest) = (shown(round_up(gap_from(arm))), shown(round_down(gap_from(first))));
        let allowed = format!("allowed: arrival_gap_s from {earliest} to {latest} s");
        if s < first {
            let of_arms = matches!(self.partner.approach, Approach::Left | Approach::Right | Approach::Opposite);
            let arm_m = match &self.draft.map {
                MapSpec::X(map) => Some(map.arm_m),
                MapSpec::T(map) => Some(map.arm_m),
                MapSpec::O(map) => Some(map.arm_m),
                _ => None,
            };
            match arm_m.filter(|_| of_arms).map(|arm_m| (arm_m + first - s).ceil()) {
                Some(needed) if needed <= LONGEST_ARM_M => format!("{allowed}, or map.arm_m of {} m", shown(needed)),
                _ => allowed + ", or a slower partner, or an ego that starts nearer to the conflict",
            }
        } else {
            allowed + ", or a faster partner, or an ego that starts farther from the conflict"
        }
    }
}

/// The first place on its way at which the whole of a road user stands on the road: half of its length, where the way
/// begins at the end of a road. [m]
fn first_place(network: &RoadNetwork, way: &LanePath, kind: PartnerKind) -> f64 {
    let half_m = 0.5 * VehicleSpec::of(kind).length_m;
    if network.on_road(way.pose(-half_m, 0.0).position) { 0.0 } else { half_m }
}

/// How far to the right of its lane's centre a road user starts that comes along a bend: as little to the inside as keeps
/// all of its corners on the road. A long one needs that at the outer edge. [m]
fn room_in_bend(network: &RoadNetwork, way: &LanePath, kind: PartnerKind, s: f64) -> f64 {
    let spec = VehicleSpec::of(kind);
    let inside = -way.curvature(s).signum();
    let fits = |t: f64| {
        let corners = OrientedBox::new(way.pose(s, t), spec.length_m, spec.width_m).corners();
        corners.into_iter().all(|corner| network.on_road(corner))
    };
    if way.curvature(s) == 0.0 {
        return 0.0;
    }
    let steps = (0..=MOST_ROOM_STEPS).map(|step| inside * ROOM_STEP_M * f64::from(step));
    steps.into_iter().find(|t| fits(*t)).unwrap_or(0.0)
}

/// Three decimals upwards, so that the number in a hint is itself allowed.
fn round_up(value: f64) -> f64 {
    (value * 1000.0).ceil() / 1000.0
}

/// Three decimals downwards.
fn round_down(value: f64) -> f64 {
    (value * 1000.0).floor() / 1000.0
}

/// Length of the part of a way on which a partner may start: its arm, on the ring up to the ego's entry, on a road
/// without a junction all of it. [m]
fn arm_length(network: &RoadNetwork, way: &LanePath) -> f64 {
    if network.map.kind() == MapKind::Road {
        return way.length_m;
    }
    let on_ring = network.road(way.roads[0]).part == RoadPart::Ring;
    let leaves = |position: usize| {
        let road = network.road(way.roads[position]);
        if on_ring { road.from == "1O0_0_" } else { !matches!(road.part, RoadPart::Approach | RoadPart::ArmIn) }
    };
    (0..way.roads.len()).find(|position| leaves(*position)).map_or(way.length_m, |end| way.segments[end].start_m)
}

/// The turns of a partner whose way meets the ego's, for a message.
fn meeting_turns(partner: &Partner, network: &RoadNetwork, ego: &Placement) -> String {
    let width = VehicleSpec::of(PartnerKind::PassengerCar).width_m;
    let other_width = VehicleSpec::of(partner.kind).width_m;
    let meets = |turn: Turn| {
        let route = network.route(partner.approach, turn)?;
        let lanes = network.road(route[0]).lanes.len();
        (0..lanes).find(|lane| {
            let lane = u8::try_from(*lane).unwrap_or(0);
            ego.path.conflict(&LanePath::new(network, route.clone(), lane), width, other_width).is_some()
        })
    };
    let found: Vec<&str> = TURNS.iter().filter(|(turn, _)| meets(*turn).is_some()).map(|(_, name)| *name).collect();
    if found.is_empty() { "none from there".to_owned() } else { found.join(", ") }
}
