//! Mutated cases: whatever somebody writes by mistake is refused with a place, or runs to its end.

use crate::gallery::{ROOT, case_names};
use recrash_model::Seed;
use recrash_model::seed::Rng;
use recrash_sim::{Ego, simulate};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// Mutated scenarios in a run of all tests; `RECRASH_MUTATED` asks for another number.
const COUNT: usize = 1000;

/// No scenario takes longer, refused or run with both drivers.
const LONGEST: Duration = Duration::from_secs(10);

/// Numbers that people do not mean.
const STRANGE: [f64; 14] = [0.0, -0.0, 1.0, -1.0, 0.1, 1e-9, 255.0, 256.0, 1e3, -1e3, 1e6, 1e9, 1e300, -1e300];

/// A pointer to every node of a document.
fn nodes(value: &Value, here: &str, list: &mut Vec<String>) {
    list.push(here.to_owned());
    match value {
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(at, item)| nodes(item, &format!("{here}/{at}"), list))
        }
        Value::Object(fields) => fields.iter().for_each(|(name, item)| nodes(item, &format!("{here}/{name}"), list)),
        _ => {}
    }
}

/// Some node that passes a test.
fn some(rng: &mut Rng, document: &Value, fits: impl Fn(&Value) -> bool) -> Option<String> {
    let mut all = Vec::new();
    nodes(document, "", &mut all);
    all.retain(|pointer| !pointer.is_empty() && document.pointer(pointer).is_some_and(&fits));
    (!all.is_empty()).then(|| all.swap_remove(rng.below(all.len())))
}

/// One mistake; its name.
fn mistake(rng: &mut Rng, document: &mut Value) -> Option<&'static str> {
    let kind = rng.below(8);
    match kind {
        // Numbers, twice as often as anything else.
        0 | 1 => {
            let at = some(rng, document, Value::is_number)?;
            let node = document.pointer_mut(&at)?;
            let was = node.as_f64()?;
            let number = match rng.below(3) {
                0 => STRANGE[rng.below(STRANGE.len())],
                1 => was * rng.range(-2.0, 3.0),
                _ => was + rng.range(-5.0, 5.0),
            };
            *node = if rng.below(2) == 0 { json!(number) } else { json!(number.clamp(-1e15, 1e15) as i64) };
            Some("number")
        }
        2 => {
            let at = some(rng, document, |_| true)?;
            let (parent, name) = at.rsplit_once('/')?;
            match document.pointer_mut(parent)? {
                Value::Array(items) => drop(items.remove(name.parse().ok()?)),
                Value::Object(fields) => drop(fields.remove(name)),
                _ => return None,
            }
            Some("removed")
        }
        3 => {
            let at = some(rng, document, |node| node.as_array().is_some_and(|items| !items.is_empty()))?;
            let items = document.pointer_mut(&at)?.as_array_mut()?;
            let item = items[rng.below(items.len())].clone();
            let times = [1, 1, 1, 2, 40, 600][rng.below(6)];
            items.extend(std::iter::repeat_n(item, times));
            Some("doubled")
        }
        4 => {
            let (a, b) = (some(rng, document, Value::is_string)?, some(rng, document, Value::is_string)?);
            let (first, second) = (document.pointer(&a)?.clone(), document.pointer(&b)?.clone());
            *document.pointer_mut(&a)? = second;
            *document.pointer_mut(&b)? = first;
            Some("swapped references")
        }
        5 => {
            let (from, to) = (some(rng, document, |_| true)?, some(rng, document, |_| true)?);
            let node = document.pointer(&from)?.clone();
            *document.pointer_mut(&to)? = node;
            Some("moved")
        }
        6 => {
            let at = some(rng, document, Value::is_string)?;
            let texts = ["", "ego", "main+", "\u{1f699}", "../x", "a b"];
            *document.pointer_mut(&at)? = json!(texts[rng.below(texts.len())]);
            Some("text")
        }
        _ => {
            let (a, b) = (some(rng, document, Value::is_object)?, some(rng, document, Value::is_object)?);
            // Two of a kind change places, such as two roads or two acts.
            let (first, second) = (document.pointer(&a)?.clone(), document.pointer(&b)?.clone());
            if a.starts_with(&b) || b.starts_with(&a) {
                return None;
            }
            *document.pointer_mut(&a)? = second;
            *document.pointer_mut(&b)? = first;
            Some("swapped nodes")
        }
    }
}

#[test]
fn mutated_cases_are_refused_with_a_place_or_run_to_their_end() {
    let count = std::env::var("RECRASH_MUTATED").map_or(COUNT, |number| number.parse().expect("a number"));
    let names: Vec<String> = case_names().into_iter().collect();
    let (mut refused, mut ran, mut slowest) = (BTreeMap::<&str, usize>::new(), 0, (Duration::ZERO, 0));
    for number in 0..count {
        let mut rng = Seed(12).child(&format!("mutated {number}")).rng();
        let name = &names[rng.below(names.len())];
        let text = std::fs::read_to_string(Path::new(ROOT).join(format!("{name}.json"))).expect("a case");
        let mut document: Value = serde_json::from_str(&text).expect("a case is JSON");
        let mut made = "nothing";
        for _ in 0..=rng.below(3) {
            made = mistake(&mut rng, &mut document).unwrap_or(made);
        }
        let text = document.to_string();
        let begun = Instant::now();
        let read = recrash_roads::read_draft(&text).and_then(|read| recrash_roads::check(read.value));
        match read {
            Ok(scenario) => {
                for ego in [Ego::Recorded, Ego::Idm] {
                    let rollout = simulate(&scenario.value, ego);
                    assert!(rollout.steps() > 0, "{number} of {name}");
                }
                ran += 1;
            }
            Err(problems) => {
                let placed =
                    problems.iter().all(|problem| problem.location.path.is_some() || problem.location.line.is_some());
                assert!(!problems.is_empty() && placed, "{number} of {name}, {made}: {problems:?}\n{text}");
                *refused.entry(made).or_default() += 1;
            }
        }
        let took = begun.elapsed();
        assert!(took < LONGEST, "{number} of {name}, {made}: {took:?}\n{text}");
        slowest = slowest.max((took, number));
    }
    println!("{count} mutated: {ran} ran, refused by the last mistake {refused:?}; the slowest took {slowest:?}");
    assert!(ran > count / 20 && refused.len() == 7, "{ran} ran, {refused:?}");
}
