//! Told lanes, held against where somebody is.

use crate::facts::astride::LEAST_M;
use crate::told::crash::Told;
use crate::told::layout;
use recrash_model::account::{Astride, AstrideWhen, LaneLine, LaneWord};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::ActorTrack;
use recrash_model::scenario::StripKind;
use recrash_roads::{RoadNetwork, RoadPart, Scenario};

/// Who is in a lane, and in no other one besides, is no farther beside the middle of it. [m]
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

/// Whether somebody begins in the told lane of its road; on the opposite side it is when they touch, and who is told to be partly in it where it
/// stands may be so there. Where both are told to be in a lane for the same turn, side by side, there are two.
pub(super) fn lane(
    (told, word): (&Told, LaneWord),
    scenario: &Scenario,
    [ego, track]: [&ActorTrack; 2],
    time_s: f64,
) -> (CheckResult, String) {
    let until = track.step_at(time_s);
    // Who is told to be on the opposite side went there, or comes from there into its own.
    let at = if word == LaneWord::Opposing && !told.leaves_opposite() { until } else { 0 };
    let over = if ego.id == track.id { told.sv.astride } else { told.cp.astride };
    let is_at = |at: usize, when: AstrideWhen| {
        lane_at((told, word), scenario, [ego, track], (at, over.filter(|over| over.when == when)))
    };
    let found = is_at(at, AstrideWhen::Start);
    let stop = (0..=until).rfind(|step| track.states[*step].stands());
    let stood = stop.map(|stop| is_at(stop, AstrideWhen::Stop));
    let partly = over.is_some_and(|over| over.when == AstrideWhen::Stop) && found.0 == CheckResult::NotShown;
    stood.filter(|stood| partly && stood.0 == CheckResult::Shown).unwrap_or(found)
}

/// The same, in this step, of who is told to be over a line then.
fn lane_at(
    (told, word): (&Told, LaneWord),
    scenario: &Scenario,
    [ego, track]: [&ActorTrack; 2],
    (at, over): (usize, Option<Astride>),
) -> (CheckResult, String) {
    let network = scenario.network();
    let first = &track.states[at];
    let Some(id) = network.lane_at(first.position(), first.heading) else {
        return (CheckResult::NotShown, "on no lane".to_owned());
    };
    let road = network.road(network.lane(id).road);
    if let Some(strip) = layout::strip_of(word) {
        return on_strip(network, road.part, (word, strip));
    }
    let lanes = &road.lanes;
    let number = lanes.iter().position(|lane| *lane == id).unwrap_or(0);
    let way = network.lane(id);
    let (s_m, t_m) = way.local(first.position());
    let against = math::wrap_angle(way.heading(s_m) - first.heading).abs() > math::FRAC_PI_2;
    let of_ego = ego.id == track.id;
    let most_m = match track.kind != PartnerKind::FixedObject {
        _ if over.is_some() => 0.5 * way.width_at(s_m),
        // Who is narrow may be anywhere in it.
        true => KEEPS_M.max(0.5 * (way.width_at(s_m) - track.width_m)),
        false => way.width_at(s_m),
    };
    if word != LaneWord::Opposing && (against || t_m.abs() > most_m) {
        let how = if against { "against its direction" } else { "beside its middle" };
        return (CheckResult::NotShown, format!("lane {} of {}, {how}", number + 1, lanes.len()));
    }
    let beside = matches!(road.part, RoadPart::Beside(_));
    if word == LaneWord::Bus && !beside {
        return (CheckResult::CannotBeShown, "no such lane is drawn".to_owned());
    }
    let last = lanes.len() - 1;
    let is = |number: usize| is_told(told, word, of_ego, (number, last));
    // Who is told partly in two is in that one, too, into which its body reaches.
    let by_m = t_m.abs() + 0.5 * track.width_m - 0.5 * way.width_at(s_m);
    let reaches = over.is_some_and(|over| over.line == LaneLine::Lanes) && by_m >= LEAST_M;
    let next = if t_m > 0.0 { Some(number + 1).filter(|next| *next <= last) } else { number.checked_sub(1) };
    let shown = match word {
        // Beside the driving lanes.
        _ if beside => false,
        LaneWord::Opposing => {
            // Of who came over from its own side: the ego's.
            let own = if told.comes_over && !of_ego { first.heading } else { ego.states[0].heading };
            let heading = network.lane(id).heading(0.0) - own;
            math::wrap_angle(heading).abs() > math::FRAC_PI_2
        }
        _ => is(number) || next.filter(|_| reaches).is_some_and(is),
    };
    let result = if shown { CheckResult::Shown } else { CheckResult::NotShown };
    (result, format!("lane {} of {}, from the left", number + 1, lanes.len()))
}

/// The same of what lies beside the driving lanes.
fn on_strip(network: &RoadNetwork, part: RoadPart, (word, strip): (LaneWord, StripKind)) -> (CheckResult, String) {
    match is_on(network, part, strip) {
        None => (CheckResult::CannotBeShown, "no such lane is drawn".to_owned()),
        Some(true) => (CheckResult::Shown, lane_words(word).to_owned()),
        Some(false) => (CheckResult::NotShown, "in another lane".to_owned()),
    }
}

/// Whether a driving lane is the told one; of its number and the last one's, 0 is the leftmost.
fn is_told(told: &Told, word: LaneWord, of_ego: bool, (number, last): (usize, usize)) -> bool {
    let turn_lanes = if told.turns_abreast() { 2 } else { 1 };
    // A count tells more than the word for the lane.
    let driving = matches!(word, LaneWord::Left | LaneWord::Center | LaneWord::Right);
    if let Some(counted) = told.counted(of_ego).filter(|_| driving) {
        return counted.place(last + 1) == Some(number);
    }
    match word {
        LaneWord::Left if of_ego && told.layout.turn_lane => number == 1,
        LaneWord::Left => number == 0,
        LaneWord::Right if told.layout.right_lane => number + 1 == last,
        LaneWord::Right => number == last,
        LaneWord::LeftTurn => number < turn_lanes,
        LaneWord::RightTurn => number + turn_lanes > last,
        LaneWord::Center => number > 0 && number < last,
        _ => false,
    }
}

/// Whether a road of this part is the told strip; nothing where no such strip is drawn anywhere.
fn is_on(network: &RoadNetwork, part: RoadPart, strip: StripKind) -> Option<bool> {
    let drawn = network.roads.iter().any(|road| road.part == RoadPart::Beside(strip));
    drawn.then_some(part == RoadPart::Beside(strip))
}
