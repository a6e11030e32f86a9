//! The gallery: every case under `cases/`, as its recorded driver drove and with `idm` in the ego's place.

use recrash_model::geometry::{OrientedBox, Vec2};
use recrash_model::rollout::{ActorState, EventKind, Rollout, TerminationKind};
use recrash_model::scenario::{ActorPlan, Device, GraphMap, MapSpec, ScenarioDraft, Trigger};
use recrash_model::zones::ContactZone;
use recrash_roads::Scenario;
use recrash_sim::{Ego, Run, Seat, simulate};
use serde_json::{Value, to_value};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Who drives in the golden.
const EGOS: [Ego; 2] = [Ego::Recorded, Ego::Idm];

/// A snapshot is taken at so many steps: at each where the compiler optimises, and there are minutes to be saved elsewhere.
const SNAPSHOT_EVERY: usize = if cfg!(debug_assertions) { 7 } else { 1 };

/// The enums of the format of which every variant has a case.
const ENUMS: [&str; 14] = [
    "StripKind",
    "LinePiece",
    "RoadStart",
    "AreaKind",
    "Turn",
    "Leg",
    "Deed",
    "Trigger",
    "Doing",
    "PartKind",
    "Device",
    "Aspect",
    "PartnerKind",
    "ObstacleKind",
];

/// A case: its path below `cases/` without `.json`, and what it says.
struct Case {
    name: String,
    draft: ScenarioDraft,
    scenario: Scenario,
}

/// The folder of the cases.
pub(crate) const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases");

/// The names of all cases: paths below `cases/` without `.json`.
pub(crate) fn case_names() -> BTreeSet<String> {
    let root = Path::new(ROOT);
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in std::fs::read_dir(root).expect("there are cases").map(|entry| entry.unwrap().path()) {
        if folder.is_dir() {
            files.extend(std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()));
        }
    }
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    let name =
        |file: &PathBuf| file.strip_prefix(root).unwrap().with_extension("").to_string_lossy().replace('\\', "/");
    files.iter().map(name).collect()
}

/// All cases, in order of their names.
fn cases() -> Vec<Case> {
    let case = |name: String| {
        let json = std::fs::read_to_string(Path::new(ROOT).join(format!("{name}.json"))).unwrap();
        let draft = match recrash_roads::read_draft(&json) {
            Ok(read) => read.value,
            Err(problems) => panic!("{name}: {problems:#?}"),
        };
        match recrash_roads::check(draft.clone()) {
            Ok(checked) => Case { name, draft, scenario: checked.value },
            Err(problems) => panic!("{name}: {problems:#?}"),
        }
    };
    case_names().into_iter().map(case).collect()
}

/// The zone of a body where another touches it.
fn zones(rollout: &Rollout, a: (usize, &ActorState), b: (usize, &ActorState)) -> String {
    let outline = |(actor, state): (usize, &ActorState)| {
        let track = &rollout.actors[actor];
        OrientedBox::new(state.pose(), track.length_m, track.width_m)
    };
    let (first, second) = (outline(a), outline(b));
    if !first.overlaps(&second) {
        return "part".to_owned();
    }
    let inside = |corner: &Vec2, other: &OrientedBox| {
        let local = other.to_local(*corner);
        local.x.abs() <= other.half_length + 1e-9 && local.y.abs() <= other.half_width + 1e-9
    };
    let shared: Vec<Vec2> = first
        .corners()
        .into_iter()
        .filter(|corner| inside(corner, &second))
        .chain(second.corners().into_iter().filter(|corner| inside(corner, &first)))
        .collect();
    let Some(count) = (!shared.is_empty()).then_some(shared.len() as f64) else { return "across".to_owned() };
    let point = shared.iter().fold(Vec2::default(), |sum, corner| sum + *corner) * (1.0 / count);
    let name = |zone: ContactZone| to_value(zone).unwrap().as_str().unwrap().to_owned();
    format!("{}/{}", name(ContactZone::at(&first, point)), name(ContactZone::at(&second, point)))
}

/// A line of the golden: who drove, how it ended and when, who touched whom, and the hash of all states.
fn line(name: &str, ego: Ego, rollout: &Rollout) -> String {
    let end = to_value(rollout.termination.kind).unwrap();
    let mut line = format!("{name} {ego} {} {:.1}", end.as_str().unwrap(), rollout.termination.time_s);
    for event in &rollout.events {
        let (time_s, id) = (event.time_s, |actor: usize| &rollout.actors[actor].id);
        match &event.kind {
            EventKind::Contact { a, b, a_state, b_state } => {
                let zones = zones(rollout, (*a, a_state), (*b, b_state));
                write!(line, " {}+{}@{time_s:.2}:{zones}", id(*a), id(*b)).unwrap();
            }
            EventKind::ObstacleContact { actor, obstacle, .. } => {
                let kind = rollout.obstacles[*obstacle].kind.label();
                write!(line, " {}+[{kind}]@{time_s:.2}", id(*actor)).unwrap();
            }
            EventKind::Gone { actor } => write!(line, " {} leaves@{time_s:.1}", id(*actor)).unwrap(),
        }
    }
    write!(line, " {}", rollout.state_hash).unwrap();
    line
}

/// Every case with every ego, by so many threads.
fn run_all(cases: &[Case], threads: usize) -> Vec<Rollout> {
    let jobs: Vec<(&Case, Ego)> = cases.iter().flat_map(|case| EGOS.map(|ego| (case, ego))).collect();
    let mut all: Vec<(usize, Rollout)> = std::thread::scope(|scope| {
        let work = |first: usize| {
            let jobs = &jobs;
            scope.spawn(move || {
                let mine = jobs.iter().enumerate().skip(first).step_by(threads);
                mine.map(|(number, (case, ego))| (number, simulate(&case.scenario, *ego))).collect::<Vec<_>>()
            })
        };
        let working: Vec<_> = (0..threads).map(work).collect();
        working.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    all.sort_by_key(|(number, _)| *number);
    all.into_iter().map(|(_, rollout)| rollout).collect()
}

/// What came out, for a reader.
fn outcome(rollout: &Rollout) -> String {
    let mut told = Vec::new();
    for event in &rollout.events {
        let (time_s, id) = (event.time_s, |actor: usize| &rollout.actors[actor].id);
        told.push(match &event.kind {
            EventKind::Contact { a, b, a_state, b_state } => {
                let zones = zones(rollout, (*a, a_state), (*b, b_state)).replace('_', " ").replace('/', " on ");
                match a {
                    0 => format!("{} at {time_s:.1} s, {zones}", id(*b)),
                    _ => format!("{} and {} at {time_s:.1} s, {zones}", id(*a), id(*b)),
                }
            }
            EventKind::ObstacleContact { obstacle, .. } => {
                format!("{} at {time_s:.1} s", rollout.obstacles[*obstacle].kind.label())
            }
            EventKind::Gone { actor } => format!("{} leaves at {time_s:.1} s", id(*actor)),
        });
    }
    if told.is_empty() { "no contact".to_owned() } else { told.join("; ") }
}

/// The table of `cases/README.md`.
fn table(cases: &[Case], rollouts: &[Rollout]) -> String {
    let mut table =
        "| Case | What it shows | Picture | As recorded | With `idm` |\n| --- | --- | --- | --- | --- |\n".to_owned();
    for (case, runs) in cases.iter().zip(rollouts.chunks(EGOS.len())) {
        let (name, says) = (&case.name, &case.draft.source.narrative);
        let picture = format!("[picture](../docs/gallery/{}.svg)", name.replace('/', "-"));
        let [recorded, idm] = [outcome(&runs[0]), outcome(&runs[1])];
        writeln!(table, "| [{name}]({name}.json) | {says} | {picture} | {recorded} | {idm} |").unwrap();
    }
    table
}

/// To renew it after a change of the model run with `RECRASH_RENEW_GOLDENS=1`; that run fails.
#[test]
fn every_case_runs_as_the_golden_says_in_any_number_of_threads() {
    let cases = cases();
    let rollouts = run_all(&cases, 1);
    for threads in [2, 8] {
        assert!(run_all(&cases, threads) == rollouts, "{threads} threads");
    }
    let mut golden = String::new();
    for (number, rollout) in rollouts.iter().enumerate() {
        assert_ne!(rollout.termination.kind, TerminationKind::Diverged, "{}", rollout.scenario_id);
        golden += &line(&cases[number / EGOS.len()].name, EGOS[number % EGOS.len()], rollout);
        golden += "\n";
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/gallery.txt");
    let readme_file = Path::new(ROOT).join("README.md");
    let readme = std::fs::read_to_string(&readme_file).unwrap();
    let text = readme.find("| Case |").map_or(readme.as_str(), |table| &readme[..table]);
    let readme_is = format!("{text}{}", table(&cases, &rollouts));
    if std::env::var_os("RECRASH_RENEW_GOLDENS").is_some() {
        std::fs::write(file, golden).unwrap();
        std::fs::write(readme_file, readme_is).unwrap();
        panic!("the golden has been renewed: look at the difference, then run again without RECRASH_RENEW_GOLDENS");
    }
    let committed = std::fs::read_to_string(file).unwrap();
    for (is, was) in golden.lines().zip(committed.lines()) {
        assert_eq!(is, was);
    }
    assert_eq!(golden.lines().count(), committed.lines().count());
    for (is, was) in readme_is.lines().zip(readme.lines()) {
        assert_eq!(is, was, "the table of the README");
    }
    assert_eq!(readme_is.len(), readme.len(), "the table of the README");
}

#[test]
fn every_case_goes_on_from_a_snapshot_with_the_same_bytes() {
    let cases = cases();
    for case in &cases {
        for ego in EGOS {
            let mut run = Run::new(&case.scenario, Seat::BuiltIn(ego));
            let (mut states, mut snapshots) = (Vec::new(), Vec::new());
            while run.termination().is_none() {
                if states.len() % SNAPSHOT_EVERY == 0 {
                    snapshots.push((states.len(), run.snapshot()));
                }
                run.step(None);
                states.push((run.observe().states.to_vec(), run.events().to_vec()));
            }
            let end = run.termination();
            for (step, snapshot) in snapshots.iter().rev() {
                run.restore(snapshot);
                for (expected, events) in &states[*step..] {
                    run.step(None);
                    assert_eq!(run.observe().states, expected.as_slice(), "{} {ego} from step {step}", case.name);
                    assert_eq!(run.events(), events.as_slice(), "{} {ego} from step {step}", case.name);
                }
                assert_eq!(run.termination(), end, "{} {ego}", case.name);
            }
        }
    }
}

#[test]
fn no_step_of_any_case_allocates() {
    for Case { name, scenario, .. } in cases() {
        for ego in EGOS {
            let mut run = Run::new(&scenario, Seat::BuiltIn(ego));
            let counted = allocation_counter::measure(|| while run.step(None).is_none() {});
            assert_eq!(counted.count_total, 0, "{name} {ego}");
        }
    }
}

/// In the folder of crashes each recorded run is one, and whoever is tested has some seconds to choose otherwise.
#[test]
fn every_crash_is_shown_and_is_taken_over_in_time() {
    let cases = cases();
    let crashes: Vec<&Case> = cases.iter().filter(|case| case.name.starts_with("crashes/")).collect();
    assert!(crashes.len() >= 24 && cases.len() >= 60, "{} of {}", crashes.len(), cases.len());
    for Case { name, draft, scenario } in crashes {
        let rollout = simulate(scenario, Ego::Recorded);
        let (_, contact_s, ego, _) = rollout.first_ego_contact().unwrap_or_else(|| panic!("{name} shows no contact"));
        let handover_s = draft.ego.handover_s.unwrap_or(0.0);
        assert!(handover_s + 1.5 <= contact_s, "{name}: {handover_s} s, contact at {contact_s} s");
        assert!(
            contact_s + 4.0 >= draft.duration_s - draft.after_contact_s,
            "{name}: goes on long after {contact_s} s"
        );
        // Who is told to stand stands exactly.
        assert!(ego.velocity().length() == 0.0 || ego.velocity().length() > 0.3, "{name}: {ego:?}");
    }
}

/// Which variants of which enums a case uses.
#[derive(Default)]
struct Used(BTreeMap<&'static str, BTreeSet<String>>);

impl Used {
    /// A variant's name is its only key, or itself.
    fn note(&mut self, kind: &'static str, value: Result<Value, serde_json::Error>) {
        let name = match value.unwrap() {
            Value::String(name) => name,
            Value::Object(fields) => fields.keys().next().unwrap().clone(),
            other => panic!("{kind}: {other}"),
        };
        self.0.entry(kind).or_default().insert(name);
    }

    fn map(&mut self, map: &GraphMap) {
        for road in &map.roads {
            self.note("RoadStart", to_value(&road.start));
            for piece in &road.line {
                self.note("LinePiece", to_value(piece));
            }
            for strip in road.right.iter().chain(&road.left) {
                self.note("StripKind", to_value(strip.kind));
                for turn in &strip.turns {
                    self.note("Turn", to_value(turn));
                }
            }
        }
        for area in &map.areas {
            self.note("AreaKind", to_value(area.kind));
        }
    }

    fn plan(&mut self, plan: &ActorPlan) {
        for leg in &plan.course {
            self.note("Leg", to_value(leg));
        }
        for act in &plan.acts {
            self.note("Deed", to_value(&act.deed));
            if let Some(trigger) = &act.when {
                self.note("Trigger", to_value(trigger));
                if let Trigger::Actor { is, .. } = trigger {
                    self.note("Doing", to_value(is));
                }
            }
        }
    }

    fn case(&mut self, draft: &ScenarioDraft) {
        if let MapSpec::G(map) = &draft.map {
            self.map(map);
        }
        for actor in &draft.actors {
            self.note("PartnerKind", to_value(actor.kind));
            self.plan(&actor.plan);
        }
        if let Some(plan) = &draft.ego.recorded {
            self.plan(plan);
        }
        for part in draft.actors.iter().flat_map(|actor| &actor.parts).chain(&draft.ego.parts) {
            self.note("PartKind", to_value(part.kind));
        }
        for control in &draft.control {
            self.note("Device", to_value(&control.device));
            if let Device::Signal { program, .. } = &control.device {
                for phase in program {
                    self.note("Aspect", to_value(phase.show));
                }
            }
        }
        for object in &draft.objects {
            self.note("ObstacleKind", to_value(object.kind));
        }
    }
}

/// The names of all variants of an enum, as the JSON Schema has them.
fn variants(schema: &Value, name: &str) -> BTreeSet<String> {
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    let of = |schema: &Value| -> Vec<String> {
        match (&schema["enum"], &schema["const"], &schema["required"]) {
            (Value::Array(names), _, _) => names.iter().map(text).collect(),
            (_, Value::String(name), _) => vec![name.clone()],
            (_, _, Value::Array(names)) => names.iter().map(text).collect(),
            _ => panic!("{name}: {schema}"),
        }
    };
    let defined = &schema["$defs"][name];
    match &defined["oneOf"] {
        Value::Array(forms) => forms.iter().flat_map(of).collect(),
        _ => of(defined).into_iter().collect(),
    }
}

#[test]
fn every_word_of_the_format_has_a_case() {
    let schema = recrash_roads::scenario_schema();
    let mut used = Used::default();
    for case in cases() {
        used.case(&case.draft);
    }
    let none = BTreeSet::new();
    for name in ENUMS {
        let used = used.0.get(name).unwrap_or(&none);
        let missing: Vec<String> = variants(&schema, name).difference(used).cloned().collect();
        assert!(missing.is_empty(), "{name}: no case uses {missing:?}");
    }
}
