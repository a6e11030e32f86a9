//! From a record to a narrative: its own crash where it can be retold, else an invented one of the same template.

use super::limits::LEAST_TOLD_SPEED_MPS;
use super::reading::{Reading, Relation, read, reading_of_account, side_from_zones};
use super::staging::{ConflictKind, Ground, KNOWN, Staging, fits_three_way, ground, stagings};
use super::writing::{self, Facts, offset_side};
use crate::{AgentError, Brief, narrative_contradictions};
use recrash_model::account::Account;
use recrash_model::kinds::PartnerKind;
use recrash_model::metrics::CollisionKind;
use recrash_model::narrative::{Fact, FactSource, FactValue, LateralKind, NARRATIVE_FORMAT, Narrative, Origin, Side};
use recrash_model::scenario::{Approach, Author};
use recrash_model::template::{Movement, RoadType};
use recrash_model::{Diagnostic, Location, Outcome, Severity};

/// What a record gives once it is decided how to stage it.
struct Told {
    staging: Staging,
    approach: Fact,
    facts: Vec<Fact>,
}

/// Writes the narrative.
pub fn paraphrase(brief: &Brief) -> Result<Outcome<Narrative>, AgentError> {
    let ways = stagings(&brief.template);
    if ways.is_empty() {
        return Err(AgentError::TemplateUnknown { template: brief.template, known: KNOWN });
    }
    let pick = brief.records.first().map(|record| read(record));
    let mut diagnostics = Vec::new();
    let retold = match (&pick, brief.untold) {
        (_, Some(why)) => Err(why.to_owned()),
        (Some(pick), None) => retell(pick, brief, ways),
        (None, None) => return Err(AgentError::NoRecord),
    };
    let (told, origin) = match retold {
        Ok(told) => (told, Origin::Own),
        Err(why) => {
            let reason = match &pick {
                Some(_) => format!("{why}; a plausible course of the same template takes its place"),
                None => format!("{why}; this is a plausible course of it"),
            };
            let message = format!("{}: {reason}", brief.scenario_id);
            diagnostics.push(Diagnostic::new(Severity::Note, "narrative.invented", Location::default(), message));
            (invent(pick.as_ref(), brief, ways), Origin::Invented { reason })
        }
    };
    let value = written(told, origin, brief, Author::Rules, &mut diagnostics);
    Ok(Outcome { value, diagnostics })
}

/// The narrative of a record's own crash, by the rules.
///
/// # Errors
/// Why it cannot be retold as the template, in a sentence.
pub fn own_narrative(brief: &Brief) -> Result<Narrative, String> {
    let ways = stagings(&brief.template);
    if ways.is_empty() {
        return Err(AgentError::TemplateUnknown { template: brief.template, known: KNOWN }.to_string());
    }
    let record = brief.records.first().ok_or_else(|| AgentError::NoRecord.to_string())?;
    let told = retell(&read(record), brief, ways)?;
    Ok(written(told, Origin::Own, brief, Author::Rules, &mut Vec::new()))
}

/// The narrative of an account that somebody else has read.
///
/// # Errors
/// Why it cannot be retold as the template, in a sentence.
pub fn narrative_of(account: &Account, brief: &Brief, author: Author) -> Result<Narrative, String> {
    let record = brief.records.first().ok_or("there is no record")?;
    let told = retell(&reading_of_account(record, account), brief, stagings(&brief.template))?;
    Ok(written(told, Origin::Own, brief, author, &mut Vec::new()))
}

fn written(told: Told, origin: Origin, brief: &Brief, author: Author, diagnostics: &mut Vec<Diagnostic>) -> Narrative {
    let facts = complete(told, brief, diagnostics);
    let mut narrative = Narrative {
        format: NARRATIVE_FORMAT.to_owned(),
        scenario_id: brief.scenario_id.to_owned(),
        template: brief.template,
        records: brief.records.iter().map(|record| record.id.clone()).collect(),
        text: String::new(),
        facts,
        origin,
        author,
    };
    narrative.text = writing::text(&narrative);
    narrative
}

/// What a record tells, or why it cannot be retold.
fn retell(reading: &Reading, brief: &Brief, ways: &[Staging]) -> Result<Told, String> {
    let id = &reading.record.id;
    if let Some((kind, _)) = &reading.collision
        && brief.profile.excludes.collisions.contains(kind)
    {
        return Err(format!(
            "{id} describes a {} collision, which the profile \"{}\" excludes",
            kind.label(),
            brief.profile.name
        ));
    }
    if !reading.tells {
        return Err(format!("{id} does not tell how the two met"));
    }
    if let Some(contradiction) = &reading.contradiction {
        return Err(format!("{id} contradicts itself: {contradiction}"));
    }
    let (staging, source) = match &reading.relation {
        Some((relation, source)) => match stage(*relation, brief, ways) {
            Some(staging) => (staging, source.clone()),
            None => {
                return Err(format!(
                    "{id} tells of a partner {}, which cannot end in this template",
                    phrase(*relation)
                ));
            }
        },
        None => match from_zones(reading, ways) {
            Some(staging) => {
                let why = "not told; the contact areas suggest this side".to_owned();
                (staging, FactSource::Assumed { why })
            }
            None => {
                (ways[0], FactSource::Assumed { why: "not told; the most typical approach of the template".into() })
            }
        },
    };
    let facts = reading.facts.clone();
    if let Some(speed) = Facts(&facts).find(FactValue::sv_speed).filter(|speed| *speed < LEAST_TOLD_SPEED_MPS) {
        return Err(format!(
            "{id} tells that the ego stood or crept, at {speed:.1} m/s; the rules stage egos that drive, from \
             {LEAST_TOLD_SPEED_MPS} m/s on"
        ));
    }
    let approach = Fact { value: FactValue::Approach { approach: staging.approach }, source };
    // Lanes beside the ego are sorted out by the staging later.
    let kept = facts.iter().filter(|fact| !matches!(fact.value, FactValue::CpLaneOffset { .. }));
    let stated: Vec<Fact> = std::iter::once(&approach).chain(kept).cloned().collect();
    if let Some(contradiction) = narrative_contradictions(&stated, brief.template, brief.profile).first() {
        return Err(format!("{id} contradicts its template: {contradiction}"));
    }
    Ok(Told { staging, approach, facts })
}

/// A staging of the template chosen by the seed, with what of the pick, where there is one, does not depend on the conflict.
fn invent(pick: Option<&Reading>, brief: &Brief, ways: &[Staging]) -> Told {
    let mut rng = brief.seed.child(brief.scenario_id).child("alternative").rng();
    let by_zones = pick.filter(|pick| pick.collision.is_none()).and_then(|pick| from_zones(pick, ways));
    let (staging, why) = match by_zones {
        Some(staging) => (staging, "the contact areas suggest this side"),
        None => (ways[rng.below(ways.len())], "chosen among the approaches of the template"),
    };
    let facts = pick.map_or(&[][..], |pick| &pick.facts).iter().filter(|fact| survives(&fact.value)).cloned().collect();
    let source = FactSource::Assumed { why: why.to_owned() };
    let approach = Fact { value: FactValue::Approach { approach: staging.approach }, source };
    Told { staging, approach, facts }
}

/// What stays true of a record when another conflict takes its place.
fn survives(value: &FactValue) -> bool {
    matches!(
        value,
        FactValue::SvMovement { .. }
            | FactValue::CpMovement { .. }
            | FactValue::Partner { .. }
            | FactValue::Obstacles { .. }
    )
}

/// The staging of a relation.
fn stage(relation: Relation, brief: &Brief, ways: &[Staging]) -> Option<Staging> {
    let road = brief.template.road;
    let (approach, side) = match relation {
        // On a road without arms and on a circle, whoever comes "from the left" comes from the lane there.
        Relation::From(side) if road == RoadType::TrafficCircle => {
            let circulating = |way: &&Staging| matches!(way.approach, Approach::Ring | Approach::Left);
            let ring = ways.iter().find(|way| side == Side::Left && circulating(way));
            return ring.or_else(|| ways.iter().find(|way| way.beside == Some(side))).copied();
        }
        Relation::From(Side::Left) => (Approach::Left, None),
        Relation::From(Side::Right) => (Approach::Right, None),
        Relation::Crossing => {
            return ways.iter().find(|way| matches!(way.approach, Approach::Left | Approach::Right)).copied();
        }
        Relation::Oncoming => (Approach::Opposite, None),
        Relation::Beside(side) => (Approach::Same, side),
        Relation::Behind => return None,
    };
    ways.iter()
        .find(|way| way.approach == approach && (side.is_none() || way.beside == side))
        // "from the left" of a partner that can only have been beside the ego.
        .or_else(|| match relation {
            Relation::From(side) => ways.iter().find(|way| way.beside == Some(side)),
            _ => None,
        })
        .copied()
}

/// The staging the contact areas suggest: on which side of the ego the partner was, and from where a partner of this
/// template typically comes there.
fn from_zones(reading: &Reading, ways: &[Staging]) -> Option<Staging> {
    let side = side_from_zones(reading.record)?;
    let arm = match side {
        Side::Left => Approach::Left,
        Side::Right => Approach::Right,
    };
    let movements = (reading.record.sv_movement.known(), reading.record.cp_movement.known());
    let oncoming = match movements {
        // An ego that turns left shows its right side to oncoming traffic, one that goes straight meets the front or the
        // right side of an oncoming left-turner with its left.
        (Some(Movement::LeftTurn), Some(Movement::Straight)) => side == Side::Right,
        (Some(Movement::Straight), Some(Movement::LeftTurn)) => side == Side::Left,
        _ => false,
    };
    let first = |is: &dyn Fn(&Staging) -> bool| ways.iter().find(|way| is(way)).copied();
    first(&|way| oncoming && way.approach == Approach::Opposite)
        .or_else(|| first(&|way| way.approach == arm))
        .or_else(|| first(&|way| way.beside == Some(side)))
}

fn phrase(relation: Relation) -> &'static str {
    match relation {
        Relation::From(Side::Left) => "from the left",
        Relation::From(Side::Right) => "from the right",
        Relation::Crossing => "from a cross street",
        Relation::Oncoming => "from the opposite direction",
        Relation::Beside(Some(Side::Left)) => "in the lane to the left",
        Relation::Beside(Some(Side::Right)) => "in the lane to the right",
        Relation::Beside(None) => "going the same way",
        Relation::Behind => "behind or ahead in the same lane",
    }
}

/// Puts the facts in order and adds what the staging needs and the record does not tell.
fn complete(told: Told, brief: &Brief, diagnostics: &mut Vec<Diagnostic>) -> Vec<Fact> {
    let Told { staging, approach, mut facts } = told;
    let assumed = |value: FactValue, why: String| Fact { value, source: FactSource::Assumed { why } };
    let approach_source = approach.source.clone();
    facts.insert(0, approach);
    replace_partner(&mut facts, brief, diagnostics);
    facts.retain(|fact| match &fact.value {
        FactValue::CpLaneOffset { lanes } => offset_side(*lanes) == staging.beside,
        FactValue::CpLateral { towards, .. } => staging.beside.is_some_and(|side| side != *towards),
        FactValue::ThreeWay { missing } => fits_three_way(&brief.template, &staging, *missing),
        _ => true,
    });
    if let Some(side) = staging.beside {
        if !facts.iter().any(|fact| matches!(fact.value, FactValue::CpLaneOffset { .. })) {
            let lanes = if side == Side::Left { -1 } else { 1 };
            facts.insert(1, Fact { value: FactValue::CpLaneOffset { lanes }, source: approach_source });
        }
        let moves = facts.iter().any(|fact| matches!(fact.value, FactValue::CpLateral { .. }));
        if staging.conflict == ConflictKind::Sideways && !moves {
            let towards = if side == Side::Left { Side::Right } else { Side::Left };
            let kind = match (ground(&brief.template, &staging), brief.template.cp) {
                (Ground::Road, _) => LateralKind::CutIn,
                (_, Movement::Straight) => LateralKind::Drift,
                _ => LateralKind::WideTurn,
            };
            let why = "parallel paths meet only when one leaves its lane".to_owned();
            facts.push(assumed(FactValue::CpLateral { towards, kind }, why));
        }
    }
    let collides = facts.iter().any(|fact| matches!(fact.value, FactValue::Collision { .. }));
    if !collides {
        let kind = match staging.conflict {
            ConflictKind::Paths => CollisionKind::Angle,
            ConflictKind::Sideways => CollisionKind::Sideswipe,
        };
        facts.push(assumed(FactValue::Collision { kind }, "follows from how the paths meet".to_owned()));
    }
    facts
}

/// A partner the profile cannot simulate as itself becomes a passenger car, and that is said.
fn replace_partner(facts: &mut Vec<Fact>, brief: &Brief, diagnostics: &mut Vec<Diagnostic>) {
    let why = match Facts(facts).partner() {
        Some(kind) if brief.profile.expresses.partner_kinds.contains(&kind) => return,
        Some(kind) => {
            let (name, kind) = (&brief.profile.name, kind.label());
            format!("the profile \"{name}\" cannot simulate a partner of the kind \"{kind}\"")
        }
        None => "the kind of partner is not told".to_owned(),
    };
    diagnostics.push(Diagnostic::new(
        Severity::Note,
        "narrative.partner-replaced",
        Location::default(),
        format!("{}: {why}; a passenger car takes its place", brief.scenario_id),
    ));
    facts.retain(|fact| !matches!(fact.value, FactValue::Partner { .. }));
    let value = FactValue::Partner { kind: PartnerKind::PassengerCar };
    facts.insert(1, Fact { value, source: FactSource::Assumed { why } });
}
