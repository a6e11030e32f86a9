//! Small changes of a scenario: somebody a little farther, beside, later, faster. Nothing here runs anything.

use recrash_model::math;
use recrash_model::scenario::{Act, Along, Deed, Place, Policy, ScenarioDraft, Start, Trigger};

/// Somebody, or something, that can be moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Who {
    /// The ego.
    Ego,
    /// A partner, by position.
    Partner(usize),
    /// An actor, by position.
    Actor(usize),
    /// A thing, by position.
    Object(usize),
    /// An obstacle, by position.
    Obstacle(usize),
}

/// A small change. Each is of one road user or thing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nudge {
    /// It starts farther along its way. [m]
    Along(f64),
    /// It starts farther to the right. [m]
    Across(f64),
    /// All that it does comes later. [s]
    Later(f64),
    /// It is faster by this factor.
    Faster(f64),
}

impl Nudge {
    /// The same, so many times as large.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        match self {
            Self::Along(by_m) => Self::Along(by_m * factor),
            Self::Across(by_m) => Self::Across(by_m * factor),
            Self::Later(by_s) => Self::Later(by_s * factor),
            Self::Faster(by) => Self::Faster(1.0 + (by - 1.0) * factor),
        }
    }
}

/// Everybody and everything of a scenario that can be moved, the ego first.
pub fn everybody(draft: &ScenarioDraft) -> Vec<Who> {
    std::iter::once(Who::Ego).chain(others(draft)).collect()
}

/// The same without the ego.
pub fn others(draft: &ScenarioDraft) -> Vec<Who> {
    let partners = (0..draft.partners.len()).map(Who::Partner);
    let actors = (0..draft.actors.len()).map(Who::Actor);
    let objects = (0..draft.objects.len()).map(Who::Object);
    partners.chain(actors).chain(objects).chain((0..draft.obstacles.len()).map(Who::Obstacle)).collect()
}

impl Who {
    /// For sentences.
    pub fn name(self, draft: &ScenarioDraft) -> String {
        match self {
            Self::Ego => "the ego".to_owned(),
            Self::Partner(at) => draft.partners.get(at).map_or_else(String::new, |partner| partner.id.clone()),
            Self::Actor(at) => draft.actors.get(at).map_or_else(String::new, |actor| actor.id.clone()),
            Self::Object(at) => format!("thing {}", at + 1),
            Self::Obstacle(at) => format!("obstacle {}", at + 1),
        }
    }
}

/// The scenario with one small change. What a change says nothing of stays: a thing is never later or faster.
#[must_use]
pub fn nudged(draft: &ScenarioDraft, who: Who, nudge: Nudge) -> ScenarioDraft {
    let mut draft = draft.clone();
    match who {
        Who::Ego => ego(&mut draft, nudge),
        Who::Partner(at) => partner(&mut draft, at, nudge),
        Who::Actor(at) => {
            if let Some(actor) = draft.actors.get_mut(at) {
                plan(&mut actor.plan.start, &mut actor.plan.speed_mps, &mut actor.plan.acts, nudge);
                if let (Nudge::Later(by_s), true) = (nudge, actor.plan.appears_s > 0.0) {
                    actor.plan.appears_s = (actor.plan.appears_s + by_s).max(0.0);
                }
            }
        }
        Who::Object(at) => {
            if let Some(object) = draft.objects.get_mut(at) {
                place(&mut object.at, nudge);
            }
        }
        Who::Obstacle(at) => {
            if let Some(obstacle) = draft.obstacles.get_mut(at) {
                match nudge {
                    Nudge::Along(by_m) => obstacle.s_m += by_m,
                    Nudge::Across(by_m) => obstacle.t_m += by_m,
                    Nudge::Later(_) | Nudge::Faster(_) => {}
                }
            }
        }
    }
    draft
}

fn ego(draft: &mut ScenarioDraft, nudge: Nudge) {
    let ego = &mut draft.ego;
    if let (Nudge::Later(by_s), Some(handover_s)) = (nudge, ego.handover_s.as_mut()) {
        // The system under test takes over a little sooner or later; what was recorded stays.
        *handover_s = (*handover_s + by_s).max(0.0);
        return;
    }
    if let Some(recorded) = &mut ego.recorded {
        plan(&mut recorded.start, &mut recorded.speed_mps, &mut recorded.acts, nudge);
        return;
    }
    match nudge {
        Nudge::Along(by_m) => ego.s_m += by_m,
        Nudge::Later(by_s) => ego.s_m -= by_s * ego.speed_mps,
        Nudge::Faster(by) => {
            ego.speed_mps *= by;
            ego.target_speed_mps *= by;
        }
        Nudge::Across(_) => {}
    }
}

fn partner(draft: &mut ScenarioDraft, at: usize, nudge: Nudge) {
    let Some(partner) = draft.partners.get_mut(at) else { return };
    let speed_mps = partner.speed_mps.max(0.1);
    match (nudge, &mut partner.start) {
        (Nudge::Along(by_m), Start::Offset { delta_s_m, .. }) => *delta_s_m += by_m,
        (Nudge::Along(by_m), Start::ArrivalGap { arrival_gap_s }) => *arrival_gap_s -= by_m / speed_mps,
        (Nudge::Across(by_m), Start::Offset { delta_t_m, .. }) => *delta_t_m += by_m,
        (Nudge::Across(_), Start::ArrivalGap { .. }) | (Nudge::Faster(_), _) => {}
        (Nudge::Later(by_s), Start::Offset { delta_s_m, .. }) => *delta_s_m -= by_s * partner.speed_mps,
        (Nudge::Later(by_s), Start::ArrivalGap { arrival_gap_s }) => *arrival_gap_s += by_s,
    }
    if let Nudge::Later(by_s) = nudge {
        for shift in &mut partner.lateral {
            shift.start_s = (shift.start_s + by_s).max(0.0);
        }
    }
    let Nudge::Faster(by) = nudge else { return };
    partner.speed_mps *= by;
    match &mut partner.policy {
        Policy::SuddenBrake { target_speed, .. } => *target_speed *= by,
        Policy::AccelThenBrake { cruise_speed, .. } => *cruise_speed *= by,
        Policy::IdmNominal { target_speed_mps }
        | Policy::Stopped { target_speed_mps, .. }
        | Policy::Yielding { target_speed_mps, .. } => *target_speed_mps *= by,
    }
}

fn plan(start: &mut Place, speed_mps: &mut f64, acts: &mut [Act], nudge: Nudge) {
    match nudge {
        Nudge::Along(_) | Nudge::Across(_) => place(start, nudge),
        Nudge::Later(by_s) => {
            place(start, Nudge::Along(-by_s * *speed_mps));
            for act in acts {
                if let Some(Trigger::TimeS(time_s)) = &mut act.when {
                    *time_s = (*time_s + by_s).max(0.0);
                }
            }
        }
        Nudge::Faster(by) => {
            *speed_mps *= by;
            for act in acts {
                match &mut act.deed {
                    Deed::Speed { to_mps, .. } => *to_mps *= by,
                    Deed::Follow { speed_mps, .. } => *speed_mps *= by,
                    Deed::Stop { .. }
                    | Deed::Hold { .. }
                    | Deed::Shift { .. }
                    | Deed::Part { .. }
                    | Deed::Obey { .. }
                    | Deed::Leave {} => {}
                }
            }
        }
    }
}

fn place(at: &mut Place, nudge: Nudge) {
    let (forward_m, right_m) = match nudge {
        Nudge::Along(by_m) => (by_m, 0.0),
        Nudge::Across(by_m) => (0.0, by_m),
        Nudge::Later(_) | Nudge::Faster(_) => return,
    };
    match at {
        Place::Plane { x_m, y_m, heading_deg } => {
            let heading = heading_deg.to_radians();
            let (sin, cos) = (math::sin(heading), math::cos(heading));
            *x_m += forward_m * cos + right_m * sin;
            *y_m += forward_m * sin - right_m * cos;
        }
        Place::Lane { along, t_m, heading_deg, .. } => {
            // Who faces against the lane goes the other way.
            let heading = heading_deg.to_radians();
            let (sin, cos) = (math::sin(heading), math::cos(heading));
            let by_m = forward_m * cos + right_m * sin;
            match along {
                Along::FromStart(s_m) => *s_m += by_m,
                Along::BeforeEnd(s_m) => *s_m -= by_m,
            }
            *t_m += right_m * cos - forward_m * sin;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(mut at: Place, nudge: Nudge) -> Place {
        place(&mut at, nudge);
        at
    }

    #[test]
    fn along_is_where_it_faces_and_across_is_to_its_right() {
        let Place::Plane { x_m, y_m, .. } = moved(Place::at(0.0, 0.0, 90.0), Nudge::Along(2.0)) else { panic!() };
        assert!(x_m.abs() < 1e-12 && (y_m - 2.0).abs() < 1e-12);
        let Place::Plane { x_m, y_m, .. } = moved(Place::at(0.0, 0.0, 90.0), Nudge::Across(2.0)) else { panic!() };
        assert!((x_m - 2.0).abs() < 1e-12 && y_m.abs() < 1e-12);
        let against = Place::Lane {
            road: "main+".to_owned(),
            lane: 0,
            along: Along::FromStart(10.0),
            t_m: 0.0,
            heading_deg: 180.0,
        };
        let Place::Lane { along: Along::FromStart(s_m), t_m, .. } = moved(against, Nudge::Along(2.0)) else { panic!() };
        assert!((s_m - 8.0).abs() < 1e-12 && t_m.abs() < 1e-12);
    }
}
