//! What the evidence claims: of the suite as a whole, of its groups of tests, and of the tools.

use super::number::Number;
use super::structure::{Claim, Structure};
use super::{Runs, corpus};
use recrash_model::profile::SystemProfile;
use serde_json::Value;
use std::collections::BTreeMap;

/// Words of anybody's without braces, which stand for numbers here.
fn plain(text: &str) -> String {
    text.replace(['{', '}'], "")
}

/// The whole structure.
pub fn all(
    runs: &Runs,
    profile: &SystemProfile,
    numbers: &[Number],
    reports: &BTreeMap<&'static str, Value>,
) -> Vec<Claim> {
    let mut all = Structure::new(numbers);
    suite(&mut all, runs, profile);
    each_test(&mut all);
    groups(&mut all, runs);
    tools(&mut all, reports);
    corpus::claims(&mut all, reports.contains_key(corpus::NAME));
    all.claims()
}

/// What is claimed of the suite, and in which context.
fn suite(all: &mut Structure, runs: &Runs, profile: &SystemProfile) {
    let (ego, simulator, suite) = (plain(&runs.ego), plain(&runs.simulator), &runs.suite);
    all.add(
        "G1",
        "goal",
        &format!("What {ego} does in the tests of suite {suite} is known: of {{tests}} it passes {{passed}} ({{passed, not met}} of these never in the situation of the record, which says nothing; in {{passed, beyond tyres}} it brakes harder than tyres give, which says nothing of a vehicle), fails {{failed}}, and {{not_run}} were not run."),
        &["S1", "S2", "S3", "S4"],
        &["C1", "C2", "C3", "A1"],
    );
    all.add(
        "C1",
        "context",
        &format!("Suite {suite}, in suite/: scenarios, whose crash each tells, and by what a run is judged."),
        &[],
        &[],
    );
    all.add(
        "C2",
        "context",
        &format!("Simulator {simulator}, in which nobody but the ego reacts unless the scenario says so."),
        &[],
        &[],
    );
    let limits = "What counts as a failure stands in suite/frozen.json under profile.failure: a contact, a gap below the limit that was come nearer to, the road left, a stop for good.";
    all.add("C3", "context", &format!("Profile {}. {limits}", plain(&profile.name)), &[], &[]);
    all.add(
        "A1",
        "assumption",
        "A scenario stands for its crash as far as it was reconstructed; what is checked of that is said in the suite.",
        &[],
        &[],
    );
}

/// Every test by itself, and what the share of failed ones says.
fn each_test(all: &mut Structure) {
    all.add("S1", "strategy", "Over every test by itself: its verdict follows from its rollout.", &["G2", "G3"], &[]);
    all.add(
        "G2",
        "goal",
        "Each verdict, least gap, contact, speed and delta-v is what the rollout shows; the greatest delta-v of anybody in a contact of two road users is {greatest_delta_v}.",
        &["Sn1"],
        &["C4"],
    );
    all.add(
        "C4",
        "context",
        "Masses by kind in runs.json, or as the rollout gives a road user its own; plane impact without restitution, friction 0.5 (Brach).",
        &[],
        &[],
    );
    all.add("Sn1", "solution", "rollouts/: every state of everybody every 0.1 s, with contacts to the physics step; each rollout is named by the hash of its states.", &[], &[]);
    all.add(
        "G3",
        "goal",
        "The share of failed tests is {failed_share}, between {failed_share, at least} and {failed_share, at most} for tests drawn as these were (95 %). {passed, not met} of the passed ones never came into the situation of their record and say nothing of it.",
        &["Sn1"],
        &[],
    );
}

/// Failures by crash type, by whose crash it is, by cause, and whether good drivers avoid them.
fn groups(all: &mut Structure, runs: &Runs) {
    let mut under = Vec::new();
    for (field, what) in [
        ("crash_type", "crash type"),
        ("provenance", "provenance"),
        ("cause", "cause"),
        ("preventability", "preventability"),
    ] {
        let of = |test: &super::TestFacts| match field {
            "crash_type" => Some(test.crash_type),
            "provenance" => Some(test.provenance),
            "cause" => test.cause,
            _ => test.preventability,
        };
        let mut values: Vec<&str> = runs.tests.iter().filter_map(of).collect();
        values.sort_unstable();
        values.dedup();
        let both = matches!(field, "crash_type" | "provenance");
        for value in values {
            let id = format!("G{}", 4 + under.len());
            let text = if both {
                format!("Of the {{{field}: {value}}} tests of {what} \"{value}\", {{{field}: {value}, failed}} fail.")
            } else {
                format!("{{{field}: {value}}} of the failed tests are of {what} \"{value}\".")
            };
            all.add(&id, "goal", &text, &["Sn2"], &[]);
            under.push(id);
        }
    }
    let under: Vec<&str> = under.iter().map(String::as_str).collect();
    all.add("S2", "strategy", "Over groups of tests: by crash type, whose crash it is, what led to the failure, and what reference drivers make of it.", &under, &["A2"]);
    all.add("A2", "assumption", "Cause, preventability and whether the situation of a record was met and the ego braked harder than tyres give are told by rules and models (docs/models/causes.md, docs/models/reference-drivers.md, docs/models/ego-behaviour.md, docs/nightly.md); the checker counts them and does not run the models.", &[], &[]);
    all.add("Sn2", "solution", "runs.json: what is said of each test.", &[], &[]);
}

/// Whether the tools can be believed.
fn tools(all: &mut Structure, reports: &BTreeMap<&'static str, Value>) {
    all.add(
        "S3",
        "strategy",
        "Over the tools: failures that small changes undo, or that another simulator does not show, say little.",
        &["T1", "T2"],
        &[],
    );
    if reports.contains_key("robustness") {
        all.add(
            "T1",
            "goal",
            "Of {robustness: failures} failures {robustness: robust} are robust ({robustness: robust share}); {robustness: marginal} live on less than 5 cm or 0.1 s, {robustness: step artefacts} on the physics step; of the robust ones {robustness: robust, fails on the second} fail on a second simulator too, {robustness: robust, passes on the second} pass there, and {robustness: robust, not run on a second} were not run there.",
            &["Sn3"],
            &[],
        );
        all.add("Sn3", "solution", "reports/robustness.json", &[], &[]);
    } else {
        all.add(
            "T1",
            "undeveloped",
            "How robust the failures are: no report of `recrash robustness` was given.",
            &[],
            &[],
        );
    }
    if reports.contains_key("parity") {
        all.add(
            "T2",
            "goal",
            "Of {parity: failed natively} failures among {parity: pairs} runs of both simulators, {parity: failed on both} are failures on MetaDrive too ({parity: confirmed share}).",
            &["Sn4"],
            &[],
        );
        all.add("Sn4", "solution", "reports/parity.json", &[], &[]);
    } else {
        all.add(
            "T2",
            "undeveloped",
            "How far another simulator agrees: no report of `recrash parity` was given.",
            &[],
            &[],
        );
    }
}

/// How to check the folder.
pub fn readme(runs: &Runs, numbers: usize) -> String {
    format!(
        "# Evidence\n\nWhat {} does in the tests of suite {}, in {}, written by recrash {}.\n\n    python3 check.py\n\n\
         works out each of the {numbers} numbers in `numbers.json` again, from the rollouts or by counting, and holds every claim in\n\
         `claims.json` and every file against it. It needs Python 3.8 and nothing else. To run a test again:\n\n    \
         recrash test suite --ego EGO\n\n| file | what it is |\n|---|---|\n\
         | `claims.json` | claims as a goal structure (GSN): `supported_by` and `in_context_of` are its arrows |\n\
         | `numbers.json` | every number with its formula |\n| `manifest.json` | the SHA-256 of every file: the root |\n\
         | `runs.json` | what is said of each test |\n| `rollouts/` | what happened in each |\n\
         | `suite/` | the frozen suite |\n| `reports/` | reports of other commands, where there are some |\n\n\
         Who changes rollouts, numbers and hashes, all in agreement, is not found by the checker: keep the hash of\n\
         `manifest.json` that `recrash evidence` prints.\n",
        plain(&runs.ego),
        runs.suite,
        plain(&runs.simulator),
        runs.recrash
    )
}
