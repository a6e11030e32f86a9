//! Told facts, held against a rollout. Nothing here reads the scenario: only who was where.

use crate::told::{Told, Turning};
use crate::touch::{side_of, zones_off};
use recrash_metrics::contact::contact_geometry;
use recrash_model::account::{ContactState, LeftRight, Origin};
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::math;
use recrash_model::narrative::FirstMover;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Rollout};
use recrash_model::zones::ContactZone;

/// Slower than this is standing. [m/s]
const STANDS_MPS: f64 = 0.1;

/// Nearer to the middle than this a contact is on neither side. [m]
const MIDDLE_M: f64 = 0.1;

/// Whether a contact lies within a step of a told zone, and not on the other side of the vehicle than all told ones.
fn is_near(told: &[ContactZone], seen: ContactZone, outline: &OrientedBox, point: Vec2) -> bool {
    let aside_m = outline.to_local(point).y;
    let other_side = side_of(told).is_some_and(|side| side * aside_m < -MIDDLE_M);
    zones_off(told, seen) <= 1 && !other_side
}

/// Who is no farther from the place of the contact is there. [m]
const NEAR_M: f64 = 0.5;

/// Who come within this time come together. [s]
const TOGETHER_S: f64 = 1.0;

/// A kind of fact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FactKind {
    /// The two touch, and nobody else touches the ego before.
    Contact,
    /// The partner's kind.
    Partner,
    /// Zone on the ego, within a step.
    SvZone,
    /// Zone on the partner, within a step.
    CpZone,
    /// The ego's state at the contact.
    SvState,
    /// The partner's state at the contact.
    CpState,
    /// The ego's speed at the contact.
    SvSpeed,
    /// The partner's speed at the contact.
    CpSpeed,
    /// The ego's turn, or that it does not turn.
    SvMovement,
    /// The partner's turn, or that it does not turn.
    CpMovement,
    /// From where the partner comes.
    Origin,
    /// Who was at the place of the contact first.
    Order,
    /// Somebody else touched the partner before it touched the ego.
    Pushed,
}

impl FactKind {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::Contact,
        Self::Partner,
        Self::SvZone,
        Self::CpZone,
        Self::SvState,
        Self::CpState,
        Self::SvSpeed,
        Self::CpSpeed,
        Self::SvMovement,
        Self::CpMovement,
        Self::Origin,
        Self::Order,
        Self::Pushed,
    ];

    /// For tables.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Partner => "partner's kind",
            Self::SvZone => "ego's zone",
            Self::CpZone => "partner's zone",
            Self::SvState => "ego's state",
            Self::CpState => "partner's state",
            Self::SvSpeed => "ego's impact speed",
            Self::CpSpeed => "partner's impact speed",
            Self::SvMovement => "ego's movement",
            Self::CpMovement => "partner's movement",
            Self::Origin => "partner's origin",
            Self::Order => "who was first",
            Self::Pushed => "partner passed on by another",
        }
    }
}

/// A told fact, and whether the rollout shows it.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Which.
    pub kind: FactKind,
    /// Whether it is shown.
    pub shown: bool,
    /// What is told, and what the rollout shows.
    pub sentence: String,
}

struct Touch<'a> {
    time_s: f64,
    ego: ActorState,
    other: ActorState,
    kind: PartnerKind,
    other_box: OrientedBox,
    track: Option<&'a ActorTrack>,
}

/// Every told fact.
pub(crate) fn facts(told: &Told, rollout: &Rollout) -> Vec<Shown> {
    let mut list = Vec::new();
    let mut fact = |kind: FactKind, shown: bool, sentence: String| list.push(Shown { kind, shown, sentence });
    let Some(touch) = first_touch(rollout) else {
        fact(FactKind::Contact, false, "told: a contact; shown: none".to_owned());
        return list;
    };
    let by_partner = touch.track.is_none_or(|track| track.id == "cp");
    fact(FactKind::Contact, by_partner, format!("told: a contact with the partner; shown: at {:.2} s", touch.time_s));
    fact(FactKind::Partner, touch.kind == told.cp.kind, format!("told: {:?}; shown: {:?}", told.cp.kind, touch.kind));
    let ego_track = rollout.ego_track();
    let ego_box = OrientedBox::new(touch.ego.pose(), ego_track.length_m, ego_track.width_m);
    let geometry = contact_geometry(&ego_box, touch.ego.velocity(), &touch.other_box, touch.other.velocity());
    if !told.sv.zones.is_empty() {
        let near = is_near(&told.sv.zones, geometry.ego_zone, &ego_box, geometry.point);
        fact(FactKind::SvZone, near, format!("told: {:?}; shown: {:?}", told.sv.zones, geometry.ego_zone));
    }
    if !told.cp.zones.is_empty() && told.thing.is_none() {
        let near = is_near(&told.cp.zones, geometry.other_zone, &touch.other_box, geometry.point);
        fact(FactKind::CpZone, near, format!("told: {:?}; shown: {:?}", told.cp.zones, geometry.other_zone));
    }
    if told.sv.state_told {
        let shown = state(told.sv.state, ego_track, &touch.ego, touch.time_s);
        fact(FactKind::SvState, shown, format!("told: {:?}; shown: {:.2} m/s", told.sv.state, touch.ego.speed()));
    }
    if told.cp.state_told
        && let Some(track) = touch.track
    {
        // Who is pushed moves when it touches.
        let shown = told.pushed || state(told.cp.state, track, &touch.other, touch.time_s);
        fact(FactKind::CpState, shown, format!("told: {:?}; shown: {:.2} m/s", told.cp.state, touch.other.speed()));
    }
    if let Some(impact_mps) = told.sv.impact_mps {
        let speed_mps = touch.ego.velocity().length();
        let close = (speed_mps - impact_mps).abs() <= 2.0_f64.max(0.25 * impact_mps);
        fact(FactKind::SvSpeed, close, format!("told: {impact_mps:.1} m/s; shown: {speed_mps:.1} m/s"));
    }
    if let Some(impact_mps) = told.cp.impact_mps {
        let speed_mps = touch.other.velocity().length();
        let close = (speed_mps - impact_mps).abs() <= 2.0_f64.max(0.25 * impact_mps);
        fact(FactKind::CpSpeed, close, format!("told: {impact_mps:.1} m/s; shown: {speed_mps:.1} m/s"));
    }
    if told.pushed {
        let number = rollout.actors.iter().position(|track| track.id == "cp");
        let before =
            rollout.events.iter().take_while(|event| event.time_s < touch.time_s).any(|event| match event.kind {
                EventKind::Contact { a, b, .. } => a != 0 && (Some(a) == number || Some(b) == number),
                _ => false,
            });
        fact(FactKind::Pushed, before, format!("told: another touched the partner first; shown: {before}"));
    }
    if told.sv.movement.is_some() && told.sv.turning != Turning::Round {
        let turned = turned(ego_track, touch.time_s);
        fact(FactKind::SvMovement, fits(told.sv.turning, turned), turn_sentence(told.sv.turning, turned));
    }
    if let Some(track) = touch.track {
        if told.cp.movement.is_some() && told.cp.turning != Turning::Round && told.cp.state != ContactState::Reversing {
            let turned = turned(track, touch.time_s);
            fact(FactKind::CpMovement, fits(told.cp.turning, turned), turn_sentence(told.cp.turning, turned));
        }
        if told.origin_told {
            let (shown, sentence) = origin(told.origin, ego_track, track, told.cp.state);
            fact(FactKind::Origin, shown, sentence);
        }
    }
    if let (Some(first), Some(track)) = (told.order, touch.track) {
        let (shown, sentence) = order(first, ego_track, track, geometry.point, touch.time_s);
        fact(FactKind::Order, shown, sentence);
    }
    list
}

/// Whether who is told to have been first was at the place of the contact first, and by how much.
fn order(first: FirstMover, ego: &ActorTrack, other: &ActorTrack, point: Vec2, time_s: f64) -> (bool, String) {
    let there_s = |track: &ActorTrack| {
        let until = ((time_s * 10.0).ceil() as usize + 1).min(track.states.len());
        let covers = |step: &usize| {
            let outline = track.outline(*step);
            let local = outline.to_local(point);
            local.x.abs() <= outline.half_length + NEAR_M && local.y.abs() <= outline.half_width + NEAR_M
        };
        (0..until).find(covers).map_or(time_s, |step| 0.1 * step as f64)
    };
    let (ego_s, other_s) = (there_s(ego), there_s(other));
    let earlier_s = other_s - ego_s;
    let shown = match first {
        FirstMover::Sv => earlier_s > 0.1,
        FirstMover::Cp => earlier_s < -0.1,
        FirstMover::Both => earlier_s.abs() <= TOGETHER_S,
    };
    (shown, format!("told: {first:?} first; shown: the ego {earlier_s:.1} s before the partner"))
}

fn first_touch(rollout: &Rollout) -> Option<Touch<'_>> {
    rollout.events.iter().find_map(|event| match &event.kind {
        EventKind::Contact { a: 0, b, a_state, b_state } => {
            let track = rollout.actors.get(*b)?;
            Some(Touch {
                time_s: event.time_s,
                ego: *a_state,
                other: *b_state,
                kind: track.kind,
                other_box: OrientedBox::new(b_state.pose(), track.length_m, track.width_m),
                track: Some(track),
            })
        }
        EventKind::ObstacleContact { actor: 0, obstacle, state } => {
            let placed = rollout.obstacles.get(*obstacle)?;
            Some(Touch {
                time_s: event.time_s,
                ego: *state,
                other: ActorState::moving(placed.pose, 0.0),
                kind: PartnerKind::FixedObject,
                other_box: placed.outline(),
                track: None,
            })
        }
        _ => None,
    })
}

/// Whether somebody is in a state when it touches, and was before as the state says.
fn state(told: ContactState, track: &ActorTrack, now: &ActorState, time_s: f64) -> bool {
    let step = (time_s * 10.0).floor() as usize;
    let back = |seconds: f64| track.states[step.saturating_sub((seconds * 10.0) as usize).min(track.states.len() - 1)];
    let speed = now.velocity().length();
    match told {
        ContactState::Moving => now.speed() > STANDS_MPS,
        ContactState::Reversing => now.speed() < -STANDS_MPS,
        ContactState::SettingOff => {
            now.speed() > STANDS_MPS
                && (1..=60).any(|tenth| back(0.1 * f64::from(tenth)).velocity().length() < STANDS_MPS)
        }
        ContactState::Stopped => speed < STANDS_MPS && back(1.0).velocity().length() < STANDS_MPS,
        ContactState::Parked => {
            track.states[..=step.min(track.states.len() - 1)].iter().all(|state| state.velocity().length() < STANDS_MPS)
        }
    }
}

/// How far somebody has turned until the contact, to the left. [rad]
fn turned(track: &ActorTrack, time_s: f64) -> f64 {
    let step = ((time_s * 10.0).floor() as usize).min(track.states.len() - 1);
    track.states[..=step].windows(2).map(|pair| math::wrap_angle(pair[1].heading - pair[0].heading)).sum()
}

fn fits(told: Turning, turned: f64) -> bool {
    let degrees = turned.to_degrees();
    match told {
        Turning::Left => degrees > 10.0,
        Turning::Right => degrees < -10.0,
        Turning::No => degrees.abs() < 50.0,
        Turning::Round => true,
    }
}

fn turn_sentence(told: Turning, turned: f64) -> String {
    let word = match told {
        Turning::No => "no turn",
        Turning::Left => "a turn to the left",
        Turning::Right => "a turn to the right",
        Turning::Round => "a U-turn",
    };
    format!("told: {word}; shown: {:.0} degrees to the left", turned.to_degrees())
}

/// Whether the partner comes from where it is told, seen from the ego at the start.
fn origin(told: Origin, ego: &ActorTrack, other: &ActorTrack, state: ContactState) -> (bool, String) {
    let (ego, other) = (&ego.states[0], &other.states[0]);
    let forward = Vec2::from_heading(ego.heading);
    let way = other.position() - ego.position();
    let (ahead, left) = (way.dot(forward), forward.cross(way));
    let facing = math::wrap_angle(other.heading - ego.heading).to_degrees();
    // Who reverses moves against where it faces.
    let moves = if state == ContactState::Reversing {
        math::wrap_angle((facing + 180.0).to_radians()).to_degrees()
    } else {
        facing
    };
    let on = |side: LeftRight, angle: f64| if side == LeftRight::Left { angle < 0.0 } else { angle > 0.0 };
    let beside = |side: LeftRight| if side == LeftRight::Left { left > 0.0 } else { left < 0.0 };
    let shown = match told {
        Origin::Behind => ahead < 2.0 && facing.abs() < 60.0 || state == ContactState::Reversing,
        Origin::Ahead => ahead > -2.0,
        Origin::Opposite => facing.abs() > 120.0,
        Origin::Beside { side } => facing.abs() < 60.0 && beside(side),
        Origin::Cross { side } => (30.0..150.0).contains(&moves.abs()) && on(side, moves),
        Origin::Stall { side } | Origin::Driveway { side } | Origin::Parked { side } | Origin::Sidewalk { side } => {
            side.is_none_or(beside) || state.stands()
        }
        Origin::Above => false,
    };
    (shown, format!("told: {told:?}; shown: {ahead:.0} m ahead, {left:.0} m to the left, facing {facing:.0} degrees"))
}
