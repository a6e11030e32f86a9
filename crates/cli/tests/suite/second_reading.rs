//! A whole run of the default profile with a language model: it reads what the built-in reader did not read whole, and the crash is
//! told as it reads it.

use crate::common::server::Reply;
use crate::common::{FEW, UNREAD, recrash};
use crate::live::{Folder, ledger, read, server, shares, shown};
use serde_json::{Value, json};

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

/// A model that reads everything is asked about every incident. What it corrects is in the account; an account by which the crash
/// cannot be rebuilt goes back to it with the reason, and where it insists, the reader's stays.
#[test]
fn a_model_reads_all_and_what_cannot_be_rebuilt_goes_back_to_it() {
    let folder = Folder::new();
    let server = server(|request| {
        let messages = request.messages();
        let asked = messages[1]["content"].as_str().unwrap();
        let answer = if asked.contains("Report 90101-251/1") {
            // Nobody is touched: the crash cannot be rebuilt.
            json!({"report": "90101-251/1", "another_partner": true})
        } else {
            let report = asked.split("Report ").nth(1).unwrap().split(". Columns").next().unwrap();
            json!({"report": report, "nobody_tells": ["driver"]})
        };
        Some(Reply::Text(answer.to_string()))
    });
    let out = folder.suite();
    let output =
        recrash(&["run", "--profile", "open", "--paraphrase", "scripted", "--model-reads", "all", "--repairs", "2"])
            .args(["--budget", "3", "--tune-budget", "1", "--concurrency", "8", "--base-url", &server.base_url])
            .args(["--records", FEW, "--out", out.to_str().unwrap()])
            .output()
            .unwrap();
    assert!(output.status.success(), "{}", shown(&output));
    assert!(shown(&output).contains("reads 49 of 49 readable incidents (100.0 %): "), "{}", shown(&output));
    let readers = read(&out.join("1-accounts.agents.json"));
    assert_eq!(readers.as_object().unwrap().len(), 49);
    let accounts = read(&out.join("1-accounts.json"));
    let told = accounts["told"].as_array().unwrap();
    let corrected: Vec<&Value> = told.iter().filter(|account| account["author"]["model"] == "scripted").collect();
    assert!(corrected.len() > 30 && corrected.iter().all(|account| account["driver"].is_null()), "{}", corrected.len());
    let insisted = ledger(&out)
        .into_iter()
        .filter(|exchange| exchange["question"]["turns"][0]["text"].as_str().unwrap().contains("Report 90101-251/1"));
    let insisted: Vec<Value> = insisted.collect();
    assert_eq!(insisted.len(), 3);
    let why = "the crash cannot be rebuilt from this account: ";
    assert!(insisted.iter().any(|exchange| exchange.to_string().contains(why)), "{insisted:?}");
    let of_reader = told.iter().chain(accounts["untold"].as_array().unwrap().iter().map(|untold| &untold["account"]));
    let kept = of_reader.into_iter().find(|account| account["report"] == "90101-251/1").unwrap();
    assert!(kept["author"].is_null() && kept["partner"]["kind"]["value"] == "pickup", "{kept}");
}
