//! The paper's own way of writing scenarios, converted into drafts.
//!
//! The paper (Parashar and Fan) names the variables, not a file layout. Read here are its names, flat or with the crash
//! partners in a list; what it leaves open is filled with MetaDrive's defaults, and one note says with what.

use crate::json_parts::{Parts, brief, policy};
use recrash_model::Diagnostic;
use recrash_model::kinds::PartnerKind;
use recrash_model::scenario::{
    Approach, CrossMap, CurveMap, EgoSpec, Environment, MapSpec, MissingArm, Obstacle, ObstacleKind, Partner,
    RoundaboutMap, SCENARIO_FORMAT, ScenarioDraft, Source, Start, StraightMap, TeeMap, Traffic, Turn,
};
use recrash_model::{Location, Severity};
use serde_json::{Map, Value, json};

/// Names of the list of crash partners.
const PARTNER_LISTS: [&str; 4] = ["cps", "crash_partners", "partners", "vehicles"];

/// Names of the list of cones.
const OBSTACLE_LISTS: [&str; 3] = ["cones", "static_obstacles", "obstacles"];

/// Fields of one crash partner.
const PARTNER_FIELDS: [&str; 11] = [
    "id",
    "direction",
    "lane_offset",
    "delta_s_m",
    "delta_t_m",
    "policy",
    "params",
    "lead_turn",
    "turn",
    "speed_mps",
    "kind",
];

/// MetaDrive's default number of lanes; from the middle one all of -1, 0, +1 can be reached.
const LANES: u8 = 3;

/// MetaDrive's default start of the ego on its lane. [m]
const EGO_START_M: f64 = 5.0;

/// Free road before and behind what was placed. [m]
const MARGIN_M: f64 = 40.0;

/// Whether an object is in the paper's dialect: it has no format tag and uses a name only the paper uses.
pub(crate) fn speaks(object: &Map<String, Value>) -> bool {
    !object.contains_key("format")
        && (object.contains_key("map_type")
            || object.contains_key("ego_turn")
            || object.contains_key("lead_turn")
            || object.contains_key("direction")
            || object.get("map").is_some_and(Value::is_string))
}

/// Converts an object; `None` with errors where it cannot be understood.
pub(crate) fn convert(object: &Map<String, Value>, parts: &mut Parts) -> Option<ScenarioDraft> {
    let mut fields = Fields { object, path: String::new(), used: Vec::new() };
    let letter = fields.word(&["map_type", "map"], parts)?.unwrap_or_else(|| "X".to_owned());
    let id = fields.word(&["id", "scenario_id", "name"], parts)?.unwrap_or_else(|| "paper-scenario".to_owned());
    let ego_turn = turn(fields.word(&["ego_turn"], parts)?, "ego_turn", parts)?;
    let lead_turn = turn(fields.word(&["lead_turn"], parts)?, "lead_turn", parts)?;
    let target = fields
        .number(&["ego_target_speed_mps", "ego_target_speed", "target_speed_mps", "target_speed", "ego_speed"], parts)?
        .unwrap_or(30.0 / 3.6);
    let density = fields.number(&["traffic_density", "density"], parts)?.unwrap_or(0.0);
    let seed = fields.number(&["seed"], parts)?.unwrap_or(0.0);
    let narrative = fields.word(&["narrative", "description"], parts)?.unwrap_or_default();
    let duration_s = fields.number(&["duration_s"], parts)?.unwrap_or(40.0);

    let partners = partners(&mut fields, lead_turn, parts)?;
    let behind = partners.iter().map(|partner| -offset(partner)).fold(0.0, f64::max);
    let ahead = partners.iter().map(offset).fold(0.0, f64::max);
    let ego_s = EGO_START_M + behind.min(200.0);
    let approach_m = (ego_s + MARGIN_M).clamp(60.0, 300.0);
    let obstacles = obstacles(&mut fields, ego_s, parts)?;
    fields.warn_unused(parts);
    let map = map(&letter, approach_m, (ahead + MARGIN_M).clamp(60.0, 300.0), parts)?;
    note(&map, ego_s, parts);
    Some(ScenarioDraft {
        format: SCENARIO_FORMAT.to_owned(),
        id,
        source: Source { narrative, ..serde_json::from_value(json!({})).ok()? },
        map,
        ego: EgoSpec {
            turn: ego_turn,
            lane: LANES / 2,
            s_m: ego_s,
            speed_mps: target,
            target_speed_mps: target,
            ..EgoSpec::default()
        },
        partners,
        obstacles,
        // A seed is a whole number; what is none becomes the nearest.
        traffic: Traffic { density, seed: seed.abs() as u64 },
        environment: Environment::default(),
        duration_s,
        ..ScenarioDraft::default()
    })
}

/// The crash partners: the one that stands flat beside the ego's fields, and those of the lists.
fn partners(fields: &mut Fields<'_>, lead_turn: Turn, parts: &mut Parts) -> Option<Vec<Partner>> {
    let mut partners = Vec::new();
    if fields.object.contains_key("direction") {
        fields.used.extend(PARTNER_FIELDS);
        partners.push(partner(fields.object, "", 1, lead_turn, parts)?);
    }
    for name in PARTNER_LISTS {
        let Some(items) = fields.list(name, parts)? else { continue };
        for (position, item) in items.iter().enumerate() {
            let path = format!("{name}[{position}]");
            let Value::Object(item) = item else {
                parts.error("scenario.type", &path, format!("{} is no partner", brief(item)), "write { ... }");
                return None;
            };
            let converted = partner(item, &path, partners.len() + 1, lead_turn, parts)?;
            partners.push(converted);
        }
    }
    Some(partners)
}

/// The obstacles of the lists, for an ego that starts here. [m]
fn obstacles(fields: &mut Fields<'_>, ego_s: f64, parts: &mut Parts) -> Option<Vec<Obstacle>> {
    let mut obstacles = Vec::new();
    for name in OBSTACLE_LISTS {
        let Some(items) = fields.list(name, parts)? else { continue };
        for (position, item) in items.iter().enumerate() {
            obstacles.push(obstacle(item, &format!("{name}[{position}]"), ego_s, parts)?);
        }
    }
    Some(obstacles)
}

fn note(map: &MapSpec, ego_s: f64, parts: &mut Parts) {
    let message = format!(
        "read as the paper's dialect, which says nothing on the road's size: taken are map {} with {LANES} lanes of 3.5 m, \
         the ego in lane {} at {ego_s} m, driving at the speed it wants",
        map.letter(),
        LANES / 2
    );
    let note = Diagnostic::new(Severity::Note, "scenario.paper-dialect", Location::default(), message);
    parts.diagnostics.push(note.with_hint("write it as recrash.scenario/1 to choose them"));
}

fn offset(partner: &Partner) -> f64 {
    match partner.start {
        Start::Offset { delta_s_m, .. } if delta_s_m.is_finite() => delta_s_m,
        _ => 0.0,
    }
}

fn map(letter: &str, approach_m: f64, arm_m: f64, parts: &mut Parts) -> Option<MapSpec> {
    let (lanes, lane_width_m) = (LANES, 3.5);
    Some(match letter {
        "X" | "I" => MapSpec::X(CrossMap { lanes, lane_width_m, approach_m, arm_m }),
        "T" => MapSpec::T(TeeMap { lanes, lane_width_m, approach_m, arm_m, missing: MissingArm::Left }),
        "O" => MapSpec::O(RoundaboutMap {
            lanes,
            lane_width_m,
            approach_m,
            arm_m,
            exit_radius_m: 10.0,
            inner_radius_m: 30.0,
        }),
        "C" => MapSpec::C(CurveMap {
            lanes,
            lane_width_m,
            approach_m,
            radius_m: 50.0,
            angle_deg: 90.0,
            direction: recrash_model::narrative::Side::Left,
            length_m: arm_m,
        }),
        "S" => MapSpec::S(StraightMap { lanes, lane_width_m, approach_m, length_m: (2.0 * arm_m).min(600.0) }),
        _ => {
            let shown: String = letter.chars().take(40).collect();
            let hint =
                "allowed: X or I (four-way intersection), T (three-way), O (roundabout), C (curve), S (straight)";
            parts.error("scenario.unknown-value", "map", format!("there is no map type {shown:?}"), hint);
            return None;
        }
    })
}

fn turn(word: Option<String>, path: &str, parts: &mut Parts) -> Option<Turn> {
    match word.as_deref() {
        None | Some("straight") => Some(Turn::Straight),
        Some("left") => Some(Turn::Left),
        Some("right") => Some(Turn::Right),
        Some(other) => {
            let shown: String = other.chars().take(40).collect();
            parts.error(
                "scenario.unknown-value",
                path,
                format!("there is no turn {shown:?}"),
                "allowed: left, right, straight",
            );
            None
        }
    }
}

fn partner(
    object: &Map<String, Value>,
    path: &str,
    number: usize,
    lead_turn: Turn,
    parts: &mut Parts,
) -> Option<Partner> {
    let mut fields = Fields { object, path: path.to_owned(), used: Vec::new() };
    let id = fields.word(&["id"], parts)?.unwrap_or_else(|| format!("cp{number}"));
    let approach = match fields.word(&["direction"], parts)?.as_deref() {
        None | Some("same") => Approach::Same,
        Some("opposite") => Approach::Opposite,
        Some("left") => Approach::Left,
        Some("right") => Approach::Right,
        Some(other) => {
            let shown: String = other.chars().take(40).collect();
            let message = format!("there is no direction {shown:?}");
            parts.error("scenario.unknown-value", &fields.at("direction"), message, "allowed: same, opposite");
            return None;
        }
    };
    let own_turn = fields.word(&["turn", "lead_turn"], parts)?;
    let turn = if own_turn.is_some() { turn(own_turn, &fields.at("turn"), parts)? } else { lead_turn };
    let lane_offset = fields.number(&["lane_offset"], parts)?.unwrap_or(0.0);
    if lane_offset.fract() != 0.0 || lane_offset.abs() > 4.0 {
        let message = format!("lane_offset is {lane_offset}, not a number of lanes");
        parts.error("scenario.type", &fields.at("lane_offset"), message, "allowed: -1, 0, 1");
        return None;
    }
    let delta_s_m = fields.number(&["delta_s_m"], parts)?.unwrap_or(0.0);
    let delta_t_m = fields.number(&["delta_t_m"], parts)?.unwrap_or(0.0);
    let policy = partner_policy(&mut fields, parts)?;
    let speed_mps = fields.number(&["speed_mps"], parts)?.unwrap_or_else(|| policy.target_speed());
    let kind = match fields.object.get("kind") {
        Some(kind) => parts.read(kind, &fields.at("kind"))?,
        None => PartnerKind::default(),
    };
    fields.used.extend(["kind", "policy", "params"]);
    if !path.is_empty() {
        fields.warn_unused(parts);
    }
    Some(Partner {
        id,
        kind,
        approach,
        turn,
        // A whole number between -4 and 4.
        lane_offset: lane_offset as i8,
        start: Start::Offset { delta_s_m, delta_t_m },
        speed_mps,
        policy,
        lateral: Vec::new(),
    })
}

/// `policy` is a name with `params` beside it, or an object with its name and its parameters.
fn partner_policy(fields: &mut Fields<'_>, parts: &mut Parts) -> Option<recrash_model::scenario::Policy> {
    let at = fields.at("policy");
    let (name, params) = match fields.object.get("policy") {
        Some(Value::String(name)) => (name.clone(), fields.object.get("params")),
        Some(Value::Object(object)) => {
            let name = ["type", "name", "policy"].iter().find_map(|key| object.get(*key)).and_then(Value::as_str);
            let Some(name) = name else {
                parts.error("scenario.missing-field", &at, "the policy has no name", "add \"type\"");
                return None;
            };
            match object.get("params") {
                Some(params) => (name.to_owned(), Some(params)),
                None => return policy(fields.object.get("policy")?, &at, parts),
            }
        }
        None => {
            let hint = "allowed: sudden_brake, accel_then_brake, idm_nominal";
            parts.error("scenario.missing-field", &fields.path, "missing field `policy`", hint);
            return None;
        }
        Some(other) => {
            let message = format!("policy is {}, not a name", brief(other));
            parts.error("scenario.type", &at, message, "write a name in quotes, and \"params\" beside it");
            return None;
        }
    };
    let mut object = match params {
        Some(Value::Object(params)) => params.clone(),
        None => Map::new(),
        Some(other) => {
            let message = format!("params is {}, not an object", brief(other));
            parts.error("scenario.type", &fields.at("params"), message, "write { ... }");
            return None;
        }
    };
    // A step is a step, also when it was written as 60.0.
    for key in ["brake_step", "brake_steps", "accel_steps"] {
        if let Some(steps) = object.get(key).and_then(Value::as_f64)
            && steps.fract() == 0.0
            && (0.0..1e6).contains(&steps)
        {
            object.insert(key.to_owned(), json!(steps as u64));
        }
    }
    object.insert("type".to_owned(), Value::String(name));
    policy(&Value::Object(object), &at, parts)
}

fn obstacle(value: &Value, path: &str, ego_s: f64, parts: &mut Parts) -> Option<Obstacle> {
    let Value::Object(object) = value else {
        let hint = "write {\"delta_s_m\": 30, \"delta_t_m\": 1.5}";
        parts.error("scenario.type", path, format!("{} is no obstacle", brief(value)), hint);
        return None;
    };
    let mut fields = Fields { object, path: path.to_owned(), used: Vec::new() };
    let kind = match fields.word(&["kind", "type"], parts)?.as_deref() {
        None | Some("cone" | "traffic_cone") => ObstacleKind::Cone,
        Some("barrier") => ObstacleKind::Barrier,
        Some("warning") => ObstacleKind::Warning,
        Some(other) => {
            let shown: String = other.chars().take(40).collect();
            let message = format!("there is no obstacle {shown:?}");
            parts.error("scenario.unknown-value", &fields.at("kind"), message, "allowed: cone, barrier, warning");
            return None;
        }
    };
    let ahead = fields.number(&["delta_s_m"], parts)?;
    let along = fields.number(&["s_m", "s"], parts)?;
    let t_m = fields.number(&["delta_t_m", "t_m", "t"], parts)?.unwrap_or(0.0);
    fields.warn_unused(parts);
    let Some(s_m) = ahead.map(|ahead| ego_s + ahead).or(along) else {
        parts.error(
            "scenario.missing-field",
            path,
            "missing field `delta_s_m`",
            "how far ahead of the ego it lies, in m",
        );
        return None;
    };
    Some(Obstacle { kind, s_m, t_m })
}

/// The fields of an object, and which of them were read.
struct Fields<'a> {
    object: &'a Map<String, Value>,
    path: String,
    used: Vec<&'static str>,
}

impl<'a> Fields<'a> {
    fn at(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) }
    }

    /// The first of these fields that is there and not null.
    fn first(&mut self, names: &[&'static str]) -> Option<(&'static str, &'a Value)> {
        self.used.extend(names);
        names.iter().find_map(|name| Some((*name, self.object.get(*name).filter(|value| !value.is_null())?)))
    }

    /// A text field; the outer `None` is an error that was told.
    fn word(&mut self, names: &[&'static str], parts: &mut Parts) -> Option<Option<String>> {
        match self.first(names) {
            None => Some(None),
            Some((_, Value::String(word))) => Some(Some(word.clone())),
            Some((name, other)) => {
                let message = format!("{name} is {}, not a word", brief(other));
                parts.error("scenario.type", &self.at(name), message, "write it in quotes");
                None
            }
        }
    }

    /// A number; the outer `None` is an error that was told.
    fn number(&mut self, names: &[&'static str], parts: &mut Parts) -> Option<Option<f64>> {
        match self.first(names) {
            None => Some(None),
            Some((name, value)) => match value.as_f64() {
                Some(number) => Some(Some(number)),
                None => {
                    let message = format!("{name} is {}, not a number", brief(value));
                    parts.error("scenario.type", &self.at(name), message, "write a number, without quotes");
                    None
                }
            },
        }
    }

    /// A list; the outer `None` is an error that was told.
    fn list(&mut self, name: &'static str, parts: &mut Parts) -> Option<Option<&'a Vec<Value>>> {
        match self.first(&[name]) {
            None => Some(None),
            Some((_, Value::Array(items))) => Some(Some(items)),
            Some((_, other)) => {
                let message = format!("{name} is {}, not a list", brief(other));
                parts.error("scenario.type", &self.at(name), message, "write [ ... ]");
                None
            }
        }
    }

    fn warn_unused(&self, parts: &mut Parts) {
        for name in self.object.keys().filter(|name| !self.used.contains(&name.as_str())) {
            let shown: String = name.chars().take(60).collect();
            let message = format!("`{shown}` means nothing here and was left out");
            parts.diagnostics.push(Diagnostic::warning_at("scenario.ignored-field", self.at(&shown), message));
        }
    }
}
