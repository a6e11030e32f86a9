//! `recrash eval`: how well an agent reads records, by labels written by careful readers (language-model agents).

use crate::model_options::AccessArgs;
use crate::output::{self, Output, title};
use crate::screen::{eprintln, println};
use crate::table::{Cell, number, table};
use clap::Args;
use recrash_pipeline::{Evaluation, EvaluationRequest, FieldScore, Half, HalfScore, PipelineError, evaluate};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  recrash eval                                      the reader that suites use, on the built-in labels and the downloaded crash files
  recrash eval --half dev                           the developed half alone, with its disagreements
  recrash eval --agent rules                        the rules of the paper's templates, on labels of their own
  recrash eval --records archive.csv --records current.csv --json
  recrash eval --agent gpt-5-mini --out eval-mini   a model, with its questions and answers in that folder

The labels are of NHTSA's two files on automated driving: recrash fetch --edition archive, and recrash fetch.
How fields are compared is in docs/models/evaluation.md.";

/// Options of `eval`.
#[derive(Debug, Clone, Args)]
#[command(after_help = EXAMPLES)]
pub struct EvalArgs {
    /// Who reads: reader (the accounts of recrash read), rules (those of the paper's templates), or a language model by name.
    #[arg(long, value_name = "reader|rules|MODEL", default_value = "reader")]
    pub agent: String,
    /// Label file (CSV). [default: the built-in ones: eval/labels.csv for the rules, else eval/accounts.csv]
    #[arg(long, value_name = "FILE")]
    pub labels: Option<PathBuf>,
    /// SGO crash file (CSV), or the name of a downloaded one; may be given several times. [default: the downloaded ones]
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub records: Vec<PathBuf>,
    /// Which half of the labels: dev, held-out or both. Disagreements on the held-out half are listed only where it is
    /// named: whoever writes rules must not read them.
    #[arg(long, value_name = "HALF", value_parser = ["dev", "held-out", "both"], default_value = "both")]
    pub half: String,
    /// System profile whose excluded collisions count.
    #[arg(long, value_name = "NAME|FILE", default_value = "paper")]
    pub profile: String,
    /// Folder of a model's questions and answers.
    #[arg(long, short, value_name = "DIR", default_value = "eval-run")]
    pub out: PathBuf,
    /// How a model is asked.
    #[command(flatten)]
    pub access: AccessArgs,
}

/// Reads the labelled records and compares.
///
/// # Errors
/// Labels or crash files cannot be used; questions wait for a batch.
pub fn run(args: &EvalArgs, output: Output) -> Result<(), PipelineError> {
    let evaluation = evaluate(&EvaluationRequest {
        agent: args.agent.clone(),
        labels: args.labels.clone(),
        records: args.records.clone(),
        half: match args.half.as_str() {
            "dev" => Some(Half::Dev),
            "held-out" => Some(Half::HeldOut),
            _ => None,
        },
        profile: args.profile.clone(),
        out: args.out.clone(),
        models: args.access.access(),
    })?;
    if output.json {
        output::json(&evaluation);
    } else if !output.quiet {
        show(&evaluation);
    }
    Ok(())
}

fn show(evaluation: &Evaluation) {
    for half in &evaluation.halves {
        show_half(half, &evaluation.agent);
    }
    if !evaluation.disagreements.is_empty() {
        title("Disagreements");
        let mut rows = table(&["record", "entity", "half", "field", "label", "read"]);
        for one in &evaluation.disagreements {
            rows.add_row(vec![
                Cell::new(&one.record),
                Cell::new(&one.entity),
                Cell::new(one.half.label()),
                Cell::new(one.field.label()),
                Cell::new(&one.label),
                Cell::new(&one.said),
            ]);
        }
        println!("{rows}");
    }
    for (record, why) in &evaluation.unread {
        eprintln!("  not read: {record}: {why}");
    }
    if !evaluation.missing.is_empty() {
        let names: Vec<String> = evaluation.missing.iter().map(ToString::to_string).collect();
        eprintln!("  {} labelled records are in no crash file: {}", names.len(), names.join(", "));
    }
}

fn show_half(half: &HalfScore, agent: &str) {
    let remark = match half.half {
        Half::HeldOut => "never read by who wrote the rules",
        Half::Dev => "the rules were written on it",
    };
    title(&format!("{agent} on {} {} records ({remark})", half.records, half.half.label()));
    let readers = half.fields.iter().any(|score| score.readers.is_some());
    let mut columns = vec!["field", "right", "of", "share", "95 % interval", "label unknown"];
    columns.extend(readers.then_some("two readers agree"));
    let mut rows = table(&columns);
    for score in &half.fields {
        let mut row = vec![
            Cell::new(score.field.label()),
            number(score.right),
            number(score.scored),
            number(score.share.map_or_else(|| "-".into(), percent)),
            number(interval(score)),
            number(score.unknown),
        ];
        row.extend(readers.then(|| {
            number(score.readers.map_or_else(|| "-".into(), |two| format!("{}/{}", two.agreed, two.both_told)))
        }));
        rows.add_row(row);
    }
    println!("{rows}");
}

fn percent(share: f64) -> String {
    format!("{:.1} %", share * 100.0)
}

fn interval(score: &FieldScore) -> String {
    score.interval.map_or_else(|| "-".into(), |(low, high)| format!("{:.0} to {:.0} %", low * 100.0, high * 100.0))
}
