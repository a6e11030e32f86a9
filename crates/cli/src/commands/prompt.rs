//! `recrash prompt`: what a language model would be asked, without asking it.

use crate::options::SourceArgs;
use crate::output::{self, Output, title};
use crate::screen::println;
use clap::Args;
use recrash_pipeline::{Options, PipelineError, Prompt, PromptRequest, Role, prompt};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash prompt paraphrase                              for the first scenario of suite/, or of the built-in sample
  recrash prompt design --scenario intersection-straight-left-90100-12 --out mini-suite
  recrash prompt paraphrase --records ads.csv --record 30270-7733/2
  recrash prompt restage --out suite                     what the rules staged, and its replay, beside its report
  recrash prompt review --out suite                      a replay beside its report, of a suite that goes by accounts
  recrash prompt tune --json | jq .question.schema       the schema that the answer must fit

No network and no key is needed, and nothing is written. Repairs and later rounds are in the ledger once they were asked.";

/// Options of `prompt`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct PromptArgs {
    /// Role: paraphrase, design, tune, restage or review.
    #[arg(value_name = "ROLE", value_parser = role)]
    pub role: Role,
    /// Scenario of the suite. [default: the first]
    #[arg(long, value_name = "ID", conflicts_with = "record")]
    pub scenario: Option<String>,
    /// Record, such as 30270-7733/2.
    #[arg(long, value_name = "ID")]
    pub record: Option<String>,
    /// Model that would be asked; it is part of the question's hash. [default: the suite's]
    #[arg(long, value_name = "MODEL")]
    pub agent: Option<String>,
    /// Folder of the suite; where there is none, the records are read and selected from for the purpose.
    #[arg(long, short, value_name = "DIR", default_value = "suite")]
    pub out: PathBuf,
    /// Where crash records come from, without a suite.
    #[command(flatten)]
    pub source: SourceArgs,
    /// System profile, without a suite: a built-in name or a TOML file. [default: paper]
    #[arg(long, value_name = "NAME|FILE")]
    pub profile: Option<String>,
}

fn role(name: &str) -> Result<Role, String> {
    Role::ALL
        .into_iter()
        .find(|role| role.name() == name)
        .ok_or_else(|| "it is paraphrase, design, tune, restage or review".to_owned())
}

/// Shows the question.
///
/// # Errors
/// There is no such scenario or record.
pub fn run(args: &PromptArgs, output: Output) -> Result<(), PipelineError> {
    let base = crate::options::defaults();
    // Models play their roles in suites that go by templates.
    let profile = args.profile.clone().unwrap_or_else(|| "paper".to_owned());
    let prompt = prompt(&PromptRequest {
        dir: args.out.clone(),
        options: args.source.over(Options { profile, ..base }),
        role: args.role,
        model: args.agent.clone(),
        scenario: args.scenario.clone(),
        record: args.record.clone(),
    })?;
    if output.json {
        output::json(&prompt);
    } else {
        show(&prompt);
    }
    Ok(())
}

fn show(prompt: &Prompt) {
    let question = &prompt.question;
    let scenario = &question.purpose.scenario_id;
    println!("{} of {scenario}, asked of {}", question.purpose.role.name(), question.model);
    println!("question {}", prompt.hash);
    println!("prompt files {}", prompt.prompts);
    title("System");
    println!("{}", question.system.trim_end());
    for turn in &question.turns {
        title("User");
        println!("{}", turn.text.trim_end());
    }
    title(&format!("Schema of the answer ({})", question.schema_name));
    println!("{}", serde_json::to_string_pretty(&question.schema).unwrap_or_default());
}
