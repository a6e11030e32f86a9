//! Told movements, held against the way that was driven.

use crate::told::doing::Doing;
use crate::told::side::{Side, Turning};
use crate::usual::STANDS_MPS;
use recrash_model::account::{Act, Obeyed};
use recrash_model::geometry::Vec2;
use recrash_model::math;
use recrash_model::metrics::CheckResult;
use recrash_model::rollout::{ActorState, ActorTrack};
use recrash_model::template::Movement;
use recrash_roads::{RoadPart, Scenario};

/// Who changes lanes has left the middle of its own by at least this: the box reaches the next one. [m]
const CHANGED_M: f64 = 0.8;

/// Who leaves its lane, or pulls out or in, has left its line by at least this. [m]
pub(super) const LEFT_LINE_M: f64 = 0.5;

/// Nobody parks faster. [m/s]
const PARKS_MPS: f64 = 5.0;

/// Who passes is faster by this. [m/s]
const FASTER_MPS: f64 = 0.3;

/// And at no more than this to its way, or to the way back. [deg]
const PASSES_DEG: f64 = 60.0;

/// Who has come beside another is beside so much of it. [m]
const BESIDE_M: f64 = 1.0;

/// Who turns has turned by more than this at the contact, or by more where it is to meet the other head-on, or has all but done it;
/// straight on is less than that, and who turns round has turned by more. [deg]
const TURNS_DEG: f64 = 20.0;
const TURNS_WIDE_DEG: f64 = 60.0;
const TURNED_DEG: f64 = 50.0;
const STRAIGHT_DEG: f64 = 50.0;
const ROUND_DEG: f64 = 60.0;

/// Whose turn is over turns by no more in the last half second. [deg]
const TURNS_NO_MORE_DEG: f64 = 5.0;

/// Who has yet to turn has turned to the other side by no more; and by so much to its own where the other one has turned by that. [deg]
const OTHER_WAY_DEG: f64 = 4.0;
const FAR_IN_TURN_DEG: f64 = 30.0;
const BEGUN_DEG: f64 = 8.0;

/// Who goes straight on along a lane, and is not told to have left it, has turned by no more. [deg]
const KEEPS_DEG: f64 = 16.0;

/// Nor has it swung by so much on its way, from one side to the other, nor was it so far beside its line, nor came it back to that by so much.
/// [deg, m]
const SWINGS_DEG: f64 = 25.0;
const KEEPS_M: f64 = 2.2;
const COMES_BACK_M: f64 = 0.8;

/// Who comes towards another faces it by more than this. [rad]
const FACES_RAD: f64 = 2.0;

/// One who moves, and what it meets.
pub(super) struct Way<'a> {
    pub(crate) scenario: &'a Scenario,
    pub(crate) track: &'a ActorTrack,
    /// The other; nothing where it is a thing.
    pub(crate) other: Option<&'a ActorTrack>,
    /// Where the other is at the contact.
    pub(crate) met: ActorState,
    /// Of the contact. [s]
    pub(crate) time_s: f64,
    /// It comes along a lane, and nobody tells that it left that.
    pub(crate) keeps_lane: bool,
    /// Direction of the road that the ego came along. [rad]
    pub(crate) road_rad: f64,
    /// It parks behind one that stands at the kerb.
    pub(crate) parks_at_kerb: bool,
    /// It is told to come along a crossing road.
    pub(crate) crosses: bool,
    /// It is told to have come along before it entered traffic.
    pub(crate) came_along: bool,
}

impl Way<'_> {
    fn until(&self) -> &[ActorState] {
        let step = self.track.step_at(self.time_s);
        &self.track.states[..=step]
    }

    /// How far it has turned until the contact, to the left. [deg]
    fn turned_deg(&self) -> f64 {
        let turned: f64 = self.until().windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading)).sum();
        turned.to_degrees()
    }

    /// How far it had turned at most on its way to the contact, from the farthest right to the farthest left. [deg]
    fn most_turned_deg(&self) -> f64 {
        let [right, left] = self.turned_between_deg();
        left - right
    }

    /// How far it had turned at most, to the right as less than 0, and to the left. [deg]
    fn turned_between_deg(&self) -> [f64; 2] {
        let turns = self.until().windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading));
        let most = |(turned, [right, left]): (f64, [f64; 2]), turn: f64| {
            let turned = turned + turn;
            (turned, [right.min(turned), left.max(turned)])
        };
        turns.fold((0.0, [0.0, 0.0]), most).1.map(f64::to_degrees)
    }

    /// Whether somebody who has yet to turn has not turned to the other side; where whom it follows is far in its turn, it is in it too.
    fn turns_as_told(&self, movement: Movement) -> bool {
        let to_left = match movement {
            Movement::LeftTurn => 1.0,
            Movement::RightTurn => -1.0,
            _ => return true,
        };
        let other = self.other.map_or(0.0, |other| math::wrap_angle(self.met.heading - other.states[0].heading));
        let least_deg = if to_left * other.to_degrees() > FAR_IN_TURN_DEG { BEGUN_DEG } else { -OTHER_WAY_DEG };
        to_left * self.turned_deg() >= least_deg
    }

    /// Whether it has kept its direction in the last half second.
    fn turns_no_more(&self) -> bool {
        let until = self.until();
        let (last, before) = (&until[until.len() - 1], &until[until.len().saturating_sub(6)]);
        math::wrap_angle(last.heading - before.heading).to_degrees().abs() < TURNS_NO_MORE_DEG
    }

    /// Whether it has neither swung nor left its line. Who passes, or gets by somebody that comes towards it, may have gone round.
    fn keeps_line(&self, side: &Side) -> bool {
        let opposite = math::wrap_angle(self.until()[0].heading - self.met.heading).abs() > FACES_RAD;
        let gets_by = opposite || side.acts.iter().any(Doing::is_pass);
        let [right, left] = self.turned_between_deg();
        match gets_by {
            true => left.max(-right) < SWINGS_DEG,
            false => left - right < SWINGS_DEG && self.strays_m() < KEEPS_M && self.comes_back_m() < COMES_BACK_M,
        }
    }

    /// How far it is beside the line that it began on, to the left. [m]
    fn beside_m(&self) -> f64 {
        let (first, last) = (&self.until()[0], &self.until()[self.until().len() - 1]);
        Vec2::from_heading(first.heading).cross(last.position() - first.position())
    }

    /// Whether it is so far beside that line, and how far. [m]
    fn sideways(&self, least_m: f64) -> (bool, String) {
        let beside_m = self.beside_m().abs();
        (beside_m >= least_m, format!("{beside_m:.1} m aside"))
    }

    /// How far it was beside that at most on its way. [m]
    fn strays_m(&self) -> f64 {
        let first = &self.until()[0];
        let beside_m =
            |state: &ActorState| Vec2::from_heading(first.heading).cross(state.position() - first.position());
        self.until().iter().map(|state| beside_m(state).abs()).fold(0.0, f64::max)
    }

    /// How far it came back from there. [m]
    fn comes_back_m(&self) -> f64 {
        self.strays_m() - self.beside_m().abs()
    }

    /// By how much it has come nearer to the other's line, along the road. [m]
    fn comes_nearer_m(&self) -> f64 {
        let road = Vec2::from_heading(self.road_rad);
        let off_m = |state: &ActorState| road.cross(state.position() - self.met.position()).abs();
        off_m(&self.until()[0]) - off_m(&self.until()[self.until().len() - 1])
    }

    /// The angle between it and the road that the ego came along, at the contact. [deg]
    fn slant_deg(&self) -> f64 {
        let last = &self.until()[self.until().len() - 1];
        let along = math::wrap_angle(last.heading - self.road_rad).to_degrees().abs();
        along.min(180.0 - along)
    }

    fn stood(&self) -> bool {
        self.until().iter().any(|state| state.stands())
    }

    fn reversed(&self) -> bool {
        self.until().iter().any(|state| state.speed() < -STANDS_MPS)
    }

    /// Whether it came from behind the other, and is faster, or has come beside it.
    fn passed(&self) -> bool {
        let sets_out = self.until().iter().position(|state| !state.stands()).unwrap_or(0);
        let (first, last) = (&self.until()[sets_out], &self.until()[self.until().len() - 1]);
        let ahead = Vec2::from_heading(last.heading);
        let other = self.other.map_or(self.met, |other| *other.at(sets_out));
        let faster = (last.velocity() - self.met.velocity()).dot(ahead) > FASTER_MPS;
        // A partner that goes another way is not faster along that.
        let angle = math::wrap_angle(last.heading - self.met.heading).to_degrees().abs();
        if self.track.id == "cp" && angle.min(180.0 - angle) > PASSES_DEG {
            return false;
        }
        let half_m = 0.5 * (self.track.length_m + self.other.map_or(0.0, |other| other.length_m));
        let beside = (self.met.position() - last.position()).dot(ahead) < half_m - BESIDE_M;
        (faster || beside) && (other.position() - first.position()).dot(ahead) > 0.0
    }

    /// Whether it goes against the direction of the lane it is on.
    fn against(&self) -> Option<bool> {
        is_against(self.scenario, &self.until()[self.until().len() - 1])
    }

    /// Whether somebody is in no driving lane.
    fn is_off_lanes(&self, state: &ActorState) -> bool {
        let network = self.scenario.network();
        let lane = network.lane_at(state.position(), state.heading);
        lane.is_none_or(|lane| matches!(network.road(network.lane(lane).road).part, RoadPart::Beside(_)))
    }
}

/// Whether somebody faces against the direction of the lane it is on; nothing where it is on none.
pub(crate) fn is_against(scenario: &Scenario, state: &ActorState) -> Option<bool> {
    let network = scenario.network();
    // The lane it is on, whichever way it faces.
    let lanes = [0.0, math::PI].map(|turn| network.lane_at(state.position(), state.heading + turn));
    let [along, against] = lanes;
    let (along, against) = (along?, against?);
    let faces =
        |id| math::wrap_angle(network.lane(id).heading(network.lane(id).local(state.position()).0) - state.heading);
    let (first, second) = (faces(along).abs(), faces(against).abs());
    Some(first > math::FRAC_PI_2 && second > math::FRAC_PI_2)
}

/// Who drives at an angle to the road is at least at this one, and who leaves the kerb or parks has turned by more where it is not
/// aside. [deg]
const SLANTS_DEG: f64 = 15.0;
const ACROSS_DEG: f64 = 60.0;
const BENDS_DEG: f64 = 9.5;

/// Whether a movement is shown, and what is seen; else why it cannot be.
type Seen = Result<(bool, String), &'static str>;

/// What is expected, whether it is shown, and what is seen.
pub(super) fn check(side: &Side, way: &Way<'_>) -> Option<(String, CheckResult, String)> {
    let movement = side.movement?;
    let result = |shown: bool| if shown { CheckResult::Shown } else { CheckResult::NotShown };
    if side.backs_in && matches!(movement, Movement::Backing | Movement::ParkingManeuver) {
        let (shown, observed) = backs_in(way);
        return Some((word(side) + ", towards the kerb", result(shown), observed));
    }
    let (shown, observed) = match seen(side, movement, way) {
        Ok(seen) => seen,
        Err(why) => return Some((word(side), CheckResult::CannotBeShown, why.to_owned())),
    };
    let (dodges, dodged) = way.sideways(LEFT_LINE_M);
    let shown = shown && turns(side, movement, way) && (dodges || !side.dodges);
    let observed = if side.dodges { format!("{observed}, {dodged}") } else { observed };
    let turn = matches!(movement, Movement::LeftTurn | Movement::RightTurn);
    let later = if turn && side.turns_later { ", or yet to begin" } else { "" };
    Some((word(side) + later, result(shown), observed))
}

/// The movement by itself, without the turn or the dodging that is told with it.
fn seen(side: &Side, movement: Movement, way: &Way<'_>) -> Seen {
    Ok(match movement {
        Movement::Stopped | Movement::Parked => stands(side, way),
        Movement::ChangingLanes | Movement::Merging if side.merges_in => {
            let nearer_m = way.comes_nearer_m();
            (nearer_m >= CHANGED_M, format!("{nearer_m:.1} m nearer to the other's line"))
        }
        Movement::ChangingLanes | Movement::Merging | Movement::CrossingIntoOpposingLane => way.sideways(CHANGED_M),
        Movement::LaneDeparture => way.sideways(LEFT_LINE_M),
        Movement::Passing => return passes(side, way),
        Movement::Backing => backs(side, way),
        Movement::EnteringTraffic => enters_traffic(side, way),
        Movement::ParkingManeuver => parks(side, way),
        Movement::WrongWay => match way.against() {
            None => return Err("on no lane"),
            Some(against) => (against, if against { "against its lane" } else { "along its lane" }.to_owned()),
        },
        Movement::NmWaiting | Movement::NmOnSidewalk => return Err("no such place is drawn"),
        Movement::Straight
        | Movement::LeftTurn
        | Movement::RightTurn
        | Movement::UTurn
        | Movement::NmCrossing
        | Movement::NmAlongside
        | Movement::NmInRoadway => goes_on(side, movement, way),
    })
}

/// Whether the turn that is told of its way is driven, begun or yet to come.
fn turns(side: &Side, movement: Movement, way: &Way<'_>) -> bool {
    let turned = way.turned_deg();
    let least = match (side.turned, side.turns_wide) {
        (true, _) => TURNED_DEG,
        (false, true) => TURNS_WIDE_DEG,
        (false, false) => TURNS_DEG,
    };
    match side.turning {
        Turning::Left | Turning::Right if side.turns_later => turned.abs() < STRAIGHT_DEG,
        _ if side.turns_later => way.turns_as_told(movement),
        Turning::Left => turned > least,
        Turning::Right => turned < -least,
        Turning::No | Turning::Round => true,
    }
}

fn stands(side: &Side, way: &Way<'_>) -> (bool, String) {
    let stood = way.stood();
    let words = if stood { "it stood" } else { "it never stood" };
    let turned = || format!("{words}, {}", turned_words(way.turned_deg()));
    (stood, if side.turning == Turning::No { words.to_owned() } else { turned() })
}

/// Who is told to go round somebody is seen out of its line. Whom it passes may be drawn by nobody, where that is not the other one.
fn passes(side: &Side, way: &Way<'_>) -> Seen {
    let out = way.sideways(CHANGED_M);
    if side.goes_round && !out.0 {
        return Ok(out);
    }
    let passed = way.passed();
    if !passed && way.met.speed().abs() > STANDS_MPS {
        return Err("whom it passes is not drawn");
    }
    Ok((passed, if passed { "it came by" } else { "it did not come by" }.to_owned()))
}

fn backs(side: &Side, way: &Way<'_>) -> (bool, String) {
    let (reversed, slant) = (way.reversed(), way.slant_deg());
    let words = if reversed { "it went backwards" } else { "it did not go backwards" };
    let slants = side.slants.is_none() || slant >= SLANTS_DEG;
    (reversed && slants, format!("{words}, at {slant:.0} degrees to the road"))
}

/// Who comes along a crossing road enters the ego's straight across; who pulls out of it does so where it ran its signal or sign.
fn enters_traffic(side: &Side, way: &Way<'_>) -> (bool, String) {
    let (turned, beside_m) = (way.turned_deg(), way.beside_m().abs());
    let pulls_out = side.acts.iter().any(|doing| doing.act == Act::PullOut);
    let pulls_out = pulls_out && side.control.and_then(|said| said.obeyed) != Some(Obeyed::No);
    let across = way.crosses && way.slant_deg() >= ACROSS_DEG && !pulls_out;
    let out = way.is_off_lanes(&way.track.states[0]) || way.stood() || across || way.came_along;
    let enters = beside_m >= LEFT_LINE_M || turned.abs() >= BENDS_DEG || across;
    (out && enters, format!("{}, {beside_m:.1} m aside", turned_words(turned)))
}

fn parks(side: &Side, way: &Way<'_>) -> (bool, String) {
    let (turned, beside_m) = (way.turned_deg(), way.beside_m().abs());
    let last = &way.until()[way.until().len() - 1];
    let swings = side.slants.is_none() || way.slant_deg() >= BENDS_DEG;
    let turns = way.reversed() && swings || beside_m >= LEFT_LINE_M || turned.abs() >= BENDS_DEG;
    let there = !way.parks_at_kerb || way.is_off_lanes(last);
    let slow = last.velocity().length() < PARKS_MPS;
    (slow && turns && there, format!("{}, {beside_m:.1} m aside", turned_words(turned)))
}

/// Who goes straight on, or turns. Who swings out and back has not gone straight on; whose turn is over goes straight on.
fn goes_on(side: &Side, movement: Movement, way: &Way<'_>) -> (bool, String) {
    let turned = way.turned_deg();
    let fits = match side.turning {
        Turning::No if way.keeps_lane => side.turns_later || turned.abs() < KEEPS_DEG && way.keeps_line(side),
        Turning::No => side.turns_later || turned.abs() < STRAIGHT_DEG,
        Turning::Round => turned.abs() > ROUND_DEG,
        Turning::Left | Turning::Right => !side.turned || movement != Movement::Straight || way.turns_no_more(),
    };
    (fits, turned_words(turned) + &swung_words(turned, way.most_turned_deg()))
}

/// Who backs into a space at the kerb has come out of its line by so much while it reversed, and was at an angle to it. [m, deg]
const BACKED_IN_M: f64 = 0.8;
const BACKED_IN_DEG: f64 = 10.0;

/// Whether somebody backed into a space at the kerb.
fn backs_in(way: &Way<'_>) -> (bool, String) {
    let until = way.until();
    let backs = until.iter().rposition(|state| state.speed() > -STANDS_MPS).unwrap_or(0);
    let (first, last) = (&until[backs], &until[until.len() - 1]);
    let aside_m = Vec2::from_heading(first.heading).cross(last.position() - first.position()).abs();
    let angle = |state: &ActorState| math::wrap_angle(state.heading - first.heading).to_degrees().abs();
    let most_deg = until[backs..].iter().map(angle).fold(0.0, f64::max);
    let shown = aside_m >= BACKED_IN_M && most_deg >= BACKED_IN_DEG;
    (shown, format!("{aside_m:.1} m aside in reverse, by {most_deg:.0} degrees"))
}

fn word(side: &Side) -> String {
    let turn = match (side.turning, side.movement) {
        (_, Some(Movement::LeftTurn | Movement::RightTurn)) => "",
        (Turning::Left, _) => ", after a left turn",
        (Turning::Right, _) => ", after a right turn",
        (Turning::No | Turning::Round, _) => "",
    };
    let more = match (side.dodges, side.slants.is_some()) {
        (true, _) => ", and aside",
        (_, true) => ", at an angle",
        _ => "",
    };
    side.movement.map_or(String::new(), |movement| movement.label().to_lowercase() + turn + more)
}

fn swung_words(turned: f64, most: f64) -> String {
    if most - turned.abs() > KEEPS_DEG { format!(", {most:.0} on its way") } else { String::new() }
}

fn turned_words(degrees: f64) -> String {
    match degrees.round() {
        d if d >= 1.0 => format!("{d:.0} degrees to the left"),
        d if d <= -1.0 => format!("{:.0} degrees to the right", -d),
        _ => "straight on".to_owned(),
    }
}
