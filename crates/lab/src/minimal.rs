//! Minimal failures: a failing scenario stripped to what it needs, and the nearest one that passes beside it. Described in
//! `docs/models/minimal.md`.
//!
//! An element is a piece of the scenario's JSON that can be taken away, or a number that can be set back. What cannot be run
//! without something else is no element: taking it away says nothing.

use crate::judging::run_scenario;
use crate::perturb::{Nudge, Who, nudged, others};
use recrash_model::metrics::FindingKind;
use recrash_model::profile::SystemProfile;
use recrash_model::scenario::ScenarioDraft;
use recrash_roads::{RunError, Simulator};
use serde::Serialize;
use serde_json::{Number, Value};

/// How far somebody is moved to find a twin that passes, in order. [m]
const MOVES_M: [f64; 13] = [0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0];
/// Halvings between the last move that fails and the first that passes.
const HALVINGS: usize = 6;

/// What can be taken away of the whole scenario, of a partner, of an actor and of the ego; the largest first.
const OF_SCENARIO: [&str; 5] = ["partners", "actors", "objects", "obstacles", "control"];
const OF_PARTNER: [&str; 1] = ["lateral"];
const OF_ACTOR: [&str; 2] = ["parts", "plan/acts"];
const OF_EGO: [&str; 3] = ["parts", "stops", "recorded/acts"];

/// A failing scenario and what it needs.
#[derive(Debug, Clone, PartialEq)]
pub struct MinimalFailure {
    /// The scenario without what it does not need; its gravest failure is there as before, a contact with the same one.
    pub draft: ScenarioDraft,
    /// What was taken away or set back, in order.
    pub taken: Vec<String>,
    /// What is left: without any one of these that failure is gone.
    pub needed: Vec<Needed>,
    /// The nearest scenario that passes; `None` where none was found, such as where the ego fails by itself.
    pub twin: Option<Twin>,
    /// Scenarios that were run.
    pub runs: usize,
}

/// An element that the failure needs.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Needed {
    /// What it is.
    pub name: String,
    /// Where it stands in the scenario (JSON pointer).
    pub pointer: String,
}

/// A scenario that passes, near one that fails.
#[derive(Debug, Clone, PartialEq)]
pub struct Twin {
    /// The scenario.
    pub draft: ScenarioDraft,
    /// What is different.
    pub difference: String,
    /// By how much somebody is moved; absent where something was taken away. [m]
    pub moved_m: Option<f64>,
}

/// One thing that may be taken away, or set back to a value.
#[derive(Debug, Clone, PartialEq)]
struct Element {
    pointer: String,
    name: String,
    set_back: Option<Value>,
}

/// How a draft comes out beside the failure that is stripped.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// It fails so as well.
    Same,
    /// It fails otherwise.
    Otherwise,
    Passes,
}

/// Runs drafts and counts them.
struct Trial<'a> {
    simulator: &'a dyn Simulator,
    profile: &'a SystemProfile,
    /// The failure that is stripped; `None` where there is none.
    failure: Option<Failure>,
    runs: usize,
}

impl<'a> Trial<'a> {
    /// For the failure of a draft.
    fn of(draft: &ScenarioDraft, simulator: &'a dyn Simulator, profile: &'a SystemProfile) -> Result<Self, RunError> {
        let mut trial = Self { simulator, profile, failure: None, runs: 0 };
        trial.failure = trial.failures(draft)?.and_then(|failures| failures.into_iter().next());
        Ok(trial)
    }

    /// Failures of a draft, the gravest first; `None` where it may not be run.
    fn failures(&mut self, draft: &ScenarioDraft) -> Result<Option<Vec<Failure>>, RunError> {
        self.runs += 1;
        let Ok(checked) = recrash_roads::check(draft.clone()) else { return Ok(None) };
        let run = run_scenario(&checked.value, self.simulator, self.profile, None)?;
        let mut kinds: Vec<FindingKind> = run.failures().collect();
        kinds.sort_unstable_by_key(|kind| (!kind.is_crash(), *kind));
        let with = |kind| run.metrics.contact.as_ref().filter(|_| kind == FindingKind::Contact).map(|it| it.id.clone());
        Ok(Some(kinds.into_iter().map(|kind| Failure { kind, with: with(kind) }).collect()))
    }

    /// How it comes out; `None` where it may not be run.
    fn outcome(&mut self, draft: &ScenarioDraft) -> Result<Option<Outcome>, RunError> {
        Ok(self.failures(draft)?.map(|failures| match &self.failure {
            _ if failures.is_empty() => Outcome::Passes,
            Some(failure) if failures.contains(failure) => Outcome::Same,
            _ => Outcome::Otherwise,
        }))
    }
}

/// A failure: its kind, and with whom a contact is.
#[derive(PartialEq, Eq)]
struct Failure {
    kind: FindingKind,
    with: Option<String>,
}

/// Strips a failing scenario. `record` is the scenario as its record tells it, where this one was varied: numbers go back to it.
///
/// # Errors
/// The simulator or the ego failed.
pub fn minimal(
    draft: &ScenarioDraft,
    record: Option<&ScenarioDraft>,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
) -> Result<MinimalFailure, RunError> {
    let mut trial = Trial::of(draft, simulator, profile)?;
    let record = record.map(|draft| serde_json::to_value(draft).unwrap_or_default());
    let mut current = draft.clone();
    let mut taken = Vec::new();
    let (needed, passing) = loop {
        let (mut needed, mut passing, mut at, mut found) = (Vec::new(), Vec::new(), 0, false);
        loop {
            let Some(element) = elements(&current, record.as_ref()).into_iter().nth(at) else { break };
            let without = without(&current, &element);
            match without.as_ref().map(|draft| trial.outcome(draft)).transpose()?.flatten() {
                Some(Outcome::Same) => {
                    current = without.unwrap_or(current);
                    taken.push(element.name);
                    found = true;
                    continue;
                }
                Some(outcome) => {
                    needed.push(Needed { name: element.name.clone(), pointer: element.pointer });
                    let passes = without.filter(|_| outcome == Outcome::Passes);
                    passing.extend(passes.map(|draft| (element.name, draft)));
                }
                None => {}
            }
            at += 1;
        }
        // What was needed may be needed no more once something else is gone.
        if !found {
            break (needed, passing);
        }
    };
    let twin = match moved_twin(&current, &mut trial)? {
        Some(twin) => Some(twin),
        // The last elements are the smallest.
        None => passing.into_iter().next_back().map(|(name, draft)| Twin {
            draft,
            difference: format!("without {name}"),
            moved_m: None,
        }),
    };
    Ok(MinimalFailure { draft: current, taken, needed, twin, runs: trial.runs })
}

/// Every single element of a scenario taken away: what it is, and whether the rest fails so as well; `None` where the rest may not be
/// run. For whoever checks that a failure is minimal.
///
/// # Errors
/// The simulator or the ego failed.
pub fn without_each(
    draft: &ScenarioDraft,
    record: Option<&ScenarioDraft>,
    simulator: &dyn Simulator,
    profile: &SystemProfile,
) -> Result<Vec<(String, Option<bool>)>, RunError> {
    let record = record.map(|draft| serde_json::to_value(draft).unwrap_or_default());
    let mut trial = Trial::of(draft, simulator, profile)?;
    let each = |element: Element| {
        let rest = without(draft, &element);
        let outcome = rest.map(|draft| trial.outcome(&draft)).transpose()?.flatten();
        Ok((element.name, outcome.map(|outcome| outcome == Outcome::Same)))
    };
    elements(draft, record.as_ref()).into_iter().map(each).collect()
}

/// The scenario without an element; `None` where that is none any more.
fn without(draft: &ScenarioDraft, element: &Element) -> Option<ScenarioDraft> {
    let mut document = serde_json::to_value(draft).ok()?;
    match &element.set_back {
        Some(value) => *document.pointer_mut(&element.pointer)? = value.clone(),
        None => {
            let (parent, last) = element.pointer.rsplit_once('/')?;
            match document.pointer_mut(parent)? {
                Value::Array(list) => drop(list.remove(last.parse().ok()?)),
                Value::Object(fields) => drop(fields.remove(last)?),
                _ => return None,
            }
        }
    }
    let changed: ScenarioDraft = serde_json::from_value(document).ok()?;
    (changed != *draft).then_some(changed)
}

/// Elements of a scenario, the largest first.
fn elements(draft: &ScenarioDraft, record: Option<&Value>) -> Vec<Element> {
    let Ok(document) = serde_json::to_value(draft) else { return Vec::new() };
    let mut all = Vec::new();
    lists(&document, "", &OF_SCENARIO, &mut all);
    if draft.traffic.density > 0.0 {
        all.push(set_back("/traffic/density", "background traffic", Value::from(0.0)));
    }
    for at in 0..draft.actors.len() {
        lists(&document, &format!("/actors/{at}"), &OF_ACTOR, &mut all);
    }
    for at in 0..draft.partners.len() {
        lists(&document, &format!("/partners/{at}"), &OF_PARTNER, &mut all);
    }
    lists(&document, "/ego", &OF_EGO, &mut all);
    if let Some(record) = record {
        numbers(&document, [&document, record], String::new(), &mut all);
    }
    settings(&document, &mut all);
    all
}

fn set_back(pointer: &str, name: &str, value: Value) -> Element {
    Element { pointer: pointer.to_owned(), name: name.to_owned(), set_back: Some(value) }
}

/// Members of lists.
fn lists(document: &Value, parent: &str, names: &[&str], all: &mut Vec<Element>) {
    for name in names {
        let list = format!("{parent}/{name}");
        let members = document.pointer(&list).and_then(Value::as_array).map_or(0, Vec::len);
        for at in 0..members {
            let pointer = format!("{list}/{at}");
            let id = document.pointer(&format!("{pointer}/id")).and_then(Value::as_str);
            let name = match id {
                Some(id) => id.to_owned(),
                None => spoken(document, &pointer),
            };
            all.push(Element { pointer, name, set_back: None });
        }
    }
}

/// Numbers that an element leaves at nought when it is taken away: they do not go back to the record, or it would come and go for ever.
const NOUGHT: [&str; 4] = ["/traffic/density", "/start/delta_t_m", "/start/t_m", "/start/heading_deg"];

fn is_taken(now: &Number, pointer: &str) -> bool {
    now.as_f64() == Some(0.0) && NOUGHT.iter().any(|name| pointer.ends_with(name))
}

/// Numbers that are not the record's. Where a list is another one, its numbers say nothing.
fn numbers(whole: &Value, [document, record]: [&Value; 2], pointer: String, all: &mut Vec<Element>) {
    match (document, record) {
        (Value::Number(now), Value::Number(told)) if now != told && !is_taken(now, &pointer) => {
            let name = format!("{}: {now} where the record has {told}", spoken(whole, &pointer));
            all.push(Element { pointer, name, set_back: Some(record.clone()) });
        }
        (Value::Object(now), Value::Object(told)) => {
            for (name, value) in now.iter().filter(|(name, _)| !matches!(name.as_str(), "source" | "map")) {
                if let Some(other) = told.get(name) {
                    numbers(whole, [value, other], format!("{pointer}/{name}"), all);
                }
            }
        }
        (Value::Array(now), Value::Array(told)) if now.len() == told.len() => {
            for (at, (value, other)) in now.iter().zip(told).enumerate() {
                numbers(whole, [value, other], format!("{pointer}/{at}"), all);
            }
        }
        _ => {}
    }
}

/// Settings that are not as they are where nobody says anything.
fn settings(document: &Value, all: &mut Vec<Element>) {
    let defaults = serde_json::to_value(recrash_model::scenario::Environment::default()).unwrap_or_default();
    for (name, usual) in defaults.as_object().into_iter().flatten() {
        let pointer = format!("/environment/{name}");
        if let Some(now) = document.pointer(&pointer).filter(|now| *now != usual) {
            all.push(set_back(&pointer, &format!("{name}: {}", bare(now)), usual.clone()));
        }
    }
    if document.get("after_contact_s").is_some() {
        all.push(Element {
            pointer: "/after_contact_s".to_owned(),
            name: "time after the contact".to_owned(),
            set_back: None,
        });
    }
    for group in ["partners", "actors"] {
        let members = document.get(group).and_then(Value::as_array).map_or(0, Vec::len);
        for at in 0..members {
            let owner = format!("/{group}/{at}");
            own_settings(document, &owner, all);
        }
    }
    own_settings(document, "/ego", all);
}

/// Settings of one road user: its kind, its size, where it is beside its lane's middle.
fn own_settings(document: &Value, owner: &str, all: &mut Vec<Element>) {
    let at = |name: &str| document.pointer(&format!("{owner}/{name}"));
    if at("kind").is_some_and(|kind| kind != "passenger_car") {
        let pointer = format!("{owner}/kind");
        let name = format!("{}: {}", spoken(document, &pointer), at("kind").map_or_else(String::new, bare));
        all.push(Element { pointer, name, set_back: Some(Value::from("passenger_car")) });
    }
    for name in ["size", "plan/obeys_control", "plan/appears_s", "policy/speed_kp"] {
        if at(name).is_some_and(|value| !value.is_null()) {
            let pointer = format!("{owner}/{name}");
            all.push(Element { name: spoken(document, &pointer), pointer, set_back: None });
        }
    }
    for name in ["start/delta_t_m", "plan/start/t_m", "plan/start/heading_deg"] {
        let is_lane = !name.ends_with("heading_deg") || at("plan/start/road").is_some();
        if is_lane && at(name).and_then(Value::as_f64).is_some_and(|value| value != 0.0) {
            let pointer = format!("{owner}/{name}");
            all.push(Element { name: spoken(document, &pointer), pointer, set_back: Some(Value::from(0.0)) });
        }
    }
}

/// What a pointer leads to, in words: which field, as the format calls it, and whose.
fn spoken(document: &Value, pointer: &str) -> String {
    let counted = |word: &str| word.parse::<usize>().map_or_else(|_| word.to_owned(), |at| (at + 1).to_string());
    let words: Vec<&str> = pointer.trim_start_matches('/').split('/').collect();
    let (owner, fields) = match words[..] {
        ["ego", ref fields @ ..] => ("the ego".to_owned(), fields),
        [list @ ("partners" | "actors" | "objects" | "obstacles"), at, ref fields @ ..] => {
            let id = document.pointer(&format!("/{list}/{at}/id")).and_then(Value::as_str);
            let kind = if list == "objects" { "thing" } else { list.trim_end_matches('s') };
            (id.map_or_else(|| format!("{kind} {}", counted(at)), str::to_owned), fields)
        }
        ref others => return others.iter().map(|word| counted(word)).collect::<Vec<_>>().join(" "),
    };
    // These say only where in the format a field stands.
    let fields: Vec<String> =
        fields.iter().filter(|word| !["plan", "start", "policy"].contains(word)).map(|word| counted(word)).collect();
    if fields.is_empty() { owner } else { format!("{} of {owner}", fields.join(" ")) }
}

/// A value without the quotation marks of JSON.
fn bare(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The least move of one other that makes the scenario pass.
fn moved_twin(draft: &ScenarioDraft, trial: &mut Trial) -> Result<Option<Twin>, RunError> {
    let ways = [
        (Nudge::Along(1.0), "farther along its way"),
        (Nudge::Along(-1.0), "farther back"),
        (Nudge::Across(1.0), "farther to its right"),
        (Nudge::Across(-1.0), "farther to its left"),
    ];
    let everyone = others(draft);
    let mut before_m = 0.0;
    for by_m in MOVES_M {
        for &who in &everyone {
            for (way, how) in ways {
                let at = |by_m: f64| nudged(draft, who, way.times(by_m));
                if trial.outcome(&at(by_m))? != Some(Outcome::Passes) {
                    continue;
                }
                let (mut fails_m, mut passes_m): (f64, f64) = (before_m, by_m);
                for _ in 0..HALVINGS {
                    let middle_m = 0.5 * (fails_m + passes_m);
                    match trial.outcome(&at(middle_m))? {
                        Some(Outcome::Passes) => passes_m = middle_m,
                        _ => fails_m = middle_m,
                    }
                }
                return Ok(Some(twin(draft, who, at(passes_m), how, passes_m)));
            }
        }
        before_m = by_m;
    }
    Ok(None)
}

fn twin(draft: &ScenarioDraft, who: Who, moved: ScenarioDraft, how: &str, by_m: f64) -> Twin {
    let by = if by_m < 0.1 { format!("{:.1} cm", 100.0 * by_m) } else { format!("{by_m:.2} m") };
    let difference = format!("{} {by} {how}", who.name(draft));
    Twin { draft: moved, difference, moved_m: Some(by_m) }
}
