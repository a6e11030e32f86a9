//! Random checked scenes: networks of roads, road users with plans, control. Beside the scenarios of [`super::draw`], which
//! are on the paper's maps with the paper's policies.

use recrash_model::Seed;
use recrash_model::geometry::Vec2;
use recrash_model::math::PI;
use recrash_model::seed::Rng;
use recrash_roads::{Scenario, check, read_draft};
use serde_json::{Value, json};

/// Draws until one passes the check. Most do; a thousand in a row that do not would be a fault.
const MOST_DRAWS: u32 = 1000;

/// Roads and deeds come in turn, so that each is there as often as the others.
const ROADS: usize = 4;
const DEEDS: usize = 8;

/// Kinds that drive on a road.
const DRIVEN: [&str; 9] =
    ["passenger_car", "suv", "van", "pickup_truck", "heavy_truck", "bus", "motorcycle", "first_responder", "cyclist"];
/// Kinds that walk or roll across it.
const ON_FOOT: [&str; 4] = ["pedestrian", "other_non_motorist", "animal", "fixed_object"];

/// Scene number `number` of a seed: the same whatever else is drawn.
///
/// # Panics
/// Never, in practice: where a thousand draws in a row fail the check.
pub fn random_scene(seed: u64, number: usize) -> Scenario {
    let seed = Seed(seed).child(&format!("scene {number}"));
    (0..MOST_DRAWS)
        .find_map(|draw| {
            let mut rng = seed.child(&format!("draw {draw}")).rng();
            let draft = read_draft(&scene(&mut rng, number).to_string()).ok()?.value;
            check(draft).ok()
        })
        .unwrap_or_else(|| unreachable!("most draws pass the check"))
        .value
}

/// A number in a range, as a person would write it.
fn drawn(rng: &mut Rng, low: f64, high: f64) -> f64 {
    (10.0 * rng.range(low, high)).round() / 10.0
}

fn one_of<'a>(rng: &mut Rng, items: &[&'a str]) -> &'a str {
    items[rng.below(items.len())]
}

/// A map with the road the ego drives on, and the way it takes.
struct Ground {
    map: Value,
    /// The ego's road with direction, and the whole way.
    from: &'static str,
    route: Value,
    /// Where the ego starts, from the road's beginning, and where what happens to it lies. [m]
    start_m: f64,
    place_m: f64,
    /// The beginning of the ego's road, and the way it leads there, where it is straight up to `straight_m`. [m, deg]
    origin: Vec2,
    heading_deg: f64,
    straight_m: f64,
    length_m: f64,
    /// Cross traffic: its way and where its road ends, where there is any.
    across: Option<(&'static str, Value)>,
    /// Fastest target speed that the way allows, nearly. [m/s]
    fastest_mps: f64,
}

impl Ground {
    /// A point of the plane, from its place beside the straight beginning of the ego's road. [m]
    fn point(&self, s_m: f64, t_m: f64) -> Vec2 {
        let along = Vec2::from_heading(self.heading_deg * PI / 180.0);
        self.origin + along * s_m + Vec2::new(along.y, -along.x) * t_m
    }
}

fn scene(rng: &mut Rng, number: usize) -> Value {
    let ground = if number % ROADS < 2 { street(rng, number % ROADS == 1) } else { junction(rng, number % ROADS == 3) };
    let speed_mps = drawn(rng, 5.0, ground.fastest_mps);
    let (actor, more) = deed(rng, number / ROADS % DEEDS, &ground, speed_mps);
    let control = control(rng, &ground);
    let mut ego = json!({
        "route": ground.route, "s_m": ground.start_m, "speed_mps": speed_mps, "target_speed_mps": speed_mps,
    });
    if rng.below(2) == 0 {
        // As recorded for some time; then whoever is tested takes over.
        ego["recorded"] = json!({
            "start": { "road": ground.from, "s_m": ground.start_m }, "speed_mps": speed_mps,
            "course": [{ "lanes": { "roads": ground.route } }],
        });
        ego["handover_s"] = json!(drawn(rng, 0.5, 1.5));
    }
    let mut actors = vec![actor];
    if rng.below(3) == 0 {
        let s_m = ground.start_m - drawn(rng, 12.0, 18.0);
        actors.push(json!({
            "id": "behind", "kind": one_of(rng, &DRIVEN[..4]),
            "plan": {
                "start": { "road": ground.from, "s_m": s_m }, "speed_mps": 0.8 * speed_mps,
                "course": [{ "lanes": { "roads": [ground.from] } }],
                "acts": [{ "when": { "time_s": drawn(rng, 1.0, 2.0) }, "do": { "stop": { "rate_mps2": 2.5 } } }],
            },
        }));
    }
    json!({
        "format": "recrash.scenario/2", "source": {}, "id": format!("scene-{number:04}"), "map": ground.map, "ego": ego, "actors": actors,
        "objects": more, "control": control, "duration_s": 16,
    })
}

/// A road with strips of many kinds, straight or in a bend.
fn street(rng: &mut Rng, bent: bool) -> Ground {
    let beside = |rng: &mut Rng| match rng.below(4) {
        0 => vec![json!({ "kind": "parking" })],
        1 => vec![json!({ "kind": "bike" }), json!({ "kind": "sidewalk" })],
        2 => vec![json!({ "kind": "shoulder" })],
        _ => vec![json!({ "kind": "sidewalk" })],
    };
    let driving = json!({ "kind": "driving", "width_m": drawn(rng, 3.0, 3.8) });
    let side = |rng: &mut Rng, lanes: usize| {
        let mut strips = vec![driving.clone(); lanes];
        strips.extend(beside(rng));
        strips
    };
    let (right, left) = (1 + rng.below(2), 1 + rng.below(2));
    let (right, left) = (side(rng, right), side(rng, left));
    let to = one_of(rng, &["left", "right"]);
    let radius_m = drawn(rng, 50.0, 120.0);
    let line = if bent && rng.below(2) == 0 {
        json!([
            { "straight": { "length_m": 50 } }, { "spiral": { "length_m": 20, "to_radius_m": radius_m, "to": to } },
            { "arc": { "length_m": 40, "radius_m": radius_m, "to": to } },
            { "spiral": { "length_m": 20, "from_radius_m": radius_m, "to": to } }, { "straight": { "length_m": 50 } },
        ])
    } else if bent {
        json!([
            { "straight": { "length_m": 50 } }, { "arc": { "length_m": 60, "radius_m": radius_m, "to": to } },
            { "straight": { "length_m": 70 } },
        ])
    } else {
        json!([{ "straight": { "length_m": 180 } }])
    };
    let heading_deg = drawn(rng, -90.0, 90.0);
    let road = json!({
        "id": "main", "start": { "at": { "x_m": 0, "y_m": 0, "heading_deg": heading_deg } }, "line": line,
        "right": right, "left": left,
    });
    Ground {
        map: json!({ "type": "G", "roads": [road] }),
        from: "main+",
        route: json!(["main+"]),
        start_m: drawn(rng, 22.0, 30.0),
        place_m: drawn(rng, 70.0, 100.0),
        origin: Vec2::default(),
        heading_deg,
        straight_m: if bent { 50.0 } else { 180.0 },
        length_m: 180.0,
        across: None,
        fastest_mps: if bent { 11.0 } else { 14.0 },
    }
}

/// A junction of three or four arms at angles that are not quite right.
fn junction(rng: &mut Rng, three: bool) -> Ground {
    let length_m = drawn(rng, 60.0, 80.0);
    let bearing_deg = 180.0 + drawn(rng, -12.0, 12.0);
    let arm = |id: &str, bearing_deg: f64| {
        json!({
            "id": id, "start": { "arm": { "junction": "c", "bearing_deg": bearing_deg, "from_m": 14 } },
            "line": [{ "straight": { "length_m": length_m } }], "right": [{ "kind": "driving" }], "left": [{ "kind": "driving" }],
        })
    };
    let mut around = |straight_deg: f64| straight_deg + drawn(rng, -12.0, 12.0);
    let mut roads = vec![arm("west", bearing_deg), arm("east", around(0.0)), arm("south", around(270.0))];
    if !three {
        roads.push(arm("north", around(90.0)));
    }
    let to = one_of(rng, &["east+", "east+", "south+"]);
    let leaves = if three { "west+" } else { "north+" };
    Ground {
        map: json!({ "type": "G", "roads": roads, "junctions": [{ "id": "c" }] }),
        from: "west-",
        route: json!(["west-", to]),
        start_m: drawn(rng, 20.0, 26.0),
        place_m: length_m - drawn(rng, 2.0, 14.0),
        origin: Vec2::from_heading(bearing_deg * PI / 180.0) * (length_m + 14.0),
        heading_deg: bearing_deg - 180.0,
        straight_m: length_m,
        length_m,
        across: Some(("south-", json!(["south-", leaves]))),
        fastest_mps: if to == "east+" { 12.0 } else { 7.0 },
    }
}

/// What somebody else does; and things that lie about.
fn deed(rng: &mut Rng, which: usize, ground: &Ground, speed_mps: f64) -> (Value, Value) {
    let kind = one_of(rng, &DRIVEN);
    let plan = plan_on_the_road(rng, which, ground, kind, speed_mps);
    let mut who = match (which, &ground.across) {
        (6, Some((from, way))) => who_crosses(rng, kind, from, way),
        (6 | 7, _) => who_steps_out(rng, ground),
        _ => json!({ "id": "cp", "kind": kind, "plan": plan }),
    };
    if which == 4 {
        who["kind"] = json!("passenger_car");
        who["parts"] =
            json!([{ "id": "door", "kind": "door", "x_m": 0.6, "y_m": 0.92, "length_m": 1, "width_m": 0.08 }]);
    }
    (who, things(rng, ground))
}

/// A place on the ego's road.
fn on_road(ground: &Ground, s_m: f64, t_m: f64) -> Value {
    json!({ "road": ground.from, "s_m": s_m, "t_m": t_m })
}

/// Who rides a bicycle is no faster than one. [m/s]
fn no_faster(kind: &str, mps: f64) -> f64 {
    if kind == "cyclist" { mps.min(6.0) } else { mps }
}

/// The plan of somebody on the ego's road: brakes, stands, swerves, backs up, opens a door, slows; nothing of the others.
fn plan_on_the_road(rng: &mut Rng, which: usize, ground: &Ground, kind: &str, speed_mps: f64) -> Value {
    let road = ground.from;
    let along = json!([{ "lanes": { "roads": [road] } }]);
    let at = |s_m: f64, t_m: f64| on_road(ground, s_m, t_m);
    let (ahead_m, place_m) = (ground.start_m + drawn(rng, 15.0, 25.0), ground.place_m);
    // Against a lane places count from its end.
    let until_m = ground.length_m - place_m + drawn(rng, 5.0, 15.0);
    match which {
        0 => json!({
            "start": at(ahead_m, 0.0), "speed_mps": no_faster(kind, 0.9 * speed_mps), "course": along,
            "acts": [
                { "when": { "time_s": drawn(rng, 1.0, 3.0) }, "do": { "stop": { "rate_mps2": drawn(rng, 2.0, 6.0) } } },
                { "do": { "hold": { "for_s": drawn(rng, 0.5, 3.0) } } },
                { "do": { "speed": { "to_mps": no_faster(kind, speed_mps), "rate_mps2": 2 } } },
            ],
        }),
        1 => json!({ "start": at(place_m, drawn(rng, -1.0, 1.0)) }),
        2 => json!({
            "start": at(ahead_m, 0.0), "speed_mps": no_faster(kind, drawn(rng, 3.0, 6.0)), "course": along,
            "acts": [{ "when": { "time_s": drawn(rng, 0.5, 2.0) }, "do": { "shift": { "to_t_m": drawn(rng, -1.5, 1.5), "over_m": 15 } } }],
        }),
        3 => json!({
            "start": at(place_m, 0.0),
            "course": [{ "lanes": { "roads": [road], "until_m": until_m, "against": true, "reverse": true } }],
            "acts": [{ "when": { "time_s": drawn(rng, 0.5, 3.0) }, "do": { "speed": { "to_mps": no_faster(kind, 1.8), "rate_mps2": 1 } } }],
        }),
        4 => json!({
            "start": at(place_m, drawn(rng, 2.2, 3.0)),
            "acts": [{ "when": { "time_s": drawn(rng, 0.5, 5.0) }, "do": { "part": { "part": "door", "to_deg": -70, "over_s": 1 } } }],
        }),
        5 => json!({
            "start": at(ahead_m, 0.0), "speed_mps": no_faster(kind, speed_mps), "course": along,
            "acts": [{ "when": { "time_s": drawn(rng, 0.5, 2.0) }, "do": { "speed": { "to_mps": no_faster(kind, drawn(rng, 1.0, 4.0)), "rate_mps2": 1.5 } } }],
        }),
        _ => json!(null),
    }
}

/// Somebody from the side road.
fn who_crosses(rng: &mut Rng, kind: &str, from: &str, way: &Value) -> Value {
    let mps = no_faster(kind, drawn(rng, 5.0, 10.0));
    let start = json!({ "road": from, "to_end_m": drawn(rng, 20.0, 50.0) });
    json!({ "id": "cp", "kind": kind, "plan": { "start": start, "speed_mps": mps, "course": [{ "lanes": { "roads": way } }] } })
}

/// Somebody who walks or rolls across the ego's road.
fn who_steps_out(rng: &mut Rng, ground: &Ground) -> Value {
    let kind = one_of(rng, &ON_FOOT);
    let s_m = ground.place_m.min(ground.straight_m - 4.0);
    let from = ground.point(s_m, drawn(rng, 3.0, 5.0));
    let to = ground.point(s_m, -drawn(rng, 3.0, 4.0));
    let start = json!({ "x_m": from.x, "y_m": from.y, "heading_deg": ground.heading_deg + 90.0 });
    let begin =
        json!({ "when": { "time_s": drawn(rng, 0.5, 4.0) }, "do": { "speed": { "to_mps": 1.4, "rate_mps2": 1.5 } } });
    let course = json!([{ "path": { "points": [[to.x, to.y]] } }]);
    json!({ "id": "cp", "kind": kind, "plan": { "start": start, "course": course, "acts": [begin] } })
}

/// Now and then a thing at the edge of the lane.
fn things(rng: &mut Rng, ground: &Ground) -> Value {
    if rng.below(4) != 0 {
        return json!([]);
    }
    let thing = one_of(rng, &["cone", "barrier", "debris", "container"]);
    let at = on_road(ground, ground.place_m + drawn(rng, -20.0, 20.0), drawn(rng, 1.4, 2.6));
    json!([{ "kind": thing, "at": at }])
}

/// What stands at the end of the ego's road: nothing, a signal, a sign.
fn control(rng: &mut Rng, ground: &Ground) -> Value {
    let device = match rng.below(4) {
        0 if ground.across.is_some() => json!({ "signal": { "program": [
            { "show": "red", "for_s": drawn(rng, 2.0, 7.0) }, { "show": "green", "for_s": drawn(rng, 6.0, 20.0) },
            { "show": "yellow", "for_s": 3 },
        ] } }),
        1 if ground.across.is_some() => json!({ "stop_sign": {} }),
        _ => return json!([]),
    };
    json!([{ "at": ground.from, "device": device }])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_scene_depends_on_its_seed_and_number_alone() {
        assert_eq!(random_scene(7, 3), random_scene(7, 3));
        assert_ne!(random_scene(7, 3).draft(), random_scene(8, 3).draft());
        assert_ne!(random_scene(7, 3).draft(), random_scene(7, 35).draft());
    }

    #[test]
    fn two_hundred_hold_every_road_deed_kind_and_control() {
        let mut seen: BTreeSet<String> = BTreeSet::new();
        for number in 0..200 {
            let scene = random_scene(1, number);
            let draft = serde_json::to_value(scene.draft()).unwrap();
            let texts = draft.to_string();
            for word in ["spiral", "arc\"", "arm\"", "parking", "bike", "shoulder", "sidewalk", "signal", "stop_sign"] {
                seen.extend(texts.contains(word).then(|| word.to_owned()));
            }
            for word in [
                "\"shift\"",
                "\"hold\"",
                "\"speed\"",
                "\"part\"",
                "\"path\"",
                "\"reverse\":true",
                "\"handover_s\":1",
                "\"objects\":[{",
            ] {
                seen.extend(texts.contains(word).then(|| word.to_owned()));
            }
            seen.insert(format!("kind {:?}", scene.draft().actors[0].kind));
        }
        assert_eq!(seen.len(), 9 + 8 + DRIVEN.len() + ON_FOOT.len(), "{seen:?}");
    }
}
