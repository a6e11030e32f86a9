//! Told lanes, held against where somebody is.

use crate::told::crash::Told;
use crate::told::layout;
use recrash_model::account::LaneWord;
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::StripKind;
use recrash_roads::{RoadNetwork, RoadPart, Scenario};

/// Who is in a lane is no farther beside the middle of it. [m]
const KEEPS_M: f64 = 0.7;

pub(super) fn lane_words(word: LaneWord) -> &'static str {
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
        LaneWord::Sidewalk => "the sidewalk",
        LaneWord::Opposing => "the opposite side",
    }
}

/// Whether somebody begins in the told lane of its road; on the opposite side it is when they touch. Where both are told to be in a lane
/// for the same turn, side by side, there are two.
pub(super) fn lane(
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
        return (CheckResult::NotShown, "on no lane".to_owned());
    };
    let road = network.road(network.lane(id).road);
    if let Some(strip) = layout::strip_of(word) {
        return match is_on(network, road.part, strip) {
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
    // Who is narrow may be anywhere in it, and so may who is told to stand partly in it.
    let partly = ego.id == track.id && told.is_partly_in_lane();
    let drives = track.kind != PartnerKind::FixedObject && !partly;
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
        LaneWord::Right if told.layout.right_lane => number + 1 == last,
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
        LaneWord::Bike | LaneWord::Bus | LaneWord::Shoulder | LaneWord::Curb | LaneWord::Sidewalk => {
            return (CheckResult::CannotBeShown, "no such lane is drawn".to_owned());
        }
    };
    let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
    (result, format!("lane {} of {}, from the left", number + 1, lanes.len()))
}

/// Whether a road of this part is the told strip; nothing where no such strip is drawn anywhere.
fn is_on(network: &RoadNetwork, part: RoadPart, strip: StripKind) -> Option<bool> {
    let drawn = network.roads.iter().any(|road| road.part == RoadPart::Beside(strip));
    drawn.then_some(part == RoadPart::Beside(strip))
}
