//! A made-up suite, big enough to look like a real one: kinematics by hand, no simulator, no real record.
//!
//! The page's tests use it too.

use super::drive::{self, Plan};
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::*;
use recrash_model::narrative::*;
use recrash_model::profile::*;
use recrash_model::record::*;
use recrash_model::rollout::TerminationKind;
use recrash_model::scenario::*;
use recrash_model::selection::*;
use recrash_model::surroundings::{Lighting, Surface, Weather};
use recrash_model::template::*;
use recrash_model::triage::{EgoOutcome, Fared, Triage};
use recrash_model::tuning::*;
use recrash_model::zones::ContactZone;
use recrash_model::{Diagnostic, Location, Seed};
use recrash_report::{CaseRow, CaseView, RunRow, RunTrace, RunView, SuiteView, Thumbnail};
use std::path::Path;

/// The paper's templates, as (road, SV, CP, work zone, records, picks).
const TEMPLATES: [(RoadType, Movement, Movement, bool, usize, usize); 14] = {
    use Movement::{LeftTurn as L, RightTurn as R, Straight as S};
    use RoadType::{Highway as H, Intersection as I, TrafficCircle as C};
    [
        (I, S, S, false, 102, 4),
        (I, S, L, false, 35, 2),
        (I, L, S, false, 24, 2),
        (I, R, S, false, 16, 2),
        (H, S, S, false, 14, 1),
        (I, R, R, false, 14, 1),
        (I, L, L, false, 9, 1),
        (I, S, R, false, 7, 1),
        (I, S, S, true, 4, 1),
        (I, L, R, false, 3, 1),
        (H, S, R, false, 2, 1),
        (H, L, S, true, 2, 1),
        (H, S, L, true, 2, 1),
        (C, R, L, true, 1, 1),
    ]
};

fn template((road, sv, cp, work_zone, _, _): (RoadType, Movement, Movement, bool, usize, usize)) -> Template {
    Template { road, sv, cp, work_zone }
}

fn pick<T: Copy>(rng: &mut recrash_model::seed::Rng, of: &[T]) -> T {
    of[(rng.uniform() * of.len() as f64) as usize]
}

/// The report of a record.
fn reference(index: usize) -> RecordRef {
    RecordRef { report_id: format!("90000-{:04}", 1000 + index), version: 1 + u32::from(index.is_multiple_of(3)) }
}

fn record(index: usize, template: Template, seed: Seed) -> CrashRecord {
    let mut rng = seed.child(&format!("record {index}")).rng();
    let places = ["Phoenix, AZ", "San Francisco, CA", "Tempe, AZ", "Austin, TX", "Los Angeles, CA", "Las Vegas, NV"];
    let zones = [ContactZone::Front, ContactZone::FrontLeft, ContactZone::Left, ContactZone::Right, ContactZone::Rear];
    let (sv_mph, cp_mph) = (rng.range(4.0, 38.0).round(), rng.range(5.0, 40.0).round());
    let verb = |movement: Movement| match movement {
        Movement::LeftTurn => "turning left",
        Movement::RightTurn => "turning right",
        _ => "going straight",
    };
    let kinds = [PartnerKind::PassengerCar, PartnerKind::Suv, PartnerKind::PickupTruck, PartnerKind::Motorcycle];
    let side = pick(&mut rng, &["left", "right"]);
    let narrative = format!(
        "On a clear afternoon the test vehicle was {} at about {sv_mph} mph when another vehicle came from the {side}, \
         {} against a red light. The operator had no time to react.\n\nThe other vehicle's front touched the {side} side \
         of the test vehicle. Nobody was hurt; [XXX] was told. Made-up record number {index} of the demonstration.",
        verb(template.sv),
        verb(template.cp),
    );
    CrashRecord {
        id: reference(index),
        incident_id: Some(format!("made-up-{}", index / 2)),
        entity: pick(&mut rng, &["Example Mobility LLC", "Sample Robotics", "Placeholder AV, Inc."]).to_owned(),
        vehicle: pick(&mut rng, &["Example Shuttle 2022", "Sample Hatchback 2023"]).to_owned(),
        when: Some(YearMonth { year: 2022 + (index % 4) as u16, month: 1 + (index % 12) as u8 }),
        time_of_day_min: (!index.is_multiple_of(5)).then_some((rng.uniform() * 1440.0) as u16),
        place: pick(&mut rng, &places).to_owned(),
        road: Coded::Known(template.road),
        work_zone: template.work_zone,
        surface: Some(Surface::Dry),
        lighting: Some(pick(&mut rng, &[Lighting::Daylight, Lighting::DarkLighted, Lighting::DawnDusk])),
        weather: vec![Weather::Clear],
        posted_speed_mps: (!index.is_multiple_of(7)).then_some(35.0 * MPS_PER_MPH),
        partner: if index.is_multiple_of(23) { Coded::Unknown } else { Coded::Known(pick(&mut rng, &kinds)) },
        cp_movement: Coded::Known(template.cp),
        sv_movement: Coded::Known(template.sv),
        sv_speed_mps: (!index.is_multiple_of(6)).then_some(sv_mph * MPS_PER_MPH),
        sv_zones: vec![pick(&mut rng, &zones), pick(&mut rng, &zones)],
        cp_zones: vec![
            ContactZone::Front,
            if cp_mph > 20.0 { ContactZone::FrontLeft } else { ContactZone::FrontRight },
        ],
        severity: Coded::Known(pick(&mut rng, &[Severity::None, Severity::None, Severity::Minor])),
        towed: Default::default(),
        airbags: Default::default(),
        engagement: Coded::Known(Engagement::Ads),
        narrative,
        redaction: Redaction::Open,
        provenance: Provenance { file: "made-up.csv".into(), edition: Edition::Second, row: 1 + index as u64 },
        reading: None,
    }
}

fn selection(seed: Seed) -> Selection {
    let counts: Vec<TemplateCount> = TEMPLATES
        .iter()
        .map(|&line| TemplateCount { template: template(line), records: line.4, picks: line.5 })
        .collect();
    let (clusters, map) = clusters(&counts, seed);
    Selection {
        strategy: Strategy::Stratified,
        budget: 20,
        seed: 7,
        embedding: EmbeddingInfo {
            name: "tf-idf + truncated SVD".into(),
            source_dimensions: 412,
            dimensions: 6,
            explained_variance: 0.413,
        },
        template_weight: 1.0,
        weighting: Weighting::Frequency,
        inertia: 61.3,
        tables: tables(&counts),
        coverage: coverage(&counts),
        templates: counts,
        clusters,
        map,
    }
}

/// The records of each template, dealt to its picks, and every record's place on the map.
fn clusters(counts: &[TemplateCount], seed: Seed) -> (Vec<Cluster>, Vec<MapPoint>) {
    let (mut clusters, mut map, mut first) = (Vec::new(), Vec::new(), 0);
    for (order, count) in counts.iter().enumerate() {
        let members: Vec<usize> = (first..first + count.records).collect();
        first += count.records;
        for part in 0..count.picks {
            let number = clusters.len() + 1;
            let own: Vec<usize> = members.iter().copied().filter(|member| member % count.picks == part).collect();
            let angle = order as f64 * 0.9;
            let mut rng = seed.child(&format!("map {number}")).rng();
            let (cx, cy) = (recrash_model::math::cos(angle) * 3.0, recrash_model::math::sin(angle) * 2.0);
            for &member in &own {
                let spread = |draw: f64| (draw - 0.5) * 1.6 + part as f64 * 0.7;
                let (x, y) = (cx + spread(rng.uniform()), cy + spread(rng.uniform()));
                map.push(MapPoint { record: member, cluster: number - 1, x, y });
            }
            clusters.push(Cluster {
                number,
                scenario_id: format!("{number:02}-{}", count.template.slug()),
                template: count.template,
                pick: reference(own[0]),
                pick_index: own[0],
                members: own,
                radius: 0.8 + 0.1 * part as f64,
                invented: false,
            });
        }
    }
    map.sort_by_key(|point| point.record);
    (clusters, map)
}

/// How many records have what.
fn tables(counts: &[TemplateCount]) -> StageTables {
    let records = |has: &dyn Fn(&Template) -> bool| {
        counts.iter().filter(|count| has(&count.template)).map(|count| count.records).sum()
    };
    let matrix = |cp: Movement| {
        let cell = |sv: Movement| records(&|template| template.sv == sv && template.cp == cp);
        (cp, Movement::PAPER.map(cell).to_vec())
    };
    let road = |road: RoadType| (road, records(&|template| template.road == road));
    StageTables {
        road_types: [RoadType::Intersection, RoadType::Highway, RoadType::TrafficCircle].map(road).to_vec(),
        sv_movements: Movement::PAPER.to_vec(),
        movements: Movement::PAPER.map(matrix).to_vec(),
        work_zone: records(&|template| template.work_zone),
        largest_template: counts[0].records,
    }
}

/// What the picks cover: every template that occurs.
fn coverage(counts: &[TemplateCount]) -> Coverage {
    let total: usize = counts.iter().map(|count| count.records).sum();
    let observed: Vec<Template> = counts.iter().map(|count| count.template).collect();
    let possible = profile().templates();
    let pair =
        ValuePair { road: Some(RoadType::TrafficCircle), sv: Some(Movement::Straight), cp: None, work_zone: None };
    Coverage {
        templates_possible: possible.len(),
        templates_observed: counts.len(),
        templates_covered: counts.len(),
        records_covered: total,
        records: total,
        radius: 1.31,
        mean_distance: 0.42,
        embedding_radius: 1.05,
        embedding_mean_distance: 0.37,
        pairs: PairCoverage {
            possible: 37,
            observed: 31,
            covered: 31,
            holes_observed: vec![],
            holes_possible: vec![pair],
        },
        holes_observed: vec![],
        holes_possible: possible.into_iter().filter(|template| !observed.contains(template)).collect(),
    }
}

fn profile() -> SystemProfile {
    SystemProfile {
        format: PROFILE_FORMAT.into(),
        name: "paper".into(),
        description: "3 road types, 3 x 3 movements, work zone or not; MetaDrive's IDM as the system under test".into(),
        ego: "metadrive-idm".into(),
        records: RecordRules { dedupe: Dedupe::None, tells: Tells::Templates },
        expresses: Expressible {
            road_types: vec![RoadType::Intersection, RoadType::Highway, RoadType::TrafficCircle],
            sv_movements: Movement::PAPER.to_vec(),
            cp_movements: Movement::PAPER.to_vec(),
            work_zone: true,
            partner_kinds: vec![PartnerKind::PassengerCar],
            min_speed_mps: 1.0,
            max_speed_mps: 22.2,
            max_traffic_density: 0.3,
        },
        excludes: Excluded {
            collisions: vec![CollisionKind::RearEndByEgo, CollisionKind::RearEndOfEgo, CollisionKind::HeadOn],
        },
        failure: FailureCriteria {
            min_gap_m: 2.0,
            hard_braking_mps2: 4.0,
            phantom_braking_mps2: 3.0,
            oscillation_reversals: 4,
            oscillation_window_s: 5.0,
            lane_departure_m: 0.3,
        },
    }
}

fn narrative(cluster: &Cluster, record: &CrashRecord, records: &[CrashRecord], plan: &Plan) -> Narrative {
    let side = if record.narrative.contains("from the left") { "left" } else { "right" };
    Narrative {
        format: NARRATIVE_FORMAT.into(),
        scenario_id: cluster.scenario_id.clone(),
        template: cluster.template,
        records: vec![record.id.clone()],
        text: format!(
            "{}. The ego drives at {:.1} m/s. A car comes from the {side} at {:.1} m/s and does not yield; its front meets the \
             side of the ego.",
            cluster.template, plan.ego_speed, plan.partner_speed
        ),
        facts: facts(cluster, record, plan, side),
        origin: if cluster.number.is_multiple_of(6) {
            Origin::Invented { reason: "the record describes a rear-end collision, which the profile excludes".into() }
        } else if cluster.number == 7 {
            let record = records[cluster.members[1]].id.clone();
            Origin::Other { record, reason: "the record does not say where the other came from".into() }
        } else {
            Origin::Own
        },
        author: Author::Rules,
    }
}

/// The facts of a narrative, each from a column, from words or assumed.
fn facts(cluster: &Cluster, record: &CrashRecord, plan: &Plan, side: &str) -> Vec<Fact> {
    let words = |words: &str| FactSource::Words { record: record.id.clone(), words: words.into() };
    let column = |column: &str, text: &str| FactSource::Column {
        record: record.id.clone(),
        column: column.into(),
        text: text.into(),
    };
    let assumed = |why: &str| FactSource::Assumed { why: why.into() };
    let sv_speed = match record.sv_speed_mps {
        Some(_) => column("SV Precrash Speed (MPH)", "as filed"),
        None => assumed("the column is empty; a town speed is taken"),
    };
    let approach = if side == "left" { Approach::Left } else { Approach::Right };
    let Template { sv, cp, .. } = cluster.template;
    let fact = |value, source| Fact { value, source };
    vec![
        fact(FactValue::SvMovement { movement: sv }, column("SV Pre-Crash Movement", sv.label())),
        fact(FactValue::CpMovement { movement: cp }, column("CP Pre-Crash Movement", cp.label())),
        fact(FactValue::Approach { approach }, words(&format!("from the {side}"))),
        fact(FactValue::CpSignal { signal: Signal::Red }, words("against a red light")),
        fact(FactValue::SvSpeed { speed_mps: plan.ego_speed }, sv_speed),
        fact(
            FactValue::CpSpeed { speed_mps: plan.partner_speed },
            assumed("no record gives it; the posted speed is taken"),
        ),
        fact(
            FactValue::Contact { sv: record.sv_zones.clone(), cp: record.cp_zones.clone() },
            column("SV Contact Area, CP Contact Area", "as ticked"),
        ),
    ]
}

/// What a search of the delay found, and the best delay. [s]
fn tune_log(cluster: &Cluster, plan: &Plan, designed: f64) -> (TuneLog, f64) {
    let mut rng = Seed(7).child(&cluster.scenario_id).rng();
    let mut best = (0, f64::INFINITY, designed);
    let points: Vec<TunePoint> = (0..48)
        .map(|number| {
            let (proposed_by, value) = match number {
                0 => ("start", designed),
                1..=20 => ("halton", rng.range(-3.0, 3.0)),
                _ => ("local", (best.2 + rng.range(-0.4, 0.4)).clamp(-3.0, 3.0)),
            };
            let score = score(plan, value, number % 9 == 4);
            if score.refused.is_empty() && score.objective < best.1 - 1e-9 {
                best = (number, score.objective, value);
            }
            TunePoint { number, proposed_by: proposed_by.into(), values: vec![value, plan.ego_speed], score }
        })
        .collect();
    let log = TuneLog {
        format: TUNE_FORMAT.into(),
        scenario_id: cluster.scenario_id.clone(),
        searcher: "halton, then local".into(),
        seed: 7,
        parameters: parameters(plan, designed),
        points,
        best: best.0,
    };
    (log, best.2)
}

/// What a run with this delay is worth to the search.
fn score(plan: &Plan, arrival_gap_s: f64, refused: bool) -> Score {
    let gap = drive::least_gap(plan, arrival_gap_s);
    let failed = gap.value < 2.0;
    Score {
        objective: gap.value + if refused { 5.0 } else { 0.0 },
        min_gap: Some(gap),
        depth_m: None,
        contact_mps: None,
        braking: None,
        findings: if failed { vec![FindingKind::NearMiss] } else { vec![] },
        failed,
        refused: if refused { vec!["the least gap comes at the very end".into()] } else { vec![] },
    }
}

/// What the search may change.
fn parameters(plan: &Plan, designed: f64) -> Vec<Parameter> {
    vec![
        Parameter {
            pointer: "/partners/0/start/arrival_gap_s".into(),
            unit: "s".into(),
            min: -3.0,
            max: 3.0,
            start: designed,
            integer: false,
            reason: "who comes first stays open within three seconds".into(),
        },
        Parameter {
            pointer: "/ego/target_speed_mps".into(),
            unit: "m/s".into(),
            min: plan.ego_speed - 1.5,
            max: plan.ego_speed + 1.5,
            start: plan.ego_speed,
            integer: false,
            reason: "the speed in the record, give or take what its rounding hides".into(),
        },
    ]
}

fn run(cluster: &Cluster, plan: &Plan, arrival_gap_s: f64, folder: &str) -> RunView {
    drive::run(
        cluster,
        plan,
        arrival_gap_s,
        format!("recrash simulate suite/{folder}/{}.json --ego metadrive-idm --seed 7", cluster.scenario_id),
    )
}

/// Other egos: by turns all avoid it, one, the other, none.
fn triage(number: usize, careful: &RunView) -> Triage {
    let outcome = |ego: &str, failed: bool| EgoOutcome {
        ego: ego.to_owned(),
        failed,
        fared: if failed { Fared::Alike } else { Fared::Avoids },
        findings: if failed { vec![FindingKind::Contact] } else { Vec::new() },
        min_gap: if failed { Some(Timed { value: 0.0, time_s: 4.2 }) } else { careful.metrics.min_gap },
        termination: if failed { TerminationKind::Contact } else { TerminationKind::Arrived },
        state_hash: careful.rollout.state_hash.clone(),
    };
    Triage::new(vec![outcome("idm", number % 4 >= 2), outcome("reference", number % 2 == 1)])
}

/// Scenarios that are driven; a larger suite repeats them over records of its own. [count]
pub const DESIGNED: usize = 20;

/// A made-up suite: its light part, and behind it the heavy part of the scenarios that were driven.
pub struct Demo {
    /// What the tables say.
    pub suite: SuiteView,
    /// The scenarios that were driven; the others repeat them.
    pub driven: Vec<CaseView>,
}

impl Demo {
    /// Everything behind the scenario at this position.
    pub fn case(&self, position: usize) -> CaseView {
        let row = &self.suite.cases[position];
        let mut case = self.driven[position % self.driven.len()].clone();
        case.scenario_id = row.scenario_id.clone();
        case
    }

    /// The file of the scenario at this position.
    pub fn case_file(&self, position: usize) -> String {
        let row = &self.suite.cases[position];
        recrash_report::case_file(&self.suite.context(row), &self.case(position), row)
    }

    /// Writes page and files of cases.
    pub fn write(&self, folder: &Path) -> std::io::Result<()> {
        std::fs::create_dir_all(folder.join("report"))?;
        for (position, row) in self.suite.cases.iter().enumerate() {
            std::fs::write(folder.join(recrash_report::case_file_name(&row.scenario_id)), self.case_file(position))?;
        }
        std::fs::write(folder.join("report.html"), recrash_report::html(&self.suite))
    }
}

/// The suite of twenty.
pub fn demo() -> Demo {
    demo_of(DESIGNED)
}

fn row(case: &CaseView, cluster: &Cluster, position: usize) -> CaseRow {
    let row = |run: &Option<RunView>| {
        run.as_ref()
            .map(|run| RunRow { judgement: run.run.judgement.clone(), rerun_command: run.rerun_command.clone() })
    };
    let mut records = cluster.members.clone();
    records.truncate(4);
    let narrative = case.narrative.as_ref();
    CaseRow {
        account: None,
        scenario_id: case.scenario_id.clone(),
        template: cluster.template,
        cluster: Some(position),
        records,
        origin: narrative.map(|narrative| narrative.origin.clone()),
        told: narrative.and_then(|narrative| narrative.told_record().cloned()),
        narrative: narrative.map_or_else(String::new, |narrative| narrative.text.clone()),
        before: row(&case.before),
        untuned: row(&case.untuned),
        told_tuned: row(&case.told_tuned),
        after: row(&case.after),
        triage: case.triage.clone(),
        review: None,
        changed: None,
        undriven: false,
        refused: case.refused.clone(),
        edited: if position == 4 { vec![format!("4-scenarios/{}.json", case.scenario_id)] } else { Vec::new() },
        thumbnail: case.last_run().and_then(|run| Thumbnail::of(&run.run)),
    }
}

/// A suite of so many scenarios, each with a record of its own.
pub fn demo_of(count: usize) -> Demo {
    let seed = Seed(7);
    let mut selection = selection(seed);
    let templates = TEMPLATES.iter().flat_map(|&line| std::iter::repeat_n(template(line), line.4));
    let mut records: Vec<CrashRecord> =
        templates.enumerate().map(|(index, template)| record(index, template, seed)).collect();
    let driven: Vec<CaseView> = selection.clusters.iter().map(|cluster| driven_case(cluster, &records)).collect();
    let mut cases: Vec<CaseRow> =
        driven.iter().zip(&selection.clusters).enumerate().map(|(i, (case, cluster))| row(case, cluster, i)).collect();
    cases.truncate(count);
    for position in DESIGNED..count {
        repeat(position, seed, &mut selection, &mut records, &mut cases);
    }
    let suite = SuiteView {
        accounts: None,
        corpus: None,
        title: "demo suite".into(),
        generated_by: "recrash 0.1.0".into(),
        generated_at: None,
        command: "recrash run --profile paper --budget 20 --seed 7 --out suite".into(),
        profile: profile(),
        ego: "metadrive-idm".into(),
        simulator: "demonstration kinematics".into(),
        agents: "rules".into(),
        seed: 7,
        sample: true,
        cases,
        records: record_set(records),
        selection,
        diagnostics: vec![Diagnostic::new(
            recrash_model::Severity::Warning,
            "records.unlisted-code",
            Location::at_row("made-up.csv", 17),
            "\"Tricycle\" is in no code table of the column \"Crash With\"",
        )],
    };
    Demo { suite, driven }
}

/// Adds a scenario that repeats one of those designed, over a record of its own.
fn repeat(
    position: usize,
    seed: Seed,
    selection: &mut Selection,
    records: &mut Vec<CrashRecord>,
    cases: &mut Vec<CaseRow>,
) {
    let like = position % DESIGNED;
    let mut cluster = selection.clusters[like].clone();
    cluster.number = position + 1;
    cluster.scenario_id = format!("{:04}-{}", position + 1, cluster.template.slug());
    cluster.pick_index = records.len();
    cluster.members = vec![records.len()];
    let told = record(records.len(), cluster.template, seed);
    cluster.pick = told.id.clone();
    let place = selection.map[like * 7];
    let spread = |by: usize| (position * by % 997) as f64 / 997.0 - 0.5;
    let (x, y) = (place.x + spread(131), place.y + spread(389));
    selection.map.push(MapPoint { record: records.len(), cluster: position, x, y });
    let mut case = cases[like].clone();
    case.scenario_id = cluster.scenario_id.clone();
    case.cluster = Some(position);
    case.records = cluster.members.clone();
    case.told = case.told.map(|_| told.id.clone());
    case.edited.clear();
    cases.push(case);
    records.push(told);
    selection.clusters.push(cluster);
}

/// The made-up file: these records, and behind them five rows that cannot be read.
fn record_set(records: Vec<CrashRecord>) -> RecordSet {
    let usable = records.len();
    let rejects = (0..5).map(|row| Reject {
        file: "made-up.csv".into(),
        row: 236 + row,
        record: None,
        reason: RejectReason::RedactedNarrative,
    });
    RecordSet {
        files: vec![SourceFile {
            name: "made-up.csv".into(),
            edition: Edition::Second,
            rows: usable + 5,
            sha256: "5f2b51ca2fdc5baa31ec02e002f69aec0e48a8ad7cbf1c0a2f1fb1b8a1a3cf11".into(),
        }],
        usable: (0..usable).collect(),
        untold: Default::default(),
        rejects: rejects.collect(),
        funnel: vec![
            FunnelStep { name: "rows read".into(), remaining: usable + 5, lost: vec![] },
            FunnelStep {
                name: "narrative can be read".into(),
                remaining: usable,
                lost: vec![(RejectReason::RedactedNarrative, 5)],
            },
            FunnelStep { name: "the profile expresses it".into(), remaining: usable, lost: vec![] },
        ],
        records,
    }
}

/// One scenario, driven.
fn driven_case(cluster: &Cluster, records: &[CrashRecord]) -> CaseView {
    let plan = Plan::of(cluster);
    let designed = plan.designed_gap_s;
    let (log, tuned) = tune_log(cluster, &plan, designed);
    let refused = cluster.number == 19;
    let before = (!refused).then(|| run(cluster, &plan, designed, "4-scenarios"));
    let after = (!refused && log.best != 0).then(|| run(cluster, &plan, tuned, "6-tuned"));
    let failed = after.as_ref().or(before.as_ref()).is_some_and(|run| run.failed());
    let careful = failed.then(|| run(cluster, &plan, designed + 3.0, "6-tuned"));
    CaseView {
        account: None,
        assumed: Vec::new(),
        scenario_id: cluster.scenario_id.clone(),
        narrative: Some(narrative(cluster, &records[cluster.pick_index], records, &plan)),
        drawing: plan.drawing(),
        before,
        untuned: None,
        told_tuned: None,
        after,
        triage: careful.as_ref().map(|run| triage(cluster.number, run)),
        reference: careful.map(|run| RunTrace { run: run.run, series: run.series }),
        tune_log: (!refused).then_some(log),
        refused: refused.then(|| "partners[0].turn: no left turn on this map; allowed: straight".to_owned()),
    }
}
