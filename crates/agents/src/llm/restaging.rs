//! The role that stages anew: what a model would have otherwise in a scenario whose replay does not show the crash as it is told.

use super::review::in_one_line;
use super::staging::Staging;
use super::{LanguageModel, fitting, prompts, push_repair, push_turns, read, restage_question};
use crate::{AgentError, Brief};
use recrash_model::metrics::Check;
use recrash_model::scenario::{
    Actor, ActorPlan, Author, Control, GraphMap, MapSpec, MissionStop, ObjectSpec, Part, RoadSpec, ScenarioDraft,
};
use schemars::JsonSchema;
use serde::Deserialize;

/// The form of an answer: what of the scenario is otherwise. What is not named stays as it is.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct RestageAnswer {
    /// Whether the last replay shows the crash as the reports tell it. Then nothing is changed.
    as_told: bool,
    /// Where it does not: what is told and what is shown instead, in one sentence. Else empty.
    #[serde(default)]
    #[schemars(length(max = 300))]
    note: String,
    /// Told facts of the list that the reports do not tell, each with what they tell instead, where the crash cannot be shown as told beside
    /// them. Then nothing is changed, and the account is a person's to correct.
    #[serde(default)]
    #[schemars(length(max = 8), inner(length(max = 200)))]
    wrong_facts: Vec<String>,
    /// How the subject vehicle drove, where that is otherwise.
    #[serde(default)]
    ego: Option<EgoAnswer>,
    /// Road users that do or are something else, each whole; with a new id, one more.
    #[serde(default)]
    #[schemars(length(max = 32))]
    actors: Vec<Actor>,
    /// Ids of road users that are left out.
    #[serde(default)]
    #[schemars(length(max = 32))]
    without: Vec<String>,
    /// All things that stand or lie, where one of them is otherwise.
    #[serde(default)]
    #[schemars(length(max = 64))]
    objects: Option<Vec<ObjectSpec>>,
    /// All signals and signs, where one of them is otherwise.
    #[serde(default)]
    #[schemars(length(max = 32))]
    control: Option<Vec<Control>>,
    /// Roads that are otherwise, each whole; with a new id, one more.
    #[serde(default)]
    #[schemars(length(max = 48))]
    roads: Vec<RoadSpec>,
    /// All roads, junctions and areas, where a junction or an area is otherwise, or a road is left out.
    #[serde(default)]
    map: Option<GraphMap>,
    /// The rollout ends after this time at the latest, 1 to 60. [s]
    #[serde(default)]
    #[schemars(range(min = 1.0, max = 60.0))]
    duration_s: Option<f64>,
}

/// What a model decides of the subject vehicle.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct EgoAnswer {
    /// How its recorded driver drove.
    recorded: ActorPlan,
    /// The roads it is to take, with direction, where they are others.
    #[serde(default)]
    route: Option<Vec<String>>,
    /// Its lane at the start, 0 is the leftmost, where it is another.
    #[serde(default)]
    lane: Option<u8>,
    /// Where its task has it stop, where that is otherwise.
    #[serde(default)]
    #[schemars(length(max = 16))]
    stops: Option<Vec<MissionStop>>,
    /// What sticks out of its body, where that is otherwise.
    #[serde(default)]
    parts: Option<Vec<Part>>,
}

impl RestageAnswer {
    /// What of the answer contradicts the rest of it, or names no told fact: nobody can tell which half of it is meant.
    fn contradictions(&self, now: &Staging) -> Vec<String> {
        let mut problems = Vec::new();
        let changes = self.changes();
        if !changes.is_empty() && (self.as_told || !self.wrong_facts.is_empty()) {
            let said = if self.as_told { "as_told is true" } else { "wrong_facts is given" };
            problems.push(format!("{said}, and {} is given: then nothing is changed", changes.join(", ")));
        }
        if self.as_told && !in_one_line(&self.note).is_empty() {
            problems.push(
                "as_told is true, and note is not empty: where something is shown otherwise than told, as_told is false"
                    .to_owned(),
            );
        }
        if self.as_told && now.missed.is_empty() && !self.wrong_facts.is_empty() {
            problems.push(
                "as_told is true, wrong_facts is given, and the replay misses no told fact: where it shows what the reports do \
                 not tell, as_told is false"
                    .to_owned(),
            );
        }
        let strays = self.wrong_facts.iter().filter(|fact| !now.checks.iter().any(|check| names(fact, check)));
        let mut labels: Vec<&str> = now.checks.iter().map(|check| check.kind.label()).collect();
        labels.dedup();
        problems.extend(strays.map(|fact| {
            let (fact, labels) = (in_one_line(fact), labels.join(", "));
            format!("wrong_facts: \"{fact}\" names no told fact of the list; begin each with the fact's name: {labels}")
        }));
        problems
    }

    /// The fields that change the scenario.
    fn changes(&self) -> Vec<&'static str> {
        let given = [
            ("ego", self.ego.is_some()),
            ("actors", !self.actors.is_empty()),
            ("without", !self.without.is_empty()),
            ("objects", self.objects.is_some()),
            ("control", self.control.is_some()),
            ("roads", !self.roads.is_empty()),
            ("map", self.map.is_some()),
            ("duration_s", self.duration_s.is_some()),
        ];
        given.into_iter().filter(|(_, is_given)| *is_given).map(|(field, _)| field).collect()
    }

    /// The scenario with what is otherwise in it.
    ///
    /// # Errors
    /// Nothing is otherwise, nobody says why, or somebody is left out who is not there.
    fn applied(self, draft: &ScenarioDraft, model: &str) -> Result<ScenarioDraft, Vec<String>> {
        let mut problems = Vec::new();
        if in_one_line(&self.note).is_empty() {
            problems.push("note is empty: say in one sentence what is told and what is shown instead".to_owned());
        }
        let missing = self.without.iter().filter(|id| !draft.actors.iter().any(|actor| actor.id == **id));
        problems.extend(missing.map(|id| format!("without names {id}, and there is no such road user")));
        let mut next = draft.clone();
        next.actors.retain(|actor| !self.without.contains(&actor.id));
        lay_over(&mut next.actors, self.actors, |actor| &actor.id);
        if let Some(EgoAnswer { recorded, route, lane, stops, parts }) = self.ego {
            next.ego.recorded = Some(recorded);
            next.ego.route = route.unwrap_or(next.ego.route);
            next.ego.lane = lane.unwrap_or(next.ego.lane);
            next.ego.stops = stops.unwrap_or(next.ego.stops);
            next.ego.parts = parts.unwrap_or(next.ego.parts);
        }
        next.objects = self.objects.unwrap_or(next.objects);
        next.control = self.control.unwrap_or(next.control);
        next.map = self.map.map_or(next.map, MapSpec::G);
        match &mut next.map {
            MapSpec::G(map) => lay_over(&mut map.roads, self.roads, |road| &road.id),
            _ if self.roads.is_empty() => {}
            _ => problems.push("roads: this scenario has none of its own; give map".to_owned()),
        }
        next.duration_s = self.duration_s.unwrap_or(next.duration_s);
        if next == *draft {
            problems.push("as_told is false, and nothing is otherwise in the answer".to_owned());
        }
        next.source.author = Author::Model(model.to_owned());
        if problems.is_empty() { Ok(next) } else { Err(problems) }
    }
}

/// Puts each of these in the place of the one with its id, or behind all.
fn lay_over<T>(known: &mut Vec<T>, others: Vec<T>, id: impl Fn(&T) -> &String) {
    for other in others {
        match known.iter_mut().find(|one| id(one) == id(&other)) {
            Some(one) => *one = other,
            None => known.push(other),
        }
    }
}

/// Whether a text names this told fact: by its name at the beginning, or in the words in which it is told.
fn names(text: &str, check: &Check) -> bool {
    /// A shorter text stands in many others.
    const TELLING: usize = 6;
    let text = in_one_line(text).to_lowercase();
    let text = text.trim_start_matches(|letter: char| !letter.is_alphanumeric());
    let behind = text.strip_prefix(&check.kind.label().to_lowercase());
    let is_named = behind.is_some_and(|rest| !rest.starts_with(|letter: char| letter.is_alphanumeric()));
    let expected = in_one_line(&check.expected).to_lowercase();
    is_named || (expected.len() >= TELLING && text.contains(&expected))
}

impl LanguageModel<'_> {
    /// Has the model look at the replay of a staging, and change the scenario until it finds the crash shown as it is told; every
    /// changed scenario is staged by `stage`, and its replay goes back. Gives the one that the model is content with: that which it was
    /// given, where it changed nothing.
    ///
    /// # Errors
    /// [`AgentError`], where the answers are used up before the model is content with a scenario that misses no told fact, or it says that
    /// the reports tell something else than is checked.
    pub fn restage(
        &self,
        brief: &Brief,
        given: Staging,
        stage: impl Fn(ScenarioDraft) -> Result<Staging, Vec<String>>,
    ) -> Result<Staging, AgentError> {
        let mut question = restage_question(self.model, brief, &given)?;
        let mut now = given;
        loop {
            let exchange = self.answers.answer(&question)?;
            let answered = read(&exchange.answer, &[], &question.schema).and_then(fitting::<RestageAnswer>);
            let of_form = answered.is_err();
            let clear = answered.and_then(|answer| match answer.contradictions(&now) {
                problems if problems.is_empty() => Ok(answer),
                problems => Err(problems),
            });
            let step = match clear {
                Ok(answer) if answer.as_told && now.missed.is_empty() => return Ok(now),
                Ok(answer) if !answer.wrong_facts.is_empty() => {
                    let facts: Vec<String> = answer.wrong_facts.iter().map(|fact| in_one_line(fact)).collect();
                    let (model, facts) = (self.model.to_owned(), facts.join("; "));
                    return Err(AgentError::FactsDisputed { model, facts });
                }
                Ok(answer) if answer.as_told => Err(vec![prompts::missed(&now.missed)]),
                Ok(answer) => {
                    let note = in_one_line(&answer.note);
                    answer.applied(&now.draft, self.model).and_then(&stage).map(|next| (next, note))
                }
                Err(problems) => Err(problems),
            };
            let granted =
                if of_form { self.repairs.form(self.max_repairs) } else { self.repairs.meaning(self.max_repairs) };
            match step {
                Err(problems) if !granted => return Err(self.no_usable_answer(&problems)),
                Ok(_) if !granted => {
                    let why = format!("it is not content after {} changes", now.changed.len() + 1);
                    return Err(self.no_usable_answer(&[why]));
                }
                Err(problems) => push_repair(&mut question, exchange.answer, &problems)?,
                // No answer could be taken any more.
                Ok((next, _)) if !next.missed.is_empty() && self.repairs.left(self.max_repairs) == 0 => {
                    return Err(self.no_usable_answer(&[prompts::missed_at_last(&next.missed)]));
                }
                Ok((next, note)) => {
                    push_turns(
                        &mut question,
                        exchange.answer,
                        prompts::restaged(&next, self.repairs.left(self.max_repairs))?,
                    );
                    let changed = now.changed.into_iter().chain([note]).collect();
                    now = Staging { changed, ..next };
                }
            }
        }
    }
}
