//! The data the page's scripts read. The suite's stands in the page: one column a key to sort, filter or search by. A case's
//! stands in its own file: whole numbers in columns, each value as the difference from the one before.
//!
//! Positions are in mm (of the road: cm), headings in 1e-4 rad, speeds in mm/s, accelerations in cm/s^2. A value that
//! is not finite is `null`, and the next difference counts from the last finite one. `assets/data.js` reads it back.

use crate::anchor;
use crate::numbers::{column, short};
use crate::pairs::{PairView, RunTrace};
use crate::search::{self, ToldRecords};
use crate::staging;
use crate::summary::Result as Outcome;
use crate::view::{AccountRow, CaseRow, CaseView, RunRow, RunView, SuiteView};
use crate::words;
use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::{Answer, FindingKind, Series};
use recrash_model::record::CrashRecord;
use recrash_model::rollout::{ActorState, ActorTrack, EventKind, Role, Rollout, STEP_S};
use recrash_model::run::JudgedRun;
use recrash_model::selection::MapPoint;
use recrash_model::severity::Severity;
use recrash_model::tuning::TuneLog;
use recrash_roads::RoadDrawing;
use serde_json::{Value, json};

/// What reconstructions call the crash partner.
const CRASH_PARTNER: &str = "cp";

/// JSON that may stand inside a `script` element or file: nothing in it can close the element, open a comment or end a line.
pub fn embed(value: &Value) -> String {
    let mut text = value.to_string();
    for (letter, code) in
        [('<', "\\u003c"), ('>', "\\u003e"), ('&', "\\u0026"), ('\u{2028}', "\\u2028"), ('\u{2029}', "\\u2029")]
    {
        text = text.replace(letter, code);
    }
    text
}

/// What the scripts need of the suite as a whole: of the record that each case tells, and of the points that have a mark on the map
/// of the records.
pub fn suite(suite: &SuiteView, told: &ToldRecords<'_>, marks: &[&MapPoint]) -> Value {
    let records = &suite.records.records;
    let map: Vec<Value> = marks
        .iter()
        .map(|point| {
            let record = &records[point.record];
            let when = record.when.map_or_else(String::new, |when| when.to_string());
            json!([
                words::clean(&record.id.to_string(), 60),
                words::clean(&record.entity, 60),
                when,
                words::clean(&record.place, 60),
                point.cluster,
                words::clean(&record.narrative, 90),
            ])
        })
        .collect();
    json!({
        "minGap": suite.profile.failure.min_gap_m,
        "hardBraking": suite.profile.failure.hard_braking_mps2,
        "map": map,
        "clusters": suite.selection.clusters.iter().map(|cluster| json!([cluster.number, anchor::stem(&cluster.scenario_id)])).collect::<Vec<_>>(),
        "rows": rows(suite, told),
    })
}

/// Columns of the table, one value a case.
fn rows(suite: &SuiteView, told: &ToldRecords<'_>) -> Value {
    let cases = || suite.cases.iter().enumerate();
    let told = |position: usize| told.at(position);
    let texts = |of: &dyn Fn(&CrashRecord) -> String| {
        let mut names: Vec<String> = Vec::new();
        let of: Vec<Option<usize>> = cases()
            .map(|(i, _)| told(i).map(|record| index_of(&mut names, words::clean(&of(record), 80).into_owned())))
            .collect();
        json!([names, of])
    };
    let numbers = |of: &dyn Fn(&CaseRow) -> Option<f64>| {
        cases().map(|(_, case)| of(case).map_or(Value::Null, |value| short(value, 3))).collect::<Vec<_>>()
    };
    let last = |case: &CaseRow, of: fn(&RunRow) -> Option<f64>| case.last_run().and_then(of);
    json!({
        "stems": cases().map(|(_, case)| anchor::stem(&case.scenario_id)).collect::<Vec<_>>(),
        "operator": texts(&|record| record.entity.clone()),
        "city": texts(&|record| record.place.clone()),
        "kind": texts(&search::partner),
        "injury": texts(&search::injury),
        "harm": cases().map(|(i, _)| told(i).and_then(|record| record.severity.known()).map(|severity| severity as usize)).collect::<Vec<_>>(),
        "worst": cases().map(|(_, case)| short(badness(case), 3)).collect::<Vec<_>>(),
        "before": numbers(&|case| case.first_run().and_then(|run| run.min_gap_m())),
        "after": numbers(&|case| last(case, |run| run.min_gap_m())),
        "impact": numbers(&|case| last(case, |run| Some(run.metrics.contact.as_ref()?.relative_speed_mps))),
        "severity": numbers(&|case| last(case, |run| Some(run.severity.as_ref()?.harm_mps()))),
        "findings": numbers(&|case| last(case, |run| Some(finding_weight(&run.finding_kinds())))),
        "faithful": numbers(&|case| Some(match case.faithful()? { Answer::Yes => 3.0, Answer::Unchecked => 2.0, Answer::No => 1.0 })),
        "type": types(&suite.cases),
        "tags": cases().map(|(_, case)| tags(case)).collect::<Vec<_>>(),
        "words": cases().map(|(i, case)| search::words_of(case, told(i))).collect::<Vec<_>>(),
    })
}

/// Crash types: their names, and which each case is of.
fn types(cases: &[CaseRow]) -> Value {
    let mut names: Vec<String> = Vec::new();
    let of: Vec<Option<usize>> = cases
        .iter()
        .map(|case| Some(index_of(&mut names, case.account.as_ref()?.crash_type.label().to_owned())))
        .collect();
    json!([names, of])
}

/// Failures count more than odd behaviour.
fn finding_weight(kinds: &[FindingKind]) -> f64 {
    kinds.iter().map(|kind| if kind.is_failure() { 100.0 } else { 1.0 }).sum()
}

/// The order of a list that begins with the worst, which has the smallest number: failures, those in which it was struck while it
/// stood last, each by the largest change of velocity; then what came nearest to one.
fn badness(case: &CaseRow) -> f64 {
    let Some(run) = case.last_run() else { return 4000.0 };
    let harm = run.severity.as_ref().map_or(0.0, Severity::harm_mps).min(999.0);
    match Outcome::of(Some(&run.judgement)) {
        Outcome::Failed => 1000.0 - harm,
        Outcome::Struck => 2000.0 - harm,
        _ => 3000.0 + run.min_gap_m().unwrap_or(999.0).min(999.0),
    }
}

/// What a case can be filtered by.
fn tags(case: &CaseRow) -> String {
    let outcome = Outcome::of(case.last_run().map(|run| &run.judgement));
    let failed = case.last_run().map(|run| run.failed());
    let origin = case.origin.as_ref().map_or("", |origin| origin.name());
    let holds = [
        ("failed", failed == Some(true)),
        ("driving", outcome == Outcome::Failed),
        ("struck", outcome == Outcome::Struck),
        ("tuning", case.found_by_tuning()),
        ("passed", outcome == Outcome::Passed),
        ("beyond", outcome == Outcome::Passed && case.last_run().is_some_and(|run| run.brakes_beyond_tyres())),
        ("faithful", case.faithful() == Some(Answer::Yes)),
        ("unfaithful", case.faithful() == Some(Answer::No)),
        ("unchecked", case.faithful() == Some(Answer::Unchecked)),
        ("own", origin == "own"),
        ("other", origin == "other"),
        ("invented", origin == "invented"),
        ("reviewed-right", case.review.as_ref().is_some_and(|by| by.review.is_right())),
        ("reviewed-wrong", case.review.as_ref().is_some_and(|by| !by.review.is_right())),
        ("refused", case.refused.is_some()),
        ("parked", case.account.is_some() && case.before.is_some() && case.after.is_none()),
        ("met", case.situation_met() == Some(true)),
        ("unmet", case.situation_met() == Some(false)),
        ("edited", !case.edited.is_empty()),
        ("human", case.account.as_ref().is_some_and(AccountRow::human_drove)),
    ];
    holds.iter().filter(|(_, holds)| *holds).map(|(tag, _)| *tag).collect::<Vec<_>>().join(" ")
}

/// What the scripts need of one case.
pub fn case(case: &CaseView) -> Value {
    let run = |run: &RunView| staging::on(trace(&run.run, &run.series), &run.scenario, &case.drawing, &run.run);
    let runs = [case.before.as_ref().map(run), case.after.as_ref().map(run)];
    let mut data = drawn(&case.scenario_id, &case.drawing, runs, case.tune_log.as_ref().map(tune));
    if let Some(untuned) = &case.untuned {
        data["untuned"] = run(untuned);
    }
    if let Some(told_tuned) = &case.told_tuned {
        data["toldTuned"] = run(told_tuned);
    }
    if let (Some(RunTrace { run, series }), Some(last)) = (&case.reference, case.last_run()) {
        data["reference"] = staging::on(trace(run, series), &last.scenario, &case.drawing, run);
    }
    data
}

/// What the scripts need of one pair of runs of a scenario.
pub fn pair(pair: &PairView) -> Value {
    let runs = [Some(&pair.first), pair.second.as_ref()];
    let trace = |run: &RunTrace| trace(&run.run, &run.series);
    drawn(&pair.title, &pair.drawing, runs.map(|run| run.map(trace)), None)
}

fn drawn(id: &str, drawing: &RoadDrawing, [before, after]: [Option<Value>; 2], tune: Option<Value>) -> Value {
    let polyline = |points: &[Vec2]| {
        let columns = [column(points.iter().map(|p| p.x), 100.0), column(points.iter().map(|p| p.y), 100.0)];
        json!(columns)
    };
    let line_kind = |kind: crate::LineKind| match kind {
        crate::LineKind::Edge => "edge",
        crate::LineKind::LaneDivider => "lane",
        crate::LineKind::Centre => "centre",
        crate::LineKind::Guide => "guide",
        crate::LineKind::Stall => "stall",
        crate::LineKind::Stop => "stop",
    };
    let area = |area: &crate::DrawnArea| {
        let shape = match area.shape {
            crate::GroundShape::Bike => "bike",
            crate::GroundShape::Parking => "parking",
            crate::GroundShape::Shoulder => "shoulder",
            crate::GroundShape::Median => "median",
            crate::GroundShape::Sidewalk => "sidewalk",
            crate::GroundShape::Crosswalk => "crosswalk",
            crate::GroundShape::Driveway => "driveway",
            crate::GroundShape::Building => "building",
        };
        json!([shape, polyline(&area.points)])
    };
    json!({
        "id": words::clean(id, 120),
        "surfaces": drawing.surfaces.iter().map(|points| polyline(points)).collect::<Vec<_>>(),
        "areas": drawing.areas.iter().map(area).collect::<Vec<_>>(),
        "lines": drawing.lines.iter().map(|line| json!([line_kind(line.kind), polyline(&line.points)])).collect::<Vec<_>>(),
        "before": before,
        "after": after,
        "tune": tune,
    })
}

fn trace(run: &JudgedRun, series: &Series) -> Value {
    let rollout = &run.rollout;
    let obstacles = rollout.obstacles.iter().map(|obstacle| {
        let pose = obstacle.pose;
        json!([
            words::name(&obstacle.kind),
            short(pose.position.x, 3),
            short(pose.position.y, 3),
            short(pose.heading, 4),
            obstacle.length_m,
            obstacle.width_m
        ])
    });
    let mut accelerations = vec![json!([0, column(series.ego_acceleration_mps2.iter().copied(), 100.0)])];
    accelerations
        .extend(series.partners.iter().map(|p| json!([p.actor, column(p.acceleration_mps2.iter().copied(), 100.0)])));
    json!({
        "step": STEP_S,
        "end": short(rollout.termination.time_s, 3),
        "why": rollout.termination.kind.label(),
        "actors": rollout.actors.iter().map(actor).collect::<Vec<_>>(),
        "obstacles": obstacles.collect::<Vec<_>>(),
        "contacts": contacts(rollout),
        "partner": partner(run, series),
        "gaps": series.partners.iter().map(|p| json!([p.actor, column(p.gap_m.iter().copied(), 1000.0)])).collect::<Vec<_>>(),
        "accelerations": accelerations,
        "minGap": run.least_gap().map(|gap| json!([short(gap.value, 3), short(gap.time_s, 3)])),
        "events": events(run),
    })
}

/// Whose gap to the ego is told over time: who it touches, else the crash partner, else the first.
fn partner(run: &JudgedRun, series: &Series) -> Option<usize> {
    let actors = &run.rollout.actors;
    let named = |id: &str| actors.iter().position(|track| track.id == id);
    let touched = run.metrics.contact.as_ref().and_then(|contact| named(&contact.id));
    let wanted = touched.or_else(|| named(CRASH_PARTNER));
    let measured = |actor: &usize| series.partners.iter().any(|partner| partner.actor == *actor);
    wanted.filter(measured).or_else(|| series.partners.first().map(|partner| partner.actor))
}

/// What is worth a look, in the order of time: when, what kind, and in words.
fn events(run: &JudgedRun) -> Vec<Value> {
    let rollout = &run.rollout;
    let name = |actor: usize| rollout.actors.get(actor).map_or("somebody", |track| &track.id);
    let mut events: Vec<(f64, &str, String)> = Vec::new();
    for event in &rollout.events {
        events.push(match &event.kind {
            EventKind::Contact { a, b, .. } => {
                (event.time_s, "contact", format!("contact of {} and {}", name(*a), name(*b)))
            }
            EventKind::ObstacleContact { actor, .. } => {
                (event.time_s, "obstacle", format!("{} touches an obstacle", name(*actor)))
            }
            EventKind::Gone { actor } => (event.time_s, "gone", format!("{} is gone", name(*actor))),
        });
    }
    if let Some(gap) = run.least_gap() {
        let value = words::fixed(gap.value, 2).map_or_else(String::new, |value| format!(" {value} m"));
        events.push((gap.time_s, "gap", format!("least gap{value}")));
    }
    for finding in &run.findings {
        let told = matches!(finding.kind, FindingKind::Contact | FindingKind::ObstacleContact | FindingKind::NearMiss);
        if !told {
            let kind = if finding.kind == FindingKind::HardBraking { "braking" } else { "finding" };
            events.push((finding.time_s, kind, finding.kind.label().to_owned()));
        }
    }
    events.push((rollout.termination.time_s, "end", format!("end: {}", rollout.termination.kind.label())));
    events.retain(|(time_s, ..)| time_s.is_finite());
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    events.into_iter().map(|(time_s, kind, text)| json!([short(time_s, 3), kind, words::clean(&text, 120)])).collect()
}

fn actor(track: &ActorTrack) -> Value {
    let states = |of: fn(&ActorState) -> f64, scale: f64| column(track.states.iter().map(of), scale);
    json!({
        "id": words::clean(&track.id, 40),
        "role": match track.role { Role::Ego => "ego", Role::Partner => "partner", Role::Traffic => "traffic", Role::Part => "part" },
        "shape": shape(track.kind),
        "length": track.length_m,
        "width": track.width_m,
        "from": track.appears_s,
        "until": track.gone_s,
        "x": states(|state| state.x, 1000.0),
        "y": states(|state| state.y, 1000.0),
        "heading": states(|state| state.heading, 10_000.0),
        "speed": states(ActorState::speed, 1000.0),
        "throttle": states(|state| state.throttle, 20.0),
    })
}

/// Which picture stands for a kind of road user.
fn shape(kind: PartnerKind) -> &'static str {
    match kind {
        PartnerKind::Motorcycle | PartnerKind::Cyclist => "bike",
        PartnerKind::Pedestrian | PartnerKind::OtherNonMotorist | PartnerKind::Animal => "person",
        PartnerKind::HeavyTruck | PartnerKind::Bus => "truck",
        PartnerKind::FixedObject => "object",
        _ => "car",
    }
}

/// Time, place and partners of each contact.
fn contacts(rollout: &Rollout) -> Vec<Value> {
    let outline = |actor: usize, state: &ActorState| {
        let track = rollout.actors.get(actor)?;
        Some(OrientedBox::new(state.pose(), track.length_m, track.width_m))
    };
    let contact = |event: &recrash_model::rollout::Event| {
        let (at, actor) = match &event.kind {
            EventKind::Contact { a, b, a_state, b_state } => {
                (touching_point(&outline(*a, a_state)?, &outline(*b, b_state)?), *a)
            }
            EventKind::ObstacleContact { actor, obstacle, state } => {
                (touching_point(&outline(*actor, state)?, &rollout.obstacles.get(*obstacle)?.outline()), *actor)
            }
            EventKind::Gone { .. } => return None,
        };
        Some(json!([short(event.time_s, 3), short(at.x, 3), short(at.y, 3), actor]))
    };
    rollout.events.iter().filter_map(contact).collect()
}

/// A point of the contact: the middle of the corners of either box that lie in the other (with a hand's breadth to
/// spare), or of the nearest points.
fn touching_point(a: &OrientedBox, b: &OrientedBox) -> Vec2 {
    let inside = |of: &OrientedBox, point: &Vec2| {
        let local = of.to_local(*point);
        local.x.abs() <= of.half_length + 0.1 && local.y.abs() <= of.half_width + 0.1
    };
    let mut points: Vec<Vec2> = a.corners().into_iter().filter(|point| inside(b, point)).collect();
    points.extend(b.corners().into_iter().filter(|point| inside(a, point)));
    if points.is_empty() {
        let (near_a, near_b, _) = a.nearest_points(b);
        points = vec![near_a, near_b];
    }
    let sum = points.iter().fold(Vec2::default(), |sum, point| sum + *point);
    sum * (1.0 / points.len() as f64)
}

fn tune(log: &TuneLog) -> Value {
    let mut by: Vec<&str> = Vec::new();
    let mut reasons: Vec<String> = Vec::new();
    let points: Vec<Value> = log
        .points
        .iter()
        .map(|point| {
            let proposer = index_of(&mut by, point.proposed_by.as_str());
            let refused =
                point.score.refused.iter().map(|why| index_of(&mut reasons, words::clean(why, 200).into_owned()));
            let refused: Vec<usize> = refused.collect();
            json!([
                short(point.score.objective, 3),
                point.score.min_gap.map(|gap| short(gap.value, 3)),
                usize::from(point.score.failed),
                proposer,
                refused,
                point.values.iter().map(|value| short(*value, 3)).collect::<Vec<_>>(),
            ])
        })
        .collect();
    let best = log.points.iter().position(|point| point.number == log.best);
    let names = log.parameters.iter().map(|p| words::clean(&p.pointer, 120)).collect::<Vec<_>>();
    let by: Vec<_> = by.iter().map(|name| words::clean(name, 40)).collect();
    json!({ "points": points, "by": by, "reasons": reasons, "parameters": names, "best": best })
}

fn index_of<T: PartialEq>(list: &mut Vec<T>, item: T) -> usize {
    list.iter().position(|known| *known == item).unwrap_or_else(|| {
        list.push(item);
        list.len() - 1
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_json_cannot_leave_its_element() {
        let text = embed(&json!({"a": "</script><!--<img onerror=x>&amp;"}));
        assert!(!text.contains(['<', '>', '&']), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), json!({"a": "</script><!--<img onerror=x>&amp;"}));
    }

    #[test]
    fn boxes_nose_to_side_touch_between_the_corners_of_the_nose() {
        use recrash_model::geometry::Pose;
        let at = |x: f64, y: f64, heading: f64| OrientedBox::new(Pose { position: Vec2::new(x, y), heading }, 4.0, 2.0);
        let point = touching_point(&at(0.0, 0.0, 0.0), &at(3.0, 0.5, recrash_model::math::FRAC_PI_2));
        assert!((point.x - 2.0).abs() < 1e-9 && point.y.abs() < 1e-9, "{point:?}");
    }
}
