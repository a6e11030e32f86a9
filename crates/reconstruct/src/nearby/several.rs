//! The others of those who are told to be several: as the first, beside it or behind it.

use crate::draft::signals;
use crate::facts::seen::Seen;
use crate::ground::pieces::corner_m;
use crate::nearby::hinders::{CLEAR_M, hinders_nobody};
use crate::nearby::scene::Scene;
use crate::others::beside::HIDES_M;
use crate::told::others::{Extra, Role};
use crate::told::side::size_of;
use crate::told::sizes::size_of as size_of_kind;
use recrash_model::account::LeftRight;
use recrash_model::geometry::Vec2;
use recrash_model::kinds::PartnerKind;
use recrash_model::rollout::Rollout;
use recrash_model::scenario::{Actor, ActorPlan, Leg, Place, ScenarioDraft};
use recrash_model::vehicle::VehicleSpec;
use recrash_sim::Ego;

/// Between two of a queue or of a row, tried in turn; who drives ahead of or behind another keeps more. [m]
const GAPS_M: [f64; 4] = [2.5, 1.5, 4.0, 7.0];
const DRIVING_GAPS_M: [f64; 2] = [8.0, 14.0];

/// Two who walk go side by side, or one behind the other. [m]
const SIDE_BY_SIDE_M: f64 = 1.2;
const ONE_BEHIND_M: f64 = 1.6;

impl Scene<'_> {
    /// The same with as many of them as are told, each where it has room and hinders nobody.
    pub(super) fn with_more(
        &self,
        extra: &Extra,
        begun: (&ScenarioDraft, &Rollout),
    ) -> Option<(ScenarioDraft, Rollout)> {
        let mut found: Option<(ScenarioDraft, Rollout)> = None;
        for _ in 1..extra.number {
            let from = found.as_ref().map_or(begun, |(draft, rollout)| (draft, rollout));
            match self.with_another(extra, from) {
                Some(next) => found = Some(next),
                None => break,
            }
        }
        found
    }

    /// The same with another one of them: beside the first, else beside one of those that stand with it.
    fn with_another(&self, extra: &Extra, begun: (&ScenarioDraft, &Rollout)) -> Option<(ScenarioDraft, Rollout)> {
        let (draft, rollout) = begun;
        let ids = ids(extra);
        let of_them = |id: &&String| draft.actors.iter().find(|actor| actor.id == **id);
        let drawn: Vec<&Actor> = ids.iter().filter_map(|id| of_them(&id)).filter(|_| extra.several).collect();
        let first = *drawn.first().filter(|first| first.id == ids[0])?;
        let id = ids.iter().find(|id| of_them(id).is_none())?;
        let kind = extra.more.map(|kind| kind.partner_kind().unwrap_or(PartnerKind::PassengerCar));
        let (kind, size) = (kind.unwrap_or(first.kind), extra.more.map_or(first.size, size_of_kind));
        let place = |plan: ActorPlan| {
            let another = Actor { id: id.clone(), kind, size, plan, ..first.clone() };
            if self.is_in_junction(extra, &another) {
                return None;
            }
            let mut with = draft.clone();
            with.actors.push(another);
            let recorded = with.ego.recorded.clone()?;
            with.control = signals::devices(self.told, self.ground, &recorded, &with.actors);
            let scenario = recrash_roads::check(with).ok()?.value;
            let driven = recrash_sim::rehearse(&scenario, Ego::Recorded);
            let seen = Seen::new(self.told, &driven, self.contact_s);
            (hinders_nobody(id, &scenario, (rollout, &driven)) && seen.holds(extra))
                .then(|| (scenario.draft().clone(), driven))
        };
        let other_side = self.at_other_kerb(extra, draft, first);
        let beyond = self.beyond_gap(extra, first).and_then(|by| shifted(&first.plan, by));
        let beside = drawn.iter().flat_map(|actor| {
            let by = offsets(actor).unwrap_or_default();
            by.into_iter().filter_map(|by| shifted(&actor.plan, by))
        });
        beyond.into_iter().chain(other_side).chain(beside).find_map(place)
    }

    /// "came out from between two parked vans": from the first one, which stands short of where the partner comes out, to the second beyond that.
    fn beyond_gap(&self, extra: &Extra, actor: &Actor) -> Option<Vec2> {
        let between = extra.hides && matches!(extra.role, Role::Kerb | Role::Screen);
        let at = point(&actor.plan.start).filter(|_| between && actor.plan.speed_mps == 0.0)?;
        let (s_m, t_m) = self.ground.beside(at);
        let gap_m = size_of(&self.told.cp).1.max(1.0) + 2.0 * HIDES_M;
        let on_m = length_m(actor) + gap_m;
        Some(self.ground.pose(s_m + on_m, t_m).position - self.ground.pose(s_m, t_m).position)
    }

    /// "vehicles parked at both curbs": where one stands at one kerb alone, the second is at the other one first.
    fn at_other_kerb(&self, extra: &Extra, draft: &ScenarioDraft, actor: &Actor) -> Vec<ActorPlan> {
        let alone = draft.actors.iter().filter(|other| other.id.starts_with(Role::Kerb.id())).count() == 1;
        let Some(at) = point(&actor.plan.start).filter(|_| alone && extra.role == Role::Kerb && extra.side.is_none())
        else {
            return Vec::new();
        };
        let side = LeftRight::of_left(self.ground.beside(at).1);
        self.kerb(side, 0.5 * length_m(actor)).iter().map(|way| way.plan(self.contact_s)).collect()
    }

    /// Whether a vehicle that stands along the ego's road would stand in the junction.
    fn is_in_junction(&self, extra: &Extra, actor: &Actor) -> bool {
        let Some(at) = point(&actor.plan.start) else { return true };
        let stands = actor.plan.speed_mps == 0.0 && !matches!(extra.role, Role::Blocker | Role::Beyond | Role::Walker);
        let (s_m, _) = self.ground.beside(at);
        let half_m = 0.5 * length_m(actor);
        let ends_m = self.ground.first_m() + 2.0 * corner_m(self.ground.lanes);
        self.ground.junction && stands && s_m + half_m > self.ground.first_m() && s_m - half_m < ends_m
    }
}

/// The names of the first and of those with it; of those near a number names another one. At the kerbs of both sides two stand, and a third is
/// the second on its side.
fn ids(extra: &Extra) -> Vec<String> {
    let id = extra.id();
    let more = (2..=extra.number + 1).map(|number| match (extra.role, number) {
        (Role::Near, 2) => format!("{id}-too"),
        (Role::Near, number) => format!("{id}-too-{}", number - 1),
        _ => format!("{id}-{number}"),
    });
    [id.clone()].into_iter().chain(more).collect()
}

fn length_m(actor: &Actor) -> f64 {
    actor.size.map_or(VehicleSpec::of(actor.kind).length_m, |size| size.length_m)
}

/// Where the second is, from the first.
fn offsets(actor: &Actor) -> Option<Vec<Vec2>> {
    let Place::Plane { heading_deg, .. } = actor.plan.start else { return None };
    let along = Vec2::from_heading(heading_deg.to_radians());
    if matches!(actor.kind, PartnerKind::Pedestrian | PartnerKind::Cyclist | PartnerKind::Animal) {
        let aside = along.left() * (SIDE_BY_SIDE_M.max(VehicleSpec::of(actor.kind).width_m + 1.4 * CLEAR_M));
        let behind = along * (length_m(actor) + ONE_BEHIND_M);
        return Some(vec![aside, aside * -1.0, behind * -1.0, behind]);
    }
    let gaps: &[f64] = if actor.plan.speed_mps > 0.0 { &DRIVING_GAPS_M } else { &GAPS_M };
    let both = gaps.iter().flat_map(|gap_m| [gap_m + length_m(actor), -gap_m - length_m(actor)]);
    Some(both.map(|by_m| along * by_m).collect())
}

fn point(place: &Place) -> Option<Vec2> {
    match place {
        Place::Plane { x_m, y_m, .. } => Some(Vec2::new(*x_m, *y_m)),
        Place::Lane { .. } => None,
    }
}

/// The same way, so far from it.
fn shifted(plan: &ActorPlan, by: Vec2) -> Option<ActorPlan> {
    let moved = |place: &Place| match place {
        Place::Plane { x_m, y_m, heading_deg } => Some(Place::at(x_m + by.x, y_m + by.y, *heading_deg)),
        Place::Lane { .. } => None,
    };
    let leg = |leg: &Leg| match leg {
        Leg::Curve { to, reverse } => Some(Leg::Curve { to: moved(to)?, reverse: *reverse }),
        _ => None,
    };
    let course = plan.course.iter().map(leg).collect::<Option<_>>()?;
    Some(ActorPlan { start: moved(&plan.start)?, course, ..plan.clone() })
}
