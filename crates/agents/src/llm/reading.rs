//! The answer of the role that reads: facts of an account, each with the words or the column it stands in, checked one by one
//! and laid over what the built-in reader found.

use super::cues;
use recrash_model::account::{
    Account, ContactState, CrashType, Driver, Fact, FirstContact, Kind, KindGroup, Origin, Party, PlaceKind, Source,
    Speed, SpeedMeaning, Standing, Striker, told,
};
use recrash_model::narrative::FirstMover;
use recrash_model::record::CrashRecord;
use recrash_model::scenario::Author;
use recrash_model::template::Movement;
use recrash_model::zones::ContactZone;
use schemars::JsonSchema;
use serde::Deserialize;

/// Fewest facts with words or columns that an answer needs: fewer tell no crash.
const FEWEST_FACTS: usize = 3;
/// Least and most words of a quotation, by bytes.
const LONGEST_WORDS: usize = 300;

/// A fact, and where it stands: `words` copied letter for letter from the narrative, or the name of a `column`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Quoted<T> {
    /// The fact.
    value: T,
    /// The words that say so, copied from the narrative of the report; null where a column does.
    #[schemars(length(max = 300))]
    words: Option<String>,
    /// The column that says so; null where words do.
    column: Option<String>,
}

/// A speed and what it is the speed of.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SpeedValue {
    /// The speed. [m/s]
    #[schemars(range(min = 0.0, max = 60.0))]
    mps: f64,
    /// Of what.
    meaning: SpeedMeaning,
}

/// What is told of one of the two; null where nothing is.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct PartyAnswer {
    /// What it is.
    kind: Option<Quoted<Kind>>,
    /// Movement just before the conflict; who stood before it was hit is `stopped`.
    movement: Option<Quoted<Movement>>,
    /// State at the contact.
    state: Option<Quoted<ContactState>>,
    /// How long it had stood, where it stood at the contact.
    standing: Option<Quoted<Standing>>,
    /// Its speed.
    speed: Option<Quoted<SpeedValue>>,
    /// Where it was touched.
    #[serde(default)]
    #[schemars(length(max = 4))]
    zones: Vec<Quoted<ContactZone>>,
}

/// The account of the first report's crash.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct AccountAnswer {
    /// The first report, such as `30270-7733/1`.
    report: String,
    /// Type of the crash, which follows from the facts below.
    crash_type: CrashType,
    /// The subject vehicle.
    sv: PartyAnswer,
    /// The partner: the first road user or thing that the subject vehicle touched, or that touched it.
    partner: Option<PartyAnswer>,
    /// From where the partner came, seen from the subject vehicle before any turn.
    came_from: Option<Quoted<Origin>>,
    /// Who moved into whom.
    striker: Option<Quoted<Striker>>,
    /// Who was at the place of the conflict first.
    order: Option<Quoted<FirstMover>>,
    /// First harmful contact.
    first_contact: Option<Quoted<FirstContact>>,
    /// Who drove the subject vehicle at the contact.
    driver: Option<Quoted<Driver>>,
    /// Kind of place.
    place: Option<Quoted<PlaceKind>>,
}

/// An answer being checked against the report it is about.
struct Checked<'a> {
    record: &'a CrashRecord,
    facts: usize,
    problems: Vec<String>,
}

impl Checked<'_> {
    /// The fact with its source, where it stands there. `cue` is what words that say so hold; `column` whether a column says so.
    fn fact<T: Copy>(
        &mut self,
        path: &str,
        quoted: &Option<Quoted<T>>,
        cue: impl Fn(T, &str) -> bool,
        column: impl Fn(T, &str) -> Option<bool>,
    ) -> Option<Fact<T>> {
        self.quoted(path, quoted.as_ref()?, cue, column)
    }

    fn quoted<T: Copy>(
        &mut self,
        path: &str,
        quoted: &Quoted<T>,
        cue: impl Fn(T, &str) -> bool,
        column: impl Fn(T, &str) -> Option<bool>,
    ) -> Option<Fact<T>> {
        let source = match (&quoted.words, &quoted.column) {
            (Some(words), None) => match quotation(&self.record.narrative, words) {
                None => Err(format!("{path}.words do not stand in the narrative of {}", self.record.id)),
                Some(source) if cue(quoted.value, &words.to_lowercase()) => Ok(source),
                Some(_) => Err(format!("{path}.words do not say it; quote the words that do, or leave it out")),
            },
            (None, Some(name)) => match column(quoted.value, name) {
                Some(true) => Ok(Source::Column { name: name.clone() }),
                Some(false) => Err(format!("{path}: the column {name} of {} says otherwise", self.record.id)),
                None => Err(format!("{path}: {name} is no column that tells it")),
            },
            _ => Err(format!("{path} needs either words or a column")),
        };
        match source {
            Ok(source) => {
                self.facts += 1;
                Some(Fact { value: quoted.value, source })
            }
            Err(problem) => {
                self.problems.push(problem);
                None
            }
        }
    }

    /// A party's facts laid over those that are known of it.
    fn party(&mut self, path: &str, answer: &PartyAnswer, party: &mut Party) {
        let record = self.record;
        let is_sv = path == "sv";
        let at = |name: &str| format!("{path}.{name}");
        let no_column = |_: ContactState, _: &str| None;
        let kind_column = |kind: Kind, name: &str| {
            let known = (name == "Crash With" && !is_sv).then_some(&record.partner)?.known()?;
            Some(kind.partner_kind() == Some(known))
        };
        let movement_column = |movement: Movement, name: &str| {
            let (own, known) = match is_sv {
                true => ("SV Pre-Crash Movement", record.sv_movement.known()),
                false => ("CP Pre-Crash Movement", record.cp_movement.known()),
            };
            (name == own).then(|| known == Some(movement))
        };
        let zone_column = |zone: ContactZone, name: &str| {
            let (own, known) = match is_sv {
                true => ("SV Contact Area", &record.sv_zones),
                false => ("CP Contact Area", &record.cp_zones),
            };
            (name == own).then(|| known.contains(&zone))
        };
        let speed_column = |speed: SpeedValue, name: &str| {
            let known = (is_sv && name == "SV Precrash Speed").then_some(record.sv_speed_mps)?;
            Some(known.is_some_and(|known| (known - speed.mps).abs() <= 0.5))
        };
        lay(&mut party.kind, self.fact(&at("kind"), &answer.kind, cues::kind, kind_column));
        lay(&mut party.movement, self.fact(&at("movement"), &answer.movement, cues::movement, movement_column));
        lay(&mut party.state, self.fact(&at("state"), &answer.state, cues::state, no_column));
        lay(&mut party.standing, self.fact(&at("standing"), &answer.standing, cues::standing, |_, _| None));
        let said = |speed: SpeedValue, words: &str| cues::speed(speed.mps, words);
        if let Some(speed) = self.fact(&at("speed"), &answer.speed, said, speed_column) {
            let SpeedValue { mps, meaning } = speed.value;
            party.speeds.retain(|known| known.value.meaning != meaning);
            party.speeds.push(Fact { value: Speed { mps, meaning }, source: speed.source });
        }
        let zones: Vec<Fact<ContactZone>> = answer
            .zones
            .iter()
            .enumerate()
            .filter_map(|(number, zone)| self.quoted(&format!("{path}.zones[{number}]"), zone, cues::zone, zone_column))
            .collect();
        // The columns are known: words alone say more.
        if zones.iter().any(|zone| zone.source.is_told()) {
            party.zones = zones;
        }
    }
}

/// The answer laid over `base`, the account that the built-in reader made of the same incident. `record` is the report whose
/// narrative speaks.
///
/// # Errors
/// Every fact that is not as its words or its column say, and every two that cannot both be true.
pub(super) fn account(
    answer: &AccountAnswer,
    base: &Account,
    record: &CrashRecord,
    model: &str,
) -> Result<Account, Vec<String>> {
    let mut account = base.clone();
    let mut checked = Checked { record, facts: 0, problems: Vec::new() };
    if answer.report != record.id.to_string() {
        checked.problems.push(format!("report is {}; the report to read is {}", answer.report, record.id));
    }
    checked.party("sv", &answer.sv, &mut account.sv);
    if let Some(partner) = &answer.partner {
        let known = account.partner.get_or_insert_default();
        // Of somebody else nothing stays.
        let kind = partner.kind.as_ref().map(|kind| kind.value);
        if kind.is_some_and(|kind| told(&known.kind).is_some_and(|known| known != kind)) {
            *known = Party::default();
            account.others.retain(|other| Some(other.kind.value) != kind);
        }
        checked.party("partner", partner, known);
    }
    let no_column = |_: &str| None;
    lay(&mut account.came_from, checked.fact("came_from", &answer.came_from, cues::origin, |_, name| no_column(name)));
    lay(&mut account.striker, checked.fact("striker", &answer.striker, cues::contact, |_, name| no_column(name)));
    lay(&mut account.order, checked.fact("order", &answer.order, cues::order, |_, name| no_column(name)));
    lay(
        &mut account.first_contact,
        checked.fact("first_contact", &answer.first_contact, cues::contact, |_, name| no_column(name)),
    );
    lay(&mut account.driver, checked.fact("driver", &answer.driver, cues::driver, |_, name| no_column(name)));
    lay(&mut account.place.kind, checked.fact("place", &answer.place, cues::place, |_, name| no_column(name)));
    account.crash_type = Some(Fact::by_rule(answer.crash_type, "read by a language model"));
    account.author = Author::Model(model.to_owned());
    let Checked { facts, mut problems, .. } = checked;
    if facts < FEWEST_FACTS && problems.is_empty() {
        problems.push(format!("it tells {facts} facts with their words; a crash takes {FEWEST_FACTS} at least"));
    }
    problems.extend(contradictions(&account));
    if problems.is_empty() { Ok(account) } else { Err(problems) }
}

fn lay<T>(known: &mut Option<Fact<T>>, found: Option<Fact<T>>) {
    if found.is_some() {
        *known = found;
    }
}

/// Where words stand in a narrative: letter for letter but for case and the width of spaces.
fn quotation(narrative: &str, words: &str) -> Option<Source> {
    let words: Vec<String> = words.split_whitespace().map(regex::escape).collect();
    if words.is_empty() || words.join(" ").len() > 2 * LONGEST_WORDS {
        return None;
    }
    let pattern = regex::RegexBuilder::new(&words.join(r"\s+")).case_insensitive(true).build().ok()?;
    let found = pattern.find(narrative)?;
    Some(Source::Words { start: found.start(), end: found.end(), text: found.as_str().to_owned() })
}

/// Facts that cannot be true together.
fn contradictions(account: &Account) -> Vec<String> {
    let mut all = Vec::new();
    let crash_type = told(&account.crash_type);
    let group = account.partner.as_ref().and_then(|partner| told(&partner.kind)).map(Kind::group);
    let of_kind = match crash_type {
        Some(CrashType::Pedestrian) => Some(KindGroup::OnFoot),
        Some(CrashType::Cyclist) => Some(KindGroup::Cyclist),
        Some(CrashType::Motorcycle) => Some(KindGroup::Motorcycle),
        _ => None,
    };
    if let (Some(wanted), Some(group), Some(crash_type)) = (of_kind, group, crash_type)
        && wanted != group
    {
        all.push(format!("crash_type is {}; the partner is of another kind", crash_type.label()));
    }
    let fits = match (crash_type, told(&account.came_from)) {
        (Some(CrashType::FrontToRear), Some(from)) => !matches!(from, Origin::Opposite | Origin::Cross { .. }),
        (Some(CrashType::HeadOn), Some(from)) => matches!(from, Origin::Opposite | Origin::Ahead),
        (Some(CrashType::Lateral), Some(from)) => !matches!(from, Origin::Opposite | Origin::Cross { .. }),
        _ => true,
    };
    if let (false, Some(crash_type), Some(from)) = (fits, crash_type, told(&account.came_from)) {
        all.push(format!("crash_type is {}; a partner {} has no such crash", crash_type.label(), from.words()));
    }
    for (who, party) in [("sv", Some(&account.sv)), ("partner", account.partner.as_ref())] {
        let Some(party) = party else { continue };
        let impact = party.speeds.iter().find(|speed| speed.value.meaning == SpeedMeaning::Impact);
        if let (Some(state), Some(speed)) = (told(&party.state), impact)
            && state.stands()
            && speed.value.mps > 1.0
        {
            all.push(format!("{who} is {}, and its speed at the contact {:.1} m/s", state.label(), speed.value.mps));
        }
    }
    all
}
