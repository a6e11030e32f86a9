//! Facts of an answer held against the narrative and the columns of the report. What the draft says as well needs no words.

use super::answer::{ActAnswer, Quoted};
use super::cues;
use recrash_model::account::{ActFact, Fact, Source};
use recrash_model::record::CrashRecord;

/// Longest pattern of a quotation. [byte]
const LONGEST_QUOTATION: usize = 600;

/// Whether a column says a fact; `None` where it is none that tells it.
pub(super) fn no_column<T>(_: T, _: &str) -> Option<bool> {
    None
}

/// An answer being held against the report it is about.
pub(super) struct Held<'a> {
    pub record: &'a CrashRecord,
    pub problems: Vec<String>,
}

impl Held<'_> {
    /// Lays a fact of the answer over what is known. `cue` is whether words can say it; `column` whether a column says it.
    pub fn lay<T: Copy + PartialEq>(
        &mut self,
        path: &str,
        known: &mut Option<Fact<T>>,
        answer: &Option<Quoted<T>>,
        cue: impl Fn(T, &str) -> bool,
        column: impl Fn(T, &str) -> Option<bool>,
    ) {
        let Some(quoted) = answer else { return };
        if let Some(fact) = self.fact(path, known.as_slice(), quoted, cue, column) {
            *known = Some(fact);
        }
    }

    /// Puts the list of the answer, where there is one, in the place of what is known.
    pub fn list<T: Copy + PartialEq>(
        &mut self,
        path: &str,
        known: &mut Vec<Fact<T>>,
        answer: &Option<Vec<Quoted<T>>>,
        cue: impl Fn(T, &str) -> bool,
        column: impl Fn(T, &str) -> Option<bool>,
    ) {
        let Some(answer) = answer else { return };
        let one = |(number, quoted): (usize, &Quoted<T>)| {
            self.fact(&format!("{path}[{number}]"), known, quoted, &cue, &column)
        };
        *known = answer.iter().enumerate().filter_map(one).collect();
    }

    /// The fact with its source: that of the draft, where it says the same, else the words or the column that are named.
    pub fn fact<T: Copy + PartialEq>(
        &mut self,
        path: &str,
        known: &[Fact<T>],
        quoted: &Quoted<T>,
        cue: impl Fn(T, &str) -> bool,
        column: impl Fn(T, &str) -> Option<bool>,
    ) -> Option<Fact<T>> {
        if let Some(same) = known.iter().find(|fact| fact.value == quoted.value) {
            return Some(same.clone());
        }
        let source = match (&quoted.words, &quoted.column) {
            (Some(words), None) => self.words(path, words, 0, |words| cue(quoted.value, words)),
            (None, Some(name)) => match column(quoted.value, name) {
                Some(true) => Ok(Source::Column { name: name.clone() }),
                Some(false) => Err(format!("{path}: the column {name} of {} says otherwise", self.record.id)),
                None => Err(format!("{path}: {name} is no column that tells it")),
            },
            _ => Err(format!("{path} needs either words or a column")),
        };
        self.taken(source).map(|source| Fact { value: quoted.value, source })
    }

    /// The acts of one road user: each is known already, or has its words, which stand behind those of the act before where they
    /// stand in several places.
    pub fn acts(&mut self, path: &str, known: &[ActFact], answer: &[ActAnswer]) -> Vec<ActFact> {
        let mut behind = 0;
        let mut acts = Vec::new();
        for (number, act) in answer.iter().enumerate() {
            let path = format!("{path}[{number}]");
            let source = match (known.iter().find(|fact| is_same(fact, act)), &act.words) {
                (Some(same), _) => Ok(same.source.clone()),
                (None, Some(words)) => self.words(&path, words, behind, |words| cues::act(act.act, words)),
                (None, None) => Err(format!("{path} needs words")),
            };
            let Some(source) = self.taken(source) else { continue };
            if let Source::Words { start, .. } = source {
                behind = start;
            }
            let ActAnswer { act, side, step, after_contact, begun, done, after_other, manner, words: _ } = act.clone();
            acts.push(ActFact { act, side, step, after_contact, begun, done, after_other, manner, source });
        }
        acts
    }

    fn words(&self, path: &str, words: &str, behind: usize, cue: impl Fn(&str) -> bool) -> Result<Source, String> {
        match quotation(&self.record.narrative, words, behind) {
            None => Err(format!("{path}.words do not stand in the narrative of {}", self.record.id)),
            Some(source) if cue(&words.to_lowercase()) => Ok(source),
            Some(_) => Err(format!("{path}.words do not say it; quote the words that do, or leave it out")),
        }
    }

    fn taken(&mut self, source: Result<Source, String>) -> Option<Source> {
        source.map_err(|problem| self.problems.push(problem)).ok()
    }
}

/// Whether the draft has this act, said by these words.
fn is_same(fact: &ActFact, act: &ActAnswer) -> bool {
    let words = match (&fact.source, &act.words) {
        (Source::Words { text, .. }, Some(words)) => text == words,
        _ => true,
    };
    fact.act == act.act && words
}

/// Where words stand in a narrative, letter for letter but for case and the width of spaces: there where they first stand `behind`
/// this byte, else where they first stand.
fn quotation(narrative: &str, words: &str, behind: usize) -> Option<Source> {
    let words: Vec<String> = words.split_whitespace().map(regex::escape).collect();
    if words.is_empty() || words.join(" ").len() > LONGEST_QUOTATION {
        return None;
    }
    let pattern = regex::RegexBuilder::new(&words.join(r"\s+")).case_insensitive(true).build().ok()?;
    let later = pattern.find_iter(narrative).find(|found| found.start() >= behind);
    let found = later.or_else(|| pattern.find(narrative))?;
    Some(Source::Words { start: found.start(), end: found.end(), text: found.as_str().to_owned() })
}
