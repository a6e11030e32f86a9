//! A whole run of the default profile with a language model: it reads what the built-in reader did not read whole, and the crash is
//! told as it reads it.

use crate::common::{FEW, UNREAD, recrash};
use crate::live::{Folder, ledger, read, server, shares, shown};
use serde_json::Value;

#[test]
fn a_model_reads_what_the_built_in_reader_did_not_read_whole() {
    let folder = Folder::new();
    let server = server(|_| None);
    let out = folder.suite();
    let run = |more: &[&str]| {
        let arguments =
            ["run", "--profile", "open", "--paraphrase", "scripted", "--budget", "all", "--tune-budget", "1"];
        recrash(&arguments).args(["--records", FEW, "--out", out.to_str().unwrap()]).args(more).output().unwrap()
    };
    let output = run(&["--base-url", &server.base_url, "--concurrency", "8"]);
    assert!(output.status.success(), "{}", shown(&output));
    // How many and at which price is said before the first question; only those are asked about.
    let told = shown(&output);
    assert!(told.contains(" of 49 readable incidents (") && told.contains("at a price that is not known"), "{told}");
    let readers = read(&out.join("1-accounts.agents.json"));
    let asked = readers.as_object().unwrap().len();
    assert!((1..20).contains(&asked), "{asked}");
    let answers = ledger(&out);
    assert!(answers.iter().all(|exchange| exchange["question"]["purpose"]["role"] == "paraphrase"));
    assert!(answers.len() >= asked, "{} of {asked}", answers.len());
    let unread = format!("{UNREAD}/1");
    // The crash is told now, by the model's account, and the page says who read it.
    let summary = read(&out.join("summary.json"));
    let [first, repaired, fallback] = shares(&summary, "paraphrase");
    assert_eq!((first + repaired + fallback) as usize, asked);
    let accounts = read(&out.join("1-accounts.json"));
    let by_model: Vec<&Value> = accounts["told"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|account| account["author"]["model"] == "scripted")
        .collect();
    assert!(by_model.iter().any(|account| account["report"] == unread), "{by_model:?}");
    let cases = summary["cases"].as_array().unwrap();
    let case = cases.iter().find(|case| case["told"] == unread).expect("it is in the suite");
    assert_eq!((&case["recorded"]["faithful"] == "no", &case["failure"]), (false, &Value::Null), "{case}");
    assert_eq!(case["narrated"]["outcome"], "first answer");
    // Nothing is asked again, and the ledger alone gives the same.
    let before = server.requests().len();
    assert!(run(&["--base-url", &server.base_url]).status.success() && server.requests().len() == before);
    let again = run(&["--llm", "replay", "--discard-edits"]);
    assert!(
        again.status.success() && read(&out.join("summary.json"))["models"] == summary["models"],
        "{}",
        shown(&again)
    );
}
