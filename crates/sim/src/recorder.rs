//! What is kept of a run: everything ([`RolloutRecorder`]) or a few numbers ([`SummaryRecorder`]).

use crate::cast::CastMember;
use recrash_model::geometry::OrientedBox;
use recrash_model::rollout::{
    ActorState, ActorTrack, Event, EventKind, ROLLOUT_FORMAT, Role, Rollout, STEP_S, Termination, TerminationKind,
};
use recrash_roads::Scenario;

/// The simulator's name in rollouts.
pub(crate) const NAME: &str = "native";

/// Its version in rollouts.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Takes what happens in one run, in order.
pub trait Recorder {
    /// The run begins. `ego` is the driver's name; `cast` holds the ego, the partners in the scenario's order, then
    /// background traffic.
    fn begin(&mut self, scenario: &Scenario, ego: &str, cast: &[CastMember]);
    /// One step: a state of every actor, with the controls it has chosen for the next (none at the last step).
    fn step(&mut self, states: &[ActorState]);
    /// Something happened.
    fn event(&mut self, event: &Event);
    /// The run is over.
    fn end(&mut self, termination: Termination);
}

/// Keeps a whole [`Rollout`].
#[derive(Debug, Clone, Default)]
pub struct RolloutRecorder {
    rollout: Option<Rollout>,
}

impl RolloutRecorder {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// The rollout, once a run is over.
    pub fn finish(self) -> Option<Rollout> {
        self.unnamed().map(Rollout::named)
    }

    /// The same without the hash of its states, which takes as long as a tenth of the run.
    pub fn unnamed(self) -> Option<Rollout> {
        self.rollout
    }
}

impl Recorder for RolloutRecorder {
    fn begin(&mut self, scenario: &Scenario, ego: &str, cast: &[CastMember]) {
        let draft = scenario.draft();
        let steps = (draft.duration_s / STEP_S).ceil().clamp(0.0, 2000.0) as usize + 2;
        let actors = cast.iter().enumerate().map(|(position, member)| ActorTrack {
            id: member.id(draft, position),
            role: member.role,
            part_of: member.owner.map(usize::from),
            appears_s: f64::from(member.appears) * STEP_S,
            gone_s: None,
            kind: member.kind,
            length_m: member.length_m,
            width_m: member.width_m,
            mass_kg: member.own_mass_kg(draft, position),
            states: Vec::with_capacity(steps),
        });
        self.rollout = Some(Rollout {
            format: ROLLOUT_FORMAT.to_owned(),
            scenario_id: draft.id.clone(),
            simulator: format!("{NAME} {VERSION}"),
            ego: ego.to_string(),
            actors: actors.collect(),
            obstacles: scenario.obstacles().iter().map(|obstacle| obstacle.placed).collect(),
            events: Vec::new(),
            termination: Termination { kind: TerminationKind::Timeout, time_s: 0.0 },
            state_hash: String::new(),
        });
    }

    fn step(&mut self, states: &[ActorState]) {
        if let Some(rollout) = &mut self.rollout {
            for (track, state) in rollout.actors.iter_mut().zip(states) {
                track.states.push(*state);
            }
        }
    }

    fn event(&mut self, event: &Event) {
        if let Some(rollout) = &mut self.rollout {
            if let EventKind::Gone { actor } = event.kind {
                rollout.actors[actor].gone_s = Some(event.time_s);
            }
            rollout.events.push(event.clone());
        }
    }

    fn end(&mut self, termination: Termination) {
        if let Some(rollout) = &mut self.rollout {
            rollout.termination = termination;
        }
    }
}

/// A few numbers about one run; what a search needs a million times.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    /// How it ended.
    pub termination: Option<Termination>,
    /// Steps run.
    pub steps: u32,
    /// Road users, the ego among them.
    pub actors: usize,
    /// First road user the ego touched: position among the actors, and when. [s]
    pub contact: Option<(usize, f64)>,
    /// Obstacles the ego touched.
    pub obstacles_hit: u32,
    /// Least box gap between the ego and any partner (background traffic where there is none), at the steps. [m]
    pub min_gap_m: f64,
    /// When. [s]
    pub min_gap_time_s: f64,
    /// Hardest deceleration of the ego over one step. [m/s^2]
    pub max_deceleration_mps2: f64,
}

/// Keeps a [`Summary`]; allocates nothing once it has seen as many actors as there are.
#[derive(Debug, Clone, Default)]
pub struct SummaryRecorder {
    /// The summary, once a run is over.
    pub summary: Summary,
    sizes: Vec<(f64, f64, f64)>,
    watched: std::ops::Range<usize>,
    last_speed_mps: Option<f64>,
}

impl SummaryRecorder {
    /// An empty one, to be used again and again.
    pub fn new() -> Self {
        Self::default()
    }
}

impl Recorder for SummaryRecorder {
    fn begin(&mut self, _: &Scenario, _: &str, cast: &[CastMember]) {
        self.summary = Summary { min_gap_m: f64::INFINITY, actors: cast.len(), ..Summary::default() };
        self.sizes.clear();
        self.sizes.extend(cast.iter().map(|member| {
            let radius = 0.5 * (member.length_m * member.length_m + member.width_m * member.width_m).sqrt();
            (member.length_m, member.width_m, radius)
        }));
        let partners = cast.iter().filter(|member| member.role == Role::Partner).count();
        let road_users = cast.iter().filter(|member| member.role != Role::Part).count();
        self.watched = if partners > 0 { 1..1 + partners } else { 1..road_users };
        self.last_speed_mps = None;
    }

    fn step(&mut self, states: &[ActorState]) {
        let ego = &states[0];
        let (length, width, radius) = self.sizes[0];
        for other in self.watched.clone() {
            let (other_length, other_width, other_radius) = self.sizes[other];
            // The circles around the boxes bound the gap from below; most steps need no more than that.
            let bound = ego.position().distance(states[other].position()) - radius - other_radius;
            if bound < self.summary.min_gap_m {
                let ego_box = OrientedBox::new(ego.pose(), length, width);
                let gap = ego_box.gap(&OrientedBox::new(states[other].pose(), other_length, other_width));
                if gap < self.summary.min_gap_m {
                    self.summary.min_gap_m = gap;
                    self.summary.min_gap_time_s = f64::from(self.summary.steps) * STEP_S;
                }
            }
        }
        let speed_mps = ego.speed();
        if let Some(last) = self.last_speed_mps {
            let deceleration = (last - speed_mps) / STEP_S;
            self.summary.max_deceleration_mps2 = self.summary.max_deceleration_mps2.max(deceleration);
        }
        self.last_speed_mps = Some(speed_mps);
        self.summary.steps += 1;
    }

    fn event(&mut self, event: &Event) {
        match event.kind {
            EventKind::Contact { a: 0, b, .. } if self.summary.contact.is_none() => {
                self.summary.contact = Some((b, event.time_s));
                if self.watched.contains(&b) {
                    self.summary.min_gap_m = 0.0;
                    self.summary.min_gap_time_s = event.time_s;
                }
            }
            EventKind::ObstacleContact { actor: 0, .. } => self.summary.obstacles_hit += 1,
            _ => {}
        }
    }

    fn end(&mut self, termination: Termination) {
        self.summary.termination = Some(termination);
    }
}
