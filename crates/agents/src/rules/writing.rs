//! The narrative's text: our own plain sentences, made from its facts.

use super::limits::LEAST_TOLD_SPEED_MPS;
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{
    Fact, FactSource, FactValue, FirstMover, LanePosition, LateralKind, LongitudinalAction, Narrative, Side, Signal,
};
use recrash_model::record::MPS_PER_MPH;
use recrash_model::scenario::{Approach, MissingArm};
use recrash_model::template::{Movement, RoadType};
use recrash_model::zones::ContactZone;

/// Writes the text of a narrative from its template and facts: two to five sentences.
pub fn text(narrative: &Narrative) -> String {
    let facts = Facts(&narrative.facts);
    let mut sentences = vec![ego_sentence(narrative, &facts), partner_sentence(narrative, &facts)];
    sentences.extend(conflict_sentence(&facts));
    sentences.extend(contact_sentence(narrative, &facts));
    sentences.extend(work_zone_sentence(narrative, &facts));
    sentences.join(" ")
}

/// Facts with look-ups.
pub struct Facts<'a>(pub &'a [Fact]);

impl<'a> Facts<'a> {
    /// The first fact that `pick` takes.
    pub fn find<T>(&self, pick: impl Fn(&'a FactValue) -> Option<T>) -> Option<T> {
        self.0.iter().find_map(|fact| pick(&fact.value))
    }

    /// The first fact of this sort.
    pub fn find_fact(&self, is: impl Fn(&FactValue) -> bool) -> Option<&'a Fact> {
        self.0.iter().find(|fact| is(&fact.value))
    }

    /// The first fact that `pick` takes, with its source.
    fn find_with_source<T>(&self, pick: impl Fn(&'a FactValue) -> Option<T>) -> Option<(T, &'a FactSource)> {
        self.0.iter().find_map(|fact| Some((pick(&fact.value)?, &fact.source)))
    }

    /// From where the partner comes.
    pub fn approach(&self) -> Option<Approach> {
        self.find(|value| match value {
            FactValue::Approach { approach } => Some(*approach),
            _ => None,
        })
    }

    /// On which side of the ego the partner drives.
    pub fn side(&self) -> Option<Side> {
        self.find(|value| match value {
            FactValue::CpLaneOffset { lanes } => offset_side(*lanes),
            _ => None,
        })
    }

    /// What the partner is.
    pub fn partner(&self) -> Option<PartnerKind> {
        self.find(|value| match value {
            FactValue::Partner { kind } => Some(*kind),
            _ => None,
        })
    }

    /// Who is first where their paths meet.
    pub fn first_mover(&self) -> Option<FirstMover> {
        self.find(|value| match value {
            FactValue::Order { first } => Some(*first),
            _ => None,
        })
    }

    /// The arm that a three-way intersection lacks.
    pub fn missing_arm(&self) -> Option<MissingArm> {
        self.find(|value| match value {
            FactValue::ThreeWay { missing } => Some(*missing),
            _ => None,
        })
    }

    /// Whether the partner did this.
    pub fn cp_did(&self, action: LongitudinalAction) -> bool {
        self.0.iter().any(|fact| fact.value == FactValue::CpAction { action })
    }
}

/// The side of a lane offset.
pub fn offset_side(lanes: i8) -> Option<Side> {
    match lanes.signum() {
        -1 => Some(Side::Left),
        1 => Some(Side::Right),
        _ => None,
    }
}

fn place(narrative: &Narrative, facts: &Facts) -> String {
    match (narrative.template.road, facts.missing_arm()) {
        (RoadType::Intersection, Some(missing)) => {
            let arm = match missing {
                MissingArm::Right => "to the right",
                MissingArm::Ahead => "ahead",
                MissingArm::Left => "to the left",
            };
            format!("At a three-way intersection with no road {arm}")
        }
        (RoadType::Intersection, None) => "At an intersection".to_owned(),
        (RoadType::TrafficCircle, _) => "At a traffic circle".to_owned(),
        (RoadType::Highway, _) => "On a highway".to_owned(),
        _ => "On a street".to_owned(),
    }
}

fn movement(road: RoadType, movement: Movement, beside: bool) -> &'static str {
    match (road, movement) {
        (RoadType::TrafficCircle, Movement::LeftTurn) => "drives round to the third exit",
        (RoadType::TrafficCircle, Movement::RightTurn) => "leaves by the first exit",
        (RoadType::TrafficCircle, _) => "leaves by the second exit",
        (RoadType::Highway, Movement::LeftTurn) if beside => "moves to its left",
        (RoadType::Highway, Movement::RightTurn) if beside => "moves to its right",
        (_, Movement::LeftTurn) => "turns left",
        (_, Movement::RightTurn) => "turns right",
        _ => "drives straight ahead",
    }
}

fn lane(lane: LanePosition) -> &'static str {
    match lane {
        LanePosition::Leftmost => " in the leftmost lane",
        LanePosition::Middle => " in a middle lane",
        LanePosition::Rightmost => " in the rightmost lane",
    }
}

/// A speed in SI units, with mph in brackets where the record gives it so.
fn speed(speed: Option<(f64, &FactSource)>) -> String {
    match speed {
        None => String::new(),
        // A vehicle this slow stood, or nearly did.
        Some((mps, _)) if mps < LEAST_TOLD_SPEED_MPS => String::new(),
        Some((mps, FactSource::Assumed { .. })) => format!(" at about {mps:.1} m/s"),
        Some((mps, _)) => format!(" at {mps:.1} m/s ({:.0} mph)", mps / MPS_PER_MPH),
    }
}

fn control(signal: Option<Signal>, facing_red: &str) -> String {
    match signal {
        Some(Signal::Green) => " on a green light".to_owned(),
        Some(Signal::Yellow) => " on a yellow light".to_owned(),
        Some(Signal::Red) => facing_red.to_owned(),
        Some(Signal::StopSign) => " from a stop sign".to_owned(),
        Some(Signal::YieldSign) => " from a yield sign".to_owned(),
        Some(Signal::Uncontrolled) | None => String::new(),
    }
}

fn ego_sentence(narrative: &Narrative, facts: &Facts) -> String {
    let speed = speed(facts.find_with_source(|value| match value {
        FactValue::SvSpeed { speed_mps } => Some(*speed_mps),
        _ => None,
    }));
    let lane = facts.find(|value| match value {
        FactValue::SvLane { lane: position } => Some(lane(*position)),
        _ => None,
    });
    let signal = facts.find(|value| match value {
        FactValue::SvSignal { signal } => Some(*signal),
        _ => None,
    });
    format!(
        "{}, the ego {}{}{}{}.",
        place(narrative, facts),
        movement(narrative.template.road, narrative.template.sv, false),
        lane.unwrap_or(""),
        control(signal, " after a red light"),
        speed,
    )
}

/// The partner's kind with its article.
fn partner(facts: &Facts) -> &'static str {
    match facts.partner().unwrap_or_default() {
        PartnerKind::PassengerCar => "A passenger car",
        PartnerKind::Suv => "An SUV",
        PartnerKind::Van => "A van",
        PartnerKind::PickupTruck => "A pickup truck",
        PartnerKind::HeavyTruck => "A heavy truck",
        PartnerKind::Bus => "A bus",
        PartnerKind::Motorcycle => "A motorcycle",
        PartnerKind::Cyclist => "A cyclist",
        PartnerKind::Pedestrian => "A pedestrian",
        PartnerKind::OtherNonMotorist => "A scooter rider",
        PartnerKind::FirstResponder => "An emergency vehicle",
        PartnerKind::Animal => "An animal",
        PartnerKind::FixedObject => "An object",
    }
}

fn partner_sentence(narrative: &Narrative, facts: &Facts) -> String {
    let approach = facts.approach();
    let side = facts.side();
    let from = match (approach, side) {
        (Some(Approach::Left), _) => "comes from the left",
        (Some(Approach::Right), _) => "comes from the right",
        (Some(Approach::Opposite), _) => "comes from the opposite direction",
        (Some(Approach::Ring), _) => "is already on the ring",
        (_, Some(Side::Left)) => "drives in the lane to the left of the ego",
        (_, Some(Side::Right)) => "drives in the lane to the right of the ego",
        _ => "drives in the same direction",
    };
    let speed = speed(facts.find_with_source(|value| match value {
        FactValue::CpSpeed { speed_mps } => Some(*speed_mps),
        _ => None,
    }));
    let signal = facts.find(|value| match value {
        FactValue::CpSignal { signal } => Some(*signal),
        _ => None,
    });
    let start = if facts.cp_did(LongitudinalAction::WasStopped) { ", sets off from standstill" } else { "" };
    format!(
        "{} {from}{start} and {}{}{speed}.",
        partner(facts),
        movement(narrative.template.road, narrative.template.cp, approach == Some(Approach::Same)),
        control(signal, " against a red light"),
    )
}

fn conflict_sentence(facts: &Facts) -> Option<String> {
    let moved = facts.find(|value| match value {
        FactValue::CpLateral { towards, kind } => Some((*towards, *kind)),
        _ => None,
    });
    if let Some((towards, kind)) = moved {
        let side = if towards == Side::Left { "left" } else { "right" };
        return Some(match kind {
            LateralKind::Drift => format!("The partner drifts to the {side}, towards the ego's lane."),
            LateralKind::LaneChange => format!("The partner changes lanes to the {side}, where the ego is."),
            LateralKind::CutIn => format!("The partner cuts in to the {side}, close to the ego."),
            LateralKind::WideTurn => format!("The partner does not hold its lane in the turn and comes to the {side}."),
        });
    }
    Some(match facts.first_mover()? {
        FirstMover::Sv => "The ego reaches the place where their paths meet first.".to_owned(),
        FirstMover::Cp => "The partner reaches the place where their paths meet first.".to_owned(),
        FirstMover::Both => "Both reach the place where their paths meet at about the same time.".to_owned(),
    })
}

fn contact_sentence(narrative: &Narrative, facts: &Facts) -> Option<String> {
    let kind = facts.find(|value| match value {
        FactValue::Collision { kind } => Some(*kind),
        _ => None,
    });
    let zones = facts.find(|value| match value {
        FactValue::Contact { sv, cp } => Some((sv.as_slice(), cp.as_slice())),
        _ => None,
    });
    match (zones, kind) {
        (Some((sv, cp)), _) if !sv.is_empty() && !cp.is_empty() => {
            Some(format!("The ego's {} and the partner's {} touch.", zone_list(sv), zone_list(cp)))
        }
        (Some((sv, _)), _) if !sv.is_empty() => Some(format!("The partner touches the ego's {}.", zone_list(sv))),
        (_, Some(CollisionKind::Sideswipe)) => Some("They come close side to side.".to_owned()),
        (_, Some(_)) if narrative.template.road == RoadType::Intersection => {
            Some("They come close in the intersection.".to_owned())
        }
        _ => None,
    }
}

fn zone_list(zones: &[ContactZone]) -> String {
    let labels: Vec<&str> = zones.iter().map(|zone| zone.label()).collect();
    match labels.as_slice() {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

fn work_zone_sentence(narrative: &Narrative, facts: &Facts) -> Option<String> {
    let side = facts.find(|value| match value {
        FactValue::Obstacles { side, .. } => Some(*side),
        _ => None,
    });
    let side = match (narrative.template.work_zone, side) {
        (_, Some(side)) => side,
        (true, None) => Side::Left,
        (false, None) => return None,
    };
    let side = if side == Side::Left { "left" } else { "right" };
    Some(format!("Cones of a work zone stand to the {side} of the ego's lane."))
}
